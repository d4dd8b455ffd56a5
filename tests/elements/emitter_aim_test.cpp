// Rays aimed at emitters: their places and weights, and the light that they find.
#include "elements/emitter_aim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "radiosity/elements.h"
#include "support/scene_builder.h"
#include "visibility/clipping/flat_polygon.h"
#include "visibility/clipping/point_to_polygon.h"

namespace radiosity {
namespace {

using test::SceneBuilder;

/// Facing down from z = 0.
Emitter emitterOf(const std::vector<Vec3>& outline) {
  Emitter emitter;
  emitter.outline = outline;
  emitter.normal = {0, 0, -1};
  Vec3 area(0.0);
  for (std::size_t k = 1; k + 1 < outline.size(); ++k) {
    area += 0.5 * glm::cross(outline[k] - outline[0], outline[k + 1] - outline[0]);
  }
  emitter.area = glm::length(area);
  return emitter;
}

/// Over a fine grid of the unit square: the mean of the form factors, and their standard deviation
/// over it.
struct Spread {
  double mean = 0;
  double deviation = 0;
};

Spread spreadOf(const EmitterAim& aim) {
  constexpr int kSide = 512;
  double sum = 0;
  double squares = 0;
  for (int r = 0; r < kSide; ++r) {
    for (int c = 0; c < kSide; ++c) {
      const double factor = aim.at((c + 0.5) / kSide, (r + 0.5) / kSide).factor;
      sum += factor;
      squares += factor * factor;
    }
  }
  const double count = double(kSide) * kSide;
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean)) / mean};
}

const Emitter kRectangle = emitterOf({{0, 0, 0}, {0, 2, 0}, {3, 2, 0}, {3, 0, 0}});
const Emitter kTrapezoid = emitterOf({{0, 0, 0}, {1, 2, 0}, {2, 2, 0}, {3, 0, 0}});
const Emitter kTriangle = emitterOf({{0, 0, 0}, {0, 2, 0}, {3, 0, 0}});

/// By the midpoint rule, whose error is that of the steps at the horizon, a row of the grid.
TEST(EmitterAim, TheMeanOfAllRaysIsTheFormFactor) {
  const std::vector<std::pair<Vec3, Vec3>> eyes{
      {{1, 1, -2}, {0, 0, 1}},          // below the middle
      {{-40, 10, -30}, {0.6, 0, 0.8}},  // far
      {{1, 1, -0.2}, {0, 0, 1}},        // near
      {{-0.5, 1, -0.3}, {1, 0, 0}},     // on a wall beside it
      {{1, 1, -0.5}, {1, 0, 0}},        // half of it behind the horizon
      {{2.9, 0.1, -0.05}, {0, 0.8, 0.6}}};
  for (const Emitter* emitter : {&kRectangle, &kTrapezoid, &kTriangle}) {
    for (const auto& [eye, normal] : eyes) {
      const FlatPolygon target = clipToFront(emitter->outline, normal, glm::dot(normal, eye));
      const double truth = pointToPolygon(eye, normal, target.outline());
      for (const bool even : {true, false}) {
        EXPECT_NEAR(spreadOf(EmitterAim(*emitter, eye, normal, even)).mean, truth, 0.005 * truth)
            << eye.x << " " << eye.y << " " << eye.z << " even " << even;
      }
    }
  }
}

TEST(EmitterAim, RaysToANearEmitterStandForMoreEvenLight) {
  for (const Emitter* emitter : {&kRectangle, &kTrapezoid, &kTriangle}) {
    const Vec3 eye{-0.5, 1, -0.3};
    const double even = spreadOf(EmitterAim(*emitter, eye, {1, 0, 0}, true)).deviation;
    const double aimed = spreadOf(EmitterAim(*emitter, eye, {1, 0, 0}, false)).deviation;
    EXPECT_GT(even, 1.0);
    EXPECT_LT(aimed, 0.5);
  }
}

/// A lamp is covered on the side of a wall beside it, and too much is in between for clipping. The
/// covered half would bring most of the light. The 256 rays miss about 256^-0.75 = 1.6% of the
/// light of the whole lamp, of which the open half has 17%: within 10%.
TEST(EmitterAim, APartlyCoveredLampBesideAWallShinesByItsOpenPart) {
  SceneBuilder builder;
  const Index wall = builder.surface("wall", 0.0);
  const Index dust = builder.surface("dust", 0.0);
  builder.face(wall, std::vector<Vec3>{{-0.5, 0, -2}, {-0.5, 2, -2}, {-0.5, 2, 0}, {-0.5, 0, 0}});
  builder.level(builder.surface("lamp", 0.0, 1.0), 0, 0, 2, 2, 0, false);
  builder.level(builder.surface("cover", 0.0), 0, 0, 1, 2, -0.001, false);
  for (int k = 0; k < 400; ++k) {
    const int row = k / 20;
    const Vec3 corner{0.1 + 0.04 * (k % 20), 0.5 + 0.05 * row, -0.6};
    builder.box(dust, corner, corner + Vec3(0.001));
  }
  Progress quiet;
  const Scene scene = builder.scene();
  const PatchMesh mesh = meshScene(scene, {.patches = 3000}, quiet).mesh;
  const PatchMaterials materials = patchMaterials(scene, mesh);
  const std::vector<double> dark(mesh.size() * std::size_t(materials.bands), 0.0);
  const LightAtPoints light(mesh, materials, dark, {}, {}, quiet);
  const std::vector<Vec3> open{{1, 0, 0}, {1, 2, 0}, {2, 2, 0}, {2, 0, 0}};
  std::size_t tried = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Vec3& at = mesh.centroid[i];
    if (mesh.normal[i].x < 0.9 || at.x > -0.4 || at.z < -1 || at.z > -0.2) continue;
    const double truth = pointToPolygon(at, mesh.normal[i], open);
    std::vector<double> sum(std::size_t(materials.bands), 0.0);
    light.add(light.roots().of_patch[i], at, LightAtPoints::kFewestRays, sum);
    EXPECT_NEAR(sum[0], truth, 0.1 * truth) << at.y << " " << at.z;
    ++tried;
  }
  EXPECT_GT(tried, 20u);
  EXPECT_GT(light.report().direct_by_rays, 0u);
}

}  // namespace
}  // namespace radiosity
