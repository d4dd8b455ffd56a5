// The kernels of far_kernels.h for any vector: included by the scalar twin, and once for every
// instruction set. Deliberately without #pragma once: each set has its own namespace.
#include "formfactor/exact/far_kernels.h"
#include "formfactor/exact/lanes.h"
#include "formfactor/exact/quadrature.h"

// NOLINTBEGIN(google-build-using-namespace)
namespace RADIOSITY_FAR_NAMESPACE {
namespace {

// Plain numbers' operations; those of vectors are found by their arguments.
using namespace radiosity::lanes;

template <class T>
inline constexpr std::size_t kMostLanes = 64 / sizeof(T);

/// Sum of weight / s^2 over the column's points for one point of the row, with one division for two
/// points. `count` is a multiple of the number of lanes.
template <class T, class D, class V>
RADIOSITY_FAR_INLINE V sumOverColumn(D d, const T* at_u, const T* at_v, const T* weight,
                                     std::size_t count, V u, V v, V height2) {
  const std::size_t lanes = Lanes(d);
  const auto square = [&](std::size_t i) RADIOSITY_FAR_ATTR {
    const auto x = Sub(LoadU(d, at_u + i), u);
    const auto y = Sub(LoadU(d, at_v + i), v);
    const auto s = Add(Add(Mul(x, x), Mul(y, y)), height2);
    return Mul(s, s);
  };
  auto sum = Zero(d);
  std::size_t i = 0;
  for (; i + lanes < count; i += 2 * lanes) {
    const auto a = square(i);
    const auto b = square(i + lanes);
    const auto both = Add(Mul(LoadU(d, weight + i), b), Mul(LoadU(d, weight + i + lanes), a));
    sum = Add(sum, Div(both, Mul(a, b)));
  }
  if (i < count) sum = Add(sum, Div(LoadU(d, weight + i), square(i)));
  return sum;
}

/// Mean of p q / s^2 over n x n points on both elements, times s^2 of the centroids, for one vector
/// of columns. `du`, `dv`: from the row's centroid to the columns'; `inverse`: 1 / s.
template <class T, class D, class V>
RADIOSITY_FAR_INLINE V productMean(D d, FarRow<T>& row, const FarBatch<T>& batch, std::size_t k,
                                   int n, V du, V dv, V height, V inverse) {
  const auto load = [&](FarField field) RADIOSITY_FAR_ATTR {
    return LoadU(d, batch.columns->field(field) + batch.first + k);
  };
  constexpr std::size_t kMostPoints = std::size_t(kMostProduct) * kMostProduct;
  alignas(64) T at_u[kMostPoints * kMostLanes<T>];
  alignas(64) T at_v[kMostPoints * kMostLanes<T>];
  alignas(64) T weight[kMostPoints * kMostLanes<T>];
  const std::size_t lanes = Lanes(d);
  const auto slope_u = Set(d, row.slope_u);
  const auto slope_v = Set(d, row.slope_v);
  const auto zero = Zero(d);
  // Lengths in units of the distance: products of squares stay within single precision's range.
  const auto scale = Sqrt(inverse);
  std::size_t m = 0;
  for (const Node& s : gaussLegendre(n)) {
    const auto ss = Set(d, T(s.x));
    const auto base_u = Add(load(kMeanU), Mul(ss, load(kAxisUU)));
    const auto base_v = Add(load(kMeanV), Mul(ss, load(kAxisUV)));
    const auto along_u = Add(load(kAxisVU), Mul(ss, load(kTwistU)));
    const auto along_v = Add(load(kAxisVV), Mul(ss, load(kTwistV)));
    const auto density = Add(Set(d, T(1)), Mul(ss, load(kAlpha)));
    const auto beta = load(kBeta);
    for (const Node& t : gaussLegendre(n)) {
      const auto tt = Set(d, T(t.x));
      const auto u = Add(base_u, Mul(tt, along_u));
      const auto v = Add(base_v, Mul(tt, along_v));
      const auto above = Add(height, Add(Mul(slope_u, u), Mul(slope_v, v)));
      const auto share = Mul(Set(d, T(0.25 * s.weight * t.weight)), Add(density, Mul(tt, beta)));
      StoreU(Mul(scale, Add(du, u)), d, at_u + m);
      StoreU(Mul(scale, Add(dv, v)), d, at_v + m);
      StoreU(Mul(share, Max(above, zero)), d, weight + m);
      m += lanes;
    }
  }
  const auto& points = row.points(n);
  auto sum = zero;
  const std::size_t begin = pointsBegin(n);
  for (std::size_t j = begin; j < begin + std::size_t(n) * n; ++j) {
    const auto inner =
        sumOverColumn(d, at_u, at_v, weight, m, Mul(scale, Set(d, points.u[j])),
                      Mul(scale, Set(d, points.v[j])), Mul(inverse, Set(d, points.height2[j])));
    sum = Add(sum, Mul(Set(d, points.weight[j]), inner));
  }
  return sum;
}

/// See FarFunction.
template <class T, class D>
std::size_t farRow(D d, FarRow<T>& row, const FarBatch<T>& batch, const ProductLimits<T>& limits) {
  const std::size_t lanes = Lanes(d);
  const auto one = Set(d, T(1));
  const auto two = Set(d, T(2));
  const auto four = Set(d, T(4));
  const auto eight = Set(d, T(8));
  const auto twelve = Set(d, T(12));
  const auto twenty_four = Set(d, T(24));
  const auto zero = Zero(d);
  const auto q = Set(d, row.height);
  const auto q2 = Set(d, row.height * row.height);
  const auto p_constant = Set(d, -row.height * row.p[2]);
  const auto q_constant = Set(d, -row.height * row.q[2]);
  std::size_t near = 0;
  for (std::size_t k = 0; k < batch.count; k += lanes) {
    const auto load = [&](FarField field) RADIOSITY_FAR_ATTR {
      return LoadU(d, batch.columns->field(field) + batch.first + k);
    };
    const auto p = LoadU(d, batch.heights + k);
    const auto du =
        Add(Sub(load(kCentreUHigh), Set(d, row.u_high)), Sub(load(kCentreULow), Set(d, row.u_low)));
    const auto dv =
        Add(Sub(load(kCentreVHigh), Set(d, row.v_high)), Sub(load(kCentreVLow), Set(d, row.v_low)));
    const auto s = Add(Add(Mul(du, du), Mul(dv, dv)), q2);
    const auto inverse = Div(one, s);

    // r along the moment vectors of the column and of the row.
    const auto column_pu = load(kMomentPU);
    const auto column_pv = load(kMomentPV);
    const auto column_q = load(kMomentQ);
    const auto r_cp = Add(Mul(du, column_pu), Mul(dv, column_pv));
    const auto r_cq = Mul(dv, column_q);
    const auto r_rp = Add(Add(Mul(du, Set(d, row.p[0])), Mul(dv, Set(d, row.p[1]))), p_constant);
    const auto r_rq = Add(Add(Mul(du, Set(d, row.q[0])), Mul(dv, Set(d, row.q[1]))), q_constant);
    // The other's normal along them.
    const auto n_cp = Add(Mul(Set(d, row.slope_u), column_pu), Mul(Set(d, row.slope_v), column_pv));
    const auto n_cq = Mul(Set(d, row.slope_v), column_q);
    const auto c_column = Add(Mul(n_cp, r_cp), Mul(n_cq, r_cq));
    const auto c_row = Add(Mul(Set(d, row.p[2]), r_rp), Mul(Set(d, row.q[2]), r_rq));
    const auto cross_u = Mul(n_cp, column_pu);
    const auto cross_v = Add(Mul(n_cp, column_pv), Mul(n_cq, column_q));
    const auto x = Add(Mul(Set(d, row.cross_u), cross_u), Mul(Set(d, row.cross_v), cross_v));

    const auto e =
        Add(Add(Mul(r_cp, r_cp), Mul(r_cq, r_cq)), Add(Mul(r_rp, r_rp), Mul(r_rq, r_rq)));
    const auto twelve_e = Mul(twelve, Mul(e, inverse));
    const auto m = Add(Set(d, row.moment), load(kMoment));
    const auto pq = Mul(p, q);
    const auto p_row = Mul(p, c_row);
    const auto q_column = Mul(q, c_column);
    const auto both = Sub(Mul(four, x), Mul(twenty_four, Mul(Mul(c_row, c_column), inverse)));
    const auto corrections =
        Add(Add(Mul(pq, Sub(twelve_e, Mul(two, m))), Mul(four, Sub(p_row, q_column))), both);
    const auto magnitude = Mul(inverse, Add(Add(Mul(pq, Add(twelve_e, Mul(four, m))),
                                                Mul(eight, Add(Abs(p_row), Abs(q_column)))),
                                            Mul(four, Abs(both))));

    const auto areas = Mul(Set(d, row.area_over_pi), load(kArea));
    auto value = Add(pq, Mul(inverse, corrections));  // times s^2
    const auto limit = Min(Set(d, row.series_limit), load(kSeriesLimit));
    auto open = AndNot(Le(magnitude, Mul(limit, pq)),
                       FirstN(d, batch.count - k < lanes ? batch.count - k : lanes));
    const auto skew = Max(Set(d, row.skew), load(kSkew));
    for (int n = kLeastProduct; n <= kMostProduct && !AllFalse(d, open); ++n) {
      const auto rule = std::size_t(n - kLeastProduct);
      const auto rule_limit =
          Add(Set(d, limits.plain[rule]), Mul(skew, Set(d, limits.skew_part[rule])));
      const auto good = And(open, Le(magnitude, Mul(rule_limit, pq)));
      if (AllFalse(d, good)) continue;
      value = IfThenElse(good, productMean(d, row, batch, k, n, du, dv, p, inverse), value);
      open = AndNot(good, open);
    }
    value = Mul(Mul(areas, Mul(inverse, inverse)), Max(value, zero));
    if (!AllFalse(d, open)) {
      value = IfThenElse(open, Set(d, T(kNearPair)), value);
      near += CountTrue(d, open);
    }
    StoreU(value, d, batch.values + k);
  }
  return near;
}

}  // namespace
}  // namespace RADIOSITY_FAR_NAMESPACE
// NOLINTEND(google-build-using-namespace)
