// Makes form factors between groups of patches from those between patches.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "matrix/run_row.h"
#include "radiosity/matrix_functions.h"

namespace radiosity {

namespace {

void requireGroups(const ExchangeOperator& matrix, std::span<const Index> group_of,
                   std::size_t groups) {
  if (group_of.size() != matrix.size()) {
    throw InputError(fmt::format("exchange matrix: groups of {} patches are given for {}",
                                 group_of.size(), matrix.size()));
  }
  for (std::size_t i = 0; i < group_of.size(); ++i) {
    if (group_of[i] < groups) continue;
    throw InputError(fmt::format("exchange matrix: patch {} is in group {}, of {} there are", i,
                                 group_of[i], groups));
  }
}

std::vector<double> areasOf(const ExchangeOperator& matrix, std::span<const Index> group_of,
                            std::size_t groups) {
  std::vector<double> area(groups, 0.0);
  for (std::size_t i = 0; i < group_of.size(); ++i) area[group_of[i]] += matrix.area()[i];
  return area;
}

/// A group without an area exchanges nothing.
double inverseOf(double area) { return area > 0 ? 1 / area : 0.0; }

/// The patches of each group, ascending.
std::vector<std::vector<Index>> patchesOf(std::span<const Index> group_of, std::size_t groups) {
  std::vector<std::vector<Index>> patches(groups);
  for (Index i = 0; i < group_of.size(); ++i) patches[group_of[i]].push_back(i);
  return patches;
}

/// Stores the row of a group with these exchange areas.
void storeRow(std::size_t group, std::span<const double> exchange, RowMatrix& result) {
  const double inverse = inverseOf(result.area()[group]);
  std::vector<Index> columns;
  std::vector<double> values;
  for (Index other = 0; other < exchange.size(); ++other) {
    const double factor = exchange[other] * inverse;
    if (!(factor > 0)) continue;
    columns.push_back(other);
    values.push_back(factor);
  }
  result.setRow(group, columns, values);
}

/// Stores the exchange areas of row k of the triangle.
void storeUpper(std::size_t k, std::span<double> exchange, SymmetricMatrix& result) {
  const double inverse = inverseOf(result.area()[result.order()[k]]);
  for (double& value : exchange) value *= inverse;
  result.setUpperRow(k, exchange);
}

std::shared_ptr<const ExchangeMatrix> aggregatedRows(const RowMatrix& matrix,
                                                     std::span<const Index> group_of,
                                                     std::vector<double> area, Precision stored,
                                                     Progress& progress) {
  const std::size_t groups = area.size();
  const std::vector<std::vector<Index>> patches = patchesOf(group_of, groups);
  auto result = std::make_shared<RowMatrix>(std::move(area), stored);
  parallelFor(groups, 1, [&](std::size_t group) {
    if (progress.cancelled()) return;
    std::vector<double> exchange(groups, 0.0);
    for (const Index i : patches[group]) {
      const double a = matrix.area()[i];
      matrix.forRow(i, [&](Index j, double factor) { exchange[group_of[j]] += a * factor; });
    }
    storeRow(group, exchange, *result);
    progress.advance(patches[group].size());
  });
  progress.check();
  return result;
}

/// The groups in the order in which they first occur among the patches of a symmetric matrix;
/// groups without patches last. As with patches, groups that do not see each other stay neighbours.
std::vector<Index> orderOfGroups(std::span<const Index> patches, std::span<const Index> group_of,
                                 std::size_t groups) {
  std::vector<Index> order;
  std::vector<char> seen(groups, 0);
  const auto add = [&](Index group) {
    if (!std::exchange(seen[group], 1)) order.push_back(group);
  };
  for (const Index i : patches) add(group_of[i]);
  for (Index group = 0; group < groups; ++group) add(group);
  return order;
}

/// Exchange areas of the upper triangle, all values.
class Triangle {
 public:
  explicit Triangle(std::size_t size) : size_(size), values_(size * (size + 1) / 2, 0.0) {}
  /// Row k: from its diagonal on.
  std::span<double> row(std::size_t k) {
    return {values_.data() + k * (2 * size_ - k + 1) / 2, size_ - k};
  }
  void add(std::size_t k, std::size_t other, double exchange) {
    row(std::min(k, other))[std::max(k, other) - std::min(k, other)] += exchange;
  }

 private:
  std::size_t size_;
  std::vector<double> values_;
};

/// Sums exchange areas over the pairs of a symmetric matrix; a pair within one group counts from
/// both ends. `place`: the place of the group, by the position of the patch.
Triangle exchangeOfGroups(const SymmetricMatrix& matrix, std::span<const Index> place,
                          std::size_t groups, Progress& progress) {
  Triangle triangle(groups);
  std::vector<double> exchange(groups, 0.0);  // of one patch, by place
  for (std::size_t k = 0; k < place.size(); ++k) {
    progress.check();
    const Index own = place[k];
    forRuns(matrix.upperRuns(k), [&](std::size_t offset, const auto* values, std::size_t count) {
      const Index* later = &place[k + 1 + offset];
      for (std::size_t m = 0; m < count; ++m) exchange[later[m]] += double(values[m]);
    });
    exchange[own] = 2 * exchange[own] + matrix.diagonal(k);
    const double area = matrix.area()[matrix.order()[k]];
    for (std::size_t other = 0; other < groups; ++other) {
      if (exchange[other] == 0) continue;
      triangle.add(own, other, area * std::exchange(exchange[other], 0.0));
    }
    progress.advance();
  }
  return triangle;
}

std::shared_ptr<const ExchangeMatrix> aggregatedTriangle(const SymmetricMatrix& matrix,
                                                         std::span<const Index> group_of,
                                                         std::vector<double> area, Precision stored,
                                                         Progress& progress) {
  const std::size_t groups = area.size();
  std::vector<Index> order = orderOfGroups(matrix.order(), group_of, groups);
  std::vector<Index> place_of(groups);
  for (Index k = 0; k < groups; ++k) place_of[order[k]] = k;
  std::vector<Index> place;
  place.reserve(group_of.size());
  for (const Index i : matrix.order()) place.push_back(place_of[group_of[i]]);
  Triangle exchange = exchangeOfGroups(matrix, place, groups, progress);
  auto result = std::make_shared<SymmetricMatrix>(std::move(area), std::move(order), stored);
  parallelFor(groups, 16, [&](std::size_t k) { storeUpper(k, exchange.row(k), *result); });
  return result;
}

/// Exchange areas of all pairs of groups: what rows see of some groups at a time is a product.
std::vector<double> exchangeByProducts(const ExchangeOperator& factors,
                                       std::span<const Index> group_of, std::size_t groups,
                                       Progress& progress) {
  constexpr std::size_t kGroupsAtOnce = 16;
  std::vector<double> exchange(groups * groups, 0.0);
  for (std::size_t first = 0; first < groups; first += kGroupsAtOnce) {
    progress.check();
    const std::size_t width = std::min(kGroupsAtOnce, groups - first);
    std::vector<double> members(factors.size() * width, 0.0);
    std::vector<double> seen(members.size());
    for (std::size_t j = 0; j < group_of.size(); ++j) {
      if (group_of[j] - first < width) members[j * width + group_of[j] - first] = 1;
    }
    factors.product(members, int(width), seen);
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const std::size_t i = k / width;
      exchange[group_of[i] * groups + first + k % width] += factors.area()[i] * seen[k];
    }
    progress.advance((first + width) * factors.size() / groups - first * factors.size() / groups);
  }
  return exchange;
}

/// Fits to the light of many patches at once may see a little less than nothing of a group: that is
/// 0, and all others of the row give up a share of theirs, so that its sum stays.
void liftFromBelowZero(std::span<double> row) {
  double sum = 0;
  double above = 0;
  for (const double value : row) {
    sum += value;
    above += std::max(0.0, value);
  }
  const double share = above > 0 ? std::max(0.0, sum) / above : 0.0;
  for (double& value : row) value = share * std::max(0.0, value);
}

/// Of form factors whose pairs are not stored in this process.
std::shared_ptr<const ExchangeMatrix> aggregatedProducts(const ExchangeOperator& factors,
                                                         std::span<const Index> group_of,
                                                         std::vector<double> area, Precision stored,
                                                         Progress& progress) {
  const std::size_t groups = area.size();
  std::vector<double> exchange = exchangeByProducts(factors, group_of, groups, progress);
  const auto rowOf = [&](std::size_t g) { return std::span(exchange).subspan(g * groups, groups); };
  if (factors.isSymmetric()) {
    std::vector<Index> order(groups);
    std::iota(order.begin(), order.end(), Index(0));
    auto result = std::make_shared<SymmetricMatrix>(std::move(area), std::move(order), stored);
    for (std::size_t g = 0; g < groups; ++g) storeUpper(g, rowOf(g).subspan(g), *result);
    return result;
  }
  auto result = std::make_shared<RowMatrix>(std::move(area), stored);
  for (std::size_t g = 0; g < groups; ++g) {
    if (!factors.isNonNegative()) liftFromBelowZero(rowOf(g));
    storeRow(g, rowOf(g), *result);
  }
  return result;
}

}  // namespace

std::shared_ptr<const ExchangeMatrix> aggregated(const ExchangeOperator& factors,
                                                 std::span<const Index> group_of,
                                                 std::size_t groups, Progress& progress,
                                                 std::optional<Precision> stored) {
  requireGroups(factors, group_of, groups);
  std::vector<double> area = areasOf(factors, group_of, groups);
  progress.begin("summing over groups of patches", factors.size());
  std::shared_ptr<const ExchangeMatrix> result;
  if (const auto* const triangle = dynamic_cast<const SymmetricMatrix*>(&factors)) {
    result = aggregatedTriangle(*triangle, group_of, std::move(area),
                                stored.value_or(triangle->precision()), progress);
  } else if (const auto* const rows = dynamic_cast<const RowMatrix*>(&factors)) {
    result = aggregatedRows(*rows, group_of, std::move(area), stored.value_or(rows->precision()),
                            progress);
  } else {
    result = aggregatedProducts(factors, group_of, std::move(area),
                                stored.value_or(Precision::double_precision), progress);
  }
  progress.end();
  return result;
}

}  // namespace radiosity
