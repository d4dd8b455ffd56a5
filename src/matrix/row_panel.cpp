// Assembles rows of the symmetric form from the triangle.
#include "radiosity/row_panel.h"

#include <tbb/enumerable_thread_specific.h>

#include "base/parallel.h"
#include "matrix/run_row.h"
#include "matrix/shared_rows.h"
#include "matrix/sort_entries.h"

namespace radiosity {

namespace {

/// Blocks of the triangle that are walked side by side.
constexpr std::size_t kBlocks = 32;

/// Gathers rows first to last - 1 of F. Row i has the values of row position(i) of the triangle,
/// and from every earlier row of the triangle the one value at its own position.
class Gathering {
 public:
  Gathering(const ExchangeMatrix& matrix, std::size_t first, std::size_t last)
      : matrix_(matrix), rows_(last - first), row_at_(matrix.size(), kNone) {
    for (std::size_t k = 0; k < matrix.size(); ++k) {
      const Index patch = matrix.order()[k];
      if (patch < first || patch >= last) continue;
      row_at_[k] = Index(patch - first);
      positions_.push_back(Index(k));
    }
    const std::size_t end = positions_.empty() ? 0 : positions_.back() + 1;
    const std::size_t blocks = std::min(end, kBlocks);
    for (std::size_t b = 0; b <= blocks; ++b) ends_.push_back(blocks > 0 ? b * end / blocks : 0);
  }

  /// Returns the rows in compressed form, sorted.
  void run(std::vector<std::size_t>& starts, std::vector<Index>& columns,
           std::vector<double>& values) {
    // The place of each block's next entry in each row.
    const std::size_t blocks = ends_.size() - 1;
    std::vector<std::size_t> next(blocks * rows_, 0);
    parallelFor(blocks, 1, [&](std::size_t b) {
      forEntries(b, [&](std::size_t row, Index, double) { ++next[b * rows_ + row]; });
    });
    starts.assign(rows_ + 1, 0);
    for (std::size_t row = 0; row < rows_; ++row) {
      std::size_t at = starts[row];
      for (std::size_t b = 0; b < blocks; ++b) {
        const std::size_t count = next[b * rows_ + row];
        next[b * rows_ + row] = at;
        at += count;
      }
      starts[row + 1] = at;
    }
    columns.resize(starts.back());
    values.resize(starts.back());
    parallelFor(blocks, 1, [&](std::size_t b) {
      forEntries(b, [&](std::size_t row, Index column, double value) {
        const std::size_t at = next[b * rows_ + row]++;
        columns[at] = column;
        values[at] = value;
      });
    });
    tbb::enumerable_thread_specific<EntrySorter> sorters;
    parallelFor(rows_, 1, [&](std::size_t row) {
      const std::size_t count = starts[row + 1] - starts[row];
      sorters.local().sort(std::span(columns).subspan(starts[row], count),
                           std::span(values).subspan(starts[row], count), matrix_.size());
    });
  }

 private:
  /// Calls visit(row of the panel, column, value) for the entries that a block of rows of the
  /// triangle holds or hands on.
  template <class Visit>
  void forEntries(std::size_t block, const Visit& visit) const {
    const std::span<const Index> order = matrix_.order();
    for (std::size_t k = ends_[block]; k < ends_[block + 1]; ++k) {
      const Index row = row_at_[k];
      if (row != kNone && matrix_.diagonal(k) != 0) visit(row, order[k], matrix_.diagonal(k));
      const RunRow& stored = matrix_.upperRuns(k);
      const auto later = std::upper_bound(positions_.begin(), positions_.end(), Index(k));
      const double area = matrix_.area()[order[k]];
      const auto handOn = [&](std::size_t position, double value) {
        visit(row_at_[position], order[k], value * area / matrix_.area()[order[position]]);
      };
      if (row == kNone && std::size_t(positions_.end() - later) < stored.runs.size()) {
        RunReader reader(stored);
        for (auto at = later; at != positions_.end(); ++at) {
          const double value = reader.at(*at - k - 1);
          if (value != 0) handOn(*at, value);
        }
        continue;
      }
      forRuns(stored, [&](std::size_t offset, const auto* values, std::size_t count) {
        for (std::size_t m = 0; m < count; ++m) {
          if (values[m] == 0) continue;
          const std::size_t position = k + 1 + offset + m;
          if (row != kNone) visit(row, order[position], double(values[m]));
          if (row_at_[position] != kNone) handOn(position, double(values[m]));
        }
      });
    }
  }

  const ExchangeMatrix& matrix_;
  std::size_t rows_;
  std::vector<Index> row_at_;     // by position: row of the panel, kNone: not of it
  std::vector<Index> positions_;  // of the panel's rows, increasing
  std::vector<std::size_t> ends_;
};

}  // namespace

RowPanel::RowPanel(const ExchangeMatrix& matrix, std::size_t first, std::size_t last)
    : matrix_(&matrix), first_(first), last_(last) {
  if (matrix.sharedRows() != nullptr) {
    matrix.sharedRows()->panel(first, last, starts_, columns_, values_);
    return;
  }
  if (matrix.isSymmetric()) Gathering(matrix, first, last).run(starts_, columns_, values_);
}

std::vector<std::size_t> ExchangeMatrix::panelEnds() const {
  std::vector<std::size_t> ends;
  if (!symmetric_ && !shared_) {
    if (size() > 0) ends.push_back(size());
    return ends;
  }
  // A panel of shared rows must not be larger than the share of a process.
  const std::size_t share = shared_ ? std::size_t(shared_->processes()) : 1;
  const std::size_t most = panelBytes(bytes() / share) / RowPanel::kEntryBytes;
  std::size_t held = 0;
  const std::vector<Index> entries = rowEntries();
  for (std::size_t i = 0; i < size(); ++i) {
    if (held > 0 && held + entries[i] > most) {
      ends.push_back(i);
      held = 0;
    }
    held += entries[i];
  }
  if (size() > 0) ends.push_back(size());
  return ends;
}

}  // namespace radiosity
