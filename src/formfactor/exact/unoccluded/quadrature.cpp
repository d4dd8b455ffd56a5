#include "formfactor/exact/unoccluded/quadrature.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace radiosity {
namespace {

using Rule = std::vector<Node>;

/// Roots of the Legendre polynomial by Newton's method on its three-term recurrence, with weights
/// 2 / ((1 - x^2) P_n'(x)^2).
Rule makeGaussLegendre(int n) {
  Rule rule;
  for (int k = n; k >= 1; --k) {
    long double x = std::cos(std::numbers::pi_v<long double> * (k - 0.25L) / (n + 0.5L));
    long double slope = 1;
    for (int step = 0; step < 100; ++step) {
      long double before = 1;
      long double value = x;
      for (int j = 2; j <= n; ++j) {
        const long double next = ((2 * j - 1) * x * value - (j - 1) * before) / j;
        before = value;
        value = next;
      }
      slope = n * (x * value - before) / (x * x - 1);
      const long double change = value / slope;
      x -= change;
      if (std::abs(change) < 1e-19L) break;
    }
    if (2 * k == n + 1) x = 0;
    rule.push_back({double(x), double(2 / ((1 - x * x) * slope * slope)), double(1 - std::abs(x))});
  }
  return rule;
}

/// x = tanh(pi/2 sinh t): the trapezium rule in t, cut where the weights vanish in double.
Rule makeTanhSinh(int level) {
  constexpr long double kHalfPi = std::numbers::pi_v<long double> / 2;
  constexpr long double kLargest = 3.25L;  // 1 - x = 1e-17 there
  const long double step = std::ldexp(1.0L, -level);
  const int count = int(std::floor(kLargest / step));
  Rule rule;
  long double sum = 0;
  for (int k = -count; k <= count; ++k) {
    const long double t = k * step;
    const long double s = kHalfPi * std::sinh(t);
    const long double c = std::cosh(s);
    const long double weight = step * kHalfPi * std::cosh(t) / (c * c);
    rule.push_back({double(std::tanh(s)), double(weight), double(std::exp(-std::abs(s)) / c)});
    sum += weight;
  }
  // So that constants come out exactly at every level.
  for (Node& node : rule) node.weight = double(node.weight * 2 / sum);
  return rule;
}

template <std::size_t kCount, class Make>
std::array<Rule, kCount> makeAll(int first, const Make& make) {
  std::array<Rule, kCount> rules;
  for (std::size_t k = 0; k < kCount; ++k) rules[k] = make(first + int(k));
  return rules;
}

}  // namespace

std::span<const Node> gaussLegendre(int n) {
  static const auto rules = makeAll<kMostGaussNodes>(1, makeGaussLegendre);
  return rules[std::size_t(n - 1)];
}

std::span<const Node> tanhSinh(int level) {
  static const auto rules = makeAll<kFinestTanhSinh + 1>(0, makeTanhSinh);
  return rules[std::size_t(level)];
}

}  // namespace radiosity
