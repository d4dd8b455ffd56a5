// Lamps of photometric files: how they hang, their texts, and what is refused.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "radiosity/light.h"
#include "scene/lights/light_text.h"
#include "support/lamp_files.h"
#include "support/scene_builder.h"
#include "support/scene_files.h"

namespace radiosity {
namespace {

using test::EulumdatLamp;
using test::IesLamp;

class PhotometricLights : public test::SceneFiles {
 protected:
  /// 400 cd to C0, 300 to C90, 200 to C180, 100 to C270, at all vertical angles.
  IesLamp quarters() const {
    IesLamp lamp;
    lamp.vertical = {0, 180};
    lamp.horizontal = {0, 90, 180, 270, 360};
    lamp.candela = [](double, double h) { return h == 360 ? 400 : 400 - h / 90 * 100; };
    return lamp;
  }
  Light light(const IesLamp& lamp, const std::string& rest, Up up = Up::z) const {
    Light made = lightOf("ies," + write("lamp.ies", lamp.text()) + rest);
    made.settle(up);
    made.validate();
    return made;
  }
  /// cd from the lamp to a place.
  static double candela(const Light& light, const Vec3& to) {
    const Vec3 way = to - *light.place();
    return light.ray(to, 0.5, 0.5).share * glm::dot(way, way) * light.strength[0] * kLumensPerWatt;
  }
};

TEST_F(PhotometricLights, HaveTheFluxOfTheirFileOrTheirOwn) {
  IesLamp lamp;
  const double lumens = 2 * std::numbers::pi * 100;
  EXPECT_NEAR(light(lamp, "").strength[0], lumens / 683, 1e-7);
  EXPECT_NEAR(*light(lamp, "").power(0), lumens / 683, 1e-7);
  EXPECT_NEAR(light(lamp, ",900lm").strength[1], 900 / 683.0, 1e-15);
  EXPECT_EQ(light(lamp, ",flux=7").strength, std::vector<double>(3, 7.0));
  EXPECT_EQ(light(lamp, ",flux=1,2,3W").strength, (std::vector<double>{1, 2, 3}));
  // The shape stays.
  EXPECT_NEAR(candela(light(lamp, ",flux=900lm,at=0,0,2"), {0, 1, 0}), 900 / (2 * std::numbers::pi),
              1e-4);
  EXPECT_EQ(light(lamp, ",900lm,name=a"),
            lightOf("ies,900lm,file=" + path("lamp.ies") + ",name=a,up=0,0,1"));
}

// Straight down C0 points to +x and C90 to +y where z is up, to -z where y is.
TEST_F(PhotometricLights, HangAsTheReadmeSays) {
  const IesLamp lamp = quarters();
  const auto around = [&](const Light& light, const std::vector<Vec3>& places) {
    std::vector<double> found;
    found.reserve(places.size());
    for (const Vec3& place : places) found.push_back(std::round(candela(light, place)));
    return found;
  };
  const std::vector<double> as_they_are{400, 300, 200, 100};
  EXPECT_EQ(around(light(lamp, ""), {{1, 0, -1}, {0, 1, -1}, {-1, 0, -1}, {0, -1, -1}}),
            as_they_are);
  EXPECT_EQ(around(light(lamp, "", Up::y), {{1, -1, 0}, {0, -1, -1}, {-1, -1, 0}, {0, -1, 1}}),
            as_they_are);
  // A turn goes from C0 to C90.
  EXPECT_EQ(around(light(lamp, ",turn=90"), {{0, 1, -1}, {-1, 0, -1}, {0, -1, -1}, {1, 0, -1}}),
            as_they_are);
  // Tipped towards +x, C0 looks up, and C90 stays.
  EXPECT_EQ(around(light(lamp, ",aim=5,0,0"), {{1, 0, 1}, {1, 1, 0}, {1, 0, -1}, {1, -1, 0}}),
            as_they_are);
  // A little aside, hardly anything changes; straight up it is tipped about C0.
  EXPECT_EQ(
      around(light(lamp, ",aim=0,.001,-1"), {{1, 0, -1}, {0, 1, -1}, {-1, 0, -1}, {0, -1, -1}}),
      as_they_are);
  EXPECT_EQ(around(light(lamp, ",aim=0,0,1"), {{1, 0, 1}, {0, -1, 1}, {-1, 0, 1}, {0, 1, 1}}),
            as_they_are);
}

TEST_F(PhotometricLights, FloodlightsStandUpright) {
  IesLamp lamp;
  lamp.type = 2;
  lamp.vertical = lamp.horizontal = {-90, 0, 90};
  lamp.candela = [](double v, double h) { return 500 + v + 2 * h; };
  // Ahead, to the right, up. 45 degrees up: V 45; to the right in the level plane: H 45.
  const auto check = [&](const Light& made, const Vec3& ahead, const Vec3& right, const Vec3& up) {
    EXPECT_NEAR(candela(made, ahead), 500, 1e-3);
    EXPECT_NEAR(candela(made, ahead + right), 590, 1e-3);
    EXPECT_NEAR(candela(made, ahead + up), 545, 1e-3);
  };
  check(light(lamp, ",aim=0,3,0"), {0, 1, 0}, {1, 0, 0}, {0, 0, 1});
  check(light(lamp, ",aim=-2,0,0"), {-1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  check(light(lamp, ",aim=0,0,-3", Up::y), {0, 0, -1}, {1, 0, 0}, {0, 1, 0});
  check(light(lamp, ""), {0, 0, -1}, {1, 0, 0}, {0, 1, 0});
  const Vec3 ahead = glm::normalize(Vec3(1, 2, -1));
  const Vec3 right = glm::normalize(glm::cross(ahead, Vec3(0, 0, 1)));
  check(light(lamp, ",aim=10,20,-10"), ahead, right, glm::cross(right, ahead));
}

TEST_F(PhotometricLights, AreWideNearByAlone) {
  IesLamp lamp;
  lamp.opening = "2 .6 .8 0";
  const Light made = light(lamp, ",at=0,0,3");
  EXPECT_TRUE(made.isWide({0, 0, -6.9}));
  EXPECT_FALSE(made.isWide({0, 0, -7.1}));
  EXPECT_FALSE(light(IesLamp(), ",at=0,0,3").isWide({0, 0, 2.9}));
  // Points of the opening: .8 along C0, .6 along C90.
  Vec3 far(0.0);
  for (const double u : {0.0, 0.5, 0.999}) {
    for (const double v : {0.0, 0.5, 0.999}) {
      const LightRay ray = made.ray({0, 0, 1}, u, v);
      const Vec3 point = Vec3(0, 0, 1) + ray.distance * ray.toward;
      EXPECT_NEAR(point.z, 3, 1e-12);
      far = glm::max(far, glm::abs(point));
    }
  }
  EXPECT_NEAR(far.x, .4, 1e-12);
  EXPECT_NEAR(far.y, .3, 1e-12);
}

// Every shape has the intensity of its file, up to what its size does to the square of a distance
// of 4.5 sizes.
TEST_F(PhotometricLights, OfAllShapesSendTheirIntensity) {
  for (const char* opening : {"2 .6 .8 0", "2 -.6 0 0", "2 .6 .8 .3", "2 -.6 0 .5", "2 0 .9 -.1"}) {
    IesLamp lamp;
    lamp.vertical = {0, 180};
    lamp.opening = opening;
    const Light made = light(lamp, "");
    for (const Vec3& to : {Vec3(1, 2, -3), Vec3(0, 1, 1), Vec3(2, 0, -.5)}) {
      const double size = std::get<PhotometricLight>(made.kind).file.table().size();
      const Vec3 place = 4.5 * size * glm::normalize(to);
      double sum = 0;
      constexpr int kSteps = 64;
      for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
          sum += made.ray(place, (i + .5) / kSteps, (j + .5) / kSteps).share;
        }
      }
      const double candela =
          sum / kSteps / kSteps * glm::dot(place, place) * made.strength[0] * 683;
      EXPECT_NEAR(candela, 100, 100 * 1.5 / (4.5 * 4.5)) << opening << " " << to.x;
    }
  }
}

// A line of length 2 a, of the same intensity I everywhere, each length of it I / 2 a: at h across
// its middle the integral of h / (h^2 + x^2)^(3/2) is 1 / (h sqrt(h^2 + a^2)), and at d > a from
// its middle along it that of 1 / (d - x)^2 is 1 / (d^2 - a^2).
TEST_F(PhotometricLights, OfALineShineNearBy) {
  constexpr double kA = .6;
  const auto mean = [](const Light& light, const Vec3& place, const Vec3& normal) {
    EXPECT_TRUE(light.isWide(place));
    constexpr int kSteps = 2000;  // of midpoints: 1e-6 at h = a / 3
    double sum = 0;
    for (int k = 0; k < kSteps; ++k) {
      const LightRay ray = light.ray(place, (k + .5) / kSteps, .3);
      sum += ray.share * glm::dot(ray.toward, normal) / kSteps;
    }
    return sum * light.strength[0] * kLumensPerWatt;
  };
  EulumdatLamp eulumdat;
  eulumdat.symmetry = 1;
  eulumdat.rows = {0};
  eulumdat.area = "0\n1200\n0\n0\n0\n0\n";
  IesLamp ies;
  ies.vertical = {0, 180};
  const auto of_ies = [&](const char* opening) {
    ies.opening = opening;
    return light(ies, ",1W");
  };
  const std::string file = write("lamp.ldt", eulumdat.text());
  const std::pair<Light, Vec3> lamps[] = {{of_ies("2 0 1.2 0"), {1, 0, 0}},
                                          {of_ies("2 1.2 0 0"), {0, 1, 0}},
                                          {of_ies("2 0 0 1.2"), {0, 0, 1}},
                                          {lightOf("ies," + file + ",1W"), {1, 0, 0}}};
  for (const auto& [lamp, along] : lamps) {
    const Vec3 across(along.z, along.x, along.y);
    const double candela = kLumensPerWatt / (4 * std::numbers::pi);
    for (const double h : {.2, 1.0, 5.0}) {
      EXPECT_NEAR(mean(lamp, h * across, -across), candela / (h * std::hypot(h, kA)),
                  1e-5 * candela / (h * h))
          << h;
    }
    EXPECT_NEAR(mean(lamp, 1.5 * along, -along), candela / (1.5 * 1.5 - kA * kA), 1e-5 * candela);
  }
}

// So does a plate in its own plane: of a square of side 2 a, what stands at x on an axis of it and
// faces it has from the strip at s, in the mean over its length, the same as across a line.
TEST_F(PhotometricLights, OfAPlateShineInItsPlane) {
  IesLamp lamp;
  lamp.vertical = {0, 180};
  lamp.opening = "2 1 1 0";
  const Light made = light(lamp, ",1W");
  constexpr int kSteps = 200;
  double sum = 0;
  double expected = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double s = (i + .5) / kSteps - .5;
    expected += 1 / ((2 - s) * std::hypot(2 - s, .5)) / kSteps;
    for (int j = 0; j < kSteps; ++j) {
      const LightRay ray = made.ray({2, 0, 0}, (i + .5) / kSteps, (j + .5) / kSteps);
      sum += ray.share * -ray.toward.x / kSteps / kSteps;
    }
  }
  // Midpoints across t are off by 1e-6 of it.
  EXPECT_NEAR(sum * 4 * std::numbers::pi, expected, 1e-5 * expected);
}

TEST_F(PhotometricLights, TextsGiveTheSameLightAgain) {
  const Light made = light(quarters(), ",1,2,3W,at=1,2,2.5,aim=0,.1,0,turn=-30,name=Desk%20lamp");
  std::filesystem::remove(path("lamp.ies"));
  const std::vector<std::string> texts = otherLights({&made, 1});
  EXPECT_EQ(texts[0].find_first_of(" \t\n;"), std::string::npos);
  const std::vector<Light> again = lightsOf({}, texts, 3);
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again[0], made);
  EXPECT_EQ(otherLights(again), texts);
  EXPECT_EQ(made.briefText(), ",file=lamp.ies,at=1,2,2.5,aim=0,0.1,0,turn=-30,name=Desk%20lamp");
  EXPECT_EQ(standText(made, Up::z), "at 1,2,2.5, lamp.ies");
  EXPECT_EQ(made.parameterNames(), (std::vector<std::string>{"file", "at", "aim", "turn"}));
}

TEST_F(PhotometricLights, ChangeByName) {
  test::SceneBuilder builder;
  builder.level(builder.surface("floor"), 0, 0, 1, 1, 0);
  Scene scene = builder.scene();
  IesLamp lamp;
  lamp.lamps = "1 100";
  SceneOverrides changes;
  changes.lights = {lightOf("ies," + write("lamp.ies", lamp.text()) + ",at=0,0,2")};
  applyOverrides(scene, changes);
  EXPECT_NOTE(scene.notes, "lamp.ies: its table gives 628.319 lm, and its lamps 100 lm",
              Severity::warning);
  EXPECT_NOTE(scene.notes,
              "ies: flux 0 -> 0.919939 W, 683 lm/W at Y of Rec. 709, at 0,0,2, lamp.ies",
              Severity::info);
  std::filesystem::remove(path("lamp.ies"));
  SceneOverrides others;
  others.set = {"ies.flux=900lm", "ies.at=0,0,3", "ies.turn=20"};
  applyOverrides(scene, others);
  EXPECT_NEAR(scene.lights.back().strength[0], 900 / 683.0, 1e-15);
  EXPECT_EQ(*scene.lights.back().place(), Vec3(0, 0, 3));
  EXPECT_TRUE(scene.lights.back().photometric);
  validate(scene);
  others.set = {"ies.flux=2"};
  applyOverrides(scene, others);
  EXPECT_FALSE(scene.lights.back().photometric);
}

TEST_F(PhotometricLights, ThatAreNoneAreRefusedInALine) {
  const std::string file = write("lamp.ies", IesLamp().text());
  const auto refusal = [](const std::string& text) {
    return test::inputErrorOf([&] {
      Light light = lightOf(text);
      light.settle(Up::z);
      light.validate();
    });
  };
  EXPECT_EQ(refusal("ies"), "ies: it has no file; give file=lamp.ies or file=lamp.ldt");
  EXPECT_EQ(refusal("ies,900lm,at=0,0,1,file="), "light='ies': file '' is not LAMP.ies|.ldt");
  EXPECT_EQ(refusal("ies,7"), "ies: it has no file; give file=lamp.ies or file=lamp.ldt");
  EXPECT_CONTAINS(refusal("ies,none.ies"), "none.ies: no such file");
  EXPECT_EQ(refusal("ies," + file + ",at=1,1,1,aim=1,1,1"),
            "ies: a lamp needs two finite places, other than each other: at and aim");
  EXPECT_EQ(refusal("ies," + file + ",turn=400"), "turn: 400 degrees is out of range; -360 to 360");
  EXPECT_EQ(refusal("ies," + file + ",flux=bright"),
            "light='ies': '" + file +
                ",flux=bright' is not one finite number or three with commas, "
                "W (or lm)");
  EXPECT_CONTAINS(refusal("ies," + file + ",width=3"),
                  "'width' is no parameter of it; there are flux, name, file, at, aim, turn");
  EXPECT_EQ(refusal("ies,1,file=a.ies|c|0"),
            "a.ies: its table is damaged; give the lamp's file again, and write %7c for a | in its "
            "name");
  EXPECT_CONTAINS(refusal("ies,1,file=a|b.ies"), "a: its table is damaged");
  write("a|b.ies", IesLamp().text());
  EXPECT_EQ(lightOf("ies,1,file=" + path("a%7cb.ies")).fileName(), "a|b.ies");
}

}  // namespace
}  // namespace radiosity
