// Options in keys, from the lists of their structs: files of older versions match by these texts.
#include "pipeline/stage_key.h"

#include <gtest/gtest.h>

#include "radiosity/compare.h"
#include "radiosity/lightmap.h"
#include "radiosity/render.h"
#include "support/error_of.h"

namespace radiosity {
namespace {

FormFactorOptions by(FormFactorMethod method) {
  FormFactorOptions options;
  options.method = method;
  return options;
}

TEST(StageKey, HasTheOptionsOfOlderFiles) {
  EXPECT_EQ(keyText(MeshOptions()), "patches=2000 max-edge=0 weld=1e-07 faces-as-patches=off");
  EXPECT_EQ(keyText(SolveOptions()), "solver=auto solve-tolerance=1e-06 max-iterations=10000");
  EXPECT_EQ(keyText(ElementOptions()),
            "element-tolerance=0.01 smallest-edge=0.002 most-vertices=400000 rays=512 "
            "most-rays=100000000 crease=30 seed=1");
  EXPECT_EQ(keyText(GatherOptions()),
            "at=vertices passes=100 gather-tolerance=0.0001 resolution=256 seed=1 crease=30");
  EXPECT_EQ(keyText(HeatOptions()),
            "sky-temperature=0 band-edges=none band-fractions=none heat-tolerance=1e-09 "
            "heat-iterations=100");
  EXPECT_EQ(keyText(by(FormFactorMethod::automatic)),
            "method=auto tolerance=default closure=report seed=1 resolution=256 symmetrize=off "
            "near=off precision=auto");
  EXPECT_EQ(keyText(by(FormFactorMethod::exact)),
            "method=exact tolerance=default closure=report precision=auto");
  EXPECT_EQ(keyText(by(FormFactorMethod::rays)),
            "method=rays tolerance=default closure=report seed=1 precision=auto");
  FormFactorOptions hemicubes = by(FormFactorMethod::hemicube);
  hemicubes.near_exact = true;
  hemicubes.random_turns = false;
  hemicubes.exact_emitters = false;
  hemicubes.precision = Precision::single_precision;
  EXPECT_EQ(keyText(hemicubes),
            "method=hemicube seed=1 resolution=256 symmetrize=off near=exact random-turns=off "
            "emitters=estimated precision=single");
}

TEST(StageKey, GivesItsOptionsBack) {
  HeatOptions heat;
  heat.bands.edges = {0.1, 3};
  heat.tolerance = 1.0 / 3;
  heat.sigma = 5.67e-8;
  EXPECT_EQ(keyText(optionsIn<HeatOptions>(keyText(heat))), keyText(heat));
  FormFactorOptions factors = by(FormFactorMethod::rays);
  factors.sources_only = true;
  factors.seed = 18446744073709551615u;
  const auto back = optionsOf<FormFactorOptions>(StageKey(keyText(factors)));
  EXPECT_TRUE(back.sources_only);
  EXPECT_EQ(keyText(back), keyText(factors));
  EXPECT_EQ(optionsIn<MeshOptions>("patches=many weld=0.001").weld, 0.001);
}

TEST(Options, AreValidByDefault) {
  requireRanges(MeshOptions());
  requireRanges(FormFactorOptions());
  requireRanges(SolveOptions());
  requireRanges(ElementOptions());
  requireRanges(GatherOptions());
  requireRanges(HeatOptions());
  requireRanges(LightmapOptions());
  requireRanges(RenderOptions());
  requireRanges(CompareOptions());
}

TEST(Options, SayTheirRange) {
  const auto says = [](auto options) { return test::errorOf([&] { options.validate(); }); };
  EXPECT_EQ(says(MeshOptions{.patches = 0}), "patches: 0 is out of range; 1 to 20,000,000");
  EXPECT_EQ(says(MeshOptions{.max_edge = -1}), "max_edge: -1 m is out of range; 0 or more");
  EXPECT_EQ(says(SolveOptions{.tolerance = 1}),
            "tolerance: 1 is out of range; above 0 and below 1");
  EXPECT_EQ(says(GatherOptions{.resolution = 17}),
            "resolution: 17 pixels is out of range; even, 16 to 4096");
  EXPECT_EQ(says(ElementOptions{.rays = 100}),
            "rays: 100 is out of range; a power of two, 64 to 4096");
  EXPECT_EQ(says(CompareOptions{.match = 0}), "match: 0 is out of range; above 0 and at most 0.1");
}

}  // namespace
}  // namespace radiosity
