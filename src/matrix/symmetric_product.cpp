// Products. With A_q F_qk = A_k F_kq each stored F_kq is used twice: row k gathers F_kq x_q, and
// hands F_kq A_k x_k on to row q, which divides by its own area at the end.
#include <algorithm>

#include "base/aligned_buffer.h"
#include "base/scratch_rows.h"
#include "matrix/run_row.h"
#include "matrix/triangle_kernels.h"
#include "matrix/triangle_pass.h"
#include "radiosity/symmetric_matrix.h"

namespace radiosity {

namespace {

/// The bands that one pass over the matrix serves. More would need more memory for the sums
/// scattered and would not save time.
constexpr int kBandsAtOnce = 16;

/// Bands [first, last) of N * bands values, a plane each, by position instead of patch.
struct Planes {
  Planes(std::size_t n, int first, int last)
      : first_band(std::size_t(first)),
        bands(std::size_t(last - first)),
        stride((n + kSums - 1) / kSums * kSums) {
    values.reserve(stride * bands);
    std::fill_n(values.data(), stride * bands, 0.0);
  }
  void take(std::span<const double> x, std::size_t width, std::span<const Index> order) {
    for (std::size_t b = 0; b < bands; ++b) {
      for (std::size_t k = 0; k < order.size(); ++k)
        at(b, k) = x[order[k] * width + first_band + b];
    }
  }
  double& at(std::size_t band, std::size_t k) { return values.data()[band * stride + k]; }
  double at(std::size_t band, std::size_t k) const { return values.data()[band * stride + k]; }
  std::size_t first_band;
  std::size_t bands;
  std::size_t stride;
  AlignedBuffer<double> values;
};

bool isWanted(std::span<const std::uint8_t> wanted, Index patch) {
  return wanted.empty() || wanted[patch] != 0;
}

/// `sums`: gathered sums by r * bands + b if any row is wanted (`gathers`), else 0. `factor`: as in
/// TriangleKernels.
void multiplyBlock(const TriangleKernels& kernels, const RowBlock& block,
                   const RowOperands& operands, std::span<const double> factor, bool gathers,
                   double* sums) {
  const bool scatters = std::ranges::any_of(factor, [](double f) { return f != 0; });
  if (gathers && scatters) {
    kernels.gather_and_scatter(block, operands, factor.data(), sums);
  } else if (gathers) {
    kernels.gather(block, operands, sums);
  } else {
    std::fill_n(sums, factor.size(), 0.0);
    if (scatters) kernels.scatter(block, operands, factor.data());
  }
}

/// The sum scattered to a row, divided by its area; 0 for a patch without area.
double perArea(double scattered, double area) { return area > 0 ? scattered / area : 0.0; }

}  // namespace

void SymmetricMatrix::multiply(std::span<const double> x, int bands, std::span<double> y,
                               std::span<const std::uint8_t> wanted) const {
  const std::size_t n = size();
  const std::span<const Index> order = this->order();
  const std::span<const double> area = this->area();
  const auto width = std::size_t(bands);
  const TrianglePass pass(n, kSums, [&](std::size_t k) { return workOf(upper_[k]); });
  const TriangleKernels kernels = triangleKernels();
  for (int first = 0; first < bands; first += kBandsAtOnce) {
    Planes in(n, first, std::min(first + kBandsAtOnce, bands));
    in.take(x, width, order);
    std::vector<double> gathered(n * in.bands);
    // Positions count from `begin`, the first of a range of rows.
    const auto block = [&](std::size_t k, std::size_t count, std::size_t begin, double* scattered,
                           std::size_t stride) {
      const RowBlock rows{.rows = {&upper_[k], count}, .first = k + 1 - begin};
      for (const RunRow& row : rows.rows) touchRows(scratch_.get(), bytesOf(row));
      const auto patches = order.subspan(k, count);
      const bool gathers =
          std::ranges::any_of(patches, [&](Index patch) { return isWanted(wanted, patch); });
      for (std::size_t b = 0; b < in.bands; b += kMaxBands) {
        const std::size_t some = std::min(in.bands - b, std::size_t(kMaxBands));
        const RowOperands operands{.x = &in.at(b, begin),
                                   .x_stride = in.stride,
                                   .z = scattered + b * stride,
                                   .z_stride = stride,
                                   .bands = int(some)};
        double factor[kMaxRows * kMaxBands];
        double sums[kMaxRows * kMaxBands];
        for (std::size_t m = 0; m < count * some; ++m) {
          factor[m] = in.at(b + m % some, k + m / some) * area[patches[m / some]];
        }
        multiplyBlock(kernels, rows, operands, {factor, count * some}, gathers, sums);
        for (std::size_t m = 0; m < count * some; ++m) {
          gathered[(k + m / some) * in.bands + b + m % some] = sums[m];
        }
      }
    };
    const auto range = [&](std::size_t begin, std::size_t end, double* scattered,
                           std::size_t stride) {
      for (std::size_t k = begin; k < end; k += kMaxRows) {
        block(k, std::min(kMaxRows, end - k), begin, scattered, stride);
      }
    };
    const auto finish = [&](std::size_t k, const double* scattered) {
      const Index patch = order[k];
      if (!isWanted(wanted, patch)) return;
      for (std::size_t b = 0; b < in.bands; ++b) {
        const double own = diagonal_[k] * in.at(b, k);
        y[patch * width + in.first_band + b] =
            gathered[k * in.bands + b] + own + perArea(scattered[b], area[patch]);
      }
    };
    pass.runRanges(in.bands, range, finish);
  }
}

// Earlier patches scattered their part of row k's sum just after their update; the part of later
// patches is gathered from values that are not updated yet. So a sweep, too, passes over the
// triangle once.
void SymmetricMatrix::sweep(std::span<double> x, int bands, const Update& update,
                            std::span<const std::uint8_t> wanted) const {
  const std::size_t n = size();
  const auto width = std::size_t(bands);
  Planes now(n, 0, bands);
  now.take(x, width, order());
  Planes scattered(n, 0, bands);
  const TriangleKernels kernels = triangleKernels();
  std::vector<double> sums(width);
  std::vector<double> factor(width);
  const auto operands = [&](int first) {
    return RowOperands{.x = &now.at(std::size_t(first), 0),
                       .x_stride = now.stride,
                       .z = &scattered.at(std::size_t(first), 0),
                       .z_stride = scattered.stride,
                       .bands = std::min(bands - first, kMaxBands)};
  };
  const auto gather = [&](const RowBlock& row) {
    for (int b = 0; b < bands; b += kMaxBands) {
      kernels.gather(row, operands(b), &sums[std::size_t(b)]);
    }
  };
  for (std::size_t k = 0; k < n; ++k) {
    const Index patch = order()[k];
    const double area = this->area()[patch];
    const RowBlock row{.rows = {&upperRuns(k), 1}, .first = k + 1};
    if (isWanted(wanted, patch)) {
      gather(row);
      for (std::size_t b = 0; b < width; ++b) {
        sums[b] += diagonal_[k] * now.at(b, k) + perArea(scattered.at(b, k), area);
      }
      update(patch, sums.data());
      for (std::size_t b = 0; b < width; ++b) now.at(b, k) = x[patch * width + b];
    }
    for (std::size_t b = 0; b < width; ++b) factor[b] = now.at(b, k) * area;
    if (std::all_of(factor.begin(), factor.end(), [](double f) { return f == 0; })) continue;
    for (int b = 0; b < bands; b += kMaxBands) {
      kernels.scatter(row, operands(b), &factor[std::size_t(b)]);
    }
  }
}

}  // namespace radiosity
