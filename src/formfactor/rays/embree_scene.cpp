#include "formfactor/rays/embree_scene.h"

#include <pmmintrin.h>
#include <tbb/task_arena.h>
#include <xmmintrin.h>

#include <algorithm>
#include <optional>

#include "base/geometry/box.h"
#include "base/parallel.h"
#include "radiosity/base.h"

namespace radiosity {
namespace {

/// Of two hits no farther apart than this, in scenes of size 1, single precision cannot tell which
/// is first.
constexpr float kTie = 2e-6F;

/// An intersection filter of a single ray.
void refuseBacks(const RTCFilterFunctionNArguments* hit) {
  const float along = RTCHitN_Ng_x(hit->hit, 1, 0) * RTCRayN_dir_x(hit->ray, 1, 0) +
                      RTCHitN_Ng_y(hit->hit, 1, 0) * RTCRayN_dir_y(hit->ray, 1, 0) +
                      RTCHitN_Ng_z(hit->hit, 1, 0) * RTCRayN_dir_z(hit->ray, 1, 0);
  if (along >= 0) hit->valid[0] = 0;
}

RTCDevice newDevice() {
  const RTCDevice device = rtcNewDevice(nullptr);
  if (device == nullptr) throw RunError("rays: Embree cannot be started on this processor");
  return device;
}

}  // namespace

EmbreeScene::EmbreeScene(const ViewScene& scene, const PatchMesh& mesh)
    : middle_(boxOf(scene.vertices).centre()),
      device_(newDevice()),
      scene_(rtcNewScene(device_)),
      vertices_(scene.vertices) {
  std::vector<std::optional<std::vector<Triangle>>> of_polygon(scene.polygons.size());
  parallelFor(of_polygon.size(), 64,
              [&](std::size_t p) { of_polygon[p] = scene.trianglesOf(scene.polygons[p]); });
  std::vector<Index> without_triangles;
  for (Index p = 0; p < of_polygon.size(); ++p) {
    if (!of_polygon[p]) {
      without_triangles.push_back(p);
      continue;
    }
    triangles_.insert(triangles_.end(), of_polygon[p]->begin(), of_polygon[p]->end());
    polygon_of_.insert(polygon_of_.end(), of_polygon[p]->size(), p);
  }
  if (!without_triangles.empty()) addTiles(scene, mesh, without_triangles);
  const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices_.size()));
  for (const Vec3& v : vertices_) {
    const glm::vec3 at = place(v);
    for (int c = 0; c < 3; ++c) *vertices++ = at[c];
  }
  auto* corners = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), triangles_.size()));
  for (const auto& triangle : triangles_) {
    for (const std::uint32_t corner : triangle) *corners++ = corner;
  }
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  // One thread builds the tree: it then is the same in every run, and with it which of two
  // triangles a ray through their common edge ends on. (A device with one thread would leave the
  // whole process one.)
  tbb::task_arena(1).execute([&] { rtcCommitScene(scene_); });
}

void EmbreeScene::addTiles(const ViewScene& scene, const PatchMesh& mesh,
                           const std::vector<Index>& without_triangles) {
  std::vector<Index> place(mesh.polygons.size(), kNone);  // of those without triangles
  for (const Index p : without_triangles) place[scene.polygons[p].source] = p;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    // A back has the tiles of its front.
    const Index polygon = mesh.polygon[i];
    if (polygon == kNone || place[polygon] == kNone || mesh.side[i] != 0) continue;
    for (std::size_t t = mesh.piece_offset[i]; t < mesh.piece_offset[i + 1]; ++t) {
      const auto first = std::uint32_t(vertices_.size());
      for (const Index v : mesh.pieces[t]) vertices_.push_back(mesh.vertices[v] * scene.scale);
      triangles_.push_back({first, first + 1, first + 2});
      polygon_of_.push_back(place[polygon]);
    }
  }
}

void EmbreeScene::trace(RTCRayHit16& packet, int lanes) const {
  alignas(64) std::array<int, kRayLanes> valid;
  for (int k = 0; k < kRayLanes; ++k) valid[std::size_t(k)] = k < lanes ? -1 : 0;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
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
  ray.ray.tnear = std::max(0.0F, packet.ray.tfar[k] - kTie);
  ray.ray.tfar = packet.ray.tfar[k] + kTie;
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
