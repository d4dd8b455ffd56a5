// Products of the row form, and the choice between the forms.
#include <algorithm>

#include "base/parallel.h"
#include "matrix/matrix_row.h"
#include "matrix/run_row.h"
#include "matrix/shared_rows.h"

namespace radiosity {

namespace {

/// The rows that a thread takes at a time: enough work to hide the scheduling of sparse rows.
constexpr std::size_t kProductGrain = 16;

/// The bands summed in one walk along a row; further bands take another walk, from the cache.
constexpr int kBandsAWalk = 4;

/// Values of one stored row. `columns` is null for a dense row.
template <class Value>
struct StoredValues {
  const Value* values;
  const Index* columns;
  std::size_t count;
};

/// out[b] = sum over the row of value * x[column * stride + b], for `kBands` bands.
///
/// Four running sums a band, picked by column modulo 4, keep the additions from waiting for each
/// other. The order of additions depends on the columns alone and adding a stored 0 changes
/// nothing, so dense and sparse storage give the same bits.
template <int kBands, class Value>
void dot(const StoredValues<Value>& row, const double* x, std::size_t stride, double* out) {
  constexpr std::size_t kLanes = 4;
  double sum[kLanes][kBands] = {};
  const auto add = [&](std::size_t lane, std::size_t column, double value) {
    for (int b = 0; b < kBands; ++b) sum[lane][b] += value * x[column * stride + std::size_t(b)];
  };
  std::size_t k = 0;
  if (row.columns == nullptr) {
    for (; k + kLanes <= row.count; k += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) add(lane, k + lane, row.values[k + lane]);
    }
    for (; k < row.count; ++k) add(k % kLanes, k, row.values[k]);
  } else {
    for (; k < row.count; ++k) add(row.columns[k] % kLanes, row.columns[k], row.values[k]);
  }
  for (int b = 0; b < kBands; ++b) out[b] = (sum[0][b] + sum[1][b]) + (sum[2][b] + sum[3][b]);
}

template <class Value>
void dotAllBands(const StoredValues<Value>& row, const double* x, int bands, double* out) {
  const auto stride = std::size_t(bands);
  for (int b = 0; b < bands; b += kBandsAWalk) {
    switch (std::min(bands - b, kBandsAWalk)) {
      case 1:
        dot<1>(row, x + b, stride, out + b);
        break;
      case 2:
        dot<2>(row, x + b, stride, out + b);
        break;
      case 3:
        dot<3>(row, x + b, stride, out + b);
        break;
      default:
        dot<4>(row, x + b, stride, out + b);
        break;
    }
  }
}

/// out[b] = sum over the row of F_ij x[j * bands + b].
void rowProduct(const RowView& row, const double* x, int bands, double* out) {
  const Index* columns = row.dense ? nullptr : row.columns.data();
  if (row.doubles.empty()) {
    dotAllBands(StoredValues<float>{row.floats.data(), columns, row.floats.size()}, x, bands, out);
  } else {
    dotAllBands(StoredValues<double>{row.doubles.data(), columns, row.doubles.size()}, x, bands,
                out);
  }
}

}  // namespace

void ExchangeMatrix::product(std::span<const double> x, int bands, std::span<double> y,
                             std::span<const std::uint8_t> wanted) const {
  if (shared_) return shared_->product(x, bands, y, wanted);
  if (symmetric_) return symmetricProduct(x, bands, y, wanted);
  parallelFor(size(), kProductGrain, [&](std::size_t i) {
    if (!wanted.empty() && wanted[i] == 0) return;
    rowProduct(viewOf(i), x.data(), bands, &y[i * std::size_t(bands)]);
  });
}

void ExchangeMatrix::sweep(std::span<double> x, int bands, const Update& update,
                           std::span<const std::uint8_t> wanted) const {
  requireRows("a sweep over the rows (Gauss-Seidel)");
  if (symmetric_) return symmetricSweep(x, bands, update, wanted);
  std::vector<double> gathered(static_cast<std::size_t>(bands));
  for (std::size_t i = 0; i < size(); ++i) {
    if (!wanted.empty() && wanted[i] == 0) continue;
    rowProduct(viewOf(i), x.data(), bands, gathered.data());
    update(i, gathered.data());
  }
}

}  // namespace radiosity
