#include "scene/vtk/vtk_arrays.h"

#include <fmt/format.h>
#include <lz4.h>
#include <lzma.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

namespace radiosity {

namespace {

using enum NumberType;

[[noreturn]] void fail(const VtkFile& file, const VtkArray& array, const std::string& what) {
  throw InputError(fmt::format("{}: DataArray {}: {}", file.path, array.name, what));
}

NumberType arrayType(const VtkFile& file, const VtkArray& array) {
  constexpr std::pair<std::string_view, NumberType> kTypes[] = {
      {"Int8", i8},    {"UInt8", u8},  {"Int16", i16},  {"UInt16", u16},  {"Int32", i32},
      {"UInt32", u32}, {"Int64", i64}, {"UInt64", u64}, {"Float32", f32}, {"Float64", f64}};
  for (const auto& [name, type] : kTypes) {
    if (name == array.type) return type;
  }
  fail(file, array, fmt::format("type `{}` is not read; export the file again", array.type));
}

/// The value of a base64 digit, or 64.
unsigned digitOf(char c) {
  if (c >= 'A' && c <= 'Z') return unsigned(c - 'A');
  if (c >= 'a' && c <= 'z') return unsigned(c - 'a') + 26;
  if (c >= '0' && c <= '9') return unsigned(c - '0') + 52;
  if (c == '+') return 62;
  return c == '/' ? 63 : 64;
}

/// Reads bytes of an array from base64, in runs that end with their padding, or raw.
class ByteSource {
 public:
  ByteSource(const VtkFile& file, const VtkArray& array) : file_(file), array_(array) {
    const bool is_appended = array.format == "appended";
    coded_ = !is_appended || !file.appended_is_raw;
    rest_ = is_appended ? file.appended : array.text;
    if (is_appended) {
      if (array.offset > rest_.size()) {
        fail(file, array, "its offset is beyond the appended data; the file is cut off");
      }
      rest_.remove_prefix(array.offset);
    }
  }

  /// The next bytes. A run of base64 continues where the last call ended.
  std::string take(std::size_t count) {
    if (!coded_) {
      if (count > rest_.size()) failShort();
      std::string bytes(rest_.substr(0, count));
      rest_.remove_prefix(count);
      return bytes;
    }
    while (decoded_.size() < count) decodeFour();
    std::string bytes = decoded_.substr(0, count);
    decoded_.erase(0, count);
    return bytes;
  }

  /// Begins a new run of base64, for instance after the header of packed data.
  void endRun() { decoded_.clear(); }

  /// An upper bound of the bytes that are left.
  std::size_t room() const { return rest_.size() + decoded_.size(); }

 private:
  [[noreturn]] void failShort() const {
    fail(file_, array_, "it ends too early; the file is cut off or damaged, export it again");
  }

  void decodeFour() {
    std::array<unsigned, 4> digits{};
    std::size_t found = 0;
    std::size_t padding = 0;
    std::size_t at = 0;
    for (; found < 4 && at < rest_.size(); ++at) {
      const char c = rest_[at];
      if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
      digits[found] = digitOf(c);
      if (c == '=') {
        digits[found] = 0;
        ++padding;
      } else if (digits[found] > 63 || padding > 0) {
        fail(file_, array_, "its base64 is damaged; export the file again");
      }
      ++found;
    }
    if (found < 4 || padding > 2) failShort();
    rest_.remove_prefix(at);
    const unsigned bits = (digits[0] << 18U) | (digits[1] << 12U) | (digits[2] << 6U) | digits[3];
    for (std::size_t k = 0; k + padding < 3; ++k) {
      decoded_ += char((bits >> (16U - 8U * unsigned(k))) & 0xffU);
    }
  }

  const VtkFile& file_;
  const VtkArray& array_;
  bool coded_;
  std::string_view rest_;
  std::string decoded_;  ///< decoded bytes that are not taken yet
};

std::vector<std::size_t> headerOf(const VtkFile& file, ByteSource& source, std::size_t count) {
  const NumberType type = file.wide_header ? u64 : u32;
  const std::string bytes = source.take(count * sizeOf(type));
  MeshCursor cursor(file.path, bytes);
  cursor.setEncoding(file.order);
  std::vector<std::size_t> numbers;
  for (std::size_t k = 0; k < count; ++k) {
    numbers.push_back(std::size_t(cursor.integer(type, "size")));
  }
  return numbers;
}

/// The most bytes to which one byte of packed data can unpack. For LZMA it is far more than occurs
/// in practice, for the others it is the format's limit.
std::size_t mostRatio(VtkPacking packing) {
  if (packing == VtkPacking::zlib) return 1032;
  return packing == VtkPacking::lz4 ? 255 : 8192;
}

/// Unpacks `packed` into `block`; false if it is damaged.
bool unpackBlock(VtkPacking packing, const std::string& packed, std::span<char> block) {
  if (packing == VtkPacking::lz4) {
    constexpr std::size_t kMost = std::numeric_limits<int>::max();
    return packed.size() <= kMost && block.size() <= kMost &&
           LZ4_decompress_safe(packed.data(), block.data(), int(packed.size()),
                               int(block.size())) == int(block.size());
  }
  const auto* in = reinterpret_cast<const std::uint8_t*>(packed.data());
  auto* out = reinterpret_cast<std::uint8_t*>(block.data());
  if (packing == VtkPacking::lzma) {
    std::uint64_t memory = std::uint64_t{1} << 30U;  // of the decoder; xz -9 asks for 65 MiB
    std::size_t read = 0;
    std::size_t written = 0;
    return lzma_stream_buffer_decode(&memory, 0, nullptr, in, &read, packed.size(), out, &written,
                                     block.size()) == LZMA_OK &&
           written == block.size();
  }
  uLongf length = block.size();
  return uncompress(out, &length, in, packed.size()) == Z_OK && length == block.size();
}

/// The bytes of the values that the file declares.
std::size_t mostBytes(const VtkFile& file, const VtkArray& array) {
  const std::size_t size = sizeOf(arrayType(file, array));
  return size * std::min(array.most, std::numeric_limits<std::size_t>::max() / size);
}

/// Unpacks blocks, which are packed separately. The header has their number, their size, the size
/// of the last (0: like the others), then the packed size of each.
std::string unpacked(const VtkFile& file, const VtkArray& array, ByteSource& source) {
  const std::vector<std::size_t> head = headerOf(file, source, 3);
  const std::size_t blocks = head[0];
  if (blocks > source.room() / 4)
    fail(file, array, "it has too many blocks; export the file again");
  const std::vector<std::size_t> sizes = headerOf(file, source, blocks);
  source.endRun();
  const std::size_t most = mostBytes(file, array);
  std::string all;
  for (std::size_t k = 0; k < blocks; ++k) {
    const bool is_short = k + 1 == blocks && head[2] > 0;
    const std::size_t size = is_short ? head[2] : head[1];
    if (sizes[k] > source.room() || size / mostRatio(file.packing) > sizes[k]) {
      fail(file, array, "a block's size is wrong; the file is damaged, export it again");
    }
    if (size > most - all.size()) {
      fail(file, array,
           fmt::format("it unpacks to more than the {} values that its piece has; the file is "
                       "damaged, export it again",
                       array.most));
    }
    const std::string packed = source.take(sizes[k]);
    const std::size_t begin = all.size();
    all.resize(begin + size);
    if (!unpackBlock(file.packing, packed, std::span(all).subspan(begin))) {
      fail(file, array, "a block cannot be unpacked; the file is damaged, export it again");
    }
  }
  return all;
}

std::string bytesOf(const VtkFile& file, const VtkArray& array) {
  ByteSource source(file, array);
  if (file.packing != VtkPacking::none) return unpacked(file, array, source);
  const std::size_t size = headerOf(file, source, 1)[0];
  if (size > source.room()) {
    fail(file, array, "it ends too early; the file is cut off or damaged, export it again");
  }
  return source.take(size);
}

template <class Number, class Read>
std::vector<Number> readAll(const VtkFile& file, const VtkArray& array, const Read& read) {
  const NumberType type = arrayType(file, array);
  const bool is_text = array.format == "ascii";
  const std::string bytes = is_text ? std::string() : bytesOf(file, array);
  MeshCursor cursor(fmt::format("{}: DataArray {}", file.path, array.name),
                    is_text ? array.text : std::string_view(bytes));
  std::vector<Number> numbers;
  if (is_text) {
    while (!cursor.atEnd()) numbers.push_back(read(cursor, type));
    return numbers;
  }
  cursor.setEncoding(file.order);
  const std::size_t count = bytes.size() / sizeOf(type);
  numbers.reserve(count);
  for (std::size_t k = 0; k < count; ++k) numbers.push_back(read(cursor, type));
  return numbers;
}

}  // namespace

std::optional<VtkPacking> vtkPacking(std::string_view compressor) {
  constexpr std::pair<std::string_view, VtkPacking> kNames[] = {
      {"", VtkPacking::none},
      {"vtkZLibDataCompressor", VtkPacking::zlib},
      {"vtkLZ4DataCompressor", VtkPacking::lz4},
      {"vtkLZMADataCompressor", VtkPacking::lzma}};
  for (const auto& [name, packing] : kNames) {
    if (name == compressor) return packing;
  }
  return std::nullopt;
}

std::vector<double> vtkNumbers(const VtkFile& file, const VtkArray& array) {
  return readAll<double>(file, array, [](MeshCursor& cursor, NumberType type) {
    return cursor.number(type, "coordinate");
  });
}

std::vector<long long> vtkIntegers(const VtkFile& file, const VtkArray& array) {
  return readAll<long long>(file, array, [](MeshCursor& cursor, NumberType type) {
    return cursor.integer(type, "value");
  });
}

std::vector<std::string> vtkWords(const VtkFile& file, const VtkArray& array) {
  VtkArray characters = array;
  characters.type = "Int8";
  constexpr std::size_t kLongestWord = 4096;
  characters.most *= kLongestWord;
  std::vector<std::string> words(1);
  for (const long long code : vtkIntegers(file, characters)) {
    if (code == 0) {
      words.emplace_back();
    } else {
      words.back() += char(code);
    }
  }
  words.pop_back();
  return words;
}

}  // namespace radiosity
