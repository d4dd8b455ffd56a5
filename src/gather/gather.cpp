#include "radiosity/gather.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/made.h"
#include "base/option_list.h"
#include "base/parallel.h"
#include "base/processor_clock.h"
#include "base/steady_mean.h"
#include "formfactor/row_accounts.h"
#include "gather/gpu_gatherer.h"
#include "gather/passes.h"
#include "mesh/patches/enclosures.h"
#include "radiosity/spelling.h"

namespace radiosity {
namespace {

// Radiosities are 32-bit floats, and H may exceed E by far in a white room.
constexpr double kLargest = 1e30;

void checkMaterials(const PatchMesh& mesh, const PatchMaterials& materials) {
  materials.requireSizes(mesh.size());
  for (const Light& light : materials.lights) {
    for (const double value : light.strength) {
      if (value >= 0 && value <= kLargest) continue;
      throw InputError(fmt::format("gather: {} {} {} is not within 0 and {:g}", light.name,
                                   light.traits().strength, value, kLargest));
    }
  }
  for (std::size_t k = 0; k < materials.reflectance.size(); ++k) {
    const double rho = materials.reflectance[k];
    const double emission = materials.emission[k];
    const bool reflects = rho >= 0 && rho <= 1;
    if (reflects && emission >= 0 && emission <= kLargest) continue;
    const std::size_t i = k / std::size_t(materials.bands);
    const std::string where =
        fmt::format("gather: patch {} of surface \"{}\"", i, mesh.surface_names[mesh.surface[i]]);
    if (!reflects) {
      throw InputError(fmt::format("{}: reflectance {} is not within 0 and 1", where, rho));
    }
    throw InputError(
        fmt::format("{}: emission {} is not within 0 and {:g}", where, emission, kLargest));
  }
}

/// The passes of one run.
class Passes {
 public:
  Passes(const GatherScene& scene, std::unique_ptr<GpuEye> eye, Gathered& result)
      : scene_(scene),
        bands_(scene.bands),
        result_(result),
        fronts_(scene.size(), 0.0F),
        seen_backs_(scene.size()),
        workers_([&] { return Gatherer(scene_, result_.radiosity); }) {
    if (eye != nullptr) gpu_.emplace(scene, std::move(eye));
    result_.radiosity = scene.source;
    result_.irradiance.assign(bands_ * scene.size(), 0.0F);
    result_.backs.assign(scene.size(), 0.0F);
    result_.sky.assign(scene.size(), 0.0F);
    next_ = scene.source;
  }

  GatherPass run(int number, Progress& progress) {
    const Stopwatch watch;
    progress.begin(fmt::format("gathering, pass {}", number), scene_.size());
    std::vector<std::uint8_t> gathered(scene_.size(), 0);
    if (gpu_) gatherByGpu(number == 1, gathered, progress);
    parallelFor(scene_.size(), 1, [&](std::size_t k) {
      if (progress.cancelled() || gathered[k] != 0) return;
      if (scene_.eyes[k].looks) gatherAt(k, number == 1);
      progress.advance();
    });
    progress.check();
    progress.end();
    if (number == 1) {
      accountForBacks();
      noteNothingSeen();
    }
    GatherPass pass;
    measure(pass);
    account(pass);
    std::swap(result_.radiosity, next_);
    pass.seconds = watch.seconds();
    return pass;
  }

  /// The error bound of the last pass over the largest emission, worst band; infinite if there is
  /// no bound.
  double relativeBound() const { return relative_bound_; }

  HemicubeReport counts() const {
    HemicubeReport counts = gpu_counts_;
    if (gpu_) counts += gpu_->counts();
    for (const Gatherer& worker : workers_) counts += worker.counts();
    return counts;
  }
  std::size_t bytes() const {
    std::size_t sum = scene_.bytes() + scene_.size() * (4 * bands_ + 3) * sizeof(float);
    for (const Gatherer& worker : workers_) sum += worker.bytes();
    if (gpu_) sum += gpu_->bytes();
    return sum;
  }

 private:
  void noteOn(Severity severity, std::string text) {
    result_.summary.notes.push_back({severity, std::move(text)});
  }

  void gatherAt(std::size_t k, bool first) {
    Gatherer& worker = workers_.local();
    const Gatherer::Received received = worker.look(k);
    if (first && received.backs > 0) seeBacks(k, worker.backsBySurface());
    receive(k, received);
  }

  /// Gathers by the GPU and marks the eyes done in `gathered`. If the device gives up, the CPU's
  /// eye does the others.
  void gatherByGpu(bool first, std::vector<std::uint8_t>& gathered, Progress& progress) {
    GpuGatherer& gpu = made(gpu_);
    const std::string problem = gpu.pass(
        [&](std::size_t k, const GpuGatherer::Seen& seen) {
          if (first && seen.received.backs > 0) seeBacks(k, seen.backs);
          receive(k, seen.received);
          gathered[k] = 1;
        },
        progress);
    const bool drew = gpu.counts().hemicubes > 0;
    if (first && drew) noteOn(Severity::info, "hemicubes drawn by " + gpu.device().name);
    if (problem.empty()) return;
    noteOn(Severity::warning, fmt::format("{}: {}; {} hemicubes were drawn by the processor",
                                          gpu.device().name, problem, drew ? "the other" : "all"));
    gpu_counts_ = gpu.counts();
    gpu_.reset();
  }

  void seeBacks(std::size_t k, std::span<const double> backs) {
    for (std::size_t s = 0; s < backs.size(); ++s) {
      if (backs[s] > 0) seen_backs_[k].push_back({Index(s), backs[s]});
    }
  }

  void receive(std::size_t k, const Gatherer::Received& received) {
    fronts_[k] = float(received.fronts);
    result_.backs[k] = float(received.backs);
    result_.sky[k] = float(received.sky);
    for (std::size_t b = 0; b < bands_; ++b) {
      const std::size_t at = bands_ * k + b;
      const double irradiance = received.irradiance[b] + byLights(k, b);
      result_.irradiance[at] = float(irradiance);
      next_[at] = float(double(scene_.materials.emission[at]) +
                        double(scene_.materials.reflectance[at]) * irradiance);
    }
  }

  /// Irradiance by lights without a surface. The eye must have looked.
  double byLights(std::size_t k, std::size_t b) const {
    return scene_.byLights(k, b, result_.sky[k]);
  }

  /// Averages the shares of backs over all eyes. All passes see the same backs.
  void accountForBacks() {
    std::vector<double>& share = result_.backs_by_surface;
    double area = 0;
    for (std::size_t k = 0; k < scene_.size(); ++k) {
      if (scene_.eyes[k].looks) area += scene_.area[k];
      for (const SeenBack& seen : seen_backs_[k]) {
        share[seen.surface] += scene_.area[k] * seen.share;
      }
    }
    for (double& value : share) value = area > 0 ? value / area : 0;
    seen_backs_ = {};
  }

  void noteNothingSeen() {
    if (std::ranges::any_of(fronts_, [](float seen) { return seen > 0; })) return;
    if (std::optional<Note> note = nothingSeenNote(scene_.mesh)) {
      noteOn(note->severity, std::move(note->text));
    }
  }

  /// B* = E + R F B* and B_k = E + R F B_(k-1) + rounding give
  ///     |B* - B_k| <= q |B* - B_(k-1)| + u |B_k| <= q (|B* - B_k| + change) + u |B_k|
  /// in the maximum norm with q = max rho_i fronts_i: the weights of an eye sum to its fronts, and
  /// interpolation weights are positive and sum to 1.
  void measure(GatherPass& pass) {
    constexpr double kRounding = std::numeric_limits<float>::epsilon();
    double bound = 0;
    relative_bound_ = 0;
    for (std::size_t b = 0; b < bands_; ++b) {
      const double emission = scene_.largest_source[b];
      if (emission == 0) continue;
      double change = 0;
      double largest = 0;
      double q = 0;
      for (std::size_t k = b; k < next_.size(); k += bands_) {
        change = std::max(change, std::abs(double(next_[k]) - double(result_.radiosity[k])));
        largest = std::max(largest, double(next_[k]));
        q = std::max(q, double(scene_.materials.reflectance[k]) * fronts_[k / bands_]);
      }
      pass.change = std::max(pass.change, change / emission);
      // fronts are floats: rounding must not give a closed room with rho = 1 a bound.
      const bool bounded = q < 1 - 2 * kRounding;
      const double in_band = bounded ? (q * change + kRounding * largest) / (1 - q) : HUGE_VAL;
      bound = std::max(bound, in_band);
      relative_bound_ = std::max(relative_bound_, in_band / emission);
    }
    if (std::isfinite(bound)) pass.bound = bound;
  }

  void account(GatherPass& pass) const {
    const std::vector<double> zeros(bands_, 0.0);
    pass.energy = {zeros, zeros, zeros, zeros, zeros, zeros};
    pass.in_flight = zeros;
    EnergyAccount& energy = pass.energy;
    for (std::size_t k = 0; k < next_.size(); ++k) {
      const std::size_t eye = k / bands_;
      const std::size_t b = k % bands_;
      const double area = scene_.area[eye];
      const double before = result_.radiosity[k];
      energy.emitted[b] += area * scene_.materials.emission[k];
      energy.from_sky[b] += area * byLights(eye, b);
      energy.absorbed[b] +=
          area * (1 - double(scene_.materials.reflectance[k])) * result_.irradiance[k];
      energy.to_sky[b] += area * result_.sky[eye] * before;
      energy.on_backs[b] += area * result_.backs[eye] * before;
      if (scene_.eyes[eye].looks) pass.in_flight[b] += area * (double(next_[k]) - before);
    }
    for (std::size_t b = 0; b < bands_; ++b) {
      energy.imbalance[b] = energy.emitted[b] + energy.from_sky[b] - energy.absorbed[b] -
                            energy.to_sky[b] - energy.on_backs[b] - pass.in_flight[b];
    }
  }

  const GatherScene& scene_;
  const std::size_t bands_;
  Gathered& result_;
  std::vector<float> next_;
  std::vector<float> fronts_;
  std::vector<std::vector<SeenBack>> seen_backs_;  ///< L, during the first pass
  double relative_bound_ = HUGE_VAL;
  std::optional<GpuGatherer> gpu_;
  HemicubeReport gpu_counts_;  ///< of a device that gave up
  tbb::enumerable_thread_specific<Gatherer> workers_;
};

/// The imbalance of the band where it is largest, as a share of the power that comes in.
double worstImbalance(const GatherPass& pass) {
  const EnergyAccount& energy = pass.energy;
  double worst = 0;
  for (std::size_t b = 0; b < energy.imbalance.size(); ++b) {
    const double whole = energy.emitted[b] + energy.from_sky[b];
    const double share = whole > 0 ? energy.imbalance[b] / whole : 0.0;
    if (std::abs(share) > std::abs(worst)) worst = share;
  }
  return worst;
}

std::string messageOf(const GatherSummary& summary, const GatherOptions& options) {
  if (summary.status == GatherStatus::no_light) {
    return "no light: nothing emits, so everything is dark; usable, but black";
  }
  const GatherPass& last = summary.passes.back();
  const std::size_t count = summary.passes.size();
  const std::string passes = fmt::format("{} {}", count, count == 1 ? "pass" : "passes");
  const std::string bound =
      last.bound ? fmt::format("what further passes would add is below {:.2e} W/m^2", *last.bound)
                 : "what further passes would add is not bounded: reflectance times what is seen "
                   "reaches 1";
  if (summary.status == GatherStatus::unbalanced) {
    return fmt::format(
        "energy does not balance: after {}, {:.3g}% of the light {}; not usable; patches are too "
        "large for points to stand for them: give more {}, or solve by the matrix "
        "(radiosity solve)",
        passes, 100 * std::abs(worstImbalance(last)),
        worstImbalance(last) > 0 ? "is missing" : "is too much", spelled("patches"));
  }
  if (summary.status == GatherStatus::converged) {
    return fmt::format("converged: {}, last change {:.2e} of the largest emission; {}", passes,
                       last.change, bound);
  }
  return fmt::format(
      "{} as limited, last change {:.2e} of the largest emission (bound asked "
      "for {:.2e}); {}",
      passes, last.change, options.tolerance, bound);
}

void runPasses(const GatherScene& scene, std::unique_ptr<GpuEye> eye, const GatherOptions& options,
               Gathered& result, Progress& progress) {
  GatherSummary& summary = result.summary;
  Passes passes(scene, std::move(eye), result);
  summary.status = GatherStatus::pass_limit;
  for (int k = 1; k <= options.passes; ++k) {
    summary.passes.push_back(passes.run(k, progress));
    if (passes.relativeBound() <= options.tolerance) {
      summary.status = GatherStatus::converged;
      break;
    }
  }
  if (std::abs(worstImbalance(summary.passes.back())) > kMostImbalance) {
    summary.status = GatherStatus::unbalanced;
  }
  const HemicubeReport counts = passes.counts();
  summary.hemicubes = counts.hemicubes / summary.passes.size();
  summary.pixels = counts.pixels / summary.passes.size();
  summary.bytes = passes.bytes();
}

}  // namespace

void GatherOptions::validate() const { requireRanges(*this); }

Gathered gather(const PatchMesh& mesh, const PatchMaterials& materials,
                const GatherOptions& options, Progress& progress) {
  const Stopwatch watch;
  options.validate();
  checkMaterials(mesh, materials);
  const GatherScene scene(mesh, materials, options, progress);
  std::unique_ptr<GpuEye> eye;
  if (scene.isLit()) {
    eye = openGpuEye(options.eye, scene.rows.scene(), mesh, scene.rows.weights());
  }
  Gathered result = gatherIn(scene, std::move(eye), options, progress);
  result.summary.seconds = watch.seconds();
  return result;
}

Gathered gatherIn(const GatherScene& scene, std::unique_ptr<GpuEye> eye,
                  const GatherOptions& options, Progress& progress) {
  Gathered result;
  result.backs_by_surface.assign(scene.mesh.surface_names.size(), 0.0);
  result.at = scene.at;
  result.bands = int(scene.bands);
  result.area = scene.area;
  result.eye_of_corner = scene.eye_of_corner;
  result.position.reserve(scene.size());
  for (const Eye& at : scene.eyes) result.position.push_back(at.position);
  GatherSummary& summary = result.summary;
  summary.simd_target = scene.rows.kernels().target;
  std::optional<Enclosures> found;
  summary.closed = enclosuresOf(scene.mesh, found).closed;
  if (scene.isLit()) {
    runPasses(scene, std::move(eye), options, result, progress);
  } else {
    summary.status = GatherStatus::no_light;
    for (auto* field : {&result.radiosity, &result.irradiance}) {
      field->assign(scene.bands * scene.size(), 0.0F);
    }
    for (auto* share : {&result.backs, &result.sky}) share->assign(scene.size(), 0.0F);
  }
  summary.message = messageOf(summary, options);
  return result;
}

std::vector<double> cornerRadiosity(const PatchMesh& mesh, const Gathered& gathered) {
  const auto bands = std::size_t(gathered.bands);
  std::vector<double> values(bands * mesh.corners.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (std::size_t c = mesh.corner_offset[i]; c < mesh.corner_offset[i + 1]; ++c) {
      const std::size_t eye = gathered.at == GatherAt::patches ? i : gathered.eye_of_corner[c];
      for (std::size_t b = 0; b < bands; ++b) {
        values[bands * c + b] = gathered.radiosity[bands * eye + b];
      }
    }
  }
  return values;
}

std::vector<double> patchRadiosity(const PatchMesh& mesh, const Gathered& gathered) {
  if (gathered.at == GatherAt::patches) {
    return {gathered.radiosity.begin(), gathered.radiosity.end()};
  }
  const auto bands = std::size_t(gathered.bands);
  const std::vector<double> weights = PatchBasis(mesh).areaWeights();
  const std::vector<double> corners = cornerRadiosity(mesh, gathered);
  std::vector<double> means(bands * mesh.size(), 0.0);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (!(mesh.area[i] > 0)) continue;
    for (std::size_t b = 0; b < bands; ++b) {
      SteadyMean mean;
      for (std::size_t c = mesh.corner_offset[i]; c < mesh.corner_offset[i + 1]; ++c) {
        mean.add(weights[c], corners[bands * c + b]);
      }
      means[bands * i + b] = mean.value();
    }
  }
  return means;
}

}  // namespace radiosity
