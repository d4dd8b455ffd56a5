// Reads CalculiX and Abaqus: faces are shells, or the skin of volumes; element sets are surfaces.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "scene/inp/inp_scan.h"
#include "scene/readers.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// The most elements in all sets together. A number in a set may stand for many elements.
constexpr std::size_t kMostVisits = std::size_t(1) << 28U;

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw InputError(fmt::format("{}: {}", where, what));
}

void requireElements(const std::string& path, const InpScan& scan) {
  if (scan.hasElements()) return;
  if (!scan.hasNodes() && scan.left_out.empty()) {
    fail(path,
         "is no input of CalculiX or Abaqus: it has neither *NODE nor *ELEMENT; check the name");
  }
  std::vector<std::string> types(scan.left_out);
  std::sort(types.begin(), types.end());
  types.erase(std::unique(types.begin(), types.end()), types.end());
  fail(path, fmt::format("no faces, {}; write the surfaces as shells (TYPE=S3, S4, S6, S8)",
                         types.empty() ? "nodes alone"
                                       : "elements of type " + joinNames(types) + " alone"));
}

/// The scene to which the bodies of a file are added.
struct InpScene {
  const std::string& path;
  GroupedFaces faces;
  FeatureNotes notes;
  std::size_t visits = 0;    ///< elements visited for numbers in sets
  std::size_t elements = 0;  ///< of the bodies added so far
};

/// Adds the elements of one body.
class BodyReader {
 public:
  BodyReader(const InpBody& body, InpScene& scene) : body_(body), scene_(scene) {}

  void read() {
    addNodes();
    sortElements();
    refuseMadeElements();
    assignSets();
    nameSides();
    for (std::size_t e = 0; e < body_.elements.size(); ++e) addElement(e);
    scene_.elements += body_.elements.size();
  }

 private:
  /// A shell is there once for each side that a surface names, the negative one turned over; once
  /// if none is named.
  void addElement(std::size_t e) {
    const InpElement& element = body_.elements[e];
    std::vector<Index> corners;
    corners.reserve(element.nodes.size());
    for (const long long number : element.nodes) corners.push_back(vertexOf(number, element));
    const auto add = [&](const NamedSide& side) {
      scene_.faces.addElement(element.shape, corners, groupOf(e, side),
                              std::size_t(element.number));
    };
    const NamedSide positive = sideOf(e, InpSides::kPositive);
    const NamedSide negative = sideOf(e, InpSides::kNegative);
    if (positive.surface != nullptr || negative.surface == nullptr) add(positive);
    if (negative.surface == nullptr) return;
    std::reverse(corners.begin(), corners.begin() + element.shape.corners);
    add(negative);
    scene_.notes.add("shells are turned over where *SURFACE names their negative side (SNEG)",
                     negative.surface->name);
  }

  /// The surface that a side is in, and how many sides it has in this body.
  struct NamedSide {
    const InpSurface* surface = nullptr;
    std::size_t size = 0;
  };

  NamedSide sideOf(std::size_t e, int side) const {
    const auto found = named_.find({Index(e), side});
    return found == named_.end() ? NamedSide() : found->second;
  }

  /// A surface's name goes before that of a set, unless the set is smaller.
  std::string groupOf(std::size_t e, const NamedSide& side) const {
    const bool in_set = set_of_[e] != kNone;
    if (side.surface != nullptr && (!in_set || side.size <= size_of_set_[e])) {
      return side.surface->name;
    }
    if (in_set) return body_.sets[set_of_[e]].name;
    return body_.name.empty() ? "unnamed" : body_.name;
  }

  void refuseMadeElements() {
    for (const InpMaker& maker : body_.makers) {
      if (elementsOf(maker.originals).empty()) continue;
      fail(maker.where, fmt::format("*{} makes elements of others and is not read; write out nodes "
                                    "and elements where they lie",
                                    maker.keyword));
    }
  }

  void addNodes() {
    for (const InpNode& node : body_.nodes) {
      if (nodes_.add(node.number, scene_.faces.addVertex(node.place))) continue;
      fail(node.where, fmt::format("node {} is there twice; number nodes anew", node.number));
    }
  }

  Index vertexOf(long long number, const InpElement& element) const {
    const Index vertex = nodes_.find(number);
    if (vertex == kNone) {
      const std::string cure =
          body_.node_makers.empty()
              ? "correct it"
              : fmt::format("*{} makes nodes and is not read, write out nodes where they lie",
                            body_.node_makers.front());
      fail(element.where,
           fmt::format("node {} of element {} does not exist; {}", number, element.number, cure));
    }
    return vertex;
  }

  void sortElements() {
    for (std::size_t e = 0; e < body_.elements.size(); ++e) order_.push_back(Index(e));
    std::sort(order_.begin(), order_.end(),
              [&](Index a, Index b) { return number(a) < number(b); });
    for (std::size_t k = 1; k < order_.size(); ++k) {
      if (number(order_[k]) != number(order_[k - 1])) continue;
      fail(body_.elements[std::max(order_[k], order_[k - 1])].where,
           fmt::format("element {} is there twice; number elements anew", number(order_[k])));
    }
  }
  long long number(Index e) const { return body_.elements[e].number; }

  /// The elements with these numbers, each once, in any order.
  std::vector<Index> elementsOf(const std::vector<InpRange>& numbers) {
    std::vector<Index> found;
    for (const InpRange& range : numbers) {
      auto at = std::lower_bound(order_.begin(), order_.end(), range.first,
                                 [&](Index e, long long first) { return number(e) < first; });
      for (; at != order_.end() && number(*at) <= range.last; ++at) {
        if (++scene_.visits > kMostVisits) {
          throw InputError(scene_.path +
                           ": its element sets overlap too often; write them without one "
                           "another");
        }
        if ((number(*at) - range.first) % range.step == 0) found.push_back(*at);
      }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  /// The rank of a set: an element of several sets belongs to the most specific. Meshers put all
  /// elements into a set and name the set of a line *ELEMENT themselves, while people write *ELSET.
  /// So a set of *ELSET goes first, unless it has all elements; then the smaller set; then the
  /// first.
  std::tuple<int, std::size_t> rankOf(const InpSet& set, std::size_t size) const {
    const bool is_all = size == body_.elements.size();
    return {is_all ? 2 : set.chosen ? 0 : 1, size};
  }

  void assignSets() {
    const std::size_t count = body_.elements.size();
    set_of_.assign(count, kNone);
    std::vector<std::tuple<int, std::size_t>> rank(count);
    std::vector<bool> loses(body_.sets.size(), false);
    for (std::size_t s = 0; s < body_.sets.size(); ++s) {
      if (body_.sets[s].internal) continue;
      const std::vector<Index> found = elementsOf(body_.sets[s].members);
      const auto rank_here = rankOf(body_.sets[s], found.size());
      for (const Index e : found) {
        const bool is_first = set_of_[e] == kNone;
        const bool wins = is_first || rank_here < rank[e];
        if (!is_first) loses[wins ? set_of_[e] : s] = true;
        if (!wins) continue;
        set_of_[e] = Index(s);
        rank[e] = rank_here;
      }
    }
    for (const auto& [order, size] : rank) size_of_set_.push_back(size);
    for (std::size_t s = 0; s < loses.size(); ++s) {
      if (!loses[s]) continue;
      scene_.notes.add(
          "sets that have elements in common with smaller sets, or with those of *ELSET, and "
          "leave these to them",
          body_.sets[s].name);
    }
  }

  /// Names the sides in *SURFACE; a side in several belongs to the first.
  void nameSides() {
    for (const InpSurface& surface : body_.surfaces) {
      std::vector<NamedSide*> own;
      for (const InpSides& sides : surface.sides) {
        for (const Index e : elementsOf(sides.elements)) {
          const bool is_shell = body_.elements[e].shape.dimension == 2;
          if (is_shell != (sides.side >= InpSides::kPositive)) continue;
          const auto [place, is_new] = named_.try_emplace({e, sides.side}, NamedSide{&surface, 0});
          if (is_new) {
            own.push_back(&place->second);
            if (!is_shell)
              scene_.faces.nameSide(Index(scene_.elements) + e, sides.side, surface.name);
          } else if (place->second.surface->name != surface.name) {
            scene_.notes.add(
                "surfaces that have sides in common with earlier ones, and leave these to them",
                surface.name);
          }
        }
      }
      for (NamedSide* side : own) side->size = own.size();
    }
  }

  const InpBody& body_;
  InpScene& scene_;
  NodeNumbers nodes_;
  std::vector<Index> order_;                          ///< elements, sorted by their numbers
  std::vector<Index> set_of_;                         ///< by element; kNone: in no set
  std::vector<std::size_t> size_of_set_;              ///< by element
  std::map<std::pair<Index, int>, NamedSide> named_;  ///< by element and side
};

}  // namespace

Scene loadInp(const std::string& path, const SceneOptions& options) {
  InpScan scan = scanInp(path, InpElements::faces);
  // If there are faces, a mesher made them from the sides of volumes.
  if (!scan.hasElements() && scan.volumes > 0) scan = scanInp(path, InpElements::volumes);
  requireElements(path, scan);
  InpScene scene{path, GroupedFaces(path, options), {}, 0, 0};
  scene.faces.scene().notes = scan.notes;
  for (const InpBody& body : scan.bodies) BodyReader(body, scene).read();
  scene.notes.appendTo(scene.faces.scene().notes);
  return scene.faces.finish("write the surfaces as shells");
}

}  // namespace radiosity
