#include "formfactor/exact/unoccluded/far_rules.h"

#include <cmath>

#include "formfactor/exact/error_model.h"
#include "formfactor/exact/unoccluded/quadrature.h"

namespace radiosity {
namespace {

FarRule productGauss(int n) {
  FarRule rule;
  rule.count = std::size_t(n) * std::size_t(n);
  rule.order = n;
  std::size_t k = 0;
  for (const Node& s : gaussLegendre(n)) {
    for (const Node& t : gaussLegendre(n)) {
      const double weight = 0.25 * s.weight * t.weight;
      rule.points[k] = {s.x, t.x, weight, rule.count, 0};
      rule.column_weight[0][k] = weight;
      ++k;
    }
  }
  return rule;
}

/// C_n: 5-2 for n = 4, of volume 1: the centre, (+-r, 0, 0, 0) and (+-r, +-r, 0, 0) in all orders.
/// With the centre first, then the ends of the axes, then the corners, each point of one square
/// goes with a leading part of the other's.
FarRule stroudDegreeFive() {
  constexpr double kCentre = 102.0 / 162;
  constexpr double kOne = -30.0 / 162;
  constexpr double kTwo = 25.0 / 324;
  const double r = std::sqrt(0.6);
  FarRule rule;
  rule.count = 9;
  rule.order = kStroudOrder;
  rule.weight_sets = 3;
  rule.points[0] = {0, 0, 1, 9, 0};
  const std::array<std::array<double, 2>, 4> axes = {{{r, 0}, {-r, 0}, {0, r}, {0, -r}}};
  const std::array<std::array<double, 2>, 4> corners = {{{r, r}, {-r, r}, {r, -r}, {-r, -r}}};
  for (std::size_t k = 0; k < 4; ++k) {
    rule.points[1 + k] = {axes[k][0], axes[k][1], 1, 5, 1};
    rule.points[5 + k] = {corners[k][0], corners[k][1], 1, 1, 2};
  }
  rule.column_weight[0] = {kCentre, kOne, kOne, kOne, kOne, kTwo, kTwo, kTwo, kTwo};
  rule.column_weight[1] = {kOne, kTwo, kTwo, kTwo, kTwo};
  rule.column_weight[2] = {kTwo};
  return rule;
}

std::array<FarRule, kFarRules> makeRules() {
  std::array<FarRule, kFarRules> rules = {productGauss(2), stroudDegreeFive(), productGauss(3),
                                          productGauss(4), productGauss(5)};
  for (std::size_t k = 1; k < kFarRules; ++k)
    rules[k].begin = rules[k - 1].begin + rules[k - 1].count;
  return rules;
}

}  // namespace

std::span<const FarRule, kFarRules> farRules() {
  static const std::array<FarRule, kFarRules> rules = makeRules();
  return rules;
}

}  // namespace radiosity
