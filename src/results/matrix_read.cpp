// Reads the matrix; everything is checked before it is used.
#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "matrix/row_parts.h"
#include "matrix/sort_entries.h"
#include "radiosity/row_matrix.h"
#include "radiosity/symmetric_matrix.h"
#include "results/cut_rows.h"
#include "results/matrix_blocks.h"

namespace radiosity {

using h5::Number;

namespace {

constexpr std::size_t kRowGrain = 64;
/// Of rows, for each of several processes.
constexpr std::size_t kStretches = 16;

/// The order in which a symmetric matrix stores the patches: each once.
std::vector<Index> readOrder(const h5::InputGroup& group, std::size_t n) {
  std::size_t rows = 0;
  const h5::Handle dataset = group.open("order", h5::numberOf<Index>(), 0, rows);
  if (rows != n) group.fail("order", fmt::format("has {} values, not {}", rows, n));
  std::vector<Index> order(n);
  if (n > 0) group.readAll("order", dataset, h5::numberOf<Index>(), order.data());
  std::vector<bool> named(n, false);
  for (const Index patch : order) {
    if (patch >= n || named[patch]) group.fail("order", "does not name every patch once");
    named[patch] = true;
  }
  return order;
}

/// The compressed rows of a group without the entries themselves, checked.
struct StoredRows {
  Number number = Number::f32;  ///< of data
  std::vector<std::int64_t> indptr;
  std::vector<RowRange> chosen;  ///< to be read, by rising row

  bool allChosen() const { return chosen.front().size() == indptr.size() - 1; }

  /// Chooses the rows of a part: of kStretches stretches for each part, with about as many entries
  /// each, one in turn. A symmetric matrix keeps a pair in the row that is first in its order, so
  /// of two halves the first may keep three quarters of the pairs.
  void choose(const MatrixPart& part) {
    const std::size_t stretches = part.parts == 1 ? 1 : kStretches * part.parts;
    const auto rowAt = [&](std::size_t k) {
      const std::int64_t before =
          std::int64_t(double(indptr.back()) * double(k) / double(stretches));
      return k == stretches
                 ? indptr.size() - 1
                 : std::size_t(std::lower_bound(indptr.begin(), indptr.end() - 1, before) -
                               indptr.begin());
    };
    for (std::size_t k = 0; k < stretches; ++k) {
      const std::size_t turn = k / part.parts;
      const std::size_t place = k % part.parts;
      // To and fro, so that each part is as often before the others as after them.
      if ((turn % 2 == 0 ? place : part.parts - 1 - place) != part.part) continue;
      chosen.push_back({rowAt(k), rowAt(k + 1)});
    }
  }
};

/// The row starts: they rise from 0 to the number of entries, and no row is longer than the matrix.
std::vector<std::int64_t> readRowStarts(const h5::InputGroup& group, std::size_t n,
                                        std::size_t entries) {
  std::size_t rows = 0;
  const h5::Handle dataset = group.open("indptr", Number::i64, 0, rows);
  if (rows != n + 1) group.fail("indptr", fmt::format("has {} values, not {}", rows, n + 1));
  std::vector<std::int64_t> indptr(rows);
  group.readAll("indptr", dataset, Number::i64, indptr.data());
  bool good = indptr.front() == 0 && indptr.back() == std::int64_t(entries);
  for (std::size_t i = 0; i < n && good; ++i) {
    good = indptr[i + 1] >= indptr[i] && indptr[i + 1] - indptr[i] <= std::int64_t(n);
  }
  if (!good) group.fail("indptr", "does not divide the entries into rows");
  return indptr;
}

StoredRows openRows(const h5::InputGroup& group, std::size_t n) {
  StoredRows rows;
  const std::optional<Number> number = group.numberOfDataset("data");
  if (number != Number::f32 && number != Number::f64) group.fail("data", "is not f32 or f64");
  rows.number = *number;
  std::size_t shape_rows = 0;
  std::int64_t shape[2] = {-1, -1};
  const h5::Handle shape_set = group.open("shape", Number::i64, 0, shape_rows);
  if (shape_rows == 2) group.readAll("shape", shape_set, Number::i64, shape);
  if (shape[0] != std::int64_t(n) || shape[1] != std::int64_t(n)) {
    group.fail("shape", fmt::format("is not {0} x {0}, as area says", n));
  }
  std::size_t entries = 0;
  std::size_t index_count = 0;
  group.open("data", *number, 0, entries);
  group.open("indices", Number::i32, 0, index_count);
  if (index_count != entries) {
    group.fail("indices", fmt::format("has {} values, data has {}", index_count, entries));
  }
  rows.indptr = readRowStarts(group, n, entries);
  return rows;
}

/// Reads rows block by block and hands each to `store`, several at once.
template <class T>
class BlockReader {
 public:
  using Store =
      std::function<void(std::size_t row, std::span<const std::int32_t>, std::span<const T>)>;

  BlockReader(const h5::InputGroup& group, const StoredRows& rows_there, Store store)
      : group_(&group),
        indptr_(&rows_there.indptr),
        chosen_(&rows_there.chosen),
        store_(std::move(store)) {
    std::size_t rows = 0;
    indices_ = group.open("indices", Number::i32, 0, rows);
    data_ = group.open("data", h5::numberOf<T>(), 0, rows);
  }

  void readAll() {
    // About four chunks: enough for all threads, and small compared with a matrix worth storing.
    const auto block = std::int64_t(4 * h5::kChunkBytes / sizeof(std::int32_t));
    for (const RowRange& stretch : *chosen_) {
      for (std::size_t first = stretch.first; first < stretch.last;) {
        std::size_t last = first + 1;
        while (last < stretch.last && (*indptr_)[last + 1] - (*indptr_)[first] <= block) ++last;
        read(first, last);
        first = last;
      }
    }
  }

 private:
  void read(std::size_t first, std::size_t last) {
    const std::size_t begin = std::size_t((*indptr_)[first]);
    const std::size_t count = std::size_t((*indptr_)[last]) - begin;
    columns_.resize(count);
    values_.resize(count);
    if (count > 0) {
      group_->readRows("indices", indices_, Number::i32, begin, count, columns_.data());
      group_->readRows("data", data_, h5::numberOf<T>(), begin, count, values_.data());
    }
    parallelFor(last - first, kRowGrain, [&](std::size_t k) {
      const std::size_t from = std::size_t((*indptr_)[first + k]) - begin;
      const std::size_t to = std::size_t((*indptr_)[first + k + 1]) - begin;
      const auto columns = std::span<const std::int32_t>(columns_).subspan(from, to - from);
      const auto values = std::span<const T>(values_).subspan(from, to - from);
      check(first + k, columns, values);
      store_(first + k, columns, values);
    });
  }

  void check(std::size_t i, std::span<const std::int32_t> columns,
             std::span<const T> values) const {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      // As an unsigned number a negative column is a large one.
      if (Index(columns[k]) >= indptr_->size() - 1 || (k > 0 && columns[k] <= columns[k - 1])) {
        group_->fail("indices", fmt::format("has a row ({}) whose columns do not increase", i));
      }
      if (values[k] > 0 && std::isfinite(values[k])) continue;
      group_->fail("data", fmt::format("has a row ({}) with the form factor {}", i, values[k]));
    }
  }

  const h5::InputGroup* group_;
  const std::vector<std::int64_t>* indptr_;
  const std::vector<RowRange>* chosen_;
  Store store_;
  h5::Handle indices_;
  h5::Handle data_;
  std::vector<std::int32_t> columns_;
  std::vector<T> values_;
};

template <class T>
void readByRows(const h5::InputGroup& group, const StoredRows& rows, RowMatrix& matrix) {
  BlockReader<T>(group, rows, [&](std::size_t i, auto columns, auto values) {
    matrix.setRow(i, std::vector<Index>(columns.begin(), columns.end()),
                  std::vector<double>(values.begin(), values.end()));
  }).readAll();
}

/// Reads a symmetric matrix. It keeps one entry of each pair: the one in the row of the patch that
/// is first in the order. Calls store(k, positions, values) for every position k.
template <class T, class StoreUpper>
void readTriangle(const h5::InputGroup& group, const StoredRows& rows, std::span<const Index> order,
                  const StoreUpper& store) {
  std::vector<Index> position(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) position[order[k]] = Index(k);
  tbb::enumerable_thread_specific<EntrySorter> sorters;
  std::atomic<std::ptrdiff_t> surplus = 0;  // entries to later patches less those to earlier ones
  const auto keepUpper = [&](std::size_t i, std::span<const std::int32_t> columns,
                             std::span<const T> values) {
    const Index k = position[i];
    std::vector<Index> later;
    std::vector<double> factors;
    std::ptrdiff_t more = 0;
    for (std::size_t m = 0; m < columns.size(); ++m) {
      const Index other = position[std::size_t(columns[m])];
      if (other != k) more += other > k ? 1 : -1;
      if (other < k) continue;
      later.push_back(other);
      factors.push_back(values[m]);
    }
    sorters.local().sort(later, factors, order.size());
    store(k, later, factors);
    surplus.fetch_add(more, std::memory_order_relaxed);
  };
  BlockReader<T>(group, rows, keepUpper).readAll();
  // All rows together must have no surplus.
  if (rows.allChosen() && surplus != 0) group.fail("indices", "is not that of a symmetric matrix");
}

template <class T>
void readSymmetric(const h5::InputGroup& group, const StoredRows& rows, SymmetricMatrix& matrix) {
  const auto store = [&](std::size_t k, std::span<const Index> positions,
                         std::span<const double> factors) {
    try {
      matrix.setUpperRow(k, positions, factors);
    } catch (const InputError& error) {
      group.fail("data", fmt::format("does not fit: {}", error.what()));
    }
  };
  readTriangle<T>(group, rows, matrix.order(), store);
}

std::vector<double> readAreas(const h5::InputGroup& group) {
  std::size_t n = 0;
  const h5::Handle area_set = group.open("area", Number::f64, 0, n);
  std::vector<double> area(n);
  if (n > 0) group.readAll("area", area_set, Number::f64, area.data());
  for (const double a : area) {
    if (!(a >= 0) || !std::isfinite(a)) group.fail("area", fmt::format("holds the area {}", a));
  }
  return area;
}

std::shared_ptr<const RowMatrix> readRowMatrix(const h5::InputGroup& group, const StoredRows& rows,
                                               std::vector<double> area,
                                               std::shared_ptr<ScratchMemory> scratch) {
  const bool single = rows.number == Number::f32;
  const auto matrix = std::make_shared<RowMatrix>(
      std::move(area), single ? Precision::single_precision : Precision::double_precision,
      std::move(scratch));
  single ? readByRows<float>(group, rows, *matrix) : readByRows<double>(group, rows, *matrix);
  return matrix;
}

/// The rows of `part`; all others are empty.
std::shared_ptr<const ExchangeMatrix> readPairs(const h5::InputGroup& group,
                                                std::shared_ptr<ScratchMemory> scratch,
                                                const MatrixPart& part) {
  std::vector<double> area = readAreas(group);
  const std::size_t n = area.size();
  StoredRows rows = openRows(group, n);
  rows.choose(part);
  const bool single = rows.number == Number::f32;
  const Precision precision = single ? Precision::single_precision : Precision::double_precision;
  if (group.has("order")) {
    const auto matrix = std::make_shared<SymmetricMatrix>(std::move(area), readOrder(group, n),
                                                          precision, std::move(scratch));
    single ? readSymmetric<float>(group, rows, *matrix)
           : readSymmetric<double>(group, rows, *matrix);
    return matrix;
  }
  return readRowMatrix(group, rows, std::move(area), std::move(scratch));
}

}  // namespace

std::shared_ptr<const ExchangeOperator> readMatrix(const h5::InputGroup& group,
                                                   std::shared_ptr<ScratchMemory> scratch) {
  if (!group.has(kCutGroup)) return readPairs(group, std::move(scratch), {});
  std::vector<double> area = readAreas(group);
  const h5::InputGroup cut = group.group(kCutGroup);
  CutParts parts = readCut(cut, area);
  if (cut.has(kPairsGroup)) {
    const h5::InputGroup pairs = cut.group(kPairsGroup);
    StoredRows rows = openRows(pairs, area.size());
    rows.choose({});
    parts.pairs = readRowMatrix(pairs, rows, std::move(area), std::move(scratch));
  }
  return std::make_shared<CutOperator>(std::move(parts));
}

std::shared_ptr<const ExchangeMatrix> readMatrixPart(const std::string& path,
                                                     const MatrixPart& part) {
  return h5::readSettled(path, [&] {
    const h5::InputFile file(path);
    file.requireOwnObjects();
    const h5::InputGroup group = h5::InputGroup(file).group("form_factors");
    if (group.has(kCutGroup)) {
      group.fail(kCutGroup, "needs one process: leave out mpirun");
    }
    return readPairs(group, nullptr, part);
  });
}

}  // namespace radiosity
