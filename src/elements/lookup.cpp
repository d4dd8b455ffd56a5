// Finds the place of a point in an element, and the light there.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/parallel.h"
#include "elements/element_parts.h"
#include "radiosity/elements.h"

namespace radiosity {
namespace {

/// A quadrilateral counts as a parallelogram if its fourth corner is this near to that of a
/// parallelogram, in its own coordinates.
constexpr double kParallelogram = 1e-9;

/// The (s, t) in the unit square that a convex quadrilateral with corners (0, 0), (1, 0), c and
/// (0, 1) maps bilinearly to (x, y):  x = s + s t (c.x - 1),  y = t + s t (c.y - 1).
Vec2 inverseBilinear(const Vec2& at, const Vec2& c) {
  const double p = c.x - 1;
  const double q = c.y - 1;
  // With t = y / (1 + s q) the first equation is q s^2 + (1 + p y - q x) s - x = 0. We take the
  // root that is x if q = 0 and p = 0.
  const double b = 1 + p * at.y - q * at.x;
  const double root = std::sqrt(std::max(0.0, b * b + 4 * q * at.x));
  const double sum = b + root;
  const double s = sum > 0 ? 2 * at.x / sum : 0.0;
  const double below = 1 + s * q;
  return {s, std::abs(below) > 1e-12 ? at.y / below : 0.0};
}

Vec2 intoSquare(const Vec2& p) { return {std::clamp(p.x, 0.0, 1.0), std::clamp(p.y, 0.0, 1.0)}; }

Vec2 intoTriangle(const Vec2& p) {
  const Vec2 in{std::max(p.x, 0.0), std::max(p.y, 0.0)};
  const double sum = in.x + in.y;
  return sum > 1 ? in / sum : in;
}

/// Weights of points of a leaf, up to four.
struct Weights {
  std::array<Index, 4> point;
  std::array<double, 4> weight;
  std::size_t count;
};

Weights weightsIn(const std::array<Index, 4>& corner, std::size_t corners, double u, double v) {
  if (corners == 4) return {corner, {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v}, 4};
  return {corner, {1 - u - v, u, v, 0}, 3};
}

/// The part of a triangle that holds (b, c): 0 to 2 at that corner, 3 in the middle. (b, c) become
/// the place in the part.
int triangleAt(double& b, double& c) {
  const double a = 1 - b - c;
  if (a > 0.5) {
    b *= 2;
    c *= 2;
    return 0;
  }
  if (b > 0.5) {
    b = 2 * b - 1;
    c *= 2;
    return 1;
  }
  if (c > 0.5) {
    c = 2 * c - 1;
    b *= 2;
    return 2;
  }
  b = 1 - 2 * b;
  c = 1 - 2 * c;
  return 3;
}

/// The quarter of the unit square that holds (u, v), by its corner. (u, v) become the place in it.
int quarterOf(double& u, double& v) {
  const bool right = u > 0.5;
  const bool upper = v > 0.5;
  u = 2 * u - (right ? 1 : 0);
  v = 2 * v - (upper ? 1 : 0);
  if (upper) return right ? 2 : 3;
  return right ? 1 : 0;
}

/// The part of an element that holds (u, v). (u, v) become the place in it.
int partAt(std::size_t corners, double& u, double& v) {
  return corners == 4 ? quarterOf(u, v) : triangleAt(u, v);
}

/// The leaf at a place of a root. `place` becomes the place in the leaf.
Index leafOf(const ElementField& field, std::size_t root, Vec2& place) {
  auto leaf = Index(root);
  while (field.elements[leaf].first_child != kNone) {
    const Element& element = field.elements[leaf];
    leaf = element.first_child + Index(partAt(element.corners, place.x, place.y));
  }
  return leaf;
}

Weights weightsOf(const ElementField& field, const Element& leaf, double u, double v) {
  const Index* p = field.points.data() + leaf.first_point;
  PartCorners part = {0, 1, 2, std::uint8_t(leaf.corners - 1)};
  if (leaf.tested != 0) part = partsOf(leaf.corners)[std::size_t(partAt(leaf.corners, u, v))];
  return weightsIn({p[part[0]], p[part[1]], p[part[2]], p[part[3]]}, leaf.corners, u, v);
}

}  // namespace

ElementLookup::ElementLookup(const PatchMesh& mesh, const ElementRoots& roots) : roots_(roots) {
  maps_.resize(roots.size());
  parallelFor(roots.size(), 1024, [&](std::size_t r) {
    Map& map = maps_[r];
    const auto& corner = roots.corner[r];
    const bool quad = corner[3] != kNone;
    map.origin = mesh.vertices[corner[0]];
    const Vec3 a = mesh.vertices[corner[1]] - map.origin;
    const Vec3 b = mesh.vertices[corner[quad ? 3 : 2]] - map.origin;
    const Vec3 across = glm::cross(a, b);
    const double square = glm::dot(across, across);
    if (!(square > 0)) return;
    map.u = glm::cross(b, across) / square;
    map.v = glm::cross(across, a) / square;
    if (!quad) return;
    const Vec3 c = mesh.vertices[corner[2]] - map.origin;
    map.third = {glm::dot(map.u, c), glm::dot(map.v, c)};
    map.affine =
        std::abs(map.third.x - 1) < kParallelogram && std::abs(map.third.y - 1) < kParallelogram;
  });
}

Vec2 ElementLookup::place(std::size_t root, const Vec3& at) const {
  const Map& map = maps_[root];
  const Vec3 from = at - map.origin;
  const Vec2 p{glm::dot(map.u, from), glm::dot(map.v, from)};
  if (roots_.corner[root][3] == kNone) return intoTriangle(p);
  return intoSquare(map.affine ? p : inverseBilinear(p, map.third));
}

std::size_t ElementLookup::rootAt(std::size_t patch, const Vec3& at) const {
  const std::size_t first = roots_.of_patch[patch];
  const std::size_t end = roots_.of_patch[patch + 1];
  if (end - first == 1) return first;
  std::size_t best = first;
  double inmost = -1e300;
  for (std::size_t root = first; root < end; ++root) {
    const Map& map = maps_[root];
    const Vec3 from = at - map.origin;
    const double b = glm::dot(map.u, from);
    const double c = glm::dot(map.v, from);
    const double inside = std::min({b, c, 1 - b - c});
    if (inside <= inmost) continue;
    inmost = inside;
    best = root;
  }
  return best;
}

Index ElementLookup::leafAt(const ElementField& field, std::size_t root, Vec2 place) const {
  return field.elements[root].corners == 0 ? kNone : leafOf(field, root, place);
}

bool ElementLookup::add(const ElementField& field, std::size_t root, Vec2 place,
                        std::span<double> sum) const {
  if (field.elements[root].corners == 0) return false;
  const Index leaf = leafOf(field, root, place);
  const Weights w = weightsOf(field, field.elements[leaf], place.x, place.y);
  const std::size_t bands = sum.size();
  for (std::size_t k = 0; k < w.count; ++k) {
    const double* value = field.values.data() + w.point[k] * bands;
    for (std::size_t b = 0; b < bands; ++b) sum[b] += w.weight[k] * value[b];
  }
  return true;
}

}  // namespace radiosity
