// Any number of bands at once: each is solved as if alone.
#include <gtest/gtest.h>

#include <string>

#include "gather/gather_scenes.h"
#include "radiosity/form_factors.h"
#include "solve_systems.h"

namespace radiosity {
namespace {

constexpr int kBandCounts[] = {1, 2, 3, 5, 8};

/// Every `bands`-th value from `band` on.
std::vector<double> bandOf(const std::vector<double>& values, int bands, int band) {
  std::vector<double> out;
  for (std::size_t k = std::size_t(band); k < values.size(); k += std::size_t(bands)) {
    out.push_back(values[k]);
  }
  return out;
}

TEST(SolveBands, EachHasTheSameBitsAloneAndAmongOthers) {
  constexpr std::size_t kPatches = 120;
  test::Random random(17);
  const test::Reciprocal room = test::reciprocal(kPatches, random);
  for (const FormFactors& factors : {test::factorsFrom(room.f, room.area, 0.25),
                                     test::symmetricFactorsFrom(room.f, room.area, 0.25)}) {
    for (const int bands : kBandCounts) {
      const std::size_t count = kPatches * std::size_t(bands);
      const std::vector<double> rho = random.vector(count, 0.1, 0.9);
      const std::vector<double> emission = random.vector(count, 0.0, 2.0);
      const std::vector<double> sky = random.vector(std::size_t(bands), 0.0, 1.0);
      // A fixed number of sweeps: among others, a band goes on until the last one is done.
      for (const Solver solver : test::iterationsOf(factors)) {
        const SolveOptions options = test::options(solver, 1e-300, 9);
        Progress quiet;
        const Solution all = solve(factors, rho, emission, bands, options, quiet, {}, {}, sky);
        for (int b = 0; b < bands; ++b) {
          const Solution alone =
              solve(factors, bandOf(rho, bands, b), bandOf(emission, bands, b), 1, options, quiet,
                    {}, {}, std::vector<double>{sky[std::size_t(b)]});
          EXPECT_EQ(alone.radiosity, bandOf(all.radiosity, bands, b)) << b << " of " << bands;
          EXPECT_EQ(alone.irradiance, bandOf(all.irradiance, bands, b)) << b << " of " << bands;
          const auto& energy = all.summary.energy;
          EXPECT_EQ(alone.summary.energy.absorbed[0], energy.absorbed[std::size_t(b)]);
          EXPECT_EQ(alone.summary.energy.from_sky[0], energy.from_sky[std::size_t(b)]);
        }
      }
    }
  }
}

TEST(SolveBands, MaterialsOfAnyNumberOfBandsAreSolved) {
  // A closed room in which band b reflects rho_b and emits E_b all over: B_b = E_b / (1 - rho_b).
  test::Room room = test::loadRoom("furnace-cube", 54);
  Progress quiet;
  FormFactorOptions options;
  options.method = FormFactorMethod::exact;
  options.closure = ClosureMode::enforce;
  const FormFactors factors = computeFormFactors(room.mesh, options, quiet);
  for (const int bands : kBandCounts) {
    PatchMaterials materials;
    materials.bands = bands;
    for (std::size_t i = 0; i < room.mesh.size(); ++i) {
      for (int b = 0; b < bands; ++b) {
        materials.reflectance.push_back(0.1 * (b + 1));
        materials.emission.push_back(1 + b);
      }
    }
    SolveOptions solving;
    solving.tolerance = 1e-12;
    const Solution light = solve(factors, materials, room.mesh, solving, quiet);
    ASSERT_EQ(light.bands, bands);
    ASSERT_EQ(light.radiosity.size(), room.mesh.size() * std::size_t(bands));
    for (std::size_t k = 0; k < light.radiosity.size(); ++k) {
      const auto b = double(k % std::size_t(bands));
      // Rows sum to 1 within closure and single precision.
      const double truth = (1 + b) / (1 - 0.1 * (b + 1));
      ASSERT_NEAR(light.radiosity[k], truth, 1e-5 * truth) << k;
    }
  }
}

TEST(SolveBands, MaterialsThatDoNotFitTheMeshAreNamed) {
  const test::Room room = test::loadRoom("furnace-cube", 6);
  Progress quiet;
  const FormFactors factors = computeFormFactors(room.mesh, {}, quiet);
  PatchMaterials materials = room.materials;
  materials.bands = 8;
  try {
    solve(factors, materials, room.mesh, {}, quiet);
    FAIL() << "rows of three were taken for rows of eight";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("patches of 8 bands take"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace radiosity
