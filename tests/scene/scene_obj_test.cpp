// Wavefront OBJ and MTL: what is read, and every way a file can lie.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "radiosity/scene.h"
#include "support/scene_files.h"

namespace radiosity::test {
namespace {

class SceneObj : public SceneFiles {
 protected:
  /// Loads "scene.obj" with this text.
  Scene load(const std::string& text, const SceneOptions& options = {}) {
    return loadScene(write("scene.obj", text), options);
  }
  std::string errorOf(const std::string& text, const SceneOptions& options = {}) {
    const std::string file = write("scene.obj", text);
    return inputErrorOf([&] { loadScene(file, options); });
  }
};

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string kFace = "f 1 2 3 4\n";

TEST_F(SceneObj, DefaultOptionsAreValid) { EXPECT_NO_THROW(SceneOptions().validate()); }

TEST_F(SceneObj, OptionsOutOfRangeAreNamed) {
  SceneOptions options;
  options.unit = "parsec";
  EXPECT_CONTAINS(inputErrorOf([&] { options.validate(); }), "parsec");
  options = {};
  options.default_reflectance = 1.5;
  EXPECT_CONTAINS(inputErrorOf([&] { options.validate(); }), "1.5");
  options.default_reflectance = std::nan("");
  EXPECT_THROW(options.validate(), InputError);
}

TEST_F(SceneObj, ReadsCoordinatesCorrectlyRounded) {
  // The literals are rounded by the compiler, the file by the program; 0.3 is one of the numbers
  // that digit-by-digit parsing misses by an ulp.
  const Scene scene = load("v 0.3 -1e-3 +559.2\nv 1000000.1 .5 5.\nv 1E6 0 2e+0\nf 1 2 3\n");
  EXPECT_EQ(scene.vertices[0], Vec3(0.3, -1e-3, 559.2));
  EXPECT_EQ(scene.vertices[1], Vec3(1000000.1, 0.5, 5.0));
  EXPECT_EQ(scene.vertices[2], Vec3(1e6, 0, 2));
}

TEST_F(SceneObj, KeepsPolygonsInFileOrder) {
  // A concave pentagon, a triangle and a 3000-gon, with names in between.
  std::string text = kSquare + "v .5 .5 0\n";
  for (int k = 0; k < 3000; ++k) {
    const double angle = 2 * std::numbers::pi * k / 3000;
    text += fmt::format("v {} {} 1\n", std::cos(angle), std::sin(angle));
  }
  text += "o a\nf 1 2 3 5 4\no b\nf 1 2 3\no a\nf";
  for (int k = 0; k < 3000; ++k) text += fmt::format(" {}", 6 + k);
  const Scene scene = load(text + "\n");
  ASSERT_EQ(scene.faceCount(), 3u);
  EXPECT_EQ(scene.face(0).size(), 5u);
  EXPECT_EQ(scene.face(1).size(), 3u);
  EXPECT_EQ(scene.face(2).size(), 3000u);
  EXPECT_EQ(scene.face(0)[3], 4u);
  EXPECT_EQ(scene.face(2)[2999], 3004u);
  // `a` is one surface although it was opened twice.
  ASSERT_EQ(scene.surfaces.size(), 2u);
  EXPECT_EQ(scene.face_surface[0], scene.face_surface[2]);
  EXPECT_EQ(scene.face_element[1], 3009u) << "the line of the second face";
  EXPECT_TRUE(scene.texcoords.empty());
}

TEST_F(SceneObj, ReadsNegativeIndices) {
  const Scene scene = load(kSquare + "f -4 -3 -2 -1\nv 5 5 5\nf -1 1 -3\n");
  EXPECT_EQ(std::vector<Index>(scene.face(0).begin(), scene.face(0).end()),
            (std::vector<Index>{0, 1, 2, 3}));
  EXPECT_EQ(std::vector<Index>(scene.face(1).begin(), scene.face(1).end()),
            (std::vector<Index>{4, 0, 2}));
}

TEST_F(SceneObj, ReadsContinuedLinesCarriageReturnsAndComments) {
  const Scene scene = load(
      "\xef\xbb\xbf# by C:\\tools\\\r\nv 0 0 0\r\nv 1 0 \\\r\n 0\r\n\r\n  v 1 1 0 # last\r\n"
      "o one\r\nf 1 \\\r\n2 3 # face\r\n");
  ASSERT_EQ(scene.vertices.size(), 3u);
  EXPECT_EQ(scene.vertices[1], Vec3(1, 0, 0));
  EXPECT_EQ(scene.face(0).size(), 3u);
  EXPECT_EQ(scene.face_element[0], 8u) << "a continued line is known by its first line";
  EXPECT_EQ(scene.surfaces[0].object, "one");
}

TEST_F(SceneObj, NamesSurfacesByObjectAndMaterial) {
  write("m.mtl", "newmtl red paint\nKd .6 .1 .1\nnewmtl white\nKd .7 .7 .7\n");
  const Scene scene = load("mtllib m.mtl\n" + kSquare + "o left wall\nusemtl red paint\n" + kFace +
                           "usemtl white\n" + kFace + "g ledge\nusemtl white\n" + kFace +
                           "g\nusemtl white\n" + kFace);
  ASSERT_EQ(scene.surfaces.size(), 3u);
  EXPECT_EQ(scene.surfaces[0].name, "left wall/red paint");
  EXPECT_EQ(scene.surfaces[1].name, "left wall/white");
  EXPECT_EQ(scene.surfaces[2].name, "ledge/white");
  EXPECT_EQ(scene.face_surface[3], 1u) << "a bare g goes back to the object";
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(.6, .1, .1));
}

TEST_F(SceneObj, SurfaceNamesAreUniqueEvenWithSlashes) {
  write("m.mtl", "newmtl c\nKd 1 1 1\nnewmtl b/c\nKd 0 0 0\n");
  const Scene scene =
      load("mtllib m.mtl\n" + kSquare + "o a/b\nusemtl c\n" + kFace + "o a\nusemtl b/c\n" + kFace);
  ASSERT_EQ(scene.surfaces.size(), 2u);
  EXPECT_NE(scene.surfaces[0].name, scene.surfaces[1].name);
}

TEST_F(SceneObj, RefusesWordsWhereNumbersAreDue) {
  const std::array<std::string, 9> words = {"nan", "inf",  "1,5", "1e999", "0x10",
                                            "one", "1.5f", "--1", "1e"};
  for (const std::string& word : words) {
    const std::string error = errorOf(fmt::format("v 0 0 0\nv {} 0 0\nv 0 1 0\nf 1 2 3\n", word));
    EXPECT_CONTAINS(error, "scene.obj:2:");
    EXPECT_CONTAINS(error, fmt::format("`{}`", word));
  }
  EXPECT_CONTAINS(errorOf("v 0 0\n"), "scene.obj:1: a vertex has 3 coordinates, not 2");
  EXPECT_CONTAINS(errorOf(kSquare + "vt 0 0 0 0\nf 1 2 3\n"), "scene.obj:5:");
}

TEST_F(SceneObj, RefusesIndicesThatPointNowhere) {
  EXPECT_CONTAINS(errorOf(kSquare + "\nf 1 2 9\n"),
                  "scene.obj:6: vertex 9 does not exist, the file has 4");
  EXPECT_CONTAINS(errorOf(kSquare + "f 0 1 2\n"), "scene.obj:5: `0`");
  EXPECT_CONTAINS(errorOf(kSquare + "f -5 1 2\n"), "vertex -5 does not exist, there are 4 before");
  EXPECT_CONTAINS(errorOf(kSquare + "f 1 2 99999999999\n"), "vertex 99999999999 does not exist");
  EXPECT_CONTAINS(errorOf(kSquare + "f 1.5 2 3\n"), "`1.5` is not a corner");
  EXPECT_CONTAINS(errorOf(kSquare + "f 1/1/1/1 2 3\n"), "is not a corner");
  EXPECT_CONTAINS(errorOf(kSquare + "f /1 2 3\n"), "`/1` is not a corner");
  // A vertex may be defined after the face that uses it.
  EXPECT_EQ(load("f 1 2 3\n" + kSquare).faceCount(), 1u);
}

/// The geometry is whole without them. Those that come later in the file exist.
TEST_F(SceneObj, LeavesOutNormalsAndTextureCoordinatesThatDoNotExist) {
  for (const std::string face : {"f 1//2 2//1 3//1", "f 1//-1 2 3", "f 1//0 2 3"}) {
    const Scene scene = load(kSquare + face + "\n");
    EXPECT_EQ(scene.faceCount(), 1u);
    EXPECT_NOTE(scene.notes, "normals that do not exist are not used, in line: 5",
                Severity::warning);
  }
  for (const std::string face : {"f 1/1 2/2 3/9", "f 1/1 2/-3 3/2", "f 1/0 2/1 3/1"}) {
    const Scene scene = load(kSquare + face + "\nf 1/1 2/2 3/1\nvt 0 0\nvt 1 0\n");
    EXPECT_EQ(scene.faceCount(), 2u);
    EXPECT_NOTE(scene.notes, "texture coordinates that do not exist are not used, in line: 5",
                Severity::warning);
  }
}

TEST_F(SceneObj, ReadsLinesThatEndAsOnOldMacs) {
  std::string text = kSquare + "f 1 2 3\nf 1 3 4\n";
  std::replace(text.begin(), text.end(), '\n', '\r');
  EXPECT_EQ(load(text).faceCount(), 2u);
}

TEST_F(SceneObj, EmptyIndicesAfterSlashesCountAsMissing) {
  const Scene scene =
      load(kSquare + "vt 0 0\nvn 0 0 1\nf 1/ 2/ 3/\nf 1// 2// 3//\nf 1/1/ 3/1/ 4//1\n");
  EXPECT_EQ(scene.faceCount(), 3u);
}

TEST_F(SceneObj, NamesMissingTexturesInOneNote) {
  std::string mtl;
  std::string faces;
  for (int k = 0; k < 15; ++k) {
    mtl += fmt::format("newmtl m{0}\nKd .5 .5 .5\nmap_Kd t{0}.png\n", k);
    faces += fmt::format("usemtl m{}\n{}", k, kFace);
  }
  write("m.mtl", mtl);
  const Scene scene = load("mtllib m.mtl\n" + kSquare + faces);
  EXPECT_NOTE(scene.notes,
              fmt::format("textures that are not there; the factor alone counts, material: "
                          "m0 ({0}), m1 ({1}), m2 ({2}), m3 ({3}) and 11 more",
                          path("t0.png"), path("t1.png"), path("t2.png"), path("t3.png")),
              Severity::warning);
  EXPECT_EQ(allNotes(scene.notes).find("m4"), std::string::npos);
}

TEST_F(SceneObj, SaysHowToUnpackAFile) {
  EXPECT_CONTAINS(inputErrorOf([&] { loadScene(write("wing.obj.gz", "\x1f\x8b")); }),
                  "wing.obj.gz: is packed by gzip; unpack it first: gunzip --keep");
}

TEST_F(SceneObj, RefusesFacesOfTooFewCorners) {
  EXPECT_CONTAINS(errorOf(kSquare + "f 1 2\n"), "scene.obj: no faces");
}

TEST_F(SceneObj, RefusesFilesThatAreNoScene) {
  EXPECT_CONTAINS(inputErrorOf([&] { loadScene(path("absent.obj")); }), "no such file");
  EXPECT_CONTAINS(inputErrorOf([&] { loadScene(path("absent.xyz")); }), "no such file");
  EXPECT_CONTAINS(inputErrorOf([&] { loadScene(path("")); }), "is a folder");
  std::filesystem::create_directories(path("folder.obj"));
  EXPECT_CONTAINS(inputErrorOf([&] { loadScene(path("folder.obj")); }), "is a folder");
  const std::string blend = write("scene.blend", "BLENDER");
  EXPECT_CONTAINS(inputErrorOf([&] { loadScene(blend); }),
                  "export it as one of .obj, .gltf, .glb, .rad, .stl");
  EXPECT_CONTAINS(errorOf(""), "is empty");
  EXPECT_CONTAINS(errorOf("# nothing\n"), "no faces");
  EXPECT_CONTAINS(errorOf(kSquare + "l 1 2\n"), "no faces");
  EXPECT_CONTAINS(errorOf(std::string("\x7f"
                                      "ELF\0\1\2",
                                      7)),
                  "not a text file");
}

TEST_F(SceneObj, ReportsStatementsItLeavesOut) {
  const Scene scene =
      load(kSquare + "o wire\ns off\nl 1 2\np 1\no net\ncurv 0 1 1 2\nF 1 2 3\n" + kFace);
  EXPECT_NOTE(scene.notes, "lines and points have no area and are left out, in: wire",
              Severity::info);
  EXPECT_NOTE(scene.notes, "free-form", Severity::warning);
  EXPECT_NOTE(scene.notes, "`F` in line 11", Severity::warning);
}

TEST_F(SceneObj, TurnsRadianceIntoExitance) {
  write("m.mtl", "newmtl lamp\nKd .78 .5 .25\nKe 17 12 4\nnewmtl grey\nKd .4\n");
  const Scene scene =
      load("mtllib m.mtl\n" + kSquare + "usemtl lamp\n" + kFace + "usemtl grey\n" + kFace);
  const Material& lamp = scene.materialOf(0);
  EXPECT_EQ(lamp.reflectance, Vec3(.78, .5, .25));
  const Vec3 radiance(17, 12, 4);
  for (int band = 0; band < 3; ++band) {
    // One product: equal to the last bit.
    EXPECT_DOUBLE_EQ(lamp.emission[band], std::numbers::pi * radiance[band]);
  }
  EXPECT_EQ(scene.materialOf(1).reflectance, Vec3(.4)) << "one number stands for all bands";
  EXPECT_FALSE(lamp.two_sided);
}

TEST_F(SceneObj, UnusedValuesNeedNotBeNumbers) {
  const Scene scene = load(kSquare + "o wall\nvn nan -nan(ind) 0\nvt nan 0\nf 1/1/1 2/1/1 3/1/1\n");
  EXPECT_EQ(scene.faceCount(), 1U);
  EXPECT_TRUE(scene.texcoords.empty());
  EXPECT_NOTE(scene.notes, "a normal that is no finite number is not used, in: wall",
              Severity::warning);
  EXPECT_NOTE(scene.notes, "a texture coordinate that is no finite number is not used, in: wall",
              Severity::warning);
}

TEST_F(SceneObj, UnusedVertexColoursAreReported) {
  const Scene scene = load("v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 1 0 0\nf 1 2 3\n");
  EXPECT_NOTE(scene.notes, "colours of vertices are not used", Severity::info);
}

TEST_F(SceneObj, FacesOfTwoCornersAreLeftOut) {
  const Scene scene = load(kSquare + "o edge\nf 1 2\no wall\n" + kFace + "f\n");
  EXPECT_EQ(scene.faceCount(), 1U);
  EXPECT_NOTE(scene.notes, "fewer than 3 corners have no area and are left out, in: edge, wall",
              Severity::warning);
}

TEST_F(SceneObj, MaterialsWithoutANameAreOneMaterial) {
  write("m.mtl", "newmtl\nKd .1 .2 .3\nnewmtl wall\nKd .7 .7 .7\n");
  const Scene scene = load("mtllib\nmtllib m.mtl\n" + kSquare + "o a\nusemtl wall\n" + kFace +
                           "o b\nusemtl\n" + kFace);
  EXPECT_EQ(scene.materialOf(1).reflectance, Vec3(.1, .2, .3));
  EXPECT_NOTE(scene.notes, "newmtl names no material, it is called unnamed, line: 1",
              Severity::warning);
  EXPECT_NOTE(scene.notes, "usemtl names no material, unnamed is taken, line", Severity::warning);
  EXPECT_NOTE(scene.notes, "mtllib names no file and is not used, line: 1", Severity::warning);
}

TEST_F(SceneObj, StatementsOfMaterialsThatAreNotUsedMayBeNonsense) {
  write("m.mtl", "Kd 1 1 1\nnewmtl red\nNs -nan(ind)\nKd 1 0 1\n");
  const Scene scene = load("mtllib m.mtl\n" + kSquare + "usemtl red\n" + kFace);
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(1, 0, 1));
  EXPECT_NOTE(scene.notes, "before the first newmtl are not used: `Kd` in line 1",
              Severity::warning);
  EXPECT_NOTE(scene.notes, "no numbers: `-nan(ind)` in line 3", Severity::info);
}

TEST_F(SceneObj, QuotesNothingOfAFileThatIsNoMtl) {
  // As of a foreign file that an OBJ names: none of its words may show.
  write("secret.txt", "root:x:0:0:root\nKd secret secret secret\nmap_Kd secret\nnewmtlsecret 1\n");
  const Scene scene = load("mtllib secret.txt\n" + kSquare + "usemtl red\n" + kFace);
  EXPECT_NOTE(scene.notes, "secret.txt: defines no material (newmtl), so it is no MTL file",
              Severity::warning);
  for (const Note& note : scene.notes) {
    EXPECT_EQ(note.text.find("root"), std::string::npos) << note.text;
    EXPECT_EQ(note.text.find("Kd"), std::string::npos) << note.text;
  }
}

TEST_F(SceneObj, RefusesMaterialsThatAreImpossible) {
  const auto errorWith = [&](const std::string& line) {
    write("m.mtl", "# paint\nnewmtl red\n" + line + "\n");
    return errorOf("mtllib m.mtl\n" + kSquare + "usemtl red\n" + kFace);
  };
  EXPECT_CONTAINS(errorWith("Kd 1.2 0 0"), "m.mtl:3: material red: reflectance 1.2 0 0");
  EXPECT_CONTAINS(errorWith("Kd -.1 0 0"), "outside 0 to 1");
  EXPECT_CONTAINS(errorWith("Kd nan 0 0"), "m.mtl:3: material red: reflectance nan 0 0 is outside");
  EXPECT_CONTAINS(errorWith("Kd red"), "m.mtl:3: material red: `red`");
  EXPECT_CONTAINS(errorWith("Kd 0,5 0,5 0,5"), "`0,5`");
  EXPECT_CONTAINS(errorWith("Kd .1 .2"), "give red, green and blue");
  EXPECT_CONTAINS(errorWith("Kd"), "give red, green and blue");
  EXPECT_CONTAINS(errorWith("Ke -1 0 0"), "material red: emission -1 0 0");
  EXPECT_CONTAINS(errorWith("Ke inf 0 0"), "m.mtl:3: material red: emission nan 0 0");
  // The ends of the range are legal.
  write("m.mtl", "newmtl red\nKd 1 0 1\n");
  EXPECT_EQ(load("mtllib m.mtl\n" + kSquare + "usemtl red\n" + kFace).materialOf(0).reflectance,
            Vec3(1, 0, 1));
}

TEST_F(SceneObj, GoesOnWithoutMaterials) {
  const Scene scene = load("mtllib lost.mtl\n" + kSquare + "o a\n" + kFace + "o b\nusemtl lamp\n" +
                           kFace + "o c\nusemtl wall\n" + kFace);
  EXPECT_NOTE(scene.notes, "scene.obj:1: material file", Severity::warning);
  EXPECT_NOTE(scene.notes, "the missing file would define: lamp, wall", Severity::warning);
  EXPECT_NOTE(scene.notes, "no material, reflectance 0.5: a", Severity::warning);
  EXPECT_EQ(scene.surfaces[0].name, "a");
  EXPECT_EQ(scene.surfaces[1].name, "b/lamp");
  EXPECT_EQ(scene.materialOf(1).reflectance, Vec3(.5));
  EXPECT_EQ(scene.materialOf(1).emission, Vec3(0));
  SceneOptions options;
  options.default_reflectance = .25;
  EXPECT_EQ(load(kSquare + kFace, options).materialOf(0).reflectance, Vec3(.25));
}

TEST_F(SceneObj, ReportsInheritedMaterials) {
  write("m.mtl", "newmtl lamp\nKd .5 .5 .5\nKe 1 1 1\nnewmtl wall\nKd .5 .5 .5\n");
  const Scene scene =
      load("mtllib m.mtl\n" + kSquare + "o panel\nusemtl lamp\n" + kFace + "o cube\n" + kFace +
           "o room\nusemtl wall\n" + kFace + "o door\n" + kFace);
  EXPECT_EQ(scene.surfaces[1].name, "cube/lamp");
  EXPECT_NOTE(scene.notes,
              "no usemtl of their own, so they go on with material lamp of the object before, "
              "which EMITS LIGHT: cube",
              Severity::loud);
  EXPECT_NOTE(scene.notes,
              "no usemtl of their own, so they go on with material wall of the object before: door",
              Severity::warning);
  EXPECT_EQ(findNote(scene.notes, "room"), nullptr);
  // A material chosen just before the object was meant for it.
  const Scene meant = load("mtllib m.mtl\n" + kSquare + "usemtl lamp\no panel\n" + kFace);
  EXPECT_EQ(findNote(meant.notes, "no usemtl of their own"), nullptr) << allNotes(meant.notes);
}

TEST_F(SceneObj, NamesMaterialPropertiesThatAreNotDiffuse) {
  write("m.mtl",
        "newmtl glass\nKd .1 .1 .1\nKs .5 .5 .5\nd 0.2\nNi 1.5\nillum 7\nmap_Bump b.png\n"
        "newmtl steel\nKd .5 .5 .5\nPm 1\nKs 0 0 0\nd 1\nmap_Ke e.png\nblurb 3\n"
        "newmtl bare\nKe 1 1 1\nnewmtl bare\nKd .1 .1 .1\n");
  const Scene scene = load("mtllib m.mtl\n" + kSquare + "usemtl glass\n" + kFace +
                           "usemtl steel\n" + kFace + "usemtl bare\n" + kFace);
  EXPECT_NOTE(scene.notes, "(Ks) is not used, material: glass", Severity::info);
  EXPECT_NOTE(scene.notes, "leaves it out), material: glass", Severity::warning);
  EXPECT_NOTE(scene.notes, "texture map_Bump is not used, material: glass", Severity::info);
  EXPECT_NOTE(scene.notes, "metalness (Pm) is not used, material: steel", Severity::info);
  EXPECT_NOTE(
      scene.notes,
      fmt::format(
          "it EMITS NOTHING (set='NAME.radiance' gives it one all over), material: steel ({})",
          path("e.png")),
      Severity::loud);
  EXPECT_NOTE(scene.notes, "unknown MTL statement `blurb`", Severity::warning);
  EXPECT_NOTE(scene.notes, "material bare gives no Kd: reflectance 0.5", Severity::info);
  EXPECT_NOTE(scene.notes, "m.mtl:17: material bare is defined twice", Severity::warning);
  EXPECT_EQ(scene.materialOf(2).reflectance, Vec3(.5)) << "the first definition counts";
}

TEST_F(SceneObj, FindsMaterialFilesWithBlanksAndSeveralOnALine) {
  write("my paint.mtl", "newmtl red\nKd .6 .1 .1\n");
  write("a.mtl", "newmtl red\nKd .6 .1 .1\n");
  write("sub/b.mtl", "newmtl blue\nKd .1 .1 .6\n");
  const Scene blank = load("mtllib my paint.mtl\n" + kSquare + "usemtl red\n" + kFace);
  EXPECT_EQ(blank.materialOf(0).reflectance, Vec3(.6, .1, .1));
  const Scene two =
      load("mtllib a.mtl sub/b.mtl\n" + kSquare + "usemtl red\n" + kFace + "usemtl blue\n" + kFace);
  EXPECT_EQ(two.materialOf(0).reflectance, Vec3(.6, .1, .1));
  EXPECT_EQ(two.materialOf(1).reflectance, Vec3(.1, .1, .6));
}

TEST_F(SceneObj, ConvertsUnitsAndCameras) {
  SceneOptions options;
  options.unit = "mm";
  const std::string text =
      "# camera eye=278,273,-800 target=278,273,0 up=0,1,0 fov=60\n# camera eye=1,2 target=0,0,0\n"
      "# camera rig by someone\nv 0 0 0\nv 559.2 0 0\nv 0 1000 0\nf 1 2 3\n";
  const Scene scene = load(text, options);
  EXPECT_EQ(scene.unit, "mm");
  EXPECT_EQ(scene.vertices[1], Vec3(559.2 * 0.001, 0, 0));
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.cameras[0].eye, 0.001 * Vec3(278, 273, -800));
  EXPECT_EQ(scene.cameras[0].target, 0.001 * Vec3(278, 273, 0));
  EXPECT_DOUBLE_EQ(scene.cameras[0].vertical_fov, std::numbers::pi / 3);
  EXPECT_NOTE(scene.notes, "scene.obj:2: not used, camera: eye=\"1,2\" has 2 numbers",
              Severity::warning);
  EXPECT_EQ(findNote(scene.notes, "scene.obj:3"), nullptr) << "prose is no camera";
  // An inch is 25.4 mm and a foot 304.8 mm by definition.
  options.unit = "in";
  EXPECT_DOUBLE_EQ(load(text, options).vertices[2].y, 25.4);
  options.unit = "ft";
  EXPECT_DOUBLE_EQ(load(text, options).vertices[2].y, 304.8);
  EXPECT_EQ(load(text).vertices[2].y, 1000);
}

TEST_F(SceneObj, ReadsReflectanceInSrgbWhereAsked) {
  write("m.mtl", "newmtl grey\nKd 0.5 0 1\nKe 0.5 0.5 0.5\n");
  SceneOptions options;
  options.kd_is_srgb = true;
  const Scene scene = load("mtllib m.mtl\n" + kSquare + "usemtl grey\n" + kFace, options);
  // IEC 61966-2-1: an encoded 0.5 is 0.2140411 linear.
  EXPECT_NEAR(scene.materialOf(0).reflectance.x, 0.214041140482232, 1e-14);
  EXPECT_EQ(scene.materialOf(0).reflectance.y, 0);
  EXPECT_EQ(scene.materialOf(0).reflectance.z, 1);
  EXPECT_DOUBLE_EQ(scene.materialOf(0).emission.x, std::numbers::pi / 2) << "emission never is";
}

TEST_F(SceneObj, ReadsAllScenesOfTheProgram) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(RADIOSITY_SOURCE_DIR "/data")) {
    if (entry.path().extension() != ".obj") continue;
    ++count;
    const Scene scene = loadScene(entry.path().string());
    EXPECT_GT(scene.faceCount(), 0u) << entry.path();
    EXPECT_TRUE(std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) {
      return m.emission != Vec3(0.0);
    })) << entry.path();
    for (const Note& note : scene.notes) {
      EXPECT_EQ(int(note.severity), int(Severity::info)) << entry.path() << ": " << note.text;
    }
  }
  EXPECT_GE(count, 10u);
}

}  // namespace
}  // namespace radiosity::test
