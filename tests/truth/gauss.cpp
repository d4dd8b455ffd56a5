#include "gauss.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace radiosity::truth {
namespace {

std::vector<GaussPoint> makeRule(int n) {
  std::vector<GaussPoint> rule;
  for (int k = 0; k < n; ++k) {
    long double x = std::cos(std::numbers::pi_v<long double> * (k + 0.75L) / (n + 0.5L));
    long double slope = 0;
    for (int step = 0; step < 20; ++step) {
      long double p = 1;
      long double below = 0;
      for (int m = 0; m < n; ++m) {
        const long double above = ((2 * m + 1) * x * p - m * below) / (m + 1);
        below = p;
        p = above;
      }
      slope = n * (x * p - below) / (x * x - 1);
      x -= p / slope;
    }
    rule.push_back({(1 - x) / 2, 1 / ((1 - x * x) * slope * slope)});
  }
  return rule;
}

}  // namespace

const std::vector<GaussPoint>& gaussRule(int points) {
  static const std::vector<std::vector<GaussPoint>> rules = [] {
    std::vector<std::vector<GaussPoint>> all(33);
    for (int n = 1; n < int(all.size()); ++n) all[std::size_t(n)] = makeRule(n);
    return all;
  }();
  return rules.at(std::size_t(points));
}

}  // namespace radiosity::truth
