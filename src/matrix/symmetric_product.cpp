// Products of the symmetric form. With A_q F_qk = A_k F_kq each stored F_kq is used twice: row k
// gathers F_kq x_q, and hands F_kq A_k x_k on to row q, which divides by its own area at the end.
#include <algorithm>

#include "matrix/run_row.h"
#include "matrix/triangle_kernels.h"
#include "matrix/triangle_pass.h"
#include "radiosity/exchange_matrix.h"

namespace radiosity {

namespace {

std::size_t workOf(const RunRow& row) {
  return row.floats.size() + row.doubles.size() + row.runs.size();
}

/// Some bands of N * bands values, a plane each, by position instead of patch.
struct Planes {
  Planes(std::size_t n, int first, int last)
      : first_band(std::size_t(first)),
        bands(last - first),
        stride(n + kOverrun),
        values(stride * std::size_t(last - first)) {}
  void take(std::span<const double> x, std::size_t width, std::span<const Index> order) {
    const std::size_t n = order.size();
    for (std::size_t b = 0; b < std::size_t(bands); ++b) {
      for (std::size_t k = 0; k < n; ++k) {
        values[b * stride + k] = x[order[k] * width + first_band + b];
      }
    }
  }
  std::size_t first_band;
  int bands;
  std::size_t stride;
  std::vector<double> values;
};

bool isWanted(std::span<const std::uint8_t> wanted, Index patch) {
  return wanted.empty() || wanted[patch] != 0;
}

/// The sum handed on to a row, divided by its area; a patch without area was handed nothing.
double perArea(double handed, double area) { return area > 0 ? handed / area : 0.0; }

}  // namespace

void ExchangeMatrix::symmetricProduct(std::span<const double> x, int bands, std::span<double> y,
                                      std::span<const std::uint8_t> wanted) const {
  const std::size_t n = size();
  const auto width = std::size_t(bands);
  const TrianglePass pass(n, kOverrun, [&](std::size_t k) { return workOf(upper_[k]); });
  const TriangleKernels kernels = triangleKernels();
  for (int first = 0; first < bands; first += kMaxBands) {
    Planes in(n, first, std::min(first + kMaxBands, bands));
    in.take(x, width, order_);
    const auto planes = std::size_t(in.bands);
    std::vector<double> gathered(n * planes, 0.0);
    const auto row = [&](std::size_t k, double* handed_on, std::size_t stride) {
      const double area = area_[order_[k]];
      double factor[kMaxBands];
      for (std::size_t b = 0; b < planes; ++b) factor[b] = in.values[b * in.stride + k] * area;
      const RowOperands operands{.x = &in.values[k] + 1,
                                 .x_stride = in.stride,
                                 .z = handed_on,
                                 .z_stride = stride,
                                 .bands = in.bands};
      const bool gathers = isWanted(wanted, order_[k]);
      const bool hands_on = std::any_of(factor, factor + planes, [](double f) { return f != 0; });
      double sums[kMaxBands] = {};
      if (gathers && hands_on) {
        kernels.gather_and_hand_on(upperRuns(k), operands, factor, sums);
      } else if (gathers) {
        kernels.gather(upperRuns(k), operands, sums);
      } else if (hands_on) {
        kernels.hand_on(upperRuns(k), operands, factor);
      }
      for (std::size_t b = 0; b < planes; ++b) gathered[b * n + k] = sums[b];
    };
    const auto finish = [&](std::size_t k, const double* handed) {
      const Index patch = order_[k];
      if (!isWanted(wanted, patch)) return;
      for (std::size_t b = 0; b < planes; ++b) {
        const double own = diagonal_[k] * in.values[b * in.stride + k];
        y[patch * width + in.first_band + b] =
            gathered[b * n + k] + own + perArea(handed[b], area_[patch]);
      }
    };
    pass.run(planes, row, finish);
  }
}

// Row k's sum over earlier patches was handed on by them just after they were updated; its sum over
// later ones is gathered from values not updated yet. So a sweep, too, passes over the triangle
// once.
void ExchangeMatrix::symmetricSweep(std::span<double> x, int bands, const Update& update,
                                    std::span<const std::uint8_t> wanted) const {
  const std::size_t n = size();
  const auto width = std::size_t(bands);
  Planes now(n, 0, bands);
  now.take(x, width, order_);
  const std::size_t stride = now.stride;
  std::vector<double> handed(stride * width, 0.0);
  const TriangleKernels kernels = triangleKernels();
  std::vector<double> sums(width);
  std::vector<double> factor(width);
  const auto operands = [&](std::size_t k, int first) {
    const std::size_t start = std::size_t(first) * stride + k;
    return RowOperands{.x = &now.values[start] + 1,
                       .x_stride = stride,
                       .z = &handed[start] + 1,
                       .z_stride = stride,
                       .bands = std::min(bands - first, kMaxBands)};
  };
  const auto gather = [&](std::size_t k) {
    for (int b = 0; b < bands; b += kMaxBands) {
      kernels.gather(upperRuns(k), operands(k, b), &sums[std::size_t(b)]);
    }
  };
  for (std::size_t k = 0; k < n; ++k) {
    const Index patch = order_[k];
    const double area = area_[patch];
    if (isWanted(wanted, patch)) {
      gather(k);
      for (std::size_t b = 0; b < width; ++b) {
        sums[b] +=
            diagonal_[k] * now.values[b * stride + k] + perArea(handed[b * stride + k], area);
      }
      update(patch, sums.data());
      for (std::size_t b = 0; b < width; ++b) now.values[b * stride + k] = x[patch * width + b];
    }
    for (std::size_t b = 0; b < width; ++b) factor[b] = now.values[b * stride + k] * area;
    if (std::all_of(factor.begin(), factor.end(), [](double f) { return f == 0; })) continue;
    for (int b = 0; b < bands; b += kMaxBands) {
      kernels.hand_on(upperRuns(k), operands(k, b), &factor[std::size_t(b)]);
    }
  }
}

}  // namespace radiosity
