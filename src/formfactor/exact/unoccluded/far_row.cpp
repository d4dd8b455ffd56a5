#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "formfactor/exact/error_model.h"
#include "formfactor/exact/unoccluded/far_kernels.h"

namespace radiosity {

FarLimits::FarLimits(double tolerance) : tolerance_(tolerance) {}

FarBounds FarLimits::of(const FlatShape& shape) const {
  const double skew = std::abs(shape.alpha) + std::abs(shape.beta);
  FarBounds bounds{std::sqrt(tolerance_ / kSeriesError), std::min(kSkewFactor * skew, 1.0)};
  if (skew > 0) {
    bounds.series_limit =
        std::min(bounds.series_limit, std::pow(tolerance_ / (kSkewError * skew), 2.0 / 3.0));
  }
  return bounds;
}

static_assert(kRuleError.size() == kFarRules && kSkewRuleError.size() == kFarRules);

/// Skew above its inverse rules such a rule out.
constexpr double kRulesOutSkew = 64;

template <class T>
RuleLimits<T> FarLimits::rules() const {
  RuleLimits<T> limits{};
  for (std::size_t k = 0; k < kFarRules; ++k) {
    const double order = farRules()[k].order;
    const double plain = std::pow(tolerance_ / kRuleError[k], 1 / order);
    limits.plain[k] = T(plain);
    if (kSkewRuleError[k] == kNever) {
      limits.skew_part[k] = T(-plain * kRulesOutSkew);
      continue;
    }
    const double skewed = std::pow(tolerance_ / kSkewRuleError[k], 1 / (order - 0.5));
    limits.skew_part[k] = T(std::min(skewed - plain, 0.0));
  }
  return limits;
}

template RuleLimits<float> FarLimits::rules() const;
template RuleLimits<double> FarLimits::rules() const;

template <class T>
FarRow<T>::FarRow(const FlatShape& shape, const FacetFrame& own, const FacetFrame& columns,
                  const FarBounds& bounds)
    : shape_(shape) {
  const auto turned = [&](const Vec2& d) {
    const Vec3 in_space = d.x * own.u + d.y * own.v;
    return Vec3(glm::dot(in_space, columns.u), glm::dot(in_space, columns.v),
                glm::dot(in_space, columns.normal));
  };
  const double u = glm::dot(shape.centroid, columns.u);
  const double v = glm::dot(shape.centroid, columns.v);
  u_high = T(u);
  u_low = T(u - double(u_high));
  v_high = T(v);
  v_low = T(v - double(v_high));
  exact_height_ = glm::dot(shape.centroid, columns.normal) - columns.offset;
  height = T(exact_height_);
  slope_u = T(glm::dot(own.normal, columns.u));
  slope_v = T(glm::dot(own.normal, columns.v));
  const Vec3 pp = turned(shape.p);
  const Vec3 qq = turned({0, shape.q});
  p = {T(pp.x), T(pp.y), T(pp.z)};
  q = {T(qq.x), T(qq.y), T(qq.z)};
  const Vec3 cross = pp.z * pp + qq.z * qq;
  cross_u = T(cross.x);
  cross_v = T(cross.y);
  moment = T(shape.moment);
  area_over_pi = T(shape.area / std::numbers::pi);
  series_limit = T(bounds.series_limit);
  skew = T(bounds.skew);
  map_ = {turned(shape.mean), turned(shape.u), turned(shape.v), turned(shape.w)};
}

template <class T>
const typename FarRow<T>::Points& FarRow<T>::points(const FarRule& rule) {
  if ((made_ >> rule.begin & 1U) != 0) return points_;
  made_ |= std::uint64_t(1) << rule.begin;
  for (std::size_t k = 0; k < rule.count; ++k) {
    const FarRule::Point& point = rule.points[k];
    const Vec3 at = map_[0] + point.s * map_[1] + point.t * (map_[2] + point.s * map_[3]);
    const double above = std::max(exact_height_ + at.z, 0.0);
    const double density = 1 + shape_.alpha * point.s + shape_.beta * point.t;
    points_.u[rule.begin + k] = T(at.x);
    points_.v[rule.begin + k] = T(at.y);
    points_.height2[rule.begin + k] = T(above * above);
    points_.weight[rule.begin + k] = T(point.row_weight * density * above);
  }
  return points_;
}

template struct FarRow<float>;
template struct FarRow<double>;

}  // namespace radiosity
