// A scene's own mesh with the coordinates of a lightmap, read back by tinygltf.
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "radiosity/lightmap.h"
#include "radiosity/results.h"
#include "scene/gltf/gltf_file.h"
#include "scene/gltf/gltf_placement.h"
#include "support/lit_scene.h"
#include "support/results_folder.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

using Json = nlohmann::json;

/// Writes a glTF file with a buffer and an image beside it: under a node "House" that is moved, a
/// floor of two triangles in a strip with a texture, the same two-sided plate twice, once mirrored,
/// a lamp, and a block whose faces share their vertices.
class GltfWriter {
 public:
  std::string write(const std::filesystem::path& folder) {
    Image pixel{1, 1, {0.5f, 0.5f, 0.5f, 1}};
    writeImage((folder / "grey.png").string(), pixel, true);
    const Json floor = primitive({{0, 0, 0}, {0, 0, 2}, {2, 0, 0}, {2, 0, 2}}, {0, 1, 0}, {}, 0);
    const Json plate = primitive({{0, 0, 0}, {0, 0, .6f}, {.6f, 0, .6f}, {.6f, 0, 0}}, {0, 1, 0},
                                 {0, 1, 2, 0, 2, 3}, 1);
    const Json lamp =
        primitive({{0, 2, 0}, {2, 2, 0}, {2, 2, 2}, {0, 2, 2}}, {0, -1, 0}, {0, 1, 2, 0, 2, 3}, 2);
    const Json block = primitive({{1, .2f, 1.2f},
                                  {1.4f, .2f, 1.2f},
                                  {1.4f, .2f, 1.6f},
                                  {1, .2f, 1.6f},
                                  {1, .6f, 1.2f},
                                  {1.4f, .6f, 1.2f},
                                  {1.4f, .6f, 1.6f},
                                  {1, .6f, 1.6f}},
                                 {0, 1, 0}, {0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 7, 6, 0, 4, 5, 0, 5, 1,
                                             1, 5, 6, 1, 6, 2, 2, 6, 7, 2, 7, 3, 3, 7, 4, 3, 4, 0},
                                 2);
    Json document = {
        {"asset", {{"version", "2.0"}, {"copyright", "nobody"}}},
        {"scene", 0},
        {"scenes", {{{"nodes", {0}}, {"extras", {{"kept", 7}}}}}},
        {"nodes",
         {{{"name", "House"}, {"children", {1, 2, 3, 4, 5}}, {"translation", {10, 0, 0}}},
          {{"name", "Floor"}, {"mesh", 0}, {"extras", {{"tag", "f"}}}},
          {{"name", "Left"}, {"mesh", 1}, {"translation", {0.2, 1, 0.2}}},
          {{"name", "Right"}, {"mesh", 1}, {"translation", {1.8, 1, 1}}, {"scale", {-1, 1, 1}}},
          {{"name", "Lamp"}, {"mesh", 2}},
          {{"name", "Block"}, {"mesh", 3}}}},
        {"meshes",
         {{{"name", "floor mesh"}, {"primitives", {floor}}},
          {{"name", "plate mesh"}, {"primitives", {plate}}},
          {{"name", "lamp mesh"}, {"primitives", {lamp}}},
          {{"name", "block mesh"}, {"primitives", {block}}}}},
        {"materials",
         {{{"name", "tiles"},
           {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
           {"extras", {{"shop", "x"}}}},
          {{"name", "paper"}, {"doubleSided", true}},
          {{"name", "glow"}, {"emissiveFactor", {1, 1, 1}}}}},
        {"textures", {{{"source", 0}}}},
        {"images", {{{"uri", "grey.png"}}}},
        {"accessors", accessors_},
        {"bufferViews", views_},
        {"buffers", {{{"uri", "house.bin"}, {"byteLength", bytes_.size()}}}}};
    document["meshes"][0]["primitives"][0]["mode"] = 5;
    std::ofstream(folder / "house.bin", std::ios::binary)
        .write(bytes_.data(), std::streamsize(bytes_.size()));
    std::ofstream(folder / "house.gltf") << document;
    return (folder / "house.gltf").string();
  }

 private:
  using Vec3f = std::array<float, 3>;

  Json primitive(const std::vector<Vec3f>& at, const Vec3f& normal,
                 const std::vector<std::uint16_t>& indices, int material) {
    std::vector<std::array<float, 2>> uv;
    for (std::size_t k = 0; k < at.size(); ++k) uv.push_back({float(k), 0.25f});
    Json attributes = {{"POSITION", add(at, "VEC3", 5126)},
                       {"NORMAL", add(std::vector<Vec3f>(at.size(), normal), "VEC3", 5126)},
                       {"TEXCOORD_0", add(uv, "VEC2", 5126)}};
    Vec3f low = at[0];
    Vec3f high = at[0];
    for (const Vec3f& p : at) {
      for (std::size_t c = 0; c < 3; ++c) {
        low[c] = std::min(low[c], p[c]);
        high[c] = std::max(high[c], p[c]);
      }
    }
    accessors_[attributes["POSITION"].get<std::size_t>()]["min"] = low;
    accessors_[attributes["POSITION"].get<std::size_t>()]["max"] = high;
    Json result = {{"attributes", attributes}, {"material", material}};
    if (!indices.empty()) result["indices"] = add(indices, "SCALAR", 5123);
    return result;
  }

  template <class T>
  int add(const std::vector<T>& values, const char* type, int component) {
    views_.push_back(
        {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", values.size() * sizeof(T)}});
    const auto* first = reinterpret_cast<const char*>(values.data());
    bytes_.insert(bytes_.end(), first, first + values.size() * sizeof(T));
    accessors_.push_back({{"bufferView", views_.size() - 1},
                          {"componentType", component},
                          {"count", values.size()},
                          {"type", type}});
    return int(accessors_.size()) - 1;
  }

  std::vector<char> bytes_;
  Json views_ = Json::array();
  Json accessors_ = Json::array();
};

constexpr ElementOptions kCoarse{.tolerance = 0.5, .most_vertices = 1000, .rays = 64};

class LightmapGlb : public FolderTest {
 protected:
  void bake(const std::string& source) {
    lit = std::make_unique<test::LitScene>(loadScene(source), 40, kCoarse);
    map = makeLightmap(lit->scene, lit->mesh, lit->light, {.size = 128}, progress_);
    const bool gltf = source.ends_with("gltf") || source.ends_with("glb");
    std::filesystem::create_directories(folder_ / "out");
    set = writeLightmapGlb(path("out/baked.glb"), lit->scene, map,
                           {"map.exr", 1.5, gltf ? source : ""});
    baked = parseGltf(path("out/baked.glb"));
  }

  static std::vector<double> attribute(const GltfFile& file, const tinygltf::Primitive& primitive,
                                       const std::string& name) {
    const int accessor = primitive.attributes.at(name);
    const int type = file.model.accessors[std::size_t(accessor)].type;
    return file.readNumbers(accessor, tinygltf::GetNumComponentsInType(std::uint32_t(type)), name);
  }

  /// An attribute at each corner of the triangles of a primitive, a strip's too.
  static std::vector<double> atCorners(const GltfFile& file, const tinygltf::Primitive& primitive,
                                       const std::string& name) {
    const std::vector<double> values = attribute(file, primitive, name);
    const std::size_t count =
        file.model.accessors[std::size_t(primitive.attributes.at(name))].count;
    const std::size_t width = values.size() / count;
    std::vector<Index> corners;
    if (primitive.indices >= 0) {
      corners = file.readIndices(primitive.indices, name);
    } else {
      for (Index k = 0; k < count; ++k) corners.push_back(k);
    }
    if (primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
      EXPECT_EQ(corners.size(), 4u);
      corners = {corners[0], corners[1], corners[2], corners[1], corners[3], corners[2]};
    }
    std::vector<double> result;
    for (const Index k : corners) {
      for (std::size_t c = 0; c < width; ++c) result.push_back(values[k * width + c]);
    }
    return result;
  }

  std::unique_ptr<test::LitScene> lit;
  Lightmap map;
  int set = 0;
  GltfFile baked;
};

TEST_F(LightmapGlb, KeepsTheContentsOfTheFile) {
  const std::string source = GltfWriter().write(folder_);
  bake(source);
  EXPECT_EQ(set, 1);
  const GltfFile given = parseGltf(source);
  const tinygltf::Model& before = given.model;
  const tinygltf::Model& after = baked.model;
  ASSERT_EQ(after.nodes.size(), before.nodes.size());
  for (std::size_t n = 0; n < before.nodes.size(); ++n) {
    EXPECT_EQ(after.nodes[n].name, before.nodes[n].name);
    EXPECT_EQ(after.nodes[n].children, before.nodes[n].children);
    EXPECT_EQ(after.nodes[n].translation, before.nodes[n].translation);
    EXPECT_EQ(after.nodes[n].scale, before.nodes[n].scale);
    EXPECT_EQ(after.nodes[n].extras, before.nodes[n].extras);
    if (before.nodes[n].mesh < 0) continue;
    const tinygltf::Mesh& old_mesh = before.meshes[std::size_t(before.nodes[n].mesh)];
    const tinygltf::Mesh& new_mesh = after.meshes[std::size_t(after.nodes[n].mesh)];
    EXPECT_EQ(new_mesh.name, old_mesh.name);
    for (const char* name : {"POSITION", "NORMAL", "TEXCOORD_0"}) {
      EXPECT_EQ(atCorners(baked, new_mesh.primitives[0], name),
                atCorners(given, old_mesh.primitives[0], name))
          << before.nodes[n].name << " " << name;
    }
  }
  EXPECT_NE(after.nodes[2].mesh, after.nodes[3].mesh) << "light differs on instances";
  EXPECT_EQ(after.asset.copyright, "nobody");
  EXPECT_EQ(after.scenes[0].extras.Get("kept").GetNumberAsInt(), 7);
  EXPECT_EQ(after.scenes[0].extras.Get("lightmap").Get("texCoord").GetNumberAsInt(), 1);
  EXPECT_EQ(after.scenes[0].extras.Get("lightmap").Get("file").Get<std::string>(), "map.exr");
  for (std::size_t m = 0; m < before.materials.size(); ++m) {
    EXPECT_TRUE(after.materials[m] == before.materials[m]) << m;
  }
  // The image stands in the file itself, byte for byte.
  ASSERT_GE(after.images[0].bufferView, 0);
  EXPECT_EQ(after.images[0].mimeType, "image/png");
  const auto bytes = baked.imageBytes(after.images[0], "image");
  const std::vector<char> png = load(path("grey.png"));
  EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), png.begin(), png.end(),
                         [](unsigned char a, char b) { return char(a) == b; }));
}

/// The places of a face's corners in the map, by the file and by the map itself.
TEST_F(LightmapGlb, CoordinatesEqualThoseOfTheMap) {
  bake(GltfWriter().write(folder_));
  const Scene again = loadScene(path("out/baked.glb"));
  // Faces of the file: the floor's, a plate's fronts and backs, the other's, the lamp's.
  std::vector<std::pair<std::size_t, std::size_t>> primitives;  // node, primitive
  for (std::size_t n = 1; n <= 4; ++n) {
    const auto& mesh = baked.model.meshes[std::size_t(baked.model.nodes[n].mesh)];
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) primitives.emplace_back(n, p);
  }
  ASSERT_EQ(primitives.size(), 6u);
  std::size_t face = 0;
  std::size_t found = 0;
  for (const auto& [n, p] : primitives) {
    const auto& primitive =
        baked.model.meshes[std::size_t(baked.model.nodes[n].mesh)].primitives[p];
    const std::vector<double> uv = atCorners(baked, primitive, "TEXCOORD_1");
    const bool mirrored = baked.model.nodes[n].name == "Right";
    for (std::size_t t = 0; t < uv.size() / 6; ++t, ++face) {
      const std::span<const Index> corners = again.face(face);
      const Vec3 turn = glm::cross(again.vertices[corners[1]] - again.vertices[corners[0]],
                                   again.vertices[corners[2]] - again.vertices[corners[0]]);
      const bool down = p == 1 || baked.model.nodes[n].name == "Lamp";
      EXPECT_EQ(turn.y < 0, down) << baked.model.nodes[n].name << " " << p;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 at = again.vertices[corners[k]];
        const std::size_t stored = mirrored ? (3 - k) % 3 : k;  // as the file winds it
        const Vec2 there(uv[6 * t + 2 * stored], uv[6 * t + 2 * stored + 1]);
        for (const LightmapTriangle& of_map : map.triangles) {
          if (of_map.side != p) continue;
          for (std::size_t c = 0; c < 3; ++c) {
            const Vec3 corner = lit->scene.vertices[lit->scene.face(of_map.face)[of_map.corner[c]]];
            if (glm::distance(corner, at) > 1e-6) continue;
            EXPECT_LT(glm::distance(of_map.texcoord[c], there), 1e-6);
            ++found;
            break;
          }
        }
      }
    }
  }
  EXPECT_EQ(face + 12, again.faceCount()) << "the block's faces come last";
  EXPECT_GE(found, 3 * face);
}

TEST_F(LightmapGlb, BacksHaveAPrimitiveOfTheirOwn) {
  bake(GltfWriter().write(folder_));
  const tinygltf::Mesh& mesh = baked.model.meshes[std::size_t(baked.model.nodes[2].mesh)];
  ASSERT_EQ(mesh.primitives.size(), 2u);
  const int material = mesh.primitives[0].material;
  EXPECT_EQ(mesh.primitives[1].material, material);
  EXPECT_EQ(baked.model.materials[std::size_t(material)].name, "paper");
  EXPECT_FALSE(baked.model.materials[std::size_t(material)].doubleSided);
  std::vector<double> front = attribute(baked, mesh.primitives[0], "NORMAL");
  for (double& n : front) n = -n;
  EXPECT_EQ(attribute(baked, mesh.primitives[1], "NORMAL"), front);
  EXPECT_NE(attribute(baked, mesh.primitives[1], "TEXCOORD_1"),
            attribute(baked, mesh.primitives[0], "TEXCOORD_1"));
}

/// Three charts meet at each of the block's eight vertices.
TEST_F(LightmapGlb, ChartsDoNotShareVertices) {
  bake(GltfWriter().write(folder_));
  const tinygltf::Primitive& block =
      baked.model.meshes[std::size_t(baked.model.nodes[5].mesh)].primitives[0];
  for (const auto& [name, accessor] : block.attributes) {
    EXPECT_EQ(baked.model.accessors[std::size_t(accessor)].count, 24u) << name;
  }
}

/// The lamp at four places: the floor's corners, as translations.
TEST_F(LightmapGlb, CopiesOfANodeBecomeNodes) {
  const std::string source = GltfWriter().write(folder_);
  Json document;
  std::ifstream(source) >> document;
  const Json& floor = document["meshes"][0]["primitives"][0]["attributes"]["POSITION"];
  document["nodes"][4]["extensions"] = {
      {kGltfInstancing, {{"attributes", {{"TRANSLATION", floor}}}}}};
  // The node's weights, which move the lamp's corners, go with its copies.
  document["meshes"][2]["primitives"][0]["targets"] = {{{"POSITION", floor}}};
  document["nodes"][4]["weights"] = {0.5};
  document["extensionsUsed"] = {kGltfInstancing};
  document["extensionsRequired"] = {kGltfInstancing};
  std::ofstream(source) << document;
  bake(source);
  const tinygltf::Node& lamp = baked.model.nodes[4];
  EXPECT_EQ(lamp.mesh, -1);
  EXPECT_TRUE(lamp.weights.empty());
  EXPECT_TRUE(lamp.extensions.empty());
  EXPECT_TRUE(baked.model.extensionsUsed.empty());
  EXPECT_TRUE(baked.model.extensionsRequired.empty());
  ASSERT_EQ(lamp.children.size(), 4u);
  std::set<std::vector<double>> maps;
  for (const int child : lamp.children) {
    const int mesh = baked.model.nodes[std::size_t(child)].mesh;
    EXPECT_EQ(baked.model.nodes[std::size_t(child)].name, "Lamp");
    const auto& primitives = baked.model.meshes[std::size_t(mesh)].primitives;
    ASSERT_EQ(primitives.size(), 1u);
    maps.insert(atCorners(baked, primitives[0], "TEXCOORD_1"));
  }
  EXPECT_EQ(maps.size(), 4u) << "each copy has a place in the map";
  const auto ceiling = [](const Scene& scene) {
    std::vector<std::array<double, 3>> corners;
    for (std::size_t f = 0; f < scene.faceCount(); ++f) {
      for (const Index v : scene.face(f)) {
        const Vec3& at = scene.vertices[v];
        if (std::abs(at.y - 2) < 1e-6) corners.push_back({at.x, at.y, at.z});
      }
    }
    std::ranges::sort(corners);
    return corners;
  };
  EXPECT_EQ(ceiling(loadScene(path("out/baked.glb"))), ceiling(lit->scene));
  EXPECT_EQ(ceiling(lit->scene).size(), 24u);
}

TEST_F(LightmapGlb, OtherFilesGiveAPlainMesh) {
  bake(RADIOSITY_SOURCE_DIR "/data/cornell-box.obj");
  EXPECT_EQ(set, 1);
  const Scene again = loadScene(path("out/baked.glb"));
  ASSERT_EQ(again.surfaces.size(), lit->scene.surfaces.size());
  for (const Surface& surface : lit->scene.surfaces) {
    const auto same = std::find_if(again.surfaces.begin(), again.surfaces.end(),
                                   [&](const Surface& s) { return s.object == surface.name; });
    ASSERT_NE(same, again.surfaces.end()) << surface.name;
    const Material& a = lit->scene.materials[surface.material];
    const Material& b = again.materials[same->material];
    EXPECT_EQ(a.name, b.name);
    EXPECT_LT(glm::distance(a.reflectance, b.reflectance), 1e-12);
    EXPECT_LT(glm::distance(a.emission, b.emission), 1e-12 * (1 + glm::length(a.emission)));
  }
}

TEST_F(LightmapGlb, AChangedFileIsRefused) {
  const std::string source = GltfWriter().write(folder_);
  bake(source);
  std::string text;
  {
    std::ifstream file(source);
    text.assign(std::istreambuf_iterator<char>(file), {});
  }
  const std::string before = R"("translation":[10,0,0])";
  text.replace(text.find(before), before.size(), R"("translation":[11,0,0])");
  std::ofstream(source) << text;
  expectError<InputError>(source, "has changed since the scene was read", [&] {
    writeLightmapGlb(path("again.glb"), lit->scene, map, {"map.exr", 0, source});
  });
  EXPECT_FALSE(std::filesystem::exists(path("again.glb")));
}

}  // namespace
}  // namespace radiosity
