// Reads Gmsh meshes (Geuzaine & Remacle, "Gmsh Reference Manual", section "MSH file format"):
// versions 2.2 and 4.1, ASCII and binary. Surfaces are the physical groups of faces.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "base/input_file.h"
#include "base/parse.h"
#include "scene/grouped_faces.h"
#include "scene/mesh_cursor.h"
#include "scene/readers.h"
#include "scene/text.h"

namespace radiosity {

namespace {

using enum NumberType;

constexpr const char* kSeveralGroups =
    "in several physical groups, they count to the first: faces also in";

/// The shape of Gmsh's element type; empty for types that we do not know.
std::optional<ElementShape> gmshShape(long long type) {
  static const std::map<long long, ElementShape> kShapes = {
      {1, {1, 2, 2}},   {2, {2, 3, 3}},   {3, {2, 4, 4}},   {4, {3, 4, 4}},    {5, {3, 8, 8}},
      {6, {3, 6, 6}},   {7, {3, 5, 5}},   {8, {1, 2, 3}},   {9, {2, 3, 6}},    {10, {2, 4, 9}},
      {11, {3, 4, 10}}, {12, {3, 8, 27}}, {13, {3, 6, 18}}, {14, {3, 5, 14}},  {15, {0, 1, 1}},
      {16, {2, 4, 8}},  {17, {3, 8, 20}}, {18, {3, 6, 15}}, {19, {3, 5, 13}},  {20, {2, 3, 9}},
      {21, {2, 3, 10}}, {22, {2, 3, 12}}, {23, {2, 3, 15}}, {24, {2, 3, 15}},  {25, {2, 3, 21}},
      {26, {1, 2, 4}},  {27, {1, 2, 5}},  {28, {1, 2, 6}},  {29, {3, 4, 20}},  {30, {3, 4, 35}},
      {31, {3, 4, 56}}, {36, {2, 4, 16}}, {37, {2, 4, 25}}, {38, {2, 4, 36}},  {39, {2, 4, 12}},
      {40, {2, 4, 16}}, {41, {2, 4, 20}}, {92, {3, 8, 64}}, {93, {3, 8, 125}},
  };
  const auto found = kShapes.find(type);
  if (found == kShapes.end()) return std::nullopt;
  return found->second;
}

class GmshReader {
 public:
  GmshReader(const std::string& path, std::string_view content, const SceneOptions& options)
      : path_(path), cursor_(path, content), faces_(path, options) {}

  Scene read() {
    format();
    while (!cursor_.atEnd()) section();
    noteEmptyGroups();
    notes_.appendTo(faces_.scene().notes);
    return faces_.finish(
        "save the mesh of the surfaces too (in Gmsh: physical surfaces, or "
        "Mesh.SaveAll=1)");
  }

 private:
  void format();
  void section();
  void passSection(const std::string& name);
  void expectEnd(const std::string& name);
  void physicalNames();
  void entities();
  void nodes2();
  void nodes4();
  void node(long long tag, const Vec3& place);
  void elements2();
  void elements4();
  void readNodes(const ElementShape& shape, NumberType type);
  ElementShape shape(long long type) const;
  std::string physicalName(int dimension, long long tag);
  struct Side {
    std::string group;
    bool turned;
  };
  std::string volumeGroup(long long entity);
  void noteEmptyGroups();
  std::vector<Side> sidesOf(long long entity);
  void addSides(const ElementShape& shape, std::span<const Side> sides, long long tag);
  bool isNewFace(const ElementShape& shape, long long entity);

  const std::string& path_;
  MeshCursor cursor_;
  GroupedFaces faces_;
  FeatureNotes notes_;
  int version_ = 0;
  NodeNumbers nodes_;
  std::vector<Index> corners_;                               ///< of the present element
  using Tag = std::pair<int, long long>;                     ///< with the dimension: 2 or 3
  std::map<Tag, std::string> physical_;                      ///< names of groups
  std::set<Tag> used_;                                       ///< groups that have elements
  std::map<Tag, std::vector<long long>> tags_;               ///< groups of an entity (4.1)
  std::set<std::pair<long long, std::vector<Index>>> seen_;  ///< faces of an entity (2.2)
};

void GmshReader::format() {
  const std::string_view first = cursor_.nextLine();
  if (first == "$NOD" || first == "$PARA") {
    throw InputError(fmt::format(
        "{0}: is a Gmsh mesh of format 1, which is not read; convert it to 4.1: gmsh '{0}' -save "
        "-format msh41 -o NEW.msh",
        path_));
  }
  if (first.starts_with('(')) {
    throw InputError(path_ +
                     ": is a mesh of Fluent, not of Gmsh, which has the same extension; export it "
                     "as STL, or as a .msh of Gmsh");
  }
  if (first != "$MeshFormat") {
    cursor_.fail("is no Gmsh mesh, which begins with $MeshFormat; save it as .msh");
  }
  const std::string_view version = cursor_.word();
  const std::optional<double> number = parseNumber(version);
  if (number && *number >= 2 && *number < 3) version_ = 2;
  if (number && *number == 4.1) version_ = 4;
  if (version_ == 0) {
    cursor_.fail(fmt::format(
        "MSH version {} is not read; save as 4.1 or 2.2 (in Gmsh: -format msh41)", version));
  }
  const long long binary = cursor_.integer(i32, "file type");
  const long long size = cursor_.integer(i32, "data size");
  if (size != 8) cursor_.fail(fmt::format("data size {} is not read, 8 is; save it again", size));
  cursor_.restOfLine();
  if (binary == 1) {
    cursor_.setEncoding(Encoding::little);
    const long long one = cursor_.integer(i32, "one");
    if (one == 0x01000000) cursor_.setEncoding(Encoding::big);
    if (one != 1 && one != 0x01000000)
      cursor_.fail("the order of bytes is not told; save it again");
  }
  expectEnd("MeshFormat");
}

void GmshReader::expectEnd(const std::string& name) {
  const std::string_view found = cursor_.nextLine();
  if (found != "$End" + name) {
    cursor_.fail(fmt::format("`{}` stands where $End{} belongs; save the mesh again",
                             found.substr(0, 40), name));
  }
}

void GmshReader::section() {
  const std::string_view line = cursor_.nextLine();
  if (!line.starts_with('$')) {
    cursor_.fail(fmt::format("`{}` stands where a section ($...) belongs; save the mesh again",
                             line.substr(0, 40)));
  }
  const std::string name(line.substr(1));
  static const std::map<std::string, std::array<void (GmshReader::*)(), 2>> kSections = {
      {"PhysicalNames", {&GmshReader::physicalNames, &GmshReader::physicalNames}},
      {"Entities", {&GmshReader::entities, &GmshReader::entities}},
      {"Nodes", {&GmshReader::nodes2, &GmshReader::nodes4}},
      {"Elements", {&GmshReader::elements2, &GmshReader::elements4}},
  };
  const auto found = kSections.find(name);
  if (found == kSections.end()) return passSection(name);
  cursor_.restOfLine();
  (this->*found->second[version_ == 2 ? 0 : 1])();
  expectEnd(name);
}

/// Skips a section that we do not use: periodic nodes, data on nodes and the like.
void GmshReader::passSection(const std::string& name) {
  if (!cursor_.passBehind("$End" + name)) {
    cursor_.fail(fmt::format("section ${} has no end; the file is cut off, save it again", name));
  }
}

void GmshReader::physicalNames() {
  const Encoding encoding = cursor_.encoding();
  cursor_.setEncoding(Encoding::text);  // names are text in every file
  const std::size_t count = cursor_.count(u64, "number of names", u8, 3);
  for (std::size_t k = 0; k < count; ++k) {
    const long long dimension = cursor_.integer(i32, "dimension");
    const long long tag = cursor_.integer(i32, "physical tag");
    std::string_view name = cursor_.restOfLine();
    if (name.size() < 2 || name.front() != '"' || name.back() != '"') {
      cursor_.fail(fmt::format("`{}` is not a name in quotation marks; correct it", name));
    }
    name = trimmed(name.substr(1, name.size() - 2));
    if (dimension >= 2 && !name.empty()) physical_[{int(dimension), tag}] = name;
  }
  cursor_.setEncoding(encoding);
}

void GmshReader::entities() {
  std::size_t count[4];
  for (std::size_t& n : count) n = cursor_.count(u64, "number of entities", i32, 5);
  for (int dimension = 0; dimension < 4; ++dimension) {
    for (std::size_t k = 0; k < count[dimension]; ++k) {
      const long long tag = cursor_.integer(i32, "entity");
      cursor_.skip(f64, dimension == 0 ? 3 : 6);  // its box
      const std::size_t groups = cursor_.count(u64, "number of physical tags", i32);
      std::vector<long long> tags;
      for (std::size_t g = 0; g < groups; ++g) {
        tags.push_back(cursor_.integer(i32, "physical tag"));
      }
      if (dimension >= 2) tags_[{dimension, tag}] = tags;
      if (dimension > 0) {
        cursor_.skip(i32, cursor_.count(u64, "number of bounding entities", i32));
      }
    }
  }
}

void GmshReader::node(long long tag, const Vec3& place) {
  if (nodes_.add(tag, faces_.addVertex(place))) return;
  cursor_.fail(fmt::format("node {} is there twice; number nodes anew", tag));
}

void GmshReader::nodes2() {
  const std::size_t count = cursor_.textCount("number of nodes", f64, 3);
  for (std::size_t k = 0; k < count; ++k) {
    const long long tag = cursor_.integer(i32, "node");
    node(tag, cursor_.place(f64));
  }
}

void GmshReader::nodes4() {
  const std::size_t blocks = cursor_.count(u64, "number of blocks", i32, 4);
  cursor_.skip(u64, 3);  // number of nodes, least and largest tag
  for (std::size_t b = 0; b < blocks; ++b) {
    const long long dimension = cursor_.integer(i32, "dimension");
    cursor_.integer(i32, "entity");
    const bool parametric = cursor_.integer(i32, "parametric") != 0;
    const std::size_t count = cursor_.count(u64, "number of nodes", u64, 4);
    std::vector<long long> tags;
    tags.reserve(count);
    for (std::size_t k = 0; k < count; ++k) tags.push_back(cursor_.integer(u64, "node"));
    for (const long long tag : tags) {
      node(tag, cursor_.place(f64));
      if (parametric) cursor_.skip(f64, std::size_t(std::clamp(dimension, 0LL, 3LL)));
    }
  }
}

ElementShape GmshReader::shape(long long type) const {
  const std::optional<ElementShape> found = gmshShape(type);
  if (!found) {
    cursor_.fail(
        fmt::format("elements of type {} are not read; save the mesh with elements of the "
                    "first order",
                    type));
  }
  return *found;
}

void GmshReader::readNodes(const ElementShape& shape, NumberType type) {
  corners_.clear();
  for (int k = 0; k < shape.nodes; ++k) {
    const long long tag = cursor_.integer(type, "node");
    const Index vertex = nodes_.find(tag);
    if (vertex == kNone) {
      cursor_.fail(
          fmt::format("node {} does not exist; correct the element or save the mesh again", tag));
    }
    corners_.push_back(vertex);
  }
}

std::string GmshReader::physicalName(int dimension, long long tag) {
  used_.emplace(dimension, tag);
  const auto found = physical_.find({dimension, tag});
  return found == physical_.end() ? fmt::format("physical {}", tag) : found->second;
}

/// Whether a face is new: version 2.2 writes a face once for each of its physical groups.
bool GmshReader::isNewFace(const ElementShape& shape, long long entity) {
  if (shape.dimension != 2) return true;
  std::vector<Index> loop(corners_.begin(), corners_.begin() + shape.corners);
  std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  return seen_.emplace(entity, std::move(loop)).second;
}

void GmshReader::elements2() {
  const std::size_t count = cursor_.textCount("number of elements", i32, 3);
  for (std::size_t k = 0; k < count;) {
    const bool binary = cursor_.encoding() != Encoding::text;
    long long tag = binary ? 0 : cursor_.integer(i32, "element");
    const ElementShape kind = shape(cursor_.integer(i32, "element type"));
    const std::size_t in_block =
        binary ? cursor_.count(i32, "number of elements", i32, std::size_t(kind.nodes) + 1) : 1;
    if (in_block == 0 || in_block > count - k) {
      cursor_.fail("its blocks have more or less elements than it says; save the mesh again");
    }
    const std::size_t tags = cursor_.count(i32, "number of tags", i32);
    for (std::size_t e = 0; e < in_block; ++e, ++k) {
      if (binary) tag = cursor_.integer(i32, "element");
      const long long physical = tags > 0 ? cursor_.integer(i32, "physical tag") : 0;
      const long long entity = tags > 1 ? cursor_.integer(i32, "entity") : 0;
      if (tags > 2) cursor_.skip(i32, tags - 2);
      readNodes(kind, i32);
      const std::string group =
          physical != 0 ? physicalName(kind.dimension, physical) : fmt::format("entity {}", entity);
      if (isNewFace(kind, entity)) {
        faces_.addElement(kind, corners_, group, std::size_t(tag));
      } else {
        notes_.add(kSeveralGroups, group, Severity::warning);
      }
    }
  }
}

std::string GmshReader::volumeGroup(long long entity) {
  const auto found = tags_.find({3, entity});
  if (found == tags_.end() || found->second.empty()) return fmt::format("entity {}", entity);
  return physicalName(3, std::abs(found->second.front()));
}

/// The sides of an entity with their groups. Each side of a surface belongs to its first group; a
/// group with a negative tag has the surface turned over. (Version 2.2 writes the faces of such
/// groups already turned, 4.1 does not.)
std::vector<GmshReader::Side> GmshReader::sidesOf(long long entity) {
  const auto found = tags_.find({2, entity});
  if (found == tags_.end() || found->second.empty()) {
    return {{fmt::format("entity {}", entity), false}};
  }
  std::vector<Side> sides;
  for (const long long tag : found->second) {
    const Side side{physicalName(2, std::abs(tag)), tag < 0};
    const bool taken = std::any_of(sides.begin(), sides.end(),
                                   [&](const Side& s) { return s.turned == side.turned; });
    if (taken) {
      notes_.add(kSeveralGroups, side.group, Severity::warning);
    } else {
      sides.push_back(side);
    }
  }
  return sides;
}

void GmshReader::elements4() {
  const std::size_t blocks = cursor_.count(u64, "number of blocks", i32, 4);
  cursor_.skip(u64, 3);
  for (std::size_t b = 0; b < blocks; ++b) {
    cursor_.integer(i32, "dimension");
    const long long entity = cursor_.integer(i32, "entity");
    const ElementShape kind = shape(cursor_.integer(i32, "element type"));
    const std::size_t count =
        cursor_.count(u64, "number of elements", u64, std::size_t(kind.nodes) + 1);
    std::vector<Side> sides = {{"", false}};
    if (kind.dimension == 2) sides = sidesOf(entity);
    if (kind.dimension == 3) sides.front().group = volumeGroup(entity);
    for (std::size_t k = 0; k < count; ++k) {
      const long long tag = cursor_.integer(u64, "element");
      readNodes(kind, u64);
      addSides(kind, sides, tag);
    }
  }
}

/// Programs without $Entities write the names of groups in 4.1 and not which faces are theirs.
void GmshReader::noteEmptyGroups() {
  for (const auto& [tag, name] : physical_) {
    if (tag.first != 2 || used_.contains(tag)) continue;
    notes_.add(version_ == 4 ? "no face is said to be in these physical groups (4.1 says so in "
                               "$Entities; if there should be some, save as 2.2)"
                             : "no face is said to be in these physical groups",
               name, Severity::warning);
  }
}

void GmshReader::addSides(const ElementShape& shape, std::span<const Side> sides, long long tag) {
  for (const Side& side : sides) {
    if (side.turned) std::reverse(corners_.begin(), corners_.begin() + shape.corners);
    faces_.addElement(shape, corners_, side.group, std::size_t(tag));
    if (side.turned) std::reverse(corners_.begin(), corners_.begin() + shape.corners);
  }
}

}  // namespace

Scene loadGmsh(const std::string& path, const SceneOptions& options) {
  return GmshReader(path, readWholeFile(path), options).read();
}

}  // namespace radiosity
