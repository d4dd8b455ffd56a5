// Makes conditions of surfaces or rows from lines that name them.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "base/input_file.h"
#include "base/name_pattern.h"
#include "base/near_names.h"
#include "heat/condition_targets.h"
#include "heat/condition_text.h"
#include "radiosity/spelling.h"
#include "radiosity/surface_groups.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// The most names that a message lists.
constexpr std::size_t kMostNames = 40;
constexpr std::size_t kFewNames = 12;

[[noreturn]] void fail(const GivenCondition& given, const std::string& what) {
  throw InputError(fmt::format("{}: {}", given.origin, what));
}

/// All lines, those of the table first, and the lines that name each target.
class Lines {
 public:
  Lines(const ConditionTargets& targets, const ConditionText& text)
      : targets_(targets), of_target_(targets.size()) {
    if (!text.groups.empty()) groups_ = groupSurfaces(targets.ownNames(), text.groups);
    if (!text.table.empty()) lines_ = parseConditionTable(text.origin, text.table);
    table_ = lines_.size();
    for (const std::string& setting : text.settings) lines_.push_back(parseSetting(setting));
    findOthers();
    find();
    placeAll(0, table_);
    placeAll(table_, lines_.size());
  }

  HeatConditions conditions() {
    HeatConditions out;
    out.notes = groups_.notes;
    std::map<Same, Index> known;
    for (Index t = 0; t < of_target_.size(); ++t) {
      const bool material = takesMaterial(of_target_[t]);
      out.from_materials |= material;
      const Same same{of_target_[t],
                      material ? targets_.emissivityOfMaterial(t) : targets_.emissivityOf(t)};
      const auto found = known.find(same);
      if (!same.named_by.empty() && found != known.end()) {
        out.of_surface.push_back(found->second);
        continue;
      }
      GivenCondition given = together(same);
      if (material || !given.emissivity) given.emissivity = constant(same.emissivity);
      if (!given.heated() && !given.convection) without_condition_.push_back(targets_.nameOf(t));
      if (!given.emissivity) without_emissivity_.push_back(targets_.nameOf(t));
      out.of_surface.push_back(Index(out.conditions.size()));
      if (!same.named_by.empty()) known[same] = out.of_surface.back();
      const bool alone = same.named_by.empty() || countNamedBy(same.named_by) == 1;
      out.conditions.push_back(
          conditionOf(given, alone ? targets_.nameOf(t) : lines_[same.named_by[0]].name));
    }
    requireAll();
    return out;
  }

 private:
  /// The lines that targets with one condition have in common.
  struct Same {
    std::vector<std::size_t> named_by;
    std::optional<double> emissivity;  ///< used if no line gives one
    auto operator<=>(const Same&) const = default;
  };

  static std::optional<std::vector<Emissivity>> constant(const std::optional<double>& value) {
    if (!value) return std::nullopt;
    return std::vector<Emissivity>{{{}, {*value}}};
  }

  /// Whether the last of the lines that give an emissivity leaves it to the material.
  bool takesMaterial(const std::vector<std::size_t>& named_by) const {
    const auto gives = [&](std::size_t k) { return lines_[k].givesEmissivity(); };
    const auto named = std::find_if(named_by.rbegin(), named_by.rend(), gives);
    if (named != named_by.rend()) return lines_[*named].emissivity_of_material;
    const auto other = std::find_if(others_.rbegin(), others_.rend(), gives);
    return other != others_.rend() && lines_[*other].emissivity_of_material;
  }

  /// A table may have one line for all others, which must not give properties of a single surface.
  void findOthers() {
    bool there = false;
    for (std::size_t k = 0; k < lines_.size(); ++k) {
      const GivenCondition& line = lines_[k];
      if (line.name != kOthers) continue;
      others_.push_back(k);
      if (line.power || line.isothermal) {
        fail(line, "power and isothermal are of surfaces together; give them by name, not for *");
      }
      if (k < table_ && there) fail(line, "a second line for *; give one");
      there = there || k < table_;
    }
  }

  /// The number of targets that exactly these lines name.
  std::size_t countNamedBy(const std::vector<std::size_t>& named_by) const {
    return std::size_t(std::ranges::count(of_target_, named_by));
  }

  /// Finds the targets of each line; a literal name has precedence over a pattern.
  void find() {
    found_.resize(lines_.size());
    by_pattern_.assign(lines_.size(), false);
    for (std::size_t k = 0; k < lines_.size(); ++k) {
      const GivenCondition& line = lines_[k];
      if (line.name == kOthers) continue;
      found_[k] = ofGroup(line.name);
      by_pattern_[k] = !found_[k].empty();
      if (by_pattern_[k]) continue;
      found_[k] = targets_.named(line.name);
      by_pattern_[k] = found_[k].empty() && isPattern(line.name);
      if (by_pattern_[k]) found_[k] = targets_.matching(line.name);
      if (found_[k].empty()) failForName(line, by_pattern_[k]);
    }
  }

  /// The targets in the group of that name; empty: there is none.
  std::vector<Index> ofGroup(const std::string& name) const {
    const auto end = groups_.names.begin() + std::ptrdiff_t(groups_.groups);
    const auto group = std::find(groups_.names.begin(), end, name);
    std::vector<Index> out;
    for (Index t = 0; t < groups_.of_surface.size() && group != end; ++t) {
      if (groups_.of_surface[t] == Index(group - groups_.names.begin())) out.push_back(t);
    }
    return out;
  }

  [[noreturn]] void failForName(const GivenCondition& line, bool pattern) const {
    std::vector<std::string> names = targets_.knownNames();
    const auto groups = groups_.names.begin() + std::ptrdiff_t(groups_.groups);
    names.insert(names.begin(), groups_.names.begin(), groups);
    const std::vector<std::string> known = nearestFirst(line.name, names);
    const std::string what = pattern
                                 ? fmt::format("{} matches no {}", line.name, targets_.kinds())
                                 : fmt::format("no {} is called {}", targets_.kinds(), line.name);
    fail(line, fmt::format("{}; there are: {}", what, joinNames(known, kMostNames)));
  }

  /// Assigns lines from `first` on to their targets: patterns first, then literal names.
  void placeAll(std::size_t first, std::size_t last) {
    for (const bool pattern : {true, false}) {
      for (std::size_t k = first; k < last; ++k) {
        if (by_pattern_[k] == pattern) place(k);
      }
    }
  }

  void place(std::size_t k) {
    for (const Index t : found_[k]) {
      std::vector<std::size_t>& named_by = of_target_[t];
      const bool twice =
          k < table_ && !named_by.empty() && by_pattern_[named_by.back()] == by_pattern_[k];
      if (twice) {
        fail(lines_[k], fmt::format("{} is named here and in {}; name it once", targets_.nameOf(t),
                                    lines_[named_by.back()].origin));
      }
      requireOneHeat(k, t);
      named_by.push_back(k);
    }
  }

  /// Of two settings that heat a target, neither goes before the other, unless one is by pattern or
  /// the later repeats the earlier.
  void requireOneHeat(std::size_t k, Index t) const {
    const GivenCondition& line = lines_[k];
    if (k < table_ || !line.heated()) return;
    for (const std::size_t other : of_target_[t]) {
      const GivenCondition& before = lines_[other];
      if (other < table_ || by_pattern_[other] != by_pattern_[k] || !before.heated()) continue;
      if (before.name == line.name && before.heatedAs(line)) continue;
      fail(line, fmt::format("{} is heated here and by {}; give one of them", targets_.nameOf(t),
                             before.origin));
    }
  }

  static void add(const GivenCondition& line, GivenCondition& to) {
    if (line.emissivity) to.emissivity = line.emissivity;
    if (line.heated()) {
      to.temperature = line.temperature;
      to.flux = line.flux;
      to.power = line.power;
      to.origin = line.origin;
    }
    if (line.convection) to.convection = line.convection;
    if (line.ambient) to.ambient = line.ambient;
    if (line.isothermal) to.isothermal = line.isothermal;
  }

  /// Combines all lines that name a target; the line for all others fills the gaps.
  GivenCondition together(const Same& same) {
    GivenCondition out;
    for (const std::size_t k : others_) add(lines_[k], out);
    for (const std::size_t k : same.named_by) add(lines_[k], out);
    for (const std::size_t k : same.named_by) {
      const GivenCondition& line = lines_[k];
      const bool shares = (line.power && out.power) || (line.isothermal && *line.isothermal);
      if (!shares) continue;
      const auto [known, added] = shared_.emplace(k, same);
      if (added || known->second == same) continue;
      if (known->second.named_by == same.named_by) {
        fail(line,
             fmt::format("{}: power and isothermal are of all that the name stands for, whose "
                         "emissivities in the file differ; give it one emissivity",
                         line.name));
      }
      fail(line, fmt::format("{}: power and isothermal are of all that the name stands for, and "
                             "another setting takes some of it out; name them one by one",
                             line.name));
    }
    return out;
  }

  static HeatCondition conditionOf(const GivenCondition& given, const std::string& name) {
    const bool convects = given.convection.value_or(0) > 0;
    if (convects && !given.ambient) {
      throw InputError(
          fmt::format("{}: has convection and no ambient temperature; give both", name));
    }
    if (given.ambient && !given.convection) {
      throw InputError(
          fmt::format("{}: has an ambient temperature and no convection; give both", name));
    }
    HeatCondition condition;
    condition.name = name;
    condition.emissivity = given.emissivity.value_or(std::vector<Emissivity>());
    condition.temperature = given.temperature;
    condition.flux = given.flux;
    condition.power = given.power;
    condition.convection = given.convection.value_or(0);
    condition.ambient = given.ambient.value_or(0);
    condition.isothermal = given.isothermal.value_or(false);
    return condition;
  }

  void requireAll() const {
    if (!without_condition_.empty()) {
      throw InputError(fmt::format(
          "no condition for {}: give a temperature, flux (0: adiabatic), power or convection, each "
          "by name or for all others by the name *",
          joinNames(without_condition_, kFewNames)));
    }
    if (!without_emissivity_.empty()) {
      throw InputError(
          fmt::format("no emissivity for {}: give one, each by name or for all others "
                      "by the name *{}",
                      joinNames(without_emissivity_, kFewNames), targets_.emissivityCure()));
    }
  }

  const ConditionTargets& targets_;
  SurfaceGroups groups_;
  std::vector<GivenCondition> lines_;
  std::size_t table_ = 0;                            ///< number of lines of the table
  std::vector<std::size_t> others_;                  ///< the lines for all others
  std::vector<std::vector<Index>> found_;            ///< by line
  std::vector<bool> by_pattern_;                     ///< by line
  std::vector<std::vector<std::size_t>> of_target_;  ///< lines, in order of rising precedence
  std::map<std::size_t, Same> shared_;               ///< by line: the targets that share its power
  std::vector<std::string> without_condition_;
  std::vector<std::string> without_emissivity_;
};

HeatConditions conditionsOf(const ConditionTargets& targets, const ConditionText& text) {
  HeatConditions out = Lines(targets, text).conditions();
  out.text = text;
  return out;
}

}  // namespace

ConditionText readConditionText(const std::string& csv_path, std::span<const std::string> settings,
                                std::span<const std::string> groups) {
  if (csv_path.empty() && settings.empty()) {
    throw InputError(
        fmt::format("no conditions are given: name a table of them, {}, or give them by name, {}",
                    spelled("table", "FILE.csv"), spelled("conditions", "NAME.temperature=500")));
  }
  ConditionText text;
  text.origin = csv_path;
  if (!csv_path.empty()) text.table = readWholeFile(csv_path);
  text.settings.assign(settings.begin(), settings.end());
  text.groups.assign(groups.begin(), groups.end());
  // Names are looked up when the scene is there; what cannot be read is said at once.
  if (!csv_path.empty()) parseConditionTable(text.origin, text.table);
  for (const std::string& setting : text.settings) parseSetting(setting);
  return text;
}

HeatConditions readHeatConditions(const Scene& scene, const ConditionText& text) {
  return conditionsOf(SurfaceTargets(scene), text);
}

HeatConditions readHeatConditions(const Scene& scene, const std::string& csv_path,
                                  std::span<const std::string> settings) {
  return readHeatConditions(scene, readConditionText(csv_path, settings));
}

HeatConditions readHeatConditions(std::span<const std::string> names,
                                  std::span<const double> emissivity, const ConditionText& text) {
  return conditionsOf(RowTargets(names, emissivity), text);
}

}  // namespace radiosity
