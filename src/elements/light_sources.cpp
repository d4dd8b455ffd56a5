#include "elements/light_sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <string>

#include "base/parallel.h"
#include "base/processor_clock.h"

namespace radiosity {
namespace {

// Lengths are shares of the scene's diagonal.

/// The edge to which the tolerance applies.
constexpr double kReferenceEdge = 0.05;
/// The longest edge of elements that may be shaded.
constexpr double kPartialEdge = 0.0125;
/// Direct light that only serves as a source is not refined below this. Patches with shorter edges
/// that are not shown are sources with the light of the solution.
constexpr double kSourceEdge = 0.005;
/// The longest edge of elements; longer roots are cut.
constexpr double kLongestEdge = 0.04;
/// Indirect light: no element with shorter edges is cut.
constexpr double kIndirectEdge = 0.015;
/// Indirect light: the least tolerance over the noise of the rays, so that noise is not refined.
constexpr double kOverNoise = 3;
/// An element is tested if its corners differ by this many tolerances.
constexpr double kTestedSpread = 2;
/// If corners differ by more than this share, edges may be shorter by the factor below.
constexpr double kSteepSpread = 0.15;
constexpr double kSteepFraction = 0.125;
/// The least light to which errors are compared, as a share of the mean.
constexpr double kLeastLight = 0.1;
/// To divide most_rays, the last pass is assumed to have this many vertices for each corner of a
/// root.
constexpr double kTestedShare = 3;
/// A point where few rays bring most of the light takes this many times the rays of other points:
/// its spread is kUneven times the tolerance. In rooms the spread is .02 to .05 with 512 rays, and
/// scrambled points have a third of that error; behind a door it is .1 and more.
constexpr int kMoreRays = 8;
constexpr double kUneven = 7;
/// So does a point for which two halves of its rays say that the mean is off by this many
/// tolerances: around a small bright patch, such as the ceiling above a lamp.
constexpr double kApart = 2;
/// Sources of indirect light: passes end when one moves less of the reflected power of indirect
/// light than this share, or after so many.
constexpr double kSettled = 0.0003;
constexpr int kMostPasses = 24;
/// Rays of a cell of the sources over those of a vertex; and the most of all cells: where they end
/// is kept, in 64 MiB, or 16 rays a cell if that is more.
constexpr double kRaysOfCell = 1.0 / 16;
constexpr double kMostKept = 1u << 24;

double brightness(std::span<const double> values, std::size_t patch, std::size_t bands) {
  double sum = 0;
  for (std::size_t b = 0; b < bands; ++b) sum += values[patch * bands + b];
  return sum;
}

double longestEdge(const PatchMesh& mesh, std::size_t patch) {
  const auto outline = mesh.outline(patch);
  double longest = 0;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    longest = std::max(longest, glm::distance(mesh.vertices[outline[k]],
                                              mesh.vertices[outline[(k + 1) % outline.size()]]));
  }
  return longest;
}

}  // namespace

void requireSizes(const PatchMesh& mesh, const PatchMaterials& materials,
                  std::span<const double> irradiance, std::span<const std::uint8_t> wanted) {
  materials.requireSizes(mesh.size());
  const std::size_t needed = mesh.size() * std::size_t(materials.bands);
  if (irradiance.size() != needed) {
    throw InputError(fmt::format("elements: {} values of irradiance are needed, {} were given",
                                 needed, irradiance.size()));
  }
  if (!wanted.empty() && wanted.size() != mesh.size()) {
    throw InputError(fmt::format("elements: {} flags of wanted patches are needed, {} were given",
                                 mesh.size(), wanted.size()));
  }
}

LightSources::LightSources(const PatchMesh& mesh, const PatchMaterials& materials,
                           std::span<const double> irradiance, const ElementOptions& options,
                           std::span<const std::uint8_t> wanted, bool keep_lights,
                           Progress& progress)
    : mesh_(mesh),
      materials_(materials),
      irradiance_(irradiance),
      options_(options),
      progress_(progress),
      bands_(std::size_t(materials.bands)),
      surface_(mesh, options.crease, kDirectInset, kIndirectInset),
      indirect_surface_(mesh, options.crease, kIndirectInset),
      lookup_(mesh, surface_.roots),
      rays_(mesh),
      elements_(mesh) {
  double sum = 0;
  double area = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    light_of_patch_.push_back(brightness(irradiance, i, bands_));
    sum += mesh.area[i] * light_of_patch_.back();
    area += mesh.area[i];
  }
  mean_light_ = area > 0 ? sum / area : 0;
  findUses(wanted);
  report_.roots = surface_.roots.size();
  const double edge = 0.5 * options_.smallest_edge * surface_.diagonal;
  report_.uniform_vertices = edge > 0 ? area / (edge * edge) : 0;
  const Stopwatch direct;
  findDirect(keep_lights);
  report_.seconds_direct = direct.seconds();
  const Stopwatch indirect;
  findSources();
  report_.seconds_indirect = indirect.seconds();
}

void LightSources::findUses(std::span<const std::uint8_t> wanted) {
  if (wanted.empty()) return;
  use_.resize(surface_.roots.size());
  parallelFor(mesh_.size(), 1024, [&](std::size_t i) {
    RootUse use = RootUse::shown;
    if (wanted[i] == 0) {
      const bool small = longestEdge(mesh_, i) < kSourceEdge * surface_.diagonal;
      use = small ? RootUse::none : RootUse::source;
    }
    const auto& of_patch = surface_.roots.of_patch;
    std::fill(use_.begin() + std::ptrdiff_t(of_patch[i]),
              use_.begin() + std::ptrdiff_t(of_patch[i + 1]), use);
  });
  report_.as_solved = std::size_t(std::ranges::count(use_, RootUse::none));
}

RefinementRule LightSources::rule(double tolerance, double smallest) const {
  RefinementRule rule;
  rule.tolerance = tolerance;
  rule.smallest_edge = smallest * surface_.diagonal;
  rule.steep_spread = kSteepSpread;
  rule.steep_fraction = kSteepFraction;
  rule.partial_edge = kPartialEdge * surface_.diagonal;
  rule.longest_edge = kLongestEdge * surface_.diagonal;
  rule.reference_edge = kReferenceEdge * surface_.diagonal;
  rule.least_light = kLeastLight * mean_light_;
  rule.most_vertices = options_.most_vertices;
  rule.use = use_;
  rule.source_edge = kSourceEdge * surface_.diagonal;
  return rule;
}

void LightSources::take(const FieldSummary& field) {
  ElementReport& report = report_;
  report.unrefined += field.unrefined;
  report.edge = report.edge > 0 ? std::min(report.edge, field.shortest_edge) : field.shortest_edge;
  if (!(field.light_square > 0)) return;
  report.interpolation_error = std::hypot(
      report.interpolation_error, std::sqrt(field.interpolation_square / field.light_square));
  report.ray_error =
      std::hypot(report.ray_error, std::sqrt(field.noise_square / field.light_square));
}

void LightSources::findDirect(bool keep_lights) {
  emitters_ = findEmitters(mesh_, elements_, materials_);
  report_.emitters = emitters_.size();
  const bool too_many = emitters_.size() > kMostAimedEmitters;
  if (too_many) {
    report_.direct = DirectLight::hemispheres;
    emitters_.clear();
  }
  if (emitters_.empty() && aimedLights(materials_.lights).empty()) {
    direct_.field.elements.resize(surface_.roots.size());
    return;
  }
  const bool clip = emitters_.size() <= kMostClippedEmitters;
  if (clip && !emitters_.empty()) {
    occluders_ = std::make_unique<OccluderSet>(mesh_, elements_, progress_);
  }
  emitter_light_ = std::make_unique<EmitterLight>(mesh_, materials_, surface_, elements_,
                                                  occluders_.get(), emitters_, rays_);
  RefinementRule how = rule(options_.tolerance, options_.smallest_edge);
  how.other_light = light_of_patch_;
  how.keep_lights = keep_lights;
  direct_ =
      buildField(mesh_, surface_, *emitter_light_, how, int(bands_), "direct light", progress_);
  take(direct_);
  report_.direct_vertices = direct_.evaluated;
  report_.direct_by_rays = emitter_light_->byRays();
  if (too_many) return;
  report_.direct = !clip                          ? DirectLight::rays
                   : emitter_light_->byRays() > 0 ? DirectLight::partly
                                                  : DirectLight::exact;
}

/// The rays a vertex that most_rays allows for this number of vertices.
int LightSources::raysFor(double vertices, int wanted) const {
  const double most = options_.most_rays / std::max(1.0, vertices);
  constexpr double kFewest = 16;
  return std::min(wanted, int(std::bit_floor(unsigned(std::clamp(most, kFewest, 4096.0)))));
}

void LightSources::findSources() {
  const std::vector<double> direct =
      patchMeans(mesh_, surface_.roots, lookup_, direct_.field, bands_);
  // The light of patches without direct light. We subtract the mean of the direct field, which may
  // be more accurate than the matrix.
  indirect_.assign(irradiance_.begin(), irradiance_.end());
  for (std::size_t k = 0; k < indirect_.size(); ++k) {
    indirect_[k] = std::max(0.0, indirect_[k] - direct[k]);
  }
  for (std::size_t i = 0; i < mesh_.size(); ++i) {
    direct_of_patch_.push_back(brightness(direct, i, bands_));
  }
  const SourceScene scene{.mesh = mesh_,
                          .materials = materials_,
                          .surface = surface_,
                          .lookup = lookup_,
                          .rays = rays_,
                          .direct = direct_.field,
                          .irradiance = irradiance_,
                          .solved = indirect_,
                          .use = use_,
                          .emission = report_.direct == DirectLight::hemispheres};
  IndirectSources indirect(scene, kRaysOfCell * options_.rays,
                           std::min(kMostKept, 0.5 * options_.most_rays), options_.seed);
  indirect.trace(progress_);
  report_.rays += double(indirect.rays());
  report_.indirect_vertices += indirect.places();
  const double little = kSettled * indirect.reflectedPower();
  for (int k = 1; k <= kMostPasses && (k <= 2 || indirect.moved() > little); ++k) {
    progress_.check();
    indirect.pass();
  }
  indirect.extrapolate();
  sources_ = std::make_unique<SourceCells>(indirect.takeCells());
}

ElementField LightSources::indirectField() {
  const Stopwatch watch;
  const double corners = kTestedShare * shownCorners();
  const int rays = raysFor(corners, options_.rays);
  // With Owen-scrambled points 1,024 rays have an error of about 1%.
  const double noise = 0.01 * std::pow(1024.0 / rays, 0.75);
  const double tolerance = std::max(options_.tolerance, kOverNoise * noise);
  const HemisphereSet set(std::size_t(rays), options_.seed);
  // So many that all points could take them within a fourth of most_rays.
  const int more_rays = raysFor(4 * corners, std::min(kMoreRays * rays, 4096));
  std::optional<HemisphereSet> more;
  ReflectedLight light(indirect_surface_, rays_, set, *sources_, materials_.lights, options_.seed);
  if (more_rays > rays) {
    light.repeat(more.emplace(std::size_t(more_rays), options_.seed), kUneven * options_.tolerance,
                 kApart * options_.tolerance);
  }
  RefinementRule how = rule(tolerance, kIndirectEdge);
  how.least_spread = kTestedSpread * tolerance;
  how.shown_alone = true;
  how.other_light = direct_of_patch_;
  how.patch_light = indirect_;
  FieldSummary field =
      buildField(mesh_, indirect_surface_, light, how, int(bands_), "indirect light", progress_);
  take(field);
  report_.rays += double(field.evaluated) * rays + double(light.repeated()) * more_rays;
  report_.rays_a_vertex = rays;
  report_.indirect_vertices += field.evaluated;
  report_.seconds_indirect += watch.seconds();
  return std::move(field.field);
}

/// Vertices at corners of roots that are shown.
double LightSources::shownCorners() const {
  if (use_.empty()) return double(surface_.points.size());
  std::vector<std::uint8_t> counted(surface_.points.size(), 0);
  for (std::size_t r = 0; r < use_.size(); ++r) {
    if (use_[r] != RootUse::shown) continue;
    for (const Index v : surface_.vertex[r]) {
      if (v != kNone) counted[v] = 1;
    }
  }
  return double(std::count(counted.begin(), counted.end(), 1));
}

}  // namespace radiosity
