// Writes Mitsuba 3's XML.
#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/geometry/plane_frame.h"
#include "base/printable.h"
#include "interchange/foreign_writer.h"
#include "interchange/serialized_meshes.h"
#include "radiosity/version.h"

namespace radiosity {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

std::string rgb(const char* name, const Vec3& v) {
  return fmt::format("<rgb name=\"{}\" value=\"{}, {}, {}\"/>", name, v.x, v.y, v.z);
}

std::string triple(const Vec3& v) { return fmt::format("{}, {}, {}", v.x, v.y, v.z); }

std::string lookAt(const Vec3& from, const Vec3& to, const Vec3& up) {
  return fmt::format(
      "<transform name=\"to_world\"><lookat origin=\"{}\" target=\"{}\" up=\"{}\"/></transform>",
      triple(from), triple(to), triple(up));
}

/// An id of XML: letters, digits and underscores of the name, and a number that makes it unique.
std::string idOf(const std::string& name, std::size_t number) {
  std::string id;
  for (const unsigned char c : name) id += c < 0x80 && std::isalnum(c) != 0 ? char(c) : '_';
  return fmt::format("{}_{}", id, number);
}

/// Writes a scene, part by part.
class MitsubaWriter final : ForeignWriter {
 public:
  MitsubaWriter(const Scene& scene, const ForeignPicture& picture)
      : ForeignWriter(scene, picture, "Mitsuba"), meshes_(surfaceTriangles(scene)) {}

  ForeignScene write() {
    line("<scene version=\"3.0.0\">");
    line("  <!-- radiosity " RADIOSITY_VERSION
         ": metres, W/m^2/sr; for the rgb variants of Mitsuba 3 -->");
    camera();
    line("  <integrator type=\"path\"><integer name=\"max_depth\" value=\"-1\"/></integrator>");
    for (std::size_t m = 0; m < scene().materials.size(); ++m) material(m);
    surfaces();
    addLights();
    line("</scene>");
    return finish();
  }

 private:
  void camera() {
    const Camera& c = picture().camera;
    line("  <sensor type=\"perspective\">");
    line(
        fmt::format("    <string name=\"fov_axis\" value=\"y\"/><float name=\"fov\" value=\"{}\"/>",
                    c.vertical_fov * kDegrees));
    line("    " + lookAt(c.eye, c.target, c.up));
    line(
        fmt::format("    <film type=\"hdrfilm\">"
                    "<integer name=\"width\" value=\"{}\"/><integer name=\"height\" value=\"{}\"/>"
                    "<string name=\"pixel_format\" value=\"rgba\"/>"
                    "<string name=\"component_format\" value=\"float32\"/>"
                    "<rfilter type=\"box\"/></film>",
                    picture().width, picture().height));
    line(
        "    <sampler type=\"independent\"><integer name=\"sample_count\" "
        "value=\"256\"/></sampler>");
    line("  </sensor>");
  }

  std::string materialId(std::size_t m) const { return idOf(scene().materials[m].name, m); }

  void material(std::size_t m) {
    const Material& material = scene().materials[m];
    const std::string id = fmt::format(" id=\"{}\"", materialId(m));
    std::string reflectance = rgb("reflectance", material.reflectance);
    if (material.texture != kNone) {
      const std::string file = addReflectance(m);
      reflectance = fmt::format(
          "<texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" value=\"{}\"/>"
          "<boolean name=\"raw\" value=\"true\"/><string name=\"wrap_mode\" "
          "value=\"{}\"/></texture>",
          markupText(file), scene().textures[material.texture].repeat ? "repeat" : "clamp");
    }
    const bool both = material.two_sided;
    line(fmt::format("  {}<bsdf type=\"diffuse\"{}>{}</bsdf>{}",
                     both ? fmt::format("<bsdf type=\"twosided\"{}>", id) : "", both ? "" : id,
                     reflectance, both ? "</bsdf>" : ""));
  }

  void surfaces() {
    const std::string file = picture().stem + ".serialized";
    std::vector<std::string> names;
    for (std::size_t k = 0; k < meshes_.size(); ++k) {
      const Surface& surface = scene().surfaces[meshes_[k].surface];
      const Material& material = scene().materials[surface.material];
      names.push_back(printable(surface.name));
      line(fmt::format("  <shape type=\"serialized\" id=\"{}\">", idOf(surface.name, k)));
      line(
          fmt::format("    <string name=\"filename\" value=\"{}\"/>"
                      "<integer name=\"shape_index\" value=\"{}\"/>"
                      "<boolean name=\"face_normals\" value=\"true\"/>",
                      markupText(file), k));
      line(fmt::format("    <ref id=\"{}\"/>", materialId(surface.material)));
      const Vec3 radiance = meanRadiance(scene(), material);
      if (radiance != Vec3(0.0)) {
        line("    <emitter type=\"area\">" + rgb("radiance", radiance) + "</emitter>");
        if (material.two_sided) {
          note(fmt::format("'{}' emits from its front alone, here from both sides", surface.name));
        }
      }
      line("  </shape>");
    }
    addFile(file, serializedMeshes(meshes_, names));
  }

  void addPoint(const PointLight& point, const Vec3& intensity) override {
    line(
        fmt::format("  <emitter type=\"point\"><point name=\"position\" value=\"{}\"/>{}</emitter>",
                    triple(point.at), rgb("intensity", intensity)));
  }

  void addSpot(const SpotLight& spot, const Vec3& intensity) override {
    line(
        fmt::format("  <emitter type=\"spot\">{}{}<float name=\"cutoff_angle\" value=\"{}\"/>"
                    "<float name=\"beam_width\" value=\"{}\"/></emitter>",
                    lookAt(spot.at, spot.aim, axisAcross(spot.aim - spot.at)),
                    rgb("intensity", intensity), spot.outer, spot.inner));
  }

  std::string fallOff() const override {
    return "with its angle in a straight line, here by the square of a ramp in the cosine";
  }

  void addSun(const Sun& sun, const Vec3& irradiance) override {
    const Vec3 ahead = -glm::normalize(sun.toward);
    line(
        fmt::format("  <emitter type=\"directional\"><vector name=\"direction\" value=\"{}\"/>{}"
                    "</emitter>",
                    triple(ahead), rgb("irradiance", irradiance)));
  }

  /// Columns begin at -z and go on to +x; rows go from +y to -y, with one on each pole.
  SkyPixels skyPixels() const override {
    constexpr int kRows = 512;
    constexpr int kColumns = 2 * kRows;
    return {kColumns, kRows, [](int column, int row) {
              const double turn = 2 * std::numbers::pi * (column + 0.5) / kColumns;
              const double down = std::numbers::pi * row / (kRows - 1);
              return Vec3(std::sin(turn) * std::sin(down), std::cos(down),
                          -std::cos(turn) * std::sin(down));
            }};
  }

  void addSkyImage(const std::string& file) override {
    line(
        fmt::format("  <emitter type=\"envmap\"><string name=\"filename\" value=\"{}\"/></emitter>",
                    markupText(file)));
  }

  void addUniformSky(const Vec3& radiance) override {
    line("  <emitter type=\"constant\">" + rgb("radiance", radiance) + "</emitter>");
  }

  std::vector<SurfaceTriangles> meshes_;
};

}  // namespace

ForeignScene mitsubaScene(const Scene& scene, const ForeignPicture& picture) {
  validate(scene);
  return MitsubaWriter(scene, picture).write();
}

}  // namespace radiosity
