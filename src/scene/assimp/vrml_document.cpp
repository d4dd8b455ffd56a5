#include "scene/assimp/vrml_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>

#include "base/input_file.h"
#include "scene/assimp/x3d_document.h"
#include "scene/text.h"

namespace radiosity {

namespace {

constexpr int kDeepestNode = 200;  // as of X3D's elements

bool isVrmlSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ','; }

bool isNumberLike(std::string_view word) {
  return !word.empty() &&
         (word[0] == '-' || word[0] == '+' || word[0] == '.' || (word[0] >= '0' && word[0] <= '9'));
}

/// Whether a word can be the name of an element or attribute.
bool isXmlName(std::string_view word) {
  const auto isLetter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  return !word.empty() && isLetter(word[0]) && std::ranges::all_of(word, [&](char c) {
    return isLetter(c) || (c >= '0' && c <= '9') || c == '-' || c == '.';
  });
}

class VrmlReader {
 public:
  VrmlReader(const std::string& path, std::string_view text, FeatureNotes& notes)
      : path_(path), text_(text), notes_(notes) {}

  pugi::xml_document read() {
    checkHeader();
    pugi::xml_document document;
    pugi::xml_node scene = document.append_child("X3D").append_child("Scene");
    for (next(); !word_.empty(); next()) {
      if (!statement()) node(scene, 0);
    }
    return document;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", path_, line_, what));
  }

  void checkHeader() const {
    if (text_.starts_with("\x1f\x8b")) {
      throw InputError(
          fmt::format("{0}: is packed by gzip; unpack it: gunzip -c {0} > unpacked.wrl", path_));
    }
    if (text_.starts_with("#VRML V1.0")) {
      fail("VRML 1.0 is not read; export it as VRML 2.0 (VRML97), .x3d or .glb");
    }
    if (!text_.starts_with("#VRML V2.0")) {
      fail("is no VRML file, which begins with #VRML V2.0 utf8; export it");
    }
  }

  /// Moves to the next word, which is empty at the end: a bracket, a string with its quotes, or
  /// anything else up to a space.
  void next() {
    while (at_ < text_.size() && (isVrmlSpace(text_[at_]) || text_[at_] == '#')) {
      if (text_[at_] == '#') at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
      if (at_ < text_.size() && text_[at_] == '\n') ++line_;
      if (at_ < text_.size()) ++at_;
    }
    const std::size_t begin = at_;
    if (at_ < text_.size() && text_[at_] == '"') {
      string();
    } else if (at_ < text_.size() && isBracket(text_[at_])) {
      ++at_;
    } else {
      while (at_ < text_.size() && !isVrmlSpace(text_[at_]) && !isBracket(text_[at_]) &&
             text_[at_] != '"' && text_[at_] != '#') {
        ++at_;
      }
    }
    word_ = text_.substr(begin, at_ - begin);
  }

  static bool isBracket(char c) { return c == '{' || c == '}' || c == '[' || c == ']'; }

  void string() {
    const std::size_t begin_line = line_;
    for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      if (text_[at_] == '\n') ++line_;
      if (text_[at_] == '\\') ++at_;
    }
    if (at_ >= text_.size()) {
      line_ = begin_line;
      fail("a string has no end; export the file again");
    }
    ++at_;
  }

  void expect(std::string_view wanted, const std::string& where) {
    if (word_ == wanted) return;
    fail(fmt::format("`{}` stands where {} needs {}; export the file again", shown(), where,
                     wanted));
  }

  std::string shown() const {
    return word_.empty() ? "the end of the file" : onOneLine(word_.substr(0, 30));
  }

  /// Passes what stands between two brackets; the present word is the first of them.
  void pass(std::string_view opening, std::string_view closing) {
    expect(opening, "this statement");
    for (int depth = 1; depth > 0;) {
      next();
      if (word_.empty()) fail(fmt::format("a {} is missing; export the file again", closing));
      if (word_ == opening) ++depth;
      if (word_ == closing) --depth;
    }
  }

  /// Passes a statement that makes no node; false if the present word begins none.
  bool statement() {
    if (word_ == "ROUTE") {
      for (int k = 0; k < 3; ++k) next();  // FROM TO THERE
      return true;
    }
    if (word_ != "PROTO" && word_ != "EXTERNPROTO") return false;
    const bool is_here = word_ == "PROTO";
    next();
    notes_.add("nodes that the file defines itself (PROTO) are left out", std::string(word_),
               Severity::warning);
    own_.emplace(word_);
    next();
    pass("[", "]");
    next();
    if (is_here) {
      pass("{", "}");
    } else if (word_ == "[") {
      pass("[", "]");
    }
    return true;
  }

  /// Reads a node, of which the present word is the first, into an element of `parent`.
  void node(pugi::xml_node parent, int depth) {
    if (depth > kDeepestNode) {
      fail(fmt::format("nodes are nested more than {} deep; export it again, or as .glb",
                       kDeepestNode));
    }
    if (word_ == "USE") return use(parent);
    std::string name;
    if (word_ == "DEF") {
      next();
      name = word_;
      next();
    }
    if (!isXmlName(word_)) fail(fmt::format("`{}` is no name of a node; export it again", shown()));
    const std::string type(word_);
    pugi::xml_document unseen;
    if (own_.contains(type)) parent = unseen;
    pugi::xml_node element = parent.append_child(type.c_str());
    if (!name.empty()) {
      element.append_attribute("DEF").set_value(name.c_str());
      type_of_[name] = type;
    }
    next();
    if (type == "Script") return pass("{", "}");
    expect("{", type);
    for (next(); word_ != "}"; next()) {
      if (word_.empty()) fail(fmt::format("{} has no end, a }} is missing; export it again", type));
      if (!statement()) field(element, depth);
    }
  }

  void use(pugi::xml_node parent) {
    next();
    const auto type = type_of_.find(word_);
    if (type == type_of_.end()) {
      fail(fmt::format("USE {}: no node before it has that name; export it again", shown()));
    }
    if (own_.contains(type->second)) return;
    parent.append_child(type->second.c_str())
        .append_attribute("USE")
        .set_value(std::string(word_).c_str());
  }

  /// Reads a field, of which the present word is the name.
  void field(pugi::xml_node element, int depth) {
    if (!isXmlName(word_)) {
      fail(fmt::format("`{}` is no name of a field of {}; export it again", shown(),
                       element.name()));
    }
    const std::string name(word_);
    // Geometry for collisions only is not visible.
    pugi::xml_document unseen;
    pugi::xml_node parent = name == "proxy" ? unseen.append_child("proxy") : element;
    next();
    if (word_ == "[") {
      next();
      if (isValue()) return values(element, name, true);
      for (; word_ != "]"; next()) {
        if (word_.empty()) fail(fmt::format("a ] is missing after {}; export it again", name));
        node(parent, depth + 1);
      }
    } else if (isValue()) {
      values(element, name, false);
    } else if (word_ == "NULL") {
      return;
    } else if (word_ == "IS") {
      next();
    } else {
      node(parent, depth + 1);
    }
  }

  bool isValue() const {
    return isNumberLike(word_) || word_.starts_with('"') || word_ == "TRUE" || word_ == "FALSE";
  }

  /// Sets an attribute from the present word on: the values of a list, a string or truth value, or
  /// all numbers that follow.
  void values(pugi::xml_node element, const std::string& name, bool is_list) {
    std::string text;
    if (is_list || isNumberLike(word_)) {
      const auto goesOn = [&] { return is_list ? word_ != "]" : isNumberLike(word_); };
      std::size_t before = at_;
      while (goesOn()) {
        if (!isValue()) {
          fail(fmt::format("`{}` is no value of {}; export the file again", shown(), name));
        }
        if (!text.empty()) text += ' ';
        text += word_;
        before = at_;
        next();
      }
      if (!is_list) goBack(before);
    } else {
      text = word_;
    }
    if (text == "TRUE") text = "true";
    if (text == "FALSE") text = "false";
    // An attribute of one string has no quotes, one of a list of strings has.
    if (!is_list && name != "url") text = withoutQuotes(text);
    if (!element.attribute(name.c_str())) {
      element.append_attribute(name.c_str()).set_value(text.c_str());
    }
  }

  /// Returns to the end of the word before.
  void goBack(std::size_t end) {
    line_ -= std::size_t(
        std::count(text_.begin() + std::ptrdiff_t(end), text_.begin() + std::ptrdiff_t(at_), '\n'));
    at_ = end;
  }

  const std::string& path_;
  std::string_view text_;
  FeatureNotes& notes_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
  std::string_view word_;
  std::map<std::string, std::string, std::less<>> type_of_;  ///< by name
  std::set<std::string, std::less<>> own_;                   ///< types that PROTO makes
};

}  // namespace

pugi::xml_document readVrml(const std::string& path, FeatureNotes& notes) {
  const std::string content = readWholeFile(path);
  return VrmlReader(path, content, notes).read();
}

}  // namespace radiosity
