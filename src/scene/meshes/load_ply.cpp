// Reads PLY (Turk, "The PLY Polygon File Format", 1994): ASCII, and binary in both byte orders.
// Faces are one surface, or one for each value of a property such as `group` or `material_index`.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>

#include "base/input_file.h"
#include "base/lower_case.h"
#include "base/parse.h"
#include "radiosity/spelling.h"
#include "scene/grouped_faces.h"
#include "scene/mesh_cursor.h"
#include "scene/readers.h"
#include "scene/text.h"

namespace radiosity {

namespace {

struct Property {
  std::string name;
  NumberType type;
  std::optional<NumberType> count;  ///< type of the length of a list
  Index band = kNone;               ///< of a colour: 0, 1, 2
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

std::optional<NumberType> plyTypeNamed(std::string_view name) {
  using enum NumberType;
  constexpr std::pair<std::string_view, NumberType> kTypes[] = {
      {"char", i8},   {"int8", i8},     {"uchar", u8},   {"uint8", u8},
      {"short", i16}, {"int16", i16},   {"ushort", u16}, {"uint16", u16},
      {"int", i32},   {"int32", i32},   {"uint", u32},   {"uint32", u32},
      {"float", f32}, {"float32", f32}, {"double", f64}, {"float64", f64}};
  for (const auto& [known, type] : kTypes) {
    if (known == name) return type;
  }
  return std::nullopt;
}

/// The band of a colour that a property of this name has; kNone for other names.
Index bandNamed(const std::string& property) {
  constexpr std::string_view kBands[] = {"red", "green", "blue"};
  const std::string name = lowerCase(property);
  for (Index band = 0; band < 3; ++band) {
    const std::string_view word = kBands[band];
    if (name == word || name == word.substr(0, 1) || name == fmt::format("diffuse_{}", word)) {
      return band;
    }
  }
  return kNone;
}

/// The largest number of a property of a colour: 1 for fractions.
double brightest(NumberType type) {
  if (isFraction(type)) return 1;
  const bool is_signed =
      type == NumberType::i8 || type == NumberType::i16 || type == NumberType::i32;
  return std::exp2(8 * double(sizeOf(type)) - (is_signed ? 1 : 0)) - 1;
}

bool hasColours(const PlyElement& element) {
  std::array<bool, 3> found{};
  for (const Property& property : element.properties) {
    if (property.band != kNone) found[property.band] = true;
  }
  return found[0] && found[1] && found[2];
}

class PlyReader {
 public:
  PlyReader(const std::string& path, std::string_view content, const SceneOptions& options)
      : options_(options),
        cursor_(path, content),
        faces_(path, options),
        stem_(std::filesystem::path(path).stem().string()) {}

  Scene read() {
    header();
    for (const PlyElement& element : elements_) {
      if (element.name == "vertex") {
        vertices(element);
      } else if (element.name == "face") {
        faces(element);
      } else {
        passElement(element);
      }
    }
    if (!cursor_.atEnd()) {
      faces_.scene().notes.push_back(
          {Severity::warning, "what stands after the last element of the file is left out"});
    }
    faces_.refuseCloud();
    return faces_.finish("export the scene with its faces");
  }

 private:
  void header();
  void headerLine(const std::vector<std::string_view>& words);
  void property(const std::vector<std::string_view>& words);
  NumberType typeNamed(std::string_view word) const;
  void requireRoom(const PlyElement& element) const;
  void vertices(const PlyElement& element);
  void faces(const PlyElement& element);
  void face(std::size_t number, const PlyElement& element);
  void passElement(const PlyElement& element);
  void pass(const Property& property);
  void noteColours();
  Vec3 factorOf(const Vec3& colour, std::size_t vertex) const;

  const SceneOptions& options_;
  MeshCursor cursor_;
  GroupedFaces faces_;
  std::string stem_;
  std::vector<PlyElement> elements_;
  std::optional<Encoding> encoding_;
  std::vector<Index> corners_;  ///< of the present face
};

void PlyReader::header() {
  if (cursor_.nextLine() != "ply") cursor_.fail("is no PLY file, which begins with ply; export it");
  for (;;) {
    const std::string_view line = cursor_.nextLine();
    if (line.empty()) cursor_.fail("the header has no end; export the file again");
    if (line == "end_header") break;
    headerLine(splitWords(line));
  }
  cursor_.restOfLine();
  if (!encoding_) cursor_.fail("no line says the format; export the file again");
  cursor_.setEncoding(*encoding_);
  noteColours();
}

void PlyReader::headerLine(const std::vector<std::string_view>& words) {
  const std::string_view keyword = words[0];
  if (keyword == "comment" || keyword == "obj_info") return;
  if (keyword == "format" && words.size() == 3) {
    if (words[1] == "ascii") encoding_ = Encoding::text;
    if (words[1] == "binary_little_endian") encoding_ = Encoding::little;
    if (words[1] == "binary_big_endian") encoding_ = Encoding::big;
    if (!encoding_) cursor_.fail(fmt::format("format {} is not read; export it again", words[1]));
  } else if (keyword == "element" && words.size() == 3) {
    const std::optional<long long> count = parseInteger(words[2]);
    if (!count || *count < 0) {
      cursor_.fail(fmt::format("`{}` is not a whole number of 0 or more; correct it", words[2]));
    }
    if (words[1] == "tristrips") {
      cursor_.fail("strips of triangles are not read; export the faces one by one");
    }
    const bool is_second = std::ranges::any_of(
        elements_, [&](const PlyElement& before) { return before.name == words[1]; });
    if (is_second) {
      cursor_.fail(fmt::format("there are two elements called {}; export it again", words[1]));
    }
    elements_.push_back({std::string(words[1]), std::size_t(*count), {}});
  } else if (keyword == "property" && words.size() >= 3 && !elements_.empty()) {
    property(words);
  } else {
    cursor_.fail(
        fmt::format("`{}` does not belong in the header of a PLY file like this; export it "
                    "again",
                    keyword));
  }
}

NumberType PlyReader::typeNamed(std::string_view word) const {
  const std::optional<NumberType> type = plyTypeNamed(word);
  if (!type) cursor_.fail(fmt::format("`{}` is no type of a PLY file; export it again", word));
  return *type;
}

void PlyReader::property(const std::vector<std::string_view>& words) {
  const bool is_list = words[1] == "list";
  if (words.size() != (is_list ? 5U : 3U)) {
    cursor_.fail("a property is `TYPE NAME` or `list TYPE TYPE NAME`; export the file again");
  }
  Property property{std::string(words.back()), typeNamed(words[words.size() - 2]), {}, kNone};
  if (!is_list) {
    property.band = bandNamed(property.name);
    return elements_.back().properties.push_back(std::move(property));
  }
  property.count = typeNamed(words[2]);
  if (isFraction(typeNamed(words[2]))) {
    cursor_.fail("the length of a list is a whole number; export the file again");
  }
  elements_.back().properties.push_back(std::move(property));
}

/// Notes colours that are not used: they may be light, paint or labels, linear or not.
void PlyReader::noteColours() {
  for (const PlyElement& element : elements_) {
    const bool of_vertices = element.name == "vertex";
    if (!hasColours(element)) continue;
    if (of_vertices && options_.vertex_colours != VertexColours::unused) continue;
    faces_.scene().notes.push_back(
        {Severity::info,
         fmt::format("colours of each {} are not used: the format does not say what they mean; {} "
                     "does",
                     element.name,
                     of_vertices ? spelled("vertex_colours", "srgb") + " or linear"
                                 : spelled("set", "NAME.reflectance=R,G,B"))});
  }
}

/// Refuses a count that the file is too short for, so that a forged count makes no long loop.
void PlyReader::requireRoom(const PlyElement& element) const {
  std::size_t bytes = 0;
  for (const Property& property : element.properties)
    bytes += sizeOf(property.count.value_or(property.type));
  const bool is_text = cursor_.encoding() == Encoding::text;
  cursor_.require(element.count, ("element " + element.name).c_str(), NumberType::u8,
                  std::max<std::size_t>(1, is_text ? element.properties.size() : bytes));
}

void PlyReader::vertices(const PlyElement& element) {
  requireRoom(element);
  for (const char* axis : {"x", "y", "z"}) {
    const bool found = std::any_of(element.properties.begin(), element.properties.end(),
                                   [&](const Property& p) { return p.name == axis && !p.count; });
    if (!found) cursor_.fail(fmt::format("vertices have no {}; export the file again", axis));
  }
  const bool coloured = options_.vertex_colours != VertexColours::unused && hasColours(element);
  for (std::size_t k = 0; k < element.count; ++k) {
    Vec3 place(0.0);
    Vec3 colour(0.0);
    for (const Property& property : element.properties) {
      const std::size_t axis = property.name.size() == 1
                                   ? std::string_view("xyz").find(property.name)
                                   : std::string_view::npos;
      if (axis != std::string_view::npos && !property.count) {
        place[int(axis)] = cursor_.number(property.type, "coordinate");
      } else if (coloured && property.band != kNone) {
        colour[int(property.band)] =
            cursor_.number(property.type, "colour") / brightest(property.type);
      } else {
        pass(property);
      }
    }
    if (coloured) {
      faces_.addVertex(place, factorOf(colour, k));
    } else {
      faces_.addVertex(place);
    }
  }
}

Vec3 PlyReader::factorOf(const Vec3& colour, std::size_t vertex) const {
  const std::optional<Vec3> factor = factorOfColour(colour, options_.vertex_colours);
  if (!factor) {
    cursor_.fail(
        fmt::format("the colour of vertex {} is outside 0 to 1; scale it, or leave out "
                    "{}",
                    vertex, spelled("vertex_colours")));
  }
  return *factor;
}

void PlyReader::faces(const PlyElement& element) {
  requireRoom(element);
  const bool found =
      std::any_of(element.properties.begin(), element.properties.end(), [](const Property& p) {
        return p.count && (p.name == "vertex_indices" || p.name == "vertex_index");
      });
  if (!found) cursor_.fail("faces have no list vertex_indices; export the file again");
  for (std::size_t k = 0; k < element.count; ++k) face(k, element);
}

void PlyReader::face(std::size_t number, const PlyElement& element) {
  std::string group = stem_;
  bool grouped = false;
  for (const Property& property : element.properties) {
    if (property.count && (property.name == "vertex_indices" || property.name == "vertex_index")) {
      const std::size_t count = cursor_.count(*property.count, "number of corners", property.type);
      corners_.clear();
      for (std::size_t k = 0; k < count; ++k) {
        const long long vertex = cursor_.integer(property.type, "vertex");
        if (vertex < 0 || std::size_t(vertex) >= faces_.scene().vertices.size()) {
          cursor_.fail(
              fmt::format("vertex {} of face {} does not exist, there are {} (from 0); "
                          "correct it",
                          vertex, number, faces_.scene().vertices.size()));
        }
        corners_.push_back(Index(vertex));
      }
    } else if (!grouped && !property.count && !isFraction(property.type) &&
               groupArrayRank(property.name)) {
      group = fmt::format("{} {}", property.name, cursor_.integer(property.type, "group"));
      grouped = true;
    } else {
      pass(property);
    }
  }
  if (corners_.size() < 3) {
    cursor_.fail(fmt::format("face {} has {} corners, it needs 3 or more; correct or remove it",
                             number, corners_.size()));
  }
  faces_.addFace(corners_, group, number);
}

void PlyReader::pass(const Property& property) {
  const std::size_t count =
      property.count ? cursor_.count(*property.count, "length of a list", property.type) : 1;
  cursor_.skip(property.type, count);
}

void PlyReader::passElement(const PlyElement& element) {
  if (element.properties.empty()) return;
  requireRoom(element);
  for (std::size_t k = 0; k < element.count; ++k) {
    for (const Property& property : element.properties) pass(property);
  }
}

}  // namespace

Scene loadPly(const std::string& path, const SceneOptions& options) {
  return PlyReader(path, readWholeFile(path), options).read();
}

}  // namespace radiosity
