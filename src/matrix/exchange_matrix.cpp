#include "radiosity/exchange_matrix.h"

#include <fmt/format.h>

#include <numeric>
#include <stdexcept>
#include <utility>

#include "base/parallel.h"

namespace radiosity {

namespace {

constexpr std::size_t kColumnsGrain = 64;

}  // namespace

ExchangeMatrix::ExchangeMatrix(std::vector<double> area, bool symmetric, std::vector<Index> order,
                               Precision precision)
    : ExchangeOperator(std::move(area), symmetric),
      precision_(precision),
      order_(std::move(order)) {
  if (!symmetric) return;
  if (order_.size() != size()) {
    throw InputError(
        fmt::format("exchange matrix: an order of {} patches for {}", order_.size(), size()));
  }
  std::vector<bool> named(size(), false);
  for (const Index patch : order_) {
    if (patch >= size() || named[patch]) {
      throw InputError(fmt::format("exchange matrix: the order names patch {} twice or beyond {}",
                                   patch, size()));
    }
    named[patch] = true;
  }
}

std::size_t ExchangeMatrix::nonZeros() const {
  const std::vector<Index> entries = rowEntries();
  return std::accumulate(entries.begin(), entries.end(), std::size_t(0));
}

void ExchangeMatrix::columns(std::size_t first, std::size_t last, std::span<double> values) const {
  const std::size_t n = size();
  const RowPanel rows(*this, 0, n);
  parallelFor(n, kColumnsGrain, [&](std::size_t i) {
    rows.forRow(i, first, last,
                [&](Index j, double value) { values[(j - first) * n + i] = value; });
  });
}

std::vector<double> ExchangeMatrix::row(std::size_t i) const {
  std::vector<double> values(size(), 0.0);
  forRow(i, [&](Index j, double value) { values[j] = value; });
  return values;
}

double ExchangeMatrix::at(std::size_t i, std::size_t j) const {
  double found = 0;
  forRow(i, j, j + 1, [&](Index, double value) { found = value; });
  return found;
}

std::vector<double> ExchangeMatrix::dense() const {
  const std::size_t n = size();
  std::vector<double> values(n * n, 0.0);
  forPanels([&](const RowPanel& rows) {
    for (std::size_t i = rows.first(); i < rows.last(); ++i) {
      rows.forRow(i, [&](Index j, double value) { values[i * n + j] = value; });
    }
  });
  return values;
}

RowView ExchangeMatrix::viewOf(std::size_t /*i*/) const {
  throw std::logic_error("a view of a row that is not stored");
}

ExchangeMatrix::Panels ExchangeMatrix::panels() const {
  Panels all;
  if (size() == 0) return all;
  if (const std::size_t most = panelEntries(); most > 0) {
    all.entries = rowEntries();
    std::size_t held = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      if (held > 0 && held + all.entries[i] > most) {
        all.ends.push_back(i);
        held = 0;
      }
      held += all.entries[i];
    }
  }
  all.ends.push_back(size());
  return all;
}

const ExchangeMatrix& pairsOf(const ExchangeOperator& factors) {
  if (const auto* matrix = dynamic_cast<const ExchangeMatrix*>(&factors)) return *matrix;
  throw InputError(
      "these form factors are not stored pair by pair, so they can be neither listed nor written; "
      "compute them by another method");
}

}  // namespace radiosity
