// Meshes out: OBJ text, and glTF read back by tinygltf.
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <sstream>

#include "results_sample.h"
#include "support/results_folder.h"

namespace radiosity {
namespace {

class MeshFile : public FolderTest {};

tinygltf::Model parse(const std::string& path) {
  tinygltf::TinyGLTF reader;
  tinygltf::Model model;
  std::string error;
  std::string warning;
  EXPECT_TRUE(reader.LoadBinaryFromFile(&model, &error, &warning, path)) << error;
  EXPECT_EQ(error + warning, "");
  return model;
}

/// An accessor's values, after the checks of glTF 2.0, 3.6.2.4: alignment and bounds.
template <class T>
std::vector<T> values(const tinygltf::Model& model, int index) {
  const tinygltf::Accessor& accessor = model.accessors.at(std::size_t(index));
  const tinygltf::BufferView& view = model.bufferViews.at(std::size_t(accessor.bufferView));
  const std::size_t offset = view.byteOffset + accessor.byteOffset;
  EXPECT_EQ(offset % 4, 0u);
  EXPECT_EQ(view.byteStride, 0u);
  const std::size_t parts = accessor.type == TINYGLTF_TYPE_VEC3 ? 3 : 1;
  std::vector<T> result(accessor.count * parts);
  EXPECT_EQ(sizeof(T), 4u);
  EXPECT_LE(accessor.byteOffset + result.size() * 4, view.byteLength);
  EXPECT_LE(offset + result.size() * 4, model.buffers.at(0).data.size());
  std::memcpy(result.data(), model.buffers[0].data.data() + offset, result.size() * 4);
  return result;
}

struct Primitive {
  std::vector<float> position;
  std::vector<float> colour;
  std::vector<float> radiosity;
  std::vector<std::uint32_t> indices;
};

Primitive primitiveOf(const tinygltf::Model& model, const tinygltf::Primitive& p) {
  Primitive result;
  EXPECT_EQ(p.mode == -1 ? TINYGLTF_MODE_TRIANGLES : p.mode, TINYGLTF_MODE_TRIANGLES);
  EXPECT_EQ(model.accessors.at(std::size_t(p.indices)).componentType,
            TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
  result.indices = values<std::uint32_t>(model, p.indices);
  for (const auto& [name, index] : p.attributes) {
    EXPECT_EQ(model.accessors.at(std::size_t(index)).componentType, TINYGLTF_COMPONENT_TYPE_FLOAT);
    auto& target = name == "POSITION"  ? result.position
                   : name == "COLOR_0" ? result.colour
                                       : result.radiosity;
    EXPECT_TRUE(target.empty()) << name;
    target = values<float>(model, index);
  }
  for (const std::uint32_t v : result.indices) EXPECT_LT(v, result.position.size() / 3);
  const tinygltf::Accessor& position = model.accessors[std::size_t(p.attributes.at("POSITION"))];
  for (std::size_t c = 0; c < 3; ++c) {
    float low = result.position[c];
    float high = low;
    for (std::size_t k = c; k < result.position.size(); k += 3) {
      low = std::min(low, result.position[k]);
      high = std::max(high, result.position[k]);
    }
    EXPECT_EQ(position.minValues.at(c), double(low));
    EXPECT_EQ(position.maxValues.at(c), double(high));
  }
  return result;
}

/// The chunk structure itself, glTF 2.0, 4.4.
void expectValidContainer(const std::vector<char>& bytes) {
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return std::size_t(value);
  };
  ASSERT_GE(bytes.size(), 28u);
  EXPECT_EQ(word(0), 0x46546C67u);
  EXPECT_EQ(word(4), 2u);
  EXPECT_EQ(word(8), bytes.size());
  EXPECT_EQ(word(12) % 4, 0u);
  EXPECT_EQ(word(16), 0x4E4F534Au);
  const std::size_t binary = 20 + word(12);
  EXPECT_EQ(word(binary) % 4, 0u);
  EXPECT_EQ(word(binary + 4), 0x004E4942u);
  EXPECT_EQ(binary + 8 + word(binary), bytes.size());
}

double triangleArea(const Primitive& p, std::size_t t) {
  Vec3 v[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const float* q = &p.position[3 * std::size_t(p.indices[3 * t + k])];
    v[k] = {q[0], q[1], q[2]};
  }
  const Vec3 a = v[1] - v[0];
  const Vec3 b = v[2] - v[0];
  return 0.5 * std::hypot(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

/// Two unit squares that meet at x = 1 at a right angle, and the first one's back.
PatchMesh corner() {
  PatchMesh m;
  m.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 1}, {1, 1, 1}};
  m.corner_offset = {0, 4, 8, 12, 16};
  m.corners = {0, 1, 2, 3, 1, 4, 5, 2, 0, 1, 4, 4, 3, 2, 1, 0};
  m.piece_offset = {0, 2, 4, 4, 6};
  m.pieces = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}, {3, 2, 1}, {3, 1, 0}};
  m.centroid = {{.5, .5, 0}, {1, .5, .5}, {1, 0, 0}, {.5, .5, 0}};
  m.normal = {{0, 0, 1}, {-1, 0, 0}, {0, 0, 0}, {0, 0, -1}};
  m.area = {1, 1, 0, 1};
  m.polygon = {0, 1, kNone, 0};
  m.surface = {0, 1, 0, 0};
  m.index_in_surface = {0, 0, 1, 2};
  m.source_face = {0, 1, 2, 0};
  m.side = {0, 0, 0, 1};
  m.twin = {3, kNone, kNone, 0};
  m.surface_names = {"room/floor", "room/wall"};
  return m;
}

TEST_F(MeshFile, ObjHoldsOutlinesInOrder) {
  PatchMesh mesh = corner();
  mesh.vertices[5] = {1, 1. / 3, 1e-17};
  writeMesh(path("x.obj"), mesh);
  std::ifstream file(path("x.obj"));
  std::vector<Vec3> vertices;
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) {
    Vec3 v;
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", &v.x, &v.y, &v.z) == 3) {
      vertices.push_back(v);
    } else if (line[0] != '#') {
      lines.push_back(line);
    }
  }
  EXPECT_EQ(vertices, mesh.vertices);  // to the bit
  // The back of the first patch is the same face once more and is left out.
  EXPECT_EQ(lines, (std::vector<std::string>{"o room", "usemtl floor", "f 1 2 3 4", "o room",
                                             "usemtl wall", "f 2 5 6 3", "o room", "usemtl floor",
                                             "f 1 2 5 5"}));
}

/// As for --faces-as-patches: the same faces in the same order on surfaces of the same names.
TEST_F(MeshFile, ObjIsReadBackAsTheSameFaces) {
  PatchMesh mesh = sample::mesh(5);
  mesh.surface_names = {"box/red", "house/left wall/white paint"};
  writeMesh(path("x.obj"), mesh);
  const Scene scene = loadScene(path("x.obj"));
  EXPECT_EQ(scene.vertices, mesh.vertices);
  ASSERT_EQ(scene.faceCount(), 25u);
  for (std::size_t f = 0; f < 25; ++f) {
    EXPECT_TRUE(std::ranges::equal(scene.face(f), mesh.outline(f))) << f;
    EXPECT_EQ(scene.surfaces[scene.face_surface[f]].name, mesh.surface_names[mesh.surface[f]]);
  }
}

TEST_F(MeshFile, ObjKeepsABackWithoutAFront) {
  PatchMesh mesh = corner();
  mesh.twin = {kNone, kNone, kNone, kNone};
  writeMesh(path("x.obj"), mesh);
  const std::vector<char> text = load(path("x.obj"));
  EXPECT_NE(std::string(text.begin(), text.end()).find("f 4 3 2 1"), std::string::npos);
}

TEST_F(MeshFile, PlainGlbHasOneNodeASurface) {
  const PatchMesh mesh = corner();
  writeMesh(path("x.GLB"), mesh);
  expectValidContainer(load(path("x.GLB")));
  const tinygltf::Model model = parse(path("x.GLB"));
  ASSERT_EQ(model.nodes.size(), 2u);
  ASSERT_EQ(model.meshes.size(), 2u);
  EXPECT_EQ(model.scenes.at(0).nodes, (std::vector<int>{0, 1}));
  for (std::size_t s = 0; s < 2; ++s) {
    EXPECT_EQ(model.nodes[s].name, mesh.surface_names[s]);
    EXPECT_TRUE(model.nodes[s].translation.empty());
    ASSERT_EQ(model.meshes[s].primitives.size(), 1u);
    const tinygltf::Primitive& p = model.meshes[s].primitives[0];
    EXPECT_EQ(p.attributes.size(), 1u);  // no normals: flat
    EXPECT_EQ(model.materials.at(std::size_t(p.material)).doubleSided, s == 0);
    const Primitive primitive = primitiveOf(model, p);
    EXPECT_EQ(primitive.indices.size(), 6u);
    EXPECT_EQ(primitive.position.size(), 12u);
    EXPECT_EQ(triangleArea(primitive, 0) + triangleArea(primitive, 1), 1.0);
  }
}

TEST_F(MeshFile, LitGlbShowsExposedRadianceAndHoldsRadiosity) {
  const PatchMesh mesh = corner();
  const double pi = std::numbers::pi;
  const std::vector<double> b = {pi / 4, pi, 100, 1, 2, 3, 5, 5, 5, 0.5 * pi, 0.25 * pi, 0};
  writeLitGlb(path("x.glb"), mesh, b, 1.0, 30);
  expectValidContainer(load(path("x.glb")));
  const tinygltf::Model model = parse(path("x.glb"));
  EXPECT_EQ(model.extensionsUsed, (std::vector<std::string>{"KHR_materials_unlit"}));
  EXPECT_TRUE(model.extensionsRequired.empty());
  ASSERT_EQ(model.materials.size(), 1u);
  EXPECT_TRUE(model.materials[0].extensions.count("KHR_materials_unlit"));
  EXPECT_EQ(model.materials[0].pbrMetallicRoughness.baseColorFactor,
            (std::vector<double>{1, 1, 1, 1}));
  EXPECT_EQ(model.scenes.at(0).extras.Get("exposure_ev").GetNumberAsDouble(), 1.0);

  ASSERT_EQ(model.meshes.size(), 2u);
  ASSERT_EQ(model.meshes[0].primitives.size(), 2u);  // front and back of the floor
  ASSERT_EQ(model.meshes[1].primitives.size(), 1u);
  // 2^1 * B / pi: 0.5, 2 and 63 for the first patch; above 1 is white.
  const std::vector<std::vector<float>> expected = {
      {0.5f, 1, 1}, {1, 0.5f, 0}, {float(2 / pi), 1, 1}};
  const std::vector<const tinygltf::Primitive*> primitives = {&model.meshes[0].primitives[0],
                                                              &model.meshes[0].primitives[1],
                                                              &model.meshes[1].primitives[0]};
  const std::size_t patch_of[] = {0, 3, 1};
  for (std::size_t k = 0; k < 3; ++k) {
    const Primitive p = primitiveOf(model, *primitives[k]);
    EXPECT_EQ(p.position.size(), 12u);  // four corners, shared by two triangles
    ASSERT_EQ(p.colour.size(), 12u);
    ASSERT_EQ(p.radiosity.size(), 12u);
    for (std::size_t c = 0; c < 12; ++c) {
      // One rounding to float, and the exposed value is made from the rounded one: 2 of them.
      EXPECT_NEAR(p.colour[c], expected[k][c % 3], 2 * 6e-8f) << k;
      EXPECT_EQ(p.radiosity[c], float(b[3 * patch_of[k] + c % 3]));
    }
  }
}

TEST_F(MeshFile, LitGlbSharesVerticesOfEqualValues) {
  PatchMesh mesh = sample::mesh(4);
  for (Vec3& v : mesh.vertices) v.z = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.area[i] > 0) mesh.polygon[i] = mesh.surface[i];
  }
  std::vector<double> b(3 * mesh.size());
  for (std::size_t k = 0; k < b.size(); ++k) b[k] = 1 + std::sin(double(k));
  writeLitGlb(path("x.glb"), mesh, b, 0, 30);
  const tinygltf::Model model = parse(path("x.glb"));
  const std::vector<double> corners = cornerValues(mesh, b, 3, 30);
  // The values that the file must show at each corner, by place.
  std::map<std::vector<float>, std::size_t> wanted;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.piece_offset[i] == mesh.piece_offset[i + 1]) continue;
    for (std::size_t c = mesh.corner_offset[i]; c < mesh.corner_offset[i + 1]; ++c) {
      const Vec3& v = mesh.vertices[mesh.corners[c]];
      ++wanted[{float(mesh.surface[i]), float(mesh.side[i]), float(v.x), float(v.y), float(v.z),
                float(corners[3 * c]), float(corners[3 * c + 1]), float(corners[3 * c + 2])}];
    }
  }
  std::size_t found = 0;
  for (std::size_t s = 0; s < model.meshes.size(); ++s) {
    for (std::size_t side = 0; side < model.meshes[s].primitives.size(); ++side) {
      const Primitive p = primitiveOf(model, model.meshes[s].primitives[side]);
      for (std::size_t k = 0; k < p.position.size(); k += 3) {
        found += wanted.count({float(s), float(side), p.position[k], p.position[k + 1],
                               p.position[k + 2], p.radiosity[k], p.radiosity[k + 1],
                               p.radiosity[k + 2]});
      }
    }
  }
  EXPECT_EQ(found, wanted.size());  // each once: none missing, none twice
}

TEST_F(MeshFile, GlbRoundsNothingFarFromTheOrigin) {
  const PatchMesh near = corner();
  PatchMesh far = near;
  const Vec3 shift(1e6, -2e6, 3e6);
  for (Vec3& v : far.vertices) v += shift;
  const std::vector<double> b(12, 1.0);
  for (const bool lit : {false, true}) {
    const auto load = [&](const PatchMesh& mesh) {
      if (lit) {
        writeLitGlb(path("x.glb"), mesh, b, 0, 30);
      } else {
        writeMesh(path("x.glb"), mesh);
      }
      return parse(path("x.glb"));
    };
    const tinygltf::Model model = load(far);
    for (std::size_t s = 0; s < 2; ++s) {
      // The middle of the box: 0.5 from its sides, which a 32-bit float holds exactly.
      EXPECT_EQ(model.nodes.at(s).translation,
                (std::vector<double>{1e6 + .5, -2e6 + .5, 3e6 + .5}));
      const Primitive p = primitiveOf(model, model.meshes.at(s).primitives.at(0));
      for (const float x : p.position) EXPECT_EQ(std::abs(x), 0.5f);
    }
    EXPECT_TRUE(load(near).nodes.at(0).translation.empty());
  }
}

TEST_F(MeshFile, ErrorsNameTheFile) {
  const PatchMesh mesh = corner();
  std::vector<double> b(12, 1.0);
  expectError<InputError>(path("x.stl"), ".obj or .glb", [&] { writeMesh(path("x.stl"), mesh); });
  expectError<InputError>(path("no/x.obj"), "does not exist",
                          [&] { writeMesh(path("no/x.obj"), mesh); });
  expectError<InputError>(path("x.glb"), "no triangle", [&] { writeMesh(path("x.glb"), {}); });
  expectError<InputError>(path("x.glb"), "needs 12 values",
                          [&] { writeLitGlb(path("x.glb"), mesh, std::vector<double>(), 0, 30); });
  expectError<InputError>(path("x.glb"), "exposure",
                          [&] { writeLitGlb(path("x.glb"), mesh, b, NAN, 30); });
  b[4] = NAN;
  expectError<RunError>(path("x.glb"), "patch 1 of room/wall",
                        [&] { writeLitGlb(path("x.glb"), mesh, b, 0, 30); });
  EXPECT_EQ(files(), 0u);
}

TEST_F(MeshFile, IsWrittenWholeOrNotAtAll) {
  const PatchMesh mesh = sample::mesh(20);
  const std::vector<double> b(3 * mesh.size(), 1.0);
  for (const rlim_t limit : {0, 100, 5000}) {
    const FullDisk disk(limit);
    const char* part = "cannot be written";
    expectError<RunError>(path("x.obj"), part, [&] { writeMesh(path("x.obj"), mesh); });
    expectError<RunError>(path("x.glb"), part, [&] { writeMesh(path("x.glb"), mesh); });
    expectError<RunError>(path("y.glb"), part, [&] { writeLitGlb(path("y.glb"), mesh, b, 0, 30); });
    EXPECT_EQ(files(), 0u);
  }
}

}  // namespace
}  // namespace radiosity
