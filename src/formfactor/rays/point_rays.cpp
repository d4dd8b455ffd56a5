#include "formfactor/rays/point_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>

#include "base/geometry/plane_frame.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "formfactor/rays/ray_kernels.h"
#include "formfactor/rays/sobol.h"

namespace radiosity {
namespace {

/// Rays to a point end this much of their length before it.
constexpr float kShort = 1e-5F;
constexpr int kDiscCells =
    8;  ///< along each side of the disc's square: of 1,024 rays a cell has one packet

/// Sets of many rays.
constexpr std::size_t kFewestSets = 16;

/// Cells row by row, to and fro, so that neighbours in the order are neighbours on the disc.
int discCellOf(float x, float y) {
  const int row = std::min(int(y * kDiscCells), kDiscCells - 1);
  const int column = std::min(int(x * kDiscCells), kDiscCells - 1);
  return row * kDiscCells + (row % 2 == 0 ? column : kDiscCells - 1 - column);
}

/// The polygons that must not stop a ray to a point; passed through Embree's context.
struct SightContext {
  RTCIntersectContext context;  // first: Embree gives back a pointer to it
  const RayTargets* targets;
  std::span<const Index> own;
  std::span<const Index> there;  ///< by the number that the ray has; or none
};

/// An intersection filter: polygons that either end lies on stop nothing.
void passEnds(const RTCFilterFunctionNArguments* hits) {
  const auto* sight = reinterpret_cast<const SightContext*>(hits->context);
  for (unsigned k = 0; k < hits->N; ++k) {
    if (hits->valid[k] == 0) continue;
    const Index polygon = sight->targets->polygonOf(RTCHitN_primID(hits->hit, hits->N, k));
    const bool own = std::find(sight->own.begin(), sight->own.end(), polygon) != sight->own.end();
    const bool end =
        !sight->there.empty() && polygon == sight->there[RTCRayN_id(hits->ray, hits->N, k)];
    if (own || end) hits->valid[k] = 0;
  }
}

}  // namespace

HemisphereSet::HemisphereSet(std::size_t rays, std::uint64_t seed)
    : rays_(rays), sets_(std::max(kFewestSets, kMostPoints / rays)) {
  const SobolPoints sobol;
  std::array<std::vector<float>, kDimensions> points;
  PointArrays out{};
  for (std::size_t d = 0; d < kDimensions; ++d) {
    points[d].resize(rays);
    out[d] = points[d].data();
  }
  std::vector<float> u(rays);
  std::vector<float> v(rays);
  std::vector<std::size_t> order(rays);
  for (std::size_t set = 0; set < sets_; ++set) {
    sobol.points(0, rays, seed + set, out);
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return discCellOf(points[0][a], points[1][a]) < discCellOf(points[0][b], points[1][b]);
    });
    rayKernels().toDisc(out[0], out[1], rays, u.data(), v.data());
    for (const std::size_t k : order) {
      directions_.emplace_back(u[k], v[k],
                               std::sqrt(std::max(0.0F, 1 - u[k] * u[k] - v[k] * v[k])));
      first_.push_back(k < rays / 2 ? 1 : 0);
    }
  }
}

HemisphereSet::Turn HemisphereSet::turnAt(const Vec3& place, std::uint64_t seed) const {
  Hash hash;
  hash.bytes(&place, sizeof place);
  hash.bytes(&seed, sizeof seed);
  const std::uint64_t bits = mixed(hash.value());
  return {bits % sets_, 2 * std::numbers::pi * double(bits >> 11) * 0x1p-53};
}

PointRays::PointRays(const PatchMesh& mesh)
    : scene_(mesh), embree_(scene_, mesh), targets_(scene_, embree_) {}

glm::vec3 PointRays::lifted(const Vec3& from, const Vec3& normal) const {
  return embree_.place(from * scene_.scale) + kRayLift * glm::vec3(normal);
}

RayEnd PointRays::endOf(const RTCRayHit16& packet, int k, std::span<const Index> own) const {
  RayEnd end;
  const glm::vec3 along(packet.ray.dir_x[k], packet.ray.dir_y[k], packet.ray.dir_z[k]);
  if (packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) {
    end.at = along;
    return end;
  }
  const EmbreeScene::End hit = embree_.endAt(packet, k, kNone);
  end.polygon = targets_.polygonOf(hit.triangle);
  if (std::find(own.begin(), own.end(), end.polygon) != own.end()) {
    end.patch = RayEnd::kOwn;
    return end;
  }
  const std::uint32_t item = targets_.itemAt(hit.triangle, hit.side, hit.u, hit.v);
  end.patch = item < scene_.patches ? item : RayEnd::kBlack;
  const glm::vec3 from(packet.ray.org_x[k], packet.ray.org_y[k], packet.ray.org_z[k]);
  end.at = (Vec3(from + packet.ray.tfar[k] * along) + embree_.middle()) / scene_.scale;
  return end;
}

void PointRays::look(const RaySource& from, const HemisphereSet& set, std::size_t number,
                     double turn, std::span<RayEnd> ends) const {
  const FlushDenormals flush;
  const PlaneFrame frame = makeFrame(from.position, from.normal, axisAcross(from.normal));
  const double c = std::cos(turn);
  const double s = std::sin(turn);
  const glm::vec3 x(c * frame.u + s * frame.v);
  const glm::vec3 y(c * frame.v - s * frame.u);
  const glm::vec3 z(frame.n);
  const glm::vec3 start = lifted(from.position, from.normal);
  RTCRayHit16 packet;
  for (std::size_t first = 0; first < set.rays(); first += kRayLanes) {
    initPacket(packet);
    for (int k = 0; k < kRayLanes; ++k) {
      const glm::vec3& d = set.direction(number, first + std::size_t(k));
      setRay(packet, k, start, d.x * x + d.y * y + d.z * z);
    }
    embree_.trace(packet, kRayLanes);
    for (int k = 0; k < kRayLanes; ++k) ends[first + std::size_t(k)] = endOf(packet, k, from.own);
  }
}

void PointRays::trace(const Vec3& from, std::span<const Vec3> along, std::span<RayEnd> ends) const {
  const FlushDenormals flush;
  const glm::vec3 start = embree_.place(from * scene_.scale);
  RTCRayHit16 packet;
  for (std::size_t first = 0; first < along.size(); first += kRayLanes) {
    const auto lanes = std::min(std::size_t(kRayLanes), along.size() - first);
    initPacket(packet);
    for (std::size_t k = 0; k < kRayLanes; ++k) {
      setRay(packet, int(k), start, glm::vec3(along[first + std::min(k, lanes - 1)]));
    }
    embree_.trace(packet, int(lanes));
    for (std::size_t k = 0; k < lanes; ++k) ends[first + k] = endOf(packet, int(k), {});
  }
}

template <class Start>
void PointRays::seeFrom(const Start& startOf, std::span<const Index> own, std::span<const Vec3> to,
                        std::span<const Index> there, std::span<std::uint8_t> seen) const {
  const FlushDenormals flush;
  SightContext sight{{}, &targets_, own, there};
  rtcInitIntersectContext(&sight.context);
  sight.context.filter = passEnds;
  sight.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  RTCRay16 packet;
  alignas(64) std::array<int, kRayLanes> valid;
  for (std::size_t first = 0; first < to.size(); first += kRayLanes) {
    const auto lanes = std::min(std::size_t(kRayLanes), to.size() - first);
    packet = {};
    valid.fill(0);
    for (std::size_t k = 0; k < lanes; ++k) {
      valid[k] = -1;
      const glm::vec3 start = startOf(first + k);
      const glm::vec3 along = embree_.place(to[first + k] * scene_.scale) - start;
      packet.org_x[k] = start.x;
      packet.org_y[k] = start.y;
      packet.org_z[k] = start.z;
      packet.dir_x[k] = along.x;
      packet.dir_y[k] = along.y;
      packet.dir_z[k] = along.z;
      packet.tfar[k] = 1 - kShort;
      packet.mask[k] = 0xffffffffu;
      packet.id[k] = unsigned(first + k);
    }
    rtcOccluded16(valid.data(), embree_.handle(), &sight.context, &packet);
    for (std::size_t k = 0; k < lanes; ++k) seen[first + k] = packet.tfar[k] < 0 ? 0 : 1;
  }
}

void PointRays::see(const RaySource& from, std::span<const Vec3> to, std::span<const Index> there,
                    std::span<std::uint8_t> seen) const {
  const glm::vec3 start = lifted(from.position, from.normal);
  seeFrom([&](std::size_t /*ray*/) { return start; }, from.own, to, there, seen);
}

void PointRays::see(std::span<const Vec3> from, const Vec3& normal, std::span<const Index> own,
                    std::span<const Vec3> to, std::span<const Index> there,
                    std::span<std::uint8_t> seen) const {
  seeFrom([&](std::size_t ray) { return lifted(from[ray], normal); }, own, to, there, seen);
}

}  // namespace radiosity
