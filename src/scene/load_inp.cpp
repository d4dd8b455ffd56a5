// CalculiX and Abaqus: shells are faces, or the skin of volumes; element sets are surfaces.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "scene/inp_scan.h"
#include "scene/readers.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// Numbers that sets name may be those of many elements each; nobody means more in all.
constexpr std::size_t kMostVisits = std::size_t(1) << 28U;

class InpReader {
 public:
  InpReader(const std::string& path, const InpScan& scan, const SceneOptions& options)
      : path_(path), scan_(scan), faces_(path, options) {
    faces_.scene().notes = scan.notes;
  }

  Scene read() {
    requireElements();
    addNodes();
    sortElements();
    refuseMadeElements();
    assignSets();
    nameSides();
    std::vector<Index> corners;
    for (std::size_t e = 0; e < scan_.elements.size(); ++e) {
      const InpElement& element = scan_.elements[e];
      corners.clear();
      for (const long long number : element.nodes) corners.push_back(vertexOf(number, element));
      faces_.addElement(element.shape, corners,
                        set_of_[e] == kNone ? "unnamed" : scan_.sets[set_of_[e]].name,
                        std::size_t(element.number));
    }
    notes_.appendTo(faces_.scene().notes);
    return faces_.finish("write the surfaces as shells");
  }

 private:
  [[noreturn]] static void fail(const std::string& where, const std::string& what) {
    throw InputError(fmt::format("{}: {}", where, what));
  }

  void requireElements() const {
    if (!scan_.elements.empty()) return;
    if (scan_.nodes.empty() && scan_.left_out.empty()) {
      fail(path_,
           "is no input of CalculiX or Abaqus: it has neither *NODE nor *ELEMENT; check the name");
    }
    std::vector<std::string> types(scan_.left_out);
    std::sort(types.begin(), types.end());
    types.erase(std::unique(types.begin(), types.end()), types.end());
    fail(path_, fmt::format("no faces, {}; write the surfaces as shells (TYPE=S3, S4, S6, S8)",
                            types.empty() ? "nodes alone"
                                          : "elements of type " + joinNames(types) + " alone"));
  }

  void refuseMadeElements() {
    for (const InpMaker& maker : scan_.makers) {
      if (elementsOf(maker.originals).empty()) continue;
      fail(maker.where, fmt::format("*{} makes elements of others and is not read; write out nodes "
                                    "and elements where they lie",
                                    maker.keyword));
    }
  }

  void addNodes() {
    for (const InpNode& node : scan_.nodes) {
      if (nodes_.add(node.number, faces_.addVertex(node.place))) continue;
      fail(node.where, fmt::format("node {} is there twice; number nodes anew", node.number));
    }
  }

  Index vertexOf(long long number, const InpElement& element) const {
    const Index vertex = nodes_.find(number);
    if (vertex == kNone) {
      const std::string cure =
          scan_.node_makers.empty()
              ? "correct it"
              : fmt::format("*{} makes nodes and is not read, write out nodes where they lie",
                            scan_.node_makers.front());
      fail(element.where,
           fmt::format("node {} of element {} does not exist; {}", number, element.number, cure));
    }
    return vertex;
  }

  void sortElements() {
    for (std::size_t e = 0; e < scan_.elements.size(); ++e) order_.push_back(Index(e));
    std::sort(order_.begin(), order_.end(),
              [&](Index a, Index b) { return number(a) < number(b); });
    for (std::size_t k = 1; k < order_.size(); ++k) {
      if (number(order_[k]) != number(order_[k - 1])) continue;
      fail(scan_.elements[std::max(order_[k], order_[k - 1])].where,
           fmt::format("element {} is there twice; number elements anew", number(order_[k])));
    }
  }
  long long number(Index e) const { return scan_.elements[e].number; }

  /// Elements of these numbers, each once, in any order.
  std::vector<Index> elementsOf(const std::vector<InpRange>& numbers) {
    std::vector<Index> found;
    for (const InpRange& range : numbers) {
      auto at = std::lower_bound(order_.begin(), order_.end(), range.first,
                                 [&](Index e, long long first) { return number(e) < first; });
      for (; at != order_.end() && number(*at) <= range.last; ++at) {
        if (++visits_ > kMostVisits) {
          throw InputError(path_ +
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

  /// An element of several sets counts to the one that says most of it. Meshers put all elements
  /// in a set, and name those of a line *ELEMENT by themselves, where a person writes *ELSET: such
  /// a set goes first, unless it has all elements; then the smaller one; then the one that came
  /// first.
  std::tuple<int, std::size_t> rankOf(const InpSet& set, std::size_t size) const {
    const bool is_all = size == scan_.elements.size();
    return {is_all ? 2 : set.chosen ? 0 : 1, size};
  }

  void assignSets() {
    const std::size_t count = scan_.elements.size();
    set_of_.assign(count, kNone);
    std::vector<std::tuple<int, std::size_t>> rank(count);
    std::vector<bool> loses(scan_.sets.size(), false);
    for (std::size_t s = 0; s < scan_.sets.size(); ++s) {
      const std::vector<Index> found = elementsOf(scan_.sets[s].members);
      const auto rank_here = rankOf(scan_.sets[s], found.size());
      for (const Index e : found) {
        const bool is_first = set_of_[e] == kNone;
        const bool wins = is_first || rank_here < rank[e];
        if (!is_first) loses[wins ? set_of_[e] : s] = true;
        if (!wins) continue;
        set_of_[e] = Index(s);
        rank[e] = rank_here;
      }
    }
    for (std::size_t s = 0; s < loses.size(); ++s) {
      if (!loses[s]) continue;
      notes_.add(
          "sets that have elements in common with smaller sets, or with those of *ELSET, and "
          "leave these to them",
          scan_.sets[s].name);
    }
  }

  /// Sides of volumes that *SURFACE names; a side of several counts to the first.
  void nameSides() {
    std::map<std::pair<Index, int>, std::string> groups;
    for (const InpSurface& surface : scan_.surfaces) {
      for (const InpSides& sides : surface.sides) {
        for (const Index e : elementsOf(sides.elements)) {
          const auto [place, is_new] = groups.try_emplace({e, sides.side}, surface.name);
          if (is_new || place->second == surface.name) continue;
          notes_.add(
              "surfaces that have sides in common with earlier ones, and leave these to them",
              surface.name);
        }
      }
    }
    faces_.setSideGroups(std::move(groups));
  }

  const std::string& path_;
  const InpScan& scan_;
  GroupedFaces faces_;
  NodeNumbers nodes_;
  std::vector<Index> order_;   ///< elements by their numbers
  std::vector<Index> set_of_;  ///< by element; kNone: in no set
  std::size_t visits_ = 0;
  FeatureNotes notes_;
};

}  // namespace

Scene loadInp(const std::string& path, const SceneOptions& options) {
  InpScan scan = scanInp(path, InpElements::faces);
  // Where there are faces, they are what a mesher made of the sides of volumes.
  if (scan.elements.empty() && scan.volumes > 0) scan = scanInp(path, InpElements::volumes);
  return InpReader(path, scan, options).read();
}

}  // namespace radiosity
