// Writes scenes of pbrt-v4 (pbrt.org/fileformat-v4).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <numbers>

#include "base/printable.h"
#include "interchange/foreign_writer.h"
#include "radiosity/version.h"

namespace radiosity {
namespace {

std::string numbers(const Vec3& v) { return fmt::format("[{} {} {}]", v.x, v.y, v.z); }

/// The direction of a place in the square by which pbrt maps the sphere with equal areas:
/// P. Clarberg, "Fast equal-area mapping of the (hemi)sphere using SIMD", J. Graphics Tools 13
/// (2008). s and t are in [-1, 1]. The diamond |s| + |t| <= 1 is the half of +z; beyond it the
/// corners fold down to -z.
Vec3 directionOfSquare(double s, double t) {
  const double inside = 1 - (std::abs(s) + std::abs(t));
  const double r = 1 - std::abs(inside);  // 1 - |z| is its square
  const double phi = (r == 0 ? 1 : (std::abs(t) - std::abs(s)) / r + 1) * std::numbers::pi / 4;
  const double across = r * std::sqrt(2 - r * r);
  return {std::copysign(std::cos(phi), s) * across, std::copysign(std::sin(phi), t) * across,
          std::copysign(1 - r * r, inside)};
}

/// Of the shorter side of the picture, which pbrt's `fov` is, degrees.
double shorterAngle(const ForeignPicture& picture) {
  const double wide = double(picture.width) / double(picture.height);
  const double half = std::tan(picture.camera.vertical_fov / 2) * std::min(1.0, wide);
  return 2 * std::atan(half) * 180 / std::numbers::pi;
}

/// A name in a comment or a string.
std::string quiet(const std::string& name) {
  std::string text = printable(name);
  std::replace(text.begin(), text.end(), '"', '\'');
  std::replace(text.begin(), text.end(), '\\', '/');
  return text;
}

/// Writes a scene, part by part.
class PbrtWriter final : ForeignWriter {
 public:
  PbrtWriter(const Scene& scene, const ForeignPicture& picture)
      : ForeignWriter(scene, picture, "pbrt") {}

  ForeignScene write() {
    line("# radiosity " RADIOSITY_VERSION ": metres, W/m^2/sr; for pbrt-v4");
    camera();
    line("WorldBegin");
    addLights();
    for (std::size_t m = 0; m < scene().materials.size(); ++m) addMaterial(m);
    for (const SurfaceTriangles& mesh : surfaceTriangles(scene())) addSurface(mesh);
    noteOneSided();
    return finish();
  }

 private:
  void camera() {
    const Camera& c = picture().camera;
    // pbrt's axes are left-handed: without the mirror the picture would be one.
    line("Scale -1 1 1");
    line(fmt::format("LookAt {} {} {}  {} {} {}  {} {} {}", c.eye.x, c.eye.y, c.eye.z, c.target.x,
                     c.target.y, c.target.z, c.up.x, c.up.y, c.up.z));
    line(fmt::format("Camera \"perspective\" \"float fov\" [{}]", shorterAngle(picture())));
    line(
        fmt::format("Film \"rgb\" \"integer xresolution\" [{}] \"integer yresolution\" [{}] "
                    "\"string filename\" [\"{}.exr\"] \"bool savefp16\" [false]",
                    picture().width, picture().height, quiet(picture().stem)));
    line("PixelFilter \"box\"");
    line("Sampler \"independent\" \"integer pixelsamples\" [256]");
    line("Integrator \"path\" \"integer maxdepth\" [100]");
  }

  void addMaterial(std::size_t m) {
    const Material& material = scene().materials[m];
    const std::string name = nameOf(m);
    std::string reflectance = "\"rgb reflectance\" " + numbers(material.reflectance);
    if (material.texture != kNone) {
      const std::string file = addReflectance(m);
      line(fmt::format(
          "Texture \"{}\" \"spectrum\" \"imagemap\" \"string filename\" [\"{}\"] "
          "\"string encoding\" [\"linear\"] \"string wrap\" [\"{}\"]",
          name, quiet(file), scene().textures[material.texture].repeat ? "repeat" : "clamp"));
      reflectance = fmt::format("\"texture reflectance\" [\"{}\"]", name);
    }
    line(fmt::format("MakeNamedMaterial \"{}\" \"string type\" [\"diffuse\"] {}", name,
                     reflectance));
  }

  /// Unique: two materials may have one name in other objects.
  std::string nameOf(std::size_t m) const {
    return fmt::format("{} {}", quiet(scene().materials[m].name), m + 1);
  }

  void addSurface(const SurfaceTriangles& mesh) {
    const Surface& surface = scene().surfaces[mesh.surface];
    const Material& material = scene().materials[surface.material];
    line("AttributeBegin  # " + quiet(surface.name));
    line(fmt::format("NamedMaterial \"{}\"", nameOf(surface.material)));
    const Vec3 radiance = meanRadiance(scene(), material);
    if (radiance != Vec3(0.0)) {
      line(fmt::format("AreaLightSource \"diffuse\" \"rgb L\" {}{}", numbers(radiance),
                       material.two_sided ? " \"bool twosided\" [true]" : ""));
    }
    std::string text = "Shape \"trianglemesh\" \"point3 P\" [";
    const auto out = std::back_inserter(text);
    for (const Vec3& v : mesh.vertices) fmt::format_to(out, " {} {} {}", v.x, v.y, v.z);
    if (!mesh.texcoords.empty()) {
      text += " ] \"point2 uv\" [";
      for (const Vec2& t : mesh.texcoords) fmt::format_to(out, " {} {}", t.x, 1 - t.y);
    }
    text += " ] \"integer indices\" [";
    for (const std::array<Index, 3>& t : mesh.triangles) {
      fmt::format_to(out, " {} {} {}", t[0], t[1], t[2]);
    }
    line(text + " ]");
    line("AttributeEnd");
  }

  void addPoint(const PointLight& point, const Vec3& intensity) override {
    line(fmt::format("LightSource \"point\" \"rgb I\" {} \"point3 from\" {}", numbers(intensity),
                     numbers(point.at)));
  }

  void addSpot(const SpotLight& spot, const Vec3& intensity) override {
    line(
        fmt::format("LightSource \"spot\" \"rgb I\" {} \"point3 from\" {} \"point3 to\" {} "
                    "\"float coneangle\" [{}] \"float conedeltaangle\" [{}]",
                    numbers(intensity), numbers(spot.at), numbers(spot.aim), spot.outer,
                    spot.outer - spot.inner));
  }

  std::string fallOff() const override {
    return "by a smooth step in the cosine, here by the square of a ramp in it";
  }

  void addSun(const Sun& sun, const Vec3& irradiance) override {
    line(
        fmt::format("LightSource \"distant\" \"rgb L\" {} \"point3 from\" {} \"point3 to\" [0 0 0]",
                    numbers(irradiance), numbers(glm::normalize(sun.toward))));
  }

  SkyPixels skyPixels() const override {
    constexpr int kSide = 1024;
    return {kSide, kSide, [](int column, int row) {
              return directionOfSquare((2 * column + 1.0) / kSide - 1, (2 * row + 1.0) / kSide - 1);
            }};
  }

  void addSkyImage(const std::string& file) override {
    line(fmt::format("LightSource \"infinite\" \"string filename\" [\"{}\"]", quiet(file)));
  }

  void addUniformSky(const Vec3& radiance) override {
    line("LightSource \"infinite\" \"rgb L\" " + numbers(radiance));
  }

  void noteOneSided() {
    const bool all = std::ranges::all_of(scene().materials, &Material::two_sided);
    if (!all) note("backs reflect as fronts do; those of one-sided surfaces are black here");
  }
};

}  // namespace

ForeignScene pbrtScene(const Scene& scene, const ForeignPicture& picture) {
  validate(scene);
  return PbrtWriter(scene, picture).write();
}

}  // namespace radiosity
