#include "formfactor/exact/unoccluded/far_columns.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace radiosity {

FlatShape flatShape(std::span<const Vec3> corners, const FacetFrame& frame) {
  FlatShape shape;
  // Relative to a corner, so that nothing cancels.
  std::array<Vec2, 4> c;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3 d = corners[std::min(k, corners.size() - 1)] - corners[0];
    c[k] = {glm::dot(d, frame.u), glm::dot(d, frame.v)};
  }
  const auto cross = [](const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; };
  shape.u = 0.25 * (c[1] - c[0] + c[2] - c[3]);
  shape.v = 0.25 * (c[3] - c[0] + c[2] - c[1]);
  shape.w = 0.25 * (c[0] - c[1] + c[2] - c[3]);
  const double jacobian = cross(shape.u, shape.v);
  shape.area = 4 * jacobian;
  shape.alpha = cross(shape.u, shape.w) / jacobian;
  shape.beta = cross(shape.w, shape.v) / jacobian;
  // Means over s and t of density times position: of s^2, t^2 and s^2 t^2 there remain 1/3 and 1/9.
  const double a = shape.alpha;
  const double b = shape.beta;
  shape.mean = -(a * shape.u + b * shape.v) / 3.0;
  const Vec3 base = corners[0];
  const Vec2 centroid = 0.25 * (c[0] + c[1] + c[2] + c[3]) - shape.mean;
  shape.centroid = base + centroid.x * frame.u + centroid.y * frame.v;
  shape.cu = glm::dot(shape.centroid, frame.u);
  shape.cv = glm::dot(shape.centroid, frame.v);

  // Moments of d = mean + s U + t V + s t W, with density 1 + a s + b t.
  const Vec2 &m = shape.mean, &u = shape.u, &v = shape.v, &w = shape.w;
  const auto moment = [&](int i, int j) {
    const double square = m[i] * m[j] + (u[i] * u[j] + v[i] * v[j]) / 3 + w[i] * w[j] / 9;
    const double skew = a * ((m[i] * u[j] + u[i] * m[j]) / 3 + (v[i] * w[j] + w[i] * v[j]) / 9) +
                        b * ((m[i] * v[j] + v[i] * m[j]) / 3 + (u[i] * w[j] + w[i] * u[j]) / 9);
    return square + skew;
  };
  const double uu = moment(0, 0);
  const double uv = moment(0, 1);
  const double vv = moment(1, 1);
  // Cholesky's factors.
  shape.p.x = std::sqrt(std::max(uu, 0.0));
  shape.p.y = shape.p.x > 0 ? uv / shape.p.x : 0;
  shape.q = std::sqrt(std::max(vv - shape.p.y * shape.p.y, 0.0));
  shape.moment = uu + vv;
  return shape;
}

template <class T>
void FarColumns<T>::set(std::size_t k, const FlatShape& shape, const FarBounds& bounds) {
  const auto put = [&](FarField field, double value) { fields_[field][k] = T(value); };
  const auto split = [&](FarField high, FarField low, double value) {
    put(high, value);
    put(low, value - double(T(value)));
  };
  split(kCentreUHigh, kCentreULow, shape.cu);
  split(kCentreVHigh, kCentreVLow, shape.cv);
  put(kMomentPU, shape.p.x);
  put(kMomentPV, shape.p.y);
  put(kMomentQ, shape.q);
  put(kMoment, shape.moment);
  put(kArea, shape.area);
  put(kSeriesLimit, bounds.series_limit);
  put(kSkew, bounds.skew);
  put(kMeanU, shape.mean.x);
  put(kMeanV, shape.mean.y);
  put(kAxisUU, shape.u.x);
  put(kAxisUV, shape.u.y);
  put(kAxisVU, shape.v.x);
  put(kAxisVV, shape.v.y);
  put(kTwistU, shape.w.x);
  put(kTwistV, shape.w.y);
  put(kAlpha, shape.alpha);
  put(kBeta, shape.beta);
}

template class FarColumns<float>;
template class FarColumns<double>;

}  // namespace radiosity
