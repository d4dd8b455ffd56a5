// A page's container, read by the description in src/page/README.md alone.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

namespace radiosity::test {

class PageReader {
 public:
  explicit PageReader(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {
    const auto* text = reinterpret_cast<const char*>(bytes_.data());
    EXPECT_EQ(std::string(text, 8), "RADPAGE1");
    std::uint32_t length[2] = {0, 1};
    std::memcpy(length, text + 8, sizeof length);
    EXPECT_EQ(length[1], 0u);
    EXPECT_EQ(length[0] % 8, 0u);
    header = nlohmann::json::parse(text + 16, text + 16 + length[0]);
  }

  template <class Value>
  std::vector<Value> array(const std::string& name) const {
    const nlohmann::json& entry = header.at("arrays").at(name);
    const std::string type = std::is_same_v<Value, float>           ? "f32"
                             : std::is_same_v<Value, std::uint32_t> ? "u32"
                             : std::is_same_v<Value, std::uint16_t> ? "u16"
                                                                    : "u8";
    EXPECT_EQ(entry.at("type"), type) << name;
    const std::size_t offset = entry.at("offset");
    EXPECT_EQ(offset % 8, 0u) << name;
    std::vector<Value> values(entry.at("length").get<std::size_t>());
    EXPECT_LE(offset + values.size() * sizeof(Value), bytes_.size()) << name;
    if (!values.empty()) {
      std::memcpy(values.data(), bytes_.data() + offset, values.size() * sizeof(Value));
    }
    return values;
  }
  std::vector<float> floats(const std::string& name) const { return array<float>(name); }
  std::vector<std::uint32_t> indices(const std::string& name) const {
    return array<std::uint32_t>(name);
  }

  /// All of F, row-major.
  std::vector<double> factors() const {
    const auto area = floats("node_area");
    const std::size_t n = area.size();
    const auto begin = indices("factor_begin");
    const auto column = indices("factor_column");
    const auto code = array<std::uint16_t>("factor_code");
    const double lowest = header["quantisation"]["lowest"];
    const double step = header["quantisation"]["step"];
    EXPECT_EQ(begin.size(), n + 1);
    EXPECT_EQ(begin.back(), code.size());
    std::vector<double> f(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = begin[i]; k < begin[i + 1]; ++k) {
        const std::size_t j = column.empty() ? i + (k - begin[i]) : column[k];
        const double value = code[k] == 0 ? 0 : std::exp(lowest + step * code[k]);
        f[i * n + j] = value;
        if (value > 0) f[j * n + i] = value * double(area[i]) / double(area[j]);
      }
    }
    return f;
  }

  nlohmann::json header;

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace radiosity::test
