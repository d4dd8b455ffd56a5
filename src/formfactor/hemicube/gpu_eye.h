// Hemicubes drawn by a GPU. The code that uses OpenGL is a library of its own (src/gl), opened when
// the first device is asked for, so that the program runs without it.
//
// A GPU draws many hemicubes at once, all polygons in colours of their own (Cohen & Greenberg
// 1985), finds the patches of visible pixels and adds up the delta form factors. Conventions are
// those of hemicube.h, except that vertices are rounded to the rasteriser's grid: a pixel whose
// centre is within some 1/256 of a pixel of an edge may fall to either side.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formfactor/hemicube/delta_form_factors.h"
#include "formfactor/hemicube/gpu_scene.h"
#include "radiosity/form_factors.h"

namespace radiosity {

/// The place and axes of one eye, as for Hemicube::look(), in the coordinates of the ViewScene.
struct GpuView {
  std::array<double, 3> eye;
  std::array<double, 9> axes;  ///< column by column
  std::uint32_t own;           ///< position in ViewScene::polygons, or kNone
  std::uint32_t source = 0;    ///< of GpuField: the source that gathers by this eye
};
static_assert(sizeof(GpuView) == 104);

/// Polygons drawn and skipped by some hemicubes; as HemicubeReport.
struct GpuCounts {
  std::uint32_t own_plane, horizon, facing_away, face, rasterised;
};

/// Delta form factors are summed as whole numbers of this unit, modulo 2^64: a sum then does not
/// depend on the order in which a GPU adds, and no pixel is lost beside a large one.
inline constexpr double kGpuUnit = 0x1p-62;

/// The running sums of DeltaFormFactors in that unit, row by row, resolution + 1 each.
struct GpuWeights {
  explicit GpuWeights(const DeltaFormFactors& weights);
  int resolution;
  std::vector<std::uint64_t> top;   ///< rows 0 to resolution / 2 - 1; the others mirror them
  std::vector<std::uint64_t> side;  ///< as many rows
};

/// A part of a patch between whose corners radiosity is interpolated (gather/patch_basis.h).
struct GpuFacet {
  std::array<double, 4> area;           ///< of quadrilaterals: C_k
  std::array<std::uint32_t, 4> vertex;  ///< into GpuField::vertices
  std::array<std::uint32_t, 4> source;
  std::uint32_t count;  ///< 3 or 4
  std::uint32_t padding = 0;
};
static_assert(sizeof(GpuFacet) == 72);

/// Light that is gathered. Sources are the patches or, with facets, those named by the corners of
/// facets: the eyes, then means over several of them. Values are rows of `bands`.
struct GpuField {
  std::size_t bands = 0;
  std::size_t eyes = 0;            ///< sources that gather
  std::size_t patches = 0;         ///< of the scene
  std::vector<float> emission;     ///< eyes * bands, W/m^2
  std::vector<float> reflectance;  ///< eyes * bands
  std::vector<double> sky;         ///< bands: irradiance under nothing but sky, W/m^2
  std::vector<Vec3> vertices;      ///< in the coordinates of the ViewScene
  std::vector<GpuFacet> facets;
  std::vector<std::uint32_t> first_facet;  ///< patches + 1; empty: a patch has one radiosity
  /// Sources after the eyes are means of mean_of[first_of_mean[m]] to mean_of[first_of_mean[m +
  /// 1]].
  std::vector<std::uint32_t> mean_of, first_of_mean;
};

/// The rows of views [first, first + count): the items + 1 weights of each, the sky's last, in
/// units of kGpuUnit.
struct GpuRows {
  std::size_t first = 0;
  std::size_t count = 0;
  std::span<const std::uint32_t> low, high;  ///< halves of count * (items + 1) weights
  GpuCounts counts{};                        ///< of all of them
  std::span<const double> irradiance{};      ///< count * bands, without the sky's; of gather()
  std::uint64_t weight(std::size_t k) const { return std::uint64_t(high[k]) << 32 | low[k]; }
};

/// Draws hemicubes of one scene on one device. One thread at a time.
class GpuEye {
 public:
  virtual ~GpuEye() = default;

  /// Describes view k: its place and axes, and a bit for each polygon whose black back cannot be
  /// seen (bit p % 32 of word p / 32; all are 0 before).
  using Describe =
      std::function<void(std::size_t k, GpuView& view, std::span<std::uint32_t> hidden)>;
  /// Receives rows, views ascending, each once; false: that is enough.
  using Take = std::function<bool(const GpuRows& rows)>;

  /// Looks from `count` eyes. Later rows are drawn while earlier ones are taken. Returns why the
  /// device gave up ("out of memory"), if it did: views after those taken were then not seen. An
  /// eye that has given up, here or below, only says so again.
  virtual std::string look(std::size_t count, const Describe& describe, const Take& take) = 0;

  /// Makes room for the light of a field, which is dark but for its emission. Returns why the
  /// device gave up, or nothing.
  virtual std::string prepare(const GpuField& field) = 0;
  /// As look(), and gathers light: each view's source gets the light that its eye receives, for the
  /// next call. Radiosity stays on the device.
  virtual std::string gather(std::size_t count, const Describe& describe, const Take& take) = 0;

  /// For tests: the polygons that view 0 sees, face by face as Hemicube::picture() has them. Throws
  /// RunError if the device gives up.
  virtual std::vector<Index> pictures(const Describe& describe) = 0;

  /// Bytes held here and on the device, about.
  virtual std::size_t bytes() const = 0;
  virtual const EyeDevice& device() const = 0;
};

/// The pace of handing work to a device; rows have the same bits at any pace.
struct GpuPace {
  std::size_t ring;  ///< batches that are under way at once: while one is read, the next are drawn
  std::size_t pixels;  ///< of a batch; one hemicube may have more
};

/// The devices that the library offers.
class GpuEyes {
 public:
  virtual ~GpuEyes() = default;
  /// Devices that can draw, hardware first; if there are none, `problem` says why, and the cure.
  virtual EyeDevices devices() const = 0;
  /// Opens an eye on device `d` of devices(); it keeps none of its arguments. `pace`: empty for one
  /// that suits the device. Null: `problem` says why.
  virtual std::unique_ptr<GpuEye> open(std::size_t d, const GpuScene& scene,
                                       const GpuWeights& weights, std::optional<GpuPace> pace,
                                       std::string& problem) const = 0;
};

/// Those of the library; without devices if there is no library.
const GpuEyes& gpuEyes();

/// Why there is no library, and the cure, from the words of the loader (dlerror()).
std::string libraryProblem(const std::string& loader_words);

/// The eye that `choice` asks for: null for the CPU's, also if `automatic` finds no hardware, or
/// finds the program to be one of several processes. Throws RunError, with the cure, if `gl` is
/// asked for and there is no device. An eye that cannot hold the scene gives up at the first call.
std::unique_ptr<GpuEye> openGpuEye(EyeChoice choice, const ViewScene& scene, const PatchMesh& mesh,
                                   const DeltaFormFactors& weights);
/// The same with the devices of `eyes`.
std::unique_ptr<GpuEye> openGpuEye(EyeChoice choice, const ViewScene& scene, const PatchMesh& mesh,
                                   const DeltaFormFactors& weights, const GpuEyes& eyes);

}  // namespace radiosity
