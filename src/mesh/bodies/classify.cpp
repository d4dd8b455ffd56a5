#include "mesh/bodies/classify.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "mesh/bodies/bodies.h"
#include "mesh/bodies/hollows.h"
#include "radiosity/spelling.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// The most names in a note.
constexpr std::size_t kFewNames = 8;

Side opposite(Side side) { return side == kAbove ? kBelow : kAbove; }

/// A sheet of the present cell.
struct Layer {
  Index sheet;
  int layers;
  Side front;
  bool two_sided;
  Index component;
  std::array<bool, 2> carries;  ///< by Side: has patches in the file
  std::array<bool, 2> kept;     ///< by Side: of `carries`, those not dropped
  bool outdone = false;         ///< lost a side to a sheet that faces alike
};

class Classifier {
 public:
  Classifier(const Scene& scene, const Arrangement& arrangement, const std::vector<Sheet>& sheets,
             const Components& components, const Winding& winding, const Bodies& bodies,
             const Hollows& hollows, MeshReport& report)
      : scene_(scene),
        arrangement_(arrangement),
        sheets_(sheets),
        components_(components),
        winding_(winding),
        bodies_(bodies),
        hollows_(hollows),
        report_(report) {}

  void run(Index cell, std::vector<VisibleCell>& out);
  void writeNotes();

 private:
  void noteLoneRoom();
  void noteHollows();
  std::vector<Layer> layersOf(const PlaneCell& cell) const;
  bool seesNothing(Index cell, Side side) const;
  void dropContacts(Index cell, std::vector<Layer>& layers) const;
  void dropOutdone(const PlaneCell& cell, Side side, std::vector<Layer>& layers);
  void account(const PlaneCell& cell, const std::vector<Layer>& layers);
  void noteBackToBack(const PlaneCell& cell, const std::vector<Layer>& layers);
  bool wins(const Layer& a, const Layer& b) const;
  Index surfaceOf(const Layer& l) const { return sheets_[l.sheet].surface; }
  const std::string& nameOf(const Layer& l) const { return scene_.surfaces[surfaceOf(l)].name; }

  const Scene& scene_;
  const Arrangement& arrangement_;
  const std::vector<Sheet>& sheets_;
  const Components& components_;
  const Winding& winding_;
  const Bodies& bodies_;
  const Hollows& hollows_;
  MeshReport& report_;
  std::map<std::pair<std::string, std::string>, double> outdone_;       ///< (loser, winner): m^2
  std::map<std::pair<std::string, std::string>, double> back_to_back_;  ///< m^2
  std::map<std::string, double> in_hollows_;                            ///< m^2
};

std::vector<Layer> Classifier::layersOf(const PlaneCell& cell) const {
  std::vector<Layer> out;
  for (const auto& [sheet, layers] : cell.cover) {
    const Sheet& s = sheets_[sheet];
    Layer l{sheet, layers, s.facing > 0 ? kAbove : kBelow, false, components_.of_sheet[sheet],
            {},    {}};
    l.two_sided = scene_.materials[scene_.surfaces[s.surface].material].two_sided;
    l.carries[l.front] = true;
    l.carries[opposite(l.front)] = l.two_sided;
    l.kept = l.carries;
    out.push_back(l);
  }
  return out;
}

bool Classifier::seesNothing(Index cell, Side side) const {
  return bodies_.isWithinAny(cell, side) || hollows_.isDark(cell, side) ||
         std::any_of(bodies_.rooms().begin(), bodies_.rooms().end(),
                     [&](Index room) { return winding_.of(room, cell, side) == 0; });
}

/// Drops the skin of a solid where a sheet faces it from within the solid: the two are in contact,
/// and the solid stands on that sheet.
void Classifier::dropContacts(Index cell, std::vector<Layer>& layers) const {
  for (Layer& skin : layers) {
    const bool outward_above = sheets_[skin.sheet].facing * components_.outward[skin.sheet] > 0;
    const Side out = outward_above ? kAbove : kBelow;
    const Side in = opposite(out);
    if (!bodies_.isWithin(skin.component, cell, in)) continue;
    const bool faced = std::any_of(layers.begin(), layers.end(), [&](const Layer& other) {
      return other.component != skin.component && other.carries[in] &&
             !bodies_.isLining(other.component, skin.component);
    });
    if (faced) skin.kept[out] = false;
  }
}

bool Classifier::wins(const Layer& a, const Layer& b) const {
  const auto rank = [&](const Layer& l) {
    const Vec3& e = scene_.materials[scene_.surfaces[surfaceOf(l)].material].emission;
    const bool emits = std::max({e.x, e.y, e.z}) > 0;
    return std::tuple(!emits, report_.surfaces[surfaceOf(l)].given, nameOf(l), l.sheet);
  };
  return rank(a) < rank(b);
}

/// Keeps one of several sheets that face alike. A two-sided winner lies on the one-sided sheets
/// that it covers, so its far side is in contact with them.
void Classifier::dropOutdone(const PlaneCell& cell, Side side, std::vector<Layer>& layers) {
  Layer* winner = nullptr;
  for (Layer& l : layers) {
    if (l.kept[side] && (winner == nullptr || wins(l, *winner))) winner = &l;
  }
  for (Layer& l : layers) {
    if (!l.kept[side] || &l == winner) continue;
    l.kept[side] = false;
    l.outdone = true;
    outdone_[{nameOf(l), nameOf(*winner)}] += cell.area;
    if (winner->two_sided && !l.two_sided) winner->kept[opposite(side)] = false;
  }
}

void Classifier::account(const PlaneCell& cell, const std::vector<Layer>& layers) {
  for (const Layer& l : layers) {
    SurfaceAreas& areas = report_.surfaces[surfaceOf(l)];
    if (l.layers > 1) {
      areas.overlapped += (l.layers - 1) * cell.area;
      outdone_[{nameOf(l), nameOf(l)}] += (l.layers - 1) * cell.area;
    }
    if (l.kept[kAbove] || l.kept[kBelow]) continue;
    (l.outdone ? areas.overlapped : areas.buried) += cell.area;
  }
}

void Classifier::noteBackToBack(const PlaneCell& cell, const std::vector<Layer>& layers) {
  for (const Layer& up : layers) {
    for (const Layer& down : layers) {
      if (up.kept[kAbove] && down.kept[kBelow] && up.component != down.component) {
        back_to_back_[std::minmax(nameOf(up), nameOf(down))] += cell.area;
      }
    }
  }
}

void Classifier::run(Index number, std::vector<VisibleCell>& out) {
  const PlaneCell& cell = arrangement_.cells[number];
  std::vector<Layer> layers = layersOf(cell);
  for (const Side side : {kAbove, kBelow}) {
    if (!seesNothing(number, side)) continue;
    for (Layer& l : layers) {
      if (l.kept[side] && hollows_.isDark(number, side)) in_hollows_[nameOf(l)] += cell.area;
      l.kept[side] = false;
    }
  }
  dropContacts(number, layers);
  dropOutdone(cell, kAbove, layers);
  dropOutdone(cell, kBelow, layers);
  account(cell, layers);
  noteBackToBack(cell, layers);
  for (const Layer& l : layers) {
    if (l.kept[kAbove] || l.kept[kBelow]) {
      out.push_back({number, l.sheet, l.kept[kAbove], l.kept[kBelow]});
    }
  }
}

/// A two-sided body that is all there is could be meant to be seen from outside.
void Classifier::noteLoneRoom() {
  if (components_.list.size() != 1 || bodies_.rooms().empty()) return;
  std::set<std::string> names;
  for (const Sheet& sheet : sheets_) names.insert(scene_.surfaces[sheet.surface].name);
  report_.notes.push_back(
      {anyShinesIn(scene_.lights) ? Severity::warning : Severity::info,
       fmt::format("closed, two-sided and alone, so it is a room, and its outside has no patches "
                   "({} makes a body of it, if its faces are turned outward): {}",
                   spelled("one_sided", "all"),
                   joinNames(std::vector<std::string>(names.begin(), names.end())))});
}

void Classifier::writeNotes() {
  noteLoneRoom();
  std::set<std::string> emitters;
  for (const Surface& surface : scene_.surfaces) {
    if (scene_.materials[surface.material].emission != Vec3(0.0)) emitters.insert(surface.name);
  }
  for (const auto& [names, area] : outdone_) {
    const auto& [loser, winner] = names;
    // No warning for a lamp: a panel on an uncut ceiling is the usual way to model one.
    const bool lamp = emitters.contains(winner) && !emitters.contains(loser);
    report_.notes.push_back(
        {lamp ? Severity::info : Severity::warning,
         loser == winner
             ? fmt::format("{}: overlaps itself on {:.6g} m^2; one layer was kept", loser, area)
             : fmt::format("{}: {:.6g} m^2 lie in the same place as {} and face alike; {} was kept",
                           loser, area, winner, winner)});
  }
  for (const auto& [names, area] : back_to_back_) {
    report_.notes.push_back(
        {Severity::info, fmt::format("{} and {}: {:.6g} m^2 lie back to back; both were kept",
                                     names.first, names.second, area)});
  }
  noteHollows();
}

void Classifier::noteHollows() {
  double all = 0;
  std::vector<std::string> names;
  for (const auto& [name, area] : in_hollows_) {
    all += area;
    names.push_back(name);
  }
  if (names.empty()) return;
  report_.notes.push_back(
      {Severity::info,
       fmt::format("{:.6g} m^2 were dropped in dark hollows, which are closed, mostly "
                   "seen from behind and without a light: {}",
                   all, joinNames(names, kFewNames))});
}

}  // namespace

std::vector<VisibleCell> classify(const Scene& scene, const InputFaces& input,
                                  const std::vector<Plane>& planes, const EdgeTable& edges,
                                  const Arrangement& arrangement, const std::vector<Sheet>& sheets,
                                  const Components& components, MeshReport& report,
                                  Progress& progress) {
  const Winding winding(arrangement, planes, sheets, components, progress);
  const Bodies bodies(arrangement, sheets, components, winding);
  const Hollows hollows(scene, input, planes, edges, arrangement, sheets);
  Classifier classifier(scene, arrangement, sheets, components, winding, bodies, hollows, report);
  std::vector<VisibleCell> out;
  for (std::size_t k = 0; k < arrangement.cells.size(); ++k) classifier.run(Index(k), out);
  classifier.writeNotes();
  return out;
}

}  // namespace radiosity
