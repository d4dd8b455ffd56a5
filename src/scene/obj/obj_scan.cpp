#include "scene/obj/obj_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>

#include "base/parse.h"
#include "radiosity/spelling.h"
#include "scene/obj/camera_text.h"
#include "scene/scene_builder.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// Statements that do not affect geometry or material: smoothing and display attributes.
constexpr std::array<std::string_view, 14> kDisplayStatements = {
    "s",      "bevel",  "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj",
    "usemap", "maplib", "mg",       "t",        "vw",  "call",       "csh"};

/// Free-form curves and surfaces.
constexpr std::array<std::string_view, 16> kFreeForm = {
    "vp",   "deg",  "bmat", "step", "cstype", "curv", "curv2", "surf",
    "parm", "trim", "hole", "scrv", "sp",     "end",  "con",   "ctech"};

template <class Names>
bool contains(const Names& names, std::string_view word) {
  return std::find(names.begin(), names.end(), word) != names.end();
}

/// Stands for the colour of a vertex that has none.
const Vec3 kNoColour(std::numeric_limits<double>::quiet_NaN());

/// One of the three lists to which a corner refers.
struct Referenced {
  const char* what;
  std::size_t count = 0;         ///< elements so far
  long long largest = 0;         ///< highest positive index used
  std::size_t largest_line = 0;  ///< its line
};

class ObjScanner {
 public:
  ObjScanner(const std::string& file, bool with_colours)
      : file_(file), with_colours_(with_colours) {}

  void statement(std::size_t line, std::string_view text);
  ObjScan finish();

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_, line_, what));
  }
  void comment(std::string_view text);
  void numbers(Referenced& list, std::size_t least, std::size_t most, std::string_view meaning);
  void colour(std::size_t count);
  void face();
  void corner(std::string_view word);
  Index index(std::string_view word, std::string_view corner, Referenced& list);
  void noteMissing(const Referenced& list, std::size_t line);
  void object(std::string name);
  void material(std::string_view name);
  void noteNameless(const std::string& what);
  void other(std::string_view keyword);
  Index currentObject();

  const std::string& file_;
  bool with_colours_;
  std::size_t line_ = 0;
  std::vector<std::string_view> words_;  ///< of the current statement
  Referenced vertices_{"vertex"};
  Referenced texcoords_{"texture coordinate"};
  Referenced normals_{"normal"};
  ObjScan scan_;
  std::map<std::string, Index> object_index_;
  std::map<std::string, Index> material_index_;
  std::string object_name_{kUnnamed};  ///< of the last `o`
  std::string name_{kUnnamed};         ///< of the last `o` or `g`
  Index object_ = kNone;               ///< index of name_, once a face needs it
  Index material_ = kNone;
  bool material_used_ = false;  ///< by a face since its usemtl
  bool inheriting_ = false;     ///< a new object began after that face
  std::set<std::pair<Index, Index>> inherited_;
  std::string coloured_;  ///< the object whose vertices' colours were noted last
  FeatureNotes ignored_;
};

void ObjScanner::statement(std::size_t line, std::string_view text) {
  line_ = line;
  if (text[0] == '#') return comment(trimmed(text.substr(1)));
  words_ = splitWords(text);
  const std::string_view keyword = words_[0];
  const std::string_view rest = trimmed(text.substr(keyword.size()));
  if (keyword == "o") return object(std::string(rest.empty() ? kUnnamed : rest));
  // A bare `g` and "g default" end a group without starting one: back to the object.
  if (keyword == "g") return object(rest.empty() ? object_name_ : std::string(rest));
  if (keyword == "usemtl") return material(rest);
  if (keyword == "mtllib") {
    if (rest.empty()) return noteNameless("mtllib names no file and is not used");
    scan_.libraries.emplace_back(line, rest);
    return;
  }
  // A comment may follow on the same line.
  const auto hash = std::find_if(words_.begin(), words_.end(),
                                 [](std::string_view word) { return word[0] == '#'; });
  words_.erase(hash, words_.end());
  if (keyword == "v") return numbers(vertices_, 3, 7, "a vertex has 3 coordinates");
  if (keyword == "vt") return numbers(texcoords_, 1, 3, "a texture coordinate has 1 to 3 numbers");
  if (keyword == "vn") return numbers(normals_, 3, 3, "a normal has 3 coordinates");
  if (keyword == "f") return face();
  other(keyword);
}

void ObjScanner::comment(std::string_view text) {
  // A comment that only happens to begin with "camera" is ignored.
  constexpr std::string_view kCamera = "camera";
  if (!text.starts_with(kCamera) || text.find('=') == std::string_view::npos) return;
  try {
    Camera camera = readCamera(text.substr(kCamera.size()), ' ');
    camera.name = fmt::format("camera{}", scan_.cameras.size() + 1);
    scan_.cameras.push_back(camera);
  } catch (const InputError& error) {
    scan_.notes.push_back(
        {Severity::warning, fmt::format("{}:{}: not used, {}", file_, line_, error.what())});
  }
}

void ObjScanner::numbers(Referenced& list, std::size_t least, std::size_t most,
                         std::string_view meaning) {
  const std::size_t count = words_.size() - 1;
  if (count < least || count > most) {
    fail(fmt::format("{}, not {}; correct the line", meaning, count));
  }
  Vec3 value{0.0};
  for (std::size_t k = 0; k < count; ++k) {
    const std::optional<double> number = parseNumber(words_[k + 1]);
    if (!number && &list == &vertices_) {
      fail(fmt::format("`{}` is not a finite number; write it as 1.5 with a decimal point",
                       words_[k + 1]));
    }
    if (!number) {
      // Exporters write NaN for slivers. We do not use normals; faces may lack texture coordinates.
      ignored_.add(fmt::format("a {} that is no finite number is not used, in", list.what), name_,
                   Severity::warning);
    }
    if (k < 3) value[int(k)] = number.value_or(std::numeric_limits<double>::quiet_NaN());
  }
  if (++list.count >= kNone) fail(fmt::format("more than {} of one kind; split the scene", kNone));
  if (&list == &vertices_) {
    scan_.vertices.push_back(value);
    if (count >= 6) colour(count);
  }
  if (&list == &texcoords_) scan_.texcoords.emplace_back(value);
}

/// Three numbers after the coordinates of the present vertex.
void ObjScanner::colour(std::size_t count) {
  if (!with_colours_) {
    if (coloured_ == name_) return;
    coloured_ = name_;
    return ignored_.add(fmt::format("colours of vertices are not used, since the format does not "
                                    "say what they mean ({} or linear does), in",
                                    spelled("vertex_colours", "srgb")),
                        name_);
  }
  if (count != 6) {
    fail(
        fmt::format("a vertex with a colour has 6 numbers, not {}; correct the line, or leave out "
                    "{}",
                    count, spelled("vertex_colours")));
  }
  Vec3 value{0.0};
  for (std::size_t k = 0; k < 3; ++k) {
    value[int(k)] = parseNumber(words_[4 + k]).value_or(-1);
    if (value[int(k)] >= 0 && value[int(k)] <= 1) continue;
    fail(fmt::format("the colour {} is outside 0 to 1; scale it, or leave out {}", words_[4 + k],
                     spelled("vertex_colours")));
  }
  scan_.colours.resize(scan_.vertices.size(), kNoColour);
  scan_.colours.back() = value;
}

void ObjScanner::face() {
  const std::size_t corners = words_.size() - 1;
  if (corners < 3) {
    ignored_.add("faces of fewer than 3 corners have no area and are left out, in", name_,
                 Severity::warning);
    return;
  }
  for (std::size_t k = 1; k <= corners; ++k) corner(words_[k]);
  scan_.faces.push_back({line_, currentObject(), material_});
  scan_.face_offset.push_back(scan_.corners.size());
  if (inheriting_ && material_ != kNone && inherited_.emplace(object_, material_).second) {
    scan_.inherited.emplace_back(object_, material_);
  }
  material_used_ = true;
}

void ObjScanner::corner(std::string_view word) {
  const std::vector<std::string_view> parts = splitAt(word, '/');
  if (parts.size() > 3) fail(fmt::format("`{}` is not a corner v, v/vt or v/vt/vn", word));
  scan_.corners.push_back(index(parts[0], word, vertices_));
  // `1/`, `1//` and `1/2/` leave out optional parts of a corner.
  const bool textured = parts.size() > 1 && !parts[1].empty();
  scan_.corner_texcoord.push_back(textured ? index(parts[1], word, texcoords_) : kNone);
  if (parts.size() > 2 && !parts[2].empty()) index(parts[2], word, normals_);
}

/// An index from 0; only finish() checks it against the end of the file. kNone for an optional part
/// that is missing.
Index ObjScanner::index(std::string_view word, std::string_view corner, Referenced& list) {
  const std::optional<long long> value = parseInteger(word);
  if (!value) {
    fail(fmt::format("`{}` is not a corner v, v/vt or v/vt/vn of whole numbers; correct it",
                     corner));
  }
  const bool before = *value < 0 && -*value > static_cast<long long>(list.count);
  if (&list != &vertices_ && (*value == 0 || before)) {
    noteMissing(list, line_);
    return kNone;
  }
  if (*value == 0) fail(fmt::format("`{}`: a {} is counted from 1, not 0", corner, list.what));
  if (before) {
    fail(fmt::format("{} {} does not exist, there are {} before this line; correct the face",
                     list.what, *value, list.count));
  }
  if (*value > list.largest) {
    list.largest = *value;
    list.largest_line = line_;
  }
  return Index(*value > 0 ? *value - 1 : static_cast<long long>(list.count) + *value);
}

void ObjScanner::object(std::string name) {
  if (words_[0] == "o") object_name_ = name;
  if (name == "default" && words_[0] == "g") name = object_name_;
  name_ = std::move(name);
  object_ = kNone;
  inheriting_ = material_used_;
}

void ObjScanner::noteNameless(const std::string& what) {
  ignored_.add(what + ", line", std::to_string(line_), Severity::warning);
}

void ObjScanner::material(std::string_view name) {
  if (name.empty()) {
    name = kUnnamed;
    noteNameless(fmt::format("usemtl names no material, {} is taken", kUnnamed));
  }
  const auto [place, is_new] =
      material_index_.try_emplace(std::string(name), Index(scan_.materials.size()));
  if (is_new) scan_.materials.emplace_back(name);
  material_ = place->second;
  material_used_ = false;
  inheriting_ = false;
}

void ObjScanner::other(std::string_view keyword) {
  if (contains(kDisplayStatements, keyword)) return;
  if (keyword == "l" || keyword == "p") {
    ignored_.add("lines and points have no area and are left out, in", name_);
  } else if (contains(kFreeForm, keyword)) {
    ignored_.add("free-form curves and surfaces are left out (export polygons), in", name_,
                 Severity::warning);
  } else {
    ignored_.add("unknown OBJ statements are left out",
                 fmt::format("`{}` in line {}", keyword, line_), Severity::warning);
  }
}

Index ObjScanner::currentObject() {
  if (object_ == kNone) {
    const auto [place, is_new] = object_index_.try_emplace(name_, Index(scan_.objects.size()));
    if (is_new) scan_.objects.push_back(name_);
    object_ = place->second;
  }
  return object_;
}

void ObjScanner::noteMissing(const Referenced& list, std::size_t line) {
  ignored_.add(fmt::format("{}s that do not exist are not used, in line", list.what),
               std::to_string(line), Severity::warning, 3);
}

/// Checks all references. Normals are not used, and a face without texture coordinates has the
/// colour of its material.
ObjScan ObjScanner::finish() {
  const auto goesBeyond = [](const Referenced& list) {
    return list.largest > static_cast<long long>(list.count);
  };
  if (goesBeyond(vertices_)) {
    line_ = vertices_.largest_line;
    fail(fmt::format("vertex {} does not exist, the file has {}; correct the face or export again",
                     vertices_.largest, vertices_.count));
  }
  if (goesBeyond(normals_)) noteMissing(normals_, normals_.largest_line);
  for (std::size_t f = 0; f < scan_.faces.size() && goesBeyond(texcoords_); ++f) {
    for (std::size_t k = scan_.face_offset[f]; k < scan_.face_offset[f + 1]; ++k) {
      Index& texcoord = scan_.corner_texcoord[k];
      if (texcoord == kNone || texcoord < texcoords_.count) continue;
      texcoord = kNone;
      noteMissing(texcoords_, scan_.faces[f].line);
    }
  }
  if (scan_.faces.empty()) {
    throw InputError(fmt::format(
        "{}: no faces (no `f` lines); export the scene with its meshes as polygons", file_));
  }
  if (!scan_.colours.empty()) scan_.colours.resize(scan_.vertices.size(), kNoColour);
  ignored_.appendTo(scan_.notes);
  return std::move(scan_);
}

}  // namespace

void forEachStatement(std::string_view text,
                      const std::function<void(std::size_t, std::string_view)>& visit) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);                    // byte order mark
  const char line_end = text.find('\n') == std::string_view::npos ? '\r' : '\n';  // of old Macs
  std::string joined;
  std::size_t line = 0;
  std::size_t first_line = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(line_end, begin), text.size());
    std::string_view piece = trimmed(text.substr(begin, end - begin));
    begin = end + 1;
    ++line;
    if (joined.empty()) first_line = line;
    // A comment that ends in a Windows path must not swallow the next line.
    const bool goes_on = piece.ends_with('\\') && !(joined.empty() && piece.starts_with('#'));
    if (goes_on) piece.remove_suffix(1);
    joined += piece;
    if (goes_on && begin < text.size()) {
      joined += ' ';
      continue;
    }
    const std::string_view statement = trimmed(joined);
    if (!statement.empty()) visit(first_line, statement);
    joined.clear();
  }
}

ObjScan scanObj(const std::string& file, std::string_view text, bool with_colours) {
  if (text.find('\0') != std::string_view::npos) {
    throw InputError(file + ": is not a text file; export it as Wavefront OBJ");
  }
  ObjScanner scanner(file, with_colours);
  forEachStatement(text, [&](std::size_t line, std::string_view s) { scanner.statement(line, s); });
  return scanner.finish();
}

}  // namespace radiosity
