// Scenes made in memory: from triangles, and the messages for invalid ones.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "radiosity/patch_mesh.h"
#include "radiosity/scene.h"

namespace radiosity {
namespace {

Material named(const std::string& name) {
  Material material;
  material.name = name;
  return material;
}

/// Two triangles that make a unit square, of two materials.
Scene square() {
  const std::vector<Vec3> vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<std::array<Index, 3>> triangles = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<Material> materials = {named("left"), named("right")};
  const std::vector<Index> of = {1, 0};
  return sceneOfTriangles(vertices, triangles, materials, of);
}

std::string refusal(const std::function<void(Scene&)>& spoil) {
  Scene scene = square();
  spoil(scene);
  Progress quiet;
  try {
    meshScene(scene, {}, quiet);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SceneOfTriangles, BecomesPatchesOfItsMaterials) {
  Progress quiet;
  MeshOptions as_given;
  as_given.faces_as_patches = true;
  const PatchMesh mesh = meshScene(square(), as_given, quiet).mesh;
  ASSERT_EQ(mesh.size(), 2u);
  EXPECT_EQ(mesh.area[0], 0.5);
  EXPECT_EQ(mesh.surface_names[mesh.surface[0]], "right");
  EXPECT_EQ(mesh.surface_names[mesh.surface[1]], "left");
}

TEST(SceneOfTriangles, NeedsAMaterialForEachTriangleOrOneForAll) {
  const std::vector<Vec3> vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  const std::vector<std::array<Index, 3>> triangles = {{0, 1, 2}};
  const std::vector<Material> materials = {named("grey")};
  EXPECT_EQ(sceneOfTriangles(vertices, triangles, materials).faceCount(), 1u);
  const std::vector<Index> two = {0, 0};
  EXPECT_THROW(sceneOfTriangles(vertices, triangles, materials, two), InputError);
  EXPECT_THROW(sceneOfTriangles(vertices, triangles, {}), InputError);
}

TEST(SceneValidation, NamesTheElementAndItsFault) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal([](Scene&) {}), "");
  EXPECT_EQ(refusal([&](Scene& s) { s.vertices[2].y = nan; }),
            "scene: vertex 2: a coordinate is no finite number");
  EXPECT_EQ(refusal([](Scene& s) { s.corners[4] = 9; }),
            "scene: face 1: there is no vertex 9; there are 4");
  EXPECT_EQ(refusal([](Scene& s) { s.face_surface[0] = 7; }),
            "scene: face 0: there is no surface 7; there are 2");
  EXPECT_EQ(refusal([](Scene& s) { s.face_offset.pop_back(); }),
            "scene: 2 faces need 3 offsets, it has 2");
  EXPECT_EQ(refusal([](Scene& s) { s.face_offset[1] = 7; }), "scene: face 1: its offsets go down");
  EXPECT_EQ(refusal([](Scene& s) { s.surfaces[1].material = 5; }),
            "scene: surface 1: there is no material 5; there are 2");
  EXPECT_EQ(refusal([](Scene& s) { s.surfaces[1].name = s.surfaces[0].name; }),
            "scene: surface 1: another one is named 'left', too");
  EXPECT_EQ(refusal([](Scene& s) { s.materials[0].reflectance.y = 1.5; }),
            "scene: material 0: its reflectance 1.5 is not in [0, 1]");
  EXPECT_EQ(refusal([](Scene& s) { s.materials[0].emission.x = -1; }),
            "scene: material 0: its emission -1 is negative or no finite number");
  EXPECT_EQ(refusal([](Scene& s) { s.materials[1].texture = 0; }),
            "scene: material 1: there is no texture 0; there are 0");
  EXPECT_EQ(refusal([&](Scene& s) { s.lights[0].strength[0] = nan; }),
            "sky radiance nan is not a finite value of 0 or more");
  EXPECT_EQ(refusal([&](Scene& s) { s.lights[0].strength.pop_back(); }),
            "scene: sky has 2 values of radiance, it takes 3");
}

}  // namespace
}  // namespace radiosity
