// Cameras: from text, by default, and the exposure of their pictures.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <random>

#include "radiosity/render.h"
#include "render/view.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

using test::MeshBuilder;

std::string complaint(const std::string& text) {
  try {
    parseCamera(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ParseCamera, ReadsAllParts) {
  const Camera camera = parseCamera(" eye = 1,-2.5,+3e1 ; target=0,0,0;up=0,0,1;fov=45; ");
  EXPECT_EQ(camera.eye, Vec3(1, -2.5, 30));
  EXPECT_EQ(camera.target, Vec3(0));
  EXPECT_EQ(camera.up, Vec3(0, 0, 1));
  EXPECT_DOUBLE_EQ(camera.vertical_fov, std::numbers::pi / 4);
}

TEST(ParseCamera, UpAndFieldOfViewMayBeLeftOut) {
  const Camera camera = parseCamera("target=0,1,0;eye=0,1,5");
  EXPECT_EQ(camera.up, Vec3(0, 1, 0));
  EXPECT_EQ(camera.vertical_fov, Camera().vertical_fov);
  EXPECT_EQ(parseCamera("eye=0,5,0;target=0,0,0").up, Vec3(0, 0, -1));
  EXPECT_EQ(parseCamera("eye=0,5,0;target=0,0,0", Up::z).up, Vec3(0, 0, 1));
  EXPECT_EQ(parseCamera("eye=0,0,5;target=0,0,0", Up::z).up, Vec3(0, 1, 0));
}

TEST(ParseCamera, SaysWhichPartIsWrong) {
  const auto expect = [](const std::string& text, const std::string& part) {
    const std::string said = complaint(text);
    EXPECT_NE(said.find(part), std::string::npos) << text << " -> " << said;
    EXPECT_EQ(said.find('\n'), std::string::npos);
  };
  expect("", "eye is missing");
  expect("eye=0,0,1", "target is missing");
  expect("eye=0,0;target=0,0,0", "eye=\"0,0\" has 2 numbers");
  expect("eye=;target=0,0,0", "has 0 numbers");
  expect("eye=0,0,1,2;target=0,0,0", "has 4 numbers");
  expect("eye=0,x,1;target=0,0,0", "\"x\" is not a finite number");
  expect("eye=0,nan,1;target=0,0,0", "\"nan\" is not a finite number");
  expect("eye=0,1e999,1;target=0,0,0", "\"1e999\"");
  expect("eye=0,1 2,1;target=0,0,0", "\"1 2\"");
  expect("eye=0,0,1;target=0,0,0;fov=0", "between 0 and 180");
  expect("eye=0,0,1;target=0,0,0;fov=180", "between 0 and 180");
  expect("eye=0,0,1;target=0,0,0;fov=wide", "\"wide\"");
  expect("eye=0,0,1;target=0,0,0;fov=", "fov");
  expect("eye=0,0,1;target=0,0,1", "same point");
  expect("eye=0,0,1;target=0,0,0;up=0,0,-3", "along its up vector");
  expect("eye=0,0,1;target=0,0,0;up=0,0,0", "up is 0,0,0");
  expect("eye=0,0,1;eye=0,0,2;target=0,0,0", "eye is given twice");
  expect("eye=0,0,1;look=0,0,0", "unknown part \"look\"");
  expect("eye=0,0,1;target", "no value");
}

TEST(View, ANarrowPictureKeepsTheCamerasHorizontalField) {
  Camera camera;
  camera.vertical_fov = 2 * std::atan(0.5);
  camera.aspect = 2;  // half the horizontal field: tan = 1
  // At 45 degrees to the right: the right edge of the picture, whatever the picture's shape.
  for (const int height : {100, 200, 400}) {
    const View view = makeView(camera, 200, height);
    const Vec3 p = view.toPixels(view.toCamera({7, 0, -7}));
    EXPECT_NEAR(p.x / p.z, 200, 1e-10) << height;  // rounding of tan and atan
  }
  // In a wider one the vertical field stays.
  const View wide = makeView(camera, 400, 100);
  const Vec3 p = wide.toPixels(wide.toCamera({0, 3.5, -7}));
  EXPECT_NEAR(p.y / p.z, 0, 1e-10);
}

PatchMesh room(const Vec3& size, bool block_at_the_ends) {
  MeshBuilder builder;
  builder.box("room", Vec3(0), size, 6, true);
  if (block_at_the_ends) {  // at the place of an eye near the end of the longest extent
    const Vec3 half(0.12 * size.x, 0.4 * size.y, 0.3 * size.z);
    for (const double x : {0.13, 0.87}) {
      const Vec3 centre = Vec3(x, 0.45, 0.5) * size;
      builder.box("block", centre - half, centre + half, 3);
    }
  }
  return builder.build();
}

/// Share of a picture's pixels that show a front, in full.
double fronts(const PatchMesh& mesh, const Camera& camera) {
  RenderOptions options;
  options.width = options.height = 64;
  options.show_backs = true;  // black
  Progress silent;
  const std::vector<double> ones(mesh.size() * 3, 1.0);
  const Image image = render(mesh, ones, camera, options, silent);
  double sum = 0;
  for (std::size_t k = 0; k < image.rgba.size(); k += 4) sum += image.rgba[k] * image.rgba[k + 3];
  return sum / (64 * 64);
}

TEST(FramingCamera, AClosedRoomIsSeenFromAnEndAlongItsLength) {
  for (const Vec3& size : {Vec3(8, 2.5, 4), Vec3(4, 2.5, 8), Vec3(8e-3, 2.5e-3, 4e-3)}) {
    const PatchMesh mesh = room(size, false);
    const Camera camera = framingCamera(mesh, true, 1);
    const int axis = size.x > size.z ? 0 : 2;
    for (int k = 0; k < 3; ++k) {
      EXPECT_GT(camera.eye[k], 0);
      EXPECT_LT(camera.eye[k], size[k]);
    }
    const double share = camera.eye[axis] / size[axis];
    EXPECT_LT(std::min(share, 1 - share), 0.1);
    const Vec3 view = glm::normalize(camera.target - camera.eye);
    EXPECT_GT(std::abs(view[axis]), 0.98);
    EXPECT_EQ(fronts(mesh, camera), 1);
  }
}

TEST(FramingCamera, StandsOnTheFloorIfZIsUp) {
  const PatchMesh mesh = room({8, 2.5, 4}, true);
  PatchMesh lying = mesh;
  for (auto* const vectors : {&lying.vertices, &lying.centroid, &lying.normal,
                              &lying.polygons.normal, &lying.polygons.origin}) {
    for (Vec3& v : *vectors) v = {v.x, -v.z, v.y};
  }
  const Camera standing = framingCamera(mesh, true, 1.5);
  const Camera camera = framingCamera(lying, true, 1.5, {}, Up::z);
  EXPECT_EQ(camera.eye, Vec3(standing.eye.x, -standing.eye.z, standing.eye.y));
  EXPECT_EQ(camera.target, Vec3(standing.target.x, -standing.target.z, standing.target.y));
  EXPECT_EQ(camera.up, Vec3(0, 0, 1));
  EXPECT_NEAR(camera.eye.z, 1.6, 1e-12);  // eye height
  EXPECT_EQ(fronts(lying, camera), 1);
}

TEST(FramingCamera, NeverStandsInABlock) {
  const PatchMesh mesh = room({8, 2.5, 4}, true);
  const Camera camera = framingCamera(mesh, true, 1.5);
  EXPECT_EQ(fronts(mesh, camera), 1);  // from within a block everything is black
}

TEST(FramingCamera, AnOpenBoxIsSeenThroughItsOpening) {
  MeshBuilder builder;  // open towards -x
  builder.grid("floor", {0, 0, 0}, {0, 0, 2}, {2, 0, 0}, 6, 6);
  builder.grid("ceiling", {0, 2, 0}, {2, 0, 0}, {0, 0, 2}, 6, 6);
  builder.grid("end", {2, 0, 0}, {0, 0, 2}, {0, 2, 0}, 6, 6);
  builder.grid("near", {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, 6, 6);
  builder.grid("far", {0, 0, 2}, {0, 2, 0}, {2, 0, 0}, 6, 6);
  const PatchMesh mesh = builder.build();
  const Camera camera = framingCamera(mesh, false, 1);
  EXPECT_EQ(camera.name, "framed from outside");
  EXPECT_LT(camera.eye.x, 0);
  const Vec3 view = glm::normalize(camera.target - camera.eye);
  EXPECT_GT(view.x, 0.99);
  // Everything is in the picture and it fills 95% of its height.
  double widest = 0;
  const View v = makeView(camera, 100, 100);
  for (const Vec3& vertex : mesh.vertices) {
    const Vec3 p = v.toPixels(v.toCamera(vertex));
    ASSERT_GT(p.z, 0);
    widest = std::max({widest, std::abs(p.x / p.z - 50), std::abs(p.y / p.z - 50)});
  }
  EXPECT_NEAR(widest, 47.5, 1e-9);  // by construction, to rounding
}

TEST(FramingCamera, ASolidIsSeenFromOutsideEvenIfClosed) {
  MeshBuilder builder;
  builder.box("solid", {10, 20, 30}, {11, 22, 31.5}, 4);
  const PatchMesh mesh = builder.build();
  for (const bool closed : {true, false}) {
    const Camera camera = framingCamera(mesh, closed, 1.5);
    EXPECT_GT(fronts(mesh, camera), 0.2);
    int sides_seen = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double low[3] = {10, 20, 30};
      const double high[3] = {11, 22, 31.5};
      sides_seen += camera.eye[axis] < low[axis] || camera.eye[axis] > high[axis];
    }
    EXPECT_EQ(sides_seen, 3) << "three faces show more than one";
  }
}

TEST(FramingCamera, APlateIsSeenFromItsFront) {
  MeshBuilder builder;
  builder.grid("plate", {0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 4, 4);  // front towards -x
  const PatchMesh mesh = builder.build();
  EXPECT_GT(fronts(mesh, framingCamera(mesh, false, 1)), 0.3);
}

TEST(FramingCamera, DoesNotDependOnThreadsOrScale) {
  const PatchMesh mesh = room({8, 2.5, 4}, true);
  const Camera reference = framingCamera(mesh, true, 1);
  setThreads(1);
  const Camera one = framingCamera(mesh, true, 1);
  setThreads(0);
  EXPECT_EQ(one.eye, reference.eye);
  EXPECT_EQ(one.target, reference.target);
  // Eyes stand at a person's height in scenes as high as a room or hall, else at a share of theirs.
  const auto scaled = [&](double factor) {
    PatchMesh other = mesh;
    for (auto* const places : {&other.vertices, &other.centroid, &other.polygons.origin}) {
      for (Vec3& v : *places) v *= factor;
    }
    for (double& a : other.area) a *= factor * factor;
    return framingCamera(other, true, 1).eye / factor;
  };
  EXPECT_EQ(scaled(1024.0), scaled(1.0 / 1024));
}

TEST(FramingCamera, StandsAtEyeHeight) {
  for (const Vec3& size : {Vec3(8, 2.5, 4), Vec3(20, 9, 30)}) {
    EXPECT_NEAR(framingCamera(room(size, false), true, 1).eye.y, 1.6, 1e-12) << size.y;
  }
}

/// A room with a window in its long wall: 3% of its surface is open.
PatchMesh roomWithWindow() {
  MeshBuilder builder;
  builder.grid("floor", {0, 0, 0}, {0, 0, 4}, {8, 0, 0}, 8, 8);
  builder.grid("ceiling", {0, 2.5, 0}, {8, 0, 0}, {0, 0, 4}, 8, 8);
  builder.grid("left", {0, 0, 0}, {0, 2.5, 0}, {0, 0, 4}, 4, 4);
  builder.grid("right", {8, 0, 0}, {0, 0, 4}, {0, 2.5, 0}, 4, 4);
  builder.grid("front", {0, 0, 4}, {0, 2.5, 0}, {8, 0, 0}, 4, 4);
  // The back wall, facing +z, around a window from (3, 0.8) to (5.5, 2).
  builder.grid("back", {0, 0, 0}, {3, 0, 0}, {0, 2.5, 0}, 4, 4);
  builder.grid("back", {5.5, 0, 0}, {2.5, 0, 0}, {0, 2.5, 0}, 4, 4);
  builder.grid("back", {3, 0, 0}, {2.5, 0, 0}, {0, 0.8, 0}, 4, 2);
  builder.grid("back", {3, 2, 0}, {2.5, 0, 0}, {0, 0.5, 0}, 4, 2);
  return builder.build();
}

TEST(FramingCamera, ARoomWithAWindowIsSeenFromInside) {
  const PatchMesh mesh = roomWithWindow();
  const Camera camera = framingCamera(mesh, false, 1.5);
  EXPECT_EQ(camera.name, "framed from inside");
  EXPECT_NEAR(camera.eye.y, 1.6, 1e-12);
  EXPECT_GT(camera.eye.x, 0);
  EXPECT_LT(camera.eye.x, 8);
  EXPECT_GT(camera.eye.z, 0);
  EXPECT_LT(camera.eye.z, 4);
  EXPECT_GT(fronts(mesh, camera), 0.9);
}

TEST(FramingCamera, LooksTowardsTheLitRoom) {
  // Two rooms side by side, the wall between them closed: light in one of them.
  for (const bool first_lit : {true, false}) {
    MeshBuilder builder;
    builder.box("one", {0, 0, 0}, {5, 2.5, 4}, 6, true);
    builder.box("two", {5, 0, 0}, {10, 2.5, 4}, 6, true);
    const PatchMesh mesh = builder.build();
    std::vector<double> light;
    light.reserve(mesh.size());
    for (const Index s : mesh.surface) light.push_back((s == 0) == first_lit ? 3.0 : 1e-9);
    const Camera camera = framingCamera(mesh, true, 1, light);
    EXPECT_EQ(camera.eye.x < 5, first_lit);
    EXPECT_GT(fronts(mesh, camera), 0.9);
  }
}

/// Without light in its view, the camera leaves out what is far from nearly all polygons.
TEST(FramingCamera, AnObjectFarAwayIsLeftOutIfNothingLitWouldBeSeen) {
  MeshBuilder builder;
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      builder.box("block", {2.0 * x, 2.0 * y, 0}, {2.0 * x + 1, 2.0 * y + 1, 1}, 1, false);
    }
  }
  builder.box("stray", {3000, 3000, 0}, {3001, 3001, 1}, 1, false);
  const PatchMesh mesh = builder.build();
  std::vector<double> light(mesh.size(), 0.0);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.centroid[i].x < 100 && mesh.normal[i].z > 0.5) light[i] = 1;
  }
  const Camera near = framingCamera(mesh, false, 1.5, light, Up::z);
  EXPECT_LT(glm::distance(near.eye, Vec3(2.5, 2.5, 0.5)), 30);
  EXPECT_LT(glm::distance(near.target, Vec3(2.5, 2.5, 0.5)), 5);
}

/// Houses of 20 m in a plain of 9 km: a picture of all of them would show dots.
TEST(FramingCamera, OfHousesFarApartTheLargestIsFramed) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(0, 9000);
  for (const int houses : {2, 6, 40}) {
    MeshBuilder builder;
    for (int k = 0; k < houses; ++k) {
      const Vec3 low(place(random), 0, place(random));
      const double size = k == 1 ? 30 : 20;
      builder.box("houses", low, low + Vec3(size, 10, size), 1, false, false);
    }
    const PatchMesh mesh = builder.build();
    EXPECT_GT(fronts(mesh, framingCamera(mesh, false, 1.5)), 0.02) << houses;
  }
}

TEST(FramingCamera, NeedsALightValueForEachPatch) {
  const PatchMesh mesh = room({1, 1, 1}, false);
  EXPECT_THROW(framingCamera(mesh, true, 1, std::vector<double>(3, 1.0)), InputError);
  EXPECT_EQ(typicalLight(mesh, std::vector<double>(mesh.size(), 0.0)), 0);
  EXPECT_NEAR(typicalLight(mesh, std::vector<double>(mesh.size(), 5.0)), 5, 1e-12);
}

TEST(FramingCamera, NeedsAPositiveAspectAndTakesAnEmptyMesh) {
  EXPECT_THROW(framingCamera(room({1, 1, 1}, false), true, 0), InputError);
  EXPECT_NO_THROW(makeView(framingCamera(MeshBuilder().build(), false, 1), 8, 8));
}

TEST(Exposure, ThePercentileOfTheHitPixelsGoesToFourFifths) {
  Image image{25, 8, {}};
  std::vector<int> order(200);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937_64(5));
  for (const int k : order) {  // 100 pixels of luminance 1 to 100, 100 misses that are bright
    const float value = k < 100 ? float(k + 1) : 1e6f;
    image.rgba.insert(image.rgba.end(), {value, value, value, k < 100 ? 1.0f : 0.0f});
  }
  // Of 1 to 100, 99 is the smallest value that 99% do not exceed. Float luminance: 1e-6.
  EXPECT_NEAR(autoExposure(image), std::log2(0.8 / 99), 1e-6);
}

TEST(Exposure, ALampThatFillsAFifthOfThePictureDoesNotBlackenTheRoom) {
  Image image{10, 10, {}};
  for (int k = 0; k < 100; ++k) {
    const float value = k < 20 ? 1000.0f : k < 30 ? 0.0f : 2.0f;  // lamp, backs, room
    image.rgba.insert(image.rgba.end(), {value, value, value, 1.0f});
  }
  // The median of the lit pixels, 2, goes to a tenth.
  EXPECT_NEAR(autoExposure(image), std::log2(0.1 / 2), 1e-6);
}

/// What the lamps shine on is metered, the same with and without a lamp in view.
TEST(Exposure, LampsInViewDoNotCount) {
  Image image{10, 10, {}};
  std::vector<std::uint8_t> lamps;
  for (int k = 0; k < 100; ++k) {
    lamps.push_back(k < 20 ? 1 : 0);
    const float value = k < 20 ? 1000.0f : 2.0f;
    image.rgba.insert(image.rgba.end(), {value, value, value, 1.0f});
  }
  EXPECT_NEAR(autoExposure(image, lamps), std::log2(0.8 / 2), 1e-6);
  // If there is nothing but the lamp, it is metered.
  EXPECT_NEAR(autoExposure(image, std::vector<std::uint8_t>(100, 1)), autoExposure(image), 0);
}

TEST(Exposure, ALampIsWhatSendsOutMoreThanItReflects) {
  MeshBuilder builder;
  builder.grid("wall", {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  builder.grid("lamp", {1, 0, 0}, {1, 0, 0}, {0, 1, 0});
  builder.grid("glow", {2, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const PatchMesh mesh = builder.build();
  SurfaceLight light;
  light.patches = {1, 1, 1, 9, 9, 9, 1, 1, 1};  // B
  light.reflected = {1, 2, 0.6};
  RenderOptions options;
  options.width = 6;
  options.height = 2;
  const Camera camera = parseCamera("eye=1.5,.5,1;target=1.5,.5,0;fov=53.13010235415598");
  const std::vector<std::uint8_t> row{0, 0, 1, 1, 0, 0};
  std::vector<std::uint8_t> expected = row;
  expected.insert(expected.end(), row.begin(), row.end());
  EXPECT_EQ(lampPixels(mesh, light, camera, options), expected);
}

TEST(Exposure, LuminanceIsRec709) {
  const Image green{1, 1, {0, 2, 0, 1}};
  EXPECT_NEAR(autoExposure(green), std::log2(0.8 / (2 * 0.7152)), 1e-6);
}

TEST(Exposure, EmptyAndBlackImagesAreNotExposed) {
  EXPECT_EQ(autoExposure(Image{}), 0);
  EXPECT_EQ(autoExposure(Image{1, 1, {5, 5, 5, 0}}), 0);
  EXPECT_EQ(autoExposure(Image{1, 1, {0, 0, 0, 1}}), 0);
}

TEST(Exposure, MultipliesColoursOnly) {
  const Image image = exposed(Image{1, 1, {1, 0.5f, 3, 0.25f}}, 2);
  EXPECT_EQ(image.rgba, (std::vector<float>{4, 2, 12, 0.25f}));
}

}  // namespace
}  // namespace radiosity
