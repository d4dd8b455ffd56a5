// Colours of vertices as reflectance, in formats that do not say what they mean.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

#include "radiosity/scene.h"
#include "support/scene_files.h"

namespace radiosity::test {
namespace {

/// A triangle with a colour at each corner, as text.
std::string ply(const std::string& type, const std::array<std::string, 3>& colours) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\n";
  for (const char* band : {"red", "green", "blue"}) {
    text += fmt::format("property {} {}\n", type, band);
  }
  text +=
      "property uchar alpha\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::array<const char*, 3> places = {"0 0 0", "1 0 0", "0 1 0"};
  for (std::size_t k = 0; k < 3; ++k) text += fmt::format("{} {} 7\n", places[k], colours[k]);
  return text + "3 0 1 2\n";
}

constexpr const char* kCollada = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert>
<diffuse><color>0.5 1 1 1</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<source id="c"><float_array id="ca" count="9">0.25 0.5 1 0.25 0.5 1 0.25 0.5 1</float_array><technique_common>
<accessor source="#ca" count="3" stride="3"><param name="R" type="float"/><param name="G" type="float"/>
<param name="B" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1" material="m"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="COLOR" source="#c" offset="1"/><p>0 0 1 1 2 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"><bind_material>
<technique_common><instance_material symbol="m" target="#m"/></technique_common></bind_material>
</instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";

class SceneColours : public SceneFiles {
 protected:
  Scene load(const std::string& name, const std::string& content, VertexColours meaning) const {
    SceneOptions options;
    options.vertex_colours = meaning;
    return loadScene(write(name, content), options);
  }
  std::string errorOf(const std::string& name, const std::string& content) const {
    return inputErrorOf([&] { load(name, content, VertexColours::linear); });
  }
};

TEST_F(SceneColours, OfAPlyAreTheReflectance) {
  const std::string bytes = ply("uchar", {"255 0 51", "255 0 102", "255 0 255"});
  const Scene linear = load("a.ply", bytes, VertexColours::linear);
  EXPECT_EQ(linear.colours, (std::vector<Vec3>{{1, 0, 0.2}, {1, 0, 0.4}, {1, 0, 1}}));
  EXPECT_EQ(linear.materials[0].reflectance, Vec3(1.0));
  EXPECT_NOTE(linear.notes, "no material; the colours of vertices are the reflectance",
              Severity::warning);
  const Scene srgb = load("a.ply", bytes, VertexColours::srgb);
  // (0.2 + 0.055) / 1.055 to the 2.4th, by hand.
  EXPECT_NEAR(srgb.colours[0].z, 0.0331047666, 1e-9);
  EXPECT_EQ(srgb.colours[2], Vec3(1, 0, 1));
  const Scene words =
      load("b.ply", ply("ushort", {"65535 0 13107", "0 0 0", "0 0 0"}), VertexColours::linear);
  EXPECT_EQ(words.colours[0], Vec3(1, 0, 0.2));
  const Scene fractions =
      load("c.ply", ply("float", {"1 0 0.25", "0 0 0", "0 0 0"}), VertexColours::linear);
  EXPECT_EQ(fractions.colours[0], Vec3(1, 0, 0.25));
}

TEST_F(SceneColours, AreNotUsedUnlessAskedFor) {
  const Scene plain =
      load("a.ply", ply("uchar", {"255 0 0", "0 0 0", "0 0 0"}), VertexColours::unused);
  EXPECT_TRUE(plain.colours.empty());
  EXPECT_EQ(plain.materials[0].reflectance, Vec3(0.5));
  EXPECT_NOTE(plain.notes, "vertex_colours='srgb' or linear does", Severity::info);
}

constexpr const char* kObj =
    "mtllib m.mtl\no bare\nv 0 0 0\nv 1 0 0\nv 0 1 0 .25 .5 .75\nf 1 2 3\n"
    "o painted\nusemtl paint\nf 1 2 3\n";

TEST_F(SceneColours, OfAnObjMultiplyTheMaterial) {
  write("m.mtl", "newmtl paint\nKd .4 .4 .4\n");
  const Scene scene = load("a.obj", kObj, VertexColours::linear);
  ASSERT_EQ(scene.colours.size(), 6u);
  // Corners without a colour: the default reflectance, or no change of the material's.
  EXPECT_EQ(scene.colours[0], Vec3(0.5));
  EXPECT_EQ(scene.colours[2], Vec3(0.25, 0.5, 0.75));
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(1.0));
  EXPECT_EQ(scene.colours[3], Vec3(1.0));
  EXPECT_EQ(scene.colours[5], Vec3(0.25, 0.5, 0.75));
  EXPECT_EQ(scene.materialOf(1).reflectance, Vec3(0.4));
  const Scene plain = load("a.obj", kObj, VertexColours::unused);
  EXPECT_TRUE(plain.colours.empty());
  EXPECT_NOTE(plain.notes, "(vertex_colours='srgb' or linear does), in: bare", Severity::info);
}

TEST_F(SceneColours, OfOtherFormatsMultiplyTheMaterial) {
  const Scene scene = load("a.dae", kCollada, VertexColours::linear);
  EXPECT_EQ(scene.colours, std::vector<Vec3>(3, Vec3(0.25, 0.5, 1)));
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(0.5, 1, 1));
  const Scene plain = load("a.dae", kCollada, VertexColours::unused);
  EXPECT_TRUE(plain.colours.empty());
  EXPECT_NOTE(plain.notes, "colours of vertices do not change the reflectance", Severity::warning);
}

TEST_F(SceneColours, OfOtherFormatsAreTheReflectanceWithoutAMaterial) {
  std::string collada = kCollada;
  const std::size_t materials = collada.find("<library_effects>");
  collada.erase(materials, collada.find("<library_geometries>") - materials);
  const Scene scene = load("a.dae", collada, VertexColours::linear);
  EXPECT_EQ(scene.colours, std::vector<Vec3>(3, Vec3(0.25, 0.5, 1)));
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(1.0));
}

TEST_F(SceneColours, OutsideTheRangeAreRefused) {
  EXPECT_CONTAINS(errorOf("a.ply", ply("float", {"0 0 0", "0 128 0", "0 0 0"})),
                  "the colour of vertex 1 is outside 0 to 1; scale it");
  EXPECT_CONTAINS(errorOf("a.obj", "v 0 0 0 0 0 128\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
                  "a.obj:1: the colour 128 is outside 0 to 1; scale it");
  EXPECT_CONTAINS(errorOf("b.obj", "v 0 0 0 1 0 0 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
                  "b.obj:1: a vertex with a colour has 6 numbers, not 7");
  std::string collada = kCollada;
  collada.replace(collada.find("0.25 0.5 1 "), 10, "-.25 0.5 1");
  EXPECT_CONTAINS(errorOf("a.dae", collada), "a colour of vertex 0 is outside 0 to 1; scale it");
}

TEST_F(SceneColours, MissingOnesAreNoted) {
  const Scene scene = load("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", VertexColours::srgb);
  EXPECT_NOTE(scene.notes, "vertex_colours: no vertex has a colour", Severity::warning);
  EXPECT_EQ(scene.materials[0].reflectance, Vec3(0.5));
}

}  // namespace
}  // namespace radiosity::test
