#include "formfactor/raster_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "formfactor/raster_kernels_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which compiles this file once per instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace radiosity::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// At most a row's alignment, so that whole vectors never leave a row.
using Floats = hn::CappedTag<float, kRowAlignment>;
using Ints = hn::RebindToSigned<Floats>;
using Words = hn::RebindToUnsigned<Floats>;

void clear(float* depth, std::uint32_t* items, std::size_t count) {
  const Floats df;
  const Words dw;
  const auto far = hn::Neg(hn::Inf(df));
  const auto sky = hn::Set(dw, kSky);
  for (std::size_t x = 0; x < count; x += hn::Lanes(df)) {
    hn::Store(far, df, depth + x);
    hn::Store(sky, dw, items + x);
  }
}

/// Pixels x to x + lanes of one row; only those of `inside`.
template <class Mask>
HWY_INLINE void fillVector(hn::Vec<Floats> depth, hn::Vec<Words> item, Mask inside, float* depth_at,
                           std::uint32_t* item_at) {
  const Floats df;
  const Words dw;
  const auto old_depth = hn::Load(df, depth_at);
  const auto nearer = hn::And(hn::Gt(depth, old_depth), inside);
  hn::Store(hn::IfThenElse(nearer, depth, old_depth), df, depth_at);
  const auto old_item = hn::Load(dw, item_at);
  hn::Store(hn::IfThenElse(hn::RebindMask(dw, nearer), item, old_item), dw, item_at);
}

void fill(const FillTarget& target, const Span* spans, std::size_t count, float slope,
          std::uint32_t item) {
  const Floats df;
  const int lanes = int(hn::Lanes(df));
  const auto slopes = hn::Set(df, slope);
  const auto first_centres = hn::Add(hn::Iota(df, 0.0F), hn::Set(df, target.first_centre));
  const auto step = hn::Set(df, float(lanes));
  const auto items = hn::Set(Words(), item);
  const auto all = hn::FirstN(df, std::size_t(lanes));
  for (std::size_t k = 0; k < count; ++k) {
    const Span& span = spans[k];
    const std::size_t row = std::size_t(span.y) * std::size_t(target.stride);
    float* depth = target.depth + row;
    std::uint32_t* ids = target.items + row;
    const auto base = hn::Set(df, span.inverse_depth);
    int x = span.begin & -lanes;
    // Whole numbers and a half below 2^23: exact, however they are added up.
    auto centre = hn::Add(first_centres, hn::Set(df, float(x)));
    const auto depths = [&]() HWY_ATTR { return hn::Add(hn::Mul(slopes, centre), base); };
    const auto left_out = hn::FirstN(df, std::size_t(span.begin - x));
    if (x + lanes >= span.end) {
      const auto inside = hn::AndNot(left_out, hn::FirstN(df, std::size_t(span.end - x)));
      fillVector(depths(), items, inside, depth + x, ids + x);
      continue;
    }
    fillVector(depths(), items, hn::AndNot(left_out, all), depth + x, ids + x);
    x += lanes;
    centre = hn::Add(centre, step);
    for (; x + lanes <= span.end; x += lanes) {
      fillVector(depths(), items, all, depth + x, ids + x);
      centre = hn::Add(centre, step);
    }
    if (x < span.end) {
      fillVector(depths(), items, hn::FirstN(df, std::size_t(span.end - x)), depth + x, ids + x);
    }
  }
}

std::size_t findRuns(const std::uint32_t* values, int count, std::int32_t* starts) {
  const Words dw;
  const Ints di;
  const int lanes = int(hn::Lanes(dw));
  std::size_t found = 0;
  starts[found++] = 0;
  int x = 1;
  for (; x + lanes <= count; x += lanes) {
    const auto differs = hn::Ne(hn::LoadU(dw, values + x), hn::LoadU(dw, values + x - 1));
    if (hn::AllFalse(dw, differs)) continue;
    found += hn::CompressStore(hn::Iota(di, x), hn::RebindMask(di, differs), di, starts + found);
  }
  for (; x < count; ++x) {
    if (values[x] != values[x - 1]) starts[found++] = x;
  }
  starts[found] = count;
  return found;
}

void locate(const RowMap& map, int begin, int end, float* cells) {
  // Whole vectors: what is written past `end` is overwritten by the row's next polygon.
  const Floats df;
  const int lanes = int(hn::Lanes(df));
  const auto u_slope = hn::Set(df, map.u_slope);
  const auto v_slope = hn::Set(df, map.v_slope);
  const auto w_slope = hn::Set(df, map.w_slope);
  const auto u0 = hn::Set(df, map.u);
  const auto v0 = hn::Set(df, map.v);
  const auto w0 = hn::Set(df, map.w);
  const auto one = hn::Set(df, 1.0F);
  const auto zero = hn::Zero(df);
  const auto least_w = hn::Set(df, kLeastW);
  const auto rounder = hn::Set(df, kRounder);
  const auto last_column = hn::Set(df, map.last_column);
  const auto last_row = hn::Set(df, map.last_row);
  const auto columns = hn::Set(df, map.columns);
  const auto step = hn::Set(df, float(lanes));
  // Nothing here can fail to be a number, W being positive: Min and Max are the same everywhere.
  const auto whole = [&](hn::Vec<Floats> value, hn::Vec<Floats> last) HWY_ATTR {
    const auto inside = hn::Min(hn::Max(value, zero), last);
    return hn::Sub(hn::Add(inside, rounder), rounder);
  };
  auto centre = hn::Add(hn::Iota(df, float(begin)), hn::Set(df, map.first_centre));
  for (int x = begin; x < end; x += lanes) {
    const auto w = hn::Add(hn::Mul(w_slope, centre), w0);
    const auto scale = hn::Div(one, hn::Max(w, least_w));
    const auto u = hn::Mul(hn::Add(hn::Mul(u_slope, centre), u0), scale);
    const auto v = hn::Mul(hn::Add(hn::Mul(v_slope, centre), v0), scale);
    const auto cell = hn::Add(hn::Mul(whole(v, last_row), columns), whole(u, last_column));
    hn::StoreU(cell, df, cells + x);
    centre = hn::Add(centre, step);
  }
}

RasterKernels kernels() { return {hwy::TargetName(HWY_TARGET), clear, fill, findRuns, locate}; }

}  // namespace
}  // namespace radiosity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace radiosity {

HWY_EXPORT(kernels);

RasterKernels simdKernels() { return HWY_DYNAMIC_DISPATCH(kernels)(); }

}  // namespace radiosity
#endif
