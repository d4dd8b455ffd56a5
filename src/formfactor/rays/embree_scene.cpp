#include "formfactor/rays/embree_scene.h"

#include <pmmintrin.h>
#include <tbb/task_arena.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <tuple>

#include "base/geometry/box.h"
#include "formfactor/rays/near_triangles.h"
#include "radiosity/base.h"

namespace radiosity {
namespace {

/// Rays are settled among what lies this far before and behind a place, across the plane there: the
/// lift, and what single precision is off by.
constexpr float kSettled = 4 * kRayLift;
/// Of a ray that runs along the plane, at most.
constexpr float kLongestSettled = 1e-4F;

/// The part of a ray that is as long as kSettled across a plane.
float settledLength(float across) {
  return across * kLongestSettled > kSettled ? kSettled / across : kLongestSettled;
}

RTCDevice newDevice() {
  const RTCDevice device = rtcNewDevice(nullptr);
  if (device != nullptr) return device;
  if (rtcGetDeviceError(nullptr) == RTC_ERROR_UNSUPPORTED_CPU) {
    throw RunError("rays: Embree cannot be started on this processor");
  }
  throw RunError("rays: Embree cannot be started: too little memory, or too few threads, are left");
}

}  // namespace

EmbreeScene::EmbreeScene(const ViewScene& scene, const PatchMesh& mesh)
    : middle_(boxOf(scene.vertices).centre()),
      device_(newDevice()),
      scene_(rtcNewScene(device_)),
      all_(scene, mesh),
      coincidence_(scene.coincidence) {
  const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               all_.vertices.size()));
  for (const Vec3& v : all_.vertices) {
    const glm::vec3 at = place(v);
    for (int c = 0; c < 3; ++c) *vertices++ = at[c];
  }
  auto* corners = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), all_.triangles.size()));
  for (const auto& triangle : all_.triangles) {
    for (const std::uint32_t corner : triangle) *corners++ = corner;
  }
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  // One thread builds the tree, so that every run has the same tree, and a ray through the common
  // edge of two triangles ends on the same one. (A device with one thread would leave the whole
  // process one.)
  tbb::task_arena(1).execute([&] { rtcCommitScene(scene_); });
  source_of_.reserve(all_.triangles.size());
  for (const Index polygon : all_.polygon_of) {
    source_of_.push_back(scene.polygons[polygon].source);
  }
  findNear(scene, mesh);
}

void EmbreeScene::findNear(const ViewScene& scene, const PatchMesh& mesh) {
  near_ = nearTriangles(scene, all_);
  if (near_.empty()) return;
  plane_of_.resize(mesh.polygons.size());
  for (const ViewPolygon& polygon : scene.polygons) {
    plane_of_[polygon.source] = {polygon.normal, polygon.origin - middle_, false};
  }
  for (std::size_t t = 0; t < near_.size(); ++t) {
    if (near_[t] != 0) plane_of_[source_of_[t]].near = true;
  }
}

namespace {

/// A ray alone; Embree's rays go forward from 0 only.
RTCRayHit rayAlone(const glm::vec3& from, const glm::vec3& along, float near, float far) {
  RTCRayHit ray{};
  ray.ray.org_x = from.x;
  ray.ray.org_y = from.y;
  ray.ray.org_z = from.z;
  ray.ray.dir_x = along.x;
  ray.ray.dir_y = along.y;
  ray.ray.dir_z = along.z;
  ray.ray.tnear = near;
  ray.ray.tfar = far;
  ray.ray.mask = 0xffffffffu;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return ray;
}

/// Where the own polygon of a ray is not there.
struct WithoutOwn {
  RTCIntersectContext embree;
  std::span<const Index> polygon_of;
  Index own;

  static void pass(const RTCFilterFunctionNArguments* hit) {
    const auto& without = *reinterpret_cast<const WithoutOwn*>(hit->context);
    if (without.polygon_of[RTCHitN_primID(hit->hit, 1, 0)] == without.own) hit->valid[0] = 0;
  }
};

}  // namespace

/// All that a ray meets within a part of its length, by its polygons' planes in double precision.
class EmbreeScene::Settling {
 public:
  /// `own`: the polygon that it leaves from a place in its plane, or kNone.
  Settling(const EmbreeScene& scene, const glm::vec3& from, const glm::vec3& along, Index own)
      : scene_(scene), from_(from), along_(along), own_(own), leaves_(from) {
    if (own == kNone) return;
    const Plane& plane = scene.plane_of_[own];
    leaves_ -= glm::dot(plane.normal, leaves_ - plane.origin) * plane.normal;
  }

  /// From `low` to `high` along the ray, in which Embree meets it.
  std::optional<End> between(float low, float high) {
    Context context{{}, this};
    rtcInitIntersectContext(&context.embree);
    context.embree.filter = take;
    const float back = std::min(low, 0.0F);
    RTCRayHit ray = rayAlone(from_ + back * along_, along_, std::max(low, 0.0F), high - back);
    rtcIntersect1(scene_.scene_, &context.embree, &ray);
    return first();
  }

 private:
  struct Context {
    RTCIntersectContext embree;
    Settling* settling;
  };
  struct Candidate {
    double at;     ///< along the ray
    double slope;  ///< of the ray over the plane
    End end;
  };

  /// An intersection filter for a single ray, which keeps every hit and ends at none.
  static void take(const RTCFilterFunctionNArguments* hit) {
    hit->valid[0] = 0;
    reinterpret_cast<Context*>(hit->context)
        ->settling->add(RTCHitN_primID(hit->hit, 1, 0), RTCHitN_u(hit->hit, 1, 0),
                        RTCHitN_v(hit->hit, 1, 0));
  }

  void add(std::uint32_t triangle, float u, float v) {
    const Index polygon = scene_.source_of_[triangle];
    if (polygon == own_) return;
    const Plane& plane = scene_.plane_of_[polygon];
    const double slope = glm::dot(plane.normal, Vec3(along_));
    if (slope == 0 || (own_ != kNone && liesInOwnPlane(triangle))) return;
    const double at = glm::dot(plane.normal, plane.origin - leaves_) / slope;
    if (at > 0) candidates_.push_back({at, std::abs(slope), {triangle, slope < 0 ? 0 : 1, u, v}});
  }

  bool liesInOwnPlane(std::uint32_t triangle) const {
    const Plane& plane = scene_.plane_of_[own_];
    const auto& corners = scene_.all_.triangles[triangle];
    return std::ranges::all_of(corners, [&](std::uint32_t corner) {
      const Vec3 at = scene_.all_.vertices[corner] - scene_.middle_;
      return std::abs(glm::dot(plane.normal, at - plane.origin)) <= scene_.coincidence_;
    });
  }

  std::optional<End> first() {
    if (candidates_.empty()) return std::nullopt;
    std::ranges::sort(candidates_, [](const Candidate& a, const Candidate& b) {
      return std::tie(a.at, a.end.triangle) < std::tie(b.at, b.end.triangle);
    });
    const Candidate& nearest = candidates_[0];
    for (const Candidate& other : candidates_) {
      if ((other.at - nearest.at) * nearest.slope > scene_.coincidence_) break;
      if (other.end.side == 0) return other.end;
    }
    return nearest.end;
  }

  const EmbreeScene& scene_;
  glm::vec3 from_;
  glm::vec3 along_;
  Index own_;
  Vec3 leaves_;  ///< where it starts: in the plane of `own`, from_ elsewhere
  std::vector<Candidate> candidates_;
};

void EmbreeScene::trace(RTCRayHit16& packet, int lanes, Coherence coherence) const {
  alignas(64) std::array<int, kRayLanes> valid;
  for (int k = 0; k < kRayLanes; ++k) valid[std::size_t(k)] = k < lanes ? -1 : 0;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherence == Coherence::coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                                   : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  rtcIntersect16(valid.data(), scene_, &context, &packet);
}

EmbreeScene::End EmbreeScene::endAt(const RTCRayHit16& packet, int k, Index own) const {
  const glm::vec3 from(packet.ray.org_x[k], packet.ray.org_y[k], packet.ray.org_z[k]);
  const glm::vec3 along(packet.ray.dir_x[k], packet.ray.dir_y[k], packet.ray.dir_z[k]);
  const glm::vec3 normal(packet.hit.Ng_x[k], packet.hit.Ng_y[k], packet.hit.Ng_z[k]);
  return settled(
      from, along, packet.ray.tfar[k], normal,
      {packet.hit.primID[k], glm::dot(normal, along) < 0 ? 0 : 1, packet.hit.u[k], packet.hit.v[k]},
      own);
}

/// The true end of a ray that is found to end `at` along it, on a triangle of that normal.
EmbreeScene::End EmbreeScene::settled(const glm::vec3& from, const glm::vec3& along, float at,
                                      const glm::vec3& normal, const End& found, Index own) const {
  if (!isNear(found.triangle)) return found;
  const float length = settledLength(std::abs(glm::dot(normal, along)) / glm::length(normal));
  return Settling(*this, from, along, own).between(at - length, at + length).value_or(found);
}

std::optional<EmbreeScene::End> EmbreeScene::endBefore(const glm::vec3& from,
                                                       const glm::vec3& along, Index own) const {
  const double slope = glm::dot(plane_of_[own].normal, Vec3(along));
  const float length = settledLength(std::abs(float(slope)));
  return Settling(*this, from, along, own).between(-length, length);
}

std::optional<EmbreeScene::End> EmbreeScene::endBeyond(const glm::vec3& from,
                                                       const glm::vec3& along, Index own) const {
  WithoutOwn without{{}, source_of_, own};
  rtcInitIntersectContext(&without.embree);
  without.embree.filter = WithoutOwn::pass;
  RTCRayHit ray = rayAlone(from, along, 0, std::numeric_limits<float>::infinity());
  rtcIntersect1(scene_, &without.embree, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const glm::vec3 normal(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z);
  return settled(from, along, ray.ray.tfar, normal,
                 {ray.hit.primID, glm::dot(normal, along) < 0 ? 0 : 1, ray.hit.u, ray.hit.v}, own);
}

EmbreeScene::~EmbreeScene() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

FlushDenormals::FlushDenormals() : old_mode_(_mm_getcsr()) {
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
  _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
}

FlushDenormals::~FlushDenormals() { _mm_setcsr(old_mode_); }

}  // namespace radiosity
