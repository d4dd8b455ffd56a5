// Light at points after the solve: irradiance at the vertices of elements, finer than patches where
// light changes. Patches are the right size for sources, elements for receivers (Cohen, Greenberg,
// Immel & Brock, "An Efficient Radiosity Approach for Realistic Image Synthesis", 1986).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/patch_mesh.h"

namespace [[gnu::visibility("default")]] radiosity {

struct ElementOptions {
  /// 1e-4 to 0.5: error of interpolation at which an element is cut, over the irradiance there
  /// (at least a tenth of the scene's mean), for elements a twentieth of the scene's diagonal long;
  /// shorter ones are allowed more, in proportion. Indirect light is never refined below three
  /// times the noise of its rays; vertices whose rays have a spread (standard error over mean) of
  /// more than seven tolerances take eight times as many.
  double tolerance = 0.01;
  /// 1e-5 to 0.1 of the scene's diagonal: no element with a shorter edge is cut.
  double smallest_edge = 0.002;
  /// 1 or more, of each field: where refinement would take more, what promises least stays coarse.
  std::size_t most_vertices = 400000;
  /// Of the second pass, at a vertex: a power of two, 64 to 4096. The first pass has a quarter.
  int rays = 512;
  /// 1 or more, of both passes together: where it would take more, each vertex has fewer rays.
  double most_rays = 1e8;
  double crease = 30;      ///< degrees, 0 to 180; elements across sharper edges share no vertex
  std::uint64_t seed = 1;  ///< of the rays' directions

  /// Throws InputError naming the option and its range.
  void validate() const;
};

/// Where the trees stand: each patch that is a triangle or a convex quadrilateral is one root, of
/// any other each of its pieces.
struct ElementRoots {
  std::vector<Index> patch;  ///< R
  std::vector<std::array<Index, 4>>
      corner;                         ///< R, vertices of the mesh; a triangle's fourth: kNone
  std::vector<std::size_t> of_patch;  ///< N + 1, into the above: roots of each patch

  std::size_t size() const { return patch.size(); }
  std::size_t cornerCount(std::size_t root) const { return corner[root][3] == kNone ? 3 : 4; }
};

/// An element. Its points are its corners, then, where `tested`, the middles of its edges (k: from
/// corner k to the next) and, of a quadrilateral, its centre. Its four children: of a quadrilateral
/// child k at corner k, with corners in the same order; of a triangle likewise, the fourth in the
/// middle, whose corner k is the middle of the edge opposite corner k.
struct Element {
  Index first_child = kNone;  ///< kNone: a leaf
  Index first_point = 0;      ///< into ElementField::points
  std::uint8_t corners = 0;   ///< 3 or 4; 0: a root that was not evaluated
  std::uint8_t tested = 0;    ///< 1: there are middles
};

/// One kind of light on a forest over the patches.
struct ElementField {
  std::vector<Element> elements;  ///< the first R are the roots
  std::vector<Index> points;      ///< vertices
  std::vector<double> values;     ///< V * bands: irradiance, W/m^2
  std::size_t vertices = 0;       ///< V
};

/// How direct light was found.
enum class DirectLight {
  none,        ///< nothing shines but, maybe, the sky
  exact,       ///< clipped exactly
  partly,      ///< exactly, but in some places by rays to the emitters: too much is in between
  rays,        ///< by rays to the emitters, which are many
  hemispheres  ///< with the indirect light: emitters are too many to aim at
};

struct ElementReport {
  DirectLight direct = DirectLight::none;
  std::size_t roots = 0;
  std::size_t emitters = 0;           ///< convex pieces
  std::size_t direct_vertices = 0;    ///< evaluated
  std::size_t direct_by_rays = 0;     ///< of them, by rays to the emitters
  std::size_t indirect_vertices = 0;  ///< evaluated, in both passes
  double uniform_vertices = 0;        ///< of a grid of the size of the smallest element
  std::size_t unrefined = 0;          ///< elements left coarse since there were most_vertices
  double rays = 0;
  int rays_a_vertex = 0;  ///< of the second pass
  double edge = 0;        ///< metres: the shortest edge of a leaf
  /// Root mean square error over the area, relative to that of irradiance: of interpolation, from
  /// the refinement's checks; of rays, from the difference of their halves.
  double interpolation_error = 0;
  double ray_error = 0;
  double seconds_direct = 0;  ///< by the clock
  double seconds_indirect = 0;
};

/// Irradiance in two fields, view independent.
struct Elements {
  int bands = 3;
  ElementRoots roots;
  ElementField direct;    ///< from emitters
  ElementField indirect;  ///< from everything else, the sky included
  ElementReport report;

  bool empty() const { return roots.size() == 0; }
};

/// Evaluates irradiance at element vertices. `irradiance`: N * bands, of the solved patches, W/m^2.
/// Direct light is found exactly, point to polygon, with what is in between clipped off; indirect
/// light by rays in two passes, the first pass's elements being the sources of the second.
/// `wanted`: N, 1: patches whose elements are wanted; empty: all. Others are left out, but for what
/// these receive from them. The same bits for any number of threads. Errors: InputError for options
/// out of range and sizes that do not fit. Throws Cancelled.
Elements computeElements(const PatchMesh& mesh, const PatchMaterials& materials,
                         std::span<const double> irradiance, const ElementOptions& options,
                         std::span<const std::uint8_t> wanted, Progress& progress);

/// Irradiance at single points, without interpolation: what elements have at their vertices, and
/// the limit of what more of them would show. The mesh and the materials are kept by reference. All
/// calls but the constructor may come from several threads.
class LightAtPoints {
 public:
  /// Arguments and errors as of computeElements(). Direct light is found fastest on `wanted`.
  LightAtPoints(const PatchMesh& mesh, const PatchMaterials& materials,
                std::span<const double> irradiance, const ElementOptions& options,
                std::span<const std::uint8_t> wanted, Progress& progress);
  ~LightAtPoints();
  LightAtPoints(const LightAtPoints&) = delete;
  LightAtPoints& operator=(const LightAtPoints&) = delete;

  static constexpr int kFewestRays = 16;
  static constexpr int kMostRays = 4096;

  int bands() const;
  const ElementRoots& roots() const;
  /// Of the sources alone; nothing of it is said of the points.
  const ElementReport& report() const;
  /// Adds the irradiance (bands values, W/m^2) at a point of a root. Indirect light takes `rays`
  /// rays, a power of two, kFewestRays to kMostRays; which, the point decides. Returns the square
  /// of the standard error, summed over the bands.
  double add(std::size_t root, const Vec3& at, int rays, std::span<double> sum) const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

/// Finds values of a field at points of patches. All are kept by reference.
class ElementLookup {
 public:
  ElementLookup(const PatchMesh& mesh, const ElementRoots& roots);

  /// The root of the patch that holds a point of it.
  std::size_t rootAt(std::size_t patch, const Vec3& at) const;
  /// Where the point lies in the root: (u, v) of a quadrilateral, along the edges that leave
  /// corner 0; of a triangle, the weights of corners 1 and 2. Points a little outside are moved in.
  Vec2 place(std::size_t root, const Vec3& at) const;
  /// The leaf of a field there; kNone where the root was not evaluated.
  Index leafAt(const ElementField& field, std::size_t root, Vec2 place) const;
  /// Adds the field's value there to `sum` (bands). False, and nothing is added, where the root was
  /// not evaluated. C0 along edges that roots share.
  bool add(const ElementField& field, std::size_t root, Vec2 place, std::span<double> sum) const;

 private:
  /// A point p lies at (dot(u, p) + u0, dot(v, p) + v0), in a parallelogram or a triangle.
  struct Map {
    Vec3 origin{0.0};
    Vec3 u{0.0};
    Vec3 v{0.0};
    bool affine = true;
    Vec2 third{0.0};  ///< else: corner 2 in those of corners 0, 1 and 3
  };
  const ElementRoots& roots_;
  std::vector<Map> maps_;  ///< by root
};

}  // namespace radiosity
