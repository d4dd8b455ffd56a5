// A sunlit crater: light and heat on the same form factors, against a closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "radiosity/heat.h"
#include "radiosity/light.h"
#include "radiosity/solve.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

constexpr double kHalfAngle = 40;   // degrees, from the axis to the rim, as the centre sees it
constexpr double kElevation = 15;   // degrees, of the sun
constexpr double kSunlight = 1000;  // W/m^2, of what faces it
constexpr double kAlbedo = 0.3;     // of sunlight
constexpr double kEmissivity = 0.99;

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// Kelvin, of all that no sun reaches. A patch of a sphere sees every other one of the same area
/// alike: what falls on it in a bowl is the same everywhere, and so is the temperature of the
/// shadow (Ingersoll, Svitek & Murray, "Stability of polar frosts in spherical bowl-shaped craters
/// on the Moon, Mercury, and Mars", Icarus 100, 1992).
double shadowTemperature() {
  const double seen = (1 - std::cos(radians(kHalfAngle))) / 2;  // of a patch's view
  const double level = kSunlight * std::sin(radians(kElevation));
  const double scattered = seen * kAlbedo * level * (1 - seen) / (1 - kAlbedo * seen);
  const double given_off = (1 - kAlbedo) * (level * (1 - seen) + scattered) / (1 - seen);
  const double emitted = seen * given_off + (1 - kAlbedo) * scattered / kEmissivity;
  return std::pow(emitted / kStefanBoltzmann, 0.25);
}

/// A bowl of triangles with corners on the sphere: `rings` of them from the bottom to the rim.
Scene bowl(int rings) {
  test::SceneBuilder builder;
  const Index surface = builder.surface("bowl", kAlbedo);
  const auto at = [&](int ring, double turn) {
    const double angle = radians(kHalfAngle) * ring / rings;
    return Vec3(std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn),
                -std::cos(angle));
  };
  const int sectors = 4 * rings;
  for (int ring = 0; ring < rings; ++ring) {
    for (int k = 0; k < sectors; ++k) {
      const double from = 2 * std::numbers::pi * k / sectors;
      const double to = 2 * std::numbers::pi * (k + 1) / sectors;
      if (ring > 0) builder.face(surface, {at(ring, from), at(ring + 1, to), at(ring, to)});
      builder.face(surface, {at(ring, from), at(ring + 1, from), at(ring + 1, to)});
    }
  }
  const Vec3 sun{std::cos(radians(kElevation)), 0, std::sin(radians(kElevation))};
  Light light{"sun", Sun{}, {kSunlight, kSunlight, kSunlight}};
  std::get<Sun>(light.kind).toward = sun;
  std::get<Sun>(light.kind).diameter = 0;
  builder.scene().lights = {light};
  return builder.scene();
}

struct Crater {
  std::size_t facets = 0;
  double shadow = 0;  // K, mean by area
};

/// The heat that sunlight leaves in each facet is what the facet gives off.
Crater craterOf(int rings) {
  Progress quiet;
  const PatchMesh mesh = meshScene(bowl(rings), {.faces_as_patches = true}, quiet).mesh;
  const PatchMaterials materials = patchMaterials(bowl(rings), mesh);
  FormFactorOptions exact;
  exact.method = FormFactorMethod::exact;
  const FormFactors factors = computeFormFactors(mesh, exact, quiet);
  const Solution light = solve(factors, materials, mesh, {}, quiet);
  EXPECT_TRUE(light.summary.usable()) << light.summary.message;
  std::vector<HeatCondition> conditions(mesh.size());
  std::vector<Index> of_row(mesh.size());
  for (Index i = 0; i < mesh.size(); ++i) {
    conditions[i].name = "facet";
    conditions[i].emissivity = {{{}, {kEmissivity}}};
    conditions[i].flux = (1 - kAlbedo) * light.irradiance[3 * i];
    of_row[i] = i;
  }
  const HeatSolution heat = solveHeat(factors, {conditions, of_row, {}}, {}, quiet);
  EXPECT_TRUE(heat.summary.usable()) << heat.summary.message;
  PatchMaterials black = materials;
  std::ranges::fill(black.reflectance, 0.0);
  const std::vector<double> direct = solve(factors, black, mesh, {}, quiet).irradiance;
  Crater crater{mesh.size()};
  double area = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (direct[3 * i] > 0) continue;
    crater.shadow += mesh.area[i] * heat.temperature[i];
    area += mesh.area[i];
  }
  crater.shadow /= area;
  return crater;
}

// Facets inside the sphere miss area by a term in the square of their edges, which is in proportion
// to one over their number: 55, 65 and 64 K over it were found.
TEST(HeatCrater, TheShadowHasTheTemperatureOfItsClosedForm) {
  ASSERT_NEAR(shadowTemperature(), 148.857, 0.0005);
  for (const int rings : {6, 8, 16}) {
    const Crater crater = craterOf(rings);
    EXPECT_NEAR(crater.shadow, shadowTemperature(), 70.0 / double(crater.facets)) << rings;
  }
}

}  // namespace
}  // namespace radiosity
