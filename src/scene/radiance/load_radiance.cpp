// Reads Radiance scenes: polygons, curved surfaces, sources.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/input_file.h"
#include "radiosity/spelling.h"
#include "scene/radiance/facets.h"
#include "scene/radiance/primitives.h"
#include "scene/radiance/radiance_materials.h"
#include "scene/radiance/radiance_sources.h"
#include "scene/readers.h"
#include "scene/scene_builder.h"

namespace radiosity {

namespace {

/// The object that a surface belongs to: generators write the sides of one as desk.1540, desk.2310.
std::string objectOf(const std::string& name) {
  const std::size_t dot = name.find_last_not_of("0123456789");
  const bool numbered =
      dot != std::string::npos && dot > 0 && dot + 1 < name.size() && name[dot] == '.';
  return numbered ? name.substr(0, dot) : name;
}

class RadianceScene {
 public:
  RadianceScene(const std::string& path, std::string_view content, const SceneOptions& options)
      : reader_(path, content),
        options_(options),
        builder_(scene_, options),
        materials_(reader_, options, scene_, notes_),
        sources_(reader_, notes_) {
    scene_.file = path;
  }

  Scene read() {
    RadiancePrimitive surface;
    while (reader_.nextSurface(surface)) add(surface);
    if (scene_.faceCount() == 0) {
      throw InputError(
          scene_.file +
          ": has no polygons, spheres, cones, cylinders or rings; it is no scene of Radiance, or "
          "another file has its surfaces");
    }
    sources_.appendTo(scene_.lights);
    noteCurved();
    notes_.appendTo(scene_.notes);
    builder_.finish();
    return std::move(scene_);
  }

 private:
  void add(const RadiancePrimitive& surface) {
    if (surface.is("source")) return sources_.add(surface);
    requireRead(surface);
    const Index material = materials_.of(surface);
    if (material == kNone) return;
    const Index into = builder_.surface(objectOf(surface.name), material);
    if (surface.is("polygon")) return addPolygon(surface, into);
    addCurved(surface, into);
  }

  void requireRead(const RadiancePrimitive& surface) const {
    const std::string file = surface.strings.empty() ? "?" : surface.strings.front();
    if (surface.is("mesh")) {
      reader_.fail(surface, fmt::format("{} is compiled and not read; give the .obj that it was "
                                        "made of, or write its triangles here",
                                        file));
    }
    if (surface.is("instance")) {
      reader_.fail(surface, fmt::format("{} is compiled and not read; write the scene that it was "
                                        "made of in its place, moved by xform",
                                        file));
    }
  }

  void addPolygon(const RadiancePrimitive& surface, Index into) {
    std::vector<Index> corners;
    for (std::size_t k = 0; k < surface.numbers.size(); k += 3) {
      corners.push_back(Index(scene_.vertices.size()));
      scene_.vertices.push_back(surface.three(k));
    }
    builder_.addFace(corners, {}, into, surface.line);
  }

  double radius(const RadiancePrimitive& surface, std::size_t at, bool may_be_0) const {
    const double value = surface.numbers[at];
    if (value > 0 || (may_be_0 && value == 0)) return value;
    reader_.fail(surface,
                 fmt::format("a radius of {} is not above 0; correct it (surfaces that face "
                             "inward are bubble, tube and cup)",
                             value));
  }

  Facets facetsOf(const RadiancePrimitive& surface) const {
    const Vec3 first = surface.three(0);
    const double tolerance = options_.curve_deviation;
    if (surface.is("sphere") || surface.is("bubble")) {
      return sphereFacets(first, radius(surface, 3, false), tolerance);
    }
    const Vec3 second = surface.three(3);
    if (surface.is("ring")) {
      if (!(glm::length(second) > 0)) reader_.fail(surface, "has no direction; give one");
      const auto [inner, outer] = std::minmax({radius(surface, 6, true), radius(surface, 7, true)});
      if (inner == outer) reader_.fail(surface, "its radii are equal; it has no area, delete it");
      return ringFacets(first, glm::normalize(second), inner, outer, tolerance);
    }
    if (!(glm::length(second - first) > 0)) {
      reader_.fail(surface, "both ends are at one place; correct them, or write a ring");
    }
    const bool cylinder = surface.is("cylinder") || surface.is("tube");
    const double from = radius(surface, 6, !cylinder);
    const double to = cylinder ? from : radius(surface, 7, true);
    if (from == 0 && to == 0) reader_.fail(surface, "both radii are 0; it has no area, delete it");
    return coneFacets(first, from, second, to, tolerance);
  }

  void addCurved(const RadiancePrimitive& surface, Index into) {
    Facets facets = facetsOf(surface);
    if (surface.is("bubble") || surface.is("tube") || surface.is("cup")) facets.turnOver();
    const auto base = Index(scene_.vertices.size());
    scene_.vertices.insert(scene_.vertices.end(), facets.vertices.begin(), facets.vertices.end());
    for (std::vector<Index>& face : facets.faces) {
      for (Index& corner : face) corner += base;
      builder_.addFace(face, {}, into, surface.line);
    }
    ++curved_;
    facets_ += facets.faces.size();
    off_ = std::max(off_, facets.off);
    area_ = std::max(area_, facets.area);
  }

  void noteCurved() {
    if (curved_ == 0) return;
    std::string areas = "they keep their area";
    if (area_ > 1) {
      areas = fmt::format(
          "spheres and rings keep their area, cylinders and cones have up to "
          "{:.2g}% more",
          100 * (area_ - 1));
    }
    scene_.notes.push_back(
        {Severity::info,
         fmt::format("{} curved surface{} became {} flat facets, up to {:.2g}% of a radius off ({} "
                     "changes that); {}",
                     curved_, curved_ == 1 ? "" : "s", facets_, 100 * off_,
                     spelled("curve_deviation"), areas)});
  }

  RadianceReader reader_;
  const SceneOptions& options_;
  Scene scene_;
  SceneBuilder builder_;
  FeatureNotes notes_;
  RadianceMaterials materials_;
  RadianceSources sources_;
  std::size_t curved_ = 0;
  std::size_t facets_ = 0;
  double off_ = 0;   ///< the largest of Facets::off
  double area_ = 1;  ///< likewise
};

}  // namespace

Scene loadRadiance(const std::string& path, const SceneOptions& options) {
  const std::string content = readWholeFile(path);
  return RadianceScene(path, content, options).read();
}

}  // namespace radiosity
