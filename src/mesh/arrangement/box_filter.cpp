#include "mesh/arrangement/box_filter.h"

#include <algorithm>
#include <cmath>

namespace radiosity {

namespace {

constexpr int kCells = 256;         // along each axis
constexpr double kMostCells = 512;  // in which one box is looked up

}  // namespace

BoxFilter::BoxFilter(const std::vector<Box3>& boxes) {
  for (const Box3& box : boxes) {
    bounds_.add(box.low);
    bounds_.add(box.high);
  }
  for (int k = 0; k < 3; ++k) {
    const double extent = bounds_.high[k] - bounds_.low[k];
    cells_per_metre_[k] = extent > 0 ? kCells / extent : 0.0;
  }
  for (const Box3& box : boxes) {
    all_ = all_ || forCells(box, [&](std::uint32_t key) {
             marked_.insert(key);
             return false;
           });
  }
}

template <class Visit>
bool BoxFilter::forCells(const Box3& box, const Visit& visit) const {
  std::uint32_t from[3];
  std::uint32_t to[3];
  double count = 1;
  for (int k = 0; k < 3; ++k) {
    const auto cell = [&](double x) {
      const double c = std::floor((x - bounds_.low[k]) * cells_per_metre_[k]);
      return std::uint32_t(std::clamp(c, 0.0, double(kCells - 1)));
    };
    from[k] = cell(box.low[k]);
    to[k] = cell(box.high[k]);
    count *= to[k] - from[k] + 1;
  }
  if (count > kMostCells) return true;
  for (std::uint32_t x = from[0]; x <= to[0]; ++x) {
    for (std::uint32_t y = from[1]; y <= to[1]; ++y) {
      for (std::uint32_t z = from[2]; z <= to[2]; ++z) {
        if (visit((x * kCells + y) * kCells + z)) return true;
      }
    }
  }
  return false;
}

bool BoxFilter::mayMeet(const Box3& box) const {
  if (!box.meets(bounds_)) return false;
  return all_ || forCells(box, [&](std::uint32_t key) { return marked_.count(key) > 0; });
}

}  // namespace radiosity
