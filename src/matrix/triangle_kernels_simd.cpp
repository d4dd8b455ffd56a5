#include "matrix/run_row.h"
#include "matrix/triangle_kernels.h"

// Vectors without a fixed size cannot stand in arrays.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matrix/triangle_kernels_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which compiles this file once per instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace radiosity::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, kSums>;
using Vector = hn::Vec<Doubles>;

constexpr std::size_t kWidth = hn::MaxLanes(Doubles());
constexpr std::size_t kVectors = kSums / kWidth;

Vector load(const double* values) { return hn::LoadU(Doubles(), values); }
Vector load(const float* values) {
  return hn::PromoteTo(Doubles(), hn::LoadU(hn::Rebind<float, Doubles>(), values));
}

/// One walk along the runs. Everything is a local variable: through members the compiler would have
/// to expect that writing z changes them.
template <int kBands, bool kGather, bool kHandOn, class Value>
void walkRuns(std::span<const Run> runs, const Value* HWY_RESTRICT values,
              const RowOperands& operands, const double* factor, double* sums) {
  const Doubles d;
  Vector scale[kBands];
  Vector sum[kBands][kVectors];
  for (int b = 0; b < kBands; ++b) {
    if constexpr (kHandOn) scale[b] = hn::Set(d, factor[b]);
    for (std::size_t v = 0; v < kVectors; ++v) sum[b][v] = hn::Zero(d);
  }
  const std::size_t x_stride = operands.x_stride;
  const std::size_t z_stride = operands.z_stride;
  const double* HWY_RESTRICT x = operands.x;
  double* HWY_RESTRICT z = operands.z;
  const auto add = [&](std::size_t m, std::size_t v, Vector value) HWY_ATTR {
    for (int b = 0; b < kBands; ++b) {
      if constexpr (kGather) {
        const Vector from = hn::LoadU(d, x + std::size_t(b) * x_stride + m);
        sum[b][v] = hn::Add(sum[b][v], hn::Mul(value, from));
      }
      if constexpr (kHandOn) {
        double* to = z + std::size_t(b) * z_stride + m;
        hn::StoreU(hn::Add(hn::LoadU(d, to), hn::Mul(value, scale[b])), d, to);
      }
    }
  };
  for (const Run run : runs) {
    x += run.skip;
    z += run.skip;
    const std::size_t count = run.count;
    std::size_t m = 0;
    for (; m + kSums <= count; m += kSums) {
      for (std::size_t v = 0; v < kVectors; ++v) {
        add(m + v * kWidth, v, load(values + m + v * kWidth));
      }
    }
    for (std::size_t v = 0; v < kVectors && m < count; m += kWidth, ++v) {
      add(m, v, hn::IfThenElseZero(hn::FirstN(d, count - m), load(values + m)));
    }
    values += count;
    x += count;
    z += count;
  }
  if constexpr (!kGather) return;
  for (int b = 0; b < kBands; ++b) {
    HWY_ALIGN double s[kSums];
    for (std::size_t v = 0; v < kVectors; ++v) hn::Store(sum[b][v], d, s + v * kWidth);
    sums[b] = ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
  }
}

template <int kBands, bool kGather, bool kHandOn>
void walkRow(const RunRow& row, const RowOperands& operands, const double* factor, double* sums) {
  if (row.doubles.empty()) {
    walkRuns<kBands, kGather, kHandOn>(row.runs, row.floats.data(), operands, factor, sums);
  } else {
    walkRuns<kBands, kGather, kHandOn>(row.runs, row.doubles.data(), operands, factor, sums);
  }
}

template <bool kGather, bool kHandOn>
void walkBands(const RunRow& row, const RowOperands& operands, const double* factor, double* sums) {
  switch (operands.bands) {
    case 1:
      return walkRow<1, kGather, kHandOn>(row, operands, factor, sums);
    case 2:
      return walkRow<2, kGather, kHandOn>(row, operands, factor, sums);
    case 3:
      return walkRow<3, kGather, kHandOn>(row, operands, factor, sums);
    default:
      return walkRow<kMaxBands, kGather, kHandOn>(row, operands, factor, sums);
  }
}

void gather(const RunRow& row, const RowOperands& operands, double* sums) {
  walkBands<true, false>(row, operands, nullptr, sums);
}

void handOn(const RunRow& row, const RowOperands& operands, const double* factor) {
  walkBands<false, true>(row, operands, factor, nullptr);
}

void gatherAndHandOn(const RunRow& row, const RowOperands& operands, const double* factor,
                     double* sums) {
  walkBands<true, true>(row, operands, factor, sums);
}

TriangleKernels kernels() { return {hwy::TargetName(HWY_TARGET), gather, handOn, gatherAndHandOn}; }

}  // namespace
}  // namespace radiosity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace radiosity {

HWY_EXPORT(kernels);

TriangleKernels triangleKernels() { return HWY_DYNAMIC_DISPATCH(kernels)(); }

}  // namespace radiosity
#endif
