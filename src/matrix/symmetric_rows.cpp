// Assembles rows from the triangle.

#include <tbb/enumerable_thread_specific.h>

#include "base/parallel.h"
#include "matrix/make_room.h"
#include "matrix/run_row.h"
#include "matrix/sort_entries.h"
#include "matrix/working_memory.h"
#include "radiosity/symmetric_matrix.h"

namespace radiosity {

namespace {

/// Rows with at least one entry in so many columns are laid out; shorter ones are sorted.
constexpr std::size_t kSparse = 16;
/// Blocks of a panel of short rows.
constexpr std::size_t kSortedBlocks = 32;

/// Gathers the rows of a panel from the triangle. Row i has the values of row position(i) of the
/// triangle, and from every earlier row of the triangle the one value at its own position. Rows
/// that are neighbours by position are gathered together: they read neighbouring values.
class Gathering {
 public:
  Gathering(const SymmetricMatrix& matrix, std::span<const Index> position, std::size_t first,
            std::size_t last)
      : matrix_(matrix) {
    rows_.reserve(last - first);
    for (std::size_t i = first; i < last; ++i) rows_.push_back({position[i], Index(i - first)});
    std::sort(rows_.begin(), rows_.end(),
              [](const Row& a, const Row& b) { return a.position < b.position; });
  }

  std::vector<Index> countEntries() const {
    std::vector<Index> entries(rows_.size(), 0);
    forEntries(rows_, [&](std::size_t k, Index, double) { ++entries[rows_[k].row]; });
    return entries;
  }

  /// Writes the rows in compressed form, sorted, to the places that `starts` gives them.
  void run(std::span<const std::size_t> starts, std::vector<Index>& columns,
           std::vector<double>& values) const {
    const std::size_t count = rows_.size();
    if (count == 0) return;
    const bool laid_out = starts.back() * kSparse >= count * matrix_.size();
    const std::size_t size =
        laid_out ? laidOutRows(matrix_.size()) : (count + kSortedBlocks - 1) / kSortedBlocks;
    tbb::enumerable_thread_specific<std::vector<double>> layouts;
    tbb::enumerable_thread_specific<EntrySorter> sorters;
    parallelFor((count + size - 1) / size, 1, [&](std::size_t block) {
      const std::size_t begin = block * size;
      const std::size_t end = std::min(begin + size, count);
      const auto rows = std::span(rows_).subspan(begin, end - begin);
      if (laid_out) {
        layOut(rows, starts, layouts.local(), columns, values);
      } else {
        sort(rows, starts, sorters.local(), columns, values);
      }
    });
  }

 private:
  struct Row {
    Index position;
    Index row;  ///< in the panel
  };

  /// Calls visit(k, column, value) for every entry of rows[k], which are in order of position.
  template <class Visit>
  void forEntries(std::span<const Row> rows, const Visit& visit) const {
    const std::span<const Index> order = matrix_.order();
    std::size_t next = 0;  // the first row that is not before k
    for (std::size_t k = 0; next < rows.size(); ++k) {
      const RunRow& stored = matrix_.upperRuns(k);
      if (rows[next].position == k) {
        const std::size_t itself = next++;
        if (matrix_.diagonal(k) != 0) visit(itself, order[k], matrix_.diagonal(k));
        forRuns(stored, [&](std::size_t offset, const auto* values, std::size_t count) {
          const Index* later = &order[k] + 1 + offset;
          for (std::size_t m = 0; m < count; ++m) {
            if (values[m] != 0) visit(itself, later[m], double(values[m]));
          }
        });
      }
      if (stored.runs.empty()) continue;
      const double area = matrix_.area()[order[k]];
      RunReader reader(stored);
      for (std::size_t m = next; m < rows.size(); ++m) {
        const Index position = rows[m].position;
        const double value = reader.at(position - k - 1);
        if (value != 0) visit(m, order[k], value * area / matrix_.area()[order[position]]);
      }
    }
  }

  /// Writes rows with all their zeros first. `layout` is at least as large as they were before, and
  /// holds kAbsent everywhere.
  void layOut(std::span<const Row> rows, std::span<const std::size_t> starts,
              std::vector<double>& layout, std::vector<Index>& columns,
              std::vector<double>& values) const {
    constexpr double kAbsent = -1;
    const std::size_t n = matrix_.size();
    if (layout.size() < rows.size() * n) layout.resize(rows.size() * n, kAbsent);
    forEntries(rows,
               [&](std::size_t k, Index column, double value) { layout[k * n + column] = value; });
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const auto line = std::span(layout).subspan(k * n, n);
      std::size_t at = starts[rows[k].row];
      for (std::size_t column = 0; column < n; ++column) {
        if (line[column] == kAbsent) continue;
        columns[at] = Index(column);
        values[at++] = line[column];
      }
      std::fill(line.begin(), line.end(), kAbsent);
    }
  }

  void sort(std::span<const Row> rows, std::span<const std::size_t> starts, EntrySorter& sorter,
            std::vector<Index>& columns, std::vector<double>& values) const {
    std::vector<std::size_t> next;
    next.reserve(rows.size());
    for (const Row& row : rows) next.push_back(starts[row.row]);
    forEntries(rows, [&](std::size_t k, Index column, double value) {
      columns[next[k]] = column;
      values[next[k]++] = value;
    });
    for (const Row& row : rows) {
      const std::size_t count = starts[row.row + 1] - starts[row.row];
      sorter.sort(std::span(columns).subspan(starts[row.row], count),
                  std::span(values).subspan(starts[row.row], count), matrix_.size());
    }
  }

  const SymmetricMatrix& matrix_;
  std::vector<Row> rows_;  // by position
};

}  // namespace

void SymmetricMatrix::readRows(std::size_t first, std::size_t last, std::span<const Index> entries,
                               CompressedRows& rows) const {
  const Gathering gathering(*this, position_, first, last);
  std::vector<Index> counted;
  if (entries.empty()) counted = gathering.countEntries();
  const auto counts =
      entries.empty() ? std::span<const Index>(counted) : entries.subspan(first, last - first);
  rows.starts.assign(1, 0);
  for (const Index count : counts) rows.starts.push_back(rows.starts.back() + count);
  makeRoom(rows.columns, rows.starts.back());
  makeRoom(rows.values, rows.starts.back());
  gathering.run(rows.starts, rows.columns, rows.values);
}

std::size_t SymmetricMatrix::panelEntries() const {
  return panelBytes(bytes()) / RowPanel::kEntryBytes;
}

}  // namespace radiosity
