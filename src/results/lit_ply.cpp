// Reads PLY (G. Turk, "The PLY Polygon File Format", 1994): ASCII and binary, vertices with red,
// green and blue, faces as lists of vertex indices.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>

#include "base/input_file.h"
#include "base/parse.h"
#include "results/lit_mesh.h"
#include "scene/text.h"

namespace radiosity {

namespace {

enum class PlyNumber { i8, u8, i16, u16, i32, u32, f32, f64 };

struct Property {
  std::string name;
  PlyNumber type = PlyNumber::f32;
  std::optional<PlyNumber> list_count;  ///< the type of a list's length; empty: a single number
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

std::optional<PlyNumber> numberOf(std::string_view word) {
  constexpr std::array<std::pair<std::string_view, PlyNumber>, 16> kTypes = {
      {{"char", PlyNumber::i8},
       {"int8", PlyNumber::i8},
       {"uchar", PlyNumber::u8},
       {"uint8", PlyNumber::u8},
       {"short", PlyNumber::i16},
       {"int16", PlyNumber::i16},
       {"ushort", PlyNumber::u16},
       {"uint16", PlyNumber::u16},
       {"int", PlyNumber::i32},
       {"int32", PlyNumber::i32},
       {"uint", PlyNumber::u32},
       {"uint32", PlyNumber::u32},
       {"float", PlyNumber::f32},
       {"float32", PlyNumber::f32},
       {"double", PlyNumber::f64},
       {"float64", PlyNumber::f64}}};
  for (const auto& [name, type] : kTypes) {
    if (word == name) return type;
  }
  return std::nullopt;
}

std::size_t sizeOf(PlyNumber type) {
  switch (type) {
    case PlyNumber::i8:
    case PlyNumber::u8:
      return 1;
    case PlyNumber::i16:
    case PlyNumber::u16:
      return 2;
    case PlyNumber::f64:
      return 8;
    default:
      return 4;
  }
}

class PlyReader {
 public:
  PlyReader(const std::string& path, std::string_view text) : path_(path), text_(text) {}

  LitMesh read() {
    readHeader();
    mesh_.file = path_;
    mesh_.surface_names = {""};
    for (const PlyElement& element : elements_) {
      requireRoom(element);
      if (element.name == "vertex") {
        readVertices(element);
      } else if (element.name == "face") {
        readFaces(element);
      } else {
        for (std::size_t k = 0; k < element.count; ++k) record(element);
      }
    }
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(path_ + ": " + what); }

  std::string_view line() {
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string_view::npos) fail("the header has no end; export it again");
    const std::string_view found = trimmed(text_.substr(at_, end - at_));
    at_ = end + 1;
    return found;
  }

  using Words = std::vector<std::string_view>;

  [[noreturn]] void failAt(const Words& words) const {
    fail(fmt::format("'{}' in its header is not understood; export it again",
                     fmt::join(words, " ")));
  }

  /// Refuses a count for which the rest of the file is too short: in text a number takes a digit
  /// and a blank (an empty list is the length 0), else its bytes.
  void requireRoom(const PlyElement& element) const {
    if (element.count == 0) return;
    if (element.properties.empty()) {
      fail(fmt::format("its `{}` elements have no properties; export it again", element.name));
    }
    std::size_t least = 0;
    for (const Property& property : element.properties) {
      least += ascii_ ? 2 : sizeOf(property.list_count.value_or(property.type));
    }
    // In text the last number needs no blank after it.
    if (element.count <= (text_.size() - at_ + 1) / least) return;
    fail(fmt::format("claims {} `{}` elements and ends before; export it again", element.count,
                     element.name));
  }

  void readHeader() {
    if (line() != "ply") fail("is not a PLY file; export it again");
    for (std::string_view text = line(); text != "end_header"; text = line()) {
      const Words words = splitWords(text);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "format" && words.size() == 3) {
        ascii_ = words[1] == "ascii";
        swapped_ = words[1] == "binary_big_endian";
        if (!ascii_ && !swapped_ && words[1] != "binary_little_endian") failAt(words);
      } else if (words[0] == "element" && words.size() == 3) {
        addElement(words);
      } else if (words[0] == "property" && !elements_.empty()) {
        addProperty(words);
      } else {
        failAt(words);
      }
    }
  }

  /// "element vertex 8"
  void addElement(const Words& words) {
    const std::optional<long long> count = parseInteger(words[2]);
    if (!count || *count < 0) failAt(words);
    elements_.push_back({std::string(words[1]), std::size_t(*count), {}});
  }

  /// "property float x", "property list uchar int vertex_indices"
  void addProperty(const Words& words) {
    const bool list = words.size() == 5 && words[1] == "list";
    if (!list && words.size() != 3) failAt(words);
    const std::optional<PlyNumber> type = numberOf(words[words.size() - 2]);
    if (!type) failAt(words);
    Property property;
    property.name = words.back();
    property.type = *type;
    if (list) property.list_count = numberOf(words[2]);
    if (list && !property.list_count) failAt(words);
    elements_.back().properties.push_back(property);
  }

  template <class T>
  double binary() {
    if (text_.size() - at_ < sizeof(T)) fail("ends too early; export it again");
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), text_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    if (swapped_ != (std::endian::native == std::endian::big)) {
      std::reverse(bytes.begin(), bytes.end());
    }
    return double(std::bit_cast<T>(bytes));
  }

  double number(PlyNumber type) {
    if (ascii_) {
      const std::size_t begin = text_.find_first_not_of(" \t\r\n", at_);
      if (begin == std::string_view::npos) fail("ends too early; export it again");
      at_ = std::min(text_.find_first_of(" \t\r\n", begin), text_.size());
      const std::string_view word = text_.substr(begin, at_ - begin);
      const std::optional<double> value = parseNumber(word);
      if (!value) fail(fmt::format("'{}' is not a finite number; export it again", word));
      return *value;
    }
    switch (type) {
      case PlyNumber::i8:
        return binary<std::int8_t>();
      case PlyNumber::u8:
        return binary<std::uint8_t>();
      case PlyNumber::i16:
        return binary<std::int16_t>();
      case PlyNumber::u16:
        return binary<std::uint16_t>();
      case PlyNumber::i32:
        return binary<std::int32_t>();
      case PlyNumber::u32:
        return binary<std::uint32_t>();
      case PlyNumber::f32:
        return binary<float>();
      case PlyNumber::f64:
        break;
    }
    return binary<double>();
  }

  /// The numbers of one record: one for each property, or those of a list.
  const std::vector<std::vector<double>>& record(const PlyElement& element) {
    record_.resize(element.properties.size());
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const Property& property = element.properties[p];
      const double length = property.list_count ? number(*property.list_count) : 1;
      if (!(length >= 0 && length <= double(text_.size()))) fail("a list has no length");
      record_[p].clear();
      for (std::size_t k = 0; k < std::size_t(length); ++k) {
        record_[p].push_back(number(property.type));
      }
    }
    return record_;
  }

  static std::optional<std::size_t> find(const PlyElement& element, std::string_view name) {
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      if (element.properties[p].name == name) return p;
    }
    return std::nullopt;
  }

  void readVertices(const PlyElement& element) {
    std::array<std::size_t, 6> place{};
    constexpr std::array<const char*, 6> kNames = {"x", "y", "z", "red", "green", "blue"};
    for (std::size_t k = 0; k < 6; ++k) {
      const std::optional<std::size_t> found = find(element, kNames[k]);
      if (!found && k < 3) fail(fmt::format("its vertices have no {}; export it again", kNames[k]));
      if (!found) {
        fail(
            "its vertices have no red, green and blue, so there is no light to compare; bake the "
            "light into vertex colours and export those");
      }
      place[k] = *found;
    }
    const PlyNumber type = element.properties[place[3]].type;
    mesh_.bytes = type == PlyNumber::u8;
    const double unit = type == PlyNumber::u8 ? 255 : type == PlyNumber::u16 ? 65535 : 1;
    for (std::size_t v = 0; v < element.count; ++v) {
      const auto& values = record(element);
      const auto at = [&](std::size_t k) {
        if (values[place[k]].empty()) fail("a vertex lacks a number");
        return values[place[k]].front();
      };
      mesh_.vertices.emplace_back(at(0), at(1), at(2));
      colours_.push_back(Vec3(at(3), at(4), at(5)) / unit);
    }
  }

  void readFaces(const PlyElement& element) {
    std::optional<std::size_t> list = find(element, "vertex_indices");
    if (!list) list = find(element, "vertex_index");
    if (!list) fail("its faces have no vertex_indices; export it again");
    for (std::size_t f = 0; f < element.count; ++f) {
      std::vector<Index> corners;
      std::vector<Vec3> colours;
      for (const double index : record(element)[*list]) {
        if (!(index >= 0 && index < double(mesh_.vertices.size()))) {
          fail(fmt::format("face {} has vertex {}, there are {}; export it again", f, index,
                           mesh_.vertices.size()));
        }
        corners.push_back(Index(index));
        colours.push_back(colours_[corners.back()]);
      }
      if (corners.size() >= 3) appendLitFace(mesh_, corners, colours, 0);
    }
  }

  const std::string& path_;
  std::string_view text_;
  std::size_t at_ = 0;
  bool ascii_ = false;
  bool swapped_ = false;
  std::vector<PlyElement> elements_;
  std::vector<std::vector<double>> record_;
  std::vector<Vec3> colours_;
  LitMesh mesh_;
};

}  // namespace

LitMesh readLitPly(const std::string& path) {
  const std::string text = readWholeFile(path);
  return PlyReader(path, text).read();
}

}  // namespace radiosity
