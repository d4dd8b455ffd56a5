// Writes Mitsuba 3's XML.
#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <variant>

#include "base/printable.h"
#include "interchange/exported_parts.h"
#include "interchange/serialized_meshes.h"
#include "radiosity/version.h"

namespace radiosity {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

std::string rgb(const char* name, const Vec3& v) {
  return fmt::format("<rgb name=\"{}\" value=\"{}, {}, {}\"/>", name, v.x, v.y, v.z);
}

std::string triple(const Vec3& v) { return fmt::format("{}, {}, {}", v.x, v.y, v.z); }

Vec3 strengthOf(const Light& light) {
  return {light.strength[0], light.strength[1], light.strength[2]};
}

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
class MitsubaWriter {
 public:
  MitsubaWriter(const Scene& scene, const ForeignPicture& picture)
      : scene_(scene), picture_(picture), meshes_(surfaceTriangles(scene)) {}

  ForeignScene scene() {
    line("<scene version=\"3.0.0\">");
    line("  <!-- radiosity " RADIOSITY_VERSION
         ": metres, W/m^2/sr; for the rgb variants of Mitsuba 3 -->");
    camera();
    line("  <integrator type=\"path\"><integer name=\"max_depth\" value=\"-1\"/></integrator>");
    for (std::size_t m = 0; m < scene_.materials.size(); ++m) material(m);
    surfaces();
    for (const Light& one : scene_.lights) light(one);
    sky();
    line("</scene>");
    noteLosses(scene_, "Mitsuba", made_.notes);
    return std::move(made_);
  }

 private:
  void line(const std::string& text) { made_.text += text + "\n"; }
  void note(const std::string& text) { noteLoss("Mitsuba: " + text, made_.notes); }

  void camera() {
    const Camera& c = picture_.camera;
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
                    picture_.width, picture_.height));
    line(
        "    <sampler type=\"independent\"><integer name=\"sample_count\" "
        "value=\"256\"/></sampler>");
    line("  </sensor>");
  }

  std::string materialId(std::size_t m) const { return idOf(scene_.materials[m].name, m); }

  void material(std::size_t m) {
    const Material& material = scene_.materials[m];
    const std::string id = fmt::format(" id=\"{}\"", materialId(m));
    std::string reflectance = rgb("reflectance", material.reflectance);
    if (material.texture != kNone) {
      const std::string file = fmt::format("{}-{}.exr", picture_.stem, m + 1);
      made_.images.emplace_back(file, reflectanceImage(scene_, material));
      reflectance = fmt::format(
          "<texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" value=\"{}\"/>"
          "<boolean name=\"raw\" value=\"true\"/><string name=\"wrap_mode\" "
          "value=\"{}\"/></texture>",
          markupText(file), scene_.textures[material.texture].repeat ? "repeat" : "clamp");
    }
    const bool both = material.two_sided;
    line(fmt::format("  {}<bsdf type=\"diffuse\"{}>{}</bsdf>{}",
                     both ? fmt::format("<bsdf type=\"twosided\"{}>", id) : "", both ? "" : id,
                     reflectance, both ? "</bsdf>" : ""));
  }

  void surfaces() {
    const std::string file = picture_.stem + ".serialized";
    std::vector<std::string> names;
    for (std::size_t k = 0; k < meshes_.size(); ++k) {
      const Surface& surface = scene_.surfaces[meshes_[k].surface];
      const Material& material = scene_.materials[surface.material];
      names.push_back(printable(surface.name));
      line(fmt::format("  <shape type=\"serialized\" id=\"{}\">", idOf(surface.name, k)));
      line(
          fmt::format("    <string name=\"filename\" value=\"{}\"/>"
                      "<integer name=\"shape_index\" value=\"{}\"/>"
                      "<boolean name=\"face_normals\" value=\"true\"/>",
                      markupText(file), k));
      line(fmt::format("    <ref id=\"{}\"/>", materialId(surface.material)));
      const Vec3 radiance = meanRadiance(scene_, material);
      if (radiance != Vec3(0.0)) {
        line("    <emitter type=\"area\">" + rgb("radiance", radiance) + "</emitter>");
        if (material.two_sided) {
          note(fmt::format("'{}' emits from its front alone, here from both sides", surface.name));
        }
      }
      line("  </shape>");
    }
    made_.files.emplace_back(file, serializedMeshes(meshes_, names));
  }

  void light(const Light& light) {
    if (!light.shines() || light.isAllRound()) return;
    const std::string strength = rgb("intensity", strengthOf(light));
    double range = 0;
    if (const auto* point = std::get_if<PointLight>(&light.kind)) {
      range = point->range;
      line(fmt::format(
          "  <emitter type=\"point\"><point name=\"position\" value=\"{}\"/>{}</emitter>",
          triple(point->at), strength));
    } else if (const auto* spot = std::get_if<SpotLight>(&light.kind)) {
      range = spot->range;
      line(
          fmt::format("  <emitter type=\"spot\">{}{}<float name=\"cutoff_angle\" value=\"{}\"/>"
                      "<float name=\"beam_width\" value=\"{}\"/></emitter>",
                      lookAt(spot->at, spot->aim, uprightAcross(spot->aim - spot->at)), strength,
                      spot->outer, spot->inner));
      if (spot->inner < spot->outer) {
        note(
            fmt::format("'{}' falls off with its angle in a straight line, here by the square of "
                        "a ramp in the cosine",
                        light.name));
      }
    } else if (const auto* sun = std::get_if<Sun>(&light.kind)) {
      const Vec3 ahead = -glm::normalize(sun->toward);
      line(
          fmt::format("  <emitter type=\"directional\"><vector name=\"direction\" value=\"{}\"/>{}"
                      "</emitter>",
                      triple(ahead), rgb("irradiance", strengthOf(light))));
      if (sun->diameter > 0) {
        note(fmt::format("'{}' has sharp shadows, here a disc of {} degrees", light.name,
                         sun->diameter));
      }
    } else {
      note(fmt::format("'{}' is left out; there is no light of its kind", light.name));
    }
    if (range > 0) {
      note(fmt::format("'{}' shines without end, here {} m far", light.name, range));
    }
  }

  /// One light all round, as the format allows.
  void sky() {
    if (!unevenSkies(scene_.lights).empty()) {
      constexpr int kRows = 512;
      constexpr int kColumns = 2 * kRows;
      const std::string file = picture_.stem + "-sky.exr";
      // Columns begin at -z and go on to +x; rows go from +y to -y, with one on each pole.
      made_.images.emplace_back(file, skyImage(scene_.lights, kColumns, kRows, [](int c, int r) {
                                  const double turn = 2 * std::numbers::pi * (c + 0.5) / kColumns;
                                  const double down = std::numbers::pi * r / (kRows - 1);
                                  return Vec3(std::sin(turn) * std::sin(down), std::cos(down),
                                              -std::cos(turn) * std::sin(down));
                                }));
      line(fmt::format(
          "  <emitter type=\"envmap\"><string name=\"filename\" value=\"{}\"/></emitter>",
          markupText(file)));
      return;
    }
    const std::vector<double> radiance = background(scene_.lights, 3);
    if (!anyLight(radiance)) return;
    line("  <emitter type=\"constant\">" +
         rgb("radiance", {radiance[0], radiance[1], radiance[2]}) + "</emitter>");
  }

  const Scene& scene_;
  const ForeignPicture& picture_;
  std::vector<SurfaceTriangles> meshes_;
  ForeignScene made_;
};

}  // namespace

ForeignScene mitsubaScene(const Scene& scene, const ForeignPicture& picture) {
  validate(scene);
  return MitsubaWriter(scene, picture).scene();
}

}  // namespace radiosity
