#include "elements/indirect_sources.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "radiosity/light.h"

namespace radiosity {
namespace {

/// The series of changes is not summed if each is more than this share of the one before.
constexpr double kMostLeft = 0.9;
constexpr std::size_t kHalves = 2;  ///< of the rays of a place
/// A ray that ends on a patch without roots.
constexpr std::uint32_t kDark = kNone - 4;

/// Place k of a sequence that fills the unit square evenly (M. Roberts, "The unreasonable
/// effectiveness of quasirandom sequences", 2018).
Vec2 evenPlace(std::size_t k) {
  constexpr Vec2 kStep{0.7548776662466927, 0.5698402909980532};
  const Vec2 at = Vec2(0.5) + double(k) * kStep;
  return at - Vec2(std::floor(at.x), std::floor(at.y));
}

Vec3 pointAt(const PatchMesh& mesh, const ElementRoots& roots, std::size_t root, Vec2 at) {
  const auto& c = roots.corner[root];
  const bool quad = roots.cornerCount(root) == 4;
  const Vec3 a = mesh.vertices[c[0]];
  const Vec3 ab = mesh.vertices[c[1]] - a;
  const Vec3 ad = mesh.vertices[c[quad ? 3 : 2]] - a;
  const Vec3 fold = quad ? mesh.vertices[c[2]] - a - ab - ad : Vec3(0.0);
  return a + at.x * ab + at.y * ad + at.x * at.y * fold;
}

double areaOfRoot(const PatchMesh& mesh, const ElementRoots& roots, std::size_t root) {
  const Vec3 a = pointAt(mesh, roots, root, {0, 0});
  const Vec3 b = pointAt(mesh, roots, root, {1, 0});
  const Vec3 d = pointAt(mesh, roots, root, {0, 1});
  const double area = 0.5 * glm::length(glm::cross(b - a, d - a));
  if (roots.cornerCount(root) == 3) return area;
  const Vec3 c = pointAt(mesh, roots, root, {1, 1});
  return area + 0.5 * glm::length(glm::cross(b - c, d - c));
}

}  // namespace

/// In a triangle, points beyond its longest side are mirrored into it.
std::vector<double> patchMeans(const PatchMesh& mesh, const ElementRoots& roots,
                               const ElementLookup& lookup, const ElementField& field,
                               std::size_t bands) {
  std::vector<double> means(mesh.size() * bands, 0.0);
  constexpr int kSide = 8;
  parallelFor(mesh.size(), 64, [&](std::size_t i) {
    double whole = 0;
    std::vector<double> sum(bands, 0.0);
    for (std::size_t r = roots.of_patch[i]; r < roots.of_patch[i + 1]; ++r) {
      const bool quad = roots.cornerCount(r) == 4;
      const auto& c = roots.corner[r];
      const Vec3 a = mesh.vertices[c[0]];
      const Vec3 ab = mesh.vertices[c[1]] - a;
      const Vec3 ad = mesh.vertices[c[quad ? 3 : 2]] - a;
      const Vec3 fold = quad ? mesh.vertices[c[2]] - a - ab - ad : Vec3(0.0);
      std::vector<double> light(bands);
      for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
          Vec2 at{(x + 0.5) / kSide, (y + 0.5) / kSide};
          const double weight = glm::length(glm::cross(ab + at.y * fold, ad + at.x * fold));
          if (!quad && at.x + at.y > 1) at = Vec2(1.0) - at;
          std::fill(light.begin(), light.end(), 0.0);
          lookup.add(field, r, at, light);
          whole += weight * (quad ? 1 : 0.5);
          for (std::size_t b = 0; b < bands; ++b) {
            sum[b] += weight * (quad ? 1 : 0.5) * light[b];
          }
        }
      }
    }
    for (std::size_t b = 0; b < bands && whole > 0; ++b) means[i * bands + b] = sum[b] / whole;
  });
  return means;
}

/// Sums over places of a cell.
struct IndirectSources::Light {
  explicit Light(std::size_t bands) : far(bands), all(bands), indirect(bands) {}
  std::vector<double> far;       ///< irradiance times openness
  std::vector<double> all;       ///< irradiance
  std::vector<double> indirect;  ///< of it, without direct light
  double open = 0;               ///< openness: the share of rays that go far
  std::size_t places = 0;        ///< without those behind a surface
};

IndirectSources::IndirectSources(const SourceScene& scene, double rays, double most_rays,
                                 std::uint64_t seed)
    : scene_(scene),
      bands_(std::size_t(scene.materials.bands)),
      set_(kRaysOfPlace, seed),
      seed_(seed),
      background_(scene.materials.lights, scene.materials.bands),
      sources_(scene.surface, scene.lookup, scene.materials.bands) {
  for (Index r = 0; r < scene.surface.roots.size(); ++r) {
    if (!isEvaluated(r)) continue;
    const bool quad = scene.surface.roots.cornerCount(r) == 4;
    const int n = sources_.side(r);
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < (quad ? n : n - y); ++x) {
        cells_.push_back({r, std::uint16_t(x), std::uint16_t(y)});
      }
    }
  }
  for (const Cell& cell : cells_) area_.push_back(areaOf(cell));
  const double of_cell =
      std::min(rays, most_rays / double(std::max<std::size_t>(1, cells_.size())));
  places_ = std::max<std::size_t>(1, std::size_t(of_cell) / kRaysOfPlace);
  direct_.resize(places() * bands_);
  ends_.resize(places() * kRaysOfPlace);
  if (!background_.empty()) sky_.resize(places() * kHalves * bands_);
  indirect_.resize(cells_.size() * bands_);
}

double IndirectSources::areaOf(const Cell& cell) const {
  const ElementRoots& roots = scene_.surface.roots;
  const double area = areaOfRoot(scene_.mesh, roots, cell.root);
  const int n = sources_.side(cell.root);
  if (roots.cornerCount(cell.root) == 4) return area / (n * n);
  return (cell.x + cell.y == n - 1 ? 1 : 2) * area / (n * n);
}

/// Neighbouring cells go on with one sequence: all of them at the same places would miss the mean
/// of light that falls from one side to the other.
Vec2 IndirectSources::placeOf(const Cell& cell, std::size_t k) const {
  Vec2 in_cell = evenPlace(slotOf(cell) * places_ + k);
  const int n = sources_.side(cell.root);
  const bool halved = scene_.surface.roots.cornerCount(cell.root) == 3 && cell.x + cell.y == n - 1;
  if (halved && in_cell.x + in_cell.y > 1) in_cell = Vec2(1.0) - in_cell;
  return (Vec2(cell.x, cell.y) + in_cell) / double(n);
}

void IndirectSources::trace(Progress& progress) {
  progress.begin("sources of indirect light", cells_.size(), "cells");
  parallelFor(cells_.size(), 16, [&](std::size_t e) {
    if (progress.cancelled()) return;
    progress.advance();
    traceCell(e);
  });
  progress.check();
  progress.end();
  findCorrections();
  begin();
}

void IndirectSources::traceCell(std::size_t e) {
  const Cell& cell = cells_[e];
  const ElementRoots& roots = scene_.surface.roots;
  const Index patch = roots.patch[cell.root];
  const std::span<const Index> own = scene_.surface.owners[scene_.mesh.polygon[patch]];
  std::array<RayEnd, kRaysOfPlace> ends;
  std::vector<double> direct(bands_);
  std::vector<double> sky;  // of each half
  for (std::size_t p = 0; p < places_; ++p) {
    const Vec2 at = placeOf(cell, p);
    const Vec3 point = pointAt(scene_.mesh, roots, cell.root, at);
    std::fill(direct.begin(), direct.end(), 0.0);
    scene_.lookup.add(scene_.direct, cell.root, at, direct);
    const std::size_t place = e * places_ + p;
    std::ranges::copy(direct, direct_.begin() + std::ptrdiff_t(place * bands_));
    const HemisphereSet::Turn turn = set_.turnAt(point + scene_.mesh.normal[patch], seed_);
    scene_.rays.look({point, scene_.mesh.normal[patch], own}, set_, turn.set, turn.angle, ends);
    std::array<std::size_t, kHalves> next{place * kRaysOfPlace,
                                          place * kRaysOfPlace + kRaysOfPlace / 2};
    sky.assign(kHalves * bands_, 0.0);
    for (std::size_t k = 0; k < kRaysOfPlace; ++k) {
      const std::size_t half = set_.isFirst(turn.set, k) ? 0 : 1;
      std::uint32_t end = ends[k].patch;
      if (end == RayEnd::kSky) {
        background_.add(ends[k].at, std::numbers::pi,
                        std::span(sky).subspan(half * bands_, bands_));
      }
      if (end < RayEnd::kOwn) end = sources_.sourceAt(end, ends[k].at, point).value_or(kDark);
      ends_[next[half]++] = end;
    }
    if (!sky_.empty()) {
      std::ranges::copy(sky, sky_.begin() + std::ptrdiff_t(place * kHalves * bands_));
    }
  }
}

void IndirectSources::findCorrections() {
  const std::vector<Index>& patch_of = scene_.surface.roots.patch;
  std::vector<float>& values = sources_.values();
  for (std::size_t r = 0; r < patch_of.size(); ++r) {
    for (std::size_t at = 2 * sources_.first(r) * bands_; at < 2 * sources_.first(r + 1) * bands_;
         ++at) {
      const std::size_t k = patch_of[r] * bands_ + at % bands_;
      values[at] = float(scene_.materials.reflectance[k] * scene_.irradiance[k] + emitted(k));
    }
  }
  std::vector<float> found = values;
  parallelFor(cells_.size(), 64, [&](std::size_t e) {
    double gained = 0;
    lightCell(e, found, gained);
  });
  std::vector<double> area(scene_.mesh.size(), 0.0);
  std::vector<double> correction(scene_.mesh.size() * bands_, 0.0);
  for (std::size_t e = 0; e < cells_.size(); ++e) {
    const std::size_t patch = patch_of[cells_[e].root];
    area[patch] += area_[e];
    for (std::size_t b = 0; b < bands_; ++b) {
      correction[patch * bands_ + b] += area_[e] * indirect_[e * bands_ + b];
    }
  }
  for (std::size_t k = 0; k < correction.size(); ++k) {
    const double whole = area[k / bands_];
    correction[k] = whole > 0 ? scene_.solved[k] - correction[k] / whole : 0.0;
  }
  correction_ = std::move(correction);
}

/// Gives all cells the light of the solution.
void IndirectSources::begin() {
  std::vector<float>& values = sources_.values();
  for (std::size_t e = 0; e < cells_.size(); ++e) {
    const std::size_t patch = scene_.surface.roots.patch[cells_[e].root];
    for (std::size_t b = 0; b < bands_; ++b) {
      double direct = 0;
      for (std::size_t p = 0; p < places_; ++p) direct += direct_[(e * places_ + p) * bands_ + b];
      const std::size_t k = patch * bands_ + b;
      const double rho = scene_.materials.reflectance[k];
      indirect_[e * bands_ + b] = scene_.solved[k];
      solved_power_ += area_[e] * rho * scene_.solved[k];
      const double light = rho * (direct / double(places_) + scene_.solved[k]) + emitted(k);
      const std::size_t at = 2 * slotOf(cells_[e]) * bands_ + b;
      values[at] = values[at + bands_] = float(light);
    }
  }
  power_ = solved_power_;
  keepOthers(values);
}

/// Roots that are not evaluated have the light of the solution, times what the others have over
/// theirs.
void IndirectSources::keepOthers(std::vector<float>& values) const {
  const double ratio = solved_power_ > 0 ? power_ / solved_power_ : 1;
  for (std::size_t r = 0; r < scene_.surface.roots.size(); ++r) {
    if (isEvaluated(r)) continue;
    const std::size_t patch = scene_.surface.roots.patch[r];
    for (std::size_t at = 2 * sources_.first(r) * bands_; at < 2 * sources_.first(r + 1) * bands_;
         ++at) {
      const std::size_t k = patch * bands_ + at % bands_;
      values[at] = float(ratio * scene_.materials.reflectance[k] * scene_.solved[k] + emitted(k));
    }
  }
}

/// Adds a place's light. Openness and light are of the same rays, whose noise they share: so that
/// of either half of the rays is multiplied with that of the other.
void IndirectSources::addPlace(std::size_t e, std::size_t p, Light& light) const {
  const std::size_t place = e * places_ + p;
  thread_local std::vector<double> sum;  // of each half
  sum.assign(kHalves * bands_, 0.0);
  for (std::size_t k = 0; k < sum.size() && !sky_.empty(); ++k) {
    sum[k] = sky_[place * kHalves * bands_ + k];
  }
  std::array<double, kHalves> counted{};
  std::array<double, kHalves> far{};
  std::size_t behind = 0;
  for (std::size_t k = 0; k < kRaysOfPlace; ++k) {
    const std::uint32_t end = ends_[place * kRaysOfPlace + k];
    if (end == RayEnd::kOwn) continue;
    const std::size_t half = k < kRaysOfPlace / 2 ? 0 : 1;
    ++counted[half];
    if (end == RayEnd::kBlack) {
      ++behind;
    } else if (end == RayEnd::kSky) {
      ++far[half];
    } else if (end != kDark) {
      far[half] += SourceCells::isFar(end) ? 1 : 0;
      sources_.add(end, std::span(sum).subspan(half * bands_, bands_));
    }
  }
  if (counted[0] == 0 || counted[1] == 0 || 2 * behind > kRaysOfPlace) return;
  const double open = (far[0] + far[1]) / (counted[0] + counted[1]);
  ++light.places;
  light.open += open;
  for (std::size_t b = 0; b < bands_; ++b) {
    const double first = sum[b];
    const double second = sum[bands_ + b];
    const double indirect = (first + second) / (counted[0] + counted[1]);
    const double direct = direct_[place * bands_ + b];
    light.indirect[b] += indirect;
    light.all[b] += indirect + direct;
    light.far[b] +=
        open * direct + 0.5 * (first * far[1] + second * far[0]) / (counted[0] * counted[1]);
  }
}

/// Computes the light of a cell into `values`. Returns by how much its reflected power changes, W;
/// adds that with its sign to `gained`.
double IndirectSources::lightCell(std::size_t e, std::vector<float>& values, double& gained) {
  thread_local std::optional<Light> kept;
  Light& light = kept.emplace(bands_);
  for (std::size_t p = 0; p < places_; ++p) addPlace(e, p, light);
  if (light.places == 0) return 0;  // within a body: it keeps the light of its patch
  const std::size_t patch = scene_.surface.roots.patch[cells_[e].root];
  const auto places = double(light.places);
  double moved = 0;
  for (std::size_t b = 0; b < bands_; ++b) {
    const std::size_t k = patch * bands_ + b;
    const double rho = scene_.materials.reflectance[k];
    const double more = correction_.empty() ? 0.0 : correction_[k];
    const double mean = light.all[b] / places;
    const double far = light.open > 0 ? light.far[b] / light.open : mean;
    const double near =
        light.open < places ? (light.all[b] - light.far[b]) / (places - light.open) : mean;
    const std::size_t at = 2 * slotOf(cells_[e]) * bands_ + b;
    values[at] = float(rho * std::max(0.0, far + more) + emitted(k));
    values[at + bands_] = float(rho * std::max(0.0, near + more) + emitted(k));
    const double indirect = light.indirect[b] / places + more;
    const double change = area_[e] * rho * (indirect - indirect_[e * bands_ + b]);
    indirect_[e * bands_ + b] = indirect;
    gained += change;
    moved += std::abs(change);
  }
  return moved;
}

void IndirectSources::pass() {
  std::vector<float> values = sources_.values();
  std::vector<std::array<double, 2>> changes(cells_.size());
  parallelFor(cells_.size(), 64, [&](std::size_t e) {
    double gained = 0;
    const double moved = lightCell(e, values, gained);
    changes[e] = {moved, gained};
  });
  gained_before_ = gained_;
  moved_ = gained_ = 0;
  for (const auto& [moved, gained] : changes) {
    moved_ += moved;
    gained_ += gained;
  }
  power_ += gained_;
  keepOthers(values);
  before_ = std::exchange(sources_.values(), std::move(values));
}

void IndirectSources::extrapolate() {
  const double left = gained_before_ != 0 ? gained_ / gained_before_ : 0;
  if (!(left > 0 && left < kMostLeft)) return;
  std::vector<float>& values = sources_.values();
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double more = left / (1 - left) * (double(values[k]) - double(before_[k]));
    values[k] = float(std::max(0.0, values[k] + more));
  }
}

}  // namespace radiosity
