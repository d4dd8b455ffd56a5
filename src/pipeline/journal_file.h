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

/// Appended to only, so that it is good up to its last whole block whenever the process ends:
///
///     header   "RADROWS\n", 0x01020304 as this machine writes it, version of the format; length
///              and checksum of the key; the key
///     block    "RADBLOCK", kind, number, length and checksum of the payload; checksum of all
///              these; the payload
///
/// each part a multiple of 8 bytes long. Blocks are written in one piece and reach the disk some
/// seconds later at most; what was written is safe from the end of the process at once, and from
/// the end of the machine then. A damaged block is passed over; the next is found by its first
/// word. The file is locked while it is open: it belongs to one process.
class JournalFile : public RowJournal {
 public:
  /// What was found when it was opened.
  struct Found {
    std::size_t blocks = 0;   ///< good ones
    std::size_t damaged = 0;  ///< stretches that are none, the cut end among them
    bool other_key = false;   ///< there were rows of other form factors: they are gone
  };
  /// Opens `path` or makes it. `resume`: what is there is used where its key is `key`; else it
  /// goes. Errors: RunError, with the reason, where the file cannot be used: another process holds
  /// it, it is no journal (then it stays as it is), or cannot be written.
  JournalFile(std::string path, std::string key, bool resume);
  /// Removes the file where there is nothing in it.
  ~JournalFile() override;

  /// One that another process holds, or held, to look up what is there: keep() is not for it. Null
  /// where there is none of that key.
  static std::unique_ptr<JournalFile> openForReading(const std::string& path,
                                                     const std::string& key);

  /// The key of the journal `path`; empty where there is none.
  static std::optional<std::string> keyIn(const std::string& path);

  const std::string& path() const { return path_; }
  const std::string& key() const { return key_; }
  const Found& atOpening() const { return found_; }
  /// Why blocks are not kept any more ("no space left on device"); empty while they are.
  std::string failure() const;
  /// Called with what the computation finds: RowJournal::found().
  void onFound(std::function<void(std::size_t rows, std::size_t of)> told) {
    told_ = std::move(told);
  }
  /// Takes the file away. Blocks are not kept any more.
  void remove();

  bool has(RowBlock kind, std::uint64_t number) const override;
  std::vector<std::byte> kept(RowBlock kind, std::uint64_t number) const override;
  void keep(RowBlock kind, std::uint64_t number, std::span<const std::byte> bytes) override;
  void found(std::size_t rows, std::size_t of) override;

 private:
  class Descriptor;
  JournalFile(std::string path, std::string key, std::unique_ptr<Descriptor> file);
  /// Of a payload in the file.
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
