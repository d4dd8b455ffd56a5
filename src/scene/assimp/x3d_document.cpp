#include "scene/assimp/x3d_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <map>
#include <numbers>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/file_name.h"

namespace radiosity {

namespace {

const std::set<std::string_view> kGroups = {"Anchor",   "Billboard",  "Collision", "CADAssembly",
                                            "CADFace",  "CADLayer",   "CADPart",   "Layer",
                                            "LayerSet", "LayoutGroup"};
const std::set<std::string_view> kRead = {"Scene",     "Shape",  "Group",  "StaticGroup",
                                          "Transform", "Switch", "Inline", "LOD"};
/// Geometry without faces.
const std::set<std::string_view> kLines = {
    "Arc2D", "Circle2D", "Polyline2D", "Polypoint2D", "IndexedLineSet", "LineSet", "PointSet"};
const std::set<std::string_view> kGeometry = {"ArcClose2D",
                                              "Disk2D",
                                              "Rectangle2D",
                                              "TriangleSet2D",
                                              "Box",
                                              "Cone",
                                              "Cylinder",
                                              "ElevationGrid",
                                              "Extrusion",
                                              "Sphere",
                                              "IndexedFaceSet",
                                              "IndexedTriangleSet",
                                              "IndexedTriangleFanSet",
                                              "TriangleFanSet",
                                              "TriangleSet",
                                              "IndexedTriangleStripSet"};
const std::set<std::string_view> kBesideGeometry = {
    "Appearance",     "MetadataSet",     "MetadataString", "MetadataFloat",
    "MetadataDouble", "MetadataInteger", "MetadataBoolean"};

/// The name of a group with a shape, before its number.
constexpr std::string_view kShapeGroup = "$shape ";

/// The numbers of an attribute; `otherwise` if it is missing or has another number of values.
template <std::size_t N>
std::array<double, N> numbers(const pugi::xml_node& element, const char* name,
                              const std::array<double, N>& otherwise) {
  std::array<double, N> out{};
  const char* at = element.attribute(name).value();
  for (double& value : out) {
    at += std::strspn(at, " ,\t\r\n");
    char* end = nullptr;
    value = std::strtod(at, &end);
    if (end == at) return otherwise;
    at = end;
  }
  return out;
}

/// The end of the string at the start of `list`, behind its quote.
std::size_t endOfString(std::string_view list) {
  std::size_t end = 1;
  while (end < list.size() && list[end] != '"') end += list[end] == '\\' ? 2 : 1;
  return std::min(end + 1, list.size());
}

/// Repairs what Assimp gets wrong in the attributes of all elements. It crashes at empty names. Of
/// the places from which an element may be read the first is kept, since it takes the list of them
/// for one; a VRML file gets .x3d at its end, by which Assimp chooses its reader.
void repairAttributes(pugi::xml_node element) {
  for (const pugi::xml_node child : element.children()) repairAttributes(child);
  for (const char* name : {"DEF", "USE"}) {
    if (*element.attribute(name).value() == '\0') element.remove_attribute(name);
  }
  pugi::xml_attribute attribute = element.attribute("url");
  if (!attribute) return;
  std::string_view list = attribute.value();
  list.remove_prefix(std::min(list.find_first_not_of(" ,\t\r\n"), list.size()));
  std::string url = withoutQuotes(list.starts_with('"') ? list.substr(0, endOfString(list)) : list);
  if (std::strcmp(element.name(), "Inline") == 0 && lowerExtension(url) == ".wrl") url += ".x3d";
  attribute.set_value(url.c_str());
}

Vec3 vectorOf(const pugi::xml_node& element, const char* name, double otherwise) {
  const auto v = numbers<3>(element, name, {otherwise, otherwise, otherwise});
  return {v[0], v[1], v[2]};
}

/// An axis and an angle in radians.
glm::dmat4 rotationOf(const pugi::xml_node& element, const char* name) {
  const auto v = numbers<4>(element, name, {0, 0, 1, 0});
  const Vec3 axis(v[0], v[1], v[2]);
  if (!(glm::length(axis) > 0)) return glm::dmat4(1.0);
  return glm::mat4_cast(glm::angleAxis(v[3], glm::normalize(axis)));
}

glm::dmat4 moved(const Vec3& by) {
  glm::dmat4 out(1.0);
  out[3] = glm::dvec4(by, 1.0);
  return out;
}

/// T C R SR S -SR -C (ISO/IEC 19775-1, 10.4.4).
glm::dmat4 transformOf(const pugi::xml_node& element) {
  if (std::strcmp(element.name(), "Transform") != 0) return glm::dmat4(1.0);
  const Vec3 centre = vectorOf(element, "center", 0);
  const Vec3 scale = vectorOf(element, "scale", 1);
  const glm::dmat4 stretch = rotationOf(element, "scaleOrientation");
  glm::dmat4 scaled(1.0);
  for (int k = 0; k < 3; ++k) scaled[k][k] = scale[k];
  return moved(vectorOf(element, "translation", 0) + centre) * rotationOf(element, "rotation") *
         stretch * scaled * glm::transpose(stretch) * moved(-centre);
}

/// Replaces a Cone or Cylinder by an IndexedFaceSet: planar sides, turned outward, between circles
/// of 32 corners on the true circle. The upper circle of a cone is its apex.
void replaceRound(pugi::xml_node shape, pugi::xml_node given) {
  constexpr int kSides = 32;
  const bool is_cone = std::strcmp(given.name(), "Cone") == 0;
  const double radius = given.attribute(is_cone ? "bottomRadius" : "radius").as_double(1);
  const double half = 0.5 * given.attribute("height").as_double(2);
  std::string points;
  std::string upper;
  std::string sides;
  std::string bottom;
  std::string top;
  for (int k = 0; k < kSides; ++k) {
    const double angle = 2 * std::numbers::pi * k / kSides;
    const double x = radius * std::sin(angle);
    const double z = radius * std::cos(angle);
    points += fmt::format("{} {} {} ", x, -half, z);
    upper += fmt::format("{} {} {} ", x, half, z);
    const int next = (k + 1) % kSides;
    sides += is_cone ? fmt::format("{} {} {} -1 ", k, next, kSides)
                     : fmt::format("{} {} {} {} -1 ", k, next, kSides + next, kSides + k);
    bottom += fmt::format("{} ", kSides - 1 - k);
    top += fmt::format("{} ", kSides + k);
  }
  points += is_cone ? fmt::format("0 {} 0", half) : upper;
  std::string faces;
  if (given.attribute("side").as_bool(true)) faces += sides;
  if (given.attribute("bottom").as_bool(true)) faces += bottom + "-1 ";
  if (!is_cone && given.attribute("top").as_bool(true)) faces += top + "-1 ";
  pugi::xml_node made = shape.insert_child_before("IndexedFaceSet", given);
  made.append_attribute("solid") = given.attribute("solid").as_bool(true);
  made.append_attribute("coordIndex") = faces.c_str();
  made.append_child("Coordinate").append_attribute("point") = points.c_str();
  shape.remove_child(given);
}

class Rewriter {
 public:
  Rewriter(std::vector<X3dShape>& shapes, FeatureNotes& notes) : shapes_(shapes), notes_(notes) {}

  X3dExtras run(pugi::xml_node root) {
    repairAttributes(root);
    collectNames(root);
    copyUses(root);
    for (const pugi::xml_node unit : root.child("head").children("unit")) {
      if (std::strcmp(unit.attribute("category").value(), "length") != 0) continue;
      extras_.metres_per_unit = unit.attribute("conversionFactor").as_double(1);
    }
    rewriteChildren(root.child("Scene"), glm::dmat4(1.0), "");
    return std::move(extras_);
  }

 private:
  void collectNames(const pugi::xml_node& element) {
    if (const pugi::xml_attribute name = element.attribute("DEF")) {
      named_.emplace(name.value(), element);
    }
    for (const pugi::xml_node child : element.children()) collectNames(child);
  }

  /// Copies in the order of the file, so that an element has no USE any more when it is copied.
  void copyUses(pugi::xml_node element) {
    pugi::xml_node child = element.first_child();
    while (child) {
      const auto found = named_.find(child.attribute("USE").value());
      if (found != named_.end()) {
        pugi::xml_node copy = element.insert_copy_before(found->second, child);
        if (const pugi::xml_attribute field = child.attribute("containerField")) {
          copy.remove_attribute("containerField");
          copy.append_attribute("containerField") = field.value();
        }
        element.remove_child(child);
        child = copy;
      }
      copyUses(child);
      child = child.next_sibling();
    }
  }

  /// `name`: that of the nearest element above with a name.
  void rewriteChildren(pugi::xml_node parent, const glm::dmat4& place, const std::string& name) {
    pugi::xml_node next;
    for (pugi::xml_node child = parent.first_child(); child; child = next) {
      next = child.next_sibling();
      rewrite(parent, child, place, name);
    }
  }

  void rewrite(pugi::xml_node parent, pugi::xml_node element, const glm::dmat4& place,
               const std::string& name) {
    const std::string kind = element.name();  // outlives set_name()
    const std::string own = element.attribute("DEF").value();
    const std::string& called = own.empty() ? name : own;
    if (kind == "Viewpoint") return addViewpoint(element, place, called);
    if (kind == "Shape") return rewriteShape(parent, element, called);
    if (std::strcmp(element.attribute("containerField").value(), "proxy") == 0) {
      parent.remove_child(element);  // of a Collision: it is for contact, never visible
      return;
    }
    if (kind == "LOD") {
      while (element.first_child() != element.last_child()) {
        element.remove_child(element.last_child());
      }
    }
    if (kind == "LOD" || kGroups.contains(kind)) {
      element.set_name("Group");
    } else if (!kRead.contains(kind)) {
      const bool holds_shapes = element.find_node(
          [](const pugi::xml_node& below) { return std::strcmp(below.name(), "Shape") == 0; });
      if (holds_shapes || kind == "ProtoInstance") {
        notes_.add("elements of X3D that are not read, and what is in them", kind,
                   Severity::warning);
      }
      // Assimp counts lights, and fails at elements that X3D does not have.
      if (!kind.ends_with("Light")) parent.remove_child(element);
      return;
    }
    rewriteChildren(element, place * transformOf(element), called);
    if (kind != "Inline" && !hasElements(element)) parent.remove_child(element);
  }

  /// Assimp crashes at groups that have none.
  static bool hasElements(const pugi::xml_node& group) {
    return std::ranges::any_of(group.children(), [](const pugi::xml_node& child) {
      return child.type() == pugi::node_element;
    });
  }

  void rewriteShape(pugi::xml_node parent, pugi::xml_node shape, const std::string& name) {
    X3dShape found{name, materialOf(shape)};
    pugi::xml_node next;
    for (pugi::xml_node child = shape.first_child(); child; child = next) {
      next = child.next_sibling();
      if (child.type() != pugi::node_element) continue;
      const std::string_view kind = child.name();
      if (kLines.contains(kind)) {
        return leaveOut(parent, shape, "lines and points have no area and are left out, in", name);
      }
      if (kGeometry.contains(kind)) {
        found.two_sided |= !child.attribute("solid").as_bool(true);
        found.clockwise |= !child.attribute("ccw").as_bool(true);
        if (kind == "Cone" || kind == "Cylinder") replaceRound(shape, child);
        if (kind.ends_with("Set") && isEmptySet(child)) {
          return leaveOut(parent, shape, "shapes without corners are left out", name);
        }
      } else if (!kBesideGeometry.contains(kind)) {
        notes_.add("shapes of X3D that are not read", std::string(kind), Severity::warning);
        parent.remove_child(shape);
        return;
      }
    }
    if (!shape.child("Appearance")) shape.prepend_child("Appearance");
    pugi::xml_node group = parent.insert_child_before("Group", shape);
    group.append_attribute("DEF") = fmt::format("{}{}", kShapeGroup, shapes_.size()).c_str();
    group.append_move(shape);
    shapes_.push_back(std::move(found));
  }

  static std::string materialOf(const pugi::xml_node& shape) {
    const pugi::xml_node appearance = shape.child("Appearance");
    const std::string name = appearance.child("Material").attribute("DEF").value();
    return name.empty() ? appearance.attribute("DEF").value() : name;
  }

  /// Whether a set has no corners: Assimp fails or, with colours and no coordinates, crashes.
  static bool isEmptySet(const pugi::xml_node& set) {
    if (!set.child("Coordinate")) return true;
    if (!std::string_view(set.name()).starts_with("Indexed")) return false;
    const char* const name = set.attribute("coordIndex") ? "coordIndex" : "index";
    const std::string_view corners = set.attribute(name).value();
    return corners.find_first_not_of(" ,\t\r\n") == std::string_view::npos;
  }

  void leaveOut(pugi::xml_node parent, pugi::xml_node shape, const char* why,
                const std::string& name) {
    notes_.add(why, name.empty() ? "a shape without a name" : name);
    parent.remove_child(shape);
  }

  void addViewpoint(const pugi::xml_node& element, const glm::dmat4& place,
                    const std::string& name) {
    const glm::dmat4 pose =
        place * moved(vectorOf(element, "position", 0)) * rotationOf(element, "orientation");
    Camera camera;
    const std::string description = element.attribute("description").value();
    camera.name = description.empty() ? name : description;
    if (camera.name.empty()) camera.name = fmt::format("viewpoint {}", extras_.viewpoints.size());
    const bool placed = !element.attribute("position").empty();
    camera.eye = Vec3(pose * glm::dvec4(0, 0, placed ? 0 : 10, 1));
    camera.target = camera.eye + Vec3(pose * glm::dvec4(0, 0, -1, 0));
    camera.up = Vec3(pose * glm::dvec4(0, 1, 0, 0));
    // The smaller angle of the picture: the vertical one, if it is wider than high.
    camera.vertical_fov = numbers<1>(element, "fieldOfView", {0.7854})[0];
    extras_.viewpoints.push_back(camera);
  }

  std::vector<X3dShape>& shapes_;
  FeatureNotes& notes_;
  X3dExtras extras_;
  std::map<std::string_view, pugi::xml_node> named_;
};

}  // namespace

std::string withoutQuotes(std::string_view text) {
  if (!text.starts_with('"')) return std::string(text);
  std::string result;
  for (std::size_t k = 1; k < text.size() && text[k] != '"'; ++k) {
    if (text[k] == '\\' && k + 1 < text.size()) ++k;
    result += text[k];
  }
  return result;
}

std::optional<std::size_t> x3dShapeNumber(std::string_view group) {
  if (!group.starts_with(kShapeGroup)) return std::nullopt;
  std::size_t number = 0;
  const std::string_view digits = group.substr(kShapeGroup.size());
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return error == std::errc() ? std::optional(number) : std::nullopt;
}

X3dExtras rewriteX3d(pugi::xml_document& document, std::vector<X3dShape>& shapes,
                     FeatureNotes& notes) {
  return Rewriter(shapes, notes).run(document.document_element());
}

}  // namespace radiosity
