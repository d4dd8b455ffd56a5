// Quadrature over two elements at once, each the image of the square [-1, 1]^2.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace radiosity {

/// Points of one square, for either element, and the weights of their pairs. Point j of the row is
/// paired with the first `partners` points i of the column, at a weight of row_weight *
/// column_weight[weights][i].
struct FarRule {
  struct Point {
    double s, t;
    double row_weight;
    std::size_t partners;
    std::size_t weights;
  };
  static constexpr std::size_t kMostPoints = 25;

  std::size_t count = 0;
  std::size_t begin = 0;  ///< points of the rules before
  double order = 0;       ///< the error falls like R^order, see far_kernels.h
  std::array<Point, kMostPoints> points{};
  std::array<std::array<double, kMostPoints>, 3> column_weight{};
  std::size_t weight_sets = 1;  ///< of column_weight
};

/// In order of accuracy: product Gauss of 2 x 2 points on each element; of the 3 x 3 points the 33
/// pairs of Stroud's degree 5 formula C_n: 5-2 (Approximate Calculation of Multiple Integrals,
/// 1971; Hammer & Stroud 1958) for n = 4; then product Gauss of 3 x 3 to 5 x 5.
inline constexpr std::size_t kFarRules = 5;
/// Points of all rules.
inline constexpr std::size_t kFarRulePoints = 4 + 9 + 9 + 16 + 25;

std::span<const FarRule, kFarRules> farRules();

}  // namespace radiosity
