// The journal of rows as a file beside the results.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "radiosity/row_journal.h"

namespace radiosity {

/// The file is only appended to, so it is good up to its last whole block whenever the process
/// ends:
///
///     header   "RADROWS\n", 0x01020304 as this machine writes it, version of the format; length
///              and checksum of the key; the key
///     block    "RADBLOCK", kind, number, length and checksum of the payload; checksum of all
///              these; the payload
///
/// each part a multiple of 8 bytes long. A block is written in one piece: from then on it survives
/// the end of the process. It reaches the disk some seconds later at most: from then on it survives
/// a crash of the machine. Readers skip a damaged block and find the next by its first word. The
/// file is locked while it is open: it belongs to one process.
class JournalFile : public RowJournal {
 public:
  /// The contents of the file when it was opened.
  struct Found {
    std::size_t blocks = 0;   ///< good ones
    std::size_t damaged = 0;  ///< stretches without a good block, the cut-off end among them
    bool other_key = false;   ///< the file held rows of other form factors, which were removed
  };
  /// Opens or creates `path`. Keeps its blocks if `resume` is set and its key is `key`; otherwise
  /// empties it. Errors: RunError, with the reason, if another process holds the file, if it is not
  /// a journal (then it stays as it is), or if it cannot be written.
  JournalFile(std::string path, std::string key, bool resume);
  /// Removes the file if it has no blocks.
  ~JournalFile() override;

  /// Opens the journal of another process, which may still hold it, to look up its blocks; keep()
  /// must not be called. Null if `path` has no journal with that key.
  static std::unique_ptr<JournalFile> openForReading(const std::string& path,
                                                     const std::string& key);

  /// The key of the journal `path`; empty if there is no journal.
  static std::optional<std::string> keyIn(const std::string& path);

  const std::string& path() const { return path_; }
  const std::string& key() const { return key_; }
  const Found& atOpening() const { return found_; }
  /// Why blocks are not kept any more ("no space left on device"); empty while they are.
  std::string failure() const;
  /// Sets the function that RowJournal::found() calls.
  void onFound(std::function<void(std::size_t rows, std::size_t of)> told) {
    told_ = std::move(told);
  }
  /// Removes the file. Later blocks are not kept.
  void remove();

  bool has(RowBlock kind, std::uint64_t number) const override;
  std::vector<std::byte> kept(RowBlock kind, std::uint64_t number) const override;
  void keep(RowBlock kind, std::uint64_t number, std::span<const std::byte> bytes) override;
  void found(std::size_t rows, std::size_t of) override;

 private:
  class Descriptor;
  JournalFile(std::string path, std::string key, std::unique_ptr<Descriptor> file);
  /// The place of a payload in the file.
  struct Place {
    std::uint64_t offset;
    std::uint64_t length;
  };
  using Name = std::pair<std::uint32_t, std::uint64_t>;  // kind, number

  void openLocked();
  void begin();
  void readBlocks(std::uint64_t offset);
  void sync();

  std::string path_;
  std::string key_;
  Found found_;
  std::function<void(std::size_t, std::size_t)> told_;
  std::unique_ptr<Descriptor> file_;
  std::map<Name, Place> there_;  ///< found at the opening; not changed after that

  mutable std::mutex writing_;
  std::uint64_t end_ = 0;  ///< of the last whole block
  std::size_t kept_ = 0;   ///< blocks written
  std::string failure_;
  bool removed_ = false;
  bool only_read_ = false;
  bool unsynced_ = false;
  bool closing_ = false;
  std::condition_variable closing_signal_;
  std::thread syncer_;
};

}  // namespace radiosity
