// The kernels of far_kernels.h for any vector: included by the scalar twin, and once for every
// instruction set. Deliberately without #pragma once: each set has its own namespace.
#include "formfactor/exact/lanes.h"
#include "formfactor/exact/unoccluded/far_kernels.h"
#include "formfactor/exact/unoccluded/far_rules.h"

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

/// Where a vector of columns lies of the row.
template <class V>
struct Separation {
  V du, dv;   // from the row's centroid to the columns', along the columns' plane
  V inverse;  // 1 / s
  V height;   // p
};

template <class T, class D>
RADIOSITY_FAR_INLINE auto separation(D d, const FarRow<T>& row, const FarBatch<T>& batch,
                                     std::size_t k) {
  const auto load = [&](FarField field) RADIOSITY_FAR_ATTR {
    return LoadU(d, batch.columns->field(field) + batch.first + k);
  };
  const auto du =
      Add(Sub(load(kCentreUHigh), Set(d, row.u_high)), Sub(load(kCentreULow), Set(d, row.u_low)));
  const auto dv =
      Add(Sub(load(kCentreVHigh), Set(d, row.v_high)), Sub(load(kCentreVLow), Set(d, row.v_low)));
  const auto s = Add(Add(Mul(du, du), Mul(dv, dv)), Set(d, row.height * row.height));
  using V = decltype(Zero(d));
  return Separation<V>{du, dv, Div(Set(d, T(1)), s), LoadU(d, batch.heights + k)};
}

/// Mean of p q / s^2 over both elements by a rule, times s^2 of the centroids, for one vector of
/// columns.
template <class T, class D, class V>
RADIOSITY_FAR_INLINE V ruleMean(D d, FarRow<T>& row, const FarBatch<T>& batch, std::size_t k,
                                const FarRule& rule, const Separation<V>& from_row) {
  const auto load = [&](FarField field) RADIOSITY_FAR_ATTR {
    return LoadU(d, batch.columns->field(field) + batch.first + k);
  };
  constexpr std::size_t kMost = FarRule::kMostPoints * kMostLanes<T>;
  alignas(64) T at_u[kMost];
  alignas(64) T at_v[kMost];
  alignas(64) T weight[3][kMost];
  const std::size_t lanes = Lanes(d);
  const auto slope_u = Set(d, row.slope_u);
  const auto slope_v = Set(d, row.slope_v);
  const auto zero = Zero(d);
  const auto one = Set(d, T(1));
  const auto mean_u = Add(from_row.du, load(kMeanU));
  const auto mean_v = Add(from_row.dv, load(kMeanV));
  const auto mean_height =
      Add(from_row.height, Add(Mul(slope_u, load(kMeanU)), Mul(slope_v, load(kMeanV))));
  // Lengths in units of the distance: products of squares stay within single precision's range.
  const auto scale = Sqrt(from_row.inverse);
  for (std::size_t i = 0; i < rule.count; ++i) {
    const auto s = Set(d, T(rule.points[i].s));
    const auto t = Set(d, T(rule.points[i].t));
    const auto u = Add(Mul(s, load(kAxisUU)), Mul(t, Add(load(kAxisVU), Mul(s, load(kTwistU)))));
    const auto v = Add(Mul(s, load(kAxisUV)), Mul(t, Add(load(kAxisVV), Mul(s, load(kTwistV)))));
    const auto above = Add(mean_height, Add(Mul(slope_u, u), Mul(slope_v, v)));
    const auto density = Add(one, Add(Mul(s, load(kAlpha)), Mul(t, load(kBeta))));
    const auto share = Mul(density, Max(above, zero));
    StoreU(Mul(scale, Add(mean_u, u)), d, at_u + i * lanes);
    StoreU(Mul(scale, Add(mean_v, v)), d, at_v + i * lanes);
    for (std::size_t set = 0; set < rule.weight_sets; ++set) {
      StoreU(Mul(Set(d, T(rule.column_weight[set][i])), share), d, weight[set] + i * lanes);
    }
  }
  const auto& points = row.points(rule);
  auto sum = zero;
  for (std::size_t j = 0; j < rule.count; ++j) {
    const std::size_t at = rule.begin + j;
    const auto inner = sumOverColumn(
        d, at_u, at_v, weight[rule.points[j].weights], rule.points[j].partners * lanes,
        Mul(scale, Set(d, points.u[at])), Mul(scale, Set(d, points.v[at])),
        Mul(from_row.inverse, Set(d, points.height2[at])));
    sum = Add(sum, Mul(Set(d, points.weight[at]), inner));
  }
  return sum;
}

/// The second-order series, see far_kernels.h.
template <class V>
struct Series {
  V mean;       // of p q / s^2, times s^2 of the centroids
  V magnitude;  // R p q
  V pq;
};

template <class T, class D, class V>
RADIOSITY_FAR_INLINE Series<V> seriesMean(D d, const FarRow<T>& row, const FarBatch<T>& batch,
                                          std::size_t k, const Separation<V>& from_row) {
  const auto load = [&](FarField field) RADIOSITY_FAR_ATTR {
    return LoadU(d, batch.columns->field(field) + batch.first + k);
  };
  const auto set = [&](double value) RADIOSITY_FAR_ATTR { return Set(d, T(value)); };
  const auto [du, dv, inverse, p] = from_row;
  const auto q = Set(d, row.height);
  // r along the moment vectors of the column and of the row.
  const auto column_pu = load(kMomentPU);
  const auto column_pv = load(kMomentPV);
  const auto column_q = load(kMomentQ);
  const auto r_cp = Add(Mul(du, column_pu), Mul(dv, column_pv));
  const auto r_cq = Mul(dv, column_q);
  const auto r_rp = Add(Add(Mul(du, Set(d, row.p[0])), Mul(dv, Set(d, row.p[1]))),
                        Set(d, -row.height * row.p[2]));
  const auto r_rq = Add(Add(Mul(du, Set(d, row.q[0])), Mul(dv, Set(d, row.q[1]))),
                        Set(d, -row.height * row.q[2]));
  // The other's normal along them.
  const auto n_cp = Add(Mul(Set(d, row.slope_u), column_pu), Mul(Set(d, row.slope_v), column_pv));
  const auto n_cq = Mul(Set(d, row.slope_v), column_q);
  const auto c_column = Add(Mul(n_cp, r_cp), Mul(n_cq, r_cq));
  const auto c_row = Add(Mul(Set(d, row.p[2]), r_rp), Mul(Set(d, row.q[2]), r_rq));
  const auto cross_u = Mul(n_cp, column_pu);
  const auto cross_v = Add(Mul(n_cp, column_pv), Mul(n_cq, column_q));
  const auto x = Add(Mul(Set(d, row.cross_u), cross_u), Mul(Set(d, row.cross_v), cross_v));

  const auto e = Add(Add(Mul(r_cp, r_cp), Mul(r_cq, r_cq)), Add(Mul(r_rp, r_rp), Mul(r_rq, r_rq)));
  const auto twelve_e = Mul(set(12), Mul(e, inverse));
  const auto m = Add(Set(d, row.moment), load(kMoment));
  const auto pq = Mul(p, q);
  const auto p_row = Mul(p, c_row);
  const auto q_column = Mul(q, c_column);
  const auto both = Sub(Mul(set(4), x), Mul(set(24), Mul(Mul(c_row, c_column), inverse)));
  const auto corrections =
      Add(Add(Mul(pq, Sub(twelve_e, Mul(set(2), m))), Mul(set(4), Sub(p_row, q_column))), both);
  const auto magnitude = Mul(inverse, Add(Add(Mul(pq, Add(twelve_e, Mul(set(4), m))),
                                              Mul(set(8), Add(Abs(p_row), Abs(q_column)))),
                                          Mul(set(4), Abs(both))));
  return {Add(pq, Mul(inverse, corrections)), magnitude, pq};
}

/// See FarFunction.
template <class T, class D>
std::size_t farRow(D d, FarRow<T>& row, const FarBatch<T>& batch, const RuleLimits<T>& limits) {
  const std::size_t lanes = Lanes(d);
  const auto rules = farRules();
  std::size_t near = 0;
  for (std::size_t k = 0; k < batch.count; k += lanes) {
    const auto load = [&](FarField field) RADIOSITY_FAR_ATTR {
      return LoadU(d, batch.columns->field(field) + batch.first + k);
    };
    const auto from_row = separation(d, row, batch, k);
    const auto series = seriesMean(d, row, batch, k, from_row);
    auto mean = series.mean;
    const auto limit = Min(Set(d, row.series_limit), load(kSeriesLimit));
    const std::size_t left = batch.count - k;
    auto open =
        AndNot(Le(series.magnitude, Mul(limit, series.pq)), FirstN(d, left < lanes ? left : lanes));
    const auto skew = Max(Set(d, row.skew), load(kSkew));
    for (std::size_t r = 0; r < kFarRules && !AllFalse(d, open); ++r) {
      const auto rule_limit = Add(Set(d, limits.plain[r]), Mul(skew, Set(d, limits.skew_part[r])));
      const auto good = And(open, Le(series.magnitude, Mul(rule_limit, series.pq)));
      if (AllFalse(d, good)) continue;
      mean = IfThenElse(good, ruleMean(d, row, batch, k, rules[r], from_row), mean);
      open = AndNot(good, open);
    }
    const auto areas = Mul(Set(d, row.area_over_pi), load(kArea));
    const auto inverse2 = Mul(from_row.inverse, from_row.inverse);
    auto value = Mul(Mul(areas, inverse2), Max(mean, Zero(d)));
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
