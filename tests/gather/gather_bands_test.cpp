// Any number of bands at once: each is gathered as if alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "gather_scenes.h"

namespace radiosity {
namespace {

using test::Room;

constexpr int kBandCounts[] = {1, 2, 3, 5, 8};

template <class Value>
std::vector<Value> bandOf(const std::vector<Value>& values, int bands, int band) {
  std::vector<Value> out;
  for (std::size_t k = std::size_t(band); k < values.size(); k += std::size_t(bands)) {
    out.push_back(values[k]);
  }
  return out;
}

/// Every patch its own reflectance in each band; the scene's emitters emit in each.
PatchMaterials spectrum(const Room& room, int bands) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  PatchMaterials materials;
  materials.bands = bands;
  for (std::size_t i = 0; i < room.mesh.size(); ++i) {
    for (int b = 0; b < bands; ++b) {
      materials.reflectance.push_back(0.8 * unit(random));
      materials.emission.push_back(room.materials.emission[3 * i] * (0.5 + unit(random)));
    }
  }
  materials.lights = {uniformSky({})};
  for (int b = 0; b < bands; ++b) {
    materials.lights[0].strength.push_back(0.1 + 0.2 * unit(random));
  }
  return materials;
}

PatchMaterials alone(const PatchMaterials& all, int band) {
  return {1,
          bandOf(all.reflectance, all.bands, band),
          bandOf(all.emission, all.bands, band),
          {uniformSky({all.lights[0].strength[std::size_t(band)]})}};
}

/// A fixed number of passes: among others, a band goes on until the last one is done.
GatherOptions passes(GatherAt at) {
  GatherOptions options;
  options.at = at;
  options.passes = 3;
  options.tolerance = 1e-12;
  options.resolution = 32;
  return options;
}

bool hasQuadsAndTrianglesOnly(const PatchMesh& mesh) {
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.outline(i).size() > 4) return false;
  }
  return true;
}

TEST(GatherBands, EachHasTheSameBitsAloneAndAmongOthers) {
  const Room room = test::loadRoom("cornell-box", 150);
  ASSERT_TRUE(hasQuadsAndTrianglesOnly(room.mesh));
  Progress quiet;
  for (const GatherAt at : {GatherAt::patches, GatherAt::vertices}) {
    for (const int bands : kBandCounts) {
      const PatchMaterials materials = spectrum(room, bands);
      const Gathered all = gather(room.mesh, materials, passes(at), quiet);
      ASSERT_EQ(all.bands, bands);
      ASSERT_EQ(all.radiosity.size(), all.area.size() * std::size_t(bands));
      const std::vector<double> means = patchRadiosity(room.mesh, all);
      const std::vector<double> corners = cornerRadiosity(room.mesh, all);
      for (int b = 0; b < bands; ++b) {
        const Gathered one = gather(room.mesh, alone(materials, b), passes(at), quiet);
        EXPECT_EQ(one.radiosity, bandOf(all.radiosity, bands, b)) << b << " of " << bands;
        EXPECT_EQ(one.irradiance, bandOf(all.irradiance, bands, b)) << b << " of " << bands;
        EXPECT_EQ(one.sky, all.sky);
        EXPECT_EQ(patchRadiosity(room.mesh, one), bandOf(means, bands, b));
        EXPECT_EQ(cornerRadiosity(room.mesh, one), bandOf(corners, bands, b));
        const auto at_band = std::size_t(b);
        const GatherPass& last = all.summary.passes.back();
        const GatherPass& same = one.summary.passes.back();
        EXPECT_EQ(same.energy.absorbed[0], last.energy.absorbed[at_band]);
        EXPECT_EQ(same.energy.from_sky[0], last.energy.from_sky[at_band]);
        EXPECT_EQ(same.in_flight[0], last.in_flight[at_band]);
        EXPECT_LE(same.change, last.change) << "the worst band's";
      }
    }
  }
}

TEST(GatherBands, PatchesOfManyCornersDifferByRoundingAlone) {
  // Such a patch is weighed whole if all bands are constant on it, else facet by facet: doubles
  // round differently, by 1e-16, and now and then a float of the sum falls to the other side: 6e-8
  // of it, each pass.
  const Room room = test::loadRoom("two-rooms", 30);
  ASSERT_FALSE(hasQuadsAndTrianglesOnly(room.mesh));
  Progress quiet;
  PatchMaterials materials = spectrum(room, 5);
  for (std::size_t k = 2; k < materials.emission.size(); k += 5) {
    materials.emission[k] = 1;  // this band is constant all over in the first pass, alone or not
  }
  const Gathered all = gather(room.mesh, materials, passes(GatherAt::vertices), quiet);
  for (int b = 0; b < 5; ++b) {
    const Gathered one = gather(room.mesh, alone(materials, b), passes(GatherAt::vertices), quiet);
    const std::vector<float> among = bandOf(all.radiosity, 5, b);
    for (std::size_t k = 0; k < among.size(); ++k) {
      ASSERT_NEAR(one.radiosity[k], among[k], 3 * 6e-8 * double(among[k])) << b << " " << k;
    }
  }
}

TEST(GatherBands, EveryBandIsAFurnaceOfItsOwn) {
  // B_b = E_b (1 + rho_b + ... + rho_b^passes) wherever nothing is lost.
  const Room room = test::loadRoom("furnace-cube", 54);
  Progress quiet;
  for (const GatherAt at : {GatherAt::patches, GatherAt::vertices}) {
    PatchMaterials materials;
    materials.bands = 8;
    for (std::size_t k = 0; k < 8 * room.mesh.size(); ++k) {
      materials.reflectance.push_back(0.1 * double(k % 8));
      materials.emission.push_back(1 + double(k % 8));
    }
    const Gathered gathered = gather(room.mesh, materials, passes(at), quiet);  // no sky: dark
    for (std::size_t k = 0; k < gathered.radiosity.size(); ++k) {
      const double rho = 0.1 * double(k % 8);
      const double truth = (1 + double(k % 8)) * (1 + rho + rho * rho + rho * rho * rho);
      ASSERT_NEAR(gathered.radiosity[k], truth, 1e-6 * truth) << k;
    }
  }
}

TEST(GatherBands, MaterialsThatDoNotFitAreNamed) {
  const Room room = test::loadRoom("furnace-cube", 6);
  Progress quiet;
  const auto refusal = [&](const PatchMaterials& materials) {
    try {
      gather(room.mesh, materials, passes(GatherAt::patches), quiet);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  PatchMaterials five = spectrum(room, 5);
  EXPECT_EQ(refusal(five), "");
  PatchMaterials bad = five;
  bad.bands = 4;
  EXPECT_NE(refusal(bad).find("patches of 4 bands take"), std::string::npos) << refusal(bad);
  bad = five;
  bad.lights[0].strength.pop_back();
  EXPECT_NE(refusal(bad).find("the sky has 4 bands, the patches have 5"), std::string::npos);
  bad = five;
  bad.reflectance[5 * 3 + 4] = 1.5;
  EXPECT_NE(refusal(bad).find("patch 3 "), std::string::npos) << refusal(bad);
}

}  // namespace
}  // namespace radiosity
