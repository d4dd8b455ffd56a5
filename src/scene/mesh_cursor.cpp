#include "scene/mesh_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "base/parse.h"
#include "scene/text.h"

namespace radiosity {

namespace {

static_assert(std::endian::native == std::endian::little, "bytes are turned for big ones alone");

}  // namespace

std::size_t sizeOf(NumberType type) {
  constexpr std::array<std::size_t, 10> kSizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[std::size_t(type)];
}

void MeshCursor::fail(const std::string& what) const {
  if (was_binary_) throw InputError(fmt::format("{}: byte {}: {}", file_, at_, what));
  throw InputError(fmt::format("{}:{}: {}", file_, line_, what));
}

void MeshCursor::passLineEnd() {
  if (at_ < all_.size() && all_[at_] == '\n') {
    ++at_;
    ++line_;
  }
}

void MeshCursor::skipBlanks() {
  for (; at_ < all_.size() && kBlanks.find(all_[at_]) != std::string_view::npos; ++at_) {
    if (all_[at_] == '\n') ++line_;
  }
}

bool MeshCursor::atEnd() {
  skipBlanks();
  return at_ == all_.size();
}

std::string_view MeshCursor::word() {
  if (atEnd()) fail("the file ends too early; export it again");
  const std::size_t end = std::min(all_.find_first_of(kBlanks, at_), all_.size());
  const std::string_view found = all_.substr(at_, end - at_);
  at_ = end;
  return found;
}

std::string_view MeshCursor::restOfLine() {
  const std::size_t end = std::min(all_.find('\n', at_), all_.size());
  const std::string_view found = trimmed(all_.substr(at_, end - at_));
  at_ = end;
  passLineEnd();
  return found;
}

std::string_view MeshCursor::nextLine() {
  if (atEnd()) return {};
  // We do not consume the line end, so that line() is that of the last item read.
  const std::size_t end = std::min(all_.find('\n', at_), all_.size());
  const std::string_view found = trimmed(all_.substr(at_, end - at_));
  at_ = end;
  return found;
}

template <class Value>
Value MeshCursor::value() {
  std::array<char, sizeof(Value)> raw{};
  std::memcpy(raw.data(), bytes(sizeof(Value)).data(), sizeof(Value));
  if (encoding_ == Encoding::big) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<Value>(raw);
}

double MeshCursor::binaryNumber(NumberType type) {
  if (type == NumberType::f32) return double(value<float>());
  if (type == NumberType::f64) return value<double>();
  return double(integer(type, "number"));
}

double MeshCursor::number(NumberType type, const char* what) {
  if (encoding_ != Encoding::text) {
    const double found = binaryNumber(type);
    if (!std::isfinite(found)) {
      fail(fmt::format("a {} is not a finite number; export the file again", what));
    }
    return found;
  }
  const std::string_view found = word();
  const std::optional<double> parsed = parseNumber(found);
  if (!parsed) {
    fail(fmt::format("{} `{}` is not a finite number; write it as 1.5 with a decimal point", what,
                     found));
  }
  return *parsed;
}

long long MeshCursor::integer(NumberType type, const char* what) {
  if (encoding_ == Encoding::text) {
    const std::string_view found = word();
    const std::optional<long long> parsed = parseInteger(found);
    if (!parsed) fail(fmt::format("{} `{}` is not a whole number; correct it", what, found));
    return *parsed;
  }
  switch (type) {
    case NumberType::i8:
      return value<std::int8_t>();
    case NumberType::u8:
      return value<std::uint8_t>();
    case NumberType::i16:
      return value<std::int16_t>();
    case NumberType::u16:
      return value<std::uint16_t>();
    case NumberType::i32:
      return value<std::int32_t>();
    case NumberType::u32:
      return value<std::uint32_t>();
    case NumberType::i64:
      return value<std::int64_t>();
    case NumberType::u64: {
      const auto found = value<std::uint64_t>();
      if (found > std::uint64_t(std::numeric_limits<long long>::max())) {
        fail(fmt::format("{} {} is too large; export the file again", what, found));
      }
      return static_cast<long long>(found);
    }
    default:
      fail(fmt::format("a {} is a fraction, where a whole number belongs; export it again", what));
  }
}

std::size_t MeshCursor::count(NumberType type, const char* what, NumberType of,
                              std::size_t numbers) {
  const long long found = integer(type, what);
  if (found < 0) fail(fmt::format("{} {}: it cannot be negative; correct it", what, found));
  require(std::size_t(found), what, of, numbers);
  return std::size_t(found);
}

std::size_t MeshCursor::textNumber(const char* what) {
  const Encoding encoding = std::exchange(encoding_, Encoding::text);
  const std::size_t found = count(NumberType::u64, what, NumberType::u8, 0);
  encoding_ = encoding;
  return found;
}

std::size_t MeshCursor::textCount(const char* what, NumberType of, std::size_t numbers) {
  const std::size_t found = textNumber(what);
  if (encoding_ != Encoding::text) restOfLine();
  require(found, what, of, numbers);
  return found;
}

Vec3 MeshCursor::place(NumberType type) {
  Vec3 found(0.0);
  for (int k = 0; k < 3; ++k) found[k] = number(type, "coordinate");
  return found;
}

void MeshCursor::require(std::size_t count, const char* what, NumberType of,
                         std::size_t numbers) const {
  // In text a number has at least a digit and a blank, except the last.
  const std::size_t left = all_.size() - at_;
  const std::size_t room = encoding_ == Encoding::text ? (left + 1) / 2 : left / sizeOf(of);
  if (numbers == 0 || count <= room / numbers) return;
  fail(
      fmt::format("{} {}: the file is too short for so many; it is cut off or damaged, export it "
                  "again",
                  what, count));
}

void MeshCursor::skip(NumberType type, std::size_t count) {
  require(count, "values", type);
  if (encoding_ == Encoding::text) {
    for (std::size_t k = 0; k < count; ++k) word();
  } else {
    bytes(count * sizeOf(type));
  }
}

bool MeshCursor::passBehind(std::string_view text) {
  std::size_t found = all_.find(text, at_);
  while (found != std::string_view::npos && found > 0 && all_[found - 1] != '\n') {
    found = all_.find(text, found + 1);
  }
  if (found == std::string_view::npos) return false;
  line_ += std::size_t(
      std::count(all_.begin() + std::ptrdiff_t(at_), all_.begin() + std::ptrdiff_t(found), '\n'));
  at_ = found + text.size();
  return true;
}

std::string_view MeshCursor::bytes(std::size_t count) {
  if (count > all_.size() - at_) fail("the file ends too early; export it again");
  if (encoding_ != Encoding::text) was_binary_ = true;
  const std::string_view found = all_.substr(at_, count);
  at_ += count;
  return found;
}

}  // namespace radiosity
