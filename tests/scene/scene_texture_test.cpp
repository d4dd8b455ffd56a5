// Textures: files beside an OBJ, bytes inside a glTF, from sRGB to linear.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "radiosity/scene.h"
#include "support/scene_files.h"

namespace radiosity::test {
namespace {

void bigEndian(std::string& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += char(value >> shift & 255);
}

/// CRC-32 as PNG wants it (ISO 3309), bit by bit.
std::uint32_t crc32(const std::string& bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (const char byte : bytes) {
    crc ^= std::uint8_t(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

std::string chunk(const std::string& type, const std::string& data) {
  std::string out;
  bigEndian(out, std::uint32_t(data.size()));
  out += type + data;
  bigEndian(out, crc32(type + data));
  return out;
}

/// A PNG with its rows stored, not compressed. `colour`: 0 grey, 2 RGB, 6 RGBA; `bits`: 8 or 16.
/// `rows`: the samples of each row as the format wants them.
std::string png(int width, const std::vector<std::string>& rows, int colour, int bits) {
  std::string data;
  for (const std::string& row : rows) data += '\0' + row;
  std::uint32_t a = 1;  // Adler-32 (RFC 1950)
  std::uint32_t b = 0;
  for (const char byte : data) {
    a = (a + std::uint8_t(byte)) % 65521;
    b = (b + a) % 65521;
  }
  std::string zlib = "\x78\x01\x01";
  for (const std::uint16_t size : {std::uint16_t(data.size()), std::uint16_t(~data.size())}) {
    zlib += char(size & 255);
    zlib += char(size >> 8);
  }
  zlib += data;
  bigEndian(zlib, b << 16 | a);
  std::string header;
  bigEndian(header, std::uint32_t(width));
  bigEndian(header, std::uint32_t(rows.size()));
  header += {char(bits), char(colour), 0, 0, 0};
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("IDAT", zlib) + chunk("IEND", "");
}

/// sRGB decoding by its definition (IEC 61966-2-1).
double linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// Texels are stored in single precision: half an ulp of 1 and the roundings on the way.
constexpr double kTexel = 2e-7;

const std::string kTexturedSquare =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
const std::string kTexturedFace = "f 1/1 2/2 3/3 4/4\n";

class SceneTexture : public SceneFiles {
 protected:
  Scene load(const std::string& mtl, const SceneOptions& options = {},
             const std::string& faces = kTexturedFace) {
    write("m.mtl", "newmtl paint\n" + mtl);
    return loadScene(
        write("scene.obj", "mtllib m.mtl\n" + kTexturedSquare + "o wall\nusemtl paint\n" + faces),
        options);
  }
};

TEST_F(SceneTexture, ReadsEightBitsTopRowFirst) {
  write("sub/two rows.png",
        png(2, {std::string("\xff\0\0\0\x80\0", 6), std::string("\x0a\x0a\x0a\xff\xff\xff", 6)}, 2,
            8));
  const Scene scene = load("Kd .5 .5 .5\nmap_Kd sub\\two rows.png\n");
  ASSERT_EQ(scene.textures.size(), 1u) << allNotes(scene.notes);
  const Texture& texture = scene.textures[0];
  EXPECT_EQ(texture.width, 2);
  EXPECT_EQ(texture.height, 2);
  EXPECT_TRUE(texture.repeat);
  const std::array<double, 12> expected = {1,
                                           0,
                                           0,
                                           0,
                                           linear(128 / 255.0),
                                           0,
                                           linear(10 / 255.0),
                                           linear(10 / 255.0),
                                           linear(10 / 255.0),
                                           1,
                                           1,
                                           1};
  ASSERT_EQ(texture.texels.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_NEAR(texture.texels[k], expected[k], kTexel) << "texel value " << k;
  }
  EXPECT_EQ(scene.materialOf(0).texture, 0u);
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(.5)) << "Kd multiplies the texture";
  EXPECT_NOTE(scene.notes, "1 texture read; a patch gets the mean over its area", Severity::info);
  // The bottom left corner of an OBJ's texture is the top left one plus a height.
  ASSERT_EQ(scene.texcoords.size(), 4u);
  EXPECT_EQ(scene.texcoords[0], Vec2(0, 1));
  EXPECT_EQ(scene.texcoords[2], Vec2(1, 0));
}

TEST_F(SceneTexture, ReadsSixteenBitsAndGrey) {
  write("deep.png", png(1, {std::string("\x80\x00\x12\x34\xff\xff", 6)}, 2, 16));
  Scene scene = load("map_Kd deep.png\n");
  ASSERT_EQ(scene.textures.size(), 1u) << allNotes(scene.notes);
  EXPECT_NEAR(scene.textures[0].texels[0], linear(0x8000 / 65535.0), kTexel);
  EXPECT_NEAR(scene.textures[0].texels[1], linear(0x1234 / 65535.0), kTexel)
      << "eight bits would be off by 2e-4";
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(1)) << "no Kd: the texture alone";
  write("grey.png", png(1, {"\x40"}, 0, 8));
  scene = load("map_Kd grey.png\n");
  ASSERT_EQ(scene.textures.size(), 1u);
  for (int band = 0; band < 3; ++band) {
    EXPECT_NEAR(scene.textures[0].texels[std::size_t(band)], linear(64 / 255.0), kTexel);
  }
}

TEST_F(SceneTexture, AlphaDoesNotDarken) {
  write("glass.png", png(1, {"\xff\x80\x40\x20"}, 6, 8));
  const Scene scene = load("map_Kd -clamp on glass.png\n");
  ASSERT_EQ(scene.textures.size(), 1u) << allNotes(scene.notes);
  EXPECT_NEAR(scene.textures[0].texels[0], 1, kTexel);
  EXPECT_NEAR(scene.textures[0].texels[1], linear(128 / 255.0), kTexel);
  EXPECT_FALSE(scene.textures[0].repeat);
  EXPECT_NOTE(scene.notes, "alpha is not used, texture", Severity::info);
}

TEST_F(SceneTexture, TexturesCanBeTurnedOff) {
  write("grey.png", png(1, {"\x40"}, 0, 8));
  SceneOptions options;
  options.textures = false;
  const Scene scene = load("Kd .3 .3 .3\nmap_Kd grey.png\n", options);
  EXPECT_TRUE(scene.textures.empty());
  EXPECT_TRUE(scene.texcoords.empty());
  EXPECT_EQ(scene.materialOf(0).texture, kNone);
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(.3));
  EXPECT_NOTE(scene.notes, "textures are off; the factor alone counts, material: paint",
              Severity::info);
}

TEST_F(SceneTexture, GoesOnWithTheFactorWhereATextureCannotBeUsed) {
  Scene scene = load("Kd .3 .3 .3\nmap_Kd lost.png\n");
  EXPECT_NOTE(
      scene.notes,
      fmt::format("are not there; the factor alone counts, material: paint ({})", path("lost.png")),
      Severity::warning);
  EXPECT_EQ(scene.materialOf(0).texture, kNone);
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(.3));
  EXPECT_EQ(load("map_Kd lost.png\n").materialOf(0).reflectance, Vec3(.5)) << "not 0.6, not 1";
  write("text.png", "not an image");
  scene = load("map_Kd text.png\n");
  EXPECT_NOTE(scene.notes, "text.png cannot be decoded (of an unknown image format)",
              Severity::warning);
  write("grey.png", png(1, {"\x40"}, 0, 8));
  scene = load("map_Kd -s 2\n");
  EXPECT_NOTE(scene.notes, "map_Kd names no file", Severity::warning);
  scene = load("map_Kd -s 2 2 1 grey.png\n");
  EXPECT_NOTE(scene.notes, "map_Kd options -s and -o are not used, material: paint",
              Severity::warning);
  EXPECT_EQ(scene.textures.size(), 1u);
}

/// As exporters write it: options of one number (MTL specification: v and w may be left out),
/// blanks behind options, quotes, other letters, and paths of another machine.
TEST_F(SceneTexture, FindsImagesHoweverTheyAreNamed) {
  write("two rows.png", png(1, {"\x40"}, 0, 8));
  write("sub/Grey.PNG", png(1, {"\x40"}, 0, 8));
  for (const std::string map :
       {"map_Kd -o 0.1 two rows.png", "map_Kd -s 2 -o 0 0 two rows.png",
        "map_kd -blendu on -mm 0 1 -bm 0.5 -clamp off two rows.png", "map_Kd \"two rows.png\"",
        "map_Kd Two Rows.PNG", "map_Kd SUB/grey.png", "map_Kd sub\\grey.png",
        "map_Kd C:\\work\\two rows.png", "map_Kd /nowhere/of/mine/two rows.png"}) {
    const Scene scene = load(map + "\n");
    EXPECT_EQ(scene.textures.size(), 1u) << map << allNotes(scene.notes);
  }
  EXPECT_NOTE(
      load("map_Kd C:\\work\\two rows.png\n").notes,
      "not where the file says, taken from beside the scene: texture: C:\\work\\two rows.png",
      Severity::info);
  EXPECT_NOTE(load("map_Kd Two rows.png\n").notes,
              "differs in upper and lower case alone: texture: Two rows.png", Severity::info);
}

TEST_F(SceneTexture, NeedsTextureCoordinatesOnEveryFace) {
  write("grey.png", png(1, {"\x40"}, 0, 8));
  const Scene scene = load("Kd .3 .3 .3\nmap_Kd grey.png\n", {},
                           kTexturedFace + "o bare\nusemtl paint\nf 1/1 2/2 3\n");
  EXPECT_EQ(scene.materialOf(0).texture, 0u);
  EXPECT_EQ(scene.materialOf(1).texture, kNone);
  EXPECT_EQ(scene.materialOf(1).reflectance, Vec3(.3));
  EXPECT_EQ(scene.surfaces[1].name, "bare/paint");
  EXPECT_NOTE(scene.notes, "faces without texture coordinates; the factor alone counts: bare/paint",
              Severity::warning);
  EXPECT_EQ(scene.texcoords.size(), scene.corners.size());
}

TEST_F(SceneTexture, AnOverriddenReflectanceReplacesTheTexture) {
  write("grey.png", png(1, {"\x40"}, 0, 8));
  SceneOptions options;
  options.set = {"paint.reflectance=.7"};
  const Scene scene = load("map_Kd grey.png\n", options);
  EXPECT_EQ(scene.materialOf(0).texture, kNone);
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(.7));
  EXPECT_NOTE(scene.notes,
              "paint: reflectance 1 x texture -> 0.7; its texture " + path("grey.png") +
                  " is dropped (tint keeps it)",
              Severity::info);
}

TEST_F(SceneTexture, ATintKeepsTheTexture) {
  write("grey.png", png(1, {"\x40"}, 0, 8));
  SceneOptions options;
  options.set = {"paint.tint=.5,1,.25"};
  const Scene scene = load("Kd .8 .8 .8\nmap_Kd grey.png\n", options);
  EXPECT_EQ(scene.materialOf(0).texture, 0u);
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(.4, .8, .2));
  EXPECT_NOTE(scene.notes, "paint: reflectance 0.8 x texture -> 0.4 0.8 0.2 x texture",
              Severity::info);
  options.set = {"paint.tint=2"};
  EXPECT_CONTAINS(inputErrorOf([&] { load("Kd .8 .8 .8\nmap_Kd grey.png\n", options); }),
                  "set='paint.tint=2': material paint: reflectance 1.6 is outside 0 to 1");
}

TEST_F(SceneTexture, AFactorOfZeroBesideATextureMeansTheTexture) {
  write("grey.png", png(1, {"\x40"}, 0, 8));
  Scene scene = load("Kd 0 0 0\nmap_Kd grey.png\n");
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(1));
  EXPECT_NOTE(scene.notes, "Kd is 0 beside map_Kd: the texture alone counts, material: paint",
              Severity::info);
  scene = load("Kd 0 0 .5\nmap_Kd grey.png\n");
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(0, 0, .5)) << "a colour";
  scene = load("Kd 0 0 0\nmap_Kd lost.png\n");
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(0.5));
  EXPECT_NOTE(scene.notes,
              "Kd is 0 beside a texture that is not used: reflectance 0.5, material: paint",
              Severity::warning);
  scene = load("Kd 1 1 1\nmap_Kd lost.png\n");
  EXPECT_EQ(scene.materialOf(0).reflectance, Vec3(0.5)) << "it would return all light";
  EXPECT_NOTE(scene.notes, "Kd is 1 beside a texture that is not used: reflectance 0.5",
              Severity::warning);
  SceneOptions off;
  off.textures = false;
  EXPECT_EQ(load("Kd 1 1 1\nmap_Kd lost.png\n", off).materialOf(0).reflectance, Vec3(1))
      << "the factor alone was asked for";
}

TEST_F(SceneTexture, AnEmissiveTextureMultipliesKe) {
  write("grey.png", png(1, {"\x40"}, 0, 8));
  Scene scene = load("Ke 2 1 0\nmap_Ke grey.png\n");
  EXPECT_EQ(scene.materialOf(0).emission_texture, 0u);
  EXPECT_EQ(scene.materialOf(0).texture, kNone);
  EXPECT_DOUBLE_EQ(scene.materialOf(0).emission.x, 2 * M_PI);
  for (const std::string ke : {"", "Ke 0 0 0\n"}) {
    scene = load(ke + "map_Ke grey.png\n");
    EXPECT_DOUBLE_EQ(scene.materialOf(0).emission.x, M_PI);
    EXPECT_NOTE(
        scene.notes,
        "Ke is 0 beside map_Ke: the texture alone counts (1 is 1 W/m^2/sr), material: paint",
        Severity::info);
  }
  // A lamp that has lost its texture would emit all over.
  for (const std::string ke : {"", "Ke 0 0 0\n", "Ke 3 2 1\n"}) {
    scene = load(ke + "map_Ke lost.png\n");
    EXPECT_EQ(scene.materialOf(0).emission, Vec3(0));
    EXPECT_NOTE(scene.notes,
                "emission textures that are not there; it EMITS NOTHING (set='NAME.radiance' gives "
                "it one all over), material: paint",
                Severity::loud);
  }
  write("text.png", "no image");
  scene = load("Ke 3 2 1\nmap_Ke text.png\n");
  EXPECT_EQ(scene.materialOf(0).emission, Vec3(0));
  EXPECT_NOTE(scene.notes, "it EMITS NOTHING", Severity::loud);
  SceneOptions options;
  options.set = {"paint.radiance=3"};
  scene = load("Ke 1 1 1\nmap_Ke grey.png\n", options);
  EXPECT_EQ(scene.materialOf(0).emission_texture, kNone);
  EXPECT_NOTE(scene.notes, "is dropped", Severity::info);
}

TEST_F(SceneTexture, AnEmissiveTextureNeedsCoordinatesToo) {
  write("grey.png", png(1, {"\x40"}, 0, 8));
  const Scene scene = load("Ke 1 1 1\nmap_Ke grey.png\n", {},
                           kTexturedFace + "o bare\nusemtl paint\nf 1/1 2/2 3\n");
  EXPECT_EQ(scene.materialOf(0).emission_texture, 0u);
  EXPECT_EQ(scene.materialOf(1).emission, Vec3(0));
  EXPECT_NOTE(scene.notes,
              "emission texture not used, faces without texture coordinates; they EMIT NOTHING: "
              "bare/paint",
              Severity::loud);
}

/// A textured triangle; `texture_info` is the material's baseColorTexture.
class SceneGltfTexture : public SceneFiles {
 protected:
  using Json = nlohmann::json;

  Json document(const Json& texture_info) {
    const std::array<float, 15> numbers = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1};
    std::string bytes(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
    const std::string image = png(1, {"\x80\xff\x40"}, 2, 8);
    write("data.bin", bytes + image);
    return {{"asset", {{"version", "2.0"}}},
            {"buffers", {{{"uri", "data.bin"}, {"byteLength", bytes.size() + image.size()}}}},
            {"bufferViews",
             {{{"buffer", 0}, {"byteLength", 36}},
              {{"buffer", 0}, {"byteOffset", 36}, {"byteLength", 24}},
              {{"buffer", 0}, {"byteOffset", 60}, {"byteLength", image.size()}}}},
            {"accessors",
             {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
              {{"bufferView", 1}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}}}},
            {"images", {{{"bufferView", 2}, {"mimeType", "image/png"}, {"name", "wood"}}}},
            {"samplers", {{{"wrapS", 33071}, {"wrapT", 33071}}}},
            {"textures", {{{"source", 0}}, {{"source", 0}, {"sampler", 0}}}},
            {"materials",
             {{{"name", "desk"}, {"pbrMetallicRoughness", {{"baseColorTexture", texture_info}}}}}},
            {"meshes",
             {{{"primitives",
                {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}, {"material", 0}}}}}}},
            {"nodes", {{{"mesh", 0}, {"name", "top"}}}},
            {"scenes", {{{"nodes", {0}}}}}};
  }
  Scene load(const Json& json, const SceneOptions& options = {}) {
    return loadScene(write("scene.gltf", json.dump()), options);
  }
};

TEST_F(SceneGltfTexture, ReadsEmbeddedImages) {
  const Scene scene = load(document({{"index", 1}}));
  ASSERT_EQ(scene.textures.size(), 1u) << allNotes(scene.notes);
  EXPECT_EQ(scene.textures[0].name, "wood");
  EXPECT_NEAR(scene.textures[0].texels[0], linear(128 / 255.0), kTexel);
  EXPECT_NEAR(scene.textures[0].texels[2], linear(64 / 255.0), kTexel);
  EXPECT_FALSE(scene.textures[0].repeat);
  ASSERT_EQ(scene.texcoords.size(), 3u);
  EXPECT_EQ(scene.texcoords[2], Vec2(0, 1)) << "glTF's origin is the top left, as ours";
  SceneOptions options;
  options.textures = false;
  EXPECT_TRUE(load(document({{"index", 1}}), options).textures.empty());
}

TEST_F(SceneGltfTexture, ReadsImageFilesAndReportsMissingOnes) {
  Json json = document({{"index", 0}});
  json["images"][0] = {{"uri", "my%20wood.png"}};
  EXPECT_NOTE(load(json).notes,
              "are not there; the factor alone counts, material: desk (my%20wood.png)",
              Severity::warning);
  EXPECT_EQ(load(json).materials[0].reflectance, Vec3(.5)) << "not 1, the factor's default";
  EXPECT_NOTE(load(json).notes,
              "base colour is 1 beside a texture that is not used: reflectance 0.5, material: desk",
              Severity::warning);
  write("my wood.png", png(1, {"\x80\xff\x40"}, 2, 8));
  const Scene scene = load(json);
  ASSERT_EQ(scene.textures.size(), 1u) << allNotes(scene.notes);
  EXPECT_NEAR(scene.textures[0].texels[1], 1, kTexel);
  EXPECT_TRUE(scene.textures[0].repeat);
}

TEST_F(SceneGltfTexture, RefusesAnImageBeyondItsBuffer) {
  Json json = document({{"index", 0}});
  json["bufferViews"][2]["byteLength"] = 99999999999ll;
  EXPECT_CONTAINS(inputErrorOf([&] { load(json); }), "material desk reaches beyond the end");
}

TEST_F(SceneGltfTexture, AppliesTheTextureTransform) {
  // A quarter turn, counter-clockwise as seen with v downwards: (u, v) becomes (v, -u); the scale
  // comes before it, the offset after it.
  const double quarter = 1.5707963267948966;
  const Scene scene =
      load(document({{"index", 0},
                     {"extensions",
                      {{"KHR_texture_transform",
                        {{"offset", {.25, .5}}, {"rotation", quarter}, {"scale", {2, 3}}}}}}}));
  ASSERT_EQ(scene.texcoords.size(), 3u);
  const std::array<Vec2, 3> expected = {Vec2(.25, .5), Vec2(.25, -1.5), Vec2(3.25, .5)};
  for (std::size_t k = 0; k < 3; ++k) {
    // cos of the rounded quarter turn is 6e-17.
    EXPECT_NEAR(scene.texcoords[k].x, expected[k].x, 1e-15);
    EXPECT_NEAR(scene.texcoords[k].y, expected[k].y, 1e-15);
  }
}

TEST_F(SceneGltfTexture, ReadsEmissiveTextures) {
  Json json = document({{"index", 0}});
  json["materials"][0]["emissiveTexture"] = {{"index", 0}};
  json["materials"][0]["emissiveFactor"] = {1, .5, 0};
  Scene scene = load(json);
  EXPECT_EQ(scene.textures.size(), 1u) << "one image, one texture";
  EXPECT_EQ(scene.materialOf(0).emission_texture, 0u);
  EXPECT_EQ(scene.materialOf(0).texture, 0u);
  EXPECT_DOUBLE_EQ(scene.materialOf(0).emission.y, .5 * M_PI);
  // Other coordinates than the base colour's.
  json["materials"][0]["emissiveTexture"] = {{"index", 0}, {"texCoord", 1}};
  scene = load(json);
  EXPECT_EQ(scene.materialOf(0).emission_texture, kNone);
  EXPECT_EQ(scene.materialOf(0).emission, Vec3(0));
  EXPECT_NOTE(scene.notes, "the emission texture has other coordinates than the base colour",
              Severity::loud);
  // Alone, it may have any.
  json["materials"][0].erase("pbrMetallicRoughness");
  json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = 1;
  scene = load(json);
  EXPECT_EQ(scene.materialOf(0).emission_texture, 0u);
  EXPECT_EQ(scene.texcoords.size(), 3u);
  // Of an image that is not there, or not read, nothing shines.
  for (const Json& image : {Json{{"uri", "lost.png"}}, Json{{"uri", "lost.ktx2"}}}) {
    Json lost = json;
    lost["images"] = {image};
    scene = load(lost);
    EXPECT_EQ(scene.materialOf(0).emission, Vec3(0));
    EXPECT_NOTE(scene.notes, "EMITS NOTHING", Severity::loud);
  }
  // A factor of 0, the default, emits nothing whatever the texture.
  json["materials"][0].erase("emissiveFactor");
  EXPECT_EQ(load(json).materialOf(0).emission_texture, kNone);
}

TEST_F(SceneGltfTexture, UsesTheFactorWithoutTheRightCoordinates) {
  const Scene scene = load(document({{"index", 0}, {"texCoord", 1}}));
  EXPECT_EQ(scene.materialOf(0).texture, kNone);
  EXPECT_NOTE(scene.notes, "faces without texture coordinates; the factor alone counts: top/desk",
              Severity::warning);
}

}  // namespace
}  // namespace radiosity::test
