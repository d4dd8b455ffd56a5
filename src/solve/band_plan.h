// Which bands of a system have to be solved.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace radiosity {

/// The lit bands that are not equal to an earlier one, and the source of each band's values.
class BandPlan {
 public:
  BandPlan(std::span<const double> reflectance, std::span<const double> emission, int bands)
      : bands_(std::size_t(bands)) {
    for (std::size_t b = 0; b < bands_; ++b) {
      const auto same = std::find_if(solved_.begin(), solved_.end(), [&](std::size_t earlier) {
        return equal(reflectance, b, earlier) && equal(emission, b, earlier);
      });
      if (!emits(emission, b)) {
        source_.push_back(kDark);
        continue;
      }
      source_.push_back(std::size_t(same - solved_.begin()));
      if (same == solved_.end()) solved_.push_back(b);
    }
  }
  std::span<const std::size_t> solved() const { return solved_; }
  int dark() const { return int(std::count(source_.begin(), source_.end(), kDark)); }
  int repeated() const { return int(bands_) - dark() - int(solved_.size()); }

  /// The bands to solve of N * bands values.
  std::vector<double> pick(std::span<const double> values) const {
    std::vector<double> out;
    out.reserve(values.size() / bands_ * solved_.size());
    for (std::size_t row = 0; row < values.size(); row += bands_) {
      for (const std::size_t b : solved_) out.push_back(values[row + b]);
    }
    return out;
  }
  /// All bands from those solved; dark ones are 0.
  std::vector<double> spread(std::span<const double> values) const {
    const std::size_t width = solved_.size();
    std::vector<double> out;
    out.reserve(values.size() / width * bands_);
    for (std::size_t row = 0; row < values.size(); row += width) {
      for (const std::size_t from : source_) {
        out.push_back(from == kDark ? 0.0 : values[row + from]);
      }
    }
    return out;
  }

 private:
  static constexpr std::size_t kDark = std::size_t(-1);

  bool emits(std::span<const double> emission, std::size_t b) const {
    bool any = false;
    for (std::size_t k = b; k < emission.size(); k += bands_) any = any || emission[k] != 0;
    return any;
  }
  bool equal(std::span<const double> values, std::size_t a, std::size_t b) const {
    bool all = true;
    for (std::size_t row = 0; row < values.size(); row += bands_) {
      all = all && values[row + a] == values[row + b];
    }
    return all;
  }

  std::size_t bands_;
  std::vector<std::size_t> solved_;  // bands
  std::vector<std::size_t> source_;  // by band: an index into solved_, or kDark
};

}  // namespace radiosity
