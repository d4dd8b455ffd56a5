// The data of a page read back: the mesh, the materials, the matrix and the light that went in,
// within single precision and 16 bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "formfactor/hemicube/eye_frame.h"
#include "gather/eyes.h"
#include "page/page.h"
#include "page/surfaces.h"
#include "page_reader.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/pipeline.h"
#include "support/error_of.h"
#include "support/results_folder.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

using test::PageReader;
using test::SceneBuilder;

/// A double in single precision, relative: half a unit in the last place.
constexpr double kSingle = 6e-8;

Vec3 point(std::span<const float> values, std::size_t k) {
  return {values[3 * k], values[3 * k + 1], values[3 * k + 2]};
}

/// A cube seen from inside whose ceiling shines, with a two-sided plate half-way.
Scene roomWithPlate() {
  SceneBuilder builder;
  const Index wall = builder.surface("wall", 0.5);
  builder.box(wall, {0, 0, 0}, {1, 1, 1}, false);
  builder.level(builder.surface("lamp", 0.1, 5), 0.3, 0.3, 0.7, 0.7, 0.99, false);
  builder.level(builder.surface("plate", 0.8, 0, true), 0.2, 0.2, 0.8, 0.7, 0.5);
  return builder.scene();
}

Scene dataScene(const char* name) {
  return loadScene(std::string(RADIOSITY_SOURCE_DIR "/data/") + name);
}

/// A page's data beside what they were made from.
struct Made {
  Made(Scene scene, std::size_t patches, bool elements = false,
       const std::function<void(PipelineOptions&)>& change = {})
      : pipeline(progress) {
    pipeline.open(std::move(scene));
    pipeline.options().mesh.patches = patches;
    if (change) change(pipeline.options());
    light = elements ? pipeline.elementLight() : pipeline.solvedLight();
    options.title = "a title";
    options.exposure = 1.5;
    options.camera.vertical_fov = std::numbers::pi / 4;
    reader.emplace(page::pageData(pipeline, light, options, progress, report));
  }
  const PatchMesh& mesh() { return pipeline.mesh().mesh; }
  const PageReader& page() const { return *reader; }

  Progress progress;
  Pipeline pipeline;
  PageOptions options;
  SurfaceLight light;
  PageReport report;
  std::optional<PageReader> reader;
};

void expectShapes(Made& made) {
  const PatchMesh& mesh = made.mesh();
  const PageReader& page = made.page();
  const auto position = page.floats("position");
  const auto triangle = page.indices("patch_triangle");
  const auto patch = page.indices("triangle_patch");
  const auto normal = page.floats("normal");
  const auto centroid = page.floats("centroid");
  const auto area = page.floats("area");
  const auto origin = page.header["origin"].get<std::vector<double>>();
  const Vec3 shift(origin[0], origin[1], origin[2]);
  const double diagonal = page.header["diagonal"];
  ASSERT_EQ(position.size(), 3 * mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    ASSERT_LE(glm::distance(point(position, v) + shift, mesh.vertices[v]), kSingle * diagonal);
  }
  // Triangles tile each patch and turn about its normal.
  std::vector<double> tiled(mesh.size(), 0.0);
  for (std::size_t t = 0; t < patch.size(); ++t) {
    const auto p = [&](std::size_t k) { return point(position, triangle[3 * t + k]); };
    const Vec3 cross = glm::cross(p(1) - p(0), p(2) - p(0));
    ASSERT_GE(glm::dot(cross, point(normal, patch[t])), -1e-12) << t;
    tiled[patch[t]] += glm::length(cross) / 2;
  }
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    // Cross products of rounded positions: an edge is some 1e-2 of the diagonal.
    ASSERT_NEAR(tiled[i], mesh.area[i], 1e-4 * mesh.area[i] + 1e-12) << i;
    ASSERT_NEAR(area[i], mesh.area[i], kSingle * mesh.area[i]);
    ASSERT_LE(glm::distance(point(normal, i), mesh.normal[i]), 2 * kSingle);
    ASSERT_LE(glm::distance(point(centroid, i) + shift, mesh.centroid[i]), kSingle * diagonal);
  }
  EXPECT_EQ(page.indices("surface"), mesh.surface);
  EXPECT_EQ(page.array<std::uint8_t>("side"), mesh.side);
}

void expectMaterials(Made& made) {
  const Scene& scene = made.pipeline.scene();
  const PatchMesh& mesh = made.mesh();
  const PageReader& page = made.page();
  const auto reflectance = page.floats("reflectance");
  const auto emission = page.floats("emission");
  const auto irradiance = page.floats("irradiance");
  const Solution& light = made.pipeline.solution();
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const auto& surface = page.header["surfaces"][mesh.surface[i]];
    EXPECT_EQ(surface["name"], mesh.surface_names[mesh.surface[i]]);
    const Material& m = scene.materials[surface["material"].get<std::size_t>()];
    const auto& said = page.header["materials"][surface["material"].get<std::size_t>()];
    EXPECT_EQ(said["name"], m.name);
    EXPECT_FALSE(said["textured"]);
    for (std::size_t b = 0; b < 3; ++b) {
      const auto band = glm::length_t(b);
      EXPECT_EQ(said["reflectance"][b], m.reflectance[band]);
      EXPECT_EQ(said["emission"][b], m.emission[band]);
      EXPECT_EQ(reflectance[3 * i + b], float(m.reflectance[band]));
      EXPECT_EQ(emission[3 * i + b], float(m.emission[band]));
      // B = E + rho H, as solved.
      const double b_page =
          emission[3 * i + b] + double(reflectance[3 * i + b]) * double(irradiance[3 * i + b]);
      const double solved = light.radiosity[3 * i + b];
      ASSERT_NEAR(b_page, solved, 3 * kSingle * solved + 1e-5 * made.options.exposure);
    }
  }
}

/// Every form factor, both ways; and its error in the header.
void expectFactors(Made& made, bool dense) {
  const PageReader& page = made.page();
  const ExchangeMatrix& matrix = pairsOf(made.pipeline.matrix());
  const std::size_t n = matrix.size();
  EXPECT_EQ(page.indices("factor_column").empty(), dense);
  const std::vector<double> f = page.factors();
  const FactorQuantisation& q = made.report.quantisation;
  EXPECT_LE(q.largest_relative_error, 2.5e-4);  // 30 in ln F over 65,534 steps, halved
  double largest_row_error = 0;
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double row_error = 0;
    for (std::size_t j = 0; j < n; ++j) {
      const double truth = matrix.at(i, j);
      row_error += std::abs(f[i * n + j] - truth);
      if (j >= i && f[i * n + j] > 0) ++pairs;
      if (f[i * n + j] == 0) {
        ASSERT_LT(truth, 1e-9 / double(n));
      } else {
        // Areas in single precision come in below the diagonal.
        ASSERT_NEAR(f[i * n + j], truth, (q.largest_relative_error + 3 * kSingle) * truth);
      }
    }
    largest_row_error = std::max(largest_row_error, row_error);
  }
  EXPECT_EQ(pairs, made.report.pairs);
  EXPECT_NEAR(q.largest_row_error, largest_row_error, 3 * kSingle);
  EXPECT_EQ(page.header["quantisation"]["largest_row_error"], q.largest_row_error);
  EXPECT_LT(q.largest_row_error, q.largest_relative_error);  // of rows that sum to at most 1
  const auto order = matrix.order();
  EXPECT_EQ(page.indices("order"), std::vector<Index>(order.begin(), order.end()));
  const auto row_sum = page.floats("row_sum");
  const FormFactors& factors = made.pipeline.factors();
  for (std::size_t i = 0; i < n; ++i) {
    ASSERT_EQ(row_sum[i], float(factors.fronts[i]));
  }
}

TEST(PageData, AClosedRoomHasDenseRows) {
  Made made(roomWithPlate(), 150);
  expectShapes(made);
  expectMaterials(made);
  expectFactors(made, true);
  const nlohmann::json& header = made.page().header;
  EXPECT_EQ(header["title"], "a title");
  EXPECT_EQ(header["exposure"], 1.5);
  EXPECT_EQ(header["closed"], true);
  EXPECT_EQ(header["method"], "exact");
  EXPECT_EQ(header["tolerance"], 1e-3);
  EXPECT_EQ(header["patches"], made.mesh().size());
  EXPECT_EQ(header["nodes"], made.mesh().size());
  EXPECT_NEAR(header["camera"]["fov"].get<double>(), 45, 1e-12);
  EXPECT_NEAR(header["diagonal"].get<double>(), std::sqrt(3.0), 1e-12);
  const SolveSummary& summary = made.pipeline.solution().summary;
  EXPECT_EQ(header["solver"]["history"].get<std::vector<double>>(), summary.residual_history);
  EXPECT_EQ(header["solver"]["iterations"], summary.iterations);
}

TEST(PageData, RoomsApartHaveSparseRows) {
  SceneBuilder builder;
  builder.box(builder.surface("near", 0.5, 1), {0, 0, 0}, {1, 1, 1}, false);
  builder.box(builder.surface("far", 0.3), {2, 0, 0}, {3, 1, 2}, false);
  Made made(builder.scene(), 150);
  expectShapes(made);
  expectFactors(made, false);
}

TEST(PageData, BothSidesOfAPlateArePatches) {
  Made made(roomWithPlate(), 80);
  const PatchMesh& mesh = made.mesh();
  const auto side = made.page().array<std::uint8_t>("side");
  EXPECT_GT(std::count(side.begin(), side.end(), 1), 0);
  const auto normal = made.page().floats("normal");
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.twin[i] == kNone) continue;
    EXPECT_EQ(point(normal, i), -point(normal, mesh.twin[i]));
  }
}

void useRoughRays(PipelineOptions& options) {
  options.factors.method = FormFactorMethod::rays;
  options.factors.tolerance = 0.1;
}

void useCutRows(PipelineOptions& options) {
  options.factors.method = FormFactorMethod::cut;
  options.factors.tolerance = 0.05;
}

/// Rows that are cut have no pairs: form factors are summed over nodes, and what the lamp gives to
/// each patch is there beside them.
TEST(PageData, FormFactorsWithoutPairsAreSummedOverNodes) {
  Made made(dataScene("curved.obj"), 2600, false, useCutRows);
  const PatchMesh& mesh = made.mesh();
  expectShapes(made);
  const PageReader& page = made.page();
  EXPECT_EQ(page.header["patches"], mesh.size());
  EXPECT_EQ(page.header["method"], "cut");
  const std::size_t nodes = page.header["nodes"];
  EXPECT_EQ(made.report.nodes, nodes);
  ASSERT_LT(nodes, mesh.size());
  const auto node = page.indices("node");
  const auto node_area = page.floats("node_area");
  std::vector<double> area(nodes, 0.0);
  for (std::size_t i = 0; i < mesh.size(); ++i) area.at(node[i]) += mesh.area[i];
  for (std::size_t k = 0; k < nodes; ++k) ASSERT_NEAR(node_area[k], area[k], kSingle * area[k]);

  const ExchangeOperator& matrix = made.pipeline.matrix();
  const Solution& solution = made.pipeline.solution();
  const std::vector<double> f = page.factors();
  const std::vector<double> ones(mesh.size(), 1.0);
  std::vector<double> sums(mesh.size());
  matrix.product(ones, 1, sums);
  double off = 0;
  double all = 0;
  std::vector<double> of_node(nodes, 0.0);
  for (std::size_t i = 0; i < mesh.size(); ++i) of_node[node[i]] += mesh.area[i] * sums[i];
  for (std::size_t k = 0; k < nodes; ++k) {
    const double sum = std::reduce(f.begin() + std::ptrdiff_t(k * nodes),
                                   f.begin() + std::ptrdiff_t((k + 1) * nodes));
    off += area[k] * std::abs(sum - of_node[k] / area[k]);
    all += of_node[k];
  }
  EXPECT_LT(off, 1e-3 * all);  // 16 bits; all rows are within reach in a closed room

  const auto lamp = std::ranges::find_if(page.header["materials"], [](const nlohmann::json& m) {
    return m["emission"][0].get<double>() > 0;
  });
  ASSERT_NE(lamp, page.header["materials"].end());
  const auto emitted =
      page.floats("emitted_" + std::to_string(lamp - page.header["materials"].begin()));
  std::vector<double> direct(3 * mesh.size());
  matrix.product(made.pipeline.materials().emission, 3, direct);
  for (std::size_t k = 0; k < direct.size(); ++k) {
    ASSERT_EQ(emitted[k], float(std::max(0.0, direct[k]))) << k;
    ASSERT_EQ(page.floats("irradiance")[k], float(solution.irradiance[k]));
  }
}

/// The header's bound of the error of light by 16 bits: |(F' - F) B| <= largest_row_error max B.
TEST(PageData, LightIsWithinThePagesErrorBound) {
  Scene scene = dataScene("cornell-box.obj");
  scene.lights = {uniformSky({1, 2, 3})};
  Made made(std::move(scene), 200);
  const auto light = made.page().header["lights"].at(0);
  EXPECT_EQ(light["name"], "sky");
  EXPECT_EQ(light["kind"], "sky");
  EXPECT_EQ(light["single"], true);
  EXPECT_EQ(light["strength"], (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(light["radiance"], (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(made.page().header["closed"], false);
  const std::vector<double> f = made.page().factors();
  const auto by_sky = made.page().floats("light_0");
  EXPECT_GT(*std::max_element(by_sky.begin(), by_sky.end()), 0.3f);
  const Solution& solution = made.pipeline.solution();
  const std::size_t n = made.mesh().size();
  double largest = 0;
  for (const double b : solution.radiosity) largest = std::max(largest, b);
  double off = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t b = 0; b < 3; ++b) {
      double gathered = double(by_sky[3 * i + b]);
      for (std::size_t j = 0; j < n; ++j) gathered += f[i * n + j] * solution.radiosity[3 * j + b];
      off = std::max(off, std::abs(gathered - solution.irradiance[3 * i + b]));
    }
  }
  // The solver's residual comes on top: 1e-6 of the largest emission.
  EXPECT_LE(off, (made.report.quantisation.largest_row_error + 1e-6) * largest);
  EXPECT_GT(off, 0);
}

TEST(PageData, SmoothShadingEqualsThatOfPictures) {
  for (const char* name : {"cornell-box.obj", "curved.obj"}) {
    Progress progress;
    const PatchMesh mesh = meshScene(dataScene(name), {.patches = 300}, progress).mesh;
    const double crease = 30;
    std::vector<double> values(mesh.size());
    for (std::size_t i = 0; i < mesh.size(); ++i) values[i] = 1 + double(i % 17);
    const std::vector<double> expected = cornerValues(mesh, values, 1, crease);
    const page::ShadingVertices shading = page::shadingVertices(mesh, crease);
    std::vector<double> shown(shading.begin.size() - 1, 0.0);
    for (std::size_t s = 0; s < shown.size(); ++s) {
      double sum = 0;
      for (std::size_t k = shading.begin[s]; k < shading.begin[s + 1]; ++k) {
        shown[s] += double(shading.weight[k]) * values[shading.patch[k]];
        sum += double(shading.weight[k]);
      }
      ASSERT_NEAR(sum, 1, 1e-6);
    }
    ASSERT_EQ(shading.corner.size(), 3 * mesh.pieces.size());
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      const auto outline = mesh.outline(i);
      for (std::size_t t = mesh.piece_offset[i]; t < mesh.piece_offset[i + 1]; ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
          const auto found = std::find(outline.begin(), outline.end(), mesh.pieces[t][k]);
          const std::size_t corner = mesh.corner_offset[i] + std::size_t(found - outline.begin());
          const double value = found == outline.end() ? values[i] : expected[corner];
          ASSERT_NEAR(shown[shading.corner[3 * t + k]], value, 18 * kSingle * 4);
        }
      }
    }
  }
}

/// Eyes are the first shading vertices. On a flat side an eye lies in its patches' plane and looks
/// along their normal; its axes are those of `radiosity gather`.
TEST(PageData, EyesEqualThoseOfTheGather) {
  for (const bool flat : {true, false}) {
    Made made(flat ? roomWithPlate() : dataScene("curved.obj"), 120, false, useRoughRays);
    const PatchMesh& mesh = made.mesh();
    const PageReader& page = made.page();
    const auto position = page.floats("eye_position");
    const auto normal = page.floats("eye_normal");
    const auto axis = page.floats("eye_axis");
    GatherOptions options;
    options.crease = made.options.crease;
    const std::vector<Eye> eyes = vertexEyes(mesh, cornerGroups(mesh, options.crease), options);
    ASSERT_EQ(position.size(), 3 * eyes.size());
    ASSERT_EQ(normal.size(), position.size());
    ASSERT_EQ(axis.size(), position.size());
    const auto origin = page.header["origin"].get<std::vector<double>>();
    const Vec3 shift(origin[0], origin[1], origin[2]);
    const double diagonal = page.header["diagonal"];
    for (std::size_t g = 0; g < eyes.size(); ++g) {
      ASSERT_TRUE(eyes[g].looks);
      ASSERT_LE(glm::distance(point(position, g) + shift, eyes[g].position), kSingle * diagonal);
      ASSERT_LE(glm::distance(point(normal, g), eyes[g].normal), 2 * kSingle);
      ASSERT_NEAR(glm::length(point(normal, g)), 1, 2 * kSingle);
      const EyeFrame frame = eyeFrame(eyes[g].position, eyes[g].normal, eyes[g].angle);
      ASSERT_LE(glm::distance(point(axis, g), frame.axes[0]), 2 * kSingle);
      ASSERT_NEAR(glm::dot(point(axis, g), point(normal, g)), 0, 4 * kSingle);
    }
    const auto corner = page.indices("triangle_corner");
    const auto patch = page.indices("triangle_patch");
    for (std::size_t k = 0; k < corner.size(); ++k) {
      if (corner[k] >= eyes.size()) continue;  // within a patch
      const Vec3 face = mesh.normal[patch[k / 3]];
      ASSERT_GT(glm::dot(point(normal, corner[k]), face), 0);
      if (!flat) continue;
      ASSERT_LE(glm::distance(point(normal, corner[k]), face), 2 * kSingle);
      const Vec3 eye = point(position, corner[k]) + shift;
      ASSERT_NEAR(glm::dot(eye - mesh.centroid[patch[k / 3]], face), 0, 2 * kSingle * diagonal);
    }
  }
}

TEST(PageData, AnEyeWithoutAreaDoesNotLook) {
  Scene scene = roomWithPlate();
  const auto first = Index(scene.vertices.size());
  for (const double x : {0.2, 0.3, 0.4}) scene.vertices.push_back({x, 0.2, 0.2});  // in one line
  for (Index k = 0; k < 3; ++k) scene.corners.push_back(first + k);
  scene.face_offset.push_back(Index(scene.corners.size()));
  scene.face_surface.push_back(0);
  Made made(std::move(scene), 60, false,
            [](PipelineOptions& options) { options.mesh.faces_as_patches = true; });
  const auto normal = made.page().floats("eye_normal");
  const auto axis = made.page().floats("eye_axis");
  std::size_t blind = 0;
  for (std::size_t k = 0; k < normal.size(); k += 3) {
    if (point(normal, k / 3) != Vec3(0.0)) continue;
    ++blind;
    EXPECT_EQ(point(axis, k / 3), Vec3(0.0));
  }
  EXPECT_EQ(blind, 3u);
}

TEST(PageData, EveryOutlineEdgeAppearsOnce) {
  Progress progress;
  const PatchMesh mesh = meshScene(roomWithPlate(), {.patches = 100}, progress).mesh;
  const auto edges = page::outlineEdges(mesh);
  std::set<std::pair<Index, Index>> found;
  for (std::size_t k = 0; k < edges.size(); k += 2) {
    EXPECT_TRUE(found.emplace(edges[k], edges[k + 1]).second);
  }
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const auto outline = mesh.outline(i);
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const auto [a, b] = std::minmax(outline[k], outline[(k + 1) % outline.size()]);
      EXPECT_EQ(found.count({a, b}), 1u);
    }
  }
}

TEST(PageData, FarFromTheOriginPositionsStayExact) {
  Made made(test::moved(roomWithPlate(), {5e6, -3e6, 100}), 60);
  expectShapes(made);
}

TEST(PageData, AVaryingMaterialIsTheMeanOfItsPatches) {
  Scene scene = roomWithPlate();
  // Two texels, black and white, over a face whose coordinates go from 0 to 1.
  scene.textures.push_back({"stripes", 2, 1, {0, 0, 0, 1, 1, 1}, false});
  scene.materials[0].texture = 0;
  scene.texcoords.assign(scene.corners.size(), Vec2(0.0));
  for (std::size_t f = 0; f < scene.faceCount(); ++f) {
    const Vec2 square[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (std::size_t k = 0; k < 4; ++k) scene.texcoords[scene.face_offset[f] + k] = square[k];
  }
  Made made(std::move(scene), 150);
  const auto& wall = made.page().header["materials"][0];
  EXPECT_TRUE(wall["textured"]);
  EXPECT_FALSE(made.page().header["materials"][1]["textured"]);
  // Half of the texture is white, of a reflectance of 0.5.
  EXPECT_NEAR(wall["reflectance"][0].get<double>(), 0.25, 1e-6);
  EXPECT_EQ(wall["factor"][0].get<double>(), 0.5);
}

class PageElements : public FolderTest {};

TEST_F(PageElements, EqualTheTrianglesOfTheLitMesh) {
  Made made(dataScene("cornell-box.obj"), 100, true);
  const PageReader& page = made.page();
  const auto position = page.floats("element_position");
  const auto triangle = page.indices("element_triangle");
  const auto irradiance = page.floats("element_irradiance");
  const auto patch = page.indices("element_patch");
  const auto emission = page.floats("emission");
  const auto reflectance = page.floats("reflectance");
  ASSERT_EQ(irradiance.size(), position.size());
  const std::size_t count =
      writeLitGlb(path("lit.glb"), made.mesh(), made.light, made.options.exposure, 30);
  EXPECT_EQ(triangle.size(), 3 * count);
  EXPECT_EQ(made.report.element_triangles, count);
  const LitMesh lit = readLitMesh(path("lit.glb"));
  // Triangles stand in another order: each is found by the sum of its corners' places, on either
  // side by the sum of their lights.
  const auto key = [](const Vec3& place) {
    const auto round = [](double x) { return std::llround(x * 1e5); };
    return std::array{round(place.x), round(place.y), round(place.z)};
  };
  std::multimap<std::array<long long, 3>, Vec3> here;
  for (std::size_t t = 0; t < count; ++t) {
    Vec3 place(0.0);
    Vec3 value(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t v = triangle[3 * t + k];
      place += point(position, v);
      value += point(emission, patch[v]) + point(reflectance, patch[v]) * point(irradiance, v);
    }
    here.emplace(key(place), value);
  }
  for (std::size_t t = 0; t < count; ++t) {
    Vec3 place(0.0);
    Vec3 value(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      place += lit.vertices[lit.triangles[t][k]];
      value += lit.colours[t][k];
    }
    const auto [first, last] = here.equal_range(key(place));
    // Both are in single precision.
    const auto found = std::find_if(first, last, [&](const auto& each) {
      return glm::length(each.second - value) <= 1e-6 * (1 + glm::length(value));
    });
    ASSERT_NE(found, last) << "triangle " << t;
    here.erase(found);
  }
}

/// A lamp, and a point that hangs over the floor: what the point gives directly, of all light
/// there, is I cos / r^2.
TEST_F(PageElements, KnowWhatEachLampGivesDirectly) {
  Scene scene = dataScene("cornell-box.obj");
  scene.lights.push_back(lightOf("point,10,at=.08,.3,.08"));
  Made made(std::move(scene), 100, true);
  const PageReader& page = made.page();
  const auto& lamps = page.header["element_lamps"];
  ASSERT_EQ(lamps.size(), 2u);
  EXPECT_TRUE(lamps[0].contains("material"));
  EXPECT_EQ(lamps[1]["light"], 0);
  const auto position = page.floats("element_position");
  const auto irradiance = page.floats("element_irradiance");
  const auto patch = page.indices("element_patch");
  const auto normal = page.floats("normal");
  const auto shares = page.array<std::uint16_t>("element_share_1");
  const auto origin = page.header["origin"].get<std::vector<double>>();
  std::size_t seen = 0;
  for (std::size_t v = 0; v < patch.size(); ++v) {
    const Vec3 at = point(position, v) + Vec3(origin[0], origin[1], origin[2]);
    const Vec3 to = Vec3(.08, .3, .08) - at;
    if (std::abs(at.y) > 1e-6 || std::hypot(to.x, to.z) > .05) continue;
    if (point(normal, patch[v]).y < .9) continue;
    ++seen;
    const double expected = 10 * to.y / std::pow(glm::length(to), 3);
    // Interpolated values are raised to have the means, by up to a hundredth.
    EXPECT_NEAR(irradiance[3 * v] * shares[3 * v] / 65535, expected, .01 * expected);
  }
  EXPECT_GT(seen, 3u);
}

TEST(PageData, MissingElementsLeaveTheirArraysEmpty) {
  const Made made(roomWithPlate(), 60);
  EXPECT_TRUE(made.page().floats("element_irradiance").empty());
  EXPECT_EQ(made.report.element_triangles, 0u);
}

TEST(PageData, TooManyPatchesAreRefusedWithTheCure) {
  PatchMesh mesh;
  mesh.area.resize(kMostPagePatches);
  EXPECT_NO_THROW(requirePageFits("s.obj", mesh));
  mesh.area.resize(kMostPagePatches + 1);
  EXPECT_EQ(test::errorOf([&] { requirePageFits("s.obj", mesh); }),
            "s.obj: 100,001 patches, and a page holds at most 100,000; each planar piece is at "
            "least one patch: leave out parts of the scene");
}

void useHemicubes(PipelineOptions& options) {
  options.factors.method = FormFactorMethod::hemicube;
  options.factors.resolution = 32;
}

TEST(PageData, UnmergedHemicubesAreRefused) {
  const std::string why = test::errorOf([] { Made(roomWithPlate(), 60, false, useHemicubes); });
  EXPECT_NE(why.find("with symmetrize"), std::string::npos) << why;
}

TEST(PageData, HemicubesHaveNoErrorFigures) {
  Made made(roomWithPlate(), 60, false, [](PipelineOptions& options) {
    useHemicubes(options);
    options.factors.symmetrize = true;
  });
  expectFactors(made, true);
  EXPECT_TRUE(made.page().floats("row_error").empty());
  EXPECT_TRUE(made.page().header["tolerance"].is_null());
}

TEST(PageData, InvalidUtf8InANameIsReplaced) {
  Scene scene = roomWithPlate();
  scene.surfaces[0].name = "w\xe4nd";
  const Made made(std::move(scene), 60);
  EXPECT_EQ(made.page().header["surfaces"][0]["name"], "w\xef\xbf\xbdnd");
}

}  // namespace
}  // namespace radiosity
