#include "formfactor/rays/shadow_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <utility>

#include "base/geometry/clip.h"
#include "base/parallel.h"
#include "base/processor_clock.h"
#include "formfactor/patch_seed.h"
#include "formfactor/unknown_rows.h"
#include "visibility/clipping/point_to_polygon.h"

namespace radiosity {
namespace {

/// Points of a patch for each emitter, in each of two halves: at first so many that all emitters
/// have kAllPoints or less, then as many as the tolerance takes.
constexpr std::array<std::size_t, 4> kShadowPoints{1, 8, 64, 512};
constexpr std::size_t kAllPoints = 512;
/// Of what a patch sees of all emitters.
constexpr double kShadowTolerance = 0.02;
/// Beyond so many areas of it, squared distance, an emitter is a point: what a point of it brings
/// is what all of it brings, but for some percent, which average out.
constexpr double kNear = 16;
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
    if (!std::ranges::binary_search(wanted_, mesh.unknownOf(i))) continue;
    emitter_of_[i] = Index(emitters_.size());
    emitters_.push_back({i, PatchArea(mesh, i)});
  }
}

std::size_t ShadowRows::firstLevel() const {
  std::size_t level = 2;
  while (level > 0 && emitters_.size() * kShadowPoints[level] > kAllPoints) --level;
  return level;
}

double ShadowRows::rays() const {
  return 2.0 * double(kShadowPoints[firstLevel()]) * double(mesh_.size()) *
         double(emitters_.size());
}

std::size_t ShadowRows::bytes() const {
  return kBlock * emitters_.size() * sizeof(Share) +
         UnknownRows::bytes(wanted_.size(), mesh_.unknowns());
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
  return watch.seconds() * double(mesh_.size()) / double(count);
}

std::vector<KnownRow> ShadowRows::compute(Progress& progress) const {
  UnknownRows rows(mesh_, wanted_);
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

void ShadowRows::addBlock(std::size_t begin, std::size_t count, UnknownRows& rows,
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
/// take other points of a patch, so that their errors add up as squares.
void ShadowRows::receive(Index patch, std::span<Share> shares) const {
  if (mesh_.polygon[patch] == kNone || !(mesh_.area[patch] > 0)) return;
  const std::uint64_t seed = patchSeed(mesh_, patch, seed_);
  const std::size_t begin = emitter_of_[patch] == kNone ? 0 : emitter_of_[patch] + 1;
  double least = 0;
  for (std::size_t level = firstLevel(); level < kShadowPoints.size(); ++level) {
    const bool is_first = level == firstLevel();
    const std::size_t count = kShadowPoints[level];
    const std::size_t all_points = std::max(count, kShadowPoints[2]);
    std::optional<PatchPoints> first;
    std::optional<PatchPoints> second;
    for (std::size_t e = begin; e < emitters_.size(); ++e) {
      if (is_first ? !faces(patch, emitters_[e]) : !(shares[e].error > least)) continue;
      if (!first) {
        first.emplace(mesh_, patch, sobol_, all_points, seed);
        second.emplace(mesh_, patch, sobol_, all_points, seed + 1);
      }
      const std::size_t from = e * count % all_points;
      shares[e] = shareOf(look(emitters_[e], *first, from, count),
                          look(emitters_[e], *second, from, count), count);
    }
    double all = 0;
    double seen = 0;
    for (const Share& share : shares) {
      all += share.value;
      seen += share.value > 0 ? 1.0 : 0.0;
    }
    least = kShadowTolerance * all / std::sqrt(std::max(1.0, seen));
  }
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

/// Two halves may agree by chance: an edge is taken to be off by what edges are.
ShadowRows::Share ShadowRows::shareOf(const Found& a, const Found& b, std::size_t points) const {
  if (!(a.lit + b.lit > 0)) return {};
  const double formula = (a.formula + b.formula) / 2;
  const auto seenOf = [](const Found& half) { return half.whole > 0 ? half.lit / half.whole : 0; };
  const double value = formula * (a.lit + b.lit) / (a.whole + b.whole);
  const double off = std::abs(a.formula * seenOf(a) - b.formula * seenOf(b)) / 2;
  if (a.lit == a.whole && b.lit == b.whole) return {value, off};
  return {value, std::max(off, formula * edgeError(2 * points))};
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
    const auto& [u, v] = points.of_light[k];
    const Vec3 end = emitter.area.at(double(u), double(v));
    const Vec3 way = end - at;
    const double cosine = glm::dot(way, points.normal);
    const double other = -glm::dot(way, facing);
    const double square = glm::dot(way, way);
    const bool is_near = square < kNear * emitter.area.size();
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
      const Index surface = mesh_.polygons.surface[end.polygon];
      const auto same = std::ranges::find(backs, surface, &SeenBack::surface);
      const double share = 1.0 / double(kBackPoints * kBackRays);
      if (same == backs.end()) {
        backs.push_back({surface, share});
      } else {
        same->share += share;
      }
    }
  }
  return backs;
}

}  // namespace radiosity
