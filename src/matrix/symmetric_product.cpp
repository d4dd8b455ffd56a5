// Products of the symmetric form. With A_q F_qk = A_k F_kq each stored F_kq is used twice: row k
// gathers F_kq x_q, and hands F_kq A_k x_k on to row q, which divides by its own area at the end.
#include <algorithm>

#include "base/parallel.h"
#include "matrix/run_row.h"
#include "matrix/triangle_kernels.h"
#include "radiosity/exchange_matrix.h"

namespace radiosity {

namespace {

constexpr std::size_t kPositionGrain = 256;
/// Rows handed on by different threads meet in the same places, so that rows are dealt out in
/// chunks, each with sums of its own. How many depends on N alone, never on the threads.
constexpr std::size_t kRowsPerChunk = 128;
constexpr std::size_t kMostChunks = 32;

/// Starts of chunks of rows with about equally many stored values, and the end.
std::vector<std::size_t> chunkStarts(const std::vector<RunRow>& rows) {
  const std::size_t n = rows.size();
  const std::size_t chunks = std::clamp<std::size_t>(n / kRowsPerChunk, 1, kMostChunks);
  const auto work = [](const RunRow& row) {
    return row.single.size() + row.real.size() + row.runs.size();
  };
  std::size_t total = 0;
  for (const RunRow& row : rows) total += work(row);
  std::vector<std::size_t> starts{0};
  std::size_t done = 0;
  for (std::size_t k = 0; k < n; ++k) {
    done += work(rows[k]);
    if (starts.size() < chunks && done * chunks >= starts.size() * total) starts.push_back(k + 1);
  }
  starts.resize(chunks, n);
  starts.push_back(n);
  return starts;
}

/// Some bands of N * bands values, a plane each, by position instead of patch.
struct Planes {
  Planes(std::size_t n, int first, int last)
      : first_band(std::size_t(first)),
        bands(last - first),
        values(n * std::size_t(last - first)) {}
  void take(std::span<const double> x, std::size_t width, std::span<const Index> order) {
    const std::size_t n = order.size();
    for (std::size_t b = 0; b < std::size_t(bands); ++b) {
      for (std::size_t k = 0; k < n; ++k) {
        values[b * n + k] = x[order[k] * width + first_band + b];
      }
    }
  }
  std::size_t first_band;
  int bands;
  std::vector<double> values;
};

/// What a row was handed on, divided by its area; a patch without area was handed nothing.
double perArea(double handed, double area) { return area > 0 ? handed / area : 0.0; }

}  // namespace

void ExchangeMatrix::symmetricProduct(std::span<const double> x, int bands,
                                      std::span<double> y) const {
  const std::size_t n = size();
  const auto width = std::size_t(bands);
  const std::vector<std::size_t> starts = chunkStarts(upper_);
  const std::size_t chunks = starts.size() - 1;
  for (int first = 0; first < bands; first += kMaxBands) {
    Planes in(n, first, std::min(first + kMaxBands, bands));
    in.take(x, width, order_);
    const auto planes = std::size_t(in.bands);
    std::vector<double> gathered(n * planes);
    std::vector<std::vector<double>> handed(chunks);  // chunk c: positions from starts[c] on
    parallelFor(chunks, 1, [&](std::size_t c) {
      const std::size_t stride = n - starts[c];
      handed[c].assign(stride * planes, 0.0);
      for (std::size_t k = starts[c]; k < starts[c + 1]; ++k) {
        double factor[kMaxBands];
        for (std::size_t b = 0; b < planes; ++b)
          factor[b] = in.values[b * n + k] * area_[order_[k]];
        double sums[kMaxBands];
        const RowOperands operands{.x = &in.values[k] + 1,
                                   .x_stride = n,
                                   .z = &handed[c][k - starts[c]] + 1,
                                   .z_stride = stride,
                                   .bands = in.bands};
        gatherAndHandOnRow(upper_[k], operands, factor, sums);
        for (std::size_t b = 0; b < planes; ++b) gathered[b * n + k] = sums[b];
      }
    });
    parallelFor(n, kPositionGrain, [&](std::size_t k) {
      for (std::size_t b = 0; b < planes; ++b) {
        double from_before = 0;
        for (std::size_t c = 0; c < chunks && starts[c] <= k; ++c) {
          from_before += handed[c][b * (n - starts[c]) + (k - starts[c])];
        }
        y[order_[k] * width + in.first_band + b] = gathered[b * n + k] +
                                                   diagonal_[k] * in.values[b * n + k] +
                                                   perArea(from_before, area_[order_[k]]);
      }
    });
  }
}

// Row k's sum over earlier patches was handed on by them just after they were updated; its sum over
// later ones is gathered from values not updated yet. So a sweep, too, passes over the triangle
// once.
void ExchangeMatrix::symmetricSweep(
    std::span<double> x, int bands,
    const std::function<void(std::size_t i, const double* gathered)>& update) const {
  const std::size_t n = size();
  const auto width = std::size_t(bands);
  Planes now(n, 0, bands);
  now.take(x, width, order_);
  std::vector<double> handed(n * width, 0.0);
  std::vector<double> sums(width);
  std::vector<double> factor(width);
  const auto operands = [&](std::size_t k, int first) {
    const std::size_t start = std::size_t(first) * n + k;
    return RowOperands{.x = &now.values[start] + 1,
                       .x_stride = n,
                       .z = &handed[start] + 1,
                       .z_stride = n,
                       .bands = std::min(bands - first, kMaxBands)};
  };
  for (std::size_t k = 0; k < n; ++k) {
    const Index patch = order_[k];
    const double area = area_[patch];
    for (int b = 0; b < bands; b += kMaxBands)
      gatherRow(upper_[k], operands(k, b), &sums[std::size_t(b)]);
    for (std::size_t b = 0; b < width; ++b) {
      sums[b] += diagonal_[k] * now.values[b * n + k] + perArea(handed[b * n + k], area);
    }
    update(patch, sums.data());
    for (std::size_t b = 0; b < width; ++b) {
      now.values[b * n + k] = x[patch * width + b];
      factor[b] = now.values[b * n + k] * area;
    }
    for (int b = 0; b < bands; b += kMaxBands)
      handOnRow(upper_[k], operands(k, b), &factor[std::size_t(b)]);
  }
}

}  // namespace radiosity
