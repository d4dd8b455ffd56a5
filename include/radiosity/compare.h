// Compares two lightings of the same surfaces, or two pictures.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/names.h"
#include "radiosity/option_line.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/results.h"

namespace [[gnu::visibility("default")]] radiosity {

/// The quantity that the numbers of a file stand for.
enum class LightUnit {
  radiosity,  ///< B = pi L, W/m^2
  radiance,   ///< L, W/m^2/sr
  srgb8       ///< coded for a screen: of unknown exposure, clipped at the top
};
inline constexpr NameTable<LightUnit, 3> kLightUnitNames{{{LightUnit::radiosity, "radiosity"},
                                                          {LightUnit::radiance, "radiance"},
                                                          {LightUnit::srgb8, "srgb8"}}};

/// Light on surfaces: triangles with a value at each corner, in cells (patches, faces) over which
/// values are averaged before they are compared.
struct LightField {
  std::string name;  ///< for messages
  std::vector<Vec3> vertices;
  std::vector<std::array<Index, 3>> triangles;  ///< T
  int bands = 3;                                ///< 1 or more
  std::vector<double> values;  ///< T * 3 * bands: radiosity at each corner, or (srgb8) linear light
  std::vector<Index> cell;     ///< T
  std::vector<Index> cell_surface;  ///< by cell, into surface_names
  std::vector<std::string> surface_names;
  std::vector<std::uint8_t> clipped;  ///< T, 1: a corner is at the top of its range; or empty
  std::vector<std::uint8_t> emits;    ///< by cell, 1: a lamp; empty: not known
  bool constant = false;              ///< one value a cell
  bool relative = false;              ///< no unit: srgb8
};

/// The light of one value per patch and band: N * bands, W/m^2, row-major. `emission`: likewise, or
/// empty if unknown. Errors: InputError if a size does not match.
LightField lightOf(const PatchMesh& mesh, std::span<const double> radiosity, int bands,
                   std::string name, std::span<const double> emission = {});
/// The same from the colours of a lit mesh, in three bands.
LightField lightOf(const LitMesh& mesh, LightUnit unit);

struct CompareOptions {
  bool fit_scale = false;  ///< multiply B by the factor that brings it closest to A
  bool partial = false;    ///< go on even if less than 99% of either side's area has a counterpart
  /// The largest distance between matching points, as a fraction of A's diagonal; 0 to 0.1.
  double match = 1e-3;
  bool perceived = false;  ///< of pictures: PerceivedDifference, too
  void validate() const;

  /// A line an option (option_line.h).
  static void describe(auto& list, auto& o) {
    list({.name = "fit_scale", .help = "Multiply B by the factor that fits best, and print it"},
         o.fit_scale);
    list({.name = "partial",
          .help = "Compare the parts that match even where they are less than 99% of either side"},
         o.partial);
    list({.name = "match",
          .value = "FRACTION",
          .help = "How far apart points of one surface may be, of A's diagonal"},
         o.match, {.to = 0.1, .above = 0});
    list({.name = "perceived",
          .help = "Also say how different two pictures look: FLIP (0: alike, to 1) and SSIM (1: "
                  "alike)"},
         o.perceived);
  }
};

/// Sums over cells, weighted with area, by band.
struct BandSums {
  BandSums() = default;
  explicit BandSums(int bands);
  double area = 0;         ///< m^2 that were compared
  std::vector<double> a;   ///< W: integral of A; pictures: sum over pixels
  std::vector<double> b;   ///< of B, scaled
  std::vector<double> aa;  ///< integral of A^2
  std::vector<double> dd;  ///< of (B - A)^2
  /// Adds the values of all bands; those of B are multiplied by `scale`.
  void add(double weight, std::span<const double> of_a, std::span<const double> of_b,
           double scale = 1);
  /// sqrt(sum dd / sum aa) of one band or (-1) all; 0 if sum dd is 0, else infinite if sum aa is 0.
  double relativeL2(int band = -1) const;
};

struct SurfaceDifference {
  std::string name;
  double given = 0;  ///< m^2, of the side whose cells are compared
  BandSums sums;
};

struct LargestDifference {
  Vec3 place{0.0};  ///< metres; in a picture x and y, pixels from the top left
  std::string surface;
  int band = 0;
  double a = 0;
  double b = 0;  ///< scaled
};

/// How different two pictures look (src/compare/flip.h, similarity.h).
struct PerceivedDifference {
  /// The mean of FLIP: of pictures for a screen LDR-FLIP, of those that hold light HDR-FLIP.
  double flip = 0;
  /// SSIM of luminance as a screen shows it; none: the pictures are smaller than 11 x 11.
  std::optional<double> ssim;
  /// At which SSIM's screen shows both: the automatic one of A; none: they are for a screen.
  std::optional<double> exposure_ev;
};

struct Comparison {
  bool cells_of_b = false;           ///< averages are over the cells of B, else of A
  std::size_t cells = 0;             ///< compared
  double area_a = 0, matched_a = 0;  ///< m^2; of pictures: pixels that show something
  double area_b = 0, matched_b = 0;
  double clipped = 0;  ///< matched but not compared: one side is at the top of its range
  double scale = 1;    ///< the factor by which B was multiplied
  /// The least-squares factor for B (times `scale`) and the difference that it would leave.
  double fitted_scale = 1;
  double fitted_l2 = 0;
  BandSums sums;
  /// Sums without emitters, which dominate `sums`. Empty: neither side knows its emitters, or
  /// nothing emits.
  std::optional<BandSums> without_emitters;
  std::optional<PerceivedDifference> perceived;  ///< where the options ask for it
  LargestDifference largest;
  std::vector<SurfaceDifference> surfaces;  ///< in order of their share of the difference
  /// |B - A| by cell or pixel: Rec. 709 luminance of three bands, the sum of any other number. NaN:
  /// not compared.
  std::vector<double> difference;
  std::vector<Note> notes;  ///< a likely wrong factor, such as pi, by name

  double relativeL2(int band = -1) const { return sums.relativeL2(band); }
};

/// Matches the two by position: a point's counterpart is the nearest point of the other side that
/// faces alike. Compares means over the cells of A (of B if only B is constant on its cells).
/// Errors: InputError if the two differ in bands or units, or if too little of them matches; the
/// message says what to do.
Comparison compare(const LightField& a, const LightField& b, const CompareOptions& options);

/// Compares pictures at every pixel where both show something. Values are used as stored (srgb8 is
/// decoded). Of two that hold light one may have k x k pixels for each of the other's: it is
/// compared by their means, with a note. `match` and `partial` do not apply. Errors: InputError for
/// other sizes, and for one picture made for a screen.
Comparison compare(const ImageFile& a, LightUnit a_is, const ImageFile& b, LightUnit b_is,
                   const CompareOptions& options);

/// The cells of the compared side as a mesh to draw `difference` on: patch k is triangle k and
/// shows the difference of its cell (0 if that was not compared).
PatchMesh cellMesh(const LightField& side);
std::vector<double> differenceOnTriangles(const LightField& side, const Comparison& comparison);

}  // namespace radiosity
