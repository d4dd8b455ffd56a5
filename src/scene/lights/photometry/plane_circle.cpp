#include "scene/lights/photometry/plane_circle.h"

#include <algorithm>
#include <cmath>

namespace radiosity {

namespace {

constexpr double kCircle = 360;
constexpr double kSamePlane = 1e-9;  // degrees: rounding of sums of angles

double onCircle(double angle) {
  const double turned = angle - kCircle * std::floor(angle / kCircle);
  return turned > kCircle - kSamePlane ? 0 : turned;
}

}  // namespace

bool PlaneCircle::has(double angle) const {
  return std::ranges::any_of(
      planes_, [&](const Plane& plane) { return std::abs(plane.angle - angle) < kSamePlane; });
}

void PlaneCircle::add(double angle, std::vector<float> row) {
  planes_.push_back({onCircle(angle), std::move(row)});
}

void PlaneCircle::mirror(double plane) {
  const std::size_t count = planes_.size();
  for (std::size_t k = 0; k < count; ++k) {
    const double image = onCircle(2 * plane - planes_[k].angle);
    if (!has(image)) planes_.push_back({image, planes_[k].row});
  }
}

void PlaneCircle::fill(Photometry& table) {
  std::ranges::sort(planes_, {}, &Plane::angle);
  if (planes_.front().angle > 0) {
    const Plane& after = planes_.front();
    const Plane& before = planes_.back();
    const double off = kCircle - before.angle;
    const double share = off / (off + after.angle);
    std::vector<float> row(after.row.size());
    for (std::size_t k = 0; k < row.size(); ++k) {
      row[k] = float((1 - share) * double(before.row[k]) + share * double(after.row[k]));
    }
    planes_.insert(planes_.begin(), {0, std::move(row)});
  }
  planes_.push_back({kCircle, planes_.front().row});
  table.horizontal.clear();
  table.candela.clear();
  for (const Plane& plane : planes_) {
    table.horizontal.push_back(plane.angle);
    table.candela.insert(table.candela.end(), plane.row.begin(), plane.row.end());
  }
}

}  // namespace radiosity
