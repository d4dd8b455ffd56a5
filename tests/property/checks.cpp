#include "checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <exception>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <utility>

#include "base/geometry/box.h"
#include "formfactor/light_on_patches.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "radiosity/gather.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/scene.h"
#include "radiosity/solve.h"

namespace radiosity::property {

void RowCount::add(const RowCount& other) {
  rows += other.rows;
  beyond += other.beyond;
  if (other.worst > worst) {
    worst = other.worst;
    worst_scene = other.worst_scene;
  }
}

namespace {

constexpr double kExact = 1e-3;
/// What errors are measured against.
constexpr double kTight = 1e-4;
constexpr double kRays = 3e-2;
constexpr double kCut = 5e-2;
/// Of one run of a method. The scenes that ctest runs are far below it on any machine.
constexpr double kMostSeconds = 4;
/// Values in single precision, of a row's norm.
constexpr double kRounding = 1e-7;
/// A sum of rounded values.
constexpr double kSingleSum = 1e-6;
/// What closed forms hold, of a row's norm or, all off alike, of its sum.
constexpr double kClosedForm = 1e-5;
/// Values that are rounding alone.
constexpr double kNothing = 1e-12;
/// Of a hemicube's light, on no account. Both ends of a pair are estimates that are off by some per
/// cent, and nobody says by how much: a solution is refused as unbalanced from here on
/// (src/solve/README.md), and that is what is held against it.
constexpr double kImbalanceOfHemicubes = 0.1;
/// Of others, which state their error.
constexpr double kLeastImbalance = 5e-3;

struct Method {
  const char* name;
  FormFactorMethod method;
  double tolerance;
};
constexpr Method kMethods[] = {{"exact", FormFactorMethod::exact, kExact},
                               {"rays", FormFactorMethod::rays, kRays},
                               {"cut", FormFactorMethod::cut, kCut},
                               {"hemicube", FormFactorMethod::hemicube, 0}};

class Checker {
 public:
  Checker(const Model& model, const std::string& path, Findings& findings)
      : model_(model), path_(path), findings_(findings) {}

  void run() {
    scene_ = loadScene(path_ + ".obj", model_.options());
    MeshOptions options;
    options.patches = model_.patches;
    result_ = meshScene(scene_, options, silent_);
    mesh_ = &result_.mesh;
    materials_ = patchMaterials(scene_, *mesh_);
    checkMesh();
    FormFactorOptions tight = optionsOf(kMethods[0]);
    tight.tolerance = kTight;
    tight.precision = Precision::double_precision;
    const std::optional<FormFactors> truth = computed(tight);
    if (truth) {
      checkAccounts("tight", *truth);
      checkKnown("tight", *truth);
      closed_ = truth->report.closed;
    }
    for (const Method& method : kMethods) {
      const std::optional<FormFactors> factors = computed(optionsOf(method));
      if (!factors) continue;
      checkAccounts(method.name, *factors);
      checkEnergy(method.name, *factors, materials_);
      if (method.method == FormFactorMethod::rays) checkLamps(*factors);
      checkClosed(method.name, factors->report.closed);
      if (!factors->error.empty()) {
        checkKnown(method.name, *factors);
        if (truth && !isAmbiguous(*truth)) checkErrors(method.name, *factors, *truth);
      }
      if (model_.seed % 4 == 0) checkThreads(method, *factors);
    }
    if (model_.seed % 4 == 1) checkGather();
    if (model_.known.inside_out && truth) checkInsideOut(*truth);
  }

 private:
  template <class... Values>
  void fault(const std::string& what, fmt::format_string<Values...> text, Values&&... values) {
    for (const Fault& known : findings_.faults) {
      if (known.what == what) return;  // the first row says it
    }
    findings_.faults.push_back({what, fmt::format(text, std::forward<Values>(values)...)});
  }

  FormFactorOptions optionsOf(const Method& method) const {
    FormFactorOptions options;
    options.method = method.method;
    options.resolution = 64;
    options.seed = model_.seed + 1;
    if (method.tolerance > 0) options.tolerance = method.tolerance;
    if (model_.exact_emitters) options.exact_rows = emittingPatches(*mesh_, materials_);
    return options;
  }

  /// None if they would take too long: shadows of crumpled slivers are cut without end.
  std::optional<FormFactors> computed(const FormFactorOptions& options) {
    const FormFactorPlan plan = planFormFactors(*mesh_, options, silent_);
    if (plan.seconds > kMostSeconds) {
      ++findings_.too_long;
      return {};
    }
    return computeFormFactors(plan, silent_);
  }

  bool isNoted(const std::string& word, const std::vector<Note>& of_factors = {}) const {
    const auto has = [&](const std::vector<Note>& notes) {
      return std::any_of(notes.begin(), notes.end(), [&](const Note& note) {
        return note.text.find(word) != std::string::npos;
      });
    };
    return has(scene_.notes) || has(result_.report.notes) || has(of_factors);
  }

  /// Faces nearly meet or cross, by about the coincidence: which hides which, and what lies in
  /// contact, is then the method's choice.
  bool isAmbiguous(const FormFactors& truth) const {
    if (model_.known.at_weld_distance) return true;
    return std::any_of(truth.report.notes.begin(), truth.report.notes.end(), [](const Note& note) {
      return note.text.find("weld") != std::string::npos;
    });
  }

  /// No area is lost without a word.
  void checkMesh() {
    for (const SurfaceAreas& s : result_.report.surfaces) {
      const double left = s.given - s.kept - s.buried - s.overlapped - s.degenerate;
      if (!(std::abs(left) <= 1e-9 * s.given)) {
        fault("area lost", "{}: {} of {} m^2 on no account", s.name, left, s.given);
      }
      if (s.degenerate > 0.5 * s.given && !isNoted(s.name) && !isNoted("weld")) {
        fault("surface dropped", "{}: {} of {} m^2 thinner than coincidence, not noted", s.name,
              s.degenerate, s.given);
      }
    }
    for (std::size_t i = 0; i < mesh_->size(); ++i) {
      if (!std::isfinite(mesh_->area[i]) || !(mesh_->area[i] > 0)) {
        fault("area not finite", "patch {} has {}", i, mesh_->area[i]);
      }
    }
  }

  /// Every value is finite and none is below 0; the accounts of a row sum to 1.
  void checkAccounts(const std::string& by, const FormFactors& f) {
    const bool has_errors = !f.error.empty();
    const auto sane = [](double value) { return std::isfinite(value) && value >= 0; };
    const double terms = std::sqrt(double(f.matrix->size()) + 1);
    for (std::size_t i = 0; i < f.matrix->size(); ++i) {
      double sum = 0;
      const std::vector<double> row = f.matrix->row(i);
      for (Index j = 0; j < row.size(); ++j) {
        if (!std::isfinite(row[j]) || (row[j] < 0 && f.matrix->isNonNegative())) {
          fault("negative " + by, "F({}, {}) = {}", i, j, row[j]);
        }
        sum += row[j];
        if (f.matrix->isSymmetric() && row[j] > 0) checkPair(by, *f.matrix, i, j, row[j]);
      }
      if (!sane(f.fronts[i]) || !sane(f.backs[i]) || !sane(f.sky[i]) ||
          (has_errors && !sane(f.error[i]))) {
        fault("account negative " + by, "row {}: fronts {}, backs {}, sky {}", i, f.fronts[i],
              f.backs[i], f.sky[i]);
      }
      const double stated = has_errors ? terms * f.error[i] + kClosedForm : kSingleSum;
      const double all = sum + f.backs[i] + f.sky[i];
      if (f.matrix->area()[i] > 0 && !(std::abs(all - 1) <= stated)) {
        fault("row sum " + by, "row {}: {} + {} + {} = {}, stated {}", i, sum, f.backs[i], f.sky[i],
              all, stated);
      }
    }
    if (by == "exact" && !f.matrix->isSymmetric()) fault("reciprocity exact", "stored as rows");
  }

  /// One value is stored a pair: the other is off by the rounding of a product and a quotient.
  void checkPair(const std::string& by, const ExchangeOperator& f, std::size_t i, Index j,
                 double value) {
    const double there = f.area()[i] * value;
    const double back = f.area()[j] * f.at(j, i);
    if (!(std::abs(there - back) <= 4e-16 * there)) {
      fault("reciprocity " + by, "G({}, {}) = {:.17g}, {:.17g}", i, j, there, back);
    }
  }

  /// All methods say alike if the scene is closed, and what is known of it holds.
  void checkClosed(const std::string& by, bool closed) {
    if (!closed_) closed_ = closed;
    if (closed != *closed_) {
      fault("closed or open " + by, "{} by {}, {} by others", closed ? "closed" : "open", by,
            *closed_ ? "closed" : "open");
    }
    // That a room is closed may remain unproved; that an open one is not must be known.
    if (closed && model_.known.closed == false) fault("closed is open " + by, "it is open");
  }

  static double mostImbalance(const FormFactors& f) {
    if (f.method == FormFactorMethod::hemicube) return kImbalanceOfHemicubes;
    return std::max(kLeastImbalance, f.report.error_figure);
  }

  /// Light that is not accounted for is no more than rows state, or the solution is not usable.
  void checkEnergy(const std::string& by, const FormFactors& f, const PatchMaterials& materials) {
    const Solution s = solve(f, materials, *mesh_, {}, silent_);
    for (const double b : s.radiosity) {
      if (!std::isfinite(b) || b < 0) return fault("radiosity " + by, "B = {}", b);
    }
    if (!s.summary.usable()) {
      if (s.summary.status == SolveStatus::no_convergence) {
        fault("no convergence " + by, "{}", s.summary.message);
      }
      return;
    }
    const EnergyAccount& e = s.summary.energy;
    const double in = e.emitted[0] + e.from_sky[0];
    if (!(std::abs(e.imbalance[0]) <= mostImbalance(f) * in)) {
      fault("energy " + by, "{:.3g}% of {:.4g} W is on no account, usable",
            100 * e.imbalance[0] / in, in);
    }
  }

  /// A point somewhere in the scene's box, and a sun: no more light falls on patches than they
  /// give, and it is accounted for.
  void checkLamps(const FormFactors& f) {
    Box3 box;
    for (const Vec3& v : mesh_->vertices) box.add(v);
    std::mt19937_64 random(model_.seed);
    std::uniform_real_distribution<double> share(0, 1);
    const auto anyVector = [&] { return Vec3(share(random), share(random), share(random)); };
    const double size = glm::length(box.size());
    PointLight point;
    point.at = box.low + anyVector() * box.size();
    Sun sun;
    sun.toward = anyVector() - 0.5;
    PatchMaterials lit = materials_;
    std::ranges::fill(lit.emission, 0.0);
    lit.lights = {{"point", point, std::vector<double>(3, size * size)},
                  {"sun", sun, std::vector<double>(3, 1.0)}};
    // A box of that diagonal has at most so much shadow.
    const double most[] = {4 * std::numbers::pi * size * size, size * size};
    for (std::size_t l = 0; l < lit.lights.size(); ++l) {
      const std::span<const Light> light(&lit.lights[l], 1);
      const LightFall fall = LightOnPatches(*mesh_).aimed(light, 3, silent_);
      double power = 0;
      for (std::size_t i = 0; i < mesh_->size(); ++i) {
        power += mesh_->area[i] * fall.irradiance[3 * i];
      }
      // Surfaces that noise has moved through each other are lit twice there: what a solution may
      // have on no account.
      if (!(power >= 0 && power <= most[l] * (1 + 3 * fall.error + mostImbalance(f)))) {
        fault("lamp " + lit.lights[l].name, "gives {:.6g} W, {:.6g} W falls on patches", most[l],
              power);
      }
    }
    checkEnergy("lamps", f, lit);
    if (model_.seed % 4 != 0) return;
    const LightFall one = LightOnPatches(*mesh_).aimed(lit.lights, 3, silent_);
    setThreads(2);
    const LightFall two = LightOnPatches(*mesh_).aimed(lit.lights, 3, silent_);
    setThreads(1);
    if (one.irradiance != two.irradiance) fault("threads lamps", "other bits with two threads");
  }

  /// Rows are within their figures, those of the tight run allowed for.
  void checkErrors(const std::string& by, const FormFactors& f, const FormFactors& truth) {
    RowCount& count = findings_.rows[by];
    const std::size_t n = truth.matrix->size();
    const std::span<const double> area = truth.matrix->area();
    std::vector<double> row(n);
    double squares = 0;
    double norms = 0;
    double states = 0;
    for (std::size_t i = 0; i < n; ++i) {
      std::fill(row.begin(), row.end(), 0.0);
      double norm = 0;
      pairsOf(*truth.matrix).forRow(i, [&](Index j, double value) {
        row[j] = value;
        norm += value * value;
      });
      pairsOf(*f.matrix).forRow(i, [&](Index j, double value) { row[j] -= value; });
      double square = 0;
      for (const double difference : row) square += difference * difference;
      squares += area[i] * square;
      norms += area[i] * norm;
      states += area[i] * truth.error[i] * truth.error[i];
      const double error = std::sqrt(square);
      const double figure = f.error[i] + truth.error[i] + kRounding * std::sqrt(norm) + kNothing;
      ++count.rows;
      if (error > figure) ++count.beyond;
      const double ratio = error / figure;
      if (ratio > count.worst) {
        count.worst = ratio;
        count.worst_scene = fmt::format("{} {}", model_.kind, model_.seed);
      }
      if (!(error <= 2 * figure + kClosedForm * std::sqrt(norm))) {
        fault("figure " + by, "row {}: error {:.3g}, stated {:.3g} ({:.3g} of the tight run)", i,
              error, f.error[i], truth.error[i]);
      }
    }
    if (norms > 0) checkMatrix(by, f, std::sqrt(squares / norms), std::sqrt(states / norms));
  }

  /// The error of the whole matrix is what is stated and, unless rows are said to be short of it,
  /// what was asked for. Where a matrix rests on a single pair, four times that is four standard
  /// deviations.
  void checkMatrix(const std::string& by, const FormFactors& f, double error, double tight) {
    const double stated = f.report.error_figure;
    if (!(error <= 4 * stated + tight + kRounding)) {
      fault("matrix " + by, "error {:.3g}, stated {:.3g}", error, stated);
    }
    if (f.method == FormFactorMethod::rays && f.report.rays.short_rows == 0 &&
        !(error <= 4 * kRays + tight)) {
      fault("tolerance " + by, "error {:.3g}, asked for {:.3g}, no row short", error, kRays);
    }
  }

  /// Sums over surfaces against what the making of the scene tells.
  void checkKnown(const std::string& by, const FormFactors& f) {
    if (model_.known.at_weld_distance && (isNoted("weld") || isNoted("coincide"))) return;
    const std::span<const double> area = f.matrix->area();
    if (model_.known.sky_area) {
      double sky = 0;
      double stated = 0;
      for (std::size_t i = 0; i < area.size(); ++i) {
        sky += area[i] * f.sky[i];
        stated += area[i] * (f.error[i] * std::sqrt(double(area.size())) + 1e-6);
      }
      if (!(std::abs(sky - *model_.known.sky_area) <= stated)) {
        fault("sky " + by, "sees {:.6g} m^2 of sky, {:.6g} by its making, stated {:.3g}", sky,
              *model_.known.sky_area, stated);
      }
    }
    if (model_.known.factor) checkFactor(by, f);
  }

  void checkFactor(const std::string& by, const FormFactors& f) {
    const Known::Factor& known = *model_.known.factor;
    double exchange = 0;
    double from_area = 0;
    double stated = 0;
    for (std::size_t i = 0; i < f.matrix->size(); ++i) {
      if (!isOf(i, known.from)) continue;
      const double area = f.matrix->area()[i];
      from_area += area;
      stated += area * f.error[i] * std::sqrt(double(f.matrix->size()));
      pairsOf(*f.matrix).forRow(i, [&](Index j, double value) {
        if (isOf(j, known.to)) exchange += area * value;
      });
    }
    if (from_area == 0) {
      if (!isNoted("weld")) fault("surface gone " + by, "{} has no patch", known.from);
      return;
    }
    const double value = exchange / from_area;
    const double allowed = 2 * stated / from_area + (known.error + 2e-5) * known.value;
    if (!(std::abs(value - known.value) <= allowed)) {
      fault("value " + by, "F({}, {}) = {:.9g}, {:.9g} by formula, stated {:.3g}", known.from,
            known.to, value, known.value, allowed);
    }
  }

  /// If the patch is of the part of that name.
  bool isOf(std::size_t patch, const std::string& name) const {
    return mesh_->surface_names[mesh_->surface[patch]].starts_with(name);
  }

  void checkThreads(const Method& method, const FormFactors& one) {
    setThreads(2);
    const FormFactors two = computeFormFactors(*mesh_, optionsOf(method), silent_);
    setThreads(1);
    const auto same = [](double a, double b) {
      return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
    };
    const auto sameAll = [&](const std::vector<double>& a, const std::vector<double>& b) {
      return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
    };
    bool equal = sameAll(one.fronts, two.fronts) && sameAll(one.backs, two.backs) &&
                 sameAll(one.sky, two.sky) && sameAll(one.error, two.error);
    for (std::size_t i = 0; i < one.matrix->size() && equal; ++i) {
      equal = sameAll(one.matrix->row(i), two.matrix->row(i));
    }
    if (!equal) fault(std::string("threads ") + method.name, "other bits with two threads");
  }

  void checkGather() {
    GatherOptions options;
    options.resolution = 64;
    const Gathered gathered = gather(*mesh_, materials_, options, silent_);
    for (const float b : gathered.radiosity) {
      if (!std::isfinite(b) || b < 0) return fault("radiosity gather", "B = {}", b);
    }
    checkClosed("gather", gathered.summary.closed);
  }

  /// A room turned inside out sees nothing of itself, and somebody says so.
  void checkInsideOut(const FormFactors& truth) {
    const std::vector<Note>& notes = truth.report.notes;
    const bool noted = isNoted("outward", notes) || isNoted("flip", notes);
    if (pairsOf(*truth.matrix).nonZeros() == 0 && !noted) {
      fault("inside out", "nothing sees anything, and no note says why");
    }
  }

  const Model& model_;
  const std::string& path_;
  Findings& findings_;
  Progress silent_;
  Scene scene_;
  MeshResult result_;
  const PatchMesh* mesh_ = nullptr;
  PatchMaterials materials_;
  std::optional<bool> closed_;  ///< as the first method has it
};

}  // namespace

Findings check(const Model& model, const std::string& path) {
  Findings findings;
  try {
    Checker(model, path, findings).run();
  } catch (const InputError& error) {
    // A surface that is lost whole is refused with the cure. Nothing else here is bad input.
    findings.refused = 1;
    if (std::string(error.what()).find("weld") == std::string::npos) {
      findings.faults.push_back({"refused", error.what()});
    }
  } catch (const std::exception& error) {
    findings.faults.push_back({"failed", error.what()});
  }
  return findings;
}

}  // namespace radiosity::property
