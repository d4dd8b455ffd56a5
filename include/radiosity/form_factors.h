// Form factors: F_ij is the fraction of the flux leaving patch i that reaches patch j.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/closure.h"
#include "radiosity/exchange_operator.h"
#include "radiosity/form_factor_method.h"
#include "radiosity/option_line.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/report_line.h"
#include "radiosity/row_journal.h"

namespace [[gnu::visibility("default")]] radiosity {

class Processes;

enum class ClosureMode {
  off,
  report,  ///< report how far the rows of a closed scene are from 1, change nothing
  enforce  ///< change entries not known in closed form until rows sum to 1 (closeRows())
};

/// The device that draws hemicubes. Both see the same, except in pixels whose centres lie on an
/// edge to within about 1/256 of a pixel.
enum class EyeChoice {
  cpu,       ///< the same bits on every machine
  gl,        ///< OpenGL's z-buffer, in software if there is no other
  automatic  ///< gl if eyeDevices() finds hardware, else cpu
};

/// A device that can draw hemicubes.
struct EyeDevice {
  std::string name;  ///< as its driver gives it
  std::string api;   ///< "OpenGL 4.5 ..."
  bool hardware = false;
};
struct EyeDevices {
  std::vector<EyeDevice> devices;  ///< hardware first
  std::string problem;             ///< if there are none: the reason
};
/// Looks for devices anew at every call, which takes up to a second since it loads drivers.
EyeDevices eyeDevices();

struct FormFactorOptions {
  FormFactorMethod method = FormFactorMethod::automatic;
  /// 1e-12 to 0.1. Exact: the error aimed at for an occluded pair, relative to the mean form factor
  /// 1/N; it keeps the relative error (L2) of a row below it, mostly far below. Closed forms hold
  /// it, or 1e-5 if that is smaller, relative to each value; above kExactTolerance, a tenth of it.
  /// Rays: the error (L2) of a row over its norm, or over the area-weighted root mean square of all
  /// norms if that is larger; so the relative error of the matrix is below it. Cut: the error (L2,
  /// by area) of irradiance, over all of it, under trial lights of the scene. Empty: the method's
  /// default; rays then stop at kMostRaysUnasked, since a row of an open scene may see next to
  /// nothing and would want a thousand times those of a closed one.
  std::optional<double> tolerance;
  /// The matrix only gives the brightness of sources from which light is gathered anew (elements).
  /// An empty tolerance then means kSourceTolerance, which raises the error of pictures by no more
  /// than .02% of light (tests/bench/README.md).
  bool sources_only = false;
  ClosureMode closure = ClosureMode::report;  ///< rays: rows are closed unless `off`
  /// Of the stored values. Empty: single, or double if the tolerance is below 1e-6.
  std::optional<Precision> precision;
  int resolution = 256;    ///< hemicube: pixels along an edge of the top face; even, 16 to 4096
  std::uint64_t seed = 1;  ///< rays: of their directions; hemicube: of the turns about each normal
  bool random_turns = true;
  EyeChoice eye = EyeChoice::cpu;  ///< hemicube
  bool symmetrize = false;         ///< hemicube: merge both estimates of each pair, then close rows
  /// Hemicube: pairs nearer than two patch sizes get the area-to-area value times the visible
  /// fraction from the item buffer.
  bool near_exact = false;
  /// Rays, cut, hemicube: patches, ascending, whose exchange with all others is exact: those that
  /// emit (emittingPatches()), since all other light comes from them. In a hemicube's row what else
  /// was seen is scaled to the rest of 1. If exact rows would take more than half as long as the
  /// others and more than some seconds, or have more than a million pairs, they are by shadow rays,
  /// to 2% of what a patch sees of emitters; if these would be many times as many as other rays, or
  /// there are more than ten million pairs, they are left to the method. The report says which.
  /// Exact: what other patches get from these is good to 5% itself where it is 1% of the mean or
  /// more, if they have a million pairs at most. Used where knowsEmitters().
  std::vector<Index> exact_rows;
  bool exact_emitters = true;    ///< false: exact_rows are estimated as all others
  std::size_t memory_limit = 0;  ///< bytes; 0: no limit
  /// A folder on a disk. Rows that do not fit within memory_limit go into an unnamed file there
  /// (ScratchMemory), with the same bits. Empty: such a matrix is refused.
  std::string scratch_folder;
  std::size_t memory_held = 0;  ///< bytes held by others; they count towards limit and estimate
  bool needs_pairs = false;     ///< F_ij are wanted one by one: a method without is refused
  bool simd = true;             ///< false: Highway's scalar target (same bits)

  static constexpr double kExactTolerance = traitsOf(FormFactorMethod::exact).tolerance;
  static constexpr double kRayTolerance = traitsOf(FormFactorMethod::rays).tolerance;
  static constexpr double kCutTolerance = traitsOf(FormFactorMethod::cut).tolerance;
  static constexpr double kSourceTolerance = 3e-2;
  static constexpr double kSourceSky = 0.1;
  /// About half a minute on two cores.
  static constexpr double kMostRaysUnasked = 2e8;

  void validate() const;

  /// A line an option (option_line.h).
  static void describe(auto& lines, auto& o) {
    const auto list = [&](OptionLine line, auto& value, const OptionRange& range = {}) {
      line.used = traitsOf(o.method).uses(line.optionName());
      lines(line, value, range);
    };
    list({.name = "method",
          .value = "METHOD",
          .help = "How form factors are computed (default auto: exact or rays, by what a sample of "
                  "rows takes; cut in place of rays where patches are many)"},
         o.method);
    list({.name = "tolerance",
          .value = "FRACTION",
          .help = "exact: error aimed at for an occluded pair, relative to the mean form factor "
                  "1/N (default {:g}); rays: relative error of a row, L2 (default {:g}, or what "
                  "{:g} million rays reach); cut: relative error of irradiance (default {:g})",
          .figures = {kExactTolerance, kRayTolerance, 1e-6 * kMostRaysUnasked, kCutTolerance},
          .unset = o.sources_only ? "sources" : "default"},
         o.tolerance, {.from = 1e-12, .to = 0.1});
    list(
        {.name = "closure",
         .value = "off|report|enforce",
         .help = "In a closed scene say how far row sums are from 1 (report, default), or make "
                 "them 1 by the smallest change to occluded pairs (enforce); rays: rows are closed "
                 "unless off"},
        o.closure);
    list({.name = "seed", .help = "rays: seed of their directions; hemicube: of the random turns"},
         o.seed);
    list({.name = "resolution",
          .value = "PIXELS",
          .unit = "pixels",
          .help = "hemicube: edge of the top face"},
         o.resolution, {.from = 16, .to = 4096, .only = OptionRange::Only::even});
    list({.name = "symmetrize",
          .help = "hemicube: merge both estimates of each pair (A_i F_ij = A_j F_ji), then restore "
                  "the row sums"},
         o.symmetrize);
    list({.name = "near_exact",
          .option = "near",
          .value = "exact|off",
          .help = "hemicube: area-to-area values times the visible fraction for pairs closer than "
                  "about two patch sizes",
          .on = "exact"},
         o.near_exact);
    list({.name = "random_turns", .in_key = InKey::if_changed}, o.random_turns);
    list({.name = "eye",
          .value = "cpu|gl|auto",
          .help = "hemicubes are drawn by the processor (cpu, default: the same bits on every "
                  "machine), by OpenGL (gl; radiosity info --devices lists what can), or by OpenGL "
                  "where there is hardware for it (auto)",
          .in_key = InKey::if_changed},
         o.eye);
    list({.name = "exact_emitters",
          .option = "emitters",
          .value = "exact|estimated",
          .help =
              "rays, cut, hemicube: form factors to and from what emits are exact, or estimated as "
              "all others",
          .in_key = InKey::if_changed,
          .on = "exact",
          .off = "estimated"},
         o.exact_emitters);
    list({.name = "precision",
          .value = "auto|single|double",
          .help = "Of the stored form factors (default auto: single unless the tolerance is below "
                  "1e-6); sums are always double",
          .unset = "auto"},
         o.precision);
    list({.name = "memory_limit",
          .value = "SIZE",
          .unit = "bytes",
          .help = "Keep form factors that need more memory in a nameless file beside the output, "
                  "and refuse those that still do not fit: bytes, or 512M, 2G, ... (default: no "
                  "limit)",
          .in_key = InKey::never},
         o.memory_limit);
    list({.name = "memory_held", .unit = "bytes", .in_key = InKey::never}, o.memory_held);
    list({.name = "scratch_folder", .in_key = InKey::never}, o.scratch_folder);
    list({.name = "needs_pairs", .in_key = InKey::never}, o.needs_pairs);
  }

  Precision storedPrecision() const;
  /// The tolerance of a method; of one without, that of exact form factors beside its own.
  double toleranceOf(FormFactorMethod by) const {
    if (tolerance) return *tolerance;
    // Of irradiance, which sources give back as it is.
    if (sources_only && by != FormFactorMethod::cut) return kSourceTolerance;
    const double usual = traitsOf(by).tolerance;
    return usual > 0 ? usual : kExactTolerance;
  }
  /// Whether both form factors of a pair are one value: A_i F_ij = A_j F_ji.
  bool givesSymmetric() const {
    const MethodTraits& traits = traitsOf(method);
    return traits.symmetric || (symmetrize && traits.uses("symmetrize"));
  }
  /// Whether form factors need to be good for sources alone. If a tolerance is given, they are
  /// those for all uses.
  bool onlyForSources() const { return sources_only && !tolerance; }
  /// Whether a method uses exact_rows: not for sources alone, where light of emitters is found
  /// anew, but where a row has its own rays alone and so knows a lamp too badly even for these.
  bool knowsEmitters(FormFactorMethod by) const {
    return exact_emitters && (!onlyForSources() || by == FormFactorMethod::cut);
  }
  /// Rays: the sky's part in the norms that errors are relative to: sqrt(sum_j F_ij^2 + (w
  /// F_sky)^2). Of sources, if no tolerance is given, it is kSourceSky: bodies that see little but
  /// the sky are lit by it, or bring little light. Otherwise 0.
  double skyWeight() const { return onlyForSources() ? kSourceSky : 0; }
};

/// Counts of work done and skipped by the exact method. A pair is an unordered pair of elements
/// (convex pieces of patches; most patches are one), counted once.
struct ExactReport {
  std::size_t elements = 0;
  std::size_t black_elements = 0;  ///< pieces of backs that are not patches: they only absorb
  std::size_t facets = 0;          ///< planar sides that carry elements
  std::size_t occluders = 0;
  std::size_t solids = 0;        ///< of these, convex solids; the rest is flat
  std::size_t skipped_hull = 0;  ///< polygons that cannot block: all of the scene is on one side

  std::size_t no_exchange = 0;  ///< pairs coplanar, back to back, below each other's horizon
  std::size_t unoccluded = 0;   ///< pairs with nothing in between, which skip all visibility code
  std::size_t hidden = 0;       ///< pairs found to exchange nothing
  std::size_t occluded = 0;     ///< pairs clipped against their occluders

  std::size_t facet_pairs = 0;
  std::size_t facet_pairs_no_exchange = 0;  ///< skipped whole, by their planes alone
  std::size_t facet_pairs_unoccluded = 0;   ///< visibility skipped whole
  std::size_t shaft_tests = 0;

  std::size_t contour = 0;  ///< values by contour integrals
  std::size_t lambert = 0;  ///< values by point-to-polygon formula, averaged over points
  std::size_t product = 0;  ///< values by product quadrature
  std::size_t clipped = 0;  ///< of all: pairs that cross the other's plane, clipped first

  std::size_t points = 0;      ///< point evaluations of occluded pairs
  std::size_t subdivided = 0;  ///< occluded pairs that needed more than the first rule
  /// Occluded pairs evaluated again in double precision: too near for their points, or intricate.
  std::size_t evaluated_again = 0;
  std::size_t rechecked = 0;  ///< occluded pairs evaluated again to an eighth of the tolerance
  /// The ratio of error to figure that 1% of rows drawn from these pairs exceed. If 1.75 times the
  /// ratio is above 1, error figures are multiplied by it.
  double recheck_ratio = 0;

  /// Processor seconds by stage, summed over threads; preparing and finishing by the clock.
  double seconds_prepare = 0;     ///< elements, occluders, kernels
  double seconds_visibility = 0;  ///< classifying pairs
  double seconds_unoccluded = 0;  ///< closed forms and quadrature
  double seconds_occluded = 0;    ///< clipping
  double seconds_assembly = 0;    ///< summing and storing
  double seconds_finish = 0;      ///< row sums, error figures, closure

  static void describe(auto& list, auto& r) {
    list({"elements", "elements"}, r.elements);
    list({"black_elements", "  and of black backs"}, r.black_elements);
    list({"facets", "facets"}, r.facets);
    list({"occluders", "occluders"}, r.occluders);
    list({"solids", "  of them convex solids"}, r.solids);
    list({"skipped_hull", "skipped: cannot block"}, r.skipped_hull);
    list({"no_exchange", "pairs without exchange", "", "pairs_no_exchange"}, r.no_exchange);
    list({"unoccluded", "pairs unoccluded", "", "pairs_unoccluded"}, r.unoccluded);
    list({"hidden", "pairs hidden", "", "pairs_hidden"}, r.hidden);
    list({"occluded", "pairs occluded", "", "pairs_occluded"}, r.occluded);
    list({"facet_pairs", "facet pairs"}, r.facet_pairs);
    list({"facet_pairs_no_exchange", "skipped: no exchange", "", "skipped_facet_pairs"},
         r.facet_pairs_no_exchange);
    list({"facet_pairs_unoccluded", "skipped: visibility", "", "skipped_visibility"},
         r.facet_pairs_unoccluded);
    list({"shaft_tests", "shaft tests"}, r.shaft_tests);
    list({"contour", "values by contour"}, r.contour);
    list({"lambert", "values by Lambert"}, r.lambert);
    list({"product", "values by quadrature"}, r.product);
    list({"clipped", "  clipped to front sides"}, r.clipped);
    list({"points", "points of occluded pairs"}, r.points);
    list({"subdivided", "occluded pairs refined"}, r.subdivided);
    list({"evaluated_again", "occluded pairs again in double"}, r.evaluated_again);
    list({"rechecked", "evaluated again to check"}, r.rechecked);
    list({"recheck_ratio", "  row error / figure, 99%"}, r.recheck_ratio);
    list({"seconds_prepare", "time: preparing", "s"}, r.seconds_prepare);
    list({"seconds_visibility", "time: visibility", "s"}, r.seconds_visibility);
    list({"seconds_unoccluded", "time: closed forms", "s"}, r.seconds_unoccluded);
    list({"seconds_occluded", "time: occluded pairs", "s"}, r.seconds_occluded);
    list({"seconds_assembly", "time: storing rows", "s"}, r.seconds_assembly);
    list({"seconds_finish", "time: finishing", "s"}, r.seconds_finish);
  }
};

/// Counts and times of rays.
struct RayReport {
  std::size_t triangles = 0;
  std::size_t rays = 0;    ///< cast in total
  std::size_t leaked = 0;  ///< of these, not counted: they left patches that are enclosed
  int rounds = 0;
  std::size_t short_rows = 0;  ///< given up before they met the tolerance
  /// The tolerance that rows were cast to, if none was asked for and kMostRaysUnasked did not
  /// suffice for the default.
  std::optional<double> loosened_tolerance;
  double largest_row_figure = 0;  ///< largest of FormFactors::error over the norm of its row
  /// By the clock, like the others: the tree, the look-up and the exact rows.
  double seconds_prepare = 0;
  double seconds_cast = 0;
  double seconds_merge = 0;
  double seconds_close = 0;

  static void describe(auto& list, auto& r) {
    list({"triangles", "triangles"}, r.triangles);
    list({"rays", "rays"}, r.rays);
    list({"leaked", "  leaked out, not counted", "", "rays_leaked"}, r.leaked);
    list({"rounds", "rounds"}, r.rounds);
    list({"short_rows", "rows short of the tolerance"}, r.short_rows);
    list({"loosened_tolerance", "  which was loosened to"}, r.loosened_tolerance);
    list({"largest_row_figure"}, r.largest_row_figure);
    list({"seconds_prepare", "time: preparing", "s"}, r.seconds_prepare);
    list({"seconds_cast", "time: casting", "s"}, r.seconds_cast);
    list({"seconds_merge", "time: merging", "s"}, r.seconds_merge);
    list({"seconds_close", "time: closing rows", "s"}, r.seconds_close);
  }
};

/// Counts, errors and times of rows that are cut.
struct CutReport {
  std::size_t triangles = 0;
  std::size_t rays = 0;    ///< cast in total
  std::size_t leaked = 0;  ///< of these, not counted: they left patches that are enclosed
  std::size_t rays_a_row = 0;
  std::size_t entries = 0;  ///< of all rows: a node of the tree each
  double opening = 0;       ///< the most radius of a node over its distance
  /// Relative errors of irradiance (L2, by area) of rows that were tried under some suns or lamps
  /// and their shadows: by rays, and by cutting.
  double noise = 0;
  double bias = 0;
  /// The power that rows bring from each patch less what leaves it, summed up without signs over
  /// all power: by their rays alone, and as scaled.
  double unbalanced_before = 0;
  double unbalanced = 0;
  double seconds_prepare = 0;  ///< by the clock: the trees and the exact rows
  double seconds_rows = 0;

  /// Of irradiance, under the trial lights.
  double error() const { return std::hypot(noise, bias); }

  static void describe(auto& list, auto& r) {
    list({"triangles", "triangles"}, r.triangles);
    list({"rays", "rays"}, r.rays);
    list({"leaked", "  leaked out, not counted", "", "rays_leaked"}, r.leaked);
    list({"rays_a_row", "  a row"}, r.rays_a_row);
    list({"entries", "nodes in rows"}, r.entries);
    list({"opening", "  radius over distance up to"}, r.opening);
    list({"noise", "irradiance off by: rays"}, r.noise);
    list({"bias", "irradiance off by: cutting"}, r.bias);
    list({"unbalanced_before", "power of patches off by: rays"}, r.unbalanced_before);
    list({"unbalanced", "  as scaled"}, r.unbalanced);
    list({"seconds_prepare", "time: preparing", "s"}, r.seconds_prepare);
    list({"seconds_rows", "time: rows", "s"}, r.seconds_rows);
  }
};

/// Counts of hemicubes, summed over them and, of polygons, over their faces.
struct HemicubeReport {
  std::size_t hemicubes = 0;
  std::size_t pixels = 0;               ///< resolved
  std::size_t rasterised_polygons = 0;  ///< polygon-face fills
  std::size_t skipped_own_plane = 0;    ///< polygons skipped since the eye lies in their plane
  std::size_t skipped_horizon = 0;      ///< behind the eye's horizon
  std::size_t skipped_facing_away = 0;  ///< back faces of closed solids seen from outside
  std::size_t skipped_face = 0;         ///< polygon-face pairs outside the face's pyramid
  std::size_t skipped_hidden = 0;       ///< behind drawn polygons, or between pixels' centres
  std::size_t near_pairs = 0;           ///< entries replaced by area-to-area values
  std::size_t capped = 0;               ///< rows whose near entries were limited to a sum of 1

  HemicubeReport& operator+=(const HemicubeReport& other) {
    hemicubes += other.hemicubes;
    pixels += other.pixels;
    rasterised_polygons += other.rasterised_polygons;
    skipped_own_plane += other.skipped_own_plane;
    skipped_horizon += other.skipped_horizon;
    skipped_facing_away += other.skipped_facing_away;
    skipped_face += other.skipped_face;
    skipped_hidden += other.skipped_hidden;
    near_pairs += other.near_pairs;
    capped += other.capped;
    return *this;
  }

  static void describe(auto& list, auto& r) {
    list({"hemicubes", "hemicubes"}, r.hemicubes);
    list({"pixels", "pixels resolved"}, r.pixels);
    list({"rasterised_polygons", "polygons rasterised"}, r.rasterised_polygons);
    list({"skipped_own_plane", "skipped: own plane"}, r.skipped_own_plane);
    list({"skipped_horizon", "skipped: below horizon"}, r.skipped_horizon);
    list({"skipped_facing_away", "skipped: facing away"}, r.skipped_facing_away);
    list({"skipped_face", "skipped: outside a face"}, r.skipped_face);
    list({"skipped_hidden", "skipped: hidden"}, r.skipped_hidden);
    list({"near_pairs", "near entries made exact"}, r.near_pairs);
    list({"capped", "  rows held at 1"}, r.capped);
  }
};

/// The report of a computation: its method, counts, times and errors.
struct FormFactorReport {
  std::string method_reason;   ///< why this method, if it was chosen automatically
  std::size_t empty_rows = 0;  ///< degenerate patches: no hemicube, no elements
  std::size_t polygons = 0;    ///< planar polygons of the mesh
  /// Rays, cut, hemicube: rows that are exact, not estimated; empty if
  /// FormFactorOptions::exact_rows asked for none, or they are by shadow rays.
  std::optional<std::size_t> exact_rows;
  std::optional<std::size_t> shadow_rows;  ///< rows of emitters by shadow rays; empty: none
  std::string simd_target;                 ///< Highway's name, e.g. "AVX3", "SCALAR"
  double seconds = 0;                      ///< in total
  double seconds_plan = 0;                 ///< of these, for the plan, without seconds_prepare
  double estimated_seconds = 0;            ///< the others, as estimated when they were planned
  std::size_t matrix_bytes = 0;
  std::size_t estimated_bytes = 0;  ///< as estimated before the run
  double reciprocity_residual = 0;  ///< of the raw rows; 0 by construction in the exact method
  /// max |fronts + backs + sky - 1| over non-empty rows. Exact: raw, where rows are closed; else
  /// the amount by which fronts + backs exceed 1.
  double largest_row_error = 0;
  /// Exact and rays: area-weighted relL2 of the error of F; see FormFactors. Rays that give
  /// sources: relative to norms in which the sky counts, FormFactorOptions::skyWeight().
  double error_figure = 0;
  bool closed = false;  ///< no patch sees the sky: all are enclosed (Enclosures)
  bool symmetrized = false;
  ClosureReport closure;          ///< if symmetrized, or exact and closed
  bool closure_enforced = false;  ///< exact: rows were closed, not only measured
  // Of the method that ran:
  ExactReport exact;
  RayReport rays;
  CutReport cut;
  HemicubeReport hemicube;
  std::vector<Note> notes;  ///< surfaces seen from behind, ...

  /// Without `hemicube`, whose fields are in the same group as these.
  static void describe(auto& list, auto& r) {
    list({"method_reason", "  because"}, r.method_reason);
    list({"exact_rows", "exact rows, of emitters"}, r.exact_rows);
    list({"shadow_rows", "rows by shadow rays, of emitters"}, r.shadow_rows);
    list({"empty_rows", "empty rows (degenerate)"}, r.empty_rows);
    list({"seconds", "time", "s"}, r.seconds);
    list({"seconds_plan", "  of that, planning", "s"}, r.seconds_plan);
    list({"estimated_seconds", "  the rest estimated before", "s"}, r.estimated_seconds);
    list({"simd_target", "instruction set"}, r.simd_target);
    list({"matrix_bytes", "matrix in memory", "bytes"}, r.matrix_bytes);
    list({"estimated_bytes", "  estimated before", "bytes"}, r.estimated_bytes);
    list({"polygons", "planar polygons"}, r.polygons);
    list.part("exact", r.exact);
    list.part("rays", r.rays);
    list.part("cut", r.cut);
    list({"closed", "closed scene"}, r.closed);
    list({"error_figure"}, r.error_figure);
    list({"largest_row_error"}, r.largest_row_error);
    list({"reciprocity_residual"}, r.reciprocity_residual);
    list({"symmetrized"}, r.symmetrized);
    list({"closure_enforced"}, r.closure_enforced);
    list.part("closure", r.closure);
    list.notes(r.notes);
  }
};

/// The matrix and the three accounts of each row, which sum to 1: seen fronts (the row sum), seen
/// backs and sky. N values each, 0 in the row of a degenerate patch. Exact: fronts and backs are as
/// computed. The sky of an enclosed patch (Enclosures) is 0, and 1 - fronts - backs is the raw
/// error of closure. That of others is 1 - fronts - backs, but never below 0: where rounding and
/// the tolerance have more than 1, that is the row's error.
struct FormFactors {
  std::shared_ptr<const ExchangeOperator> matrix;  ///< null: it was left out (readResults())
  std::vector<double> fronts;
  std::vector<double> backs;
  std::vector<double> sky;
  /// Area-weighted share of the scene's view that ends on each surface's back, by surface.
  std::vector<double> backs_by_surface;
  /// Exact and rays: N error figures. sqrt(sum_j (F_ij - true F_ij)^2), with black backs among the
  /// j, stays below error[i] in about 99% of rows. Exact: the median of the figures is mostly 4 to
  /// 14 times the true one. Cut and hemicube: empty.
  std::vector<double> error;
  FormFactorMethod method = FormFactorMethod::matrix;  ///< never automatic
  FormFactorReport report;

  /// Whether no row sees a front: a room that faces outward, or a lone convex body.
  bool seeNothing() const {
    return !fronts.empty() &&
           std::all_of(fronts.begin(), fronts.end(), [](double seen) { return seen == 0; });
  }
  /// What a result that is usable depends on; empty: nothing.
  const char* condition() const {
    return seeNothing() ? "only if no surface is meant to see another" : "";
  }
};

/// The plan of a computation, made from a sample of rows before time and memory are spent.
/// `automatic` chooses by the seconds of exact and of rays or cut. Seconds are by the clock, on the
/// threads allowed, at the rates that the sample reached on this machine, without the time of the
/// plan itself. On scenes that nothing was fitted to they are mostly right within a factor of 2.
struct FormFactorPlan {
  FormFactorMethod method = FormFactorMethod::hemicube;  ///< never automatic
  std::string what;    ///< "12 hemicubes of 256 pixels", ...; empty: form factors between patches
  std::string reason;  ///< if it was automatic
  std::size_t bytes = 0;         ///< about, held at once; options.memory_held included
  std::size_t matrix_bytes = 0;  ///< of these, the matrix
  /// On the disk in FormFactorOptions::scratch_folder, including the matrix; 0: all is in memory.
  std::size_t scratch_bytes = 0;
  double seconds = 0;
  /// As FormFactorOptions::tolerance, looser if rays stop early.
  double tolerance = 0;
  /// The share of the seconds that goes with tolerance^-refining_order.
  double refining = 0;
  double refining_order = 1;
  /// About the seconds for a tolerance that is `times` the plan's, 1 or more.
  double secondsIfLooser(double times) const;
  /// If rays stop early: seconds for the default tolerance.
  std::optional<double> seconds_to_tolerance;
  /// The other one of exact and rays or cut, if both were sampled.
  struct Other {
    FormFactorMethod method = FormFactorMethod::exact;
    double seconds = 0;
  };
  std::optional<Other> other;
  /// The mesh, the options and everything that the plan prepared for the computation.
  struct Prepared;
  std::shared_ptr<const Prepared> prepared;
};
/// The plan keeps a copy of the mesh (about 160 bytes a patch).
FormFactorPlan planFormFactors(const PatchMesh& mesh, const FormFactorOptions& options,
                               Progress& progress);
/// The plan shares the mesh, which must not change while the plan exists.
FormFactorPlan planFormFactors(std::shared_ptr<const PatchMesh> mesh,
                               const FormFactorOptions& options, Progress& progress);

/// Computes form factors on all cores, with the same bits for any number of them. Hemicube: raw
/// rows, as seen, unless `symmetrize`; exact: a symmetric matrix. Errors: RunError if the estimate
/// exceeds `memory_limit` (with the numbers).
FormFactors computeFormFactors(const PatchMesh& mesh, const FormFactorOptions& options,
                               Progress& progress);

/// The same from a plan of planFormFactors(), any number of times. `journal`: keeps rows, and
/// returns rows of an earlier run of the same; none: rows are not kept. The bits are the same
/// either way. Exact form factors that `automatic` chose are given up, and rays take their place,
/// if they take far longer than the plan says; the report notes it. `processes`: internal, for the
/// program under mpirun (base/processes.h is not installed). They share the work and, after that,
/// the matrix; the others run shareFormFactors() (src/formfactor/shared_factors.h) meanwhile.
/// Errors: also InputError if the method cannot be shared.
FormFactors computeFormFactors(const FormFactorPlan& plan, Progress& progress,
                               RowJournal* journal = nullptr, Processes* processes = nullptr);

}  // namespace radiosity
