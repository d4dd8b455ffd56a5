#include <tbb/enumerable_thread_specific.h>

#include "base/parallel.h"
#include "cosine_rays.h"

namespace radiosity::bench {
namespace {

/// Rows as counts, sorted by column.
struct CountedRow {
  std::vector<Index> columns;
  std::vector<std::uint32_t> hits;
};

/// The same entries by column: for each j, who hit it and how often.
std::vector<CountedRow> transposed(const std::vector<CountedRow>& rows) {
  std::vector<std::size_t> count(rows.size(), 0);
  for (const CountedRow& row : rows) {
    for (const Index j : row.columns) ++count[j];
  }
  std::vector<CountedRow> result(rows.size());
  for (std::size_t j = 0; j < rows.size(); ++j) {
    result[j].columns.reserve(count[j]);
    result[j].hits.reserve(count[j]);
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = 0; k < rows[i].columns.size(); ++k) {
      CountedRow& row = result[rows[i].columns[k]];
      row.columns.push_back(Index(i));
      row.hits.push_back(rows[i].hits[k]);
    }
  }
  return result;
}

struct ValuedRow {
  std::vector<Index> columns;
  std::vector<double> values;
};

/// Row i of the estimates of both ends: F_ij = A_j (F_ij + F_ji) / (A_i + A_j).
void mergeRow(std::size_t i, const CountedRow& cast, const CountedRow& received,
              const std::vector<double>& area, double ray, ValuedRow& out) {
  out.columns.clear();
  out.values.clear();
  std::size_t a = 0;
  std::size_t b = 0;
  while (a < cast.columns.size() || b < received.columns.size()) {
    const Index from_a = a < cast.columns.size() ? cast.columns[a] : kNone;
    const Index from_b = b < received.columns.size() ? received.columns[b] : kNone;
    const Index j = std::min(from_a, from_b);
    double hits = 0;
    if (from_a == j) hits += cast.hits[a++];
    if (from_b == j) hits += received.hits[b++];
    out.columns.push_back(j);
    out.values.push_back(hits * ray * area[j] / (area[i] + area[j]));
  }
}

}  // namespace

FormFactors castFormFactors(const PatchMesh& mesh, std::uint32_t rays, bool both_ends) {
  const std::size_t n = mesh.size();
  const double ray = 1.0 / rays;
  const CosineRays caster(mesh);
  FormFactors result;
  result.method = "rays";
  result.matrix = ExchangeMatrix(mesh.area, Precision::single_precision);
  result.fronts.assign(n, 0.0);
  result.backs.assign(n, 0.0);
  result.sky.assign(n, 0.0);
  std::vector<CountedRow> rows(n);
  tbb::enumerable_thread_specific<CosineRays::Row> scratch;
  parallelFor(n, 1, [&](std::size_t i) {
    CosineRays::Row& row = scratch.local();
    caster.cast(i, rays, row);
    for (Index j = 0; j < n; ++j) {
      if (row.hits[j] == 0) continue;
      rows[i].columns.push_back(j);
      rows[i].hits.push_back(row.hits[j]);
    }
    for (std::size_t s = n; s < row.hits.size(); ++s) result.backs[i] += ray * row.hits[s];
    result.sky[i] = ray * row.sky;
  });
  const std::vector<CountedRow> received = both_ends ? transposed(rows) : std::vector<CountedRow>();
  tbb::enumerable_thread_specific<ValuedRow> valued;
  parallelFor(n, 16, [&](std::size_t i) {
    ValuedRow& row = valued.local();
    if (both_ends) {
      mergeRow(i, rows[i], received[i], mesh.area, ray, row);
    } else {
      row.columns = rows[i].columns;
      row.values.clear();
      for (const std::uint32_t hits : rows[i].hits) row.values.push_back(ray * hits);
    }
    result.matrix.setRow(i, row.columns, row.values);
    for (const double value : row.values) result.fronts[i] += value;
  });
  result.report.matrix_bytes = result.matrix.bytes();
  return result;
}

}  // namespace radiosity::bench
