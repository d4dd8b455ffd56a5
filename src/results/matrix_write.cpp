// Writes the matrix.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/byte_stream.h"
#include "base/parallel.h"
#include "matrix/shared_rows.h"
#include "results/column_writer.h"
#include "results/cut_rows.h"
#include "results/matrix_blocks.h"

namespace radiosity {

using h5::ChunkFile;
using h5::ChunkRange;
using h5::ColumnWriter;
using h5::Number;
using h5::ReservedColumn;

namespace {

/// The most entries that are converted at a time, unless one row has more.
constexpr std::int64_t kEntriesAtOnce = std::int64_t(1) << 18;

std::vector<std::int64_t> rowStarts(const ExchangeMatrix& matrix) {
  std::vector<std::int64_t> indptr(matrix.size() + 1, 0);
  const std::vector<Index> entries = matrix.rowEntries();
  std::copy(entries.begin(), entries.end(), indptr.begin() + 1);
  for (std::size_t i = 0; i < matrix.size(); ++i) indptr[i + 1] += indptr[i];
  return indptr;
}

/// Adds rows first to last - 1 to the columns. `starts`: of these rows' entries. Calls
/// step(rows done) between some of them.
template <class T, class Rows, class Start, class Step>
void addRows(const Rows& rows, std::size_t first, std::size_t last, std::span<const Start> starts,
             ColumnWriter<std::int32_t>& indices, ColumnWriter<T>& data, const Step& step) {
  const auto start = [&](std::size_t i) { return std::int64_t(starts[i - first]); };
  for (std::size_t from = first; from < last;) {
    std::size_t to = from + 1;
    while (to < last && start(to + 1) - start(from) <= kEntriesAtOnce) ++to;
    const auto count = std::size_t(start(to) - start(from));
    const std::span<std::int32_t> columns = indices.extend(count);
    const std::span<T> values = data.extend(count);
    parallelFor(to - from, 1, [&](std::size_t k) {
      auto at = std::size_t(start(from + k) - start(from));
      rows.forRow(from + k, [&](Index column, double value) {
        columns[at] = std::int32_t(column);
        values[at++] = T(value);
      });
    });
    step(to - from);
    from = to;
  }
}

/// Writes the entries of rows that begin at the entries `starts`.
template <class T>
void writeEntries(h5::OutputGroup& group, const ExchangeMatrix& matrix,
                  std::span<const std::int64_t> starts, Progress& progress) {
  const auto entries = std::size_t(starts.back());
  ColumnWriter<std::int32_t> indices(group, "indices", entries);
  ColumnWriter<T> data(group, "data", entries);
  matrix.forPanels([&](const RowPanel& rows) {
    addRows(rows, rows.first(), rows.last(),
            starts.subspan(rows.first(), rows.last() - rows.first() + 1), indices, data,
            [&](std::size_t done) {
              progress.advance(done);
              progress.check();
            });
  });
  progress.check();  // an interruption during the last rows
  indices.flush();
  data.flush();
}

/// The chunks that a process writes of a block of rows. The rows at its ends may be in its
/// neighbours, too: chunks begin and end within rows.
struct BlockChunks {
  ChunkRange indices;
  ChunkRange data;
  std::size_t first_entry = 0;  ///< of the rows
};

/// What processes need to write their blocks.
struct BlocksJob {
  std::string file;
  std::string shown;
  Number number = Number::f32;  ///< of the data
  ReservedColumn indices;
  ReservedColumn data;
  std::vector<BlockChunks> blocks;

  std::vector<std::byte> bytes() const {
    ByteWriter out;
    for (const std::string* text : {&file, &shown, &indices.path, &data.path}) {
      out.putArray(std::span<const char>(*text));
    }
    out.put(number);
    for (const ReservedColumn* column : {&indices, &data}) {
      out.put(column->chunk);
      out.putArray(std::span(column->places));
    }
    out.putArray(std::span(blocks));
    return out.take();
  }

  static BlocksJob from(std::span<const std::byte> bytes) {
    ByteReader in(bytes);
    BlocksJob job;
    for (std::string* text : {&job.file, &job.shown, &job.indices.path, &job.data.path}) {
      const std::vector<char> read = in.getArray<char>();
      text->assign(read.begin(), read.end());
    }
    job.number = in.get<Number>();
    for (ReservedColumn* column : {&job.indices, &job.data}) {
      column->chunk = in.get<std::size_t>();
      column->places = in.getArray<std::uint64_t>();
    }
    job.blocks = in.getArray<BlockChunks>();
    return job;
  }
};

class MatrixBlockWriter : public BlockTaker {
 public:
  explicit MatrixBlockWriter(BlocksJob job) : job_(std::move(job)), file_(job_.file, job_.shown) {}

  void take(std::size_t block, const CompressedRows& rows) override {
    if (job_.number == Number::f32) {
      write<float>(job_.blocks[block], rows);
    } else {
      write<double>(job_.blocks[block], rows);
    }
  }
  void end() override { file_.close(); }

 private:
  template <class T>
  void write(const BlockChunks& block, const CompressedRows& rows) {
    ColumnWriter<std::int32_t> indices(job_.indices, file_, block.indices, block.first_entry);
    ColumnWriter<T> data(job_.data, file_, block.data, block.first_entry);
    addRows(rows, rows.first, rows.first + rows.starts.size() - 1, std::span(rows.starts), indices,
            data, [](std::size_t) {});
    indices.flush();
    data.flush();
  }

  BlocksJob job_;
  ChunkFile file_;
};

/// Divides the chunks of both columns into blocks, and finds the rows of each.
std::vector<RowRange> divide(std::span<const std::int64_t> starts, std::size_t blocks,
                             BlocksJob& job) {
  std::vector<RowRange> rows;
  const auto entries = std::size_t(starts.back());
  const auto part = [&](const ReservedColumn& column, std::size_t block) {
    return block * column.places.size() / blocks;
  };
  for (std::size_t b = 0; b < blocks; ++b) {
    BlockChunks chunks{{part(job.indices, b), part(job.indices, b + 1)},
                       {part(job.data, b), part(job.data, b + 1)}};
    const std::size_t first =
        std::min(chunks.indices.first * job.indices.chunk, chunks.data.first * job.data.chunk);
    const std::size_t last = std::min(entries, std::max(chunks.indices.last * job.indices.chunk,
                                                        chunks.data.last * job.data.chunk));
    const auto after = std::upper_bound(starts.begin(), starts.end(), std::int64_t(first));
    const auto end = std::lower_bound(starts.begin(), starts.end(), std::int64_t(last));
    rows.push_back({std::size_t(after - starts.begin()) - 1, std::size_t(end - starts.begin())});
    chunks.first_entry = std::size_t(starts[rows.back().first]);
    job.blocks.push_back(chunks);
  }
  return rows;
}

/// Writes the entries of rows that lie in several processes: each process puts blocks of whole rows
/// together and writes their chunks.
void writeSharedEntries(h5::OutputGroup& group, const SharedRows& matrix,
                        std::span<const std::int64_t> starts, Number number, Progress& progress) {
  const auto entries = std::size_t(starts.back());
  const h5::ChunkFile& file = group.chunks();
  BlocksJob job{std::filesystem::absolute(file.path()).string(),
                file.shown(),
                number,
                group.reserve("indices", Number::i32, entries),
                group.reserve("data", number, entries),
                {}};
  // A process holds what it sends of a block, what it receives and the whole rows: all together
  // less than a panel of its share.
  constexpr std::size_t kHeldAtOnce = 4;
  const auto processes = std::size_t(matrix.processes());
  const std::size_t most = ExchangeMatrix::panelBytes(matrix.bytes() / processes) / kHeldAtOnce;
  const std::size_t rounds = entries * RowPanel::kEntryBytes / (most * processes) + 1;
  const std::size_t blocks = std::min(rounds * processes, job.indices.places.size());
  DealtBlocks dealt{divide(starts, blocks, job), {}};
  dealt.job = job.bytes();
  matrix.deal(std::move(dealt), makeMatrixBlockWriter, progress);
}

/// Writes shape, indptr, indices and data.
void writeRows(h5::OutputGroup& group, const ExchangeMatrix& matrix, Progress& progress) {
  const std::int64_t n = std::int64_t(matrix.size());
  const std::int64_t shape[2] = {n, n};
  group.dataset("shape", {Number::i64, 2, 0}, shape, "");
  const std::vector<std::int64_t> indptr = rowStarts(matrix);
  group.dataset("indptr", {Number::i64, indptr.size(), 0}, indptr.data(), "");
  progress.begin("writing form factors", matrix.size());
  const bool single = matrix.precision() == Precision::single_precision;
  const bool chunked = std::size_t(indptr.back()) * sizeof(std::int32_t) > h5::kCompactBytes;
  const auto* const shared = dynamic_cast<const SharedRows*>(&matrix);
  if (shared != nullptr && chunked) {
    writeSharedEntries(group, *shared, indptr, single ? Number::f32 : Number::f64, progress);
  } else if (single) {
    writeEntries<float>(group, matrix, indptr, progress);
  } else {
    writeEntries<double>(group, matrix, indptr, progress);
  }
  progress.end();
}

void countRows(h5::SizeCounter& group, const ExchangeMatrix& matrix) {
  const std::size_t entries = matrix.nonZeros();
  const Number number =
      matrix.precision() == Precision::single_precision ? Number::f32 : Number::f64;
  group.dataset("shape", {Number::i64, 2, 0}, nullptr, "");
  group.dataset("indptr", {Number::i64, matrix.size() + 1, 0}, nullptr, "");
  group.dataset("indices", {Number::i32, entries, 0}, nullptr, "");
  group.dataset("data", {number, entries, 0}, nullptr, "");
}

void writePairs(h5::OutputGroup& group, const ExchangeMatrix& matrix, Progress& progress) {
  group.dataset("area", {Number::f64, matrix.size(), 0}, matrix.area().data(), "m^2");
  if (matrix.isSymmetric()) {
    group.dataset("order", {h5::numberOf<Index>(), matrix.size(), 0}, matrix.order().data(), "");
  }
  const std::vector<double> sums = matrix.rowSums();
  group.dataset("row_sum", {Number::f64, sums.size(), 0}, sums.data(), "");
  writeRows(group, matrix, progress);
}

void countPairs(h5::SizeCounter& group, const ExchangeMatrix& matrix) {
  const std::size_t n = matrix.size();
  group.dataset("area", {Number::f64, n, 0}, nullptr, "m^2");
  if (matrix.isSymmetric()) group.dataset("order", {h5::numberOf<Index>(), n, 0}, nullptr, "");
  group.dataset("row_sum", {Number::f64, n, 0}, nullptr, "");
  countRows(group, matrix);
}

}  // namespace

void writeMatrix(h5::OutputGroup& group, const ExchangeOperator& matrix, Progress& progress) {
  const auto* const cut = dynamic_cast<const CutOperator*>(&matrix);
  if (cut == nullptr) return writePairs(group, pairsOf(matrix), progress);
  group.dataset("area", {Number::f64, matrix.size(), 0}, matrix.area().data(), "m^2");
  h5::OutputGroup rows = group.group(kCutGroup);
  writeCut(rows, *cut, progress);
  if (!cut->parts().pairs) return;
  h5::OutputGroup pairs = rows.group(kPairsGroup);
  writePairs(pairs, *cut->parts().pairs, progress);
}

std::unique_ptr<BlockTaker> makeMatrixBlockWriter(std::span<const std::byte> job) {
  return std::make_unique<MatrixBlockWriter>(BlocksJob::from(job));
}

void countMatrix(h5::SizeCounter& group, const ExchangeOperator& matrix) {
  const auto* const cut = dynamic_cast<const CutOperator*>(&matrix);
  if (cut == nullptr) return countPairs(group, pairsOf(matrix));
  group.dataset("area", {Number::f64, matrix.size(), 0}, nullptr, "m^2");
  h5::SizeCounter rows = group.group(kCutGroup);
  countCut(rows, *cut);
  if (!cut->parts().pairs) return;
  h5::SizeCounter pairs = rows.group(kPairsGroup);
  countPairs(pairs, *cut->parts().pairs);
}

}  // namespace radiosity
