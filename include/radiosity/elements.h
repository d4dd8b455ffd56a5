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
#include "radiosity/option_line.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/report_line.h"

namespace [[gnu::visibility("default")]] radiosity {

struct ElementOptions {
  /// 1e-4 to 0.5: the error of interpolation at which an element is cut, relative to the irradiance
  /// there (at least a tenth of the scene's mean), for elements a twentieth of the scene's diagonal
  /// long; shorter ones are allowed more, in proportion. Indirect light is never refined below
  /// three times the noise of its rays. A vertex whose rays have a spread (standard error over
  /// mean) of more than seven tolerances takes eight times as many rays.
  double tolerance = 0.01;
  /// 1e-5 to 0.1 of the scene's diagonal: no element with a shorter edge is cut.
  double smallest_edge = 0.002;
  /// 1 or more, in each field, besides the corners of patches. At this limit the elements that
  /// promise least stay coarse.
  std::size_t most_vertices = 400000;
  /// Rays per vertex: a power of two, 64 to 4096. A cell of the sources has a sixteenth, sixteen at
  /// least.
  int rays = 512;
  /// 1 or more, of all passes together. At this limit each vertex gets fewer rays.
  double most_rays = 1e8;
  double crease = 30;      ///< degrees, 0 to 180; elements across sharper edges share no vertex
  std::uint64_t seed = 1;  ///< of the rays' directions

  /// Throws InputError naming the option and its range.
  void validate() const;

  /// A line an option (option_line.h).
  static void describe(auto& list, auto& o) {
    list({.name = "tolerance",
          .option = "element-tolerance",
          .value = "SHARE",
          .help = "Elements are cut where interpolation misses by more than this share of the "
                  "light there, and have more rays where those of indirect light are spread by "
                  "seven times that"},
         o.tolerance, {.from = 1e-4, .to = 0.5});
    list({.name = "smallest_edge"}, o.smallest_edge, {.from = 1e-5, .to = 0.1});
    list({.name = "most_vertices"}, o.most_vertices, {.from = 1});
    list({.name = "rays"}, o.rays,
         {.from = 64, .to = 4096, .only = OptionRange::Only::power_of_two});
    list({.name = "most_rays"}, o.most_rays, {.from = 1});
    list({.name = "crease",
          .value = "DEGREES",
          .unit = "degrees",
          .help = "Interpolate across edges that bend less"},
         o.crease, {.from = 0, .to = 180});
    list({.name = "seed"}, o.seed);
  }
};

/// The roots of the trees. A patch that is a triangle or a convex quadrilateral is one root; any
/// other patch has a root for each of its pieces.
struct ElementRoots {
  std::vector<Index> patch;  ///< R
  std::vector<std::array<Index, 4>>
      corner;                         ///< R, vertices of the mesh; a triangle's fourth: kNone
  std::vector<std::size_t> of_patch;  ///< N + 1, into the arrays above: the roots of each patch

  std::size_t size() const { return patch.size(); }
  std::size_t cornerCount(std::size_t root) const { return corner[root][3] == kNone ? 3 : 4; }
};

/// An element. Its points are its corners, then, if `tested`, the middles of its edges (k: from
/// corner k to the next) and the centre of a quadrilateral. It has four children. Child k lies at
/// corner k and has its corners in the same order. In a triangle the fourth child lies in the
/// middle, and its corner k is the middle of the edge opposite corner k.
struct Element {
  Index first_child = kNone;  ///< kNone: a leaf
  Index first_point = 0;      ///< into ElementField::points
  std::uint8_t corners = 0;   ///< 3 or 4; 0: a root that was not evaluated
  std::uint8_t tested = 0;    ///< 1: it has points at the middles
};

/// One kind of light on a forest over the patches.
struct ElementField {
  std::vector<Element> elements;  ///< the first R are the roots
  std::vector<Index> points;      ///< vertices
  std::vector<double> values;     ///< V * bands: irradiance, W/m^2
  std::size_t vertices = 0;       ///< V
};

/// The method of the direct light.
enum class DirectLight {
  none,        ///< nothing shines, except perhaps the sky
  exact,       ///< clipped exactly
  partly,      ///< clipped exactly, but by rays to the emitters where too much lies in between
  rays,        ///< by rays to the emitters, since there are many
  hemispheres  ///< with the indirect light, since there are too many emitters to aim at
};

struct ElementReport {
  DirectLight direct = DirectLight::none;
  std::size_t roots = 0;
  /// Of these, on small patches that are not wanted: sources with the light of the solution.
  std::size_t as_solved = 0;
  std::size_t emitters = 0;           ///< convex pieces
  std::size_t direct_vertices = 0;    ///< evaluated
  std::size_t direct_by_rays = 0;     ///< of these, by rays to the emitters
  std::size_t indirect_vertices = 0;  ///< evaluated, in all passes
  double uniform_vertices = 0;        ///< of a uniform grid as fine as the smallest element
  std::size_t unrefined = 0;          ///< elements left coarse because of most_vertices
  double rays = 0;
  int rays_a_vertex = 0;  ///< of the last pass
  double edge = 0;        ///< metres: the shortest edge of a leaf
  /// Root mean square errors over the area, relative to that of irradiance. Interpolation: from the
  /// refinement's checks. Rays: from the difference of their halves.
  double interpolation_error = 0;
  double ray_error = 0;
  double seconds_direct = 0;  ///< by the clock
  double seconds_indirect = 0;

  static void describe(auto& list, auto& r) {
    list({"direct"}, r.direct);
    list({"roots"}, r.roots);
    list({"emitters", "emitters"}, r.emitters);
    list({"as_solved", "small parts out of view, as solved"}, r.as_solved);
    list({"direct_vertices", "vertices evaluated, direct"}, r.direct_vertices);
    list({"direct_by_rays", "  of them by rays"}, r.direct_by_rays);
    list({"indirect_vertices", "vertices evaluated, indirect"}, r.indirect_vertices);
    list({"uniform_vertices"}, r.uniform_vertices);
    list({"unrefined", "left coarse at the cap"}, r.unrefined);
    list({"edge", "shortest edge", "m", "shortest_edge_m"}, r.edge);
    list({"rays"}, r.rays);
    list({"rays_a_vertex", "rays a vertex, indirect, at least"}, r.rays_a_vertex);
    list({"interpolation_error", "error of interpolation"}, r.interpolation_error);
    list({"ray_error", "error of rays"}, r.ray_error);
    list({"seconds_direct", "time, direct", "s"}, r.seconds_direct);
    list({"seconds_indirect", "time, indirect", "s"}, r.seconds_indirect);
  }
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
/// Direct light is exact, point to polygon, with blocked parts clipped off. Indirect light is found
/// by rays in passes that end on cells of the patches (src/elements/README.md). `wanted`: N
/// flags, 1: the patch's elements are wanted; empty: all. Other patches are evaluated only as far
/// as wanted ones receive light from them; those with edges below 1/200 of the scene's diagonal not
/// at all. The same bits for any number of threads. Errors:
/// InputError for options out of range and sizes that do not match. Throws Cancelled.
Elements computeElements(const PatchMesh& mesh, const PatchMaterials& materials,
                         std::span<const double> irradiance, const ElementOptions& options,
                         std::span<const std::uint8_t> wanted, Progress& progress);

/// Irradiance at single points, without interpolation: the values that elements have at their
/// vertices, and the limit of ever finer elements. The mesh and the materials must outlive the
/// object. All calls but the constructor may come from several threads.
class LightAtPoints {
 public:
  /// Arguments and errors as in computeElements(). Direct light is found fastest on `wanted`.
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
  /// The report on the sources alone; it does not include the points.
  const ElementReport& report() const;
  /// Adds the irradiance (bands values, W/m^2) at a point of a root: that of emitters and lamps to
  /// `direct`, all else to `indirect`, which takes `rays` rays, a power of two, kFewestRays to
  /// kMostRays; the point determines their directions. Returns the square of the standard error,
  /// summed over the bands.
  double add(std::size_t root, const Vec3& at, int rays, std::span<double> direct,
             std::span<double> indirect) const;
  /// The same, both in one sum.
  double add(std::size_t root, const Vec3& at, int rays, std::span<double> sum) const {
    return add(root, at, rays, sum, sum);
  }

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

/// Finds values of a field at points of patches. Its arguments must outlive it.
class ElementLookup {
 public:
  ElementLookup(const PatchMesh& mesh, const ElementRoots& roots);

  /// The root of the patch that contains the point.
  std::size_t rootAt(std::size_t patch, const Vec3& at) const;
  /// The place of the point in the root: (u, v) of a quadrilateral, along the edges that leave
  /// corner 0; in a triangle the weights of corners 1 and 2. Points a little outside are moved in.
  Vec2 place(std::size_t root, const Vec3& at) const;
  /// The leaf of a field at `place`; kNone if the root was not evaluated.
  Index leafAt(const ElementField& field, std::size_t root, Vec2 place) const;
  /// Adds the field's value at `place` to `sum` (bands). Returns false and adds nothing if the root
  /// was not evaluated. The value is C0 along edges that roots share.
  bool add(const ElementField& field, std::size_t root, Vec2 place, std::span<double> sum) const;

 private:
  /// Maps a point p to (dot(u, p) + u0, dot(v, p) + v0), in a parallelogram or a triangle.
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
