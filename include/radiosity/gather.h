// Gathering: each patch or vertex looks at the scene through a hemicube, averages the light in view
// into its irradiance H and sets B = E + rho H; the passes repeat. No matrix is stored: each pass
// draws all hemicubes again, since the view of an eye, kept for the next pass, would be its row.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/form_factors.h"
#include "radiosity/option_line.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/report_line.h"
#include "radiosity/solve.h"

namespace [[gnu::visibility("default")]] radiosity {

enum class GatherAt {
  patches,  ///< one eye a patch, at its centroid; a patch has one radiosity all over
  vertices  ///< one eye a vertex and smooth side; radiosity is interpolated over patches
};

struct GatherOptions {
  GatherAt at = GatherAt::vertices;
  int passes = 100;  ///< at most, 1 to 100000; pass k adds the k-th bounce
  /// Stop when the bound of |B* - B| is at most this times the largest emission (pi times the
  /// radiance of the sky, if that is more), in every band. Between 0 and 1. Radiosities are 32-bit
  /// floats: below about 1e-6 it is not reached.
  double tolerance = 1e-4;
  int resolution = 256;    ///< of the hemicube's top face, as in FormFactorOptions
  std::uint64_t seed = 1;  ///< of the random turns about each normal
  bool random_turns = true;
  EyeChoice eye = EyeChoice::cpu;
  double crease = 30;  ///< degrees; a vertex looks once per side that bends less, 0 to 180
  /// The distance that an eye on an edge moves away from it, as a share of the distance to the
  /// nearest edge that does not touch the vertex; above 0, at most 0.5. Along an edge of a room
  /// light goes as x ln x. A straight line from the value at the edge misses its mean over a patch
  /// by a quarter of the patch; one from a tenth of the patch does not.
  double inset = 0.1;
  bool simd = true;  ///< false: Highway's scalar target (same bits)
  void validate() const;

  /// A line an option (option_line.h).
  static void describe(auto& list, auto& o) {
    list({.name = "at",
          .value = "vertices|patches",
          .help = "Where the eyes stand: at vertices (default), one for each smooth side, so that "
                  "radiosity is interpolated over patches; or at the centres of patches, one "
                  "radiosity each"},
         o.at);
    list({.name = "passes", .value = "K", .help = "Passes at most: pass k adds the k-th bounce"},
         o.passes, {.from = 1, .to = 100000});
    list({.name = "tolerance",
          .option = "gather-tolerance",
          .value = "RATIO",
          .help = "Stop when further passes add at most this times the largest emission"},
         o.tolerance, {.above = 0, .below = 1});
    list({.name = "resolution",
          .value = "PIXELS",
          .unit = "pixels",
          .help = "Edge of the hemicube's top face"},
         o.resolution, {.from = 16, .to = 4096, .only = OptionRange::Only::even});
    list({.name = "seed", .help = "Seed of each hemicube's random turn"}, o.seed);
    list({.name = "crease",
          .value = "DEGREES",
          .unit = "degrees",
          .help = "A vertex looks once per side that bends less"},
         o.crease, {.from = 0, .to = 180});
    list({.name = "random_turns", .in_key = InKey::if_changed}, o.random_turns);
    list({.name = "eye",
          .value = "cpu|gl|auto",
          .help = "Hemicubes are drawn by the processor (cpu, default: the same bits on every "
                  "machine), by OpenGL (gl; radiosity info --devices lists what can), or by OpenGL "
                  "where there is hardware for it (auto)",
          .in_key = InKey::if_changed},
         o.eye);
    list({.name = "inset", .in_key = InKey::if_changed}, o.inset, {.to = 0.5, .above = 0});
  }
};

/// One pass: light gathered from the radiosity of the pass before.
struct GatherPass {
  double seconds = 0;
  double change = 0;  ///< max |B_k - B_(k-1)| / max E, worst band
  /// An upper bound of |B* - B_k|, W/m^2, worst band, B* being the limit of the passes:
  /// (q change + rounding) / (1 - q), q = max rho_i fronts_i. Empty if q is 1 or more.
  std::optional<double> bound;
  /// The account of H_k and of the B_(k-1) that it was gathered from, each eye weighted with its
  /// area. emitted + from_sky = absorbed + to_sky + on_backs + in_flight + imbalance.
  EnergyAccount energy;
  std::vector<double> in_flight;  ///< W a band, still to be reflected: sum of area (B_k - B_(k-1))

  static void describe(auto& list, auto& p) {
    list({"seconds", "", "s"}, p.seconds);
    list({"change"}, p.change);
    list({"bound", "", "W/m^2"}, p.bound);
    list.part("energy", p.energy);
    list({"in_flight", "", "W"}, p.in_flight);
  }
};

enum class GatherStatus {
  converged,   ///< the bound of |B* - B| is within the tolerance; usable
  pass_limit,  ///< `passes` came first; B has that many bounces
  no_light,    ///< E = 0 and the sky is dark: B = 0
  /// More than kMostImbalance of the light is lost between the eyes, or received in excess: patches
  /// are too large for points to stand for them; not usable.
  unbalanced
};

/// Of the power that comes in, in a band.
inline constexpr double kMostImbalance = 0.05;

struct GatherSummary {
  GatherStatus status = GatherStatus::pass_limit;
  std::vector<GatherPass> passes;
  std::size_t hemicubes = 0;  ///< of one pass: L less the eyes without area
  std::size_t pixels = 0;     ///< of one pass
  bool closed = false;        ///< no patch sees the sky: all are enclosed (Enclosures)
  std::size_t bytes = 0;      ///< held at once
  std::string simd_target;
  double seconds = 0;
  std::string message;  ///< plain words, with numbers; says if B is not usable
  bool usable() const { return status != GatherStatus::unbalanced; }
  std::vector<Note> notes;  ///< on the device that drew the hemicubes, and others

  /// Without `passes`.
  static void describe(auto& list, auto& s) {
    list({"status"}, s.status);
    list({"hemicubes", "hemicubes a pass", "", "hemicubes_per_pass"}, s.hemicubes);
    list({"pixels"}, s.pixels);
    list({"seconds", "time", "s"}, s.seconds);
    list({"bytes", "memory", "bytes"}, s.bytes);
    list({"simd_target", "instruction set"}, s.simd_target);
    list({"closed", "closed scene"}, s.closed);
    list({"message", "in words"}, s.message);
    list.notes(s.notes);
  }
};

/// L eyes: the N patches, or the G corner groups of the mesh. An eye without area (degenerate
/// patches) does not look: H = 0.
struct Gathered {
  GatherAt at = GatherAt::patches;
  int bands = 3;                  ///< those of the materials
  std::vector<float> radiosity;   ///< L * bands, row-major, W/m^2
  std::vector<float> irradiance;  ///< L * bands: H
  std::vector<float> backs;       ///< L, share of the view that ends on black backs
  std::vector<float> sky;         ///< L
  /// Share of all eyes' view that ends on each surface's back, eyes weighted with their areas; by
  /// surface.
  std::vector<double> backs_by_surface;
  std::vector<double> area;    ///< L, m^2: the area each value stands for; sums to the mesh's area
  std::vector<Vec3> position;  ///< L, of the eyes
  std::vector<Index> eye_of_corner;  ///< at vertices: the eye of every entry of PatchMesh::corners
  GatherSummary summary;
};

/// Gathers any number of bands at once: all use the same views. Errors: InputError naming the
/// option or the patch, and as PatchMaterials::requireSizes(); Cancelled.
Gathered gather(const PatchMesh& mesh, const PatchMaterials& materials,
                const GatherOptions& options, Progress& progress);

/// Area mean of the radiosity over every patch, N * bands.
std::vector<double> patchRadiosity(const PatchMesh& mesh, const Gathered& gathered);

/// Radiosity at every entry of mesh.corners, * bands: as gathered, or that of the patch.
std::vector<double> cornerRadiosity(const PatchMesh& mesh, const Gathered& gathered);

}  // namespace radiosity
