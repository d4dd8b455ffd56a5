// Meshes: matched by position, compared by means over cells.
#include "radiosity/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/geometry/box.h"
#include "base/geometry/surface_index.h"
#include "base/option_list.h"
#include "base/parallel.h"
#include "compare/differences.h"
#include "radiosity/spelling.h"

namespace radiosity {
namespace {

constexpr double kEnough = 0.99;  ///< share of the area that must match

std::string textOf(const Box3& box) {
  return fmt::format("{:.4g},{:.4g},{:.4g} to {:.4g},{:.4g},{:.4g}", box.low.x, box.low.y,
                     box.low.z, box.high.x, box.high.y, box.high.z);
}

Box3 boxOf(const LightField& field) {
  Box3 box;
  for (const auto& triangle : field.triangles) {
    for (const Index v : triangle) box.add(field.vertices[v]);
  }
  return box;
}

struct Triangle {
  std::array<Vec3, 3> corner;
  Vec3 normal{0.0};
  double area = 0;
};

Triangle triangleOf(const LightField& field, std::size_t t) {
  Triangle triangle;
  for (std::size_t k = 0; k < 3; ++k) triangle.corner[k] = field.vertices[field.triangles[t][k]];
  const Vec3 cross =
      glm::cross(triangle.corner[1] - triangle.corner[0], triangle.corner[2] - triangle.corner[0]);
  const double length = glm::length(cross);
  triangle.area = 0.5 * length;
  if (length > 0) triangle.normal = cross / length;
  return triangle;
}

double areaOf(const LightField& field) {
  double area = 0;
  for (std::size_t t = 0; t < field.triangles.size(); ++t) area += triangleOf(field, t).area;
  return area;
}

/// Calls visit(barycentric weights) for the middles of the n^2 equal triangles a triangle is cut
/// into: their mean is exact for linear values.
template <class Visit>
void forSubTriangles(int n, const Visit& visit) {
  const auto at = [&](double u, double v) { visit(Vec3(1 - (u + v) / n, u / n, v / n)); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      at(i + 1.0 / 3, j + 1.0 / 3);
      if (i + j < n - 1) at(i + 2.0 / 3, j + 2.0 / 3);
    }
  }
}

/// Adds area times the value at a point of triangle t, all bands.
void addValue(const LightField& field, std::size_t t, const Vec3& weights, double area,
              std::span<double> sum) {
  const std::size_t bands = sum.size();
  const double* v0 = field.values.data() + 3 * bands * t;
  const double* v1 = v0 + bands;
  const double* v2 = v1 + bands;
  for (std::size_t b = 0; b < bands; ++b) {
    // We sum differences, so that a constant is reproduced exactly.
    sum[b] += area * (v0[b] + weights.y * (v1[b] - v0[b]) + weights.z * (v2[b] - v0[b]));
  }
}

bool isClipped(const LightField& field, std::size_t t) {
  return !field.clipped.empty() && field.clipped[t] != 0;
}

bool emits(const LightField& field, std::size_t t) {
  return !field.emits.empty() && field.emits[field.cell[t]] != 0;
}

/// Sums over the part of one triangle that has a counterpart on the other side.
struct Found {
  double area = 0;      ///< compared
  double clipped = 0;   ///< matched, but one side is clipped there
  double opposite = 0;  ///< not matched: the other side faces the other way
  Vec3 place{0.0};      ///< integral over the area compared
  bool emits = false;   ///< some part emits, on this side or the other
};

/// The same for all triangles of one side.
struct AllFound {
  AllFound(std::size_t count, int band_count)
      : bands(std::size_t(band_count)),
        triangles(count),
        own(count * bands, 0.0),
        other(count * bands, 0.0) {}
  std::span<double> ownOf(std::size_t t) { return {own.data() + t * bands, bands}; }
  std::span<double> otherOf(std::size_t t) { return {other.data() + t * bands, bands}; }

  std::size_t bands;
  std::vector<Found> triangles;
  std::vector<double> own;  ///< triangles * bands: integrals over the area compared
  std::vector<double> other;
};

class Matcher {
 public:
  Matcher(const LightField& own, const LightField& other, const SurfaceIndex& index, double reach)
      : own_(own), other_(other), index_(index), reach_(reach) {
    mean_area_ = areaOf(other) / double(other.triangles.size());
  }

  AllFound run() const {
    AllFound found(own_.triangles.size(), own_.bands);
    constexpr std::size_t kGrain = 32;
    parallelFor(found.triangles.size(), kGrain, [&](std::size_t t) {
      found.triangles[t] = match(t, found.ownOf(t), found.otherOf(t));
    });
    return found;
  }

 private:
  Found match(std::size_t t, std::span<double> own, std::span<double> other) const {
    const Triangle triangle = triangleOf(own_, t);
    Found found;
    if (!(triangle.area > 0)) return found;
    // About four samples for each triangle of the other side, and at least four for this one.
    constexpr double kMost = 16;
    const double fine = 2 * std::sqrt(triangle.area / mean_area_);
    const int n = int(std::clamp(std::ceil(fine), 2.0, kMost));
    const double area = triangle.area / (double(n) * n);
    forSubTriangles(n, [&](const Vec3& w) {
      const Vec3 point =
          triangle.corner[0] * w.x + triangle.corner[1] * w.y + triangle.corner[2] * w.z;
      const auto hit = index_.nearest(point, triangle.normal, reach_);
      if (!hit) {
        if (index_.nearest(point, -triangle.normal, reach_)) found.opposite += area;
      } else if (isClipped(own_, t) || isClipped(other_, hit->triangle)) {
        found.clipped += area;
      } else {
        found.area += area;
        addValue(own_, t, w, area, own);
        addValue(other_, hit->triangle, hit->weights, area, other);
        found.place += area * point;
        found.emits = found.emits || emits(own_, t) || emits(other_, hit->triangle);
      }
    });
    return found;
  }

  const LightField& own_;
  const LightField& other_;
  const SurfaceIndex& index_;
  double reach_;
  double mean_area_ = 0;
};

struct Matched {
  double compared = 0;
  double clipped = 0;
  double opposite = 0;
};

Matched totalOf(const AllFound& found) {
  Matched total;
  for (const Found& f : found.triangles) {
    total.compared += f.area;
    total.clipped += f.clipped;
    total.opposite += f.opposite;
  }
  return total;
}

void requireEnough(const LightField& a, const LightField& b, const Comparison& comparison,
                   double opposite, const CompareOptions& options) {
  const auto share = [](double part, double whole) { return whole > 0 ? part / whole : 0; };
  const double of_a = share(comparison.matched_a, comparison.area_a);
  const double of_b = share(comparison.matched_b, comparison.area_b);
  if (of_a > 0 && of_b > 0 && (options.partial || std::min(of_a, of_b) >= kEnough)) return;
  std::string cure = fmt::format(
      "A spans {}, B {}; bring both into the same unit and axes, or allow points farther apart "
      "with {}{}",
      textOf(boxOf(a)), textOf(boxOf(b)), spelled("match"),
      of_a > 0 && of_b > 0 ? ", or compare what there is with " + spelled("partial") : "");
  if (share(opposite, comparison.area_a) > 0.01) {
    cure = fmt::format(
        "{:.3g}% of A has a surface of B in its place that faces the other way: "
        "turn its faces over",
        100 * share(opposite, comparison.area_a));
  }
  throw InputError(fmt::format(
      "{} and {} are not the same surfaces: {:.2f}% of A's area and {:.2f}% of B's lie on the "
      "other, {:g}% are asked for; {}",
      a.name, b.name, 100 * of_a, 100 * of_b, 100 * kEnough, cure));
}

void requireBands(const LightField& a, const LightField& b) {
  if (a.bands == b.bands) return;
  const auto text = [](int bands) {
    return fmt::format("{} band{}", bands, bands == 1 ? "" : "s");
  };
  throw InputError(fmt::format(
      "{} has {} and {} has {}, so there is nothing to set against each other; compare light of "
      "the same bands: solve or gather both with materials of as many",
      a.name, text(a.bands), b.name, text(b.bands)));
}

void requireUnits(const LightField& a, const LightField& b, const CompareOptions& options) {
  if (a.relative == b.relative || options.fit_scale) return;
  const bool first = a.relative;
  throw InputError(fmt::format(
      "{}: is coded for a screen (srgb8), of unknown exposure, and {} has a unit; add {}, "
      "or export the light itself as floats",
      first ? a.name : b.name, first ? b.name : a.name, spelled("fit_scale")));
}

bool sameCells(const LightField& a, const LightField& b) {
  return a.constant && b.constant && a.clipped.empty() && b.clipped.empty() &&
         a.triangles == b.triangles && a.cell == b.cell && a.vertices == b.vertices;
}

/// One pair for each cell of `own`. `own_is_a`: `own` is side A, the other is B.
ValuePairs pairsOf(const LightField& own, const AllFound& found, bool own_is_a) {
  ValuePairs pairs(own.cell_surface.size(), own.bands);
  const std::size_t bands = found.bands;
  const std::vector<double>& a = own_is_a ? found.own : found.other;
  const std::vector<double>& b = own_is_a ? found.other : found.own;
  for (std::size_t t = 0; t < found.triangles.size(); ++t) {
    const std::size_t c = own.cell[t];
    PairWeight& pair = pairs.weights[c];
    pair.weight += found.triangles[t].area;
    pair.place += found.triangles[t].place;
    pair.emits = pair.emits || found.triangles[t].emits;
    for (std::size_t k = 0; k < bands; ++k) {
      pairs.ofA(c)[k] += a[bands * t + k];
      pairs.ofB(c)[k] += b[bands * t + k];
    }
  }
  for (std::size_t c = 0; c < pairs.weights.size(); ++c) {
    PairWeight& pair = pairs.weights[c];
    pair.surface = own.cell_surface[c];
    if (!(pair.weight > 0)) continue;
    pair.place /= pair.weight;
    for (double& value : pairs.ofA(c)) value /= pair.weight;
    for (double& value : pairs.ofB(c)) value /= pair.weight;
  }
  return pairs;
}

/// Pairs triangle t with triangle t: both sides have the same cells, so no search is needed.
AllFound pairUp(const LightField& a, const LightField& b) {
  AllFound found(a.triangles.size(), a.bands);
  const Vec3 first_corner(1, 0, 0);  // values are constant on it
  for (std::size_t t = 0; t < found.triangles.size(); ++t) {
    const Triangle triangle = triangleOf(a, t);
    const Vec3 middle = (triangle.corner[0] + triangle.corner[1] + triangle.corner[2]) / 3.0;
    found.triangles[t] = {triangle.area, 0, 0, triangle.area * middle, emits(a, t) || emits(b, t)};
    addValue(a, t, first_corner, triangle.area, found.ownOf(t));
    addValue(b, t, first_corner, triangle.area, found.otherOf(t));
  }
  return found;
}

}  // namespace

void CompareOptions::validate() const { requireRanges(*this); }

Comparison compare(const LightField& a, const LightField& b, const CompareOptions& options) {
  options.validate();
  requireBands(a, b);
  requireUnits(a, b, options);
  const bool own_is_a = a.constant || !b.constant;
  const LightField& own = own_is_a ? a : b;
  const LightField& other = own_is_a ? b : a;
  Comparison comparison;
  comparison.cells_of_b = !own_is_a;
  comparison.area_a = areaOf(a);
  comparison.area_b = areaOf(b);
  AllFound found(0, own.bands);
  double opposite = 0;
  if (sameCells(a, b)) {
    found = pairUp(a, b);
    comparison.matched_a = comparison.matched_b = comparison.area_a;
  } else {
    const double reach = options.match * boxOf(a).diagonal();
    const SurfaceIndex other_index(other.vertices, other.triangles);
    found = Matcher(own, other, other_index, reach).run();
    const SurfaceIndex own_index(own.vertices, own.triangles);
    const Matched of_own = totalOf(found);
    const Matched of_other = totalOf(Matcher(other, own, own_index, reach).run());
    const Matched& of_a = own_is_a ? of_own : of_other;
    const Matched& of_b = own_is_a ? of_other : of_own;
    comparison.matched_a = of_a.compared + of_a.clipped;
    comparison.matched_b = of_b.compared + of_b.clipped;
    comparison.clipped = of_own.clipped;
    opposite = of_a.opposite;
  }
  requireEnough(a, b, comparison, opposite, options);
  ValuePairs pairs = pairsOf(own, found, own_is_a);
  measureDifferences(pairs, options, own.surface_names, comparison);
  std::vector<double> given(own.surface_names.size(), 0.0);
  for (std::size_t t = 0; t < own.triangles.size(); ++t) {
    given[own.cell_surface[own.cell[t]]] += triangleOf(own, t).area;
  }
  for (SurfaceDifference& surface : comparison.surfaces) {
    const auto at = std::find(own.surface_names.begin(), own.surface_names.end(), surface.name);
    surface.given = given[std::size_t(at - own.surface_names.begin())];
  }
  return comparison;
}

}  // namespace radiosity
