// Reads legacy VTK files (Kitware, "VTK File Formats"): POLYDATA and UNSTRUCTURED_GRID, text or
// binary (big-endian), versions 1 to 5.1.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "base/input_file.h"
#include "base/lower_case.h"
#include "scene/mesh_cursor.h"
#include "scene/readers.h"
#include "scene/vtk/vtk_cells.h"

namespace radiosity {

namespace {

using enum NumberType;

std::optional<NumberType> vtkTypeNamed(std::string_view name) {
  constexpr std::pair<std::string_view, NumberType> kTypes[] = {
      {"char", i8},           {"unsigned_char", u8},
      {"short", i16},         {"unsigned_short", u16},
      {"int", i32},           {"unsigned_int", u32},
      {"long", i64},          {"unsigned_long", u64},
      {"float", f32},         {"double", f64},
      {"vtkidtype", i32},     {"vtktypeint8", i8},
      {"vtktypeuint8", u8},   {"vtktypeint16", i16},
      {"vtktypeuint16", u16}, {"vtktypeint32", i32},
      {"vtktypeuint32", u32}, {"vtktypeint64", i64},
      {"vtktypeuint64", u64}, {"signed_char", i8}};
  const std::string lower = lowerCase(name);
  for (const auto& [known, type] : kTypes) {
    if (known == lower) return type;
  }
  return std::nullopt;
}

/// Decodes a name or word of a text file, which has %20 for a blank and the like.
std::string percentDecoded(std::string_view word) {
  const auto digit = [](char c) {
    return std::string_view("0123456789abcdef").find(lowerCase({&c, 1})[0]);
  };
  std::string text;
  for (std::size_t k = 0; k < word.size(); ++k) {
    const bool coded = word[k] == '%' && k + 2 < word.size() &&
                       digit(word[k + 1]) != std::string_view::npos &&
                       digit(word[k + 2]) != std::string_view::npos;
    text += coded ? char(16 * digit(word[k + 1]) + digit(word[k + 2])) : word[k];
    if (coded) k += 2;
  }
  return text;
}

class VtkReader {
 public:
  VtkReader(const std::string& path, std::string_view content, const SceneOptions& options)
      : path_(path), cursor_(path, content), faces_(path, options) {}

  Scene read() {
    header();
    while (!cursor_.atEnd()) statement();
    assemble();
    const std::string stem = std::filesystem::path(path_).stem().string();
    addVtkCells(cells_, path_, stem, 0, faces_);
    return faces_.finish("export the surface as polygons");
  }

 private:
  enum class Data { field, cell, point };
  struct Lists {
    std::vector<long long> connectivity;
    std::vector<long long> ends;
  };

  void header();
  void statement();
  void points();
  Lists lists();
  void listsByCount(std::size_t count, std::size_t size, Lists& lists);
  void listsByOffsets(std::size_t offsets, std::size_t size, Lists& lists);
  std::vector<long long> numbers(NumberType type, std::size_t count, const char* what);
  void beginData(Data data);
  void attribute(const std::string& word);
  void field();
  void array(const std::string& name, std::string_view type, std::size_t components,
             std::size_t tuples);
  void words(const std::string& name, std::size_t components, std::size_t tuples);
  NumberType type(std::string_view name) const;
  void passMetadata();
  bool mayBeGroups(const std::string& name, std::size_t components, std::size_t tuples) const;
  void offerGroups(const VtkGroupRank& rank, std::vector<std::string> groups);
  std::size_t small(const char* what);
  void assemble();

  const std::string& path_;
  MeshCursor cursor_;
  GroupedFaces faces_;
  VtkCells cells_;
  std::optional<VtkGroupRank> group_rank_;  ///< of the array that gave cells_.groups
  bool is_grid_ = false;
  bool has_types_ = false;
  Lists kinds_[4];  ///< POLYDATA: vertices, lines, polygons, strips; a grid: its cells first
  Data data_ = Data::field;
  std::size_t tuples_ = 0;  ///< of the present data
};

void VtkReader::header() {
  if (!cursor_.nextLine().starts_with("# vtk DataFile Version")) {
    cursor_.fail("is no VTK file, which begins with `# vtk DataFile Version`; export it again");
  }
  cursor_.restOfLine();
  cursor_.restOfLine();  // the title, which may be empty
  const std::string encoding = lowerCase(cursor_.nextLine());
  if (encoding != "ascii" && encoding != "binary") {
    cursor_.fail("the third line is ASCII or BINARY; export the file again");
  }
  if (lowerCase(cursor_.word()) != "dataset") cursor_.fail("no DATASET; export the file again");
  const std::string kind = lowerCase(cursor_.word());
  is_grid_ = kind == "unstructured_grid";
  if (!is_grid_ && kind != "polydata") {
    cursor_.fail(
        fmt::format("DATASET {} is not read; save its surface as POLYDATA (in ParaView: "
                    "Extract Surface)",
                    kind));
  }
  if (encoding == "binary") cursor_.setEncoding(Encoding::big);
}

NumberType VtkReader::type(std::string_view name) const {
  const std::optional<NumberType> found = vtkTypeNamed(name);
  if (!found) cursor_.fail(fmt::format("numbers of type `{}` are not read; save as ASCII", name));
  return *found;
}

/// A number in the text between data: a count, which is checked when its numbers are read.
std::size_t VtkReader::small(const char* what) { return cursor_.textNumber(what); }

void VtkReader::statement() {
  const std::string word = lowerCase(cursor_.word());
  constexpr std::string_view kKinds[] = {"vertices", "lines", "polygons", "triangle_strips"};
  const auto* const kind = std::find(std::begin(kKinds), std::end(kKinds), word);
  if (word == "points") {
    points();
  } else if (kind != std::end(kKinds) && !is_grid_) {
    kinds_[kind - std::begin(kKinds)] = lists();
  } else if (word == "cells" && is_grid_) {
    kinds_[0] = lists();
  } else if (word == "cell_types" && is_grid_) {
    const std::size_t count = small("number of types");
    cursor_.restOfLine();
    cells_.types = numbers(i32, count, "cell type");
    has_types_ = true;
  } else if (word == "cell_data") {
    beginData(Data::cell);
  } else if (word == "point_data") {
    beginData(Data::point);
  } else if (word == "metadata") {
    passMetadata();
  } else {
    attribute(word);
  }
}

void VtkReader::beginData(Data data) {
  data_ = data;
  tuples_ = small("number of tuples");
}

void VtkReader::points() {
  const std::size_t count = small("number of points");
  const NumberType kind = type(cursor_.word());
  cursor_.restOfLine();
  cursor_.require(count, "number of points", kind, 3);
  if (!cells_.points.empty()) cursor_.fail("POINTS are there twice; export the file again");
  for (std::size_t k = 0; k < count; ++k) {
    cells_.points.push_back(faces_.addVertex(cursor_.place(kind)));
  }
}

std::vector<long long> VtkReader::numbers(NumberType type, std::size_t count, const char* what) {
  cursor_.require(count, what, type);
  std::vector<long long> found;
  found.reserve(count);
  for (std::size_t k = 0; k < count; ++k) found.push_back(cursor_.integer(type, what));
  return found;
}

VtkReader::Lists VtkReader::lists() {
  const std::size_t count = small("number of cells");
  const std::size_t size = small("size");
  cursor_.restOfLine();
  Lists lists;
  if (cursor_.startsWith("OFFSETS")) {
    listsByOffsets(count, size, lists);
  } else {
    listsByCount(count, size, lists);
  }
  return lists;
}

/// Reads, for each cell, the number of its points and the points.
void VtkReader::listsByCount(std::size_t count, std::size_t size, Lists& lists) {
  const std::vector<long long> all = numbers(i32, size, "point");
  std::size_t at = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const long long length = at < all.size() ? all[at] : -1;
    if (length < 0 || std::size_t(length) > all.size() - at - 1) {
      cursor_.fail(
          fmt::format("cell {} goes beyond the size of its list; export the file again", k));
    }
    const auto first = all.begin() + std::ptrdiff_t(at) + 1;
    lists.connectivity.insert(lists.connectivity.end(), first, first + length);
    lists.ends.push_back(static_cast<long long>(lists.connectivity.size()));
    at += std::size_t(length) + 1;
  }
}

/// Version 5.1: reads the start of each cell's points, and the end; then all points.
void VtkReader::listsByOffsets(std::size_t offsets, std::size_t size, Lists& lists) {
  cursor_.word();
  const NumberType offset_type = type(cursor_.word());
  cursor_.restOfLine();
  lists.ends = numbers(offset_type, offsets, "offset");
  if (!lists.ends.empty()) lists.ends.erase(lists.ends.begin());  // 0
  if (lowerCase(cursor_.word()) != "connectivity") {
    cursor_.fail("no CONNECTIVITY after OFFSETS; export the file again");
  }
  const NumberType kind = type(cursor_.word());
  cursor_.restOfLine();
  lists.connectivity = numbers(kind, size, "point");
}

/// Skips INFORMATION about arrays, up to a blank line.
void VtkReader::passMetadata() {
  cursor_.restOfLine();
  while (!cursor_.restOfLine().empty()) {
  }
}

void VtkReader::attribute(const std::string& word) {
  const bool is_text = cursor_.encoding() == Encoding::text;
  if (word == "field") return field();
  if (word == "scalars") {
    const std::string name = percentDecoded(cursor_.word());
    const std::string kind(cursor_.word());
    const std::string_view components = cursor_.restOfLine();
    std::size_t count = 1;
    if (!components.empty()) {
      if (components.size() != 1 || components[0] < '1' || components[0] > '9') {
        cursor_.fail(fmt::format("`{}` is no number of components; correct it", components));
      }
      count = std::size_t(components[0] - '0');
    }
    if (cursor_.startsWith("LOOKUP_TABLE")) cursor_.restOfLine();
    return array(name, kind, count, tuples_);
  }
  const std::string name = percentDecoded(cursor_.word());
  if (word == "lookup_table") {
    const std::size_t size = small("size");
    cursor_.restOfLine();
    return array("", is_text ? "float" : "unsigned_char", 4, size);
  }
  if (word == "color_scalars") {
    const std::size_t components = small("number of values");
    cursor_.restOfLine();
    return array("", is_text ? "float" : "unsigned_char", components, tuples_);
  }
  std::size_t components = 0;
  if (word == "vectors" || word == "normals") components = 3;
  if (word == "tensors") components = 9;
  if (word == "tensors6") components = 6;
  if (word == "global_ids" || word == "pedigree_ids") components = 1;
  if (word == "texture_coordinates") components = small("dimension");
  if (components == 0) {
    cursor_.fail(fmt::format("`{}` is no part of a VTK file that is read; export it again", word));
  }
  const std::string kind(cursor_.word());
  cursor_.restOfLine();
  array(word == "pedigree_ids" || word == "global_ids" ? "" : name, kind, components, tuples_);
}

void VtkReader::field() {
  cursor_.word();  // its name
  const std::size_t arrays = small("number of arrays");
  for (std::size_t k = 0; k < arrays; ++k) {
    std::string name = percentDecoded(cursor_.word());
    if (name == "METADATA") {
      passMetadata();
      name = percentDecoded(cursor_.word());
    }
    const std::size_t components = small("number of components");
    const std::size_t tuples = small("number of tuples");
    const std::string kind(cursor_.word());
    cursor_.restOfLine();
    array(name, kind, components, tuples);
  }
}

bool VtkReader::mayBeGroups(const std::string& name, std::size_t components,
                            std::size_t tuples) const {
  return data_ == Data::cell && components == 1 && tuples == tuples_ && groupArrayRank(name);
}

/// Keeps the groups with the best rank of those offered.
void VtkReader::offerGroups(const VtkGroupRank& rank, std::vector<std::string> groups) {
  if (group_rank_ && *group_rank_ <= rank) return;
  group_rank_ = rank;
  cells_.groups = std::move(groups);
}

void VtkReader::array(const std::string& name, std::string_view kind, std::size_t components,
                      std::size_t tuples) {
  if (lowerCase(kind) == "string") return words(name, components, tuples);
  const NumberType number = type(kind);
  cursor_.require(tuples, "number of tuples", number, components);
  if (!mayBeGroups(name, components, tuples) || isFraction(number)) {
    return cursor_.skip(number, components * tuples);
  }
  const std::vector<long long> values = numbers(number, tuples, "group");
  std::vector<std::string> groups;
  groups.reserve(values.size());
  for (const long long value : values) groups.push_back(vtkGroupName(name, value));
  offerGroups(vtkGroupRank(name, false, allDiffer(values)), std::move(groups));
}

/// Reads words, one a line.
void VtkReader::words(const std::string& name, std::size_t components, std::size_t tuples) {
  if (cursor_.encoding() != Encoding::text) {
    cursor_.fail(
        fmt::format("array {} has words, which are read from ASCII files alone; save as "
                    "ASCII",
                    name));
  }
  cursor_.require(tuples, "number of tuples", u8, components);
  const bool may_be_groups = mayBeGroups(name, components, tuples);
  std::vector<std::string> groups;
  for (std::size_t k = 0; k < components * tuples; ++k) {
    const std::string word = percentDecoded(cursor_.restOfLine());
    if (may_be_groups) groups.push_back(word.empty() ? "unnamed" : word);
  }
  if (may_be_groups) offerGroups(vtkGroupRank(name, true, false), std::move(groups));
}

void VtkReader::assemble() {
  constexpr long long kTypes[] = {kVtkPolyVertex, kVtkPolyLine, kVtkPolygon, kVtkStrip};
  if (is_grid_ && !has_types_ && !kinds_[0].ends.empty()) {
    throw InputError(path_ + ": cells have no CELL_TYPES; export it again");
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const auto shift = static_cast<long long>(cells_.connectivity.size());
    cells_.connectivity.insert(cells_.connectivity.end(), kinds_[k].connectivity.begin(),
                               kinds_[k].connectivity.end());
    for (const long long end : kinds_[k].ends) {
      if (end < 0 || end > static_cast<long long>(kinds_[k].connectivity.size())) {
        throw InputError(path_ + ": offsets of cells go beyond their points; export it again");
      }
      cells_.ends.push_back(shift + end);
    }
    if (!is_grid_) cells_.types.resize(cells_.ends.size(), kTypes[k]);
  }
}

}  // namespace

Scene loadVtk(const std::string& path, const SceneOptions& options) {
  return VtkReader(path, readWholeFile(path), options).read();
}

}  // namespace radiosity
