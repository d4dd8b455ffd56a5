#include "formfactor/rays/patch_points.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace radiosity {

PatchArea::PatchArea(const PatchMesh& mesh, std::size_t patch)
    : mesh_(mesh),
      pieces_(std::span(mesh.pieces)
                  .subspan(mesh.piece_offset[patch],
                           mesh.piece_offset[patch + 1] - mesh.piece_offset[patch])) {
  for (const auto& [a, b, c] : pieces_) {
    const Vec3& corner = mesh.vertices[a];
    const double twice =
        glm::length(glm::cross(mesh.vertices[b] - corner, mesh.vertices[c] - corner));
    end_.push_back((end_.empty() ? 0.0 : end_.back()) + twice);
  }
}

Vec3 PatchArea::at(double x, double y) const {
  x *= end_.back();
  auto piece = std::size_t(std::ranges::upper_bound(end_, x) - end_.begin());
  piece = std::min(piece, end_.size() - 1);
  const double begin = piece == 0 ? 0.0 : end_[piece - 1];
  // A triangle's points alike by area: the square root of u from its first corner.
  const double u = std::sqrt(std::clamp((x - begin) / (end_[piece] - begin), 0.0, 1.0));
  const auto& [a, b, c] = pieces_[piece];
  return (1 - u) * mesh_.vertices[a] + u * (1 - y) * mesh_.vertices[b] + u * y * mesh_.vertices[c];
}

PatchPoints::PatchPoints(const PatchMesh& mesh, std::size_t patch, const SobolPoints& sobol,
                         std::size_t count, std::uint64_t seed)
    : normal(mesh.normal[patch]), own(&mesh.polygon[patch], 1) {
  std::array<std::vector<float>, kDimensions> numbers;
  PointArrays out{};
  for (std::size_t d = 0; d < kDimensions; ++d) {
    numbers[d].resize(count);
    out[d] = numbers[d].data();
  }
  sobol.points(0, count, seed, out);
  const PatchArea area(mesh, patch);
  for (std::size_t k = 0; k < count; ++k) {
    at.push_back(area.at(double(numbers[0][k]), double(numbers[1][k])));
    of_light.push_back({numbers[2][k], numbers[3][k]});
  }
}

double edgeError(std::size_t points) { return 0.42 * std::pow(double(points), -0.75); }

}  // namespace radiosity
