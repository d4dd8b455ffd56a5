// Reads 3MF, the format of programs for CAD and printing (3MF Consortium, "3MF Core Specification"
// 1.3): the placed objects of the build with their components. Components in other files of the
// package ("Production Extension Specification") are read, too.
#include <fmt/format.h>

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <set>
#include <vector>

#include "base/parse.h"
#include "scene/readers.h"
#include "scene/scene_builder.h"
#include "scene/text.h"
#include "scene/three_mf/three_mf_materials.h"
#include "scene/three_mf/three_mf_package.h"

namespace radiosity {

namespace {

/// The deepest nesting of components. Components that refer to each other in a ring, or double at
/// each level, would never end.
constexpr int kMostLevels = 64;
constexpr std::size_t kMostParts = std::size_t(1) << 20U;

using Placement = glm::dmat4;

/// An object in the place of an item of the build, or of a component.
struct PlacedObject {
  const ThreeMfModel* model;
  std::string id;
  Placement place;
  std::string name;  ///< of the object of which it is a component
  int level;
};

class ThreeMfReader {
 public:
  ThreeMfReader(const std::string& path, const SceneOptions& options)
      : package_(path), builder_(scene_, options), materials_(package_, options, scene_, notes_) {
    scene_.file = path;
  }

  Scene read();

 private:
  double readUnit(const pugi::xml_node& model);
  void noteExtensions(const pugi::xml_node& model);
  void refer(const pugi::xml_node& to, const PlacedObject& from, std::vector<PlacedObject>& open);
  Placement placementOf(const pugi::xml_node& node) const;
  void take(const PlacedObject& placed, std::vector<PlacedObject>& open);
  void addMesh(const pugi::xml_node& object, const std::string& name, const PlacedObject& placed);
  void addVertices(const pugi::xml_node& mesh, const std::string& name, const Placement& place);
  void addTriangle(const pugi::xml_node& triangle, std::size_t number, std::size_t first);
  Index materialOf(const pugi::xml_node& triangle);
  void noteUnplaced(const ThreeMfModel& model);

  Scene scene_;
  FeatureNotes notes_;
  ThreeMfPackage package_;
  SceneBuilder builder_;
  ThreeMfMaterials materials_;
  UniqueNames names_;
  std::set<pugi::xml_node> placed_;  ///< objects
  std::size_t parts_ = 0;

  // The present mesh.
  const ThreeMfModel* model_ = nullptr;
  pugi::xml_node object_;
  std::string name_;
  bool mirrors_ = false;
};

Scene ThreeMfReader::read() {
  const ThreeMfModel& root = package_.root();
  noteExtensions(root.root);
  const PlacedObject origin{&root, "", Placement(readUnit(root.root)), "", 0};
  std::vector<PlacedObject> open;
  const pugi::xml_node build = childNamed(root.root, "build");
  for (pugi::xml_node item = build.last_child(); item; item = item.previous_sibling()) {
    if (localName(item.name()) == "item") refer(item, origin, open);
  }
  while (!open.empty()) {
    const PlacedObject placed = std::move(open.back());
    open.pop_back();
    take(placed, open);
  }
  noteUnplaced(root);
  if (scene_.faceCount() == 0) {
    package_.fail("no faces: its build places no object with triangles; export it again");
  }
  builder_.finish();
  notes_.appendTo(scene_.notes);
  return std::move(scene_);
}

/// Sets the scene's unit and returns the length of the model's unit in it.
double ThreeMfReader::readUnit(const pugi::xml_node& model) {
  struct Unit {
    std::string_view name;
    const char* ours;
    double size;
  };
  constexpr std::array<Unit, 6> kUnits = {{{"micron", "mm", 0.001},
                                           {"millimeter", "mm", 1},
                                           {"centimeter", "cm", 1},
                                           {"inch", "in", 1},
                                           {"foot", "ft", 1},
                                           {"meter", "m", 1}}};
  const std::string_view name = model.attribute("unit").as_string("millimeter");
  for (const Unit& unit : kUnits) {
    if (unit.name != name) continue;
    scene_.unit = unit.ours;
    return unit.size;
  }
  package_.fail(
      fmt::format("its unit `{}` is none of micron, millimeter, centimeter, inch, foot, "
                  "meter; correct it",
                  name));
}

/// Notes the extensions that a reader must know to read the file correctly.
void ThreeMfReader::noteExtensions(const pugi::xml_node& model) {
  for (const std::string_view prefix : splitWords(model.attribute("requiredextensions").value())) {
    const std::string space = model.attribute(fmt::format("xmlns:{}", prefix).c_str()).value();
    if (space.find("/production/") != std::string::npos ||
        space.find("/material/") != std::string::npos) {
      continue;
    }
    notes_.add("extensions that the file needs and that are not read",
               space.empty() ? std::string(prefix) : space, Severity::warning);
  }
}

/// Reads twelve numbers: the images of the axes and of the origin.
Placement ThreeMfReader::placementOf(const pugi::xml_node& node) const {
  const std::string_view text = node.attribute("transform").value();
  Placement place(1.0);
  if (text.empty()) return place;
  const std::vector<std::string_view> words = splitWords(text);
  for (std::size_t k = 0; k < words.size() && k < 12; ++k) {
    const std::optional<double> number = parseNumber(words[k]);
    if (!number) {
      package_.fail(fmt::format("transform `{}` is not 12 finite numbers; correct it", text));
    }
    place[int(k) / 3][int(k) % 3] = *number;
  }
  if (words.size() != 12) {
    package_.fail(
        fmt::format("transform `{}` has {} numbers, not 12; correct it", text, words.size()));
  }
  return place;
}

/// Appends the object to which an item or a component refers to the list of objects to read.
void ThreeMfReader::refer(const pugi::xml_node& to, const PlacedObject& from,
                          std::vector<PlacedObject>& open) {
  const ThreeMfModel* model = from.model;
  for (const pugi::xml_attribute attribute : to.attributes()) {
    if (localName(attribute.name()) == "path") model = &package_.model(attribute.value());
  }
  open.push_back({model, to.attribute("objectid").value(), from.place * placementOf(to), from.name,
                  from.level + 1});
}

void ThreeMfReader::take(const PlacedObject& placed, std::vector<PlacedObject>& open) {
  if (placed.level > kMostLevels || ++parts_ > kMostParts) {
    package_.fail(
        fmt::format("its components are more than {}, or in a ring; export it again", kMostParts));
  }
  const auto found = placed.model->resources.find(placed.id);
  if (found == placed.model->resources.end() || localName(found->second.name()) != "object") {
    package_.fail(
        fmt::format("object `{}`, which the build or a component names, does not exist; "
                    "export it again",
                    placed.id));
  }
  const pugi::xml_node object = found->second;
  placed_.insert(object);
  PlacedObject inner = placed;
  const std::string_view name = trimmed(object.attribute("name").value());
  if (!name.empty()) inner.name = name;
  if (const pugi::xml_node mesh = childNamed(object, "mesh")) {
    addMesh(object, inner.name.empty() ? "object " + placed.id : inner.name, placed);
  }
  const pugi::xml_node components = childNamed(object, "components");
  for (pugi::xml_node part = components.last_child(); part; part = part.previous_sibling()) {
    if (localName(part.name()) == "component") refer(part, inner, open);
  }
}

void ThreeMfReader::addMesh(const pugi::xml_node& object, const std::string& name,
                            const PlacedObject& placed) {
  model_ = placed.model;
  object_ = object;
  name_ = names_.make(name);
  mirrors_ = glm::determinant(glm::dmat3(placed.place)) < 0;
  const pugi::xml_node mesh = childNamed(object, "mesh");
  if (childNamed(mesh, "beamlattice")) {
    notes_.add("beams of lattices are left out, in", name_, Severity::warning);
  }
  const std::size_t first = scene_.vertices.size();
  addVertices(mesh, name_, placed.place);
  std::size_t number = 0;
  for (const pugi::xml_node triangle : childNamed(mesh, "triangles").children()) {
    if (localName(triangle.name()) == "triangle") addTriangle(triangle, number++, first);
  }
}

void ThreeMfReader::addVertices(const pugi::xml_node& mesh, const std::string& name,
                                const Placement& place) {
  constexpr std::size_t kMostVertices = std::size_t(1) << 28U;
  std::size_t number = 0;
  for (const pugi::xml_node vertex : childNamed(mesh, "vertices").children()) {
    if (localName(vertex.name()) != "vertex") continue;
    glm::dvec4 given(0, 0, 0, 1);
    for (int axis = 0; axis < 3; ++axis) {
      constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
      const char* const word = vertex.attribute(kAxes[std::size_t(axis)]).value();
      const std::optional<double> value = parseNumber(word);
      if (!value) {
        package_.fail(
            fmt::format("object {}: vertex {}: {} `{}` is not a finite number; correct it", name,
                        number, kAxes[std::size_t(axis)], word));
      }
      given[axis] = *value;
    }
    if (scene_.vertices.size() >= kMostVertices) {
      package_.fail(
          fmt::format("has more than {} vertices, each copy of an object with its own; "
                      "split the scene",
                      kMostVertices));
    }
    scene_.vertices.emplace_back(place * given);
    ++number;
  }
}

void ThreeMfReader::addTriangle(const pugi::xml_node& triangle, std::size_t number,
                                std::size_t first) {
  std::array<Index, 3> corners{};
  const std::size_t vertices = scene_.vertices.size() - first;
  for (std::size_t k = 0; k < 3; ++k) {
    constexpr std::array<const char*, 3> kCorners = {"v1", "v2", "v3"};
    const char* const word = triangle.attribute(kCorners[k]).value();
    const std::optional<long long> vertex = parseInteger(word);
    if (!vertex || *vertex < 0 || std::size_t(*vertex) >= vertices) {
      package_.fail(
          fmt::format("object {}: triangle {}: vertex `{}` does not exist, there are {} "
                      "(from 0); correct it",
                      name_, number, word, vertices));
    }
    corners[mirrors_ ? 2 - k : k] = Index(first + std::size_t(*vertex));
  }
  Index material = materialOf(triangle);
  if (material == kNone) material = materials_.ownOf(name_);
  builder_.addFace(corners, {}, builder_.surface(name_, material), number);
}

/// The material of a triangle: its member and its group, or its object's group if it names none. If
/// it names no member, both are its object's. kNone: a kind of material that is not read.
Index ThreeMfReader::materialOf(const pugi::xml_node& triangle) {
  const std::string member = triangle.attribute("p1").value();
  const pugi::xml_attribute group = triangle.attribute("pid");
  if (member.empty()) {
    const pugi::xml_attribute of_object = object_.attribute("pindex");
    if (!of_object) return kNone;
    return materials_.of(*model_, object_.attribute("pid").value(), of_object.value(), name_);
  }
  for (const char* const corner : {"p2", "p3"}) {
    const pugi::xml_attribute other = triangle.attribute(corner);
    if (!other || member == other.value()) continue;
    notes_.add("colours that change over a triangle are not read, default reflectance there, in",
               name_, Severity::warning);
    return kNone;
  }
  return materials_.of(*model_, (group ? group : object_.attribute("pid")).value(), member, name_);
}

void ThreeMfReader::noteUnplaced(const ThreeMfModel& model) {
  for (const auto& [id, node] : model.resources) {
    if (localName(node.name()) != "object" || placed_.contains(node)) continue;
    const std::string name(trimmed(node.attribute("name").value()));
    notes_.add("objects that the build does not place are left out",
               name.empty() ? "object " + id : name, Severity::warning);
  }
}

}  // namespace

Scene load3mf(const std::string& path, const SceneOptions& options) {
  return ThreeMfReader(path, options).read();
}

}  // namespace radiosity
