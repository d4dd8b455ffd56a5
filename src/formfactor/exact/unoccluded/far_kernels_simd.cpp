#include "formfactor/exact/unoccluded/far_kernels.h"
#include "formfactor/exact/unoccluded/far_rules.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "formfactor/exact/unoccluded/far_kernels_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which compiles this file once per instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace radiosity::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <class T>
inline constexpr std::size_t kMostLanes = 64 / sizeof(T);

/// Sum of weight / s^2 over the column's points for one point of the row, with one division for two
/// points. `count` is a multiple of the number of lanes.
template <class T, class D, class V>
HWY_INLINE V sumOverColumn(D d, const T* at_u, const T* at_v, const T* weight, std::size_t count,
                           V u, V v, V height2) {
  const std::size_t lanes = hn::Lanes(d);
  const auto square = [&](std::size_t i) HWY_ATTR {
    const auto x = hn::Sub(hn::LoadU(d, at_u + i), u);
    const auto y = hn::Sub(hn::LoadU(d, at_v + i), v);
    const auto s = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), height2);
    return hn::Mul(s, s);
  };
  auto sum = hn::Zero(d);
  std::size_t i = 0;
  for (; i + lanes < count; i += 2 * lanes) {
    const auto a = square(i);
    const auto b = square(i + lanes);
    const auto both =
        hn::Add(hn::Mul(hn::LoadU(d, weight + i), b), hn::Mul(hn::LoadU(d, weight + i + lanes), a));
    sum = hn::Add(sum, hn::Div(both, hn::Mul(a, b)));
  }
  if (i < count) sum = hn::Add(sum, hn::Div(hn::LoadU(d, weight + i), square(i)));
  return sum;
}

/// The position of a vector of columns relative to the row.
template <class V>
struct Separation {
  V du, dv;   // from the row's centroid to the columns', along the columns' plane
  V inverse;  // 1 / s
  V height;   // p
};

template <class T, class D>
HWY_INLINE auto separation(D d, const FarRow<T>& row, const FarBatch<T>& batch, std::size_t k) {
  const auto load = [&](FarField field) HWY_ATTR {
    return hn::LoadU(d, batch.columns->field(field) + batch.first + k);
  };
  const auto du = hn::Add(hn::Sub(load(kCentreUHigh), hn::Set(d, row.u_high)),
                          hn::Sub(load(kCentreULow), hn::Set(d, row.u_low)));
  const auto dv = hn::Add(hn::Sub(load(kCentreVHigh), hn::Set(d, row.v_high)),
                          hn::Sub(load(kCentreVLow), hn::Set(d, row.v_low)));
  const auto s =
      hn::Add(hn::Add(hn::Mul(du, du), hn::Mul(dv, dv)), hn::Set(d, row.height * row.height));
  using V = decltype(hn::Zero(d));
  return Separation<V>{du, dv, hn::Div(hn::Set(d, T(1)), s), hn::LoadU(d, batch.heights + k)};
}

/// Mean of p q / s^2 over both elements by a rule, times s^2 of the centroids, for one vector of
/// columns.
template <class T, class D, class V>
HWY_INLINE V ruleMean(D d, FarRow<T>& row, const FarBatch<T>& batch, std::size_t k,
                      const FarRule& rule, const Separation<V>& from_row) {
  const auto load = [&](FarField field) HWY_ATTR {
    return hn::LoadU(d, batch.columns->field(field) + batch.first + k);
  };
  constexpr std::size_t kMost = FarRule::kMostPoints * kMostLanes<T>;
  alignas(64) T at_u[kMost];
  alignas(64) T at_v[kMost];
  alignas(64) T weight[3][kMost];
  const std::size_t lanes = hn::Lanes(d);
  const auto slope_u = hn::Set(d, row.slope_u);
  const auto slope_v = hn::Set(d, row.slope_v);
  const auto zero = hn::Zero(d);
  const auto one = hn::Set(d, T(1));
  const auto mean_u = hn::Add(from_row.du, load(kMeanU));
  const auto mean_v = hn::Add(from_row.dv, load(kMeanV));
  const auto mean_height = hn::Add(
      from_row.height, hn::Add(hn::Mul(slope_u, load(kMeanU)), hn::Mul(slope_v, load(kMeanV))));
  // Lengths in units of the distance: products of squares stay within single precision's range.
  const auto scale = hn::Sqrt(from_row.inverse);
  for (std::size_t i = 0; i < rule.count; ++i) {
    const auto s = hn::Set(d, T(rule.points[i].s));
    const auto t = hn::Set(d, T(rule.points[i].t));
    const auto u = hn::Add(hn::Mul(s, load(kAxisUU)),
                           hn::Mul(t, hn::Add(load(kAxisVU), hn::Mul(s, load(kTwistU)))));
    const auto v = hn::Add(hn::Mul(s, load(kAxisUV)),
                           hn::Mul(t, hn::Add(load(kAxisVV), hn::Mul(s, load(kTwistV)))));
    const auto above = hn::Add(mean_height, hn::Add(hn::Mul(slope_u, u), hn::Mul(slope_v, v)));
    const auto density = hn::Add(one, hn::Add(hn::Mul(s, load(kAlpha)), hn::Mul(t, load(kBeta))));
    const auto share = hn::Mul(density, hn::Max(above, zero));
    hn::StoreU(hn::Mul(scale, hn::Add(mean_u, u)), d, at_u + i * lanes);
    hn::StoreU(hn::Mul(scale, hn::Add(mean_v, v)), d, at_v + i * lanes);
    for (std::size_t set = 0; set < rule.weight_sets; ++set) {
      hn::StoreU(hn::Mul(hn::Set(d, T(rule.column_weight[set][i])), share), d,
                 weight[set] + i * lanes);
    }
  }
  const auto& points = row.points(rule);
  auto sum = zero;
  for (std::size_t j = 0; j < rule.count; ++j) {
    const std::size_t at = rule.begin + j;
    const auto inner = sumOverColumn(
        d, at_u, at_v, weight[rule.points[j].weights], rule.points[j].partners * lanes,
        hn::Mul(scale, hn::Set(d, points.u[at])), hn::Mul(scale, hn::Set(d, points.v[at])),
        hn::Mul(from_row.inverse, hn::Set(d, points.height2[at])));
    sum = hn::Add(sum, hn::Mul(hn::Set(d, points.weight[at]), inner));
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
HWY_INLINE Series<V> seriesMean(D d, const FarRow<T>& row, const FarBatch<T>& batch, std::size_t k,
                                const Separation<V>& from_row) {
  const auto load = [&](FarField field) HWY_ATTR {
    return hn::LoadU(d, batch.columns->field(field) + batch.first + k);
  };
  const auto set = [&](double value) HWY_ATTR { return hn::Set(d, T(value)); };
  const auto [du, dv, inverse, p] = from_row;
  const auto q = hn::Set(d, row.height);
  // r along the moment vectors of the column and of the row.
  const auto column_pu = load(kMomentPU);
  const auto column_pv = load(kMomentPV);
  const auto column_q = load(kMomentQ);
  const auto r_cp = hn::Add(hn::Mul(du, column_pu), hn::Mul(dv, column_pv));
  const auto r_cq = hn::Mul(dv, column_q);
  const auto r_rp =
      hn::Add(hn::Add(hn::Mul(du, hn::Set(d, row.p[0])), hn::Mul(dv, hn::Set(d, row.p[1]))),
              hn::Set(d, -row.height * row.p[2]));
  const auto r_rq =
      hn::Add(hn::Add(hn::Mul(du, hn::Set(d, row.q[0])), hn::Mul(dv, hn::Set(d, row.q[1]))),
              hn::Set(d, -row.height * row.q[2]));
  // The other's normal along them.
  const auto n_cp = hn::Add(hn::Mul(hn::Set(d, row.slope_u), column_pu),
                            hn::Mul(hn::Set(d, row.slope_v), column_pv));
  const auto n_cq = hn::Mul(hn::Set(d, row.slope_v), column_q);
  const auto c_column = hn::Add(hn::Mul(n_cp, r_cp), hn::Mul(n_cq, r_cq));
  const auto c_row =
      hn::Add(hn::Mul(hn::Set(d, row.p[2]), r_rp), hn::Mul(hn::Set(d, row.q[2]), r_rq));
  const auto cross_u = hn::Mul(n_cp, column_pu);
  const auto cross_v = hn::Add(hn::Mul(n_cp, column_pv), hn::Mul(n_cq, column_q));
  const auto x =
      hn::Add(hn::Mul(hn::Set(d, row.cross_u), cross_u), hn::Mul(hn::Set(d, row.cross_v), cross_v));

  const auto e = hn::Add(hn::Add(hn::Mul(r_cp, r_cp), hn::Mul(r_cq, r_cq)),
                         hn::Add(hn::Mul(r_rp, r_rp), hn::Mul(r_rq, r_rq)));
  const auto twelve_e = hn::Mul(set(12), hn::Mul(e, inverse));
  const auto m = hn::Add(hn::Set(d, row.moment), load(kMoment));
  const auto pq = hn::Mul(p, q);
  const auto p_row = hn::Mul(p, c_row);
  const auto q_column = hn::Mul(q, c_column);
  const auto both =
      hn::Sub(hn::Mul(set(4), x), hn::Mul(set(24), hn::Mul(hn::Mul(c_row, c_column), inverse)));
  const auto corrections = hn::Add(hn::Add(hn::Mul(pq, hn::Sub(twelve_e, hn::Mul(set(2), m))),
                                           hn::Mul(set(4), hn::Sub(p_row, q_column))),
                                   both);
  const auto magnitude =
      hn::Mul(inverse, hn::Add(hn::Add(hn::Mul(pq, hn::Add(twelve_e, hn::Mul(set(4), m))),
                                       hn::Mul(set(8), hn::Add(hn::Abs(p_row), hn::Abs(q_column)))),
                               hn::Mul(set(4), hn::Abs(both))));
  return {hn::Add(pq, hn::Mul(inverse, corrections)), magnitude, pq};
}

/// See FarFunction.
template <class T>
std::size_t farRow(FarRow<T>& row, const FarBatch<T>& batch, const RuleLimits<T>& limits) {
  // At most the padding's width, so that whole vectors never leave an array.
  const hn::CappedTag<T, kFarPadding> d;
  const std::size_t lanes = hn::Lanes(d);
  const auto rules = farRules();
  std::size_t near = 0;
  for (std::size_t k = 0; k < batch.count; k += lanes) {
    const auto load = [&](FarField field) HWY_ATTR {
      return hn::LoadU(d, batch.columns->field(field) + batch.first + k);
    };
    const auto from_row = separation(d, row, batch, k);
    const auto series = seriesMean(d, row, batch, k, from_row);
    auto mean = series.mean;
    const auto limit = hn::Min(hn::Set(d, row.series_limit), load(kSeriesLimit));
    const std::size_t left = batch.count - k;
    auto open = hn::AndNot(hn::Le(series.magnitude, hn::Mul(limit, series.pq)),
                           hn::FirstN(d, left < lanes ? left : lanes));
    const auto skew = hn::Max(hn::Set(d, row.skew), load(kSkew));
    for (std::size_t r = 0; r < kFarRules && !hn::AllFalse(d, open); ++r) {
      const auto rule_limit =
          hn::Add(hn::Set(d, limits.plain[r]), hn::Mul(skew, hn::Set(d, limits.skew_part[r])));
      const auto good = hn::And(open, hn::Le(series.magnitude, hn::Mul(rule_limit, series.pq)));
      if (hn::AllFalse(d, good)) continue;
      mean = hn::IfThenElse(good, ruleMean(d, row, batch, k, rules[r], from_row), mean);
      open = hn::AndNot(good, open);
    }
    const auto areas = hn::Mul(hn::Set(d, row.area_over_pi), load(kArea));
    const auto inverse2 = hn::Mul(from_row.inverse, from_row.inverse);
    auto value = hn::Mul(hn::Mul(areas, inverse2), hn::Max(mean, hn::Zero(d)));
    if (!hn::AllFalse(d, open)) {
      value = hn::IfThenElse(open, hn::Set(d, T(kNearPair)), value);
      near += hn::CountTrue(d, open);
    }
    hn::StoreU(value, d, batch.values + k);
  }
  return near;
}

FarKernels kernels() { return {hwy::TargetName(HWY_TARGET), farRow<float>, farRow<double>}; }

}  // namespace
}  // namespace radiosity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace radiosity {

HWY_EXPORT(kernels);

FarKernels farKernels(bool simd) {
  return (simd ? HWY_DYNAMIC_DISPATCH(kernels) : HWY_CHOOSE_FALLBACK(kernels))();
}

}  // namespace radiosity
#endif
