// Files in a zip archive (PKWARE, "APPNOTE.TXT, .ZIP File Format Specification" 6.3), as in a .3mf:
// stored or deflated, also in the form for large files, Zip64.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace radiosity {

/// The files of an archive in memory, by their names. Case and a leading slash do not matter, as in
/// the packages to which 3MF belongs (ECMA-376, part 2).
class ZipArchive {
 public:
  /// Reads the archive's list of files. `content` must outlive it. Errors: InputError "PATH: what;
  /// cure".
  ZipArchive(const std::string& path, std::string_view content);

  bool has(std::string_view name) const;
  /// Unpacks an existing file of less than 2 GiB. Errors: InputError "PATH: NAME: what; cure".
  std::string read(std::string_view name) const;

 private:
  struct Entry {
    std::string name;
    std::uint64_t flags = 0;
    std::uint64_t method = 0;
    std::uint64_t checksum = 0;
    std::uint64_t packed = 0;  ///< bytes
    std::uint64_t size = 0;    ///< bytes when unpacked
    std::uint64_t place = 0;   ///< of the header before its bytes
  };
  struct Directory {
    std::uint64_t entries = 0;
    std::uint64_t place = 0;
  };

  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void failDamaged() const;
  std::uint64_t number(std::uint64_t place, unsigned bytes) const;
  std::string_view bytes(std::uint64_t place, std::uint64_t count) const;
  Directory directory() const;
  void readEntry(std::uint64_t& place);
  void readLargeSizes(std::string_view extra, Entry& entry) const;
  std::string_view packedBytes(const Entry& entry) const;
  void require(const Entry& entry) const;

  const std::string& path_;
  std::string_view content_;
  std::map<std::string, Entry> entries_;  ///< by name in small letters, without a slash before it
};

}  // namespace radiosity
