// Light at measuring points, as planners ask for it: on grids over surfaces and planes, in lux.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/elements.h"
#include "radiosity/light.h"
#include "radiosity/option_line.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/render.h"
#include "radiosity/report_line.h"
#include "radiosity/scene.h"

namespace [[gnu::visibility("default")]] radiosity {

/// Points, each with the way that it faces.
struct MeasuringPoints {
  /// A regular grid in a plane, which a picture may show: its first point, the unit vectors along
  /// its rows and columns (u x v faces the viewer), and the metres between points.
  struct Grid {
    Vec3 first{0.0};
    Vec3 u{0.0};
    Vec3 v{0.0};
    double step_u = 0;
    double step_v = 0;
    std::size_t columns = 0;  ///< along u
    std::size_t rows = 0;     ///< along v
  };
  std::string name;
  std::vector<Vec3> at;      ///< P, metres
  std::vector<Vec3> normal;  ///< P, unit
  std::optional<Grid> grid;
  std::vector<std::size_t> cell;  ///< P, row * columns + column of the grid; or empty
  std::vector<Note> notes;

  std::size_t size() const { return at.size(); }
};

/// The most points of a grid.
inline constexpr std::size_t kMostGridPoints = 1000000;

/// The largest distance of points by EN 12464-1 (4.4): .2 * 5^lg(d) metres, 10 m at most, of an
/// area whose longer side is d metres, or the shorter one if the longer is twice as long or more.
double standardSpacing(double longer, double shorter);

/// A regular grid over a planar surface of the scene, `height` metres above it along its normal
/// (below 0: over its other side, and facing there). Of a thin board its upper side is meant, and
/// of a surface that is not planar the faces that face up, if they are in one plane. Rows are
/// parallel to a side of the smallest rectangle around the surface; points outside of its outline
/// are left out. `spacing`: metres, with borders alike at both ends; none: standardSpacing(), with
/// borders of half a cell. `name`: of a surface, an object or a material. Errors: InputError for a
/// name that nothing has, with the nearest ones, a surface that is not planar or without area, a
/// thin board that stands upright, a spacing that leaves no point or takes more than
/// kMostGridPoints, and numbers that are not finite.
MeasuringPoints pointsOverSurface(const Scene& scene, const std::string& name, double height = 0,
                                  std::optional<double> spacing = {});

/// The same for a name that may be a pattern: a grid for each surface that it matches, or one for
/// all of them if they are in one plane and face alike. Errors: as above, naming the surface that
/// does not fit.
std::vector<MeasuringPoints> pointsOverSurfaces(const Scene& scene, const std::string& name,
                                                double height = 0,
                                                std::optional<double> spacing = {});

/// A grid over a parallelogram given by three corners in turn, metres. It faces the side from which
/// they are counter-clockwise. Errors: as above.
MeasuringPoints pointsOnPlane(const std::array<Vec3, 3>& corners,
                              std::optional<double> spacing = {});

/// Points from a table (.csv): the columns x, y, z in metres and, if they are there, nx, ny, nz,
/// the way that each faces, of any length (default: up). A header may be left out; names may end in
/// _m. Errors: InputError naming file and line.
MeasuringPoints readMeasuringPoints(const std::string& path, Up up);

/// What is measured at a point: irradiance of a small surface facing a way, or of a small upright
/// cylinder.
enum class Measured : std::size_t {
  facing,  ///< the point's own normal
  x_plus,  ///< the six faces of a small cube
  x_minus,
  y_plus,
  y_minus,
  z_plus,
  z_minus,
  /// EN 12464-1: the mean of what upright surfaces get all around, the integral of L sin(t) / pi
  /// over all directions, t the angle to the upright
  cylinder
};
inline constexpr std::size_t kMeasured = 8;

struct IlluminanceOptions {
  /// Standard error of indirect light by rays that is asked for, over all light of the point.
  double tolerance = 0.01;
  /// Of a point, in all directions. At this limit errors are larger.
  std::size_t most_rays = 32768;
  std::uint64_t seed = 1;  ///< of the rays' directions
  /// Throws InputError naming the option and its range.
  void validate() const;

  /// A line an option (option_line.h).
  static void describe(auto& list, auto& o) {
    list({.name = "tolerance",
          .option = "ray-tolerance",
          .value = "SHARE",
          .help = "Standard error of indirect light, over all light of the point: points take as "
                  "many rays as this needs, up to {:.0f}",
          .figures = {32768}},
         o.tolerance, {.from = 1e-4, .to = 0.5});
    list({.name = "most_rays"}, o.most_rays, {.from = 1024, .to = 32768});
    list({.name = "seed"}, o.seed);
  }
};

struct IlluminanceReport {
  DirectLight direct = DirectLight::none;
  double rays = 0;            ///< of indirect light
  std::size_t most_rays = 0;  ///< of a point
  /// Standard errors over all light of the point, facing: the largest, and the root mean square, of
  /// points that stand in no body.
  double largest_error = 0;
  std::size_t largest_error_at = 0;  ///< the point
  double ray_error = 0;
  double seconds = 0;  ///< by the clock, of the points alone

  static void describe(auto& list, auto& r) {
    list({"direct"}, r.direct);
    list({"rays", "rays of indirect light"}, r.rays);
    list({"most_rays", "  of a point, at most"}, r.most_rays);
    list({"largest_error", "standard error of rays, at most"}, r.largest_error);
    list({"ray_error", "  root mean square"}, r.ray_error);
    list({"seconds", "time", "s"}, r.seconds);
  }
};

/// Irradiance at P points, W/m^2. The row of a point in `direct` and `indirect` has kMeasured *
/// bands values.
struct PointLightValues {
  int bands = 3;
  Up up = Up::y;
  std::vector<double> direct;    ///< from emitters and lamps
  std::vector<double> indirect;  ///< from all else: surfaces, and the sky
  std::vector<double> error;     ///< P: standard error over all light of the point, facing
  /// P, 1: most of what the point sees are black backs of surfaces. It stands in a body.
  std::vector<std::uint8_t> inside;
  /// Lux of open level ground, where nothing shines but skies without a sun; 0: something does.
  double open_lux = 0;
  IlluminanceReport report;

  std::size_t size() const { return error.size(); }
  std::span<const double> directOf(std::size_t point, Measured what) const;
  std::span<const double> indirectOf(std::size_t point, Measured what) const;
  /// Lux, both together.
  double lux(std::size_t point, Measured what) const;
  double directLux(std::size_t point, Measured what) const;
  double indirectLux(std::size_t point, Measured what) const;
  /// What of the light outside arrives, facing, percent; 0 if `open_lux` is 0. It is the daylight
  /// factor of EN 17037 and CIE 16 under the overcast sky.
  double daylightFactor(std::size_t point) const;
  /// EN 13201-3: of half an upright cylinder that faces one of the four sides, the integral of
  /// L sin(t) (1 + cos(a)) / pi over all directions, a the angle in plan to that side.
  double semicylindricalLux(std::size_t point, Measured side) const;
};

/// The four sides of the cube that face sideways.
std::array<Measured, 4> uprightSides(Up up);
/// "+x" of x_plus, and so on; "" of `facing` and `cylinder`.
const char* axisOf(Measured what);

/// Light at points of a solved scene. `irradiance`: N * bands, of the solved patches, W/m^2;
/// `normals`: a point each. A point may stand anywhere; it is taken to be 2e-6 of the scene's
/// diagonal off its place, along its normal. Direct light, facing, of surfaces and of points is
/// exact, with what hides them clipped off; past more than 256 convex pieces, or of more than 128
/// emitters, it is by rays to points of them. That of suns, and of photometric lamps near by, is by
/// 16, 64 or 1,024 rays each. Indirect light by rays in all directions, in eight sets, whose spread
/// tells the error; they serve all that is measured. Cylinders by 31 upright surfaces (direct
/// light; .06% off for a small lamp, at most) and by the rays themselves. `elements`: of the
/// sources of indirect light. The same bits for any number of threads. Errors: InputError for
/// options out of range, sizes that do not match, a coordinate that is not finite and a normal that
/// has no length. Throws Cancelled.
PointLightValues lightAtPoints(const PatchMesh& mesh, const PatchMaterials& materials,
                               std::span<const double> irradiance, const ElementOptions& elements,
                               std::span<const Vec3> points, std::span<const Vec3> normals, Up up,
                               const IlluminanceOptions& options, Progress& progress);

/// What a plan says of points: lux, of those that stand in no body.
struct IlluminanceSummary {
  std::size_t points = 0;  ///< of which the figures are
  std::size_t inside = 0;  ///< left out
  double lowest = 0;
  double mean = 0;
  double highest = 0;
  double direct = 0;                  ///< mean
  double indirect = 0;                ///< mean
  double cylinder = 0;                ///< mean
  double daylight_factor = 0;         ///< mean, percent; 0: there is none
  double lowest_daylight_factor = 0;  ///< percent
  Vec3 lowest_at{0.0};
  Vec3 highest_at{0.0};
  /// U_0 = lowest / mean and U_d = lowest / highest; 0 in the dark.
  double overMean() const { return mean > 0 ? lowest / mean : 0; }
  double overHighest() const { return highest > 0 ? lowest / highest : 0; }
};

/// `first`: of the points' values among `light`.
IlluminanceSummary summaryOf(const MeasuringPoints& points, const PointLightValues& light,
                             std::size_t first);

/// A plan of a grid, ready for an sRGB file: illuminance as false colours with lines at round
/// numbers, values written at points, as many as can be read, and a legend below. Points that stand
/// in bodies are grey. The colours' ends are `low` and `high`, lx, or those of the values if low >=
/// high. Errors: InputError for points that are no grid.
Image illuminancePlan(const MeasuringPoints& points, const PointLightValues& light,
                      std::size_t first, double low = 0, double high = 0);

/// Pictures below each other, on white.
Image stacked(std::span<const Image> pictures);

}  // namespace radiosity
