#include "results/lit_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/made.h"

namespace radiosity {

namespace {

double brightness(const CellLight& light) {
  const Vec3 sum = light.direct + light.indirect;
  return sum.x + sum.y + sum.z;
}

/// Whether light differs less between corners 0 and 2 of a quadrilateral than between the others. A
/// diagonal between similar values does not show as a ridge.
bool splitsAtFirst(ElementCell cell) {
  const auto apart = [&](std::size_t a, std::size_t b) {
    return std::abs(brightness(cell[a].light) - brightness(cell[b].light));
  };
  return apart(0, 2) <= apart(1, 3);
}

}  // namespace

LitTriangles::LitTriangles(const PatchMesh& mesh, std::span<const double> patches,
                           std::span<const double> corners, const SurfaceLight* elements)
    : mesh_(mesh), patches_(patches), corners_(corners), light_(elements) {
  if (elements != nullptr) cells_.emplace(mesh, *elements->elements);
}

const Vec3& LitTriangles::position(Index point) const {
  if (point > kNone - 1 - middles_.size()) return middles_[kNone - 1 - point];
  return cells_ ? cells_->position(point) : mesh_.vertices[point];
}

/// Whether a patch has elements with light: either all its roots were evaluated or none.
bool LitTriangles::hasElements(Index patch) const {
  if (!cells_) return false;
  const ElementRoots& roots = light_->elements->roots;
  const std::size_t first = roots.of_patch[patch];
  return first < roots.of_patch[patch + 1] && cells_->isEvaluated(first);
}

LitTriangles::Material LitTriangles::materialOf(Index patch) const {
  const auto bands = std::size_t(light_->elements->bands);
  const auto of = [&](const std::vector<double>& values) {
    const double* value = values.data() + patch * bands;
    return bands == 1 ? Vec3(value[0]) : Vec3(value[0], value[1], value[2]);
  };
  return {of(light_->emission), of(light_->reflectance)};
}

/// The value at a vertex of a piece. A vertex inside the patch has the patch's own value.
Vec3 LitTriangles::cornerValue(Index patch, Index vertex) const {
  const auto outline = mesh_.outline(patch);
  const auto found = std::find(outline.begin(), outline.end(), vertex);
  const double* value =
      found == outline.end()
          ? &patches_[3 * std::size_t(patch)]
          : &corners_[3 * (mesh_.corner_offset[patch] + std::size_t(found - outline.begin()))];
  return {value[0], value[1], value[2]};
}

void LitTriangles::append(Index patch, std::vector<LitCorner>& out) {
  if (hasElements(patch)) {
    const ElementRoots& roots = light_->elements->roots;
    const Material material = materialOf(patch);
    for (std::size_t r = roots.of_patch[patch]; r < roots.of_patch[patch + 1]; ++r) {
      made(cells_).forCells(r, [&](ElementCell cell) { appendCell(cell, material, out); });
    }
    return;
  }
  for (std::size_t t = mesh_.piece_offset[patch]; t < mesh_.piece_offset[patch + 1]; ++t) {
    std::array<CellCorner, 3> piece;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index v = mesh_.pieces[t][k];
      piece[k] = {v, {cornerValue(patch, v), Vec3(0.0)}};
    }
    appendCell(piece, {}, out);
  }
}

void LitTriangles::appendEdge(const CellCorner& from, const CellCorner& to) {
  const Index middle = cells_ ? cells_->middle(from.point, to.point) : kNone;
  if (middle == kNone) return;
  const CellCorner between_them{middle, between(from.light, to.light)};
  appendEdge(from, between_them);
  ring_.push_back(between_them);
  appendEdge(between_them, to);
}

/// A new point in the middle of a cell, with the mean of its corners. Such points are numbered from
/// the end.
CellCorner LitTriangles::middleOf(ElementCell cell) {
  Vec3 place(0.0);
  CellLight light;
  for (const CellCorner& corner : cell) {
    place += position(corner.point);
    light += corner.light;
  }
  const double share = 1.0 / double(cell.size());
  middles_.push_back(share * place);
  return {Index(kNone - middles_.size()), share * light};
}

/// Appends a cell: if neighbours cut its edges, it is cut from its middle, else along a diagonal.
void LitTriangles::appendCell(ElementCell cell, const Material& material,
                              std::vector<LitCorner>& out) {
  const auto add = [&](const CellCorner& corner) {
    out.push_back({corner.point, material.radiosity(corner.light)});
  };
  const auto triangle = [&](const CellCorner& a, const CellCorner& b, const CellCorner& c) {
    add(a);
    add(b);
    add(c);
  };
  ring_.clear();
  for (std::size_t k = 0; k < cell.size(); ++k) {
    ring_.push_back(cell[k]);
    appendEdge(cell[k], cell[(k + 1) % cell.size()]);
  }
  if (ring_.size() == 3) return triangle(ring_[0], ring_[1], ring_[2]);
  if (ring_.size() == 4 && cell.size() == 4) {
    const std::size_t first = splitsAtFirst(cell) ? 0 : 1;
    triangle(cell[first], cell[first + 1], cell[first + 2]);
    triangle(cell[first + 2], cell[(first + 3) % 4], cell[first]);
    return;
  }
  const CellCorner middle = middleOf(cell);
  for (std::size_t k = 0; k < ring_.size(); ++k) {
    triangle(middle, ring_[k], ring_[(k + 1) % ring_.size()]);
  }
}

}  // namespace radiosity
