// Points over the area of a patch.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/rays/sobol.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// The triangles of a patch, to choose a place on them by two numbers.
class PatchArea {
 public:
  /// `mesh` is kept by reference.
  PatchArea(const PatchMesh& mesh, std::size_t patch);
  /// m^2
  double size() const { return end_.empty() ? 0.0 : end_.back() / 2; }
  /// Numbers spread evenly over [0, 1)^2 give places alike by area. Precondition: size() > 0.
  Vec3 at(double x, double y) const;
  std::span<const std::array<Index, 3>> pieces() const { return pieces_; }
  /// m^2
  double sizeOf(std::size_t piece) const {
    return (end_[piece] - (piece == 0 ? 0.0 : end_[piece - 1])) / 2;
  }

 private:
  const PatchMesh& mesh_;
  std::span<const std::array<Index, 3>> pieces_;
  std::vector<double> end_;  ///< twice the area of all pieces up to each
};

/// Points alike by area, each with two numbers more, which choose a place of what it is lit by.
/// Precondition: the patch has an area.
struct PatchPoints {
  PatchPoints(const PatchMesh& mesh, std::size_t patch, const SobolPoints& sobol, std::size_t count,
              std::uint64_t seed);

  std::vector<Vec3> at;
  std::vector<std::array<float, 2>> of_light;
  Vec3 normal;
  std::span<const Index> own;  ///< the polygon that all lie on
};

/// What shadow rays of points in two nets, `points` in all, leave unknown of a patch that is seen
/// in part: the share of a patch on one side of a straight edge is off by .42 n^-3/4 of it (root
/// mean square of 300 edges across a square, n from 128 to 8,192). A share of the whole.
double edgeError(std::size_t points);

}  // namespace radiosity
