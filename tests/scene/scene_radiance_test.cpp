// Radiance scenes: what primitives become, and every way a file can lie.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "radiosity/scene.h"
#include "scene/radiance/facets.h"
#include "support/scene_files.h"

namespace radiosity::test {
namespace {

constexpr double kPi = std::numbers::pi;

class SceneRadiance : public SceneFiles {
 protected:
  Scene load(const std::string& text, const SceneOptions& options = {}) {
    return loadScene(write("scene.rad", text), options);
  }
  std::string errorOf(const std::string& text) {
    const std::string file = write("scene.rad", text);
    return inputErrorOf([&] { loadScene(file); });
  }
  static std::string notesOf(const Scene& scene) {
    std::string all;
    for (const Note& note : scene.notes) all += note.text + "\n";
    return all;
  }
};

const std::string kGreyPlastic = "void plastic grey 0 0 5 .5 .4 .3 0 0\n";
const std::string kFloorOfGrey = "grey polygon square 0 0 12  0 0 0  1 0 0  1 1 0  0 1 0\n";

struct Measured {
  double area = 0;
  Vec3 vector{0.0};       ///< the sum of area times normal
  double volume = 0;      ///< enclosed, if they face outward
  double nearest = 1e30;  ///< distance of a facet's plane from the middle
  double farthest = 0;    ///< of a corner
};

Measured measure(const Facets& facets, const Vec3& middle) {
  Measured sum;
  for (const std::vector<Index>& face : facets.faces) {
    Vec3 area(0.0);
    const Vec3 a = facets.vertices[face[0]] - middle;
    for (std::size_t k = 2; k < face.size(); ++k) {
      area += glm::cross(facets.vertices[face[k - 1]] - middle - a,
                         facets.vertices[face[k]] - middle - a) /
              2.0;
    }
    sum.area += glm::length(area);
    sum.vector += area;
    sum.volume += glm::dot(area, a) / 3;
    sum.nearest = std::min(sum.nearest, std::abs(glm::dot(glm::normalize(area), a)));
    for (const Index corner : face) {
      sum.farthest = std::max(sum.farthest, glm::length(facets.vertices[corner] - middle));
      // Planar, but for rounding.
      EXPECT_NEAR(glm::dot(glm::normalize(area), facets.vertices[corner] - middle - a), 0, 1e-13);
    }
  }
  return sum;
}

TEST(RadianceFacets, SpheresKeepTheirArea) {
  const Vec3 middle(3, -1, 2);
  for (const double tolerance : {0.1, 0.005, 1e-4}) {
    const Facets facets = sphereFacets(middle, 0.5, tolerance);
    const Measured all = measure(facets, middle);
    EXPECT_NEAR(all.area, kPi, 1e-9);  // sums of up to 40,000 areas
    EXPECT_NEAR(glm::length(all.vector), 0, 1e-12);
    EXPECT_GT(all.volume, 0);
    EXPECT_LE(facets.off, tolerance);
    EXPECT_NEAR(std::max(all.farthest / 0.5 - 1, 1 - all.nearest / 0.5), facets.off, 1e-12);
  }
}

TEST(RadianceFacets, CansAreClosed) {
  const Vec3 a(1, 2, 3);
  const Vec3 b(2, 3, 4);  // an axis between all three
  Facets can = coneFacets(a, 0.3, b, 0.3, 0.005);
  const double side = measure(can, a).area;
  EXPECT_NEAR(side, 2 * kPi * 0.3 * std::sqrt(3) * can.area, 1e-12);
  EXPECT_GT(can.area, 1);
  EXPECT_LT(can.area, 1.0025);  // half of the tolerance
  const Vec3 axis = glm::normalize(b - a);
  // Corners meet: each of the caps is a corner of the side.
  for (const auto& [end, out] : {std::pair(a, -axis), std::pair(b, axis)}) {
    const Facets cap = ringFacets(end, out, 0, 0.3, 0.005);
    const Measured disc = measure(cap, end);
    EXPECT_NEAR(disc.area, kPi * 0.09, 1e-12);
    EXPECT_GT(glm::dot(disc.vector, out), 0);
    for (const Vec3& corner : cap.vertices) {
      double nearest = 1e30;
      for (const Vec3& other : can.vertices) {
        nearest = std::min(nearest, glm::distance(corner, other));
      }
      EXPECT_LT(nearest, 1e-14);  // some rounding of numbers of 3
    }
  }
}

TEST(RadianceFacets, ConesEndInAPoint) {
  const Facets cone = coneFacets({0, 0, 0}, 1, {0, 0, 2}, 0, 0.005);
  const Measured all = measure(cone, {0, 0, 0});
  for (const std::vector<Index>& face : cone.faces) EXPECT_EQ(face.size(), 3u);
  EXPECT_NEAR(all.area, kPi * std::sqrt(5) * cone.area, 1e-12);
  EXPECT_NEAR(all.vector.z, kPi, 1e-12);  // the disc that it stands on
  Facets cup = cone;
  cup.turnOver();
  EXPECT_NEAR(measure(cup, {0, 0, 0}).vector.z, -kPi, 1e-12);
}

TEST_F(SceneRadiance, MaterialsAreWhatModifies) {
  const Scene scene =
      load("# a comment\n" + kGreyPlastic +
           "void light bulb 0 0 3 1 2 3\n"
           "void trans paper 0 0 7 .8 .8 .8 0 0 .25 0\n"
           "void brightfunc dirt 2 dirty dirt.cal 0 0\n"
           "grey alias plain grey\n"  // of the modifier grey: a material that a material modifies
           "inherit alias same bulb\n"
           "dirt alias dirty grey\n"
           "void glow dim 0 0 4 1 1 1 2\n"
           "void glow seen 0 0 4 1 1 1 -1\n" +
           kFloorOfGrey +
           "bulb polygon lamp.1 0 0 9 0 0 1 1 0 1 0 1 1\n"
           "same polygon lamp.2 0 0 9 0 0 2 1 0 2 0 1 2\n"
           "paper polygon \"a sheet\" 0 0 9 0 0 3 1 0 3 0 1 3\n"
           "dirty polygon wall 0 0 9 0 0 4 1 0 4 0 1 4\n"
           "dim polygon glow1 0 0 9 0 0 5 1 0 5 0 1 5\n"
           "seen polygon glow2 0 0 9 0 0 6 1 0 6 0 1 6\n");
  const auto of = [&](const std::string& object) {
    for (const Surface& surface : scene.surfaces) {
      if (surface.object == object) return scene.materials[surface.material];
    }
    ADD_FAILURE() << object;
    return Material();
  };
  EXPECT_EQ(of("square").reflectance, Vec3(.5, .4, .3));
  EXPECT_TRUE(of("square").two_sided);
  EXPECT_EQ(of("lamp").radiance(), Vec3(1, 2, 3));
  EXPECT_EQ(of("lamp").reflectance, Vec3(0));
  EXPECT_FALSE(of("lamp").two_sided);
  EXPECT_EQ(of("a sheet").reflectance, Vec3(.8 * .75));
  EXPECT_EQ(of("wall").reflectance, Vec3(.5, .4, .3));
  EXPECT_EQ(of("glow1").radiance(), Vec3(1));
  EXPECT_EQ(of("glow2").radiance(), Vec3(0));
  EXPECT_EQ(scene.up, Up::z);
  EXPECT_CONTAINS(notesOf(scene), "transparency is not used");
  EXPECT_CONTAINS(notesOf(scene),
                  "brightfunc is not used, the colour alone counts, material: dirty");
  EXPECT_CONTAINS(notesOf(scene), "whatever its radius, material: dim");
  EXPECT_CONTAINS(notesOf(scene), "lights nothing, and is black, material: seen");
}

TEST_F(SceneRadiance, WhatIsLeftOutIsNamed) {
  const Scene scene = load(
      "void metal steel 0 0 5 .6 .6 .6 .9 .1\n"
      "void glass pane 0 0 3 .96 .96 .96\n"
      "void BSDF blind 6 0 a.xml 0 0 1 . 0 0\n"
      "void brightdata dist 3 flatcorr a.dat source.cal 0 1 1\n"
      "dist light lamp 0 0 3 9 9 9\n"
      "void spotlight spot 0 0 7 1 1 1 30 0 0 -1\n"
      "void antimatter hole 1 steel 0 0\n"
      "steel polygon a 0 0 9 0 0 1 1 0 1 0 1 1\n"
      "pane polygon b 0 0 9 0 0 2 1 0 2 0 1 2\n"
      "blind polygon c 0 0 9 0 0 3 1 0 3 0 1 3\n"
      "lamp polygon d 0 0 9 0 0 4 1 0 4 0 1 4\n"
      "spot polygon e 0 0 9 0 0 5 1 0 5 0 1 5\n"
      "hole sphere f 0 0 4 0 0 0 1\n");
  const std::string notes = notesOf(scene);
  EXPECT_CONTAINS(notes, "specularity and roughness are not used");
  EXPECT_CONTAINS(notes, "BSDF is not read, reflectance 0.5, material: blind");
  EXPECT_CONTAINS(notes, "the brightdata of a lamp is not read, its surfaces EMIT NOTHING");
  EXPECT_CONTAINS(notes, "spotlight is not read, its surfaces EMIT NOTHING");
  EXPECT_CONTAINS(notes, "surfaces of antimatter are left out: f");
  EXPECT_EQ(scene.faceCount(), 5u);
  EXPECT_EQ(scene.materials[scene.surfaces[0].material].reflectance, Vec3(.6));
  for (const Material& material : scene.materials) EXPECT_EQ(material.emission, Vec3(0));
}

TEST_F(SceneRadiance, SourcesAreSunsAndSkies) {
  const Scene scene = load(kGreyPlastic + kFloorOfGrey +
                           "void light solar 0 0 3 1e6 2e6 3e6\n"
                           "solar source sun 0 0 4 1 0 1 .533\n"
                           "void glow sky 0 0 4 1 2 3 0\n"
                           "sky source up 0 0 4 0 0 1 180\n"
                           "sky source down 0 0 4 0 0 -2 180\n"
                           "void glow low 0 0 4 5 5 5 0\n"
                           "low source ground 0 0 4 0 0 -1 180\n"
                           "low source wide 0 0 4 0 0 1 120\n");
  ASSERT_EQ(scene.lights.size(), 3u);  // sky, ground, sun
  EXPECT_TRUE(scene.lights[0].isUniform());
  EXPECT_EQ(scene.lights[0].strength, (std::vector<double>{1, 2, 3}));
  const Light& ground = scene.lights[1];
  EXPECT_EQ(ground.name, "ground");
  const Dome dome = ground.dome(true);
  for (const auto& [z, expected] : {std::pair(-0.6, 5.0), std::pair(0.6, 0.0)}) {
    std::array<double, 3> sum{};
    dome({0.8, 0, z}, 1, sum);
    EXPECT_NEAR(sum[1], expected, 5e-4);  // its irradiance is a quadrature to 1e-4
  }
  const Light& sun = scene.lights[2];
  EXPECT_EQ(sun.name, "sun");
  EXPECT_EQ(std::get<Sun>(sun.kind).diameter, .533);
  // The sun's disc takes 6.80e-5 sr.
  EXPECT_NEAR(sun.strength[0], 1e6 * kPi * std::pow(std::sin(.533 / 2 * kPi / 180), 2), 1e-9);
  EXPECT_NEAR(sun.strength[0], 67.97, .01);
  EXPECT_CONTAINS(notesOf(scene), "GIVE NO LIGHT: wide");
}

TEST_F(SceneRadiance, CurvedSurfacesAreReported) {
  SceneOptions options;
  options.curve_deviation = 0.05;
  const Scene coarse = load(kGreyPlastic + "grey cylinder a 0 0 7 0 0 0 0 0 1 .5\n", options);
  EXPECT_EQ(coarse.faceCount(), 12u);  // corners 4.9% outside
  const Scene scene = load(kGreyPlastic + "grey cylinder a 0 0 7 0 0 0 0 0 1 .5\n");
  EXPECT_CONTAINS(notesOf(scene),
                  "1 curved surface became 28 flat facets, up to 0.42% of a radius");
  EXPECT_CONTAINS(notesOf(scene), "have up to 0.21% more");
}

TEST_F(SceneRadiance, ErrorsNameLineAndPrimitive) {
  const auto says = [&](const std::string& text, const std::string& what) {
    SCOPED_TRACE(text);
    EXPECT_CONTAINS(errorOf(text), "scene.rad:2: ");
    EXPECT_CONTAINS(errorOf(text), what);
  };
  says(kGreyPlastic + "grey polygon p 0 0 8 0 0 0 1 0 0 1 1",
       "polygon p: has 8 numbers, it takes 9 or more");
  says(kGreyPlastic + "grey polygon p 0 0 10 0 0 0 1 0 0 1 1 0 1", "has 10 numbers");
  says(kGreyPlastic + "grey sphere s 0 0 4 0 0 0 -1", "sphere s: a radius of -1 is not above 0");
  says(kGreyPlastic + "grey sphere s 0 0 4 0 0 zero 1",
       "sphere s: argument `zero` is not a finite number");
  says(kGreyPlastic + "grey sphere s 0 0 4 0 0", "number of numbers 4: the file is too short");
  says(kGreyPlastic + "grey sphere s 0 0 99999999 0 0", "too short for so many");
  says(kGreyPlastic + "grey sphere s 0 -1 4 0 0 0 1", "cannot be negative");
  says(kGreyPlastic + "grey sphere s 1 x 0 4 0 0 0 1", "sphere s: has 1 strings, it takes none");
  says(kGreyPlastic + "grey cylinder c 0 0 7 1 1 1 1 1 1 2", "both ends are at one place");
  says(kGreyPlastic + "grey cone c 0 0 8 1 1 1 1 1 2 0 0", "both radii are 0");
  says(kGreyPlastic + "grey ring r 0 0 8 1 1 1 0 0 0 0 1", "ring r: has no direction");
  says(kGreyPlastic + "grey ring r 0 0 8 1 1 1 0 0 1 1 1", "its radii are equal");
  says(kGreyPlastic + "gray sphere s 0 0 4 0 0 0 1",
       "sphere s: its modifier `gray` is not defined before");
  says(kGreyPlastic + "void sphere s 0 0 4 0 0 0 1", "has no material");
  says(kGreyPlastic + "grey blob s 0 0 4 0 0 0 1", "`blob` is no type of primitive");
  says(kGreyPlastic + "grey instance i 1 tree.oct 0 0",
       "instance i: tree.oct is compiled and not read");
  says(kGreyPlastic + "grey mesh m 1 tree.rtm 0 0", "mesh m: tree.rtm is compiled and not read");
  says(kGreyPlastic + "!genbox grey box 1 2 3", "`!genbox grey box 1 2 3` is a command");
  says(kGreyPlastic + "void alias a b", "alias a: `b` is not defined before");
  says(kGreyPlastic + "void trans t 0 0 7 1 1 1 0 0 2 0\nt sphere s 0 0 4 0 0 0 1",
       "2 is not 0 to 1");
  says(kGreyPlastic + "grey source s 0 0 4 0 0 0 5", "has no direction");
  EXPECT_CONTAINS(errorOf(kGreyPlastic), "has no polygons, spheres");
  EXPECT_CONTAINS(errorOf("void plastic p 0 0 5 1.2 0 0 0 0\np sphere s 0 0 4 0 0 0 1"),
                  "material p: reflectance 1.2 0 0 is outside 0 to 1");
}

}  // namespace
}  // namespace radiosity::test
