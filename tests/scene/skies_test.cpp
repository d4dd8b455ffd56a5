// Skies: how their light is spread, against quadrature, closed forms and the standard's own words.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>

#include "radiosity/light.h"
#include "scene/lights/light_text.h"
#include "support/scene_files.h"
#include "support/sky_files.h"

namespace radiosity {
namespace {

constexpr double kPi = std::numbers::pi;
/// The program's own quadrature is off by up to 6e-6.
constexpr double kQuadrature = 1e-5;

double radiansOf(double degrees) { return degrees * kPi / 180; }

Light skyOf(const std::string& text, Up up = Up::z) {
  std::vector<Light> lights{lightOf(text)};
  lights[0].settle(up);
  lights[0].validate();
  settleSkies(lights, up);
  return lights[0];
}

std::string refusalOf(const std::string& text) {
  try {
    skyOf(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

double radianceOf(const Light& sky, const Vec3& toward, bool whole = true) {
  std::vector<double> sum(3, 0.0);
  Background({&sky, 1}, 3, whole).add(toward, 1, sum);
  return sum[1];
}

/// z up, degrees.
Vec3 towards(double elevation, double azimuth) {
  const double e = radiansOf(elevation);
  const double a = radiansOf(azimuth);
  return {std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)};
}

/// Adaptive Simpson.
double integral(const std::function<double(double)>& f, double a, double b, double tolerance) {
  const std::function<double(double, double, double, double, double, double, double, int)> refine =
      [&](double from, double to, double at_from, double at_middle, double at_to, double whole,
          double most, int depth) -> double {
    const double middle = (from + to) / 2;
    const double left_middle = f((from + middle) / 2);
    const double right_middle = f((middle + to) / 2);
    const double left = (middle - from) / 6 * (at_from + 4 * left_middle + at_middle);
    const double right = (to - middle) / 6 * (at_middle + 4 * right_middle + at_to);
    const double off = left + right - whole;
    if (depth == 0 || std::abs(off) < 15 * most) return left + right + off / 15;
    return refine(from, middle, at_from, left_middle, at_middle, left, most / 2, depth - 1) +
           refine(middle, to, at_middle, right_middle, at_to, right, most / 2, depth - 1);
  };
  const double middle = f((a + b) / 2);
  const double at_a = f(a);
  const double at_b = f(b);
  return refine(a, b, at_a, middle, at_b, (b - a) / 6 * (at_a + 4 * middle + at_b), tolerance, 30);
}

/// Irradiance of a surface that faces `normal`, z up, of all that is above its horizon and ours;
/// pieces end where the sun is, at which radiance has a point.
double irradianceOf(const Light& sky, const Vec3& normal, double sun_elevation,
                    double sun_azimuth) {
  const Background background({&sky, 1}, 3, true);
  const auto ring = [&](double elevation) {
    const auto at = [&](double azimuth) {
      const Vec3 toward = towards(elevation, azimuth);
      std::vector<double> sum(3, 0.0);
      background.add(toward, 1, sum);
      return sum[1] * std::max(0.0, glm::dot(toward, normal));
    };
    const double size = std::cos(radiansOf(elevation)) * kPi / 180;
    return size * (integral(at, sun_azimuth, sun_azimuth + 180, 1e-7) +
                   integral(at, sun_azimuth + 180, sun_azimuth + 360, 1e-7));
  };
  // The limit of the gradation at the horizon is not its value below it.
  constexpr double kLow = 1e-9;
  return kPi / 180 *
         (integral(ring, kLow, sun_elevation, 1e-4) +
          integral(ring, sun_elevation, 90 - kLow, 1e-4));
}

TEST(Skies, OpenLevelGroundGetsTheirStrength) {
  for (int type = 1; type <= 16; ++type) {
    for (const double elevation : {12.0, 41.0, 80.0}) {
      const Light sky =
          skyOf(fmt::format("cie-sky,5,type={},elevation={},azimuth=130", type, elevation));
      EXPECT_NEAR(irradianceOf(sky, {0, 0, 1}, elevation, 130), 5, 5 * kQuadrature)
          << "type " << type << ", sun at " << elevation;
    }
  }
}

// a, b, c, d and e of the standard as pairs of its six gradations and six indicatrices.
TEST(Skies, RadianceIsThatOfTheStandard) {
  const std::pair<double, double> gradations[] = {{4, -.7},   {1.1, -.8}, {0, -1},
                                                  {-1, -.55}, {-1, -.32}, {-1, -.15}};
  const Vec3 indicatrices[] = {{0, -1, 0},    {2, -1.5, .15}, {5, -2.5, .3},
                               {10, -3, .45}, {16, -3, .3},   {24, -2.8, .15}};
  const std::pair<int, int> types[] = {{1, 1}, {1, 2}, {2, 1}, {2, 2}, {3, 1},
                                       {3, 2}, {3, 3}, {3, 4}, {4, 2}, {4, 3},
                                       {4, 4}, {5, 4}, {5, 5}, {6, 5}, {6, 6}};
  const double sun_elevation = 35;
  const Vec3 sun = towards(sun_elevation, 200);
  for (int type = 1; type <= 15; ++type) {
    const auto [a, b] = gradations[types[type - 1].first - 1];
    const Vec3 i = indicatrices[types[type - 1].second - 1];
    const auto relative = [&, a = a, b = b](const Vec3& toward) {
      const double chi = std::acos(glm::dot(sun, toward));
      return (1 + a * std::exp(b / toward.z)) *
             (1 + i.x * (std::exp(i.y * chi) - std::exp(i.y * kPi / 2)) +
              i.z * std::cos(chi) * std::cos(chi));
    };
    const Light sky =
        skyOf(fmt::format("cie-sky,5,type={},elevation={},azimuth=200", type, sun_elevation));
    const double zenith = radianceOf(sky, {0, 0, 1});
    for (const double elevation : {3.0, 20.0, 50.0, 77.0}) {
      for (const double azimuth : {0.0, 150.0, 199.0, 260.0}) {
        const Vec3 toward = towards(elevation, azimuth);
        // Rounding of some ten operations.
        EXPECT_NEAR(radianceOf(sky, toward) / zenith / (relative(toward) / relative({0, 0, 1})), 1,
                    1e-12)
            << "type " << type << " at " << elevation << ", " << azimuth;
      }
    }
  }
}

TEST(Skies, Type5IsAlikeAllOverAndType16IsMoonAndSpencers) {
  const Light alike = skyOf("cie-sky,5,type=5");
  const Light traditional = skyOf("cie-sky,5,type=16");
  for (const double elevation : {0.1, 10.0, 45.0, 90.0}) {
    EXPECT_NEAR(radianceOf(alike, towards(elevation, 77)), 5 / kPi, kQuadrature);
    // E = 7 pi / 9 of the zenith's radiance.
    EXPECT_NEAR(radianceOf(traditional, towards(elevation, 77)),
                5 * 9 / (7 * kPi) * (1 + 2 * std::sin(radiansOf(elevation))) / 3, kQuadrature);
  }
  // The integral over half of the hemisphere, 2 (pi / 4 + 2 / 3) / 3, over 7 pi / 9.
  EXPECT_NEAR(irradianceOf(traditional, {1, 0, 0}, 45, 0), 5 * (3 * kPi + 8) / (14 * kPi),
              5 * kQuadrature);
}

TEST(Skies, TheyTurnWithTheSunAndTheScene) {
  for (const char* kind : {"cie-sky,5,type=13", "perez-sky,200,direct=600"}) {
    const Light sky = skyOf(std::string(kind) + ",elevation=30,azimuth=100");
    const Light turned = skyOf(std::string(kind) + ",elevation=30,azimuth=160");
    const Light north = skyOf(std::string(kind) + ",elevation=30,azimuth=100,north=60");
    const Light tipped = skyOf(std::string(kind) + ",elevation=30,azimuth=100", Up::y);
    for (const double elevation : {5.0, 33.0, 70.0}) {
      for (const double azimuth : {90.0, 200.0, 330.0}) {
        const Vec3 toward = towards(elevation, azimuth);
        const double radiance = radianceOf(sky, toward);
        // Rounding of angles, where the sun's glare is steepest.
        EXPECT_NEAR(radianceOf(turned, towards(elevation, azimuth + 60)) / radiance, 1, 1e-9);
        EXPECT_NEAR(radianceOf(north, towards(elevation, azimuth + 60)) / radiance, 1, 1e-9);
        EXPECT_NEAR(radianceOf(tipped, {toward.x, toward.z, -toward.y}) / radiance, 1, 1e-9);
      }
    }
  }
}

// Ratios to the zenith, by the paper's formulas and table in another program; one of each bin of
// clearness but the fourth and the fifth, of which there are two.
TEST(Skies, PerezIsThatOfThePaper) {
  struct Case {
    double diffuse, direct, elevation;
    std::array<double, 4> ratios;
  };
  const Case cases[] = {
      {120, 0, 30, {1.048938854, 0.836160717, 0.605628225, 1.021815943}},
      {150, 60, 35, {8.953186538, 1.568355216, 1.799018008, 1.832105215}},
      {180, 150, 40, {8.00804016, 1.244517543, 1.613600484, 1.830001888}},
      {200, 350, 50, {3.644487749, 0.850354088, 0.963279904, 1.843418541}},
      {220, 500, 45, {5.172103345, 0.960209947, 1.055475586, 1.849898151}},
      {160, 600, 40, {7.483761241, 1.075964643, 1.626548328, 1.789458002}},
      {120, 700, 45, {5.92200368, 1.027333675, 1.972858893, 1.866585831}},
      {90, 850, 50, {3.932589389, 0.985084305, 2.187494683, 1.775594491}},
  };
  const Vec2 directions[] = {{30, 0}, {30, 90}, {10, 180}, {60, 45}};
  for (const Case& of : cases) {
    const Light sky = skyOf(fmt::format("perez-sky,{},direct={},elevation={},azimuth=70",
                                        of.diffuse, of.direct, of.elevation));
    const double zenith = radianceOf(sky, {0, 0, 1});
    for (std::size_t k = 0; k < of.ratios.size(); ++k) {
      const Vec3 toward = towards(directions[k].x, 70 + directions[k].y);
      EXPECT_NEAR(radianceOf(sky, toward) / zenith, of.ratios[k], 1e-8)  // its digits
          << of.diffuse << ", " << of.direct << ": direction " << k;
    }
    EXPECT_NEAR(irradianceOf(sky, {0, 0, 1}, of.elevation, 70), of.diffuse,
                of.diffuse * kQuadrature);
  }
}

TEST(Skies, LuxTakeTheEfficacyOfDaylight) {
  const Light watts = skyOf("perez-sky,160,direct=600,elevation=40,azimuth=70");
  const Light lux = skyOf("perez-sky,17600lx,efficacy=110,direct=600,elevation=40,azimuth=70");
  const double scale = 17600.0 / 683 / 160;
  for (const double azimuth : {70.0, 180.0}) {
    const Vec3 toward = towards(25, azimuth);
    EXPECT_NEAR(radianceOf(lux, toward) / radianceOf(watts, toward), scale, 1e-9 * scale);
  }
}

TEST(Skies, TheSunOfTheSceneIsTheirs) {
  std::vector<Light> lights{lightOf("sun,600,elevation=40,azimuth=70"),
                            lightOf("perez-sky,160,ground=0.2"),
                            lightOf("cie-sky,100,type=12,ground=0.5"),
                            lightOf("cie-sky,100,type=12,elevation=20,azimuth=10,name=other")};
  for (Light& light : lights) light.settle(Up::z);
  settleSkies(lights, Up::z);
  const Light perez = skyOf("perez-sky,160,direct=600,elevation=40,azimuth=70");
  const Light clear = skyOf("cie-sky,100,type=12,elevation=40,azimuth=70");
  const Light other = skyOf("cie-sky,100,type=12,elevation=20,azimuth=10");
  for (const double azimuth : {70.0, 180.0}) {
    const Vec3 toward = towards(25, azimuth);
    EXPECT_NEAR(radianceOf(lights[1], toward), radianceOf(perez, toward), 1e-9);
    EXPECT_NEAR(radianceOf(lights[2], toward), radianceOf(clear, toward), 1e-9);
    EXPECT_NEAR(radianceOf(lights[3], toward), radianceOf(other, toward), 1e-9);
  }
  // The ground: what falls on it, times its reflectance, over pi.
  const double by_sun = 600 * std::sin(radiansOf(40));
  EXPECT_NEAR(radianceOf(lights[1], towards(-30, 3)), 0.2 * (160 + by_sun) / kPi, 1e-9);
  EXPECT_NEAR(radianceOf(lights[2], towards(-1, 3)), 0.5 * (100 + by_sun) / kPi, 1e-9);
  EXPECT_EQ(radianceOf(lights[3], towards(-30, 3)), 0);
  // Another place of the sun changes them.
  std::get<Sun>(lights[0].kind).elevation = 20;
  lights[0].settle(Up::z);
  settleSkies(lights, Up::z);
  EXPECT_LT(radianceOf(lights[2], towards(-1, 3)), 0.5 * (100 + 0.9 * by_sun) / kPi);
}

TEST(Skies, TextsGiveTheSameSkyAgain) {
  for (const char* text : {"cie-sky,10000lx", "cie-sky,1,2,3,type=12,elevation=30,azimuth=5",
                           "perez-sky,18000lx,direct=400,elevation=30,ground=0.2,efficacy=120"}) {
    const Light sky = skyOf(text);
    const std::vector<std::string> texts = otherLights({&sky, 1});
    std::vector<Light> again = lightsOf({}, texts, 3);
    ASSERT_EQ(again.size(), 1u) << text;
    again[0].photometric = sky.photometric;  // files keep it beside the text
    EXPECT_EQ(again[0], sky) << text;
  }
  // A sky without a sun does not depend on that of the scene.
  EXPECT_EQ(skyOf("cie-sky,1").parametersText(), ",up=0,0,1");
}

TEST(Skies, WhatIsWrongIsRefused) {
  EXPECT_EQ(refusalOf("cie-sky,1,type=17"), "type: 17 is out of range; 1 to 16");
  EXPECT_EQ(refusalOf("cie-sky,1,type=clear"), "cie-sky: type 'clear' is not N");
  EXPECT_EQ(refusalOf("cie-sky,nan").substr(0, 40), "cie-sky: 'nan' is not one finite number ");
  EXPECT_EQ(refusalOf("cie-sky,1,type=12"),
            "cie-sky: its light depends on where the sun stands, and the scene has none above the "
            "horizon; give elevation=DEGREES,azimuth=DEGREES, or latitude, longitude and time");
  EXPECT_EQ(refusalOf("cie-sky,1,type=12,toward=1,0,-1"),
            "cie-sky: its sun is below the horizon; give an elevation above 0");
  EXPECT_EQ(refusalOf("cie-sky,1,type=12,toward=1,0,inf"),
            "cie-sky: toward '1,0,inf' is not X,Y,Z");
  EXPECT_EQ(refusalOf("cie-sky,1,ground=1.5"), "ground: 1.5 is out of range; 0 to 1");
  EXPECT_EQ(refusalOf("perez-sky,100,elevation=30"),
            "perez-sky: it depends on the direct irradiance of what faces the sun, and the scene "
            "has no sun; give direct=W/m^2");
  EXPECT_EQ(refusalOf("perez-sky,1e4,direct=1,elevation=30").substr(0, 60),
            "perez-sky: 1e+04 W/m^2 of diffuse light is more than any sky");
  const Light unsettled = lightOf("cie-sky,1,type=12,elevation=30");
  EXPECT_THROW(Background({&unsettled, 1}, 3), InputError);
  EXPECT_EQ(refusalOf("image-sky,1"),
            "image-sky: has no image; give file=SKY.hdr or SKY.exr first");
}

class SkyImages : public test::SceneFiles {
 protected:
  std::string image(int height, const std::function<Vec3(int, int)>& at) const {
    return write("sky.hdr", test::radianceHdr(2 * height, height, at));
  }
};

TEST_F(SkyImages, AreSeenTheRightWayRound) {
  // Eight columns, 45 degrees each; the middle is in the north.
  const std::string path = image(4, [](int x, int y) { return Vec3(1 + x, 16 * (1 + y), 0.5); });
  const Light sky = skyOf("image-sky," + path);
  const Light turned = skyOf("image-sky,2," + std::string("file=") + path + ",turn=90");
  const Light tipped = skyOf("image-sky," + path, Up::y);
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 4; ++y) {
      const Vec3 toward = towards(90 - 45 * (y + 0.5), 45 * (x + 0.5) - 180);
      std::vector<double> seen(3, 0.0);
      Background({&sky, 1}, 3, true).add(toward, 1, seen);
      EXPECT_EQ(seen, (std::vector<double>{1.0 + x, 16.0 * (1 + y), 0.5})) << x << ", " << y;
      EXPECT_EQ(radianceOf(tipped, {toward.x, toward.z, -toward.y}), 16.0 * (1 + y));
      std::vector<double> twice(3, 0.0);
      const Vec3 later = towards(90 - 45 * (y + 0.5), 45 * (x + 0.5) - 90);
      Background({&turned, 1}, 3, true).add(later, 1, twice);
      EXPECT_EQ(twice, (std::vector<double>{2.0 * (1 + x), 32.0 * (1 + y), 1})) << x << ", " << y;
    }
  }
}

// What rays leave out and what they are aimed at are the whole together.
TEST_F(SkyImages, ASunIsAimedAt) {
  const int height = 64;
  const std::string path = image(height, [](int x, int y) {
    const bool sun = x >= 70 && x < 72 && y >= 20 && y < 22;
    return sun ? Vec3(4096, 2048, 1024) : Vec3(0.5, 0.25, 1);
  });
  const Light sky = skyOf("image-sky," + path);
  const std::vector<Light> aimed = aimedLights({&sky, 1});
  ASSERT_EQ(aimed.size(), 1u);
  const double top = std::cos(kPi * 20 / height);
  const double bottom = std::cos(kPi * 22 / height);
  const double angle = (top - bottom) * 2 * kPi / height;
  const Vec3 in_sun = towards(90 - 180 * 21.0 / height, 360 * 71.0 / (2 * height) - 180);
  for (std::size_t b = 0; b < 3; ++b) {
    std::vector<double> kept(3, 0.0);
    Background({&sky, 1}, 3).add(in_sun, 1, kept);
    std::vector<double> whole(3, 0.0);
    Background({&sky, 1}, 3, true).add(in_sun, 1, whole);
    EXPECT_LT(kept[b], 0.01 * whole[b]);
    // Texels and their shares have 24 bits.
    EXPECT_NEAR(aimed[0].strength[b] * aimed[0].ray(Vec3(0), 0.5, 0.5).share,
                angle * (whole[b] - kept[b]), 1e-6 * angle * whole[b]);
  }
  for (const double u : {0.0, 0.3, 0.77, 0.999}) {
    for (const double v : {0.0, 0.5, 0.999}) {
      std::vector<double> there(3, 0.0);
      Background({&sky, 1}, 3, true).add(aimed[0].ray(Vec3(0), u, v).toward, 1, there);
      EXPECT_EQ(there[0], 4096) << u << ", " << v;
    }
  }
}

TEST_F(SkyImages, WhatIsNoSkyIsRefused) {
  const auto starts = [&](const std::string& file, const std::string& expected) {
    const std::string message = refusalOf("image-sky," + file);
    EXPECT_EQ(message.substr(0, expected.size()), expected);
  };
  starts(path("none.hdr"), path("none.hdr") + ": the image of the sky is not there");
  const std::string text = write("text.hdr", "no image");
  starts(text, text + ": the image of the sky cannot be decoded");
  const std::string square =
      write("square.hdr", test::radianceHdr(4, 4, [](int, int) { return Vec3(1); }));
  starts(square, square + ": has 4 x 4 pixels; an equirectangular image is twice as wide");
}

}  // namespace
}  // namespace radiosity
