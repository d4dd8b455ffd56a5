// glTF 2.0: files written here with their bytes embedded, read back and checked.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "radiosity/scene.h"
#include "support/gltf_document.h"
#include "support/scene_files.h"

namespace radiosity::test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

class SceneGltf : public GltfFiles {};

Vec3 normalOf(const Scene& scene, std::size_t f) {
  const auto face = scene.face(f);
  const Vec3 a = scene.vertices[face[0]];
  return glm::cross(scene.vertices[face[1]] - a, scene.vertices[face[2]] - a);
}

TEST_F(SceneGltf, ReadsATriangleWithoutMaterial) {
  const Scene scene = load(triangle());
  ASSERT_EQ(scene.faceCount(), 1u);
  EXPECT_EQ(corner(scene, 0, 1), Vec3(1, 0, 0));
  EXPECT_EQ(normalOf(scene, 0), Vec3(0, 0, 1));
  EXPECT_EQ(scene.surfaces[0].name, "tri");
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(.5)) << "not glTF's base colour of 1";
  EXPECT_FALSE(scene.materialOf(0).two_sided);
  EXPECT_NOTE(scene.notes, "no material, reflectance 0.5: tri", Severity::warning);
}

TEST_F(SceneGltf, ReadsMaterials) {
  Document d = triangle();
  d.json["extensionsUsed"] = {"KHR_materials_emissive_strength", "KHR_materials_ior",
                              "KHR_materials_clearcoat"};
  d.json["extensionsRequired"] = {"KHR_materials_emissive_strength"};
  d.json["materials"] = {
      {{"name", "lamp"},
       {"doubleSided", true},
       {"emissiveFactor", {1.0, .5, .25}},
       {"extensions",
        {{"KHR_materials_emissive_strength", {{"emissiveStrength", 40}}},
         {"KHR_materials_ior", {{"ior", 1.3}}}}},
       {"pbrMetallicRoughness", {{"baseColorFactor", {.8, .4, .2, 1}}, {"metallicFactor", 0}}}},
      {{"name", "lamp"}, {"emissiveFactor", {0, 0, 0}}, {"alphaMode", "BLEND"}}};
  d.json["meshes"][0]["primitives"][0]["material"] = 0;
  d.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"material", 1}});
  const Scene scene = load(d);
  const Material& lamp = scene.materialOf(0);
  EXPECT_EQ(lamp.reflectance, Vec3(.8, .4, .2));
  for (int band = 0; band < 3; ++band) {
    EXPECT_DOUBLE_EQ(lamp.emission[band], std::numbers::pi * 40 / double(1 << band));
  }
  EXPECT_TRUE(lamp.two_sided);
  EXPECT_EQ(scene.surfaces[1].name, "tri/lamp#2") << "two materials of one name stay apart";
  EXPECT_NOTE(scene.notes, "KHR_materials_ior is not used, material: lamp", Severity::info);
  const Note* const others = findNote(scene.notes, "optional extensions that are not read");
  ASSERT_NE(others, nullptr);
  EXPECT_EQ(others->text, "optional extensions that are not read: KHR_materials_clearcoat")
      << "the one that a material has is named with it";
  EXPECT_NOTE(scene.notes, "metalness is not used (glTF's default is 1), material: lamp#2",
              Severity::info);
  EXPECT_NOTE(scene.notes,
              "transparency is not used: it is solid and blocks light (without='NAME' leaves it "
              "out), material: lamp#2",
              Severity::warning);
  const Note* const white = findNote(scene.notes, "reflectance 1: absorbs no light");
  ASSERT_NE(white, nullptr);
  EXPECT_EQ(white->severity, Severity::warning);
  EXPECT_TRUE(white->text.ends_with("set='NAME.reflectance'): lamp#2")) << white->text;
}

TEST_F(SceneGltf, NamesWhatIsNotUsed) {
  Document d = triangle();
  d.json["extensionsUsed"] = {"KHR_materials_transmission"};
  d.json["images"] = {{{"uri", "lost.png"}}};
  d.json["textures"] = {{{"source", 0}}};
  d.json["materials"] = {
      {{"name", "stone"},
       {"normalTexture", {{"index", 0}}},
       {"occlusionTexture", {{"index", 0}}},
       {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", .3}}}},
      {{"name", "pane"},
       {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}},
      {{"name", "fence"}, {"alphaMode", "MASK"}}};
  const Scene scene = load(d);
  EXPECT_NOTE(scene.notes, "normal maps are not used, material: stone", Severity::info);
  EXPECT_NOTE(scene.notes, "occlusion maps are not used, material: stone", Severity::info);
  EXPECT_NOTE(scene.notes, "roughness is not used, all is matt, material: stone", Severity::info);
  EXPECT_NOTE(scene.notes, "(without='NAME' leaves it out), material: pane", Severity::warning);
  EXPECT_NOTE(scene.notes, "holes (alpha masks) are not cut out: it is solid", Severity::warning);
}

TEST_F(SceneGltf, TakesAColourOneUnitOfAFloatAboveOneAsOne) {
  Document d = triangle();
  d.json["meshes"][0]["primitives"][0]["material"] = 0;
  const auto with = [&](double red) {
    d.json["materials"] = {
        {{"name", "red"}, {"pbrMetallicRoughness", {{"baseColorFactor", {red, .5, .5, 1}}}}}};
  };
  with(1.00000012);
  const Scene scene = load(d);
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(1, .5, .5));
  EXPECT_NOTE(scene.notes, "reflectance above 1 by float rounding, taken as 1, material: red",
              Severity::info);
  with(1.0000012);
  EXPECT_CONTAINS(errorOf(d), "material red: reflectance 1.0000012 0.5 0.5 is outside 0 to 1");
}

TEST_F(SceneGltf, RefusesImpossibleMaterialsByName) {
  Document d = triangle();
  d.json["meshes"][0]["primitives"][0]["material"] = 0;
  d.json["materials"] = {
      {{"name", "red"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1.5, 0, 0, 1}}}}}};
  EXPECT_CONTAINS(errorOf(d), "material red: reflectance 1.5 0 0 is outside 0 to 1");
  d.json["materials"] = {{{"name", "dark"}, {"emissiveFactor", {-1, 0, 0}}}};
  EXPECT_CONTAINS(errorOf(d), "material dark: emission");
  d.json["materials"] = {
      {{"name", "dark"},
       {"emissiveFactor", {1, 1, 1}},
       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", -2}}}}}}};
  EXPECT_CONTAINS(errorOf(d), "material dark: emission");
}

TEST_F(SceneGltf, LightOfCubesOfImagesIsLeftOut) {
  Document d = triangle();
  d.json["extensionsUsed"] = {"EXT_lights_image_based"};
  d.json["extensionsRequired"] = {"EXT_lights_image_based"};
  EXPECT_NOTE(load(d).notes,
              "light of cubes of images is left out (image_sky='SKY.hdr' takes a plain image): "
              "EXT_lights_image_based",
              Severity::warning);
}

TEST_F(SceneGltf, RefusesUnknownRequiredExtensions) {
  Document d = triangle();
  d.json["extensionsUsed"] = {"EXT_other_geometry"};
  EXPECT_NOTE(load(d).notes, "optional extensions that are not read: EXT_other_geometry",
              Severity::info);
  d.json["extensionsRequired"] = {"EXT_other_geometry"};
  EXPECT_CONTAINS(errorOf(d),
                  "needs EXT_other_geometry, which is not supported; export without it");
}

TEST_F(SceneGltf, ReadsFilesThatRequireExtensionsOfMaterialsAlone) {
  Document d = triangle();
  d.json["extensionsUsed"] = {"KHR_materials_unlit", "KHR_texture_basisu"};
  d.json["extensionsRequired"] = d.json["extensionsUsed"];
  EXPECT_NOTE(load(d).notes,
              "required extensions that are not read; materials may look different: "
              "KHR_materials_unlit, KHR_texture_basisu",
              Severity::warning);
}

TEST_F(SceneGltf, ReflectanceIsTheDiffuseColourOfSpecularGlossiness) {
  Document d = triangle();
  d.json["materials"] = {
      {{"name", "red"},
       {"pbrMetallicRoughness", {{"baseColorFactor", {.9, .9, .9, 1}}}},
       {"extensions",
        {{"KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {.5, .25, .125, 1}}}}}}}};
  d.json["meshes"][0]["primitives"][0]["material"] = 0;
  const Scene scene = load(d);
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(.5, .25, .125));
  EXPECT_EQ(findNote(scene.notes, "metalness"), nullptr) << "it has none";
}

TEST_F(SceneGltf, AppliesNestedTransformsInDouble) {
  Document d = triangle();
  const double half = std::sqrt(0.5);  // a quarter turn about z
  d.json["nodes"] = {{{"name", "far"},
                      {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1000000.1, 0, 0, 1}},
                      {"children", {1}}},
                     {{"name", "turned"},
                      {"translation", {0, 3, 0}},
                      {"rotation", {0, 0, half, half}},
                      {"scale", {2, 1, 1}},
                      {"mesh", 0}}};
  const Scene scene = load(d);
  // scale, then turn x to y, then move by 3 y, then by 1000000.1 x.
  const std::array<Vec3, 3> expected = {Vec3(1000000.1, 3, 0), Vec3(1000000.1, 5, 0),
                                        Vec3(999999.1, 3, 0)};
  for (std::size_t k = 0; k < 3; ++k) {
    // One ulp of 1e6 is 1.2e-10; single precision would be off by 0.04.
    EXPECT_NEAR(glm::length(corner(scene, 0, k) - expected[k]), 0, 5e-10);
  }
  EXPECT_EQ(scene.surfaces[0].object, "turned");
}

TEST_F(SceneGltf, MirroredNodesKeepTheirFronts) {
  Document d = triangle();
  d.json["nodes"] = {{{"scale", {1, 1, -1}}, {"mesh", 0}, {"name", "a"}},
                     {{"scale", {-1, 1, 1}}, {"mesh", 0}, {"name", "b"}},
                     {{"scale", {-1, -1, 1}}, {"mesh", 0}, {"name", "c"}}};
  d.json["scenes"] = {{{"nodes", {0, 1, 2}}}};
  const Scene scene = load(d);
  // The front of the mesh is +z. Mirrored in z it faces -z; in x, or turned, still +z.
  EXPECT_LT(normalOf(scene, 0).z, 0);
  EXPECT_GT(normalOf(scene, 1).z, 0);
  EXPECT_GT(normalOf(scene, 2).z, 0);
}

TEST_F(SceneGltf, NamesInstancesApart) {
  Document d = triangle();
  d.json["meshes"][0]["name"] = "shape";
  d.json["nodes"] = {{{"mesh", 0}, {"name", "leg"}}, {{"mesh", 0}, {"name", "leg"}}, {{"mesh", 0}}};
  d.json["scenes"] = {{{"nodes", {0, 1, 2}}}};
  const Scene scene = load(d);
  ASSERT_EQ(scene.surfaces.size(), 3u);
  EXPECT_EQ(scene.surfaces[0].object, "leg");
  EXPECT_EQ(scene.surfaces[1].object, "leg#2");
  EXPECT_EQ(scene.surfaces[2].object, "shape");
}

TEST_F(SceneGltf, ReadsStripsFansAndIndices) {
  // Four corners of a square as a zigzag (strip) and around (fan): all triangles face +z.
  for (const int mode : {5, 6}) {
    Document d = triangle();
    d.bytes.clear();
    d.json.erase("bufferViews");
    d.json.erase("accessors");
    const int positions = mode == 5 ? d.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0})
                                    : d.positions({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    d.json["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", positions}}},
                                            {"mode", mode}};
    Scene scene = load(d);
    ASSERT_EQ(scene.faceCount(), 2u);
    EXPECT_EQ(normalOf(scene, 0) + normalOf(scene, 1), Vec3(0, 0, 2)) << "mode " << mode;
    // The same through indices of each width, backwards: faces -z.
    const std::array<int, 3> indices = {
        d.add(std::vector<std::uint8_t>{3, 2, 1, 0}, 5121, "SCALAR", 1),
        d.add(std::vector<std::uint16_t>{3, 2, 1, 0}, 5123, "SCALAR", 1),
        d.add(std::vector<std::uint32_t>{3, 2, 1, 0}, 5125, "SCALAR", 1)};
    for (const int accessor : indices) {
      d.json["meshes"][0]["primitives"][0]["indices"] = accessor;
      scene = load(d);
      ASSERT_EQ(scene.faceCount(), 2u);
      // A strip read from its other end faces the same way, a fan turns round.
      EXPECT_EQ(normalOf(scene, 0) + normalOf(scene, 1), Vec3(0, 0, mode == 5 ? 2 : -2));
    }
  }
}

TEST_F(SceneGltf, LeavesOutLinesByName) {
  Document d = triangle();
  d.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 1}});
  EXPECT_NOTE(load(d).notes, "lines and points have no area and are left out, in: tri",
              Severity::info);
  d.json["meshes"][0]["primitives"].erase(0);
  EXPECT_CONTAINS(errorOf(d), "no faces");
}

TEST_F(SceneGltf, ReadsSparseAccessors) {
  Document d = triangle();
  d.add(std::vector<std::uint16_t>{2}, 5123, "SCALAR", 1);
  d.positions({0, 5, 7});
  d.json["accessors"][0]["sparse"] = {{"count", 1},
                                      {"indices", {{"bufferView", 1}, {"componentType", 5123}}},
                                      {"values", {{"bufferView", 2}}}};
  Scene scene = load(d);
  EXPECT_EQ(corner(scene, 0, 1), Vec3(1, 0, 0));
  EXPECT_EQ(corner(scene, 0, 2), Vec3(0, 5, 7));
  // Without a base all other elements are zero.
  d.json["accessors"][0].erase("bufferView");
  scene = load(d);
  EXPECT_EQ(corner(scene, 0, 1), Vec3(0, 0, 0));
  EXPECT_EQ(corner(scene, 0, 2), Vec3(0, 5, 7));
  d.json["accessors"][0]["count"] = 2;
  EXPECT_CONTAINS(errorOf(d), "sparse index beyond its end");
}

TEST_F(SceneGltf, ReadsQuantisedPositions) {
  Document d = triangle();
  d.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const int accessor =
      d.add(std::vector<std::uint16_t>{0, 0, 0, 65535, 0, 0, 0, 13107, 0}, 5123, "VEC3", 3);
  d.json["accessors"][std::size_t(accessor)]["normalized"] = true;
  d.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = accessor;
  const Scene scene = load(d);
  EXPECT_EQ(corner(scene, 0, 1), Vec3(1, 0, 0));
  EXPECT_EQ(corner(scene, 0, 2), Vec3(0, 13107.0 / 65535, 0));
}

TEST_F(SceneGltf, ReadsCamerasThroughTheirNodes) {
  Document d = triangle();
  d.json["cameras"] = {{{"type", "perspective"},
                        {"perspective", {{"yfov", .6}, {"aspectRatio", 1.5}, {"znear", .1}}}},
                       {{"type", "orthographic"},
                        {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 1}, {"znear", .1}}}}};
  const double half = std::sqrt(0.5);  // a quarter turn about y: -z becomes -x
  d.json["nodes"].push_back({{"name", "eye"},
                             {"camera", 0},
                             {"translation", {10, 2, 0}},
                             {"rotation", {0, half, 0, half}}});
  d.json["nodes"].push_back({{"name", "plan"}, {"camera", 1}});
  d.json["scenes"] = {{{"nodes", {0, 1, 2}}}};
  SceneOptions options;
  options.unit = "cm";
  const Scene scene = load(d, options);
  ASSERT_EQ(scene.cameras.size(), 1u);
  const Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.name, "eye");
  EXPECT_EQ(camera.eye, 0.01 * Vec3(10, 2, 0));
  const Vec3 forward = glm::normalize(camera.target - camera.eye);
  // A few roundings of unit vectors.
  EXPECT_NEAR(glm::length(forward - Vec3(-1, 0, 0)), 0, 1e-14);
  EXPECT_NEAR(glm::length(camera.up - Vec3(0, 1, 0)), 0, 1e-14);
  EXPECT_EQ(camera.vertical_fov, .6);
  EXPECT_EQ(camera.aspect, 1.5);
  EXPECT_NOTE(scene.notes, "orthographic cameras are not used: plan", Severity::warning);
}

/// The triangle with a node of each of these lights, moved and turned to shine along +x.
Document withLights(Document d, const Json& lights) {
  d.json["extensionsUsed"] = {"KHR_lights_punctual"};
  d.json["extensions"] = {{"KHR_lights_punctual", {{"lights", lights}}}};
  for (std::size_t k = 0; k < lights.size(); ++k) {
    d.json["scenes"][0]["nodes"].push_back(d.json["nodes"].size());
    d.json["nodes"].push_back({{"name", "light" + std::to_string(k)},
                               {"translation", {1, 2, double(k)}},
                               {"rotation", {0, -std::sqrt(.5), 0, std::sqrt(.5)}},
                               {"scale", {10, 10, 10}},
                               {"extensions", {{"KHR_lights_punctual", {{"light", k}}}}}});
  }
  return d;
}

TEST_F(SceneGltf, ReadsLights) {
  const Document document = withLights(
      triangle(), {{{"type", "point"}, {"intensity", 683}, {"color", {1, .5, 0}}, {"range", 7}},
                   {{"type", "spot"},
                    {"intensity", 1366},
                    {"spot", {{"innerConeAngle", 0}, {"outerConeAngle", std::numbers::pi / 6}}}},
                   {{"type", "directional"}, {"intensity", 68300}}});
  const Scene scene = load(document);
  ASSERT_EQ(scene.lights.size(), 4u);  // the sky
  const Light& point = scene.lights[1];
  EXPECT_EQ(point.name, "light0");
  EXPECT_EQ(point.strength, (std::vector<double>{1, .5, 0}));
  EXPECT_EQ(std::get<PointLight>(point.kind), (PointLight{{1, 2, 0}, 7}));
  const Light& spot = scene.lights[2];
  EXPECT_EQ(spot.strength, std::vector<double>(3, 2.0));
  const auto& cone = std::get<SpotLight>(spot.kind);
  EXPECT_EQ(cone.at, Vec3(1, 2, 1));
  // A few roundings of unit vectors and of degrees.
  EXPECT_NEAR(glm::distance(cone.aim, Vec3(2, 2, 1)), 0, 1e-14);
  EXPECT_NEAR(cone.outer, 30, 1e-13);
  const Light& sun = scene.lights[3];
  EXPECT_EQ(sun.strength, std::vector<double>(3, 100.0));
  EXPECT_NEAR(glm::distance(std::get<Sun>(sun.kind).toward, Vec3(-1, 0, 0)), 0, 1e-14);
  EXPECT_NOTE(scene.notes, "taken at 683 lm/W: light0, light1, light2", Severity::info);

  // In another unit they move with the scene, and are as bright.
  SceneOptions options;
  options.unit = "cm";
  const Scene small = load(document, options);
  EXPECT_EQ(small.lights[1].strength, point.strength);
  EXPECT_EQ(std::get<PointLight>(small.lights[1].kind),
            (PointLight{0.01 * Vec3(1, 2, 0), 0.01 * 7}));
  EXPECT_EQ(std::get<SpotLight>(small.lights[2].kind).aim, 0.01 * cone.aim);
  EXPECT_EQ(std::get<SpotLight>(small.lights[2].kind).outer, cone.outer);
}

/// 400 cd to C0, 300 to C90, 200 to C180, 100 to C270.
constexpr const char* kQuarters =
    "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 5 1 2 0 0 0\n1 1 0\n0 180\n0 90 180 270 360\n"
    "400 400 300 300 200 200 100 100 400 400\n";

// An untransformed light points along -z, the plane of C0 is that of x and z, and horizontal angles
// go counter-clockwise; this one is turned by 90 degrees about y, so that -z becomes -x and x -z.
TEST_F(SceneGltf, ReadsLampsWithProfiles) {
  Document d = triangle();
  write("my lamp.ies", kQuarters);
  d.json["extensionsUsed"] = {"EXT_lights_ies"};
  d.json["extensions"]["EXT_lights_ies"]["lights"] = {
      {{"uri", "my%20lamp.ies"}},
      {{"uri", "data:application/x-ies-lm-63;base64," + test::base64(kQuarters)}}};
  for (int k = 0; k < 2; ++k) {
    d.json["scenes"][0]["nodes"].push_back(d.json["nodes"].size());
    Json extension = {{"light", k}};
    if (k == 1) extension.update({{"multiplier", 2}, {"color", {1, .5, 0}}});
    d.json["nodes"].push_back({{"name", "lamp" + std::to_string(k)},
                               {"translation", {1, 2, 3}},
                               {"rotation", {0, std::sqrt(.5), 0, std::sqrt(.5)}},
                               {"scale", {10, 10, 10}},
                               {"extensions", {{"EXT_lights_ies", extension}}}});
  }
  const Scene scene = load(d);
  ASSERT_EQ(scene.lights.size(), 3u);  // the sky
  const Light& lamp = scene.lights[1];
  EXPECT_EQ(lamp.fileName(), "my lamp.ies");
  const double watts = 1000 * std::numbers::pi / kLumensPerWatt;  // 250 cd in the mean
  EXPECT_NEAR(lamp.strength[0], watts, 1e-6);
  const std::pair<Vec3, double> around[] = {
      {{0, 0, -1}, 400}, {{0, 1, 0}, 300}, {{0, 0, 1}, 200}, {{0, -1, 0}, 100}};
  for (const auto& [side, candela] : around) {
    const Vec3 way = side + Vec3(-1, 0, 0);
    const LightRay ray = lamp.ray(Vec3(1, 2, 3) + way, 0, 0);
    EXPECT_NEAR(ray.share * glm::dot(way, way) * lamp.strength[0] * kLumensPerWatt, candela, 1e-3);
  }
  EXPECT_EQ(scene.lights[2].name, "lamp1");
  EXPECT_NEAR(scene.lights[2].strength[1], watts, 1e-6);
  EXPECT_EQ(scene.lights[2].strength[2], 0);
  d.json["nodes"][1]["extensions"]["EXT_lights_ies"]["light"] = 7;
  EXPECT_CONTAINS(errorOf(d), "node lamp0: its light profile does not exist");
  d.json["nodes"][1]["extensions"]["EXT_lights_ies"]["light"] = 0;
  d.json["extensions"]["EXT_lights_ies"]["lights"][0]["uri"] = "other.ies";
  EXPECT_CONTAINS(errorOf(d), "other.ies: no such file");
}

/// A lamp of each of these extensions, all of the profile 0.
Document withProfile(Document d, const std::vector<Json>& lamps) {
  d.json["extensionsUsed"] = {"EXT_lights_ies"};
  d.json["extensions"]["EXT_lights_ies"]["lights"] = {{{"uri", "lamp.ies"}}};
  for (Json extension : lamps) {
    extension["light"] = 0;
    d.json["scenes"][0]["nodes"].push_back(d.json["nodes"].size());
    d.json["nodes"].push_back({{"name", "lamp"}, {"extensions", {{"EXT_lights_ies", extension}}}});
  }
  return d;
}

// It states 1,000 lm, and has 100 cd to a hemisphere, of an opening of a metre.
TEST_F(SceneGltf, SharesTheProfilesOfLamps) {
  write("lamp.ies",
        "IESNA:LM-63-2002\nTILT=NONE\n1 100 1 2 1 1 2 1 1 0\n1 1 0\n0 90\n0\n100 100\n");
  const Scene scene = load(withProfile(triangle(), std::vector<Json>(3)));
  ASSERT_EQ(scene.lights.size(), 4u);  // the sky
  const auto isOfItsTable = [](const Note& note) { return note.text.starts_with("lamp.ies: "); };
  EXPECT_EQ(std::ranges::count_if(scene.notes, isOfItsTable), 1);
  const auto& first = std::get<PhotometricLight>(scene.lights[1].kind);
  const auto& last = std::get<PhotometricLight>(scene.lights[3].kind);
  EXPECT_EQ(&first.file.table(), &last.file.table());
  // The extension has infinitely small points.
  EXPECT_FALSE(first.isWide(Vec3(0, 0, -.1)));
  EXPECT_EQ(first.file.table().size(), 0);
}

TEST_F(SceneGltf, RefusesFactorsOfLampsThatAreNone) {
  write("lamp.ies", kQuarters);
  const auto refusal = [&](const Json& extension) {
    return errorOf(withProfile(triangle(), {extension}));
  };
  for (const Json& factor : {Json("2"), Json(-1), Json::array({1})}) {
    EXPECT_CONTAINS(refusal({{"multiplier", factor}}),
                    "node lamp: multiplier of its lamp is no number of 0 or more; correct it");
  }
  for (const Json& colour : {Json::array({1, 1}), Json::array({1, 1, 1, 1}), Json(1),
                             Json::array({1, 1, "1"}), Json::array({1, 1, 2})}) {
    EXPECT_CONTAINS(refusal({{"color", colour}}),
                    "node lamp: color of its lamp is not three numbers from 0 to 1; correct it");
  }
  const Scene scene = load(withProfile(triangle(), {{{"multiplier", 0}, {"color", {0, 0.5, 1}}}}));
  EXPECT_EQ(scene.lights.back().strength, std::vector<double>(3, 0.0));
}

TEST_F(SceneGltf, RefusesLightsThatAreNone) {
  EXPECT_CONTAINS(errorOf(withLights(triangle(), {{{"type", "point"}, {"intensity", -1}}})),
                  "is not a finite value of 0 or more");
  EXPECT_CONTAINS(errorOf(withLights(
                      triangle(), {{{"type", "spot"},
                                    {"spot", {{"innerConeAngle", 1.}, {"outerConeAngle", .5}}}}})),
                  "give inner at most outer");
  const Scene scene = load(withLights(triangle(), {{{"type", "area"}}}));
  EXPECT_NOTE(scene.notes, "of a kind that is none, give no light: light0", Severity::warning);
}

TEST_F(SceneGltf, NamesOtherScenes) {
  Document d = triangle();
  d.json["nodes"].push_back({{"name", "elsewhere"}, {"mesh", 0}});
  d.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  const Scene scene = load(d);
  EXPECT_EQ(scene.faceCount(), 1u);
  EXPECT_NOTE(scene.notes, "not part of the scene that is read, node: elsewhere",
              Severity::warning);
}

TEST_F(SceneGltf, RefusesReferencesThatLeadNowhere) {
  const auto with = [&](const char* pointer, const Json& value) {
    Document d = triangle();
    d.json[Json::json_pointer(pointer)] = value;
    return errorOf(d);
  };
  EXPECT_CONTAINS(with("/nodes/0/mesh", 5), "node tri refers to mesh 5, which does not exist");
  EXPECT_CONTAINS(with("/scenes/0/nodes/0", 7), "refers to node 7");
  EXPECT_CONTAINS(with("/scene", 3), "refers to scene 3");
  EXPECT_CONTAINS(with("/nodes/0/children", {0}), "node tri is reached twice");
  EXPECT_CONTAINS(with("/nodes/0/camera", 1), "refers to camera 1");
  EXPECT_CONTAINS(with("/meshes/0/primitives/0/material", 2), "refers to material 2");
  EXPECT_CONTAINS(with("/meshes/0/primitives/0/attributes/POSITION", 9), "accessor 9");
  EXPECT_CONTAINS(with("/accessors/0/count", 4), "tri, primitive 0: POSITION reaches beyond");
  EXPECT_CONTAINS(with("/accessors/0/count", 4000000000000000000ll), "reaches beyond");
  EXPECT_CONTAINS(with("/accessors/0/byteOffset", 4), "reaches beyond");
  EXPECT_CONTAINS(with("/accessors/0/type", "VEC2"), "is not a list of 3 numbers");
  EXPECT_CONTAINS(with("/bufferViews/0/byteLength", 4000), "reaches beyond");
  EXPECT_CONTAINS(with("/nodes/0/rotation", {0, 0, 0, 0}), "zero quaternion");
}

TEST_F(SceneGltf, RefusesBadIndicesAndPositions) {
  Document d = triangle();
  const int out = d.add(std::vector<std::uint16_t>{0, 1, 3}, 5123, "SCALAR", 1);
  d.json["meshes"][0]["primitives"][0]["indices"] = out;
  EXPECT_CONTAINS(errorOf(d), "tri, primitive 0: vertex 3 does not exist, there are 3");
  const int four = d.add(std::vector<std::uint16_t>{0, 1, 2, 0}, 5123, "SCALAR", 1);
  d.json["meshes"][0]["primitives"][0]["indices"] = four;
  EXPECT_CONTAINS(errorOf(d), "4 indices do not make triangles");
  const int nan = d.positions({0, 0, 0, 1, 0, 0, 0, kNaN, 0});
  d.json["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", nan}}}};
  EXPECT_CONTAINS(errorOf(d), "tri, primitive 0: vertex 2 is not finite");
}

TEST_F(SceneGltf, RefusesFilesThatAreNoGltf) {
  const auto errorIn = [&](const std::string& name, const std::string& content) {
    const std::string file = write(name, content);
    return inputErrorOf([&] { loadScene(file); });
  };
  EXPECT_CONTAINS(errorIn("a.gltf", "{ \"asset\": "),
                  "a.gltf: is not JSON that can be read: it is cut off");
  EXPECT_CONTAINS(errorIn("a.gltf", std::string("\x7f\0\1garbage", 10)),
                  "neither binary glTF nor a JSON object");
  EXPECT_CONTAINS(errorIn("a.glb", "not a binary glTF at all"),
                  "a.glb: is neither binary glTF nor a JSON object");
  EXPECT_CONTAINS(errorIn("a.gltf", ""), "is empty");
  EXPECT_CONTAINS(inputErrorOf([&] { loadScene(path("absent.glb")); }), "no such file");
  Document old = triangle();
  old.json["asset"]["version"] = "1.0";
  EXPECT_CONTAINS(errorOf(old), "is glTF 1.0");
  Document away = triangle();
  away.text();
  away.json["buffers"][0]["uri"] = "lost.bin";
  EXPECT_CONTAINS(errorIn("b.gltf", away.json.dump()), "lost.bin");
}

TEST_F(SceneGltf, RefusesEveryTruncatedFile) {
  Document d = triangle();
  d.json["materials"] = {{{"name", "m"}, {"emissiveFactor", {1, 1, 1}}}};
  const std::string text = d.text();
  for (std::size_t size = 1; size < text.size(); size += 3) {
    const std::string file = write("cut.gltf", text.substr(0, size));
    EXPECT_CONTAINS(inputErrorOf([&] { loadScene(file); }),
                    "cut.gltf: is not JSON that can be read");
  }
}

TEST_F(SceneGltf, ReadsBinaryFiles) {
  Document d = triangle();
  d.text();
  d.json["buffers"][0].erase("uri");
  std::string json = d.json.dump();
  while (json.size() % 4 != 0) json += ' ';
  while (d.bytes.size() % 4 != 0) d.bytes += '\0';
  std::string glb;
  const auto word = [&](std::size_t value) {
    const auto v = std::uint32_t(value);
    glb.append(reinterpret_cast<const char*>(&v), 4);
  };
  glb = "glTF";
  word(2);
  word(12 + 8 + json.size() + 8 + d.bytes.size());
  word(json.size());
  glb += "JSON" + json;
  word(d.bytes.size());
  glb += std::string("BIN\0", 4) + d.bytes;
  const Scene scene = loadScene(write("scene.GLB", glb));
  ASSERT_EQ(scene.faceCount(), 1u);
  EXPECT_EQ(corner(scene, 0, 2), Vec3(0, 1, 0));
  for (std::size_t size = 1; size < glb.size(); size += 5) {
    const std::string file = write("cut.glb", glb.substr(0, size));
    EXPECT_CONTAINS(inputErrorOf([&] { loadScene(file); }), "cut.glb: ");
  }
}

}  // namespace
}  // namespace radiosity::test
