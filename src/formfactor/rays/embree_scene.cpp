#include "formfactor/rays/embree_scene.h"

#include <pmmintrin.h>
#include <tbb/task_arena.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/geometry/box.h"
#include "radiosity/base.h"

namespace radiosity {
namespace {

/// Two planes no farther apart than rays start before theirs are one to rays that leave, so they
/// are one to rays that arrive, or a pair would see each other from one end alone.
constexpr float kTie = kRayLift;
/// Of a ray between the planes, at most: where it runs along them.
constexpr float kLongestTie = 2e-5F;

/// An intersection filter for a single ray.
void refuseBacks(const RTCFilterFunctionNArguments* hit) {
  const float along = RTCHitN_Ng_x(hit->hit, 1, 0) * RTCRayN_dir_x(hit->ray, 1, 0) +
                      RTCHitN_Ng_y(hit->hit, 1, 0) * RTCRayN_dir_y(hit->ray, 1, 0) +
                      RTCHitN_Ng_z(hit->hit, 1, 0) * RTCRayN_dir_z(hit->ray, 1, 0);
  if (along >= 0) hit->valid[0] = 0;
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
      all_(scene, mesh) {
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
}

void EmbreeScene::trace(RTCRayHit16& packet, int lanes, Coherence coherence) const {
  alignas(64) std::array<int, kRayLanes> valid;
  for (int k = 0; k < kRayLanes; ++k) valid[std::size_t(k)] = k < lanes ? -1 : 0;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherence == Coherence::coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                                   : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  rtcIntersect16(valid.data(), scene_, &context, &packet);
}

RTCHit EmbreeScene::frontAt(const RTCRayHit16& packet, int k) const {
  RTCRayHit ray{};
  ray.ray.org_x = packet.ray.org_x[k];
  ray.ray.org_y = packet.ray.org_y[k];
  ray.ray.org_z = packet.ray.org_z[k];
  ray.ray.dir_x = packet.ray.dir_x[k];
  ray.ray.dir_y = packet.ray.dir_y[k];
  ray.ray.dir_z = packet.ray.dir_z[k];
  const glm::vec3 normal(packet.hit.Ng_x[k], packet.hit.Ng_y[k], packet.hit.Ng_z[k]);
  const glm::vec3 along(ray.ray.dir_x, ray.ray.dir_y, ray.ray.dir_z);
  const float across = std::abs(glm::dot(normal, along)) / glm::length(normal);
  const float tie = across * kLongestTie > kTie ? kTie / across : kLongestTie;
  ray.ray.tnear = std::max(0.0F, packet.ray.tfar[k] - tie);
  ray.ray.tfar = packet.ray.tfar[k] + tie;
  ray.ray.mask = 0xffffffffu;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.filter = refuseBacks;
  rtcIntersect1(scene_, &context, &ray);
  return ray.hit;
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
