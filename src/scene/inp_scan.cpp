#include "scene/inp_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <map>
#include <optional>

#include "base/input_file.h"
#include "base/parse.h"
#include "scene/inp_keyword.h"
#include "scene/mesh_cursor.h"
#include "scene/text.h"

namespace radiosity {

namespace {

constexpr int kMostIncludes = 16;  // a file that includes itself would never end
/// The most members of sets: nested sets that no person means are refused before they fill memory.
constexpr std::size_t kMostMembers = std::size_t(1) << 24U;

/// The place of an instance of a part.
struct InstancePlacement {
  Vec3 shift{0.0};
  Vec3 from{0.0};  ///< axis of the turn
  Vec3 to{0.0};
  double degrees = 0;

  /// Shifts a point, then turns it about the axis (Rodrigues).
  Vec3 of(const Vec3& place) const {
    const Vec3 shifted = place + shift;
    if (degrees == 0) return shifted;
    const Vec3 axis = glm::normalize(to - from);
    const Vec3 arm = shifted - from;
    const double angle = glm::radians(degrees);
    return from + std::cos(angle) * arm + std::sin(angle) * glm::cross(axis, arm) +
           (1 - std::cos(angle)) * glm::dot(axis, arm) * axis;
  }
};

class InpScanner {
 public:
  explicit InpScanner(InpElements kind) : kind_(kind), body_(&scan_.bodies.emplace_back()) {}
  InpScan run(const std::string& path) {
    file(path, 0);
    if (!parts_.empty() && scan_.bodies.size() == 1) {
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
  void beginSet();
  void beginSurface();
  void beginPart(const InpKeyword& keyword);
  void beginInstance(const InpKeyword& keyword);
  void place(const std::vector<std::string_view>& fields);
  void endInstance();
  /// The instance with this name in small letters, or null.
  InpBody* instanceNamed(const std::string& name);
  double coordinate(std::string_view field) const;
  void data(std::string_view line);
  void node(const std::vector<std::string_view>& fields);
  void element(const std::vector<std::string_view>& fields, const ElementShape& shape);
  void sides(const std::vector<std::string_view>& fields);
  void members(const std::vector<std::string_view>& fields);
  void addMembersNamed(std::string_view field);
  void range(const std::vector<std::string_view>& fields);
  void addMember(InpSet& set, const InpRange& range);
  /// The name of a set of the present instance, in small letters.
  std::string ownName(const std::string& name) const;
  std::size_t setNamed(const std::string& name);
  static std::size_t setIn(InpBody& body, const std::string& name);
  void addSides(InpBody& body, std::string_view members, int side);
  long long integer(std::string_view word, const char* what) const;
  [[noreturn]] void fail(const std::string& what) const { cursor_->fail(what); }
  std::string where() const { return fmt::format("{}:{}", *file_, cursor_->line()); }

  InpElements kind_;
  const MeshCursor* cursor_ = nullptr;  ///< of the present file
  const std::string* file_ = nullptr;
  InpScan scan_;
  InpBody* body_;                         ///< receives all that is read
  std::map<std::string, InpBody> parts_;  ///< by name in small letters
  bool in_part_ = false;
  bool in_instance_ = false;
  std::vector<InstancePlacement> placements_;  ///< of the present instance: none or one
  std::size_t placing_lines_ = 0;              ///< lines of its placement that were read
  InpBody* set_body_ = nullptr;                ///< the body of set_
  InpKeyword current_;                         ///< the keyword of the data lines that follow
  std::optional<ElementShape> shape_;          ///< of the elements that follow
  bool unfinished_ = false;                    ///< the last element continues in the next line
  std::size_t set_ = 0;                        ///< the set to which *ELSET or *ELEMENT adds
  bool in_set_ = false;
  std::size_t member_count_ = 0;
  bool has_system_ = false;  ///< coordinates of nodes are in another system
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
    keyword(inpKeyword(whole), depth);
  }
  if (unfinished_) {
    throw InputError(body_->elements.back().where +
                     ": the last element has too few nodes; correct it, or the file is cut off");
  }
  cursor_ = outer_cursor;
  file_ = outer_file;
}

void InpScanner::refuseKeyword(const InpKeyword& keyword) const {
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

void InpScanner::keyword(const InpKeyword& keyword, int depth) {
  if (unfinished_) fail("the element before it has too few nodes; correct it");
  refuseKeyword(keyword);
  if (keyword.word == "include") return include(keyword, depth);
  current_ = keyword;
  in_set_ = false;
  if (keyword.word == "system") has_system_ = false;
  noteMaker(keyword);
  if (keyword.word == "element") beginElements();
  if (keyword.word == "surface") beginSurface();
  if (keyword.word == "elset") beginSet();
  if (keyword.word == "part") beginPart(keyword);
  if (keyword.word == "instance") beginInstance(keyword);
  if (keyword.word == "end part") {
    in_part_ = false;
    body_ = &scan_.bodies.front();
  }
  if (keyword.word == "end instance") endInstance();
}

/// Begins a set. A set of the assembly belongs to the instance whose elements it lists.
void InpScanner::beginSet() {
  if (current_.get("elset").empty()) fail("*ELSET names no set; add ELSET=NAME");
  InpBody* const outer = body_;
  if (current_.has("instance")) {
    const std::string instance = current_.get("instance");
    body_ = instanceNamed(lowerCase(instance));
    if (body_ == nullptr) {
      fail(fmt::format("there is no instance `{}` before it; correct it", instance));
    }
  }
  set_ = setNamed(current_.get("elset"));
  set_body_ = body_;
  body_ = outer;
  set_body_->sets[set_].chosen = true;
  if (current_.has("internal")) set_body_->sets[set_].internal = true;
  in_set_ = true;
}

void InpScanner::beginPart(const InpKeyword& keyword) {
  if (in_part_ || in_instance_) fail("a part begins within another; end that with *END PART");
  const auto [place, is_new] = parts_.try_emplace(lowerCase(keyword.get("name")));
  if (!is_new) fail(fmt::format("part `{}` is there twice; rename one", keyword.get("name")));
  in_part_ = true;
  body_ = &place->second;
}

void InpScanner::beginInstance(const InpKeyword& keyword) {
  if (in_part_ || in_instance_) fail("an instance begins within another; add *END INSTANCE");
  const std::string name = keyword.get("name");
  const auto part = parts_.find(lowerCase(keyword.get("part")));
  if (part == parts_.end()) {
    fail(fmt::format("instance `{}` is of part `{}`, which does not come before it; correct it",
                     name, keyword.get("part")));
  }
  if (instanceNamed(lowerCase(name)) != nullptr) {
    fail(fmt::format("instance `{}` is there twice; rename one", name));
  }
  body_ = &scan_.bodies.emplace_back(part->second);
  body_->name = name;
  body_->set_index.clear();
  for (std::size_t s = 0; s < body_->sets.size(); ++s) {
    body_->sets[s].name = name + "." + body_->sets[s].name;
    body_->set_index[lowerCase(body_->sets[s].name)] = s;
  }
  for (InpSurface& surface : body_->surfaces) surface.name = name + "." + surface.name;
  in_instance_ = true;
  placements_.clear();
  placing_lines_ = 0;
}

/// Reads the placement of an instance: the first line shifts it, the second turns it about an axis
/// through two points.
void InpScanner::place(const std::vector<std::string_view>& fields) {
  const std::size_t expected = placing_lines_ == 0 ? 3 : 7;
  if (placing_lines_ > 1 || fields.size() != expected) {
    fail(
        "an instance is placed by a line of 3 numbers, its shift, and one of 7, two points of an "
        "axis and degrees; correct it");
  }
  std::array<double, 7> values{};
  for (std::size_t k = 0; k < expected; ++k) values[k] = coordinate(fields[k]);
  if (placing_lines_++ == 0) {
    placements_ = {{{values[0], values[1], values[2]}, Vec3(0.0), Vec3(0.0), 0}};
    return;
  }
  InstancePlacement& placement = placements_.front();
  placement.from = {values[0], values[1], values[2]};
  placement.to = {values[3], values[4], values[5]};
  placement.degrees = values[6];
  if (placement.degrees != 0 && placement.from == placement.to) {
    fail("the two points of the axis are the same; correct them");
  }
}

void InpScanner::endInstance() {
  if (!in_instance_) fail("*END INSTANCE ends none; correct it");
  for (const InstancePlacement& placement : placements_) {
    for (InpNode& node : body_->nodes) node.place = placement.of(node.place);
  }
  in_instance_ = false;
  body_ = &scan_.bodies.front();
}

InpBody* InpScanner::instanceNamed(const std::string& name) {
  for (std::size_t k = 1; k < scan_.bodies.size(); ++k) {
    if (lowerCase(scan_.bodies[k].name) == name) return &scan_.bodies[k];
  }
  return nullptr;
}

/// Notes a keyword that makes elements or nodes: the scene would lack such shells, and shells would
/// lack such nodes. The reader reports both.
void InpScanner::noteMaker(const InpKeyword& keyword) {
  const std::string& word = keyword.word;
  if (word == "ngen" || word == "nfill" || word == "ncopy") body_->node_makers.push_back(word);
  if (word != "elgen" && word != "elcopy") return;
  body_->makers.push_back({word, {}, where()});
  const auto copied = body_->set_index.find(ownName(keyword.get("old set")));
  if (word == "elcopy" && copied != body_->set_index.end()) {
    body_->makers.back().originals = body_->sets[copied->second].members;
  }
}

void InpScanner::include(const InpKeyword& keyword, int depth) {
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
  set_ = setNamed(current_.get("elset"));  // also if it has no faces: other sets may name it
  set_body_ = body_;
  in_set_ = shape_.has_value();
}

/// Begins a surface. Surfaces of nodes, and combinations of other surfaces, do not list sides.
void InpScanner::beginSurface() {
  const std::string type = lowerCase(current_.get("type"));
  if (kind_ != InpElements::volumes || (!type.empty() && type != "element")) {
    current_.word.clear();
  } else {
    // A surface of the assembly has a part in each instance.
    const std::string own = in_instance_ ? body_->name + "." : "";
    const auto begin = [&](InpBody& body) {
      body.surfaces.push_back({own + current_.get("name"), {}});
    };
    if (in_part_ || in_instance_) {
      begin(*body_);
    } else {
      for (InpBody& body : scan_.bodies) begin(body);
    }
  }
}

std::size_t InpScanner::setNamed(const std::string& name) {
  return setIn(*body_, in_instance_ ? body_->name + "." + name : name);
}

std::size_t InpScanner::setIn(InpBody& body, const std::string& name) {
  const auto [place, is_new] = body.set_index.try_emplace(lowerCase(name), body.sets.size());
  if (is_new) body.sets.push_back({name, {}});
  return place->second;
}

std::string InpScanner::ownName(const std::string& name) const {
  return lowerCase(in_instance_ ? body_->name + "." + name : name);
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
  } else if (current_.word == "instance" && !fields.empty()) {
    place(fields);
  } else if (current_.word == "elgen" && !fields.empty()) {
    const long long original = integer(fields[0], "element number");
    body_->makers.back().originals.push_back({original, original, 1});
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
    if (fields[k].empty()) continue;  // a missing coordinate is 0
    node.place[int(k) - 1] = coordinate(fields[k]);
  }
  body_->nodes.push_back(std::move(node));
}

double InpScanner::coordinate(std::string_view field) const {
  std::string word = lowerCase(field);
  std::replace(word.begin(), word.end(), 'd', 'e');  // Fortran's exponents
  const std::optional<double> value = parseNumber(word);
  if (!value) {
    fail(fmt::format("coordinate `{}` is not a finite number; write it as 1.5 with a decimal point",
                     field));
  }
  return *value;
}

void InpScanner::element(const std::vector<std::string_view>& fields, const ElementShape& shape) {
  if (fields.empty()) return;
  std::size_t k = 0;
  if (!unfinished_) {
    const long long number = integer(fields[k++], "element number");
    body_->elements.push_back({number, shape, {}, where()});
    if (in_set_) addMember(set_body_->sets[set_], {number, number, 1});
  }
  std::vector<long long>& nodes = body_->elements.back().nodes;
  for (; k < fields.size(); ++k) nodes.push_back(integer(fields[k], "node number"));
  const auto expected = std::size_t(shape.nodes);
  if (nodes.size() > expected) {
    fail(fmt::format("element {} has {} nodes, its type has {}; correct it",
                     body_->elements.back().number, nodes.size(), expected));
  }
  unfinished_ = nodes.size() < expected;
}

/// Reads "12, S3" or "SET, S3". Other labels (SPOS, EDGE1) are not sides of volumes.
void InpScanner::sides(const std::vector<std::string_view>& fields) {
  if (fields.size() != 2) return;
  const std::string label = lowerCase(fields[1]);
  if (label.size() != 2 || label[0] != 's' || label[1] < '1' || label[1] > '6') return;
  const int side = label[1] - '0';
  if (in_part_ || in_instance_) return addSides(*body_, fields[0], side);
  for (InpBody& body : scan_.bodies) addSides(body, fields[0], side);
}

/// `members`: a set or an element of the body; "INSTANCE.12" if the body is an instance.
void InpScanner::addSides(InpBody& body, std::string_view members, int side) {
  InpSides sides{{}, side};
  const std::string name = lowerCase(members);
  const std::string prefix = lowerCase(body.name) + ".";
  const bool is_element = !body.name.empty() && name.starts_with(prefix);
  const bool is_local = body.name.empty() || in_instance_;
  const std::optional<long long> number =
      parseInteger(is_element ? std::string_view(name).substr(prefix.size()) : members);
  if (number && (is_element || is_local)) {
    sides.elements.push_back({*number, *number, 1});
  } else if (const auto found = body.set_index.find(ownName(name)); found != body.set_index.end()) {
    sides.elements = body.sets[found->second].members;
  }
  if (!sides.elements.empty()) body.surfaces.back().sides.push_back(std::move(sides));
}

void InpScanner::members(const std::vector<std::string_view>& fields) {
  for (const std::string_view field : fields) {
    if (const std::optional<long long> number = parseInteger(field)) {
      addMember(set_body_->sets[set_], {*number, *number, 1});
      continue;
    }
    addMembersNamed(field);
  }
}

/// Adds the members of a set. Sets of the assembly may also have "INSTANCE.12" and "INSTANCE.SET",
/// which go to a set of that instance.
void InpScanner::addMembersNamed(std::string_view field) {
  const std::string name = lowerCase(field);
  const std::size_t dot = name.find('.');
  InpBody* body = dot == std::string::npos ? nullptr : instanceNamed(name.substr(0, dot));
  std::size_t set = set_;
  if (body == nullptr) {
    body = set_body_;
  } else if (body != set_body_) {
    const InpSet& listed = set_body_->sets[set_];
    set = setIn(*body, listed.name);
    body->sets[set].chosen = listed.chosen;
    body->sets[set].internal = listed.internal;
  }
  if (const auto number = parseInteger(std::string_view(name).substr(dot + 1));
      number && dot != std::string::npos) {
    return addMember(body->sets[set], {*number, *number, 1});
  }
  auto found = body->set_index.find(name);
  if (found == body->set_index.end()) found = body->set_index.find(ownName(name));
  if (found == body->set_index.end()) {
    fail(fmt::format("`{}` is neither an element nor a set that came before; correct it", field));
  }
  if (found->second == set) return;
  for (const InpRange& range : body->sets[found->second].members) {
    addMember(body->sets[set], range);
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
  addMember(set_body_->sets[set_], range);
}

void InpScanner::addMember(InpSet& set, const InpRange& range) {
  if (++member_count_ > kMostMembers) {
    fail(fmt::format("its element sets have more than {} members; write them without one another",
                     kMostMembers));
  }
  set.members.push_back(range);
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
