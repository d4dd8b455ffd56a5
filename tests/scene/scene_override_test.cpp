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
  later.lights = {uniformSky({1, 1, 1})};
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
  EXPECT_CONTAINS(errorOf(R"({"nobody": {"reflectance": 1}})"), "is called nobody; there are: ");
  EXPECT_CONTAINS(errorOf(R"({"gloww": {"reflectance": 1}})"), "there are: glow, ");
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
  EXPECT_CONTAINS(inputErrorOf([&] { loadScene(file_, options); }), "two_sided='nobody'");
}

TEST_F(SceneOverride, TakesPatternsAndAll) {
  for (const std::string name : {"all", "*"}) {
    const Scene scene = loadWith({name + ".radiance=1"});
    for (std::size_t f = 0; f < 3; ++f) {
      EXPECT_DOUBLE_EQ(scene.materialOf(f).emission.x, std::numbers::pi) << name;
    }
    EXPECT_NOTE(scene.notes, name + " (white): emission 0 -> 3.14159 W/m^2", Severity::info);
  }
  // By the names of objects, materials and surfaces; what shares the material stays.
  const Scene scene = loadWith({"s*f.reflectance=.2", "gl?w.reflectance=.3"});
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(.7));
  EXPECT_EQ(scene.materialOf(1).reflectance, Vec3(.3));
  EXPECT_EQ(scene.materialOf(2).reflectance, Vec3(.2));
  EXPECT_CONTAINS(inputErrorOf([&] { loadWith({"x*.radiance=1"}); }),
                  "no surface, material or object matches x*; there are: ");
  EXPECT_CONTAINS(inputErrorOf([&] { loadWith({"shlef.radiance=1"}); }),
                  "is called shlef; there are: shelf, ");
}

TEST_F(SceneOverride, ALiteralNameGoesBeforeAPattern) {
  const std::string file = write("b.obj",
                                 "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\no all\nusemtl a\nf 1 2 3 4\n"
                                 "o w*\nusemtl b\nf 1 2 3 4\no wall\nusemtl c\nf 1 2 3 4\n");
  SceneOptions options;
  options.set = {"all.emission=1", "w*.emission=2"};
  const Scene scene = loadScene(file, options);
  EXPECT_EQ(scene.materialOf(0).emission, Vec3(1));
  EXPECT_EQ(scene.materialOf(1).emission, Vec3(2));
  EXPECT_EQ(scene.materialOf(2).emission, Vec3(0));
}

TEST_F(SceneOverride, TurnsFacesOver) {
  write("t.mtl", "newmtl paint\nKd .5 .5 .5\n");
  const std::string file =
      write("t.obj",
            "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 2 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
            "usemtl paint\no a\nf 1/1 2/2 3/3 4/4\no b\nf 1 2 3\n");
  SceneOptions options;
  options.flip = {"a", "a*"};  // once
  const Scene before = loadScene(file);
  const Scene after = loadScene(file, options);
  for (const std::size_t k : {0, 1, 2, 3}) {
    EXPECT_EQ(corner(after, 0, k), corner(before, 0, (4 - k) % 4));
  }
  for (const std::size_t k : {0, 1, 2}) EXPECT_EQ(corner(after, 1, k), corner(before, 1, k));
  EXPECT_NOTE(after.notes, "a (a/paint): 1 face, 1.5 m^2, turned over", Severity::info);
  options.flip = {"nobody"};
  EXPECT_CONTAINS(inputErrorOf([&] { loadScene(file, options); }), "flip='nobody': no surface");
}

TEST_F(SceneOverride, LeavesSurfacesOut) {
  SceneOptions options;
  options.without = {"white"};
  options.set = {"shelf.emission=3"};  // gone, but known
  Scene scene = loadScene(file_, options);
  ASSERT_EQ(scene.faceCount(), 1u);
  ASSERT_EQ(scene.surfaces.size(), 1u);
  EXPECT_EQ(scene.surfaces[0].name, "lamp.001/glow");
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(.5));
  EXPECT_EQ(scene.face_element[0], 11u);
  EXPECT_NO_THROW(validate(scene));
  EXPECT_NOTE(scene.notes, "white (room/white, shelf/white): 2 faces, 2 m^2, left out",
              Severity::info);
  options.without = {"all"};
  EXPECT_CONTAINS(inputErrorOf([&] { loadScene(file_, options); }),
                  "without='all': leaves no face");
  // Errors leave a scene in memory as it was.
  scene = loadScene(file_);
  options = {};
  options.without = {"shelf"};
  options.flip = {"nobody"};
  EXPECT_THROW(applyOverrides(scene, options), InputError);
  EXPECT_EQ(scene.faceCount(), 3u);
}

TEST_F(SceneOverride, MendsWhatIsNoReflectance) {
  const auto load = [&](const std::string& kd, const SceneOptions& options = {}) {
    write("m.mtl", "newmtl white\nKd " + kd + "\nnewmtl glow\nKe 1 1 1\nnewmtl spare\nKd 7 7 7\n");
    return loadScene(file_, options);
  };
  SceneOptions mended;
  mended.set = {"white.reflectance=.7"};
  SceneOptions without;
  without.without = {"white"};
  for (const std::string kd : {"1.2 0 0", "1.0000011 1 1", "-1e-9 0 0", "nan 0 0", "inf 0 0"}) {
    const std::string error = inputErrorOf([&] { load(kd); });
    EXPECT_CONTAINS(error, "m.mtl:2: material white: reflectance ");
    EXPECT_CONTAINS(error, "set='white.reflectance=0.8'");
    EXPECT_EQ(load(kd, mended).materialOf(0).reflectance, Vec3(.7)) << kd;
    EXPECT_EQ(load(kd, without).faceCount(), 1u) << kd;
  }
  EXPECT_CONTAINS(inputErrorOf([&] { load("1.0000011 1 1"); }), "reflectance 1.0000011 1 1 is");
  EXPECT_NOTE(load(".5 .5 .5", mended).notes,
              "material spare: no face has it; its reflectance 7 or", Severity::warning);
  SceneOptions tinted;
  tinted.set = {"white.tint=.5"};
  EXPECT_EQ(load("1.2 1.2 1.2", tinted).materialOf(0).reflectance, Vec3(.6));
}

TEST_F(SceneOverride, TakesRoundingAboveOneAsOne) {
  write("m.mtl", "newmtl white\nKd 1.00000012 .5 1.000001\nnewmtl glow\nKd .5 .5 .5\n");
  const Scene scene = loadScene(file_);
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(1, .5, 1));
  EXPECT_NOTE(scene.notes, "above 1 by float rounding, taken as 1, material: white",
              Severity::info);
  EXPECT_EQ(loadWith({"glow.reflectance=1.0000001"}).materialOf(1).reflectance, Vec3(1));
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
