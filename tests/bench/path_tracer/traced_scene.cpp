#include "path_tracer/traced_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace radiosity::bench {
namespace {

/// Of the scene's diagonal; coordinates in single precision are good to a hundredth of that.
constexpr double kLift = 1e-5;

double areaOf(const TracedTriangle& t) {
  return 0.5 * glm::length(glm::cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]));
}

double sumOf(const Vec3& v) { return v.x + v.y + v.z; }

TracedSide sideOf(const PatchMaterials& materials, Index patch) {
  const double* rho = materials.reflectance.data() + 3 * std::size_t(patch);
  const double* light = materials.emission.data() + 3 * std::size_t(patch);
  return {false, {rho[0], rho[1], rho[2]}, {light[0], light[1], light[2]}};
}

/// At every entry of mesh.corners the mean of the normals, by area, of facets that meet smoothly.
std::vector<Vec3> cornerNormals(const PatchMesh& mesh, double crease) {
  std::vector<Vec3> normals(mesh.corners.size());
  const CornerGroups groups = cornerGroups(mesh, crease);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    Vec3 sum(0.0);
    for (const Index i : groups.patchesOf(g)) sum += mesh.area[i] * mesh.normal[i];
    for (const std::size_t corner : groups.cornersOf(g)) normals[corner] = sum;
  }
  return normals;
}

}  // namespace

TracedScene::TracedScene(const PatchMesh& mesh, const PatchMaterials& materials, double crease) {
  const std::vector<Vec3> normals = cornerNormals(mesh, crease);
  for (Index i = 0; i < mesh.size(); ++i) {
    if (mesh.side[i] != 0 || !(mesh.area[i] > 0)) continue;
    const auto outline = mesh.outline(i);
    for (std::size_t p = mesh.piece_offset[i]; p < mesh.piece_offset[i + 1]; ++p) {
      TracedTriangle t;
      t.normal = mesh.normal[i];
      for (std::size_t k = 0; k < 3; ++k) {
        const Index v = mesh.pieces[p][k];
        t.corner[k] = mesh.vertices[v];
        t.corner_normal[k] = mesh.normal[i];
        const auto at = std::find(outline.begin(), outline.end(), v);
        if (at == outline.end()) continue;
        const Vec3 mean = normals[mesh.corner_offset[i] + std::size_t(at - outline.begin())];
        // Facets of one plane differ by rounding alone.
        constexpr double kPlanar = 1e-6;
        if (!(glm::length(mean) > 0) || glm::distance(glm::normalize(mean), t.normal) < kPlanar) {
          continue;
        }
        t.corner_normal[k] = glm::normalize(mean);
        t.smooth = true;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        t.longest_edge =
            std::max(t.longest_edge, glm::distance(t.corner[k], t.corner[(k + 1) % 3]));
      }
      t.side[0] = sideOf(materials, i);
      if (mesh.twin[i] != kNone) t.side[1] = sideOf(materials, mesh.twin[i]);
      triangles_.push_back(t);
    }
  }
  sky_ = Background(materials.lights, 3);
  whole_sky_ = Background(materials.lights, 3, true);
  lamps_ = aimedLights(materials.lights);
  findLights();
  build();
}

TracedScene::~TracedScene() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void TracedScene::findLights() {
  double sum = 0;
  for (Index t = 0; t < triangles_.size(); ++t) {
    for (int s = 0; s < 2; ++s) {
      const double power = sumOf(triangles_[t].side[s].emission) * areaOf(triangles_[t]);
      if (power > 0) shining_.push_back({t, s, sum += power});
    }
  }
  for (const Shining& one : shining_) {
    TracedSide& side = triangles_[one.triangle].side[one.side];
    side.aim = sumOf(side.emission) / sum;
  }
  for (Shining& one : shining_) one.end /= sum;
}

void TracedScene::build() {
  Vec3 lower(std::numeric_limits<double>::infinity());
  Vec3 upper = -lower;
  for (const TracedTriangle& t : triangles_) {
    for (const Vec3& c : t.corner) {
      lower = glm::min(lower, c);
      upper = glm::max(upper, c);
    }
  }
  middle_ = 0.5 * (lower + upper);
  lift_ = kLift * glm::distance(lower, upper);
  beyond_ = 2 * glm::distance(lower, upper);
  device_ = rtcNewDevice(nullptr);
  if (device_ == nullptr) throw RunError("Embree cannot be started on this processor");
  scene_ = rtcNewScene(device_);
  const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               3 * triangles_.size()));
  auto* corners = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), triangles_.size()));
  std::uint32_t next = 0;
  for (const TracedTriangle& t : triangles_) {
    for (const Vec3& c : t.corner) {
      const glm::vec3 at = place(c);
      for (int k = 0; k < 3; ++k) *vertices++ = at[k];
      *corners++ = next++;
    }
  }
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  rtcCommitScene(scene_);
}

TracedHit TracedScene::hit(const Vec3& from, const Vec3& direction, double start,
                           bool through_backs) const {
  TracedHit found;
  for (;;) {
    RTCRayHit ray{};
    const glm::vec3 origin = place(from);
    ray.ray.org_x = origin.x;
    ray.ray.org_y = origin.y;
    ray.ray.org_z = origin.z;
    ray.ray.dir_x = float(direction.x);
    ray.ray.dir_y = float(direction.y);
    ray.ray.dir_z = float(direction.z);
    ray.ray.tnear = float(start);
    ray.ray.tfar = std::numeric_limits<float>::infinity();
    ray.ray.mask = 0xffffffffu;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_, &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return found;
    const TracedTriangle& t = triangles_[ray.hit.primID];
    const int side = glm::dot(t.normal, direction) < 0 ? 0 : 1;
    if (through_backs && t.side[side].black) {
      start = double(ray.ray.tfar) + lift_;
      continue;
    }
    const double u = double(ray.hit.u);
    const double v = double(ray.hit.v);
    const double sign = side == 0 ? 1 : -1;
    found.triangle = ray.hit.primID;
    found.side = side;
    found.at = (1 - u - v) * t.corner[0] + u * t.corner[1] + v * t.corner[2];
    found.normal = sign * t.normal;
    found.smooth_normal =
        t.smooth ? sign * glm::normalize((1 - u - v) * t.corner_normal[0] + u * t.corner_normal[1] +
                                         v * t.corner_normal[2])
                 : found.normal;
    return found;
  }
}

bool TracedScene::sees(const Vec3& from, const Vec3& to, double start) const {
  const Vec3 along = to - from;
  const double length = glm::length(along);
  if (!(length > start + lift_)) return true;
  const glm::vec3 origin = place(from);
  RTCRay ray{};
  ray.org_x = origin.x;
  ray.org_y = origin.y;
  ray.org_z = origin.z;
  ray.dir_x = float(along.x / length);
  ray.dir_y = float(along.y / length);
  ray.dir_z = float(along.z / length);
  ray.tnear = float(start);
  ray.tfar = float(length);
  ray.mask = 0xffffffffu;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene_, &context, &ray);
  return ray.tfar >= 0;
}

LightSample TracedScene::light(double choice, const Vec2& place) const {
  auto one = std::lower_bound(shining_.begin(), shining_.end(), choice,
                              [](const Shining& s, double x) { return s.end < x; });
  if (one == shining_.end()) --one;
  const TracedTriangle& t = triangles_[one->triangle];
  const double root = std::sqrt(place.x);
  const double b = root * (1 - place.y);
  const double c = root * place.y;
  LightSample sample;
  sample.at = (1 - b - c) * t.corner[0] + b * t.corner[1] + c * t.corner[2];
  sample.normal = one->side == 0 ? t.normal : -t.normal;
  sample.side = &t.side[one->side];
  return sample;
}

}  // namespace radiosity::bench
