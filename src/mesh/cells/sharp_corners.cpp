#include "mesh/cells/sharp_corners.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace radiosity {

namespace {

/// An edge that leaves a vertex.
struct Leaving {
  Vec3 direction;
  Index edge;
};

/// Tests pairs whose directions are near each other along one axis, nearest first, until no pair
/// can be sharper than those found. Directions at less than a right angle are at most sqrt(2) times
/// the sine apart.
void lookAround(std::vector<Leaving>& at, std::vector<double>& sines) {
  std::sort(at.begin(), at.end(), [](const Leaving& a, const Leaving& b) {
    return a.direction.x != b.direction.x ? a.direction.x < b.direction.x : a.edge < b.edge;
  });
  const auto tooFar = [&](const Leaving& from, const Leaving& to) {
    return std::abs(to.direction.x - from.direction.x) > 1.5 * sines[from.edge];
  };
  const auto look = [&](const Leaving& from, const Leaving& to) {
    if (glm::dot(from.direction, to.direction) <= 0) return;
    const double sine = glm::length(glm::cross(from.direction, to.direction));
    sines[from.edge] = std::min(sines[from.edge], sine);
  };
  for (std::size_t i = 0; i < at.size(); ++i) {
    for (std::size_t j = i + 1; j < at.size() && !tooFar(at[i], at[j]); ++j) look(at[i], at[j]);
    for (std::size_t j = i; j > 0 && !tooFar(at[i], at[j - 1]); --j) look(at[i], at[j - 1]);
  }
}

}  // namespace

std::vector<double> sharpestSines(const std::vector<Vec3>& vertices,
                                  const std::vector<std::array<Index, 2>>& edges) {
  std::vector<std::vector<Leaving>> at(vertices.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto& [a, b] = edges[e];
    const Vec3 along = glm::normalize(vertices[b] - vertices[a]);
    at[a].push_back({along, Index(e)});
    at[b].push_back({-along, Index(e)});
  }
  std::vector<double> sines(edges.size(), 1.0);
  for (auto& leaving : at) lookAround(leaving, sines);
  return sines;
}

}  // namespace radiosity
