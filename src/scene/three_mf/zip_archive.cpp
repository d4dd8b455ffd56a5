#include "scene/three_mf/zip_archive.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <utility>

#include "base/lower_case.h"
#include "radiosity/base.h"

namespace radiosity {

namespace {

/// The signatures of the parts of an archive.
constexpr std::uint64_t kFileHeader = 0x04034b50;
constexpr std::uint64_t kDirectoryEntry = 0x02014b50;
constexpr std::uint64_t kDirectoryEnd = 0x06054b50;
constexpr std::uint64_t kLargeDirectoryEnd = 0x06064b50;
constexpr std::uint64_t kLargeLocator = 0x07064b50;
/// Marks a number that needs more bits and is stored elsewhere.
constexpr std::uint64_t kInLargeForm = 0xffffffff;

/// The most bytes that zlib takes at once.
constexpr std::uint64_t kMostOfZlib = (std::uint64_t{1} << 31U) - 1;
/// The largest file that is unpacked: some 10 million triangles.
constexpr std::uint64_t kMostUnpacked = std::uint64_t{1} << 30U;
/// The most bytes to which one deflated byte can unpack (zlib's manual, "Maximum expansion
/// factor").
constexpr std::uint64_t kMostRatio = 1032;
/// Larger files are refused at a lower ratio, which no list of coordinates reaches.
constexpr std::uint64_t kFewUnpacked = std::uint64_t{1} << 26U;
constexpr std::uint64_t kMostRatioOfMany = 100;

std::string plainName(std::string_view name) {
  if (name.starts_with('/')) name.remove_prefix(1);
  return lowerCase(name);
}

std::uint64_t littleEndian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (std::size_t k = bytes.size(); k-- > 0;) {
    value = (value << 8U) | static_cast<unsigned char>(bytes[k]);
  }
  return value;
}

/// Fills `unpacked`; false if the bytes are damaged.
bool inflateInto(std::string_view packed, std::string& unpacked) {
  z_stream stream{};
  constexpr int kWithoutHeader = -15;
  if (inflateInit2(&stream, kWithoutHeader) != Z_OK) return false;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = uInt(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(unpacked.data());
  stream.avail_out = uInt(unpacked.size());
  const int outcome = inflate(&stream, Z_FINISH);
  inflateEnd(&stream);
  return outcome == Z_STREAM_END && stream.avail_out == 0;
}

}  // namespace

ZipArchive::ZipArchive(const std::string& path, std::string_view content)
    : path_(path), content_(content) {
  if (!content.starts_with("PK")) fail("is no zip archive, which begins with PK; export it again");
  const Directory list = directory();
  std::uint64_t place = list.place;
  for (std::uint64_t k = 0; k < list.entries; ++k) readEntry(place);
}

void ZipArchive::fail(const std::string& what) const {
  throw InputError(fmt::format("{}: {}", path_, what));
}

void ZipArchive::failDamaged() const {
  fail("the list of its files is damaged or cut off; export it again");
}

std::string_view ZipArchive::bytes(std::uint64_t place, std::uint64_t count) const {
  if (place > content_.size() || count > content_.size() - place) failDamaged();
  return content_.substr(place, count);
}

std::uint64_t ZipArchive::number(std::uint64_t place, unsigned count) const {
  return littleEndian(bytes(place, count));
}

/// Finds the list of files. It is at the end of the archive, followed by a record with its start
/// and a comment of up to 65535 bytes.
ZipArchive::Directory ZipArchive::directory() const {
  constexpr std::size_t kEndSize = 22;
  const std::size_t end = content_.rfind("PK\5\6");
  if (end == std::string_view::npos || content_.size() - end < kEndSize ||
      number(end, 4) != kDirectoryEnd) {
    fail("the list of its files, at its end, is not there; it is cut off, export it again");
  }
  Directory list{number(end + 10, 2), number(end + 16, 4)};
  constexpr std::size_t kLocatorSize = 20;
  if (end < kLocatorSize || number(end - kLocatorSize, 4) != kLargeLocator) return list;
  const std::uint64_t large = number(end - kLocatorSize + 8, 8);
  if (number(large, 4) != kLargeDirectoryEnd) failDamaged();
  return {number(large + 32, 8), number(large + 48, 8)};
}

void ZipArchive::readEntry(std::uint64_t& place) {
  constexpr std::uint64_t kEntrySize = 46;
  if (number(place, 4) != kDirectoryEntry) failDamaged();
  Entry entry;
  entry.flags = number(place + 8, 2);
  entry.method = number(place + 10, 2);
  entry.checksum = number(place + 16, 4);
  entry.packed = number(place + 20, 4);
  entry.size = number(place + 24, 4);
  entry.place = number(place + 42, 4);
  const std::uint64_t name = number(place + 28, 2);
  const std::uint64_t extra = number(place + 30, 2);
  const std::uint64_t comment = number(place + 32, 2);
  entry.name = bytes(place + kEntrySize, name);
  readLargeSizes(bytes(place + kEntrySize + name, extra), entry);
  place += kEntrySize + name + extra + comment;
  entries_.try_emplace(plainName(entry.name), std::move(entry));
}

/// Reads sizes that did not fit into the entry. They are in field 1 of the extra fields, each of
/// which has a number and a size.
void ZipArchive::readLargeSizes(std::string_view extra, Entry& entry) const {
  while (extra.size() >= 4) {
    const std::uint64_t field = littleEndian(extra.substr(0, 2));
    const std::uint64_t size = littleEndian(extra.substr(2, 2));
    if (size > extra.size() - 4) failDamaged();
    std::string_view values = extra.substr(4, size);
    extra.remove_prefix(4 + size);
    if (field != 1) continue;
    for (std::uint64_t* value : {&entry.size, &entry.packed, &entry.place}) {
      if (*value != kInLargeForm) continue;
      if (values.size() < 8) failDamaged();
      *value = littleEndian(values.substr(0, 8));
      values.remove_prefix(8);
    }
  }
}

bool ZipArchive::has(std::string_view name) const { return entries_.contains(plainName(name)); }

/// Refuses the entry of a damaged or forged archive before memory is allocated.
void ZipArchive::require(const Entry& entry) const {
  if ((entry.flags & 1U) != 0) fail(entry.name + ": is encrypted; save it without a password");
  if (entry.method != Z_DEFLATED && entry.method != 0) {
    fail(fmt::format("{}: is packed by method {}, which is not read; pack it by deflate",
                     entry.name, entry.method));
  }
  const auto failForSize = [&] {
    fail(fmt::format("{}: unpacks to {} bytes, more than are read; split the scene", entry.name,
                     entry.size));
  };
  if (entry.size > kMostOfZlib || entry.packed > kMostOfZlib) failForSize();
  const bool is_stored = entry.method == 0;
  if (is_stored ? entry.size != entry.packed : entry.size / kMostRatio > entry.packed) {
    fail(fmt::format("{}: its size is wrong; the archive is damaged, export it again", entry.name));
  }
  if (entry.size > kMostUnpacked) failForSize();
  if (entry.size > kFewUnpacked && entry.size / kMostRatioOfMany > entry.packed) {
    fail(fmt::format("{}: unpacks from {} to {} bytes, as no scene does; export it again",
                     entry.name, entry.packed, entry.size));
  }
}

/// The packed bytes of a file. They follow a header, which repeats the name and has extra fields.
std::string_view ZipArchive::packedBytes(const Entry& entry) const {
  constexpr std::uint64_t kHeaderSize = 30;
  if (entry.place >= content_.size() || number(entry.place, 4) != kFileHeader) failDamaged();
  const std::uint64_t name = number(entry.place + 26, 2);
  const std::uint64_t extra = number(entry.place + 28, 2);
  return bytes(entry.place + kHeaderSize + name + extra, entry.packed);
}

std::string ZipArchive::read(std::string_view name) const {
  const Entry& entry = entries_.at(plainName(name));
  require(entry);
  const std::string_view packed = packedBytes(entry);
  std::string unpacked;
  if (entry.method == 0) {
    unpacked = packed;
  } else {
    unpacked.resize(entry.size);
    if (!inflateInto(packed, unpacked)) {
      fail(entry.name + ": cannot be unpacked; the archive is damaged, export it again");
    }
  }
  const auto* const first = reinterpret_cast<const Bytef*>(unpacked.data());
  if (crc32(0, first, uInt(unpacked.size())) != entry.checksum) {
    fail(entry.name + ": its checksum is wrong; the archive is damaged, export it again");
  }
  return unpacked;
}

}  // namespace radiosity
