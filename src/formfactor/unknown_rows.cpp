#include "formfactor/unknown_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/clusters/cluster_means.h"

namespace radiosity {

UnknownRows::UnknownRows(const PatchMesh& mesh, std::span<const Index> wanted)
    : mesh_(mesh),
      which_(mesh.unknowns(), kNone),
      exchange_(wanted.size() * mesh.unknowns(), 0.0),
      squares_(exchange_.size(), 0.0),
      rows_(wanted.size()),
      area_(unknownAreas(mesh)) {
  for (Index w = 0; w < wanted.size(); ++w) {
    which_[wanted[w]] = w;
    rows_[w].unknown = wanted[w];
  }
}

void UnknownRows::add(Index a, Index b, double exchange, double error) {
  addFrom(mesh_.unknownOf(a), mesh_.unknownOf(b), exchange, error);
  addFrom(mesh_.unknownOf(b), mesh_.unknownOf(a), exchange, error);
}

void UnknownRows::addBacks(Index patch, std::span<const SeenBack> seen) {
  const Index unknown = mesh_.unknownOf(patch);
  if (which_[unknown] == kNone) return;
  std::vector<SeenBack>& backs = rows_[which_[unknown]].backs;
  for (const auto& [surface, of_patch] : seen) {
    addBack({surface, of_patch * mesh_.area[patch] / area_[unknown]}, backs);
  }
}

std::vector<KnownRow> UnknownRows::take() {
  const std::size_t unknowns = mesh_.unknowns();
  for (std::size_t w = 0; w < rows_.size(); ++w) {
    for (Index u = 0; u < unknowns; ++u) {
      const double exchange = exchange_[w * unknowns + u];
      if (!(exchange > 0)) continue;
      rows_[w].entries.push_back({u, exchange, std::sqrt(squares_[w * unknowns + u])});
    }
  }
  return std::move(rows_);
}

void UnknownRows::addFrom(Index from, Index to, double exchange, double error) {
  if (which_[from] == kNone) return;
  const std::size_t k = which_[from] * mesh_.unknowns() + to;
  exchange_[k] += exchange;
  squares_[k] += error * error;
}

}  // namespace radiosity
