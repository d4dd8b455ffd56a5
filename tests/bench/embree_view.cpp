#include "embree_view.h"

#include <array>
#include <glm/vec3.hpp>
#include <limits>

namespace radiosity::bench {
namespace {

constexpr int kTile = 4;
constexpr int kLanes = kTile * kTile;
/// Rays start this far out, in scenes of size 1, so as not to hit the eye's own polygon.
constexpr float kNear = 1e-5F;

/// Axis, right and up of a face in the eye's frame.
std::array<Vec3, 3> faceAxes(int face) {
  switch (face) {
    case 0:
      return {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    case 1:
      return {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    case 2:
      return {Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1)};
    case 3:
      return {Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)};
    default:
      return {Vec3(0, -1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)};
  }
}

}  // namespace

EmbreeView::EmbreeView(const ViewScene& scene, const PatchMesh& mesh) : scene_(scene, mesh) {}

const std::vector<std::uint32_t>& EmbreeView::trace(const EyeFrame& frame, int resolution) {
  const FlushDenormals flush;
  const std::size_t pixels = std::size_t(resolution) * std::size_t(resolution);
  seen_.resize(3 * pixels);
  traceFace(frame, 0, resolution, seen_.data());
  for (std::size_t face = 1; face < 5; ++face) {
    traceFace(frame, int(face), resolution, seen_.data() + pixels + (face - 1) * pixels / 2);
  }
  return seen_;
}

void EmbreeView::traceFace(const EyeFrame& frame, int face, int resolution, std::uint32_t* out) {
  const auto axes = faceAxes(face);
  const glm::vec3 forward(frame.axes * axes[0]);
  const glm::vec3 right(frame.axes * axes[1]);
  const glm::vec3 up(frame.axes * axes[2]);
  const glm::vec3 eye = scene_.place(frame.eye);
  const int rows = face == 0 ? resolution : resolution / 2;
  const float size = 2.0F / float(resolution);
  const float bottom = face == 0 ? -1.0F : 0.0F;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) int valid[kLanes];
  for (int& v : valid) v = -1;
  RTCRayHit16 packet;
  for (int y0 = 0; y0 < rows; y0 += kTile) {
    for (int x0 = 0; x0 < resolution; x0 += kTile) {
      for (int k = 0; k < kLanes; ++k) {
        const float x = (float(x0 + k % kTile) + 0.5F) * size - 1.0F;
        const float y = (float(y0 + k / kTile) + 0.5F) * size + bottom;
        packet.ray.org_x[k] = eye.x;
        packet.ray.org_y[k] = eye.y;
        packet.ray.org_z[k] = eye.z;
        packet.ray.tnear[k] = kNear;
        packet.ray.dir_x[k] = forward.x + x * right.x + y * up.x;
        packet.ray.dir_y[k] = forward.y + x * right.y + y * up.y;
        packet.ray.dir_z[k] = forward.z + x * right.z + y * up.z;
        packet.ray.time[k] = 0;
        packet.ray.tfar[k] = std::numeric_limits<float>::infinity();
        packet.ray.mask[k] = 0xffffffffu;
        packet.ray.flags[k] = 0;
        packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
      }
      rtcIntersect16(valid, scene_.handle(), &context, &packet);
      for (int k = 0; k < kLanes; ++k) {
        const bool hit = packet.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
        out[(y0 + k / kTile) * resolution + x0 + k % kTile] =
            hit ? scene_.polygonOf()[packet.hit.primID[k]] : kNone;
      }
    }
  }
}

}  // namespace radiosity::bench
