// Materials changed by name after reading.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "radiosity/scene.h"
#include "support/scene_files.h"

namespace radiosity::test {
namespace {

/// Objects room, lamp.001 and shelf; the first and the last share material white.
class SceneOverride : public SceneFiles {
 protected:
  void SetUp() override {
    SceneFiles::SetUp();
    write("m.mtl",
          "newmtl white\nKd .7 .7 .7\nnewmtl glow\nKd .5 .5 .5\nKe 1 1 1\n"
          "newmtl spare\nKd .1 .1 .1\n");
    file_ = write("scene.obj",
                  "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                  "o room\nusemtl white\nf 1 2 3 4\no lamp.001\nusemtl glow\nf 1 2 3 4\n"
                  "o shelf\nusemtl white\nf 1 2 3 4\n");
  }
  Scene loadWith(const std::vector<std::string>& set) const {
    SceneOptions options;
    options.set = set;
    return loadScene(file_, options);
  }
  Scene loadWithFile(const std::string& json) const {
    SceneOptions options;
    options.materials_file = write("materials.json", json);
    return loadScene(file_, options);
  }
  std::string file_;
};

TEST_F(SceneOverride, NamesMaterialsThatBecomeWhiteOnce) {
  Scene scene = loadWith({"lamp.001.reflectance=1"});
  const auto whites = [&] {
    return std::ranges::count_if(scene.notes, [](const Note& note) {
      return note.text.starts_with("reflectance 1: absorbs no light");
    });
  };
  EXPECT_EQ(whites(), 1);
  SceneOptions later;
  later.sky = Vec3(1);
  applyOverrides(scene, later);
  EXPECT_EQ(whites(), 1);
  later.set = {"shelf.reflectance=1"};
  applyOverrides(scene, later);
  EXPECT_EQ(whites(), 2);
  EXPECT_CONTAINS(scene.notes.back().text, "glow, white");
}

TEST_F(SceneOverride, SetsAMaterialForAllItsSurfaces) {
  const Scene scene = loadWith({"white.reflectance=.2,.3,.4"});
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(.2, .3, .4));
  EXPECT_EQ(scene.materialOf(2).reflectance, Vec3(.2, .3, .4));
  EXPECT_EQ(scene.materialOf(1).reflectance, Vec3(.5));
  EXPECT_EQ(scene.materials.size(), 3u);
  EXPECT_NOTE(scene.notes, "white: reflectance 0.7 -> 0.2 0.3 0.4", Severity::info);
}

TEST_F(SceneOverride, SetsOneObjectOrSurfaceAlone) {
  for (const std::string name : {"shelf", "shelf/white"}) {
    const Scene scene = loadWith({fmt::format("{}.reflectance=.2", name)});
    EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(.7)) << "room shares the material: untouched";
    EXPECT_EQ(scene.materialOf(2).reflectance, Vec3(.2));
    EXPECT_EQ(scene.surfaces[2].name, "shelf/white") << "results stay keyed by the same name";
    // The copy is still called white.
    const Scene both = loadWith({fmt::format("{}.reflectance=.2", name), "white.emission=3"});
    EXPECT_EQ(both.materialOf(0).emission, Vec3(3));
    EXPECT_EQ(both.materialOf(2).emission, Vec3(3));
    EXPECT_EQ(both.materialOf(2).reflectance, Vec3(.2));
  }
}

TEST_F(SceneOverride, EmissionIsExitanceAndPiTimesRadiance) {
  Scene scene = loadWith({"glow.emission=17,12,4"});
  EXPECT_EQ(scene.materialOf(1).emission, Vec3(17, 12, 4));
  EXPECT_NOTE(scene.notes, "glow: emission 3.14159 -> 17 12 4 W/m^2", Severity::info);
  scene = loadWith({"glow.radiance=2"});
  EXPECT_DOUBLE_EQ(scene.materialOf(1).emission.y, 2 * std::numbers::pi);
}

TEST_F(SceneOverride, NamesMayHoldDots) {
  EXPECT_EQ(loadWith({"lamp.001.emission=9"}).materialOf(1).emission, Vec3(9));
  EXPECT_EQ(loadWith({"lamp.001/glow.emission=1.5"}).materialOf(1).emission, Vec3(1.5));
}

TEST_F(SceneOverride, RefusesUnknownNamesAndBadValues) {
  const auto errorOf = [&](const std::string& set) {
    return inputErrorOf([&] { loadWith({set}); });
  };
  const std::string unknown = errorOf("ceiling.emission=1");
  for (const std::string name : {"ceiling", "white", "glow", "room", "lamp.001", "shelf/white"}) {
    EXPECT_CONTAINS(unknown, name);
  }
  EXPECT_CONTAINS(errorOf("glow.reflectance=1.2"), "glow");
  EXPECT_CONTAINS(errorOf("glow.reflectance=1.2"), "outside 0 to 1");
  EXPECT_CONTAINS(errorOf("glow.emission=-1"), "emission -1");
  EXPECT_CONTAINS(errorOf("glow.emission=nan"), "`nan`");
  EXPECT_CONTAINS(errorOf("glow.emission=1,2"), "`1,2`");
  EXPECT_CONTAINS(errorOf("glow.emission="), "``");
  EXPECT_CONTAINS(errorOf("glow.colour=1"), "`colour` is none of");
  EXPECT_CONTAINS(errorOf("glow"), "NAME.PROPERTY=VALUE");
  EXPECT_CONTAINS(errorOf("glow=1"), "NAME.PROPERTY=VALUE");
  EXPECT_CONTAINS(errorOf(".emission=1"), "NAME.PROPERTY=VALUE");
}

TEST_F(SceneOverride, WarnsOfAChangeThatShowsNowhere) {
  EXPECT_NOTE(loadWith({"spare.emission=1"}).notes, "spare: no face has this material",
              Severity::warning);
}

TEST_F(SceneOverride, ReadsAMaterialsFileInItsOrderAndSetAfterIt) {
  const Scene scene = loadWithFile(
      R"({"white": {"reflectance": [0.1, 0.2, 0.3], "emission": 2}, "room": {"radiance": 1}})");
  EXPECT_EQ(scene.materialOf(2).reflectance, Vec3(.1, .2, .3));
  EXPECT_EQ(scene.materialOf(2).emission, Vec3(2));
  EXPECT_DOUBLE_EQ(scene.materialOf(0).emission.x, std::numbers::pi) << "later and narrower";
  SceneOptions options;
  options.materials_file = path("materials.json");
  options.set = {"white.emission=5"};
  EXPECT_EQ(loadScene(file_, options).materialOf(2).emission, Vec3(5));
}

TEST_F(SceneOverride, RefusesABadMaterialsFile) {
  const auto errorOf = [&](const std::string& json) {
    return inputErrorOf([&] { loadWithFile(json); });
  };
  EXPECT_CONTAINS(errorOf("{\"white\": {"), "materials.json: is not JSON");
  EXPECT_CONTAINS(errorOf("[1]"), "materials.json: is not a JSON object");
  EXPECT_CONTAINS(errorOf(R"({"white": 3})"), "white is not an object");
  EXPECT_CONTAINS(errorOf(R"({"white": {"reflectance": "red"}})"),
                  "materials.json: white.reflectance: give one number or three");
  EXPECT_CONTAINS(errorOf(R"({"white": {"reflectance": [1, 2]}})"), "give one number or three");
  EXPECT_CONTAINS(errorOf(R"({"white": {"reflectance": 2}})"), "outside 0 to 1");
  EXPECT_CONTAINS(errorOf(R"({"nobody": {"reflectance": 1}})"), "there are: white, glow");
  SceneOptions options;
  options.materials_file = path("absent.json");
  EXPECT_CONTAINS(inputErrorOf([&] { loadScene(file_, options); }), "no such file");
}

TEST_F(SceneOverride, SetsOneSidedBeforeTwoSided) {
  SceneOptions options;
  options.two_sided = {"all"};
  Scene scene = loadScene(file_, options);
  for (std::size_t f = 0; f < 3; ++f) EXPECT_TRUE(scene.materialOf(f).two_sided);
  options.two_sided = {"shelf"};
  options.one_sided = {"all"};
  scene = loadScene(file_, options);
  EXPECT_FALSE(scene.materialOf(0).two_sided);
  EXPECT_FALSE(scene.materialOf(1).two_sided);
  EXPECT_TRUE(scene.materialOf(2).two_sided);
  EXPECT_NOTE(scene.notes, "shelf: two-sided", Severity::info);
  options.two_sided = {"nobody"};
  EXPECT_CONTAINS(inputErrorOf([&] { loadScene(file_, options); }), "--two-sided nobody");
}

TEST_F(SceneOverride, AFailedOverrideChangesNothing) {
  Scene scene = loadScene(file_);
  const std::size_t notes = scene.notes.size();
  SceneOptions options;
  options.set = {"shelf.reflectance=.1", "nobody.reflectance=.1"};
  EXPECT_THROW(applyOverrides(scene, options), InputError);
  EXPECT_EQ(scene.materialOf(2).reflectance, Vec3(.7));
  EXPECT_EQ(scene.materials.size(), 3u);
  EXPECT_EQ(scene.notes.size(), notes);
}

}  // namespace
}  // namespace radiosity::test
