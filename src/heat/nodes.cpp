#include "heat/nodes.h"

#include <fmt/format.h>

#include "base/union_find.h"
#include "heat/conditions.h"

namespace radiosity {

namespace {

void checkRows(const HeatRows& rows, std::size_t n) {
  if (rows.of_row.size() != n || (!rows.twin.empty() && rows.twin.size() != n)) {
    throw InputError(fmt::format("heat: {} rows have {} conditions and {} other sides", n,
                                 rows.of_row.size(), rows.twin.size()));
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (rows.of_row[i] >= rows.conditions.size()) {
      throw InputError(fmt::format("heat: row {} has no condition", i));
    }
  }
  for (std::size_t i = 0; i < rows.twin.size(); ++i) {
    const Index twin = rows.twin[i];
    if (twin == kNone) continue;
    if (twin >= n || rows.of_row[twin] != rows.of_row[i]) {
      throw InputError(fmt::format("heat: row {} and its other side have different conditions", i));
    }
  }
}

/// Joins the rows that have one temperature, by the first of them.
UnionFind together(const HeatRows& rows) {
  UnionFind sets(rows.of_row.size());
  std::vector<Index> first(rows.conditions.size(), kNone);
  for (Index i = 0; i < rows.of_row.size(); ++i) {
    if (!rows.twin.empty() && rows.twin[i] != kNone) sets.unite(i, rows.twin[i]);
    Index& leader = first[rows.of_row[i]];
    if (leader == kNone) leader = i;
    if (rows.conditions[rows.of_row[i]].isothermal) sets.unite(leader, i);
  }
  return sets;
}

}  // namespace

HeatNodes heatNodes(const HeatRows& rows, std::span<const double> area) {
  checkRows(rows, area.size());
  UnionFind sets = together(rows);
  std::vector<double> of_condition(rows.conditions.size(), 0.0);
  for (std::size_t i = 0; i < area.size(); ++i) of_condition[rows.of_row[i]] += area[i];

  HeatNodes out;
  out.of_row.assign(area.size(), kNone);
  for (Index i = 0; i < area.size(); ++i) {
    const Index c = rows.of_row[i];
    if (!isFree(rows.conditions[c])) continue;
    const Index leader = sets.find(i);
    if (leader == i) {
      out.of_row[i] = Index(out.nodes.size());
      out.nodes.push_back({.rows = {}, .condition = c});
    }
    out.of_row[i] = out.of_row[leader];
    HeatNode& node = out.nodes[out.of_row[i]];
    node.rows.push_back(i);
    node.area += area[i];
  }
  for (HeatNode& node : out.nodes) {
    const HeatCondition& condition = rows.conditions[node.condition];
    if (condition.flux) node.supplied = *condition.flux * node.area;
    if (!condition.power) continue;
    const double whole = of_condition[node.condition];
    if (!(whole > 0)) {
      throw InputError(condition.name + ": has a power and no area to give it off");
    }
    node.supplied = *condition.power * (node.area / whole);
  }
  return out;
}

}  // namespace radiosity
