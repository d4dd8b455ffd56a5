// glTF 2.0: geometry that is packed, copied, bent by a skin, moved by morph targets or coloured.
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "radiosity/patch_mesh.h"
#include "radiosity/scene.h"
#include "support/gltf_document.h"
#include "support/scene_files.h"

namespace radiosity::test {
namespace {

class GltfGeometry : public GltfFiles {};

void expectNear(const Vec3& a, const Vec3& b) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-7) << "floats of size 1 to 10";
}

/// A grid of n x n squares, z a wave of x and y, in indexed triangles.
struct Grid {
  std::vector<float> positions;
  std::vector<std::uint32_t> corners;

  explicit Grid(std::uint32_t n) {
    for (std::uint32_t y = 0; y <= n; ++y) {
      for (std::uint32_t x = 0; x <= n; ++x) {
        positions.insert(positions.end(), {float(x), float(y), std::sin(float(x + 2 * y))});
      }
    }
    for (std::uint32_t y = 0; y < n; ++y) {
      for (std::uint32_t x = 0; x < n; ++x) {
        const std::uint32_t a = y * (n + 1) + x;
        const std::uint32_t b = a + n + 1;
        corners.insert(corners.end(), {a, a + 1, b + 1, a, b + 1, b});
      }
    }
  }
};

/// The grid with both its buffer views packed by meshoptimizer's encoder.
Document packedGrid(const Grid& grid) {
  Document d = triangle();
  d.json["accessors"].clear();
  d.json["bufferViews"].clear();
  d.bytes.clear();
  const std::size_t vertices = grid.positions.size() / 3;
  const std::size_t indices = grid.corners.size();
  std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(vertices, 12));
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), grid.positions.data(),
                                           vertices, 12));
  std::vector<unsigned char> order(meshopt_encodeIndexBufferBound(indices, vertices));
  order.resize(meshopt_encodeIndexBuffer(order.data(), order.size(), grid.corners.data(), indices));
  const auto addView = [&](const std::vector<unsigned char>& bytes, std::size_t count,
                           std::size_t stride, const char* mode) {
    d.json["bufferViews"].push_back({{"buffer", 1},
                                     {"byteLength", count * stride},
                                     {"extensions",
                                      {{"EXT_meshopt_compression",
                                        {{"buffer", 0},
                                         {"byteOffset", d.bytes.size()},
                                         {"byteLength", bytes.size()},
                                         {"byteStride", stride},
                                         {"count", count},
                                         {"mode", mode}}}}}});
    d.bytes.append(bytes.begin(), bytes.end());
  };
  addView(packed, vertices, 12, "ATTRIBUTES");
  addView(order, indices, 4, "TRIANGLES");
  d.json["accessors"] = {
      {{"bufferView", 0}, {"componentType", 5126}, {"count", vertices}, {"type", "VEC3"}},
      {{"bufferView", 1}, {"componentType", 5125}, {"count", indices}, {"type", "SCALAR"}}};
  d.json["meshes"][0]["primitives"][0]["indices"] = 1;
  d.json["extensionsUsed"] = {"EXT_meshopt_compression"};
  d.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  return d;
}

/// Its text, with the second buffer, which would hold the unpacked data and has none.
std::string withFallback(Document d, std::size_t size) {
  d.text();
  d.json["buffers"].push_back(
      {{"byteLength", size}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
  return d.json.dump();
}

TEST_F(GltfGeometry, UnpacksWhatMeshoptimizerPacked) {
  const Grid grid(20);
  const Scene scene = loadScene(write("packed.gltf", withFallback(packedGrid(grid), 1 << 20)));
  ASSERT_EQ(scene.faceCount(), grid.corners.size() / 3);
  for (std::size_t f = 0; f < scene.faceCount(); ++f) {
    // The encoder may begin a triangle with another of its corners, so we compare the sums.
    Vec3 sum(0.0);
    Vec3 expected(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      const float* p = grid.positions.data() + 3 * std::size_t(grid.corners[3 * f + k]);
      expected += Vec3(p[0], p[1], p[2]);
      sum += corner(scene, f, k);
    }
    EXPECT_LT(glm::length(sum - expected), 1e-12) << "face " << f;
  }
  EXPECT_EQ(findNote(scene.notes, "EXT_meshopt"), nullptr) << "it is read";
}

TEST_F(GltfGeometry, RefusesDamagedPackedData) {
  const Document good = packedGrid(Grid(3));
  std::size_t refused = 0;
  for (std::size_t k = 0; k < good.bytes.size(); ++k) {
    Document d = good;
    d.bytes[k] = char(d.bytes[k] ^ 0x55);
    const std::string file = write("damaged.gltf", withFallback(d, 1 << 20));
    try {
      loadScene(file);  // a changed number may still be one
    } catch (const InputError& error) {
      EXPECT_CONTAINS(std::string(error.what()), "damaged.gltf: ");
      ++refused;
    }
  }
  EXPECT_GT(refused, 2u) << "the first bytes of both parts tell their kinds, at least";
}

TEST_F(GltfGeometry, RefusesImpossibleSizesOfPackedData) {
  for (const char* field : {"count", "byteLength", "byteStride", "buffer", "byteOffset"}) {
    Document d = packedGrid(Grid(3));
    d.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][field] = 1ull << 40;
    const std::string file = write("size.gltf", withFallback(d, 1 << 20));
    EXPECT_CONTAINS(inputErrorOf([&] { loadScene(file); }), "size.gltf: buffer view 0");
  }
  Document d = packedGrid(Grid(3));
  d.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["count"] = "many";
  const std::string file = write("word.gltf", withFallback(d, 1 << 20));
  EXPECT_CONTAINS(inputErrorOf([&] { loadScene(file); }),
                  "what its JSON says of compressed geometry cannot be read");
}

TEST_F(GltfGeometry, RefusesDracoDataThatIsNone) {
  Document d = triangle();
  d.json["meshes"][0]["primitives"][0]["extensions"] = {
      {"KHR_draco_mesh_compression", {{"bufferView", 0}, {"attributes", {{"POSITION", 0}}}}}};
  EXPECT_CONTAINS(errorOf(d),
                  "mesh 0, primitive 0 cannot be unpacked (KHR_draco_mesh_compression); export the "
                  "scene again");
}

TEST_F(GltfGeometry, CopiesAMeshForEachInstance) {
  Document d = triangle();
  const int move = d.positions({1, 0, 0, 0, 5, 0, 0, 0, -2});
  const int scale = d.positions({1, 1, 1, 2, 2, 2, -1, 1, 1});
  d.json["nodes"][0]["translation"] = {10, 0, 0};
  d.json["nodes"][0]["extensions"] = {
      {"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", move}, {"SCALE", scale}}}}}};
  d.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const Scene scene = load(d);
  ASSERT_EQ(scene.faceCount(), 3u);
  EXPECT_EQ(scene.surfaces.size(), 1u) << "copies are one surface";
  expectNear(corner(scene, 0, 1), {12, 0, 0});
  expectNear(corner(scene, 1, 1), {12, 5, 0});
  expectNear(corner(scene, 2, 0), {10, 0, -2});
  // A mirrored copy keeps its front: normals stay +z.
  for (std::size_t f = 0; f < 3; ++f) {
    const Vec3 a = corner(scene, f, 0);
    EXPECT_GT(glm::cross(corner(scene, f, 1) - a, corner(scene, f, 2) - a).z, 0) << "face " << f;
  }
  d.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] = move;
  EXPECT_CONTAINS(errorOf(d), "ROTATION of its copies is not a list of 4 numbers");
}

/// The triangle with joints at nodes 1 and 2: one raised by 3, one turned by 90 degrees about z.
Document skinnedTriangle() {
  Document d = triangle();
  const int joints =
      d.add(std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, 5121, "VEC4", 4);
  const int weights =
      d.add(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, .5, .5, 0, 0}, 5126, "VEC4", 4);
  d.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = joints;
  d.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = weights;
  const double half = std::sqrt(0.5);
  d.json["nodes"][0]["skin"] = 0;
  d.json["nodes"][0]["scale"] = {7, 7, 7};  // does not count
  d.json["nodes"].push_back({{"translation", {0, 0, 3}}});
  d.json["nodes"].push_back({{"rotation", {0, 0, half, half}}});
  d.json["scenes"][0]["nodes"] = {0, 1, 2};
  d.json["skins"] = {{{"joints", {1, 2}}}};
  return d;
}

TEST_F(GltfGeometry, PutsSkinsIntoThePoseOfTheirNodes) {
  const Scene scene = load(skinnedTriangle());
  expectNear(corner(scene, 0, 0), {0, 0, 3});
  expectNear(corner(scene, 0, 1), {0, 1, 0});
  expectNear(corner(scene, 0, 2), {-.5, .5, 1.5});  // half (0, 1, 3), half (-1, 0, 0)
}

TEST_F(GltfGeometry, InverseBindMatricesTakeVerticesToTheirJoints) {
  Document d = skinnedTriangle();
  std::vector<float> matrices(32);
  for (std::size_t k : {0, 5, 10, 15, 16, 21, 26, 31}) matrices[k] = 1;
  matrices[14] = -3;  // the first joint undoes its own height
  d.json["skins"][0]["inverseBindMatrices"] = d.add(matrices, 5126, "MAT4", 16);
  expectNear(corner(load(d), 0, 0), {0, 0, 0});
  d.json["skins"][0]["joints"] = {1};
  EXPECT_CONTAINS(errorOf(d), "joint 1 does not exist, there are 1");
  d.json["skins"][0]["joints"] = nlohmann::json::array({1, 9});
  EXPECT_CONTAINS(errorOf(d), "refers to node 9, which does not exist");
}

TEST_F(GltfGeometry, MorphTargetsHaveTheWeightsOfTheFile) {
  Document d = triangle();
  const int up = d.positions({0, 0, 4, 0, 0, 4, 0, 0, 4});
  d.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", up}}};
  EXPECT_EQ(corner(load(d), 0, 0), Vec3(0, 0, 0)) << "without weights they are at rest";
  d.json["meshes"][0]["weights"] = {.25};
  EXPECT_EQ(corner(load(d), 0, 0), Vec3(0, 0, 1));
  d.json["nodes"][0]["weights"] = {.5};
  EXPECT_EQ(corner(load(d), 0, 0), Vec3(0, 0, 2)) << "a node's weights come first";
}

/// The triangle with a red, a green and a white corner and a material of reflectance .5.
Document colouredTriangle() {
  Document d = triangle();
  const int colours =
      d.add(std::vector<float>{1, 0, 0, 1, 0, 1, 0, 1, 1, 1, 1, 1}, 5126, "VEC4", 4);
  d.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = colours;
  d.json["materials"] = {
      {{"name", "paint"}, {"pbrMetallicRoughness", {{"baseColorFactor", {.5, .5, .5, 1}}}}}};
  d.json["meshes"][0]["primitives"][0]["material"] = 0;
  return d;
}

Vec3 meanReflectance(const Scene& scene, std::size_t patches) {
  MeshOptions options;
  options.patches = patches;
  Progress progress;
  const PatchMesh mesh = meshScene(scene, options, progress).mesh;
  const PatchMaterials materials = patchMaterials(scene, mesh);
  Vec3 sum(0.0);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (int b = 0; b < 3; ++b) {
      sum[b] += mesh.area[i] / 0.5 * materials.reflectance[3 * i + std::size_t(b)];
    }
  }
  return sum;
}

TEST_F(GltfGeometry, VertexColoursMultiplyTheReflectance) {
  const Scene scene = load(colouredTriangle());
  // The mean of a linear colour over the triangle is that of its corners: 2/3, 2/3, 1/3 of .5.
  for (const std::size_t patches : {1, 40}) {
    expectNear(meanReflectance(scene, patches), {1. / 3, 1. / 3, 1. / 6});
  }
  SceneOptions set;
  set.set = {"paint.reflectance=.25"};
  const Scene changed = load(colouredTriangle(), set);
  expectNear(meanReflectance(changed, 1), Vec3(.25));
  EXPECT_NOTE(changed.notes, "vertex colours are dropped (tint keeps them)", Severity::info);
  set.set = {"paint.tint=.5"};
  expectNear(meanReflectance(load(colouredTriangle(), set), 1), {1. / 6, 1. / 6, 1. / 12});
  SceneOptions off;
  off.textures = false;
  expectNear(meanReflectance(load(colouredTriangle(), off), 1), Vec3(.5));
}

TEST_F(GltfGeometry, VertexColoursThatAreLightAreNotReflectance) {
  Document d = colouredTriangle();
  d.json["materials"][0]["extensions"] = {{"KHR_materials_unlit", nlohmann::json::object()}};
  const Scene unlit = load(d);
  EXPECT_TRUE(unlit.colours.empty());
  EXPECT_NOTE(unlit.notes, "vertex colours of unlit materials are light", Severity::warning);
  Document bright = colouredTriangle();
  bright.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
      bright.positions({3, 0, 0, 0, 1, 0, 0, 0, 1});
  EXPECT_NOTE(load(bright).notes, "vertex colours outside 0 to 1 are no reflectance",
              Severity::warning);
}

}  // namespace
}  // namespace radiosity::test
