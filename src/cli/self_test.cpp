#include "cli/self_test.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "radiosity/form_factor_method.h"
#include "radiosity/radiosity.h"
#include "radiosity/version.h"

namespace radiosity::cli {

namespace {

using Triangles = std::vector<std::array<Index, 3>>;

/// That of two values which is further from the truth.
double further(double a, double b, double truth) {
  return std::abs(a - truth) > std::abs(b - truth) ? a : b;
}

/// Says a figure; RunError if it is further from the truth than the tolerance, a share of it.
void require(const std::string& what, double found, double truth, double tolerance) {
  const double off = std::abs(found / truth - 1);
  if (!(off <= tolerance)) {
    throw RunError(fmt::format(
        "self-test: {} is {:.9g} and not {:.9g}; install the program again, or, if that does not "
        "help, report the processor and the libraries that it is run with",
        what, found, truth));
  }
  fmt::print("  {:<42}{:.9g}, off by {:.0e}\n", what, found, off);
}

PatchMesh meshOf(std::span<const Vec3> vertices, const Triangles& triangles,
                 const Material& material, const MeshOptions& options) {
  Progress quiet;
  return meshScene(sceneOfTriangles(vertices, triangles, {&material, 1}), options, quiet).mesh;
}

FormFactors factorsBy(FormFactorMethod method, const PatchMesh& mesh, bool simd = true) {
  FormFactorOptions options;
  options.method = method;
  options.resolution = 64;
  options.simd = simd;
  Progress quiet;
  return computeFormFactors(mesh, options, quiet);
}

/// Unit squares that face each other at a distance of 1, each two triangles, with or without a
/// square of side 1/2 half-way.
PatchMesh facingSquares(bool blocked) {
  std::vector<Vec3> vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  Triangles triangles = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};
  if (blocked) {
    for (const auto& [x, y] : {std::pair{.25, .25}, {.75, .25}, {.75, .75}, {.25, .75}}) {
      vertices.emplace_back(x, y, .5);
    }
    triangles.push_back({8, 9, 10});
    triangles.push_back({8, 10, 11});
  }
  MeshOptions options;
  options.faces_as_patches = true;
  return meshOf(vertices, triangles, {.name = "grey"}, options);
}

double lowerToUpper(const FormFactors& factors) {
  const ExchangeOperator& f = *factors.matrix;
  return (f.at(0, 2) + f.at(0, 3) + f.at(1, 2) + f.at(1, 3)) / 2;
}

void checkClosedForms() {
  // Howell C-11. Blocked: tests/formfactor/truth_closed_forms_test.cpp.
  constexpr double kFacing = 0.199824895698387, kBlocked = 0.0995062945990;
  const PatchMesh open = facingSquares(false);
  const PatchMesh blocked = facingSquares(true);
  // Of the default tolerance, 1e-3, closed forms take a hundredth; smooth shadows take less than
  // all.
  using enum FormFactorMethod;
  require("F of facing squares, exact", lowerToUpper(factorsBy(exact, open)), kFacing, 1e-5);
  const double by_vectors = lowerToUpper(factorsBy(exact, blocked));
  require("F past a square half-way, exact", by_vectors, kBlocked, 1e-3);
  require("  the same without vector instructions", lowerToUpper(factorsBy(exact, blocked, false)),
          by_vectors, 0);
  // Rows are good to 1e-2 of their 2-norm, 0.2; this sums two of a row.
  require("F past a square half-way, rays", lowerToUpper(factorsBy(rays, blocked)), kBlocked, 3e-2);
}

/// A closed cube of reflectance 1/2 that emits 1 W/m^2 everywhere: B = 1 + B/2 = 2.
PatchMesh furnace() {
  std::vector<Vec3> vertices;
  for (const int k : {0, 1, 2, 3, 4, 5, 6, 7}) vertices.emplace_back(k & 1, (k >> 1) & 1, k >> 2);
  Triangles inward;
  for (const auto& [a, b, c, d] : {std::array<Index, 4>{0, 1, 3, 2},
                                   {4, 6, 7, 5},
                                   {0, 4, 5, 1},
                                   {2, 3, 7, 6},
                                   {0, 2, 6, 4},
                                   {1, 5, 7, 3}}) {
    inward.push_back({a, b, c});
    inward.push_back({a, c, d});
  }
  return meshOf(vertices, inward, {.name = "wall", .reflectance = Vec3(.5), .emission = Vec3(1)},
                {.patches = 150});
}

void checkFurnace() {
  Progress quiet;
  const PatchMesh mesh = furnace();
  const std::vector<double> reflectance(mesh.size() * 3, .5);
  const std::vector<double> emission(mesh.size() * 3, 1);
  Solution light;
  for (const FormFactorMethod method : {FormFactorMethod::hemicube, FormFactorMethod::cut,
                                        FormFactorMethod::rays, FormFactorMethod::exact}) {
    const FormFactors factors = factorsBy(method, mesh);
    light = solve(factors, reflectance, emission, 3, {}, quiet);
    double worst = 2;
    for (const double b : light.radiosity) worst = further(b, worst, 2);
    // Rows sum to 1 in single precision, or are made to; the solver stops at 1e-6.
    require(fmt::format("B in a furnace, {}", traitsOf(method).word), worst, 2, 1e-5);
  }
  Camera camera;
  camera.eye = Vec3(.5);
  camera.target = {.9, .6, .7};
  RenderOptions small;
  small.width = small.height = 64;
  const Image image = renderRadiance(mesh, light.radiosity, {}, camera, small, quiet);
  double worst = 2 / std::numbers::pi;
  for (std::size_t k = 0; k < image.rgba.size(); ++k) {
    if (k % 4 != 3) worst = further(image.rgba[k], worst, 2 / std::numbers::pi);
  }
  require("radiance in its picture", worst, 2 / std::numbers::pi, 1e-5);
}

/// A folder of this process for files, removed at the end.
class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / "radiosity-XXXXXX") {
    if (mkdtemp(path_.data()) == nullptr)
      throw RunError(path_ + ": cannot be made; set TMPDIR to a folder that can be written");
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const char* name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

/// Files of which code is opened only when they are: images, and Assimp's program.
void checkFiles() {
  const Folder folder;
  const Image grey{2, 2, std::vector<float>(16, 1)};
  writeImage(folder.file("grey.png"), grey, false);
  require("white of a .png", readImage(folder.file("grey.png")).rgba.front(), 1, 0);
  std::ofstream(folder.file("roof.dxf"))
      << "0\nSECTION\n2\nENTITIES\n0\n3DFACE\n8\nroof\n10\n0\n20\n0\n30\n2\n"
         "11\n1\n21\n0\n31\n2\n12\n1\n22\n1\n32\n2\n13\n0\n23\n1\n33\n2\n"
         "0\nENDSEC\n0\nEOF\n";
  require("corners in a .dxf", double(loadScene(folder.file("roof.dxf")).corners.size()), 4, 0);
}

}  // namespace

void selfTest() {
  fmt::print("radiosity {}\n", RADIOSITY_VERSION);
  checkClosedForms();
  checkFurnace();
  checkFiles();
  fmt::print("all as it should be\n");
}

}  // namespace radiosity::cli
