#include "scene/inp_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>

#include "base/input_file.h"
#include "base/parse.h"
#include "scene/mesh_cursor.h"
#include "scene/text.h"

namespace radiosity {

namespace {

constexpr int kMostIncludes = 16;  // a file that includes itself never ends
/// Sets of sets of sets: what no person means is refused before it fills the memory.
constexpr std::size_t kMostMembers = std::size_t(1) << 24U;

/// Shells, membranes, rigid and other surfaces by their types, and flat solids, as which Gmsh
/// writes faces. Nothing for volumes, beams and the rest.
std::optional<ElementShape> shapeNamed(const std::string& type) {
  struct Family {
    ElementShape shape;
    std::vector<std::string_view> types;
  };
  static const std::array<Family, 5> kFamilies = {{
      {{2, 3, 3},
       {"s3", "s3r", "s3rs", "s3t", "s3rt", "stri3", "ds3", "m3d3", "r3d3", "sfm3d3", "cps3",
        "cpe3", "dc2d3"}},
      {{2, 3, 6}, {"s6", "stri65", "ds6", "m3d6", "sfm3d6", "cps6", "cpe6", "dc2d6"}},
      {{2, 4, 4},
       {"s4", "s4r", "s4rs", "s4rsw", "s4r5", "s4t", "s4rt", "ds4", "m3d4", "m3d4r", "r3d4",
        "sfm3d4", "sfm3d4r", "cps4", "cps4r", "cpe4", "cpe4r", "dc2d4"}},
      {{2, 4, 8},
       {"s8", "s8r", "s8r5", "s8rt", "ds8", "m3d8", "m3d8r", "sfm3d8", "sfm3d8r", "cps8", "cps8r",
        "cpe8", "cpe8r", "dc2d8"}},
      {{2, 4, 9}, {"s9r5", "m3d9", "m3d9r"}},
  }};
  for (const Family& family : kFamilies) {
    const auto& types = family.types;
    if (std::find(types.begin(), types.end(), type) != types.end()) return family.shape;
  }
  return std::nullopt;
}

/// Volumes of solids, heat transfer (D), acoustics (A) and fluids (F), whatever the letters behind
/// their number of nodes (C3D20RBR) say of their integration.
std::optional<ElementShape> volumeNamed(const std::string& type) {
  static constexpr std::array<ElementShape, 9> kShapes = {{{3, 4, 4},
                                                           {3, 5, 5},
                                                           {3, 6, 6},
                                                           {3, 8, 8},
                                                           {3, 4, 10},
                                                           {3, 5, 13},
                                                           {3, 6, 15},
                                                           {3, 8, 20},
                                                           {3, 8, 27}}};
  for (const std::string_view family : {"c3d", "dc3d", "dcc3d", "ac3d", "f3d", "fc3d", "q3d"}) {
    if (!type.starts_with(family)) continue;
    const std::size_t begin = family.size();
    std::size_t end = begin;
    while (end < type.size() && type[end] >= '0' && type[end] <= '9') ++end;
    const std::optional<long long> nodes =
        parseInteger(std::string_view(type).substr(begin, end - begin));
    for (const ElementShape& shape : kShapes) {
      if (nodes && *nodes == shape.nodes) return shape;
    }
  }
  return std::nullopt;
}

/// A line `*WORD, NAME=VALUE, NAME`: names in small letters.
struct Keyword {
  std::string word;
  std::map<std::string, std::string> parameters;

  std::string get(const std::string& name) const {
    const auto found = parameters.find(name);
    return found == parameters.end() ? std::string() : found->second;
  }
  bool has(const std::string& name) const { return parameters.contains(name); }
};

Keyword keywordOf(std::string_view line) {
  const std::vector<std::string_view> parts = splitAt(line, ',');
  Keyword keyword;
  keyword.word = lowerCase(trimmed(parts[0].substr(1)));
  for (std::size_t k = 1; k < parts.size(); ++k) {
    const std::size_t equals = parts[k].find('=');
    const std::string name = lowerCase(trimmed(parts[k].substr(0, equals)));
    if (name.empty()) continue;
    std::string_view value;
    if (equals != std::string_view::npos) value = trimmed(parts[k].substr(equals + 1));
    if (value.size() > 1 && value.front() == '"' && value.back() == '"') {
      value = value.substr(1, value.size() - 2);
    }
    keyword.parameters[name] = value;
  }
  return keyword;
}

class InpScanner {
 public:
  explicit InpScanner(InpElements kind) : kind_(kind) {}
  InpScan run(const std::string& path) {
    file(path, 0);
    notes_.appendTo(scan_.notes);
    return std::move(scan_);
  }

 private:
  void file(const std::string& path, int depth);
  void keyword(const Keyword& keyword, int depth);
  void refuseKeyword(const Keyword& keyword) const;
  void noteMaker(const Keyword& keyword);
  void include(const Keyword& keyword, int depth);
  void beginElements();
  void beginSurface();
  void data(std::string_view line);
  void node(const std::vector<std::string_view>& fields);
  void element(const std::vector<std::string_view>& fields, const ElementShape& shape);
  void sides(const std::vector<std::string_view>& fields);
  void members(const std::vector<std::string_view>& fields);
  void range(const std::vector<std::string_view>& fields);
  void addMember(const InpRange& range);
  std::size_t setNamed(const std::string& name);
  long long integer(std::string_view word, const char* what) const;
  [[noreturn]] void fail(const std::string& what) const { cursor_->fail(what); }
  std::string where() const { return fmt::format("{}:{}", *file_, cursor_->line()); }

  InpElements kind_;
  const MeshCursor* cursor_ = nullptr;  ///< of the file at hand
  const std::string* file_ = nullptr;
  InpScan scan_;
  Keyword current_;                    ///< whose data lines come
  std::optional<ElementShape> shape_;  ///< of the elements that come
  bool unfinished_ = false;            ///< the last element goes on in the next line
  std::size_t set_ = 0;                ///< that *ELSET or *ELEMENT adds to
  bool in_set_ = false;
  std::size_t member_count_ = 0;
  bool has_system_ = false;                       ///< coordinates of nodes are another system's
  std::map<std::string, std::size_t> set_index_;  ///< by name in small letters
  FeatureNotes notes_;
};

void InpScanner::file(const std::string& path, int depth) {
  const std::string content = readWholeFile(path);
  if (content.find('\0') != std::string::npos) {
    throw InputError(path + ": is not a text file; export it as CalculiX or Abaqus input");
  }
  MeshCursor cursor(path, content);
  const MeshCursor* outer_cursor = std::exchange(cursor_, &cursor);
  const std::string* outer_file = std::exchange(file_, &path);
  while (!cursor.atEnd()) {
    const std::string_view line = cursor.nextLine();
    if (line.starts_with("**")) continue;
    if (!line.starts_with('*')) {
      data(line);
      continue;
    }
    std::string whole(line);
    while (whole.ends_with(',') && !cursor.atEnd()) whole += cursor.nextLine();
    keyword(keywordOf(whole), depth);
  }
  if (unfinished_) {
    throw InputError(scan_.elements.back().where +
                     ": the last element has too few nodes; correct it, or the file is cut off");
  }
  cursor_ = outer_cursor;
  file_ = outer_file;
}

void InpScanner::refuseKeyword(const Keyword& keyword) const {
  if (keyword.word == "instance") {
    fail(
        "parts and instances are not read; write the input without them (in Abaqus/CAE: Model, "
        "Edit Attributes, Do not use parts and assemblies in input files)");
  }
  if (keyword.word == "nmap") fail("*NMAP moves nodes and is not read; write nodes where they lie");
  if (keyword.word == "node" && has_system_) {
    fail("nodes in the coordinates of *SYSTEM are not read; write x, y, z");
  }
  const bool lists = keyword.word == "node" || keyword.word == "element" || keyword.word == "elset";
  if (lists && keyword.has("input")) {
    fail(fmt::format("*{} from another file is not read; use *INCLUDE", keyword.word));
  }
  if (keyword.word == "node" && keyword.has("system") && lowerCase(keyword.get("system")) != "r") {
    fail("cylindrical and spherical coordinates are not read; write x, y, z");
  }
}

void InpScanner::keyword(const Keyword& keyword, int depth) {
  if (unfinished_) fail("the element before it has too few nodes; correct it");
  refuseKeyword(keyword);
  if (keyword.word == "include") return include(keyword, depth);
  current_ = keyword;
  in_set_ = false;
  if (keyword.word == "system") has_system_ = false;
  noteMaker(keyword);
  if (keyword.word == "element") beginElements();
  if (keyword.word == "surface") beginSurface();
  if (keyword.word == "elset") {
    if (keyword.get("elset").empty()) fail("*ELSET names no set; add ELSET=NAME");
    set_ = setNamed(keyword.get("elset"));
    scan_.sets[set_].chosen = true;
    in_set_ = true;
  }
}

/// What is made of shells is missed in the scene, and nodes may be missed by a shell: both are for
/// the reader to tell.
void InpScanner::noteMaker(const Keyword& keyword) {
  const std::string& word = keyword.word;
  if (word == "ngen" || word == "nfill" || word == "ncopy") scan_.node_makers.push_back(word);
  if (word != "elgen" && word != "elcopy") return;
  scan_.makers.push_back({word, {}, where()});
  const auto copied = set_index_.find(lowerCase(keyword.get("old set")));
  if (word == "elcopy" && copied != set_index_.end()) {
    scan_.makers.back().originals = scan_.sets[copied->second].members;
  }
}

void InpScanner::include(const Keyword& keyword, int depth) {
  const std::string name = keyword.get("input");
  if (name.empty()) fail("*INCLUDE names no file; add INPUT=FILE");
  if (depth == kMostIncludes) {
    fail(fmt::format("more than {} files include one another; write them into one", kMostIncludes));
  }
  const std::string path = (std::filesystem::path(*file_).parent_path() / name).string();
  const std::string why = whyNotAFile(path);
  if (!why.empty()) fail(fmt::format("*INCLUDE of {}: {}", path, why));
  file(path, depth + 1);
}

void InpScanner::beginElements() {
  const std::string type = current_.get("type");
  if (type.empty()) fail("*ELEMENT names no type; add TYPE=S3 or another");
  const bool wants_volumes = kind_ == InpElements::volumes;
  const std::optional<ElementShape> volume = volumeNamed(lowerCase(type));
  shape_ = wants_volumes ? volume : shapeNamed(lowerCase(type));
  if (!shape_) {
    scan_.left_out.push_back(type);
    if (volume) ++scan_.volumes;
    notes_.add(wants_volumes
                   ? "elements that are no volumes (beams, springs, ...) are left out, of type"
                   : "elements that are no faces (volumes, beams, ...) are left out, of type",
               type, Severity::warning);
  }
  if (current_.get("elset").empty()) return;
  set_ = setNamed(current_.get("elset"));  // also of no faces: sets of sets may name it
  in_set_ = shape_.has_value();
}

/// Surfaces of nodes, and those that others are cut of, say nothing of sides.
void InpScanner::beginSurface() {
  const std::string type = lowerCase(current_.get("type"));
  if (kind_ != InpElements::volumes || (!type.empty() && type != "element")) {
    current_.word.clear();
  } else {
    scan_.surfaces.push_back({current_.get("name"), {}});
  }
}

std::size_t InpScanner::setNamed(const std::string& name) {
  const auto [place, is_new] = set_index_.try_emplace(lowerCase(name), scan_.sets.size());
  if (is_new) scan_.sets.push_back({name, {}, false});
  return place->second;
}

void InpScanner::data(std::string_view line) {
  std::vector<std::string_view> fields = splitAt(line, ',');
  for (std::string_view& field : fields) field = trimmed(field);
  if (fields.back().empty()) fields.pop_back();  // a comma at the end of the line
  if (current_.word == "node") {
    node(fields);
  } else if (current_.word == "element" && shape_) {
    element(fields, *shape_);
  } else if (current_.word == "elset") {
    current_.has("generate") ? range(fields) : members(fields);
  } else if (current_.word == "surface") {
    sides(fields);
  } else if (current_.word == "elgen" && !fields.empty()) {
    const long long original = integer(fields[0], "element number");
    scan_.makers.back().originals.push_back({original, original, 1});
  } else if (current_.word == "system") {
    has_system_ = true;
  }
}

long long InpScanner::integer(std::string_view word, const char* what) const {
  const std::optional<long long> value = parseInteger(word);
  if (!value) fail(fmt::format("{} `{}` is not a whole number; correct it", what, word));
  return *value;
}

void InpScanner::node(const std::vector<std::string_view>& fields) {
  if (fields.empty()) return;
  InpNode node{integer(fields[0], "node number"), Vec3(0.0), where()};
  for (std::size_t k = 1; k < std::min<std::size_t>(fields.size(), 4); ++k) {
    if (fields[k].empty()) continue;  // a coordinate that is left out is 0
    std::string word = lowerCase(fields[k]);
    std::replace(word.begin(), word.end(), 'd', 'e');  // Fortran's exponents
    const std::optional<double> value = parseNumber(word);
    if (!value) {
      fail(
          fmt::format("coordinate `{}` is not a finite number; write it as 1.5 with a decimal "
                      "point",
                      fields[k]));
    }
    node.place[int(k) - 1] = *value;
  }
  scan_.nodes.push_back(std::move(node));
}

void InpScanner::element(const std::vector<std::string_view>& fields, const ElementShape& shape) {
  if (fields.empty()) return;
  std::size_t k = 0;
  if (!unfinished_) {
    const long long number = integer(fields[k++], "element number");
    scan_.elements.push_back({number, shape, {}, where()});
    if (in_set_) addMember({number, number, 1});
  }
  std::vector<long long>& nodes = scan_.elements.back().nodes;
  for (; k < fields.size(); ++k) nodes.push_back(integer(fields[k], "node number"));
  const auto expected = std::size_t(shape.nodes);
  if (nodes.size() > expected) {
    fail(fmt::format("element {} has {} nodes, its type has {}; correct it",
                     scan_.elements.back().number, nodes.size(), expected));
  }
  unfinished_ = nodes.size() < expected;
}

/// "12, S3" or "SET, S3". Other labels (SPOS, EDGE1) are no sides of volumes.
void InpScanner::sides(const std::vector<std::string_view>& fields) {
  if (fields.size() != 2) return;
  const std::string label = lowerCase(fields[1]);
  if (label.size() != 2 || label[0] != 's' || label[1] < '1' || label[1] > '6') return;
  InpSides sides{{}, label[1] - '0'};
  if (const std::optional<long long> number = parseInteger(fields[0])) {
    sides.elements.push_back({*number, *number, 1});
  } else if (const auto found = set_index_.find(lowerCase(fields[0])); found != set_index_.end()) {
    sides.elements = scan_.sets[found->second].members;
  }
  scan_.surfaces.back().sides.push_back(std::move(sides));
}

void InpScanner::members(const std::vector<std::string_view>& fields) {
  for (const std::string_view field : fields) {
    if (const std::optional<long long> number = parseInteger(field)) {
      addMember({*number, *number, 1});
      continue;
    }
    const auto found = set_index_.find(lowerCase(field));
    if (found == set_index_.end()) {
      fail(fmt::format("`{}` is neither an element nor a set that came before; correct it", field));
    }
    if (found->second == set_) continue;
    for (const InpRange& range : scan_.sets[found->second].members) addMember(range);
  }
}

void InpScanner::range(const std::vector<std::string_view>& fields) {
  if (fields.size() < 2 || fields.size() > 3) {
    fail(fmt::format("GENERATE takes first, last and step, not {} numbers; correct the line",
                     fields.size()));
  }
  const InpRange range{integer(fields[0], "first element"), integer(fields[1], "last element"),
                       fields.size() > 2 ? integer(fields[2], "step") : 1};
  if (range.step <= 0 || range.last < range.first) {
    fail(
        "the last element is not less than the first, and the step is 1 or more; correct the line");
  }
  addMember(range);
}

void InpScanner::addMember(const InpRange& range) {
  if (++member_count_ > kMostMembers) {
    fail(fmt::format("its element sets have more than {} members; write them without one another",
                     kMostMembers));
  }
  scan_.sets[set_].members.push_back(range);
}

}  // namespace

InpScan scanInp(const std::string& path, InpElements kind) { return InpScanner(kind).run(path); }

}  // namespace radiosity
