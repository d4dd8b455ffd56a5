// The kernels of rays on every instruction set: the scalar target's bits, and the definitions.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "formfactor/rays/ray_caster.h"
#include "formfactor/rays/ray_kernels.h"
#include "support/mesh_builder.h"
#include "support/simd_targets.h"

namespace radiosity {
namespace {

constexpr std::size_t kRays = 512;

/// A tilted roof, a patch of three triangles, over a floor with a patch a cell and triangles that
/// share cells.
PatchMesh roofOverFloor() {
  test::MeshBuilder builder;
  builder.polygon("roof", {{{0, 0, 2}, {0, 1, 2.25}, {1, 2, 2.5}, {2, 1, 2.25}, {1.5, 0, 2}}});
  builder.grid("floor", {-4, -4, 0}, {4, 0, 0}, {0, 8, 0}, 3, 5);
  builder.polygon("floor", {{{0, -4, 0}, {4, -4, 0}, {4, 4, 0}, {0, 4, 0}}},
                  {{{0, -4, 0}, {4, -4, 0}, {0, 1, 0}},
                   {{4, -4, 0}, {4, 4, 0}, {0, 1, 0}},
                   {{4, 4, 0}, {0, 4, 0}, {0, 1, 0}}});
  return builder.build();
}

struct Rays {
  std::array<std::vector<float>, 4> points;
  std::vector<std::int32_t> part;
  std::array<std::vector<float>, 3> origin;
  std::array<std::vector<float>, 3> direction;
  std::vector<std::uint16_t> cell;

  /// Random points; parts by turns.
  explicit Rays(std::size_t parts) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0, 1);
    for (auto& values : points) {
      values.resize(kRays);
      for (float& x : values) x = std::min(unit(random), 1 - 0x1p-24F);
    }
    // The middle and the corners of the square.
    for (std::size_t k = 0; k < 5; ++k) {
      points[2][k] = k == 4 ? 0.5F : k % 2 == 0 ? 0.0F : 1 - 0x1p-24F;
      points[3][k] = k == 4 ? 0.5F : k / 2 == 0 ? 0.0F : 1 - 0x1p-24F;
    }
    part.resize(kRays);
    for (std::size_t k = 0; k < kRays; ++k) part[k] = std::int32_t(k % parts);
    for (auto* values : {&origin, &direction}) {
      for (auto& component : *values) component.resize(kRays);
    }
    cell.resize(kRays);
  }

  RayArrays arrays() {
    return {{points[0].data(), points[1].data(), points[2].data(), points[3].data()},
            part.data(),
            {origin[0].data(), origin[1].data(), origin[2].data()},
            {direction[0].data(), direction[1].data(), direction[2].data()},
            cell.data()};
  }
  Vec3 leaves(std::size_t k) const { return {origin[0][k], origin[1][k], origin[2][k]}; }
  Vec3 along(std::size_t k) const { return {direction[0][k], direction[1][k], direction[2][k]}; }
  bool operator==(const Rays& other) const {
    return origin == other.origin && direction == other.direction && cell == other.cell;
  }
};

template <class Check>
void forEveryTarget(const Check& check) {
  test::onEveryTarget([] { return rayKernels(); }, check);
}

class RayKernelsTest : public testing::Test {
 protected:
  PatchMesh mesh_ = roofOverFloor();
  RayCaster caster_{mesh_};
  ViewScene scene_{mesh_};
  EmbreeScene embree_{scene_, mesh_};
  RayTargets targets_{scene_, embree_};
  RayOrigins roof_ = caster_.origins(0);
  RayOrigins cell_ = caster_.origins(1);  // a parallelogram

  /// From the horizon up, in between, and to the zenith.
  static std::vector<DirectionWindow> someWindows() {
    return {{0, 0.3, 3, 0.1}, {0.4, 0.7, 1, 2.5}, {0.9, 1, 2, 2.5}};
  }

  /// Aimed rays of roof and floor by turns, sent by Embree. Lanes from `lanes` on are not traced.
  RTCRayHit16 packet(const RayKernels& kernels, Rays& rays, std::size_t first, int lanes) {
    std::array<std::uint16_t, kRayLanes> order;
    for (std::size_t k = 0; k < kRayLanes; ++k) {
      order[k] = std::uint16_t((first + 37 * k) % kRays);
    }
    RTCRayHit16 packet;
    initPacket(packet);
    kernels.fill(rays.arrays(), order.data(), packet);
    for (std::size_t k = 0; k < kRayLanes; ++k) {
      EXPECT_EQ(packet.ray.org_y[k], rays.origin[1][order[k]]);
      EXPECT_EQ(packet.ray.dir_z[k], rays.direction[2][order[k]]);
    }
    embree_.trace(packet, lanes);
    return packet;
  }
};

/// Rays are spread evenly over elevations' squared sines and azimuths.
TEST_F(RayKernelsTest, AimedRaysStayInTheirWindow) {
  for (const DirectionWindow& window : someWindows()) {
    RayOrigins aimed = roof_;
    const double range = window.high - window.low;
    EXPECT_NEAR(aimed.aim(window), range * window.half / std::numbers::pi, 1e-6);
    Rays rays(aimed.parts());
    rayKernels().aim(aimed, kRays, rays.arrays());
    const RayFrame& before = roof_.frame();  // azimuths of windows are those of its axes
    for (std::size_t k = 0; k < kRays; ++k) {
      const Vec3 along = rays.along(k);
      EXPECT_NEAR(glm::length(along), 1, 5e-7);
      const double height = glm::dot(along, Vec3(before.z));
      const double turn = std::remainder(
          std::atan2(glm::dot(along, Vec3(before.y)), glm::dot(along, Vec3(before.x))) -
              window.centre,
          2 * std::numbers::pi);
      EXPECT_NEAR(height * height, window.low + range * double(rays.points[2][k]), 1e-6);
      // Next to the normal the azimuth is nothing that single precision knows.
      EXPECT_NEAR(turn, window.half * (2 * double(rays.points[3][k]) - 1),
                  1e-6 / std::sqrt(std::max(1e-9, 1 - height * height)));
    }
  }
}

TEST_F(RayKernelsTest, CoherentAndIncoherentPacketsEndOnTheSameTriangles) {
  Rays rays(roof_.parts());
  rayKernels().aim(roof_, kRays, rays.arrays());
  std::size_t hits = 0;
  for (std::size_t first = 0; first < kRays; first += kRayLanes) {
    RTCRayHit16 together = packet(rayKernels(), rays, first, kRayLanes);
    RTCRayHit16 alone = together;
    for (int k = 0; k < kRayLanes; ++k) {
      alone.ray.tfar[k] = std::numeric_limits<float>::infinity();
      alone.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    }
    embree_.trace(alone, kRayLanes, Coherence::incoherent);
    for (int k = 0; k < kRayLanes; ++k) {
      ASSERT_EQ(together.hit.geomID[k], alone.hit.geomID[k]);
      if (together.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
      EXPECT_EQ(together.hit.primID[k], alone.hit.primID[k]);
      ++hits;
    }
  }
  EXPECT_GT(hits, kRays / 4);
}

TEST_F(RayKernelsTest, EveryInstructionSetGivesTheSameBits) {
  struct Sample {
    std::vector<float> scrambled = std::vector<float>(kRays + 1, -1.0F);
    std::array<std::vector<float>, 2> disc = {std::vector<float>(kRays), std::vector<float>(kRays)};
    Rays roof;
    Rays cell;
    Rays aimed;
    std::vector<std::uint32_t> items = {};
    std::vector<float> places = {};
  };
  std::vector<std::uint32_t> first(kRays);
  std::mt19937 random(3);
  for (std::uint32_t& bits : first) bits = std::uint32_t(random());
  RayOrigins aimed = roof_;
  aimed.aim(someWindows()[1]);
  std::unique_ptr<Sample> scalar;
  std::vector<std::unique_ptr<Sample>> samples;
  forEveryTarget([&](const RayKernels& kernels) {
    auto sample = std::make_unique<Sample>(
        Sample{.roof = Rays(roof_.parts()), .cell = Rays(1), .aimed = Rays(roof_.parts())});
    kernels.scramble(first.data(), kRays - 3, 0x12345u, 99, sample->scrambled.data());
    kernels.toDisc(sample->roof.points[2].data(), sample->roof.points[3].data(), kRays,
                   sample->disc[0].data(), sample->disc[1].data());
    kernels.aim(roof_, kRays, sample->roof.arrays());
    kernels.aim(cell_, kRays, sample->cell.arrays());
    kernels.aim(aimed, kRays, sample->aimed.arrays());
    for (Rays* rays : {&sample->roof, &sample->cell}) {
      for (std::size_t k = 0; k < kRays; k += kRayLanes) {
        const int lanes = kRayLanes - int(k / kRayLanes % 3);
        const RTCRayHit16 hit = packet(kernels, *rays, k, lanes);
        RayEnds ends;
        kernels.find(hit, targets_, ends);
        for (std::size_t lane = 0; lane < kRayLanes; ++lane) {
          if (hit.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
          sample->items.push_back(targets_.itemOf(ends, lane));
          sample->places.insert(sample->places.end(), {ends.u[lane], ends.v[lane]});
        }
      }
    }
    if (kernels.target == test::scalarTarget()) {
      scalar = std::move(sample);
    } else {
      samples.push_back(std::move(sample));
    }
  });
  ASSERT_NE(scalar, nullptr);
  EXPECT_GT(scalar->items.size(), kRays / 4);  // most rays of the roof end on the floor
  for (const auto& sample : samples) {
    EXPECT_EQ(sample->scrambled, scalar->scrambled);
    EXPECT_EQ(sample->disc, scalar->disc);
    EXPECT_TRUE(sample->roof == scalar->roof);
    EXPECT_TRUE(sample->cell == scalar->cell);
    EXPECT_TRUE(sample->aimed == scalar->aimed);
    EXPECT_EQ(sample->items, scalar->items);
    EXPECT_EQ(sample->places, scalar->places);
  }
}

TEST_F(RayKernelsTest, ScramblingWritesNoFurtherThanAsked) {
  const std::vector<std::uint32_t> first(2 * kRayLanes, 1u);
  forEveryTarget([&](const RayKernels& kernels) {
    for (std::size_t count = 0; count <= kRayLanes + 1; ++count) {
      std::vector<float> out(2 * kRayLanes, -1.0F);
      kernels.scramble(first.data(), count, 0, 5, out.data());
      for (std::size_t k = 0; k < out.size(); ++k) EXPECT_EQ(out[k] >= 0, k < count) << k;
    }
  });
}

/// The concentric map in double precision, by its definition: squares around the middle become
/// circles, and angles go evenly along their sides.
TEST_F(RayKernelsTest, SquareGoesToDiscByTheConcentricMap) {
  forEveryTarget([&](const RayKernels& kernels) {
    Rays rays(1);
    std::vector<float> u(kRays);
    std::vector<float> v(kRays);
    kernels.toDisc(rays.points[2].data(), rays.points[3].data(), kRays, u.data(), v.data());
    for (std::size_t k = 0; k < kRays; ++k) {
      const double a = 2.0 * double(rays.points[2][k]) - 1;
      const double b = 2.0 * double(rays.points[3][k]) - 1;
      const double radius = std::max(std::abs(a), std::abs(b));
      double angle = 0;
      if (std::abs(a) > std::abs(b)) {
        angle = std::numbers::pi / 4 * b / a + (a < 0 ? std::numbers::pi : 0);
      } else if (b != 0) {
        angle =
            std::numbers::pi / 2 - std::numbers::pi / 4 * a / b + (b < 0 ? std::numbers::pi : 0);
      }
      // Some roundings of single precision, and 1e-7 of the series.
      EXPECT_NEAR(u[k], radius * std::cos(angle), 5e-7) << k;
      EXPECT_NEAR(v[k], radius * std::sin(angle), 5e-7) << k;
    }
  });
}

TEST_F(RayKernelsTest, RaysLeaveTheirPartsByTheirFrame) {
  forEveryTarget([&](const RayKernels& kernels) {
    for (const RayOrigins& origins : {roof_, cell_}) {
      Rays rays(origins.parts());
      kernels.aim(origins, kRays, rays.arrays());
      std::vector<float> u(kRays);
      std::vector<float> v(kRays);
      kernels.toDisc(rays.points[2].data(), rays.points[3].data(), kRays, u.data(), v.data());
      const RayFrame& frame = origins.frame();
      for (std::size_t k = 0; k < kRays; ++k) {
        const RayOrigins::Part& part = origins.part(std::uint32_t(rays.part[k]));
        const double x = part.parallelogram != 0 ? double(rays.points[0][k])
                                                 : std::sqrt(double(rays.points[0][k]));
        const double y = double(rays.points[1][k]);
        const Vec3 on_part =
            part.parallelogram != 0
                ? Vec3(part.corner) + x * Vec3(part.ab) + y * Vec3(part.ac)
                : Vec3(part.corner) + x * (1 - y) * Vec3(part.ab) + x * y * Vec3(part.ac);
        const Vec3 above = rays.leaves(k) - on_part;
        // Roundings of single precision, in a scene of size 1.
        EXPECT_LT(glm::length(above - double(kRayLift) * Vec3(frame.z)), 3e-7) << k;
        const double w = std::sqrt(std::max(0.0, 1 - double(u[k]) * u[k] - double(v[k]) * v[k]));
        const Vec3 along =
            double(u[k]) * Vec3(frame.x) + double(v[k]) * Vec3(frame.y) + w * Vec3(frame.z);
        EXPECT_LT(glm::length(rays.along(k) - along), 1e-3)
            << k;  // at the horizon w is a root of 1e-7
        EXPECT_NEAR(glm::length(rays.along(k)), 1, 1e-6) << k;
        EXPECT_LT(rays.cell[k], kDirectionCells * kDirectionCells) << k;
      }
    }
  });
}

/// By the patches' corners, without grids.
TEST_F(RayKernelsTest, HitsAreFoundOnThePatchAroundThem) {
  const auto holds = [&](Index patch, const Vec3& at) {
    const auto outline = mesh_.outline(patch);
    for (std::size_t c = 0; c < outline.size(); ++c) {
      const Vec3 a = mesh_.vertices[outline[c]];
      const Vec3 b = mesh_.vertices[outline[(c + 1) % outline.size()]];
      const double inside = glm::dot(glm::cross(b - a, at - a), mesh_.normal[patch]);
      if (inside < -1e-5) return false;  // single precision in a scene of 8 m
    }
    return true;
  };
  forEveryTarget([&](const RayKernels& kernels) {
    Rays rays(roof_.parts());
    kernels.aim(roof_, kRays, rays.arrays());
    std::size_t found = 0;
    for (std::size_t k = 0; k < kRays; k += kRayLanes) {
      const RTCRayHit16 hit = packet(kernels, rays, k, kRayLanes);
      RayEnds ends;
      kernels.find(hit, targets_, ends);
      for (std::size_t lane = 0; lane < kRayLanes; ++lane) {
        if (hit.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
        const std::uint32_t item = targets_.itemOf(ends, lane);
        const Vec3 from(hit.ray.org_x[lane], hit.ray.org_y[lane], hit.ray.org_z[lane]);
        const Vec3 along(hit.ray.dir_x[lane], hit.ray.dir_y[lane], hit.ray.dir_z[lane]);
        const Vec3 at =
            (from + double(hit.ray.tfar[lane]) * along + embree_.middle()) / scene_.scale;
        if (item >= mesh_.size()) {
          EXPECT_GT(at.z, 1.9) << "a black back that is not the roof's";
          continue;
        }
        EXPECT_TRUE(holds(item, at)) << item << " at " << at.x << ", " << at.y << ", " << at.z;
        EXPECT_EQ(ends.polygon[lane], mesh_.polygon[item]);
        ++found;
      }
    }
    EXPECT_GT(found, kRays / 2);
  });
}

}  // namespace
}  // namespace radiosity
