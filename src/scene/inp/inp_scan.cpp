#include "scene/inp/inp_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>
#include <utility>

#include "base/input_file.h"
#include "base/lower_case.h"
#include "base/parse.h"
#include "scene/inp/inp_bodies.h"
#include "scene/inp/inp_keyword.h"
#include "scene/inp/inp_place.h"
#include "scene/inp/inp_sets.h"
#include "scene/inp/inp_sides.h"
#include "scene/mesh_cursor.h"
#include "scene/text.h"

namespace radiosity {

namespace {

constexpr int kMostIncludes = 16;  // a file that includes itself would never end

class InpScanner {
 public:
  explicit InpScanner(InpElements kind) : kind_(kind) {}
  InpScan run(const std::string& path) {
    file(path, 0);
    if (bodies_.hasPartsAlone()) {
      throw InputError(path + ": its parts have no *INSTANCE, so nothing says where they lie");
    }
    notes_.appendTo(scan_.notes);
    return std::move(scan_);
  }

 private:
  void file(const std::string& path, int depth);
  void keyword(const InpKeyword& keyword, int depth);
  void refuseKeyword(const InpKeyword& keyword) const;
  void noteMaker(const InpKeyword& keyword);
  void include(const InpKeyword& keyword, int depth);
  void beginElements();
  void beginSides();
  void data(std::string_view line);
  void node(const std::vector<std::string_view>& fields);
  void element(const std::vector<std::string_view>& fields, const ElementShape& shape);

  InpElements kind_;
  InpPlace at_;
  InpScan scan_;
  InpBodies bodies_{at_, scan_.bodies};
  InpSets sets_{at_, bodies_};
  InpKeyword current_;                 ///< the keyword of the data lines that follow
  std::optional<ElementShape> shape_;  ///< of the elements that follow
  bool unfinished_ = false;            ///< the last element continues in the next line
  bool in_set_ = false;                ///< the elements that follow are members of a set
  bool has_system_ = false;            ///< coordinates of nodes are in another system
  FeatureNotes notes_;
};

/// Whether a text begins like input: with a keyword, a comment or numbers. *INCLUDE may name any
/// file, whose words must not be quoted.
bool looksLikeInp(std::string_view text) {
  const std::string_view line =
      trimmed(text.substr(0, text.find('\n', text.find_first_not_of(" \t\r\n"))));
  if (line.starts_with('*')) {
    return line.size() > 1 &&
           (line[1] == '*' || std::isalpha(static_cast<unsigned char>(line[1])) != 0);
  }
  return line.empty() || parseNumber(inpFields(line)[0]).has_value();
}

void InpScanner::file(const std::string& path, int depth) {
  const std::string content = readWholeFile(path);
  if (depth > 0 && !looksLikeInp(content)) {
    throw InputError(path +
                     ": begins with neither a keyword nor numbers, so it is no input of "
                     "CalculiX or Abaqus; correct the *INCLUDE");
  }
  if (content.find('\0') != std::string::npos) {
    throw InputError(path + ": is not a text file; export it as CalculiX or Abaqus input");
  }
  MeshCursor cursor(path, content);
  const InpPlace outer = std::exchange(at_, {&cursor, &path});
  while (!cursor.atEnd()) {
    const std::string_view line = cursor.nextLine();
    if (line.starts_with("**")) continue;
    if (!line.starts_with('*')) {
      data(line);
      continue;
    }
    std::string whole(line);
    while (whole.ends_with(',') && !cursor.atEnd()) whole += cursor.nextLine();
    keyword(inpKeyword(whole), depth);
  }
  if (unfinished_) {
    throw InputError(bodies_.current().elements.back().where +
                     ": the last element has too few nodes; correct it, or the file is cut off");
  }
  at_ = outer;
}

void InpScanner::refuseKeyword(const InpKeyword& keyword) const {
  if (keyword.word == "nmap")
    at_.fail("*NMAP moves nodes and is not read; write nodes where they lie");
  if (keyword.word == "node" && has_system_) {
    at_.fail("nodes in the coordinates of *SYSTEM are not read; write x, y, z");
  }
  const bool lists = keyword.word == "node" || keyword.word == "element" || keyword.word == "elset";
  if (lists && keyword.has("input")) {
    at_.fail(fmt::format("*{} from another file is not read; use *INCLUDE", keyword.word));
  }
  if (keyword.word == "node" && keyword.has("system") && lowerCase(keyword.get("system")) != "r") {
    at_.fail("cylindrical and spherical coordinates are not read; write x, y, z");
  }
}

void InpScanner::keyword(const InpKeyword& keyword, int depth) {
  if (unfinished_) at_.fail("the element before it has too few nodes; correct it");
  refuseKeyword(keyword);
  if (keyword.word == "include") return include(keyword, depth);
  current_ = keyword;
  in_set_ = false;
  if (keyword.word == "system") has_system_ = false;
  noteMaker(keyword);
  if (keyword.word == "element") beginElements();
  if (keyword.word == "surface") beginSides();
  if (keyword.word == "elset") sets_.begin(keyword);
  if (keyword.word == "part") bodies_.beginPart(keyword);
  if (keyword.word == "instance") bodies_.beginInstance(keyword);
  if (keyword.word == "end part") bodies_.endPart();
  if (keyword.word == "end instance") bodies_.endInstance();
}

/// Notes a keyword that makes elements or nodes: the scene would lack such shells, and shells would
/// lack such nodes. The reader reports both.
void InpScanner::noteMaker(const InpKeyword& keyword) {
  const std::string& word = keyword.word;
  InpBody& body = bodies_.current();
  if (word == "ngen" || word == "nfill" || word == "ncopy") body.node_makers.push_back(word);
  if (word != "elgen" && word != "elcopy") return;
  body.makers.push_back({word, {}, at_.where()});
  const auto copied = body.set_index.find(lowerCase(bodies_.nameIn(body, keyword.get("old set"))));
  if (word == "elcopy" && copied != body.set_index.end()) {
    body.makers.back().originals = body.sets[copied->second].members;
  }
}

void InpScanner::include(const InpKeyword& keyword, int depth) {
  const std::string name = keyword.get("input");
  if (name.empty()) at_.fail("*INCLUDE names no file; add INPUT=FILE");
  if (depth == kMostIncludes) {
    at_.fail(
        fmt::format("more than {} files include one another; write them into one", kMostIncludes));
  }
  const std::string path = (std::filesystem::path(*at_.file).parent_path() / name).string();
  const std::string why = whyNotAFile(path);
  if (!why.empty()) at_.fail(fmt::format("*INCLUDE of {}: {}", path, why));
  file(path, depth + 1);
}

void InpScanner::beginElements() {
  const std::string type = current_.get("type");
  if (type.empty()) at_.fail("*ELEMENT names no type; add TYPE=S3 or another");
  const bool wants_volumes = kind_ == InpElements::volumes;
  const std::optional<ElementShape> volume = inpVolume(lowerCase(type));
  shape_ = wants_volumes ? volume : inpFace(lowerCase(type));
  if (!shape_) {
    scan_.left_out.push_back(type);
    if (volume) ++scan_.volumes;
    notes_.add(wants_volumes
                   ? "elements that are no volumes (beams, springs, ...) are left out, of type"
                   : "elements that are no faces (volumes, beams, ...) are left out, of type",
               type, Severity::warning);
  }
  if (current_.get("elset").empty()) return;
  // Begins the set even if the elements are no faces: other sets may name it.
  sets_.beginIn(bodies_.current(), current_.get("elset"));
  in_set_ = shape_.has_value();
}

/// Begins a surface. Surfaces of nodes, and combinations of other surfaces, do not list sides.
void InpScanner::beginSides() {
  const std::string type = lowerCase(current_.get("type"));
  if (!type.empty() && type != "element") {
    current_.word.clear();
  } else {
    beginSurface(bodies_, current_.get("name"));
  }
}

void InpScanner::data(std::string_view line) {
  const std::vector<std::string_view> fields = inpFields(line);
  if (current_.word == "node") {
    node(fields);
  } else if (current_.word == "element" && shape_) {
    element(fields, *shape_);
  } else if (current_.word == "elset") {
    current_.has("generate") ? sets_.addRange(fields) : sets_.addMembers(fields);
  } else if (current_.word == "surface") {
    addSides(bodies_, fields);
  } else if (current_.word == "instance" && !fields.empty()) {
    bodies_.place(fields);
  } else if (current_.word == "elgen" && !fields.empty()) {
    const long long original = at_.integer(fields[0], "element number");
    bodies_.current().makers.back().originals.push_back({original, original, 1});
  } else if (current_.word == "system") {
    has_system_ = true;
  }
}

void InpScanner::node(const std::vector<std::string_view>& fields) {
  if (fields.empty()) return;
  InpNode node{at_.integer(fields[0], "node number"), Vec3(0.0), at_.where()};
  for (std::size_t k = 1; k < std::min<std::size_t>(fields.size(), 4); ++k) {
    if (fields[k].empty()) continue;  // a missing coordinate is 0
    node.place[int(k) - 1] = at_.coordinate(fields[k]);
  }
  bodies_.current().nodes.push_back(std::move(node));
}

void InpScanner::element(const std::vector<std::string_view>& fields, const ElementShape& shape) {
  if (fields.empty()) return;
  std::size_t k = 0;
  if (!unfinished_) {
    const long long number = at_.integer(fields[k++], "element number");
    bodies_.current().elements.push_back({number, shape, {}, at_.where()});
    if (in_set_) sets_.addElement(number);
  }
  std::vector<long long>& nodes = bodies_.current().elements.back().nodes;
  for (; k < fields.size(); ++k) nodes.push_back(at_.integer(fields[k], "node number"));
  const auto expected = std::size_t(shape.nodes);
  if (nodes.size() > expected) {
    at_.fail(fmt::format("element {} has {} nodes, its type has {}; correct it",
                         bodies_.current().elements.back().number, nodes.size(), expected));
  }
  unfinished_ = nodes.size() < expected;
}

}  // namespace

bool InpScan::hasElements() const {
  return std::any_of(bodies.begin(), bodies.end(),
                     [](const InpBody& body) { return !body.elements.empty(); });
}

bool InpScan::hasNodes() const {
  return std::any_of(bodies.begin(), bodies.end(),
                     [](const InpBody& body) { return !body.nodes.empty(); });
}

InpScan scanInp(const std::string& path, InpElements kind) { return InpScanner(kind).run(path); }

}  // namespace radiosity
