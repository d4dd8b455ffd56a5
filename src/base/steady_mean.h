// A weighted mean that is not off where its values are alike.
#pragma once

#include <algorithm>

namespace radiosity {

/// The mean of values of weights >= 0, as the first value and the mean of the differences to it: a
/// constant keeps its bits. Where the first has hardly any weight, rounding of the differences
/// might pass the least or the largest value; the mean does not.
class SteadyMean {
 public:
  void add(double weight, double value) {
    if (!any_) first_ = least_ = largest_ = value;
    any_ = true;
    least_ = std::min(least_, value);
    largest_ = std::max(largest_, value);
    weight_ += weight;
    sum_ += weight * (value - first_);
  }
  /// The first value if none has weight.
  double value() const {
    return weight_ > 0 ? std::clamp(first_ + sum_ / weight_, least_, largest_) : first_;
  }

 private:
  bool any_ = false;
  double first_ = 0;
  double least_ = 0;
  double largest_ = 0;
  double weight_ = 0;
  double sum_ = 0;
};

}  // namespace radiosity
