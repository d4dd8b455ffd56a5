#include "matrix/triangle_kernels.h"

#include "matrix/run_row.h"

namespace radiosity {

namespace {

/// Running sums a band, so that additions need not wait for each other.
constexpr std::size_t kLanes = 8;

/// Whole blocks of kLanes values of a run go to kLanes sums, what is left of the run to one more:
/// the order of additions depends on nothing but the runs.
template <int kBands, bool kGather, bool kHandOn>
void walk(const RunRow& row, const RowOperands& operands, const double* factor, double* sums) {
  double lanes[kBands][kLanes] = {};
  double rest[kBands] = {};
  forRuns(row, [&](std::size_t offset, const auto* values, std::size_t count) {
    const std::size_t blocks = count - count % kLanes;
    for (int b = 0; b < kBands; ++b) {
      const double* __restrict x = operands.x + std::size_t(b) * operands.x_stride + offset;
      double* __restrict z = operands.z + std::size_t(b) * operands.z_stride + offset;
      for (std::size_t m = 0; m < blocks; m += kLanes) {
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
          if constexpr (kGather) lanes[b][lane] += values[m + lane] * x[m + lane];
          if constexpr (kHandOn) z[m + lane] += values[m + lane] * factor[b];
        }
      }
      for (std::size_t m = blocks; m < count; ++m) {
        if constexpr (kGather) rest[b] += values[m] * x[m];
        if constexpr (kHandOn) z[m] += values[m] * factor[b];
      }
    }
  });
  if constexpr (kGather) {
    for (int b = 0; b < kBands; ++b) {
      const double* l = lanes[b];
      sums[b] = (((l[0] + l[1]) + (l[2] + l[3])) + ((l[4] + l[5]) + (l[6] + l[7]))) + rest[b];
    }
  }
}

template <bool kGather, bool kHandOn>
void walkBands(const RunRow& row, const RowOperands& operands, const double* factor, double* sums) {
  switch (operands.bands) {
    case 1:
      return walk<1, kGather, kHandOn>(row, operands, factor, sums);
    case 2:
      return walk<2, kGather, kHandOn>(row, operands, factor, sums);
    case 3:
      return walk<3, kGather, kHandOn>(row, operands, factor, sums);
    default:
      return walk<kMaxBands, kGather, kHandOn>(row, operands, factor, sums);
  }
}

}  // namespace

void gatherRow(const RunRow& row, const RowOperands& operands, double* sums) {
  walkBands<true, false>(row, operands, nullptr, sums);
}

void handOnRow(const RunRow& row, const RowOperands& operands, const double* factor) {
  walkBands<false, true>(row, operands, factor, nullptr);
}

void gatherAndHandOnRow(const RunRow& row, const RowOperands& operands, const double* factor,
                        double* sums) {
  walkBands<true, true>(row, operands, factor, sums);
}

}  // namespace radiosity
