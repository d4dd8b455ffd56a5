// Reads XML VTK files (Kitware, "VTK File Formats"): .vtp PolyData and .vtu UnstructuredGrid.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <pugixml.hpp>

#include "base/input_file.h"
#include "base/lower_case.h"
#include "base/parse.h"
#include "scene/readers.h"
#include "scene/vtk/vtk_arrays.h"
#include "scene/vtk/vtk_cells.h"

namespace radiosity {

namespace {

class VtkXmlReader {
 public:
  VtkXmlReader(const std::string& path, std::string content, const SceneOptions& options)
      : content_(std::move(content)), faces_(path, options) {
    file_.path = path;
  }

  Scene read() {
    parse();
    const pugi::xml_node root = document_.child("VTKFile");
    header(root);
    const std::string kind = root.attribute("type").value();
    if (kind != "PolyData" && kind != "UnstructuredGrid") {
      fail(
          fmt::format("type `{}` is not read; save its surface as PolyData (in ParaView: Extract "
                      "Surface)",
                      kind));
    }
    const pugi::xml_node data = root.child(kind.c_str());
    group_array_ = groupArray(data);
    std::size_t first = 0;
    const std::string stem = std::filesystem::path(file_.path).stem().string();
    for (const pugi::xml_node piece : data.children("Piece")) {
      const VtkCells cells = kind == "PolyData" ? polygons(piece) : grid(piece);
      addVtkCells(cells, file_.path, stem, first, faces_);
      first += cells.ends.size();
    }
    return faces_.finish("export the surface as polygons");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", file_.path, what));
  }

  void parse();
  void header(const pugi::xml_node& root);
  VtkArray array(const pugi::xml_node& node, std::size_t most) const;
  std::size_t declared(const pugi::xml_node& piece, const std::string& what) const;
  std::size_t cellsOf(const pugi::xml_node& piece) const;
  pugi::xml_node named(const pugi::xml_node& parent, const char* name) const;
  void points(const pugi::xml_node& piece, VtkCells& cells);
  bool mayBeGroups(const pugi::xml_node& node) const;
  std::string groupArray(const pugi::xml_node& data) const;
  void groups(const pugi::xml_node& piece, VtkCells& cells) const;
  void append(const pugi::xml_node& piece, const char* kind, VtkCells& cells) const;
  VtkCells polygons(const pugi::xml_node& piece);
  VtkCells grid(const pugi::xml_node& piece);

  std::string content_;
  VtkFile file_;
  pugi::xml_document document_;
  std::string group_array_;  ///< the array with groups of cells; empty: there is none
  GroupedFaces faces_;
};

/// Parses the file. Raw appended data is not XML, so it is removed first.
void VtkXmlReader::parse() {
  const std::size_t begin = content_.find("<AppendedData");
  std::string text = content_;
  if (begin != std::string::npos) {
    const std::size_t data = content_.find('_', content_.find('>', begin));
    const std::size_t end = content_.rfind("</AppendedData>");
    if (data == std::string::npos || end == std::string::npos || end < data) {
      fail("its appended data is cut off; export it again");
    }
    file_.appended = std::string_view(content_).substr(data + 1, end - data - 1);
    text = content_.substr(0, data) + content_.substr(end);
  }
  const pugi::xml_parse_result result = document_.load_buffer(text.data(), text.size());
  if (!result) {
    fail(fmt::format("is no sound XML (byte {}: {}); export it again", result.offset,
                     result.description()));
  }
  if (!document_.child("VTKFile")) fail("has no element VTKFile; export it again");
}

void VtkXmlReader::header(const pugi::xml_node& root) {
  if (std::string_view(root.attribute("byte_order").value()) == "BigEndian") {
    file_.order = Encoding::big;
  }
  file_.wide_header = std::string_view(root.attribute("header_type").value()) == "UInt64";
  const std::string compressor = root.attribute("compressor").value();
  const std::optional<VtkPacking> packing = vtkPacking(compressor);
  if (!packing) {
    fail(fmt::format("compressor {} is not read; save with zlib or without one", compressor));
  }
  file_.packing = *packing;
  const pugi::xml_node appended = root.child("AppendedData");
  file_.appended_is_raw = std::string_view(appended.attribute("encoding").value()) == "raw";
}

VtkArray VtkXmlReader::array(const pugi::xml_node& node, std::size_t most) const {
  VtkArray array{node.attribute("Name").value(),
                 node.attribute("type").value(),
                 node.attribute("format").as_string("ascii"),
                 node.child_value(),
                 0,
                 most};
  if (array.format == "appended") {
    const auto offset = parseInteger(node.attribute("offset").value());
    if (!offset || *offset < 0) fail(fmt::format("DataArray {} has no offset", array.name));
    array.offset = std::size_t(*offset);
  } else if (array.format != "ascii" && array.format != "binary") {
    fail(fmt::format("DataArray {}: format `{}` is not read; export it again", array.name,
                     array.format));
  }
  return array;
}

/// The number of points or cells that a piece declares; 0 if it says nothing.
std::size_t VtkXmlReader::declared(const pugi::xml_node& piece, const std::string& what) const {
  const std::string key = "NumberOf" + what;
  const std::string text = piece.attribute(key.c_str()).value();
  const auto count = text.empty() ? 0 : parseInteger(text);
  constexpr long long kMost = 1LL << 32;
  if (!count || *count < 0 || *count > kMost) {
    fail(fmt::format("{} `{}` is no number of {}; export it again", key, text, lowerCase(what)));
  }
  return std::size_t(*count);
}

std::size_t VtkXmlReader::cellsOf(const pugi::xml_node& piece) const {
  std::size_t sum = 0;
  for (const char* kind : {"Cells", "Verts", "Lines", "Polys", "Strips"}) {
    sum += declared(piece, kind);
  }
  return sum;
}

pugi::xml_node VtkXmlReader::named(const pugi::xml_node& parent, const char* name) const {
  const pugi::xml_node found = parent.find_child_by_attribute("DataArray", "Name", name);
  if (!found) fail(fmt::format("{} has no DataArray {}; export it again", parent.name(), name));
  return found;
}

void VtkXmlReader::points(const pugi::xml_node& piece, VtkCells& cells) {
  const pugi::xml_node node = piece.child("Points").child("DataArray");
  if (!node) return;  // an empty piece
  const std::vector<double> numbers = vtkNumbers(file_, array(node, 3 * declared(piece, "Points")));
  if (numbers.size() % 3 != 0) fail("its points have no 3 coordinates each; export it again");
  for (std::size_t k = 0; k < numbers.size(); k += 3) {
    cells.points.push_back(faces_.addVertex({numbers[k], numbers[k + 1], numbers[k + 2]}));
  }
}

/// Reads lists of corners: their ends first, which say how many corners there are.
void VtkXmlReader::append(const pugi::xml_node& piece, const char* kind, VtkCells& cells) const {
  const pugi::xml_node lists = piece.child(kind);
  const std::vector<long long> ends =
      vtkIntegers(file_, array(named(lists, "offsets"), declared(piece, kind)));
  const long long last = ends.empty() ? 0 : std::max(0LL, *std::ranges::max_element(ends));
  const std::vector<long long> all =
      vtkIntegers(file_, array(named(lists, "connectivity"), std::size_t(last)));
  const auto shift = static_cast<long long>(cells.connectivity.size());
  cells.connectivity.insert(cells.connectivity.end(), all.begin(), all.end());
  for (const long long end : ends) {
    if (end < 0 || end > static_cast<long long>(all.size())) {
      fail(fmt::format("{}: offset {} goes beyond its points; export it again", kind, end));
    }
    cells.ends.push_back(shift + end);
  }
}

bool VtkXmlReader::mayBeGroups(const pugi::xml_node& node) const {
  const std::string_view type = node.attribute("type").value();
  return groupArrayRank(node.attribute("Name").value()) && !type.starts_with("Float") &&
         node.attribute("NumberOfComponents").as_llong(1) <= 1;
}

/// The array with groups of cells, the same for all pieces: a piece with few cells is not enough to
/// decide.
std::string VtkXmlReader::groupArray(const pugi::xml_node& data) const {
  std::map<std::string, std::vector<long long>> values;  // of all cells; empty for words
  std::vector<VtkArray> arrays;
  for (const pugi::xml_node piece : data.children("Piece")) {
    for (const pugi::xml_node node : piece.child("CellData").children()) {
      if (!mayBeGroups(node)) continue;
      const VtkArray found = array(node, cellsOf(piece));
      const auto [place, is_new] = values.try_emplace(found.name);
      if (is_new) arrays.push_back(found);
      if (found.type == "String") continue;
      const std::vector<long long> here = vtkIntegers(file_, found);
      place->second.insert(place->second.end(), here.begin(), here.end());
    }
  }
  std::string best;
  std::optional<VtkGroupRank> best_rank;
  for (const VtkArray& found : arrays) {
    const auto rank =
        vtkGroupRank(found.name, found.type == "String", allDiffer(values.at(found.name)));
    if (best_rank && *best_rank <= rank) continue;
    best = found.name;
    best_rank = rank;
  }
  return best;
}

void VtkXmlReader::groups(const pugi::xml_node& piece, VtkCells& cells) const {
  const pugi::xml_node node =
      piece.child("CellData").find_child_by_attribute("Name", group_array_.c_str());
  if (group_array_.empty() || !node) return;
  const VtkArray data = array(node, cellsOf(piece));
  if (data.type == "String") {
    cells.groups = vtkWords(file_, data);
    for (std::string& group : cells.groups) {
      if (group.empty()) group = "unnamed";
    }
  } else {
    for (const long long value : vtkIntegers(file_, data)) {
      cells.groups.push_back(vtkGroupName(data.name, value));
    }
  }
  if (cells.groups.size() != cells.ends.size()) {
    fail(fmt::format("DataArray {} has {} values for {} cells; export it again", data.name,
                     cells.groups.size(), cells.ends.size()));
  }
}

VtkCells VtkXmlReader::polygons(const pugi::xml_node& piece) {
  constexpr std::pair<const char*, long long> kKinds[] = {{"Verts", kVtkPolyVertex},
                                                          {"Lines", kVtkPolyLine},
                                                          {"Polys", kVtkPolygon},
                                                          {"Strips", kVtkStrip}};
  // Data of cells are in this order.
  VtkCells cells;
  points(piece, cells);
  for (const auto& [name, type] : kKinds) {
    if (piece.child(name).child("DataArray")) append(piece, name, cells);
    cells.types.resize(cells.ends.size(), type);
  }
  groups(piece, cells);
  return cells;
}

VtkCells VtkXmlReader::grid(const pugi::xml_node& piece) {
  VtkCells cells;
  points(piece, cells);
  const pugi::xml_node lists = piece.child("Cells");
  if (lists.child("DataArray")) {
    append(piece, "Cells", cells);
    cells.types = vtkIntegers(file_, array(named(lists, "types"), cellsOf(piece)));
  }
  groups(piece, cells);
  return cells;
}

}  // namespace

Scene loadVtkXml(const std::string& path, const SceneOptions& options) {
  return VtkXmlReader(path, readWholeFile(path), options).read();
}

}  // namespace radiosity
