#include "formfactor/hemicube/kept_row.h"

#include <utility>

#include "base/byte_stream.h"

namespace radiosity {

namespace {

/// Columns as distances from the one before: neighbours take a byte.
template <class Value>
void putEntries(const RowMatrix& matrix, std::size_t i, ByteWriter& bytes) {
  std::vector<Index> columns;
  std::vector<Value> values;
  matrix.forRow(i, [&](Index column, double value) {
    columns.push_back(column);
    values.push_back(Value(value));  // as it is stored
  });
  bytes.putArray(std::span<const Value>(values));
  Index before = 0;
  for (const Index column : columns) {
    bytes.putVarint(column - before);
    before = column;
  }
}

template <class Value>
void takeEntries(ByteReader& bytes, std::vector<Index>& columns, std::vector<double>& values) {
  Index column = 0;
  for (const Value value : bytes.getArray<Value>()) {
    column += Index(bytes.getVarint());
    columns.push_back(column);
    values.push_back(value);
  }
}

bool isSingle(const RowMatrix& matrix) { return matrix.precision() == Precision::single_precision; }

}  // namespace

void keepRow(RowJournal& journal, std::size_t i, const RowMatrix& matrix, const FormFactors& result,
             const std::vector<SeenBack>& seen_backs, const HemicubeReport& counts) {
  ByteWriter bytes;
  if (isSingle(matrix)) {
    putEntries<float>(matrix, i, bytes);
  } else {
    putEntries<double>(matrix, i, bytes);
  }
  bytes.put(result.fronts[i]);
  bytes.put(result.backs[i]);
  bytes.put(result.sky[i]);
  bytes.putArray(std::span<const SeenBack>(seen_backs));
  bytes.put(counts);
  journal.keep(RowBlock::hemicube_row, i, bytes.bytes());
}

bool takeRow(const RowJournal& journal, std::size_t i, RowMatrix& matrix, FormFactors& result,
             std::vector<SeenBack>& seen_backs, HemicubeReport& counts) {
  if (!journal.has(RowBlock::hemicube_row, i)) return false;
  const std::vector<std::byte> block = journal.kept(RowBlock::hemicube_row, i);
  ByteReader bytes(block);
  std::vector<Index> columns;
  std::vector<double> values;
  if (isSingle(matrix)) {
    takeEntries<float>(bytes, columns, values);
  } else {
    takeEntries<double>(bytes, columns, values);
  }
  const auto fronts = bytes.get<double>();
  const auto backs = bytes.get<double>();
  const auto sky = bytes.get<double>();
  std::vector<SeenBack> seen = bytes.getArray<SeenBack>();
  const auto counted = bytes.get<HemicubeReport>();
  if (!bytes.isWhole()) return false;
  matrix.setRow(i, columns, values);
  result.fronts[i] = fronts;
  result.backs[i] = backs;
  result.sky[i] = sky;
  seen_backs = std::move(seen);
  counts += counted;
  return true;
}

}  // namespace radiosity
