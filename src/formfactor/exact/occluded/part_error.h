// Estimates the error of a part between critical lines from the difference of its two rules.
#pragma once

#include <array>
#include <cstddef>

namespace radiosity {

/// Values of the target at the points of a part.
struct PartValues {
  static constexpr std::size_t kPoints = 13;  ///< 2 x 2, then 3 x 3
  static constexpr std::size_t kCoarse = 4;   ///< of them the first

  std::array<double, kPoints> visible;
  std::array<double, kPoints> whole;
  std::array<double, kPoints> weight;
  double area = 0;
  bool one_shape = true;
  bool overlap = false;  ///< of shadows on the target

  /// The integral by 3 x 3 points.
  double integral(const std::array<double, kPoints>& values) const;
  /// Error of the integral of visible minus `fraction` times whole form factor. `near`: see
  /// VisibleFraction. It decides whether the part is halved; a part that is kept states kPartStated
  /// times this.
  double error(double fraction, bool near) const;

 private:
  double coarseIntegral(const std::array<double, kPoints>& values) const;
};

}  // namespace radiosity
