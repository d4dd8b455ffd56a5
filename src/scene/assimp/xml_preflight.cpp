#include "scene/assimp/xml_preflight.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <string_view>

#include "base/input_file.h"
#include "radiosity/base.h"
#include "scene/text.h"

namespace radiosity {

namespace {

constexpr int kDeepestElement = 200;  // as in JSON
constexpr double kMostCopies = 1e6;

/// The number of elements that each element stands for, with those below it and those to which it
/// refers: <instance_node url="#id">.
class References {
 public:
  explicit References(const std::string& path) : path_(path) {}

  void check(const pugi::xml_node& root) {
    for (pugi::xml_node at = root; !at.empty(); at = next(at, root)) {
      ++elements_;
      checkIndices(at);
      if (const pugi::xml_attribute id = at.attribute("id")) named_.emplace(id.value(), at);
    }
    const double all = count(root, 0);
    if (all > elements_ + kMostCopies) {
      fail(
          fmt::format("its references stand for {:.2g} elements, over {:.2g}; export it without "
                      "instances, or as .glb",
                      all, kMostCopies));
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", path_, what));
  }

  /// Checks <p>: Assimp never gets past a character that is not a digit.
  void checkIndices(const pugi::xml_node& text) const {
    if (std::strcmp(text.parent().name(), "p") != 0) return;
    const std::string_view value = text.value();
    const std::size_t at = value.find_first_not_of("+-0123456789 \t\r\n");
    if (at == std::string_view::npos) return;
    const std::string_view word = value.substr(at, value.find_first_of(" \t\r\n", at) - at);
    fail(fmt::format("<p> holds `{}`, which is no index of a corner; export it again",
                     onOneLine(word.substr(0, 20))));
  }

  [[noreturn]] void failForDepth(const pugi::xml_node& element) const {
    fail(
        fmt::format("<{}> is nested more than {} deep, references included; export it again, or "
                    "as .glb",
                    element.name(), kDeepestElement));
  }

  /// The element after `at` in the file's order; empty after the last one below `root`.
  pugi::xml_node next(pugi::xml_node at, const pugi::xml_node& root) const {
    if (const pugi::xml_node child = at.first_child()) return child;
    while (at != root && at.next_sibling().empty()) at = at.parent();
    return at == root ? pugi::xml_node() : at.next_sibling();
  }

  pugi::xml_node referredBy(const pugi::xml_node& element) const {
    if (std::strcmp(element.name(), "instance_node") != 0) return {};
    std::string_view name = element.attribute("url").value();
    if (name.starts_with('#')) name.remove_prefix(1);
    const auto found = name.empty() ? named_.end() : named_.find(name);
    return found == named_.end() ? pugi::xml_node() : found->second;
  }

  double count(const pugi::xml_node& element, int depth) {
    if (depth > kDeepestElement) failForDepth(element);
    const auto [known, is_new] = known_.try_emplace(element, Known{});
    Known& here = known->second;
    if (is_new) {
      const pugi::xml_node referred = referredBy(element);
      double sum = 1;
      int height = 0;
      const auto add = [&](const pugi::xml_node& below) {
        sum += count(below, depth + 1);
        height = std::max(height, 1 + known_[below].height);
      };
      for (const pugi::xml_node child : element.children()) add(child);
      if (!referred.empty()) add(referred);
      here = {sum, height, false};
    } else if (here.open) {
      fail(fmt::format("<{}> `{}` refers to itself; take the reference out", element.name(),
                       element.attribute("id").value()));
    } else if (depth + here.height > kDeepestElement) {
      failForDepth(element);
    }
    return here.elements;
  }

  struct Known {
    double elements = 0;
    int height = 0;  ///< of the elements below it
    bool open = true;
  };
  const std::string& path_;
  double elements_ = 0;
  std::map<std::string_view, pugi::xml_node> named_;
  std::map<pugi::xml_node, Known> known_;
};

}  // namespace

pugi::xml_document checkXml(const std::string& path) {
  const std::string content = readWholeFile(path);
  pugi::xml_document document;
  // If the file is not XML, Assimp will say so: it has the same parser.
  if (!document.load_buffer(content.data(), content.size())) return {};
  References(path).check(document.document_element());
  return document;
}

}  // namespace radiosity
