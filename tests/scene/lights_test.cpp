// Lights without a surface: their texts, and what they send.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "radiosity/light.h"
#include "scene/lights/light_text.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

constexpr double kPi = std::numbers::pi;

double radiansOf(double degrees) { return degrees * kPi / 180; }

/// The message of the refusal of a light's text.
std::string refusal(const std::string& text) {
  try {
    Light light = lightOf(text);
    light.settle(Up::z);
    light.validate();
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

Sun sunOf(const std::string& text, Up up) {
  Light light = lightOf("sun", text);
  light.settle(up);
  return std::get<Sun>(light.kind);
}

TEST(Lights, TextsGiveTheSameLightAgain) {
  for (const char* text :
       {"point,3,at=1,2,2.5", "point,1,2,3,at=1e-7,-2,1e6,range=4,name=Desk%20lamp%2c%20left",
        "spot,7,at=0,0,3,aim=0,1,0,inner=10,outer=30", "sun,1000,toward=1,2,3,diameter=0",
        "sun,5,elevation=30,azimuth=90,north=7", "sky,1,2,3"}) {
    const Light light = lightOf(text);
    const std::vector<Light> of_text =
        lightsOf(skyRadiance({&light, 1}), otherLights({&light, 1}), 3);
    ASSERT_EQ(of_text.size(), 1u) << text;
    EXPECT_EQ(of_text[0], light) << text;
  }
  EXPECT_EQ(lightOf("point,1,name=Desk%20lamp%2c%20left").name, "Desk lamp, left");
  // No space, for keys of stages separate their values by it.
  EXPECT_EQ(lightOf("point,1,name=Desk%20lamp").parametersText(), ",name=Desk%20lamp");
}

TEST(Lights, StrengthsComeInSeveralUnits) {
  EXPECT_EQ(lightOf("point,800cd").strength, std::vector<double>(3, 800.0 / 683));
  EXPECT_EQ(lightOf("point,intensity=800cd,at=1,2,3").strength, lightOf("point,800cd").strength);
  EXPECT_EQ(lightOf("point,8W/sr").strength, std::vector<double>(3, 8.0));
  EXPECT_EQ(lightOf("sun,68300lx").strength, std::vector<double>(3, 100.0));
  EXPECT_EQ(lightOf("sun").strength, std::vector<double>(3, 1000.0));
  for (const char* text : {"point,800cd", "point,900lm", "sun,68300lx", "sky,5cd/m^2"}) {
    const Light light = lightOf(text);
    EXPECT_TRUE(light.photometric) << text;
    EXPECT_TRUE(arePhotometric({&light, 1})) << text;
  }
  for (const char* text : {"point,8W/sr", "point,9W", "sun", "sky,5", "point,0cd"}) {
    const Light light = lightOf(text);
    EXPECT_FALSE(arePhotometric({&light, 1})) << text;
  }
  // A point spreads its power over 4 pi; rounding of one product.
  EXPECT_NEAR(lightOf("point,900lm").strength[0], 900 / 683.0 / (4 * kPi), 1e-15);
  EXPECT_NEAR(lightOf("point,9W").strength[0], 9 / (4 * kPi), 1e-15);
  // Whatever is said first, the cone counts: half a sphere, all of it alike.
  EXPECT_NEAR(lightOf("spot,6W,inner=90,outer=90").strength[0], 6 / (2 * kPi), 1e-15);
}

TEST(Lights, ASpotHasItsPower) {
  const SpotLight spot{Vec3(0.0), Vec3(0, 0, -1), 20, 50, 0};
  double power = 0;
  // The midpoint rule over a smooth function with two kinks: h^2.
  constexpr int kSteps = 20000;
  for (int k = 0; k < kSteps; ++k) {
    const double angle = kPi * (k + 0.5) / kSteps;
    const Vec3 place(std::sin(angle), 0, -std::cos(angle));
    power += spot.ray(place, 0, 0).share * 2 * kPi * std::sin(angle) * kPi / kSteps;
  }
  EXPECT_NEAR(power, spot.power(), 1e-7 * power);
  EXPECT_NEAR(spot.ray({0, 0, -2}, 0, 0).share, 0.25, 1e-16);
  EXPECT_EQ(spot.ray({0, 0, 2}, 0, 0).share, 0.0);
}

// The window of KHR_lights_punctual: max(0, 1 - (d / range)^4) / d^2.
TEST(Lights, ARangeEndsALight) {
  const PointLight light{Vec3(0.0), 2};
  EXPECT_NEAR(light.ray({1, 0, 0}, 0, 0).share, 1 - 1.0 / 16, 1e-15);
  EXPECT_EQ(light.ray({3, 0, 0}, 0, 0).share, 0.0);
  EXPECT_FALSE(light.share({1, 0, 0}, {0, 1, 0}, {0, 0, 1}));
}

// Computed with 30 digits by quadrature of cos / r^2 (van Oosterom & Strackee's formula agrees).
TEST(Lights, ATriangleHasItsSolidAngle) {
  const Vec3 a(1, 0, 2);
  const Vec3 b(2, .5, 1.5);
  const Vec3 c(.5, 2, 1);
  const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
  for (const Vec3& at : {Vec3(0.0), Vec3(1e3, -7, 5e2)}) {
    const PointLight light{at, 0};
    // Places a thousand away lose three digits.
    EXPECT_NEAR(*light.share(a + at, b + at, c + at) * area, 0.256850984813721, 1e-12);
  }
  // A whole octant, and far away: the cosine over the square.
  EXPECT_NEAR(*PointLight().share({1, 0, 0}, {0, 1, 0}, {0, 0, 1}) * std::sqrt(3) / 2, kPi / 2,
              1e-14);
  EXPECT_NEAR(*PointLight().share({1e6, 0, 0}, {1e6, 1, 0}, {1e6, 0, 1}), 1e-12, 1e-17);
}

// I. Reda, A. Andreas, "Solar position algorithm for solar radiation applications",
// NREL/TP-560-34302 (2008), table A5.1: 50.11162 degrees from the zenith, at 820 mbar. What the air
// of sea level bends more is .004 degrees; .01 is what the almanac's formula claims.
TEST(Lights, TheSunStandsWhereItIsPublished) {
  const SolarPosition stands = solarPosition(39.742476, -105.1786, "2003-10-17T12:30:30-07:00");
  EXPECT_NEAR(stands.elevation, 90 - 50.11162, 0.01);
  EXPECT_NEAR(stands.azimuth, 194.34024, 0.01);
  const SolarPosition utc = solarPosition(39.742476, -105.1786, "2003-10-17T19:30:30Z");
  EXPECT_NEAR(utc.elevation, stands.elevation, 1e-9);
}

TEST(Lights, TheSunKnowsWhereUpIs) {
  const double low = std::sqrt(0.75);
  // East is +x in both; north is +y where z is up, and -z where y is. Roundings of sines.
  EXPECT_NEAR(glm::distance(sunOf("1,elevation=30,azimuth=90", Up::z).toward, Vec3(low, 0, .5)), 0,
              1e-15);
  EXPECT_NEAR(glm::distance(sunOf("1,elevation=30,azimuth=90", Up::y).toward, Vec3(low, .5, 0)), 0,
              1e-15);
  EXPECT_NEAR(glm::distance(sunOf("1,elevation=30,azimuth=0", Up::z).toward, Vec3(0, low, .5)), 0,
              1e-15);
  EXPECT_NEAR(glm::distance(sunOf("1,elevation=30,azimuth=0", Up::y).toward, Vec3(0, .5, -low)), 0,
              1e-15);
  EXPECT_NEAR(
      glm::distance(sunOf("1,elevation=30,azimuth=0,north=90", Up::z).toward, Vec3(low, 0, .5)), 0,
      1e-15);
  // Unnamed: a place and a time. It is south of Berlin at noon, as high as its declination says.
  const Sun noon = sunOf("52.5,13.4,2026-06-21T11:08Z", Up::z);
  EXPECT_NEAR(std::asin(noon.toward.z), radiansOf(90 - 52.5 + 23.44), radiansOf(0.05));
  EXPECT_NEAR(noon.toward.x, 0, 0.01);
  EXPECT_LT(noon.toward.y, 0);
  // Angles replace a direction, one of them that part of it alone.
  Light low_sun = lightOf("sun,1,elevation=30,azimuth=90");
  low_sun.settle(Up::y);
  std::get<Sun>(low_sun.kind).elevation = 45;
  low_sun.settle(Up::y);
  EXPECT_NEAR(
      glm::distance(std::get<Sun>(low_sun.kind).toward, Vec3(std::sqrt(.5), std::sqrt(.5), 0)), 0,
      1e-15);
  EXPECT_EQ(standText(low_sun, Up::y), "45 degrees above the horizon, azimuth 90");
  EXPECT_NEAR(sunOf("1,toward=1,0,0,elevation=90", Up::z).toward.z, 1, 1e-15);
}

TEST(Lights, ADiscHasItsSize) {
  const Sun sun = sunOf("1,toward=0,0,2,diameter=2", Up::z);
  double farthest = 0;
  Vec3 sum(0.0);
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j < 64; ++j) {
      const Vec3 way = sun.ray(Vec3(0.0), (i + 0.5) / 64, (j + 0.5) / 64).toward;
      farthest = std::max(farthest, std::acos(way.z));
      sum += way;
    }
  }
  EXPECT_NEAR(farthest, radiansOf(1), radiansOf(1) / 64);
  EXPECT_NEAR(glm::length(Vec2(sum)) / 4096, 0, 1e-12);
}

// Blender's lamps and materials may have one name.
TEST(Lights, AMaterialKeepsItsPropertiesBesideALightOfItsName) {
  test::SceneBuilder builder;
  builder.level(builder.surface("Light"), 0, 0, 1, 1, 0);
  Scene scene = builder.scene();
  addLight(scene.lights, lightOf("point,1,name=Light"));
  SceneOverrides changes;
  changes.set = {"Light.emission=7", "Light.intensity=3", "sky.radiance=2"};
  applyOverrides(scene, changes);
  EXPECT_EQ(scene.materials[0].emission, Vec3(7.0));
  EXPECT_EQ(scene.lights[1].strength, std::vector<double>(3, 3.0));
  EXPECT_EQ(scene.lights[0].strength, std::vector<double>(3, 2.0));
}

TEST(Lights, WhatIsNoLightIsRefusedInALine) {
  EXPECT_EQ(refusal("lamp,1"),
            "light: no light is called 'lamp'; there are sky, point, spot, sun, ies, "
            "cie-sky, perez-sky, image-sky");
  EXPECT_EQ(refusal("point"),
            "light='point': '' is not one finite number or three with commas, W/sr (or cd)");
  EXPECT_EQ(refusal("point,1,x=3"),
            "light='point': 'x' is no parameter of it; there are intensity, name, at, range");
  EXPECT_EQ(refusal("point,1,at=1,2"), "light='point': at '1,2' is not X,Y,Z");
  EXPECT_EQ(refusal("point,1lx"),
            "light='point': '1lx' is not one finite number or three with commas, W/sr (or cd)");
  EXPECT_EQ(refusal("point,nan"),
            "light='point': 'nan' is not one finite number or three with commas, W/sr (or cd)");
  EXPECT_EQ(refusal("point,-1"), "point intensity -1 is not a finite value of 0 or more");
  EXPECT_EQ(refusal("point,1,name=sun"),
            "light='point': 'sun' is the name of another light; give it one of its own");
  EXPECT_EQ(refusal("spot,1,at=1,1,1,aim=1,1,1"),
            "a spot needs two finite places, other than each other: at and aim");
  EXPECT_EQ(refusal("spot,1,inner=50,outer=40"),
            "a spot of inner 50 degrees and outer 40: give inner at most outer");
  EXPECT_EQ(
      refusal("sun,1,elevation=-5"),
      "sun: it is 5.0 degrees below the horizon and gives no light; for light from below give "
      "toward=X,Y,Z");
  EXPECT_EQ(refusal("sun,52,13,2026-01-01T00:00Z").substr(0, 27), "sun: at 2026-01-01T00:00Z i");
  for (const char* time : {"2026-02-30T12:00Z", "2026-06-21", "2026-06-21T12:00",
                           "1900-01-01T12:00Z", "2026-06-21T12:00+99:00", "noon"}) {
    EXPECT_NE(refusal("sun,52,13," + std::string(time)).find(time), std::string::npos) << time;
  }
}

}  // namespace
}  // namespace radiosity
