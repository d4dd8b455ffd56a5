#include "formfactor/rays/shadow_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "base/geometry/clip.h"
#include "base/parallel.h"
#include "base/processor_clock.h"
#include "formfactor/patch_seed.h"
#include "formfactor/wanted_rows.h"
#include "visibility/clipping/point_to_polygon.h"

namespace radiosity {
namespace {

/// Points of a patch for each emitter, in each of two halves: at first so many that all emitters
/// have kAllPoints or less, then as many as the tolerance takes.
constexpr std::array<std::size_t, 4> kShadowPoints{1, 8, 64, 512};
constexpr std::size_t kAllPoints = 512;
/// Of what a patch sees of all emitters, but no less than this share of what it would see without
/// anything in between.
constexpr double kShadowTolerance = 0.02;
constexpr double kLeastSeen = 0.1;
/// Beyond so many of its radii an emitter is a point: what a point of it brings is what all of it
/// brings, but for some percent, which average out.
constexpr double kNear = 5;
/// seconds() looks from so many patches.
constexpr std::size_t kShadowSample = 128;
/// For the backs that an emitter sees: points, and rays of each.
constexpr std::size_t kBackPoints = 64;
constexpr std::size_t kBackRays = 256;

/// Patches whose shares are held at once.
constexpr std::size_t kBlock = 4096;

constexpr std::uint64_t kSeedOfShadows = 0x736861646f77;

}  // namespace

/// Sums over the points of a half, over their number: what Lambert's formula gives, and, of the
/// rays, all and those that nothing stops.
struct ShadowRows::Found {
  double formula = 0;
  double whole = 0;
  double lit = 0;
};

ShadowRows::ShadowRows(const PatchMesh& mesh, std::vector<Index> wanted, std::uint64_t seed)
    : mesh_(mesh),
      wanted_(std::move(wanted)),
      seed_(seed ^ kSeedOfShadows),
      emitter_of_(mesh.size(), kNone),
      rays_(mesh) {
  for (Index i = 0; i < mesh.size(); ++i) {
    if (mesh.polygon[i] == kNone || !(mesh.area[i] > 0)) continue;
    if (!std::ranges::binary_search(wanted_, i)) continue;
    emitter_of_[i] = Index(emitters_.size());
    double radius = 0;
    for (const Index corner : mesh.outline(i)) {
      radius = std::max(radius, glm::distance(mesh.vertices[corner], mesh.centroid[i]));
    }
    emitters_.push_back({i, PatchArea(mesh, i), radius});
  }
}

std::size_t ShadowRows::firstLevel() const {
  std::size_t level = 2;
  while (level > 0 && emitters_.size() * kShadowPoints[level] > kAllPoints) --level;
  return level;
}

double ShadowRows::rays() const {
  const double of_pairs = 2.0 * double(kShadowPoints[firstLevel()]) * double(mesh_.size());
  return (of_pairs + double(kBackPoints * kBackRays)) * double(emitters_.size());
}

std::size_t ShadowRows::bytes() const {
  return kBlock * emitters_.size() * sizeof(Share) +
         WantedRows::bytes(wanted_.size(), mesh_.size());
}

double ShadowRows::seconds(Progress& progress) const {
  const std::size_t count = std::min(mesh_.size(), kShadowSample);
  if (count == 0) return 0;
  const Stopwatch watch;
  parallelFor(count, 1, [&](std::size_t k) {
    if (progress.cancelled()) return;
    std::vector<Share> shares(emitters_.size());
    receive(Index((2 * k + 1) * mesh_.size() / (2 * count)), shares);
  });
  progress.check();
  const double of_pairs = watch.seconds() * double(mesh_.size()) / double(count);
  if (emitters_.empty()) return of_pairs;
  const Stopwatch of_backs;
  backsOf(emitters_.front());
  return of_pairs + of_backs.seconds() * double(emitters_.size()) / double(allowedThreads());
}

std::vector<KnownRow> ShadowRows::compute(Progress& progress) const {
  WantedRows rows(mesh_.size(), wanted_);
  progress.begin("form factors of emitters", mesh_.size());
  for (std::size_t begin = 0; begin < mesh_.size(); begin += kBlock) {
    addBlock(begin, std::min(kBlock, mesh_.size() - begin), rows, progress);
  }
  std::vector<std::vector<SeenBack>> backs(emitters_.size());
  parallelFor(emitters_.size(), 1, [&](std::size_t e) {
    if (!progress.cancelled()) backs[e] = backsOf(emitters_[e]);
  });
  progress.check();
  progress.end();
  for (std::size_t e = 0; e < emitters_.size(); ++e) rows.addBacks(emitters_[e].patch, backs[e]);
  return rows.take();
}

void ShadowRows::addBlock(std::size_t begin, std::size_t count, WantedRows& rows,
                          Progress& progress) const {
  std::vector<Share> shares(count * emitters_.size());
  const auto of = [&](std::size_t k) {
    return std::span(shares).subspan(k * emitters_.size(), emitters_.size());
  };
  parallelFor(count, 16, [&](std::size_t k) {
    progress.advance();
    if (!progress.cancelled()) receive(Index(begin + k), of(k));
  });
  progress.check();
  for (std::size_t k = 0; k < count; ++k) {
    const auto patch = Index(begin + k);
    const double area = mesh_.area[patch];
    for (std::size_t e = 0; e < emitters_.size(); ++e) {
      const Share& share = of(k)[e];
      if (!(share.value > 0)) continue;
      rows.add(patch, emitters_[e].patch, area * share.value, area * share.error);
    }
  }
}

/// Fills in the share of each emitter, of a pair of two emitters at the first of them. Emitters
/// take other points of a patch, so that their errors add up as squares. Whether there are enough
/// rays is judged by all emitters at once: by each of them, those that few rays happened to miss,
/// or to see whole, would stay as they are, and half shadows come out too dark.
void ShadowRows::receive(Index patch, std::span<Share> shares) const {
  if (mesh_.polygon[patch] == kNone || !(mesh_.area[patch] > 0)) return;
  const std::uint64_t seed = patchSeed(mesh_, patch, seed_);
  std::vector<std::size_t> facing;
  const std::size_t begin = emitter_of_[patch] == kNone ? 0 : emitter_of_[patch] + 1;
  for (std::size_t e = begin; e < emitters_.size(); ++e) {
    if (faces(patch, emitters_[e])) facing.push_back(e);
  }
  if (facing.empty()) return;
  for (std::size_t level = firstLevel(); level < kShadowPoints.size(); ++level) {
    const std::size_t count = kShadowPoints[level];
    const std::size_t all_points = std::max(count, kShadowPoints[2]);
    const PatchPoints first(mesh_, patch, sobol_, all_points, seed);
    const PatchPoints second(mesh_, patch, sobol_, all_points, seed + 1);
    std::vector<std::array<Found, 2>> found;
    for (const std::size_t e : facing) {
      const std::size_t from = e * count % all_points;
      found.push_back(
          {look(emitters_[e], first, from, count), look(emitters_[e], second, from, count)});
    }
    if (settle(found, facing, count, shares)) return;
  }
}

/// The shares by what was found of the emitters that a patch faces, with their errors. Returns
/// whether these are small enough.
bool ShadowRows::settle(std::span<const std::array<Found, 2>> found,
                        std::span<const std::size_t> facing, std::size_t count,
                        std::span<Share> shares) const {
  std::array<double, 2> lit{};
  double formula = 0;
  double squares = 0;
  double all = 0;
  bool is_whole = true;
  bool is_dark = true;
  for (std::size_t k = 0; k < facing.size(); ++k) {
    const auto& [a, b] = found[k];
    const double mean = (a.formula + b.formula) / 2;
    const double whole = a.whole + b.whole;
    Share& share = shares[facing[k]];
    share.value = whole > 0 ? mean * (a.lit + b.lit) / whole : 0.0;
    for (std::size_t half = 0; half < lit.size(); ++half) {
      const Found& of = found[k][half];
      lit[half] += of.whole > 0 ? of.formula * of.lit / of.whole : 0.0;
      is_whole = is_whole && of.lit == of.whole;
      is_dark = is_dark && of.lit == 0;
    }
    formula += mean;
    squares += mean * mean;
    all += share.value;
  }
  // Two halves may agree by chance: an edge is taken to be off by what edges are, and what all rays
  // see alike by what falls between them.
  const auto rays = double(2 * count * facing.size());
  const double chance = is_whole || is_dark ? 1 / rays : edgeError(std::size_t(rays));
  const double error = std::max(std::abs(lit[0] - lit[1]) / 2, chance * formula);
  for (std::size_t k = 0; squares > 0 && k < facing.size(); ++k) {
    const double mean = (found[k][0].formula + found[k][1].formula) / 2;
    shares[facing[k]].error = error * mean / std::sqrt(squares);
  }
  return error <= kShadowTolerance * std::max(all, kLeastSeen * formula);
}

/// Whether something of each lies in front of the other.
bool ShadowRows::faces(Index patch, const Emitter& emitter) const {
  const auto isInFront = [&](Index of, Index other) {
    return std::ranges::any_of(mesh_.outline(of), [&](Index corner) {
      return glm::dot(mesh_.normal[other], mesh_.vertices[corner] - mesh_.centroid[other]) > 0;
    });
  };
  return isInFront(patch, emitter.patch) && isInFront(emitter.patch, patch);
}

ShadowRows::Found ShadowRows::look(const Emitter& emitter, const PatchPoints& points,
                                   std::size_t first, std::size_t count) const {
  thread_local std::vector<Vec3> from;
  thread_local std::vector<Vec3> to;
  thread_local std::vector<double> share;
  thread_local std::vector<std::uint8_t> seen;
  thread_local std::vector<Index> there;
  from.clear();
  to.clear();
  share.clear();
  Found found;
  const Vec3& facing = mesh_.normal[emitter.patch];
  const double each = 1 / double(count);
  for (std::size_t k = first; k < first + count; ++k) {
    const Vec3& at = points.at[k];
    const Vec3 middle = mesh_.centroid[emitter.patch] - at;
    const bool is_near = glm::dot(middle, middle) < kNear * kNear * emitter.radius * emitter.radius;
    const auto& [u, v] = points.of_light[k];
    const Vec3 end = emitter.area.at(double(u), double(v));
    const Vec3 way = end - at;
    const double cosine = glm::dot(way, points.normal);
    const double other = -glm::dot(way, facing);
    const double square = glm::dot(way, way);
    if (is_near) found.formula += each * formula(emitter, at, points.normal);
    if (!(cosine > 0) || !(other > 0)) continue;
    from.push_back(at);
    to.push_back(end);
    share.push_back(each * emitter.area.size() * cosine * other /
                    (std::numbers::pi * square * square));
    found.whole += share.back();
    if (!is_near) found.formula += share.back();
  }
  seen.resize(to.size());
  there.assign(to.size(), mesh_.polygon[emitter.patch]);
  rays_.see(from, points.normal, points.own, to, there, seen);
  for (std::size_t k = 0; k < to.size(); ++k) {
    if (seen[k] != 0) found.lit += share[k];
  }
  return found;
}

double ShadowRows::formula(const Emitter& emitter, const Vec3& at, const Vec3& normal) const {
  const Index patch = emitter.patch;
  if (!(glm::dot(mesh_.normal[patch], at - mesh_.centroid[patch]) > 0)) return 0;
  thread_local std::vector<Vec3> corners;
  thread_local std::vector<Vec3> scratch;
  double sum = 0;
  for (const auto& [a, b, c] : emitter.area.pieces()) {
    corners.assign({mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]});
    clipLoop(corners, scratch, [&](const Vec3& corner) { return glm::dot(normal, corner - at); });
    if (corners.size() > 2) sum += pointToPolygon(at, normal, corners);
  }
  return std::max(0.0, sum);
}

std::vector<SeenBack> ShadowRows::backsOf(const Emitter& emitter) const {
  const std::uint64_t seed = patchSeed(mesh_, emitter.patch, seed_);
  const PatchPoints points(mesh_, emitter.patch, sobol_, kBackPoints, seed);
  const HemisphereSet set(kBackRays, seed_);
  std::vector<RayEnd> ends(kBackRays);
  std::vector<SeenBack> backs;
  for (const Vec3& at : points.at) {
    const HemisphereSet::Turn turn = set.turnAt(at, seed_);
    rays_.look({at, points.normal, points.own}, set, turn.set, turn.angle, ends);
    for (const RayEnd& end : ends) {
      if (end.patch != RayEnd::kBlack) continue;
      addBack({mesh_.polygons.surface[end.polygon], 1.0 / double(kBackPoints * kBackRays)}, backs);
    }
  }
  return backs;
}

}  // namespace radiosity
