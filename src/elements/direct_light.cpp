#include "elements/direct_light.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <optional>
#include <unordered_map>

#include "elements/emitter_aim.h"
#include "formfactor/rays/sobol.h"
#include "visibility/clipping/flat_polygon.h"
#include "visibility/clipping/point_to_polygon.h"

namespace radiosity {
namespace {

/// The number of rays to emitters from a point, and from one that some of them do not reach.
constexpr std::size_t kLooks = 64;
constexpr std::size_t kMoreLooks = 256;
/// An emitter that gets fewer rays than this takes them evenly.
constexpr double kFewLooks = 3;
/// Light on an element is clipped if its emitters and occluders together are no more than this. A
/// point then takes some 50 us, like its rays.
constexpr std::size_t kMostClips = 64;
/// The longest list of occluders that is thinned out: beyond, that would take longer than rays. The
/// element and all below it are then lit by rays.
constexpr std::size_t kMostThinned = 160;
/// Beyond this many radii the form factor is taken at the emitter's centre. It is then good to 1%,
/// and only decides how many rays go there.
constexpr double kFar = 6;

const std::vector<Occluder>& bodiesOf(const OccluderSet* occluders) {
  static const std::vector<Occluder> kNoBodies;
  return occluders == nullptr ? kNoBodies : occluders->occluders;
}

/// The part of an emitter above a point's horizon.
FlatPolygon aboveHorizon(const Emitter& emitter, const Vec3& normal, double offset) {
  return clipToFront(emitter.outline, normal, offset);
}

bool isFar(const Emitter& emitter, const Vec3& eye) {
  const Vec3 to = emitter.centre - eye;
  return glm::dot(to, to) > kFar * kFar * emitter.radius * emitter.radius;
}

/// The form factor from a point to an emitter that faces it, with nothing in between.
double unblockedFactor(const Emitter& emitter, const Vec3& eye, const Vec3& normal) {
  if (isFar(emitter, eye)) {
    const Vec3 to = emitter.centre - eye;
    const double square = glm::dot(to, to);
    return -glm::dot(to, normal) * glm::dot(to, emitter.normal) * emitter.area /
           (std::numbers::pi * square * square);
  }
  const FlatPolygon target = aboveHorizon(emitter, normal, glm::dot(normal, eye));
  return target.count < 3 ? 0.0 : pointToPolygon(eye, normal, target.outline());
}

/// The first points of a sequence.
std::vector<std::array<float, 3>> aimsOf(std::uint64_t seed) {
  std::array<std::array<float, kMoreLooks>, kDimensions> points;
  PointArrays out{};
  for (std::size_t d = 0; d < kDimensions; ++d) out[d] = points[d].data();
  SobolPoints().points(0, kMoreLooks, seed, out);
  std::vector<std::array<float, 3>> aims;
  for (std::size_t k = 0; k < kMoreLooks; ++k) {
    aims.push_back({points[0][k], points[1][k], points[2][k]});
  }
  return aims;
}

}  // namespace

/// The emitters that an element may see, and the occluders that may be in between.
struct EmitterLight::Lights : ElementLights {
  struct Seen {
    Index emitter;
    Index first, end;  ///< into candidates
  };
  std::vector<Seen> seen;
  std::vector<Candidate> candidates;

  void judge() {
    kind = seen.empty() ? Kind::dark : candidates.empty() ? Kind::plain : Kind::partial;
    if (seen.size() + candidates.size() > kMostClips) kind = Kind::by_rays;
  }
};

/// The light of emitters at a point with nothing in between.
struct EmitterLight::Unblocked {
  struct Share {
    Index emitter;
    double factor;  ///< form factor
    double end;     ///< end of its share in the running sum
  };
  std::vector<Share> shares;
  std::vector<double> whole;  ///< by band
  double sum = 0;             ///< over the bands
};

/// Rays from a point to points of emitters, and whether they arrive.
struct EmitterLight::Looks {
  std::array<Vec3, kMoreLooks> to;
  std::array<Index, kMoreLooks> polygon;
  std::array<Index, kMoreLooks> emitter;
  std::array<double, kMoreLooks> weight;  ///< light of the place over the density of rays there
  std::array<std::uint8_t, kMoreLooks> seen;
  std::size_t count = 0;
};

EmitterLight::EmitterLight(const PatchMesh& mesh, const PatchMaterials& materials,
                           const ElementSurface& surface, const ElementSet& elements,
                           const OccluderSet* occluders, const std::vector<Emitter>& emitters,
                           const PointRays& rays)
    : materials_(materials),
      surface_(surface),
      elements_(elements),
      occluders_(occluders),
      emitters_(emitters),
      aimed_(mesh, rays, materials.lights),
      rays_(rays),
      tree_(bodiesOf(occluders)),
      kernels_(visibilityKernels(true)),
      facet_of_patch_(mesh.size(), kNone),
      own_(elements.facets.size()) {
  for (std::size_t e = 0; e < elements.patch_elements; ++e) {
    facet_of_patch_[elements.patch[e]] = elements.facet[e];
  }
  const std::vector<Occluder>& bodies = bodiesOf(occluders);
  for (Index o = 0; o < bodies.size(); ++o) {
    for (const Index f : bodies[o].facets) own_[f].push_back(o);
  }
  aims_ = aimsOf(0);
  // Sorted by the number that chooses the emitter.
  std::sort(aims_.begin(), aims_.begin() + kLooks);
  std::sort(aims_.begin() + kLooks, aims_.end());
  for (std::size_t set = 0; set < kFineSets; ++set) {
    fine_aims_[set] = aimsOf(set + 1);
    std::ranges::sort(fine_aims_[set]);
  }
}

std::shared_ptr<const ElementLights> EmitterLight::lightsOf(const ElementShape& shape,
                                                            const ElementLights* parent) const {
  const bool any_aimed = !aimed_.lights().empty();
  if (occluders_ == nullptr && !any_aimed) return nullptr;
  auto lights = std::make_shared<Lights>();
  if (occluders_ == nullptr) {
    lights->kind = ElementLights::Kind::partial;
    lights->settled = true;
    return lights;
  }
  if (parent != nullptr) {
    thinOut(shape, static_cast<const Lights&>(*parent), *lights);
    lights->judge();
  } else if (findAll(shape, *lights)) {
    lights->judge();
  } else {
    lights->kind = ElementLights::Kind::by_rays;
    lights->settled = true;
  }
  // What stands between the element and aimed lights, points tell.
  if (any_aimed && lights->kind != ElementLights::Kind::by_rays) {
    lights->kind = ElementLights::Kind::partial;
  }
  return lights;
}

/// Finds all emitters in front of a root that face it, with the occluders in between. False, with
/// the emitters alone, if the occluders are too many to be thinned out.
bool EmitterLight::findAll(const ElementShape& shape, Lights& lights) const {
  const Index facet = facet_of_patch_[surface_.roots.patch[shape.root]];
  if (facet == kNone || occluders_->hidden_facets[facet] != 0) return true;
  const Facet& own = elements_.facets[facet];
  const double touching = elements_.coincidence;
  // At smooth corners the horizon is not that of the root's plane.
  const bool curved = surface_.curved[shape.root] != 0;
  const HalfSpace front = curved ? kAnywhere : HalfSpace{own.normal, own.offset + touching};
  std::array<Vec3, 4> corners;
  Sphere ball;
  for (std::size_t k = 0; k < 4; ++k) {
    corners[k] = scaled(shape.corners[k]);
    ball.centre += 0.25 * corners[k];
  }
  for (const Vec3& c : corners) ball.radius = std::max(ball.radius, glm::distance(c, ball.centre));
  Lights all;
  std::size_t tests = 0;
  std::vector<Index> found;
  for (Index e = 0; e < emitters_.size(); ++e) {
    const Emitter& emitter = emitters_[e];
    const auto before = [&](const Vec3& c) {
      return glm::dot(emitter.normal, c) > emitter.offset + touching;
    };
    const auto above = [&](const Vec3& c) { return glm::dot(front.normal, c) > front.offset; };
    if (std::none_of(corners.begin(), corners.end(), before)) continue;
    if (std::none_of(emitter.outline.begin(), emitter.outline.end(), above)) continue;
    found.clear();
    if (all.candidates.size() > kMostThinned) {
      all.seen.push_back({e, 0, 0});
      continue;
    }
    const std::vector<Index>& mine = own_[facet];
    const std::vector<Index>& its = own_[emitter.facet];
    // With more than these, candidates will be too many, even without its own and the emitter's.
    const std::size_t most = kMostThinned - all.candidates.size() + mine.size() + its.size();
    tree_.query(ball, {emitter.centre, emitter.radius}, front,
                {emitter.normal, emitter.offset + touching}, found, tests, most);
    std::sort(found.begin(), found.end());
    const auto first = Index(all.candidates.size());
    for (const Index o : found) {
      if (std::binary_search(mine.begin(), mine.end(), o)) continue;
      if (std::binary_search(its.begin(), its.end(), o)) continue;
      const Occluder& body = occluders_->occluders[o];
      const bool cuts = std::any_of(body.corners.begin(), body.corners.end(), [&](const Vec3& c) {
        return glm::dot(emitter.normal, c) < emitter.offset - touching;
      });
      all.candidates.push_back({o, cuts});
    }
    all.seen.push_back({e, first, Index(all.candidates.size())});
  }
  if (all.candidates.size() > kMostThinned) {
    lights.seen = std::move(all.seen);
    return false;
  }
  thinOut(shape, all, lights);
  return true;
}

/// Keeps the emitters and occluders of the lists that matter to an element.
void EmitterLight::thinOut(const ElementShape& shape, const Lights& from, Lights& lights) const {
  ShapeCorners corners{};
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3 c = scaled(shape.corners[k]);
    corners.x[k] = c.x;
    corners.y[k] = c.y;
    corners.z[k] = c.z;
  }
  std::unordered_map<Index, ShadowPlanes> shadows;
  for (const Lights::Seen& seen : from.seen) {
    const auto first = Index(lights.candidates.size());
    bool hidden = false;
    for (Index k = seen.first; k < seen.end && !hidden; ++k) {
      const Candidate& candidate = from.candidates[k];
      const auto [shadow, fresh] = shadows.try_emplace(candidate.occluder);
      if (fresh) {
        shadow->second.build(corners, occluders_->occluders[candidate.occluder],
                             elements_.coincidence);
      }
      ShadowPlanes::Planes open = ShadowPlanes::kAllPlanes;
      const ShadowRelation relation =
          shadow->second.relation(kernels_, emitters_[seen.emitter].shape, open);
      hidden = relation == ShadowRelation::kInside;
      if (relation == ShadowRelation::kUnclear) lights.candidates.push_back(candidate);
    }
    if (hidden) {
      lights.candidates.resize(first);
      continue;
    }
    lights.seen.push_back({seen.emitter, first, Index(lights.candidates.size())});
  }
}

double EmitterLight::irradiance(const SurfacePoint& point, const ElementLights* lights,
                                std::span<double> out) const {
  const double noise = aimedAt(point, out);
  if (emitters_.empty()) return noise;
  const auto* of = static_cast<const Lights*>(lights);
  if (occluders_ == nullptr) return noise + byRays(point, nullptr, out);
  if (of == nullptr || of->kind == ElementLights::Kind::by_rays) {
    return noise + byRays(point, of, out);
  }
  return noise + clipped(point, *of, out);
}

/// Whether an occluder lies on one of several facets that meet smoothly in a point.
bool EmitterLight::ownsOccluder(Index owners, Index occluder) const {
  const std::vector<Index>& polygons = surface_.owners[owners];
  const std::vector<Index>& facets = occluders_->occluders[occluder].facets;
  return std::any_of(facets.begin(), facets.end(), [&](Index f) {
    return std::binary_search(polygons.begin(), polygons.end(), elements_.facets[f].polygon);
  });
}

double EmitterLight::clipped(const SurfacePoint& point, const Lights& lights,
                             std::span<double> out) const {
  thread_local VisiblePart part;
  thread_local std::vector<Blocker> blockers;
  const Vec3 eye = scaled(point.position);
  const double horizon = glm::dot(point.normal, eye);
  const bool shared = surface_.owners[point.owners].size() > 1;
  for (const Lights::Seen& seen : lights.seen) {
    const Emitter& emitter = emitters_[seen.emitter];
    if (!(glm::dot(emitter.normal, eye) > emitter.offset)) continue;
    const FlatPolygon target = aboveHorizon(emitter, point.normal, horizon);
    if (target.count < 3) continue;
    double factor = 0;
    if (seen.first == seen.end) {
      factor = std::max(0.0, pointToPolygon(eye, point.normal, target.outline()));
    } else {
      blockers.clear();
      for (Index k = seen.first; k < seen.end; ++k) {
        const Candidate& c = lights.candidates[k];
        if (shared && ownsOccluder(point.owners, c.occluder)) continue;
        blockers.push_back({&occluders_->occluders[c.occluder], c.occluder, c.cuts_emitter});
      }
      factor = part.look(eye, point.normal, target.outline(), blockers).visible;
    }
    const double* exitance = materials_.emission.data() + emitter.patch * out.size();
    for (std::size_t b = 0; b < out.size(); ++b) out[b] += factor * exitance[b];
  }
  return 0;
}

/// Adds rays until there are `count`, aimed in proportion to the unblocked light, so that each
/// stands for nearly the same light.
void EmitterLight::look(const SurfacePoint& point, const Unblocked& light, const Aims& aims,
                        std::size_t count, Looks& looks) const {
  const Vec3 eye = scaled(point.inner);
  const std::size_t first = looks.count;
  std::optional<EmitterAim> aim;
  std::size_t at = 0;
  for (std::size_t k = first; k < count; ++k) {
    const std::size_t before = at;
    while (at + 1 < light.shares.size() && double(aims[k][0]) * light.sum >= light.shares[at].end) {
      ++at;
    }
    const Unblocked::Share& share = light.shares[at];
    const Emitter& emitter = emitters_[share.emitter];
    if (!aim || at != before) {
      const double given = share.end - (at > 0 ? light.shares[at - 1].end : 0.0);
      const bool few = given * double(count - first) < kFewLooks * light.sum;
      aim.emplace(emitter, eye, point.normal, few || isFar(emitter, eye));
    }
    const AimedPlace place = aim->at(aims[k][1], aims[k][2]);
    looks.to[k] = place.at / elements_.scale + elements_.middle;
    looks.weight[k] = place.factor / share.factor;
    looks.polygon[k] = elements_.facets[emitter.facet].polygon;
    looks.emitter[k] = share.emitter;
  }
  looks.count = count;
  const std::size_t fresh = count - first;
  rays_.see({point.inner, point.normal, surface_.owners[point.owners]},
            std::span(looks.to).subspan(first, fresh),
            std::span(looks.polygon).subspan(first, fresh),
            std::span(looks.seen).subspan(first, fresh));
}

/// Sums the light of the emitters that an element may see, or of all if `lights` is null.
void EmitterLight::sumUnblocked(const SurfacePoint& point, const Lights* lights,
                                Unblocked& light) const {
  const Vec3 eye = scaled(point.inner);
  const std::size_t bands = light.whole.size();
  const auto add = [&](Index e) {
    const Emitter& emitter = emitters_[e];
    if (!(glm::dot(emitter.normal, eye) > emitter.offset)) return;
    const double factor = unblockedFactor(emitter, eye, point.normal);
    if (!(factor > 0)) return;
    const double* exitance = materials_.emission.data() + emitter.patch * bands;
    double given = 0;
    for (std::size_t b = 0; b < bands; ++b) {
      light.whole[b] += factor * exitance[b];
      given += factor * exitance[b];
    }
    light.shares.push_back({e, factor, light.sum += given});
  };
  if (lights == nullptr) {
    for (Index e = 0; e < emitters_.size(); ++e) add(e);
  } else {
    for (const Lights::Seen& seen : lights->seen) add(seen.emitter);
  }
}

/// Adds the light that the looks let through. Returns the square of its error, estimated from every
/// second look alone.
double EmitterLight::addSeen(const Unblocked& light, const Looks& looks,
                             std::span<double> out) const {
  thread_local std::vector<double> given;
  thread_local std::vector<double> all;
  given.assign(out.size(), 0.0);
  all.assign(out.size(), 0.0);
  std::array<double, 2> above{};  // of even looks, of odd ones
  std::array<double, 2> visible{};
  for (std::size_t k = 0; k < looks.count; ++k) {
    const double* exitance =
        materials_.emission.data() + emitters_[looks.emitter[k]].patch * out.size();
    double sum = 0;
    for (std::size_t b = 0; b < out.size(); ++b) sum += exitance[b];
    const double weight = looks.weight[k];
    for (std::size_t b = 0; b < out.size(); ++b) {
      all[b] += weight * exitance[b] / sum;
      if (looks.seen[k] != 0) given[b] += weight * exitance[b] / sum;
    }
    above[k % 2] += weight;
    if (looks.seen[k] != 0) visible[k % 2] += weight;
  }
  for (std::size_t b = 0; b < out.size(); ++b) {
    if (all[b] > 0) out[b] += light.whole[b] * given[b] / all[b];
  }
  if (!(above[0] > 0 && above[1] > 0)) return light.sum * light.sum;
  const double off =
      light.sum * ((visible[0] + visible[1]) / (above[0] + above[1]) - visible[1] / above[1]);
  return off * off;
}

/// Of those that leave above the horizon.
bool EmitterLight::onlySomeArrive(const Looks& looks) {
  bool some = false;
  bool all = true;
  for (std::size_t k = 0; k < looks.count; ++k) {
    if (!(looks.weight[k] > 0)) continue;
    some = some || looks.seen[k] != 0;
    all = all && looks.seen[k] != 0;
  }
  return some && !all;
}

/// Finds what there is of emitters, and the first looks at it. False: there is nothing.
bool EmitterLight::lookFirst(const SurfacePoint& point, const Lights* lights, std::size_t bands,
                             Unblocked& light, Looks& looks) const {
  light.shares.clear();
  light.whole.assign(bands, 0.0);
  light.sum = 0;
  sumUnblocked(point, lights, light);
  looks.count = 0;
  if (!(light.sum > 0)) return false;
  look(point, light, aims_, kLooks, looks);
  return true;
}

/// Most points see all looks arrive or none; those in a penumbra take more.
double EmitterLight::byRays(const SurfacePoint& point, const Lights* lights,
                            std::span<double> out) const {
  ++by_rays_;
  thread_local Unblocked light;
  thread_local Looks looks;
  if (!lookFirst(point, lights, out.size(), light, looks)) return 0;
  if (onlySomeArrive(looks)) look(point, light, aims_, kMoreLooks, looks);
  return addSeen(light, looks, out);
}

double EmitterLight::aimedAt(const SurfacePoint& point, std::span<double> out) const {
  if (aimed_.lights().empty()) return 0;
  return aimed_.add({point.inner, point.normal, surface_.owners[point.owners]}, out);
}

double EmitterLight::emittedWithin(const SurfacePoint& point, double tolerance,
                                   std::span<double> out) const {
  thread_local Unblocked light;
  thread_local Looks looks;
  if (!lookFirst(point, nullptr, out.size(), light, looks)) return 0;
  if (!onlySomeArrive(looks)) return addSeen(light, looks, out);
  return finely(point, light, tolerance, out);
}

/// The mean of sets of rays, and the square of its standard error over all bands.
double EmitterLight::finely(const SurfacePoint& point, const Unblocked& light, double tolerance,
                            std::span<double> out) const {
  constexpr std::size_t kFewestSets = 4;
  thread_local Looks looks;
  std::vector<double> of_sets(out.size(), 0.0);
  double sum = 0;
  double squares = 0;
  double square_error = 0;
  std::size_t sets = 0;
  while (sets < kFineSets) {
    looks.count = 0;
    look(point, light, fine_aims_[sets], kMoreLooks, looks);
    const double before = std::accumulate(of_sets.begin(), of_sets.end(), 0.0);
    addSeen(light, looks, of_sets);
    const double found = std::accumulate(of_sets.begin(), of_sets.end(), 0.0) - before;
    ++sets;
    sum += found;
    squares += found * found;
    if (sets < kFewestSets) continue;
    const auto n = double(sets);
    square_error = std::max(0.0, squares - sum * sum / n) / (n * (n - 1));
    if (square_error <= tolerance * tolerance * sum * sum / (n * n)) break;
  }
  for (std::size_t b = 0; b < out.size(); ++b) out[b] += of_sets[b] / double(sets);
  return square_error;
}

}  // namespace radiosity
