#include "embree_scene.h"

#include <fmt/format.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

namespace radiosity::bench {

EmbreeScene::EmbreeScene(const ViewScene& scene)
    : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
  for (Index p = 0; p < scene.polygons.size(); ++p) {
    const auto triangles = scene.trianglesOf(scene.polygons[p]);
    if (!triangles) throw InputError(fmt::format("polygon {}: its loops cross", p));
    for (const auto& triangle : *triangles) {
      triangles_.push_back(triangle);
      polygon_of_.push_back(p);
    }
  }
  const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               scene.vertices.size()));
  for (const Vec3& v : scene.vertices) {
    *vertices++ = float(v.x);
    *vertices++ = float(v.y);
    *vertices++ = float(v.z);
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
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  rtcCommitScene(scene_);
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

}  // namespace radiosity::bench
