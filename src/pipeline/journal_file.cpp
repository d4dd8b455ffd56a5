#include "pipeline/journal_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "base/hash.h"

namespace radiosity {

namespace {

constexpr std::uint64_t kFileMagic = 0x0a53574f52444152ULL;   // "RADROWS\n"
constexpr std::uint64_t kBlockMagic = 0x4b434f4c42444152ULL;  // "RADBLOCK"
constexpr std::uint32_t kByteOrder = 0x01020304;
constexpr std::uint32_t kVersion = 3;
constexpr std::uint64_t kAlignment = 8;
/// The time between two synchronisations of the file with the disk.
constexpr std::chrono::seconds kSyncInterval{5};

struct FileHeader {
  std::uint64_t magic = kFileMagic;
  std::uint32_t byte_order = kByteOrder;
  std::uint32_t version = kVersion;
  std::uint64_t key_length = 0;
  std::uint64_t key_checksum = 0;
};

struct BlockHeader {
  std::uint64_t magic = kBlockMagic;
  std::uint64_t kind = 0;
  std::uint64_t number = 0;
  std::uint64_t length = 0;
  std::uint64_t payload_checksum = 0;
  std::uint64_t checksum = 0;  ///< of the members above

  std::uint64_t ownChecksum() const { return checksumOf(this, sizeof *this - sizeof checksum); }
};

std::uint64_t padded(std::uint64_t size) {
  return (size + kAlignment - 1) / kAlignment * kAlignment;
}

/// False where the file ends before.
bool readAt(int file, std::uint64_t offset, void* data, std::size_t size) {
  auto* to = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = pread(file, to, size, off_t(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    to += got;
    offset += std::uint64_t(got);
    size -= std::size_t(got);
  }
  return true;
}

std::uint64_t sizeOf(int file) {
  struct stat state {};
  return fstat(file, &state) == 0 ? std::uint64_t(state.st_size) : 0;
}

struct KeyFound {
  bool is_journal = false;  ///< it starts like one, of whatever version
  std::optional<std::string> key;
  std::uint64_t end = 0;
};

KeyFound readKey(int file) {
  KeyFound found;
  FileHeader header;
  if (!readAt(file, 0, &header, sizeof header)) return found;
  found.is_journal = header.magic == kFileMagic;
  if (!found.is_journal || header.byte_order != kByteOrder || header.version != kVersion ||
      header.key_length > sizeOf(file)) {
    return found;
  }
  std::string key(header.key_length, '\0');
  if (!readAt(file, sizeof header, key.data(), key.size())) return found;
  if (checksumOf(key.data(), key.size()) != header.key_checksum) return found;
  found.key = std::move(key);
  found.end = sizeof header + padded(header.key_length);
  return found;
}

/// Writes all parts in one call. False, with errno set, if not all of it could be written.
bool writeAt(int file, std::uint64_t offset, std::span<const iovec> parts) {
  std::size_t size = 0;
  for (const iovec& part : parts) size += part.iov_len;
  ssize_t put = 0;
  do {
    put = pwritev(file, parts.data(), int(parts.size()), off_t(offset));
  } while (put < 0 && errno == EINTR);
  if (put >= 0 && std::size_t(put) < size) errno = ENOSPC;
  return put >= 0 && std::size_t(put) == size;
}

iovec part(const void* data, std::size_t size) { return {const_cast<void*>(data), size}; }

const std::array<char, kAlignment> kZeros{};

}  // namespace

class JournalFile::Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { ::close(number_); }  // and with it the lock
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

JournalFile::JournalFile(std::string path, std::string key, bool resume)
    : path_(std::move(path)), key_(std::move(key)) {
  openLocked();
  const int file = file_->number();
  const std::uint64_t size = sizeOf(file);
  const KeyFound there = readKey(file);
  if (size > 0 && !there.is_journal) {
    throw RunError(path_ + " is there and holds no rows; give it another name");
  }
  if (resume && there.key == key_) {
    readBlocks(there.end);
  } else {
    found_.other_key = resume && size > 0;
    begin();
  }
  syncer_ = std::thread([this] { sync(); });
}

JournalFile::JournalFile(std::string path, std::string key, std::unique_ptr<Descriptor> file)
    : path_(std::move(path)), key_(std::move(key)), file_(std::move(file)), only_read_(true) {
  readBlocks(readKey(file_->number()).end);
}

std::unique_ptr<JournalFile> JournalFile::openForReading(const std::string& path,
                                                         const std::string& key) {
  const int number = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (number < 0) return nullptr;
  auto file = std::make_unique<Descriptor>(number);
  if (readKey(number).key != key) return nullptr;
  return std::unique_ptr<JournalFile>(new JournalFile(path, key, std::move(file)));
}

JournalFile::~JournalFile() {
  if (only_read_) return;
  {
    const std::lock_guard lock(writing_);
    closing_ = true;
    closing_signal_.notify_all();
  }
  syncer_.join();
  if (kept_ == 0 && found_.blocks == 0) remove();
}

/// The lock belongs to the file, not to its name: the last holder may have removed the name.
void JournalFile::openLocked() {
  constexpr mode_t kMode = 0666;  // less the bits in the user's mask
  for (;;) {
    const int number = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kMode);
    if (number < 0) throw RunError(fmt::format("{}: {}", path_, std::strerror(errno)));
    file_ = std::make_unique<Descriptor>(number);
    struct stat state {};
    if (fstat(number, &state) != 0 || !S_ISREG(state.st_mode)) {
      throw RunError(path_ + " is no file");
    }
    if (flock(number, LOCK_EX | LOCK_NB) != 0) {
      throw RunError(errno == EWOULDBLOCK ? path_ + " is in use by another run"
                                          : fmt::format("{}: {}", path_, std::strerror(errno)));
    }
    struct stat named {};
    const bool same = stat(path_.c_str(), &named) == 0 && named.st_ino == state.st_ino &&
                      named.st_dev == state.st_dev;
    if (same) return;
  }
}

/// Makes the file an empty journal with this key.
void JournalFile::begin() {
  const int file = file_->number();
  FileHeader header;
  header.key_length = key_.size();
  header.key_checksum = checksumOf(key_.data(), key_.size());
  const std::array parts = {part(&header, sizeof header), part(key_.data(), key_.size()),
                            part(kZeros.data(), padded(key_.size()) - key_.size())};
  if (ftruncate(file, 0) != 0 || !writeAt(file, 0, parts)) {
    const std::string why = std::strerror(errno);
    unlink(path_.c_str());
    throw RunError(fmt::format("{}: {}", path_, why));
  }
  end_ = sizeof header + padded(key_.size());
}

void JournalFile::readBlocks(std::uint64_t offset) {
  const int file = file_->number();
  const std::uint64_t size = sizeOf(file);
  end_ = offset;
  bool in_damage = false;
  std::vector<std::byte> payload;
  while (offset < size) {
    BlockHeader header;
    const bool whole = size - offset >= sizeof header &&
                       readAt(file, offset, &header, sizeof header) &&
                       header.magic == kBlockMagic && header.checksum == header.ownChecksum() &&
                       header.length <= size - offset - sizeof header;
    if (!whole) {
      if (!in_damage) ++found_.damaged;
      in_damage = true;
      offset += kAlignment;
      continue;
    }
    in_damage = false;
    payload.resize(header.length);
    const std::uint64_t at = offset + sizeof header;
    offset = at + padded(header.length);
    if (!readAt(file, at, payload.data(), payload.size()) ||
        checksumOf(payload.data(), payload.size()) != header.payload_checksum) {
      ++found_.damaged;
      continue;
    }
    there_[{std::uint32_t(header.kind), header.number}] = {at, header.length};
    end_ = offset;
  }
  found_.blocks = there_.size();
  if (!only_read_ && end_ < size && ftruncate(file, off_t(end_)) != 0)
    failure_ = std::strerror(errno);
}

std::optional<std::string> JournalFile::keyIn(const std::string& path) {
  const int number = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (number < 0) return std::nullopt;
  const Descriptor file(number);
  return readKey(number).key;
}

std::string JournalFile::failure() const {
  const std::lock_guard lock(writing_);
  return failure_;
}

void JournalFile::remove() {
  const std::lock_guard lock(writing_);
  if (!std::exchange(removed_, true)) unlink(path_.c_str());
}

bool JournalFile::has(RowBlock kind, std::uint64_t number) const {
  return there_.contains({std::uint32_t(kind), number});
}

std::vector<std::byte> JournalFile::kept(RowBlock kind, std::uint64_t number) const {
  const auto found = there_.find({std::uint32_t(kind), number});
  if (found == there_.end()) return {};
  std::vector<std::byte> bytes(found->second.length);
  if (!readAt(file_->number(), found->second.offset, bytes.data(), bytes.size())) return {};
  return bytes;
}

void JournalFile::keep(RowBlock kind, std::uint64_t number, std::span<const std::byte> bytes) {
  BlockHeader header;
  header.kind = std::uint32_t(kind);
  header.number = number;
  header.length = bytes.size();
  header.payload_checksum = checksumOf(bytes.data(), bytes.size());
  header.checksum = header.ownChecksum();
  const std::uint64_t padding = padded(bytes.size()) - bytes.size();
  const std::array parts = {part(&header, sizeof header), part(bytes.data(), bytes.size()),
                            part(kZeros.data(), padding)};
  const std::lock_guard lock(writing_);
  if (!failure_.empty() || removed_) return;
  if (!writeAt(file_->number(), end_, parts)) {
    failure_ = std::strerror(errno);
    // We cut off the incomplete block, which frees space on a full disk. If that fails, too, the
    // next run skips the block.
    if (ftruncate(file_->number(), off_t(end_)) == 0) unsynced_ = true;
    return;
  }
  end_ += sizeof header + bytes.size() + padding;
  ++kept_;
  unsynced_ = true;
}

void JournalFile::found(std::size_t rows, std::size_t of) {
  if (told_) told_(rows, of);
}

/// Runs in a thread of its own, so that a slow disk does not delay the computation.
void JournalFile::sync() {
  std::unique_lock lock(writing_);
  while (!closing_signal_.wait_for(lock, kSyncInterval, [this] { return closing_; })) {
    if (!std::exchange(unsynced_, false)) continue;
    lock.unlock();
    fdatasync(file_->number());
    lock.lock();
  }
}

}  // namespace radiosity
