#include "matrix/row_parts.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/byte_stream.h"
#include "base/parallel.h"
#include "matrix/make_room.h"
#include "matrix/sort_entries.h"

namespace radiosity {

namespace {

constexpr std::size_t kRowsAtOnce = 64;

}  // namespace

RowsPart partOf(const ExchangeMatrix& own, RowRange rows) {
  RowsPart part;
  part.counts.assign(rows.size(), 0);
  const RowPanel panel(own, rows.first, rows.last);
  parallelFor(rows.size(), kRowsAtOnce, [&](std::size_t row) {
    panel.forRow(rows.first + row, [&](Index, double) { ++part.counts[row]; });
  });
  std::vector<std::size_t> starts{0};
  starts.reserve(rows.size() + 1);
  for (const Index count : part.counts) starts.push_back(starts.back() + count);
  part.columns.resize(starts.back());
  part.values.resize(starts.back());
  parallelFor(rows.size(), kRowsAtOnce, [&](std::size_t row) {
    std::size_t at = starts[row];
    panel.forRow(rows.first + row, [&](Index column, double value) {
      part.columns[at] = column;
      part.values[at++] = value;
    });
  });
  return part;
}

RowsPart rowsOf(const RowsPart& part, RowRange rows) {
  const auto counts = std::span(part.counts);
  const auto entries = [](std::span<const Index> of_rows) {
    return std::accumulate(of_rows.begin(), of_rows.end(), std::size_t(0));
  };
  const auto taken = counts.subspan(rows.first, rows.size());
  const std::size_t first = entries(counts.first(rows.first));
  const std::size_t last = first + entries(taken);
  return {
      {taken.begin(), taken.end()},
      {part.columns.begin() + std::ptrdiff_t(first), part.columns.begin() + std::ptrdiff_t(last)},
      {part.values.begin() + std::ptrdiff_t(first), part.values.begin() + std::ptrdiff_t(last)}};
}

std::vector<std::byte> bytesOf(const RowsPart& part) {
  ByteWriter bytes;
  bytes.putArray(std::span(part.counts));
  bytes.putArray(std::span(part.columns));
  bytes.putArray(std::span(part.values));
  return bytes.take();
}

RowsPart partFrom(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  RowsPart part;
  part.counts = reader.getArray<Index>();
  part.columns = reader.getArray<Index>();
  part.values = reader.getArray<double>();
  return part;
}

void mergeParts(std::span<const RowsPart> parts, std::size_t n, CompressedRows& rows) {
  const std::size_t count = parts.empty() ? 0 : parts.front().counts.size();
  rows.starts.assign(count + 1, 0);
  std::vector<std::size_t> from(parts.size() * count);  // the first entry of a row in each part
  for (std::size_t p = 0; p < parts.size(); ++p) {
    std::size_t before = 0;
    for (std::size_t row = 0; row < count; ++row) {
      from[p * count + row] = std::exchange(before, before + parts[p].counts[row]);
      rows.starts[row + 1] += parts[p].counts[row];
    }
  }
  for (std::size_t row = 0; row < count; ++row) rows.starts[row + 1] += rows.starts[row];
  makeRoom(rows.columns, rows.starts.back());
  makeRoom(rows.values, rows.starts.back());
  tbb::enumerable_thread_specific<EntrySorter> sorters;
  parallelFor(count, kRowsAtOnce, [&](std::size_t row) {
    std::size_t at = rows.starts[row];
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const std::size_t entries = parts[p].counts[row];
      const std::size_t first = from[p * count + row];
      std::copy_n(parts[p].columns.data() + first, entries, rows.columns.data() + at);
      std::copy_n(parts[p].values.data() + first, entries, rows.values.data() + at);
      at += entries;
    }
    const std::size_t entries = at - rows.starts[row];
    sorters.local().sort(std::span(rows.columns).subspan(rows.starts[row], entries),
                         std::span(rows.values).subspan(rows.starts[row], entries), n);
  });
}

}  // namespace radiosity
