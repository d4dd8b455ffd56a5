// Meshes with vertex colours as other programs write them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <numeric>

#include "gather/gather_scenes.h"
#include "radiosity/compare.h"
#include "radiosity/results.h"
#include "support/error_of.h"
#include "support/results_folder.h"

namespace radiosity {
namespace {

using test::errorOf;

class LitMeshFiles : public FolderTest {
 protected:
  std::string put(const std::string& name, const std::string& text) const {
    std::ofstream file(path(name), std::ios::binary);
    file << text;
    return path(name);
  }
  std::string refusal(const std::string& name, const std::string& text) const {
    const std::string file = put(name, text);
    return errorOf([&] { readLitMesh(file); });
  }
};

const std::string kAsciiPly =
    "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
    "property uchar alpha\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0 255 0 51 255\n1 0 0 0 0 0 255\n1 1 0 0 0 0 255\n0 1 0 0 255 0 255\n4 0 1 2 3\n";

TEST_F(LitMeshFiles, AsciiPlyIsRead) {
  const LitMesh mesh = readLitMesh(put("a.ply", kAsciiPly));
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_TRUE(mesh.bytes);
  EXPECT_EQ(mesh.face, (std::vector<Index>{0, 0}));
  EXPECT_EQ(mesh.colours[0][0], Vec3(1, 0, 0.2));
  EXPECT_EQ(mesh.colours[1][2], Vec3(0, 1, 0));
  EXPECT_EQ(mesh.vertices[3], Vec3(0, 1, 0));
}

template <class T>
void append(std::string& out, T value, bool swapped) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  out.append(bytes.data(), bytes.size());
}

TEST_F(LitMeshFiles, BinaryPlyIsReadInBothByteOrders) {
  for (const bool big : {false, true}) {
    std::string text = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                       "_endian 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
                       "property double z\nproperty float red\nproperty float green\n"
                       "property float blue\nelement face 1\nproperty short flags\n"
                       "property list uchar uint vertex_index\nend_header\n";
    for (int v = 0; v < 3; ++v) {
      for (const double x : {v == 1 ? 1.5 : 0.0, v == 2 ? 2.5 : 0.0, 0.25}) append(text, x, big);
      for (const float c : {7.5F, 0.125F, float(v)}) append(text, c, big);
    }
    append(text, short(9), big);
    text += '\3';
    for (const std::uint32_t k : {0u, 1u, 2u}) append(text, k, big);
    const LitMesh mesh = readLitMesh(put("b.ply", text));
    ASSERT_EQ(mesh.triangles.size(), 1u);
    EXPECT_FALSE(mesh.bytes);
    EXPECT_EQ(mesh.vertices[2], Vec3(0, 2.5, 0.25));
    EXPECT_EQ(mesh.colours[0][2], Vec3(7.5, 0.125, 2));
    // A shorter file is damaged, not silently smaller.
    for (const std::size_t cut : {1u, 13u, 60u}) {
      EXPECT_NE(refusal("c.ply", text.substr(0, text.size() - cut)), "") << cut;
    }
  }
}

TEST_F(LitMeshFiles, ObjWithColoursIsRead) {
  const LitMesh mesh = readLitMesh(put("a.obj",
                                       "# by hand\no wall\nusemtl red\nv 0 0 0 1 0.5 0.25\n"
                                       "v 1 0 0 4 5 6\nv 1 1 0 0 0 0\nv 0 1 0 0 0 1e3\n"
                                       "vn 0 0 1\nf 1//1 2//1 3//1 4//1\no roof\nf -4 -2 -1\n"));
  ASSERT_EQ(mesh.triangles.size(), 3u);
  EXPECT_EQ(mesh.surface_names, (std::vector<std::string>{"wall/red", "roof/red"}));
  EXPECT_EQ(mesh.face_surface, (std::vector<Index>{0, 1}));
  EXPECT_EQ(mesh.colours[0][1], Vec3(4, 5, 6));
  EXPECT_EQ(mesh.colours[2][2], Vec3(0, 0, 1000));
}

TEST_F(LitMeshFiles, MissingColoursAreRefusedWithTheCure) {
  for (const std::string& error :
       {refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        refusal("a.ply",
                "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                "property float z\nend_header\n0 0 0\n")}) {
    EXPECT_NE(error.find("bake the light into vertex colours"), std::string::npos) << error;
  }
  const test::Room room = test::loadRoom("furnace-cube", 24);
  writeMesh(path("plain.glb"), room.mesh);
  const std::string error = errorOf([&] { readLitMesh(path("plain.glb")); });
  EXPECT_NE(error.find("bake the light into vertex colours"), std::string::npos) << error;
}

TEST_F(LitMeshFiles, DamageIsReportedWithItsPlace) {
  EXPECT_NE(refusal("a.obj", "v 0 0 0 1 1 1\nv 1 0 0 nan 1 1\n").find("a.obj:2:"),
            std::string::npos);
  EXPECT_NE(refusal("a.obj", "v 0 0 0 1 1 1\nf 1 2 3\n").find("a.obj:2:"), std::string::npos);
  EXPECT_NE(refusal("a.obj", "v 0 0 0 1 1 1\n").find("no faces"), std::string::npos);
  EXPECT_NE(refusal("a.ply", "plx\n"), "");
  EXPECT_NE(refusal("a.ply", "ply\nformat ascii 1.0\n"), "");
  EXPECT_NE(refusal("a.ply", "ply\nformat runic 1.0\nend_header\n"), "");
  std::string beyond = kAsciiPly;
  beyond.replace(beyond.rfind("0 1 2 3"), 7, "0 1 2 9");
  EXPECT_NE(refusal("a.ply", beyond).find("vertex 9"), std::string::npos);
  EXPECT_NE(refusal("a.txt", "").find(".txt"), std::string::npos);
}

TEST_F(LitMeshFiles, OurOwnLitMeshHoldsRadiosity) {
  // The true values, to the rounding of floats, not the exposed and clipped ones that are shown.
  const test::Room room = test::loadRoom("cornell-box", 80);
  std::vector<double> radiosity;
  for (const Vec3& c : room.mesh.centroid) {
    radiosity.insert(radiosity.end(), {100 + c.x, 200 + c.y, 300 + c.z});
  }
  writeLitGlb(path("lit.glb"), room.mesh, radiosity, 5.0, 30.0);
  const LitMesh mesh = readLitMesh(path("lit.glb"));
  EXPECT_TRUE(mesh.radiosity);
  const Comparison c = compare(lightOf(room.mesh, radiosity, 3, "A"),
                               lightOf(mesh, LightUnit::radiosity), CompareOptions());
  EXPECT_NEAR(c.matched_a, c.area_a, 1e-6 * c.area_a);
  EXPECT_NEAR(c.matched_b, c.area_b, 1e-6 * c.area_b);
  // Interpolation between vertices moves values by the gradient times a patch: 0.2 of 100 to 300.
  EXPECT_LT(c.relativeL2(), 1e-3);
  EXPECT_TRUE(c.notes.empty());
}

TEST(OtherPrograms, CyclesAndTheMatrixAgreeOnTheCornellBox) {
  // The mesh was lit by path tracing in another program (data/blender_lit.py) from another mesh.
  Progress quiet;
  const test::Room room = test::loadRoom("cornell-box", 1000);
  FormFactorOptions options;
  options.resolution = 128;
  const FormFactors factors = computeFormFactors(room.mesh, options, quiet);
  const Solution solution = solve(factors, room.materials, room.mesh, SolveOptions(), quiet);
  const LightField a = lightOf(room.mesh, solution.radiosity, 3, "matrix");
  const LitMesh mesh =
      readLitMesh(std::string(RADIOSITY_SOURCE_DIR "/data/cornell-box-cycles.ply"));
  const Comparison c = compare(a, lightOf(mesh, LightUnit::radiance), CompareOptions());
  EXPECT_GT(c.matched_a, 0.999 * c.area_a);
  EXPECT_GT(c.matched_b, 0.999 * c.area_b);
  // All light: 2048 paths a patch leave 0.1% of noise in the sum; its patches (500, sampled at the
  // middle) and ours (1000) 1% between them.
  for (std::size_t b = 0; b < 3; ++b) {
    EXPECT_NEAR(c.sums.b[b], c.sums.a[b], 0.015 * c.sums.a[b]) << b;
  }
  EXPECT_TRUE(c.notes.empty());
  for (const SurfaceDifference& s : c.surfaces) {
    // The floor has the shadows' edges, which 500 patches cannot draw.
    EXPECT_LT(s.sums.relativeL2(), s.name == "floor/white" ? 0.2 : 0.12) << s.name;
  }
  // The same file taken for radiosity: the factor is found and named.
  const Comparison wrong = compare(a, lightOf(mesh, LightUnit::radiosity), CompareOptions());
  ASSERT_EQ(wrong.notes.size(), 1u);
  EXPECT_NE(wrong.notes[0].text.find("that is pi:"), std::string::npos);
  CompareOptions fitting;
  fitting.fit_scale = true;
  const Comparison fitted = compare(a, lightOf(mesh, LightUnit::radiosity), fitting);
  EXPECT_NEAR(fitted.scale, std::numbers::pi, 0.02);
}

}  // namespace
}  // namespace radiosity
