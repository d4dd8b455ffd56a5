#include "page/container.h"

#include <cmath>
#include <cstring>

#include "radiosity/base.h"

namespace radiosity::page {

namespace {

constexpr char kMagic[] = "RADPAGE1";
constexpr std::size_t kHeadBytes = 16;

}  // namespace

void Container::requireFinite(const std::string& name, std::span<const float> values) {
  for (const float value : values) {
    if (std::isfinite(value)) continue;
    throw RunError("a page's array '" + name +
                   "' has a value that is no finite number in single precision; solve again");
  }
}

std::string Container::headerText(std::size_t first_array) const {
  Json header = header_;
  header["arrays"] = Json::object();
  for (const Array& array : arrays_) {
    header["arrays"][array.name] = {
        {"type", array.type}, {"offset", first_array + array.begin}, {"length", array.length}};
  }
  // A name from an OBJ file need not be valid UTF-8, but JSON must be.
  return header.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::vector<std::byte> Container::bytes() const {
  // The header contains offsets, which depend on its length. So we reserve room for offsets with
  // the most digits.
  constexpr std::size_t kMostDigits = 9'999'999'999;
  const std::size_t length = padded(headerText(kMostDigits).size());
  std::string header = headerText(kHeadBytes + length);
  header.resize(length, ' ');
  std::vector<std::byte> out(kHeadBytes + length + data_.size());
  const auto header_length = std::uint32_t(length);
  std::memcpy(out.data(), kMagic, 8);
  std::memcpy(out.data() + 8, &header_length, sizeof header_length);
  std::memcpy(out.data() + kHeadBytes, header.data(), length);
  if (!data_.empty()) std::memcpy(out.data() + kHeadBytes + length, data_.data(), data_.size());
  return out;
}

}  // namespace radiosity::page
