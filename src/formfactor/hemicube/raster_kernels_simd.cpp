#include "formfactor/hemicube/raster_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "formfactor/hemicube/raster_kernels_simd.cpp"
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

void cross(const EdgeRows& edge, std::int32_t* crossings) {
  const hn::CappedTag<double, kRowAlignment> dd;
  const hn::Rebind<std::int32_t, decltype(dd)> di;
  const int lanes = int(hn::Lanes(dd));
  const auto low_x = hn::Set(dd, edge.low_x);
  const auto low_y = hn::Set(dd, edge.low_y);
  const auto slope = hn::Set(dd, edge.slope);
  const auto half = hn::Set(dd, 0.5);
  const auto zero = hn::Zero(dd);
  const auto columns = hn::Set(dd, double(edge.columns));
  const auto step = hn::Set(dd, double(lanes));
  const int count = edge.end - edge.first;
  auto centre = hn::Add(hn::Iota(dd, 0.0), hn::Set(dd, edge.first + 0.5));
  for (int k = 0; k < count; k += lanes) {
    const auto along = hn::Mul(hn::Sub(centre, low_y), slope);
    const auto x = hn::Sub(hn::Add(low_x, along), half);
    const auto right = hn::IfThenElseZero(hn::Gt(x, zero), x);
    const auto inside = hn::IfThenElse(hn::Lt(right, columns), right, columns);
    const auto pixel = hn::DemoteTo(di, hn::Ceil(inside));
    if (k + lanes <= count) {
      hn::StoreU(pixel, di, crossings + k);
    } else {
      hn::BlendedStore(pixel, hn::FirstN(di, std::size_t(count - k)), di, crossings + k);
    }
    centre = hn::Add(centre, step);
  }
}

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
template <bool kAnyOrder, class Mask>
HWY_INLINE void fillVector(hn::Vec<Floats> depth, hn::Vec<Words> item, Mask inside, float* depth_at,
                           std::uint32_t* item_at) {
  const Floats df;
  const Words dw;
  const auto old_depth = hn::Load(df, depth_at);
  const auto old_item = hn::Load(dw, item_at);
  auto nearer = hn::Gt(depth, old_depth);
  if constexpr (kAnyOrder) {
    const auto lower = hn::RebindMask(df, hn::Lt(item, old_item));
    nearer = hn::Or(nearer, hn::And(hn::Eq(depth, old_depth), lower));
  }
  nearer = hn::And(nearer, inside);
  hn::Store(hn::IfThenElse(nearer, depth, old_depth), df, depth_at);
  hn::Store(hn::IfThenElse(hn::RebindMask(dw, nearer), item, old_item), dw, item_at);
}

template <bool kAnyOrder>
void fillSpans(const FillTarget& target, const Span* spans, std::size_t count, float slope,
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
      fillVector<kAnyOrder>(depths(), items, inside, depth + x, ids + x);
      continue;
    }
    fillVector<kAnyOrder>(depths(), items, hn::AndNot(left_out, all), depth + x, ids + x);
    x += lanes;
    centre = hn::Add(centre, step);
    for (; x + lanes <= span.end; x += lanes) {
      fillVector<kAnyOrder>(depths(), items, all, depth + x, ids + x);
      centre = hn::Add(centre, step);
    }
    if (x < span.end) {
      fillVector<kAnyOrder>(depths(), items, hn::FirstN(df, std::size_t(span.end - x)), depth + x,
                            ids + x);
    }
  }
}

std::size_t findRuns(const std::uint32_t* values, int count, std::int32_t* starts) {
  const Words dw;
  const Ints di;
  const int lanes = int(hn::Lanes(dw));
  std::size_t found = 0;
  starts[found++] = 0;
  // Counted on by hand: Iota from a variable goes through memory.
  auto pixel = hn::Add(hn::Iota(di, 0), hn::Set(di, 1));
  const auto step = hn::Set(di, lanes);
  int x = 1;
  for (; x + lanes <= count; x += lanes) {
    const auto differs = hn::Ne(hn::LoadU(dw, values + x), hn::LoadU(dw, values + x - 1));
    // Not CompressStore: with the memory as its target it takes several times as long.
    hn::StoreU(hn::Compress(pixel, hn::RebindMask(di, differs)), di, starts + found);
    found += hn::CountTrue(dw, differs);
    pixel = hn::Add(pixel, step);
  }
  for (; x < count; ++x) {
    if (values[x] != values[x - 1]) starts[found++] = x;
  }
  starts[found] = count;
  return found;
}

/// The lanes moved up by one, the last one to the bottom.
HWY_INLINE hn::Vec<Floats> rotateUp(hn::Vec<Floats> v) {
  const Floats df;
  const Ints di;
  const auto last = hn::Set(di, std::int32_t(hn::Lanes(df)) - 1);  // lanes: a power of two
  return hn::TableLookupLanes(
      v, hn::IndicesFromVec(df, hn::And(hn::Add(hn::Iota(di, 0), last), last)));
}

std::size_t locate(const RowMap& map, int begin, int end, std::int32_t* starts,
                   std::int32_t* cells) {
  const Floats df;
  const Ints di;
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
  auto pixel = hn::Add(hn::Iota(di, 0), hn::Set(di, begin));
  const auto first_cell = hn::Set(di, map.first_cell);
  const auto pixel_step = hn::Set(di, lanes);
  auto centre = hn::Add(hn::Iota(df, 0.0F), hn::Set(df, float(begin) + map.first_centre));
  const auto bottom = hn::FirstN(df, 1);
  auto before = hn::Set(df, -1.0F);  // no cell: the first pixel starts a run
  std::size_t found = 0;
  const int count = end - begin;
  for (int x = 0; x < count; x += lanes) {
    const auto w = hn::Add(hn::Mul(w_slope, centre), w0);
    const auto scale = hn::Div(one, hn::Max(w, least_w));
    const auto u = hn::Mul(hn::Add(hn::Mul(u_slope, centre), u0), scale);
    const auto v = hn::Mul(hn::Add(hn::Mul(v_slope, centre), v0), scale);
    const auto cell = hn::Add(hn::Mul(whole(v, last_row), columns), whole(u, last_column));
    const auto rotated = rotateUp(cell);
    auto differs = hn::Ne(cell, hn::IfThenElse(bottom, before, rotated));
    if (count - x < lanes) differs = hn::And(differs, hn::FirstN(df, std::size_t(count - x)));
    const auto changes = hn::RebindMask(di, differs);
    hn::StoreU(hn::Compress(pixel, changes), di, starts + found);
    const auto number = hn::Add(hn::ConvertTo(di, cell), first_cell);
    hn::StoreU(hn::Compress(number, changes), di, cells + found);
    found += hn::CountTrue(df, differs);
    before = rotated;
    pixel = hn::Add(pixel, pixel_step);
    centre = hn::Add(centre, step);
  }
  return found;
}

RasterKernels kernels() {
  return {hwy::TargetName(HWY_TARGET),
          cross,
          clear,
          fillSpans<false>,
          fillSpans<true>,
          findRuns,
          locate};
}

}  // namespace
}  // namespace radiosity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace radiosity {

HWY_EXPORT(kernels);

RasterKernels rasterKernels(bool simd) {
  return (simd ? HWY_DYNAMIC_DISPATCH(kernels) : HWY_CHOOSE_FALLBACK(kernels))();
}

}  // namespace radiosity
#endif
