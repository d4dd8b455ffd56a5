// Conditions of a scene's surfaces from what lines say by name.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "heat/condition_text.h"
#include "scene/surface_names.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// How messages list names.
constexpr std::size_t kMostNames = 40;

[[noreturn]] void fail(const GivenCondition& given, const std::string& what) {
  throw InputError(fmt::format("{}: {}", given.origin, what));
}

/// All lines, those of the table first, and which of them each surface is named by.
class Lines {
 public:
  Lines(const Scene& scene, const std::string& csv_path, std::span<const std::string> settings)
      : scene_(scene), of_surface_(scene.surfaces.size()) {
    if (!csv_path.empty()) lines_ = readConditionTable(csv_path);
    table_ = lines_.size();
    for (const std::string& text : settings) lines_.push_back(parseSetting(text));
    checkOthers();
    for (std::size_t k = 0; k < lines_.size(); ++k) {
      if (lines_[k].name != kOthers) place(k);
    }
  }

  HeatConditions conditions() {
    HeatConditions out;
    std::map<std::vector<std::size_t>, Index> known;  // lines to their condition
    std::vector<std::string> without;
    for (std::size_t s = 0; s < of_surface_.size(); ++s) {
      const std::vector<std::size_t>& named_by = of_surface_[s];
      const auto found = known.find(named_by);
      if (!named_by.empty() && found != known.end()) {
        out.of_surface.push_back(found->second);
        continue;
      }
      const std::string& surface = scene_.surfaces[s].name;
      const GivenCondition given = together(named_by);
      if (!given.heated() && !given.convection) {
        without.push_back(surface);
        continue;
      }
      out.of_surface.push_back(Index(out.conditions.size()));
      if (!named_by.empty()) known[named_by] = out.of_surface.back();
      const bool alone = named_by.empty() || surfacesOf(named_by) == 1;
      out.conditions.push_back(conditionOf(given, alone ? surface : lines_[named_by[0]].name));
    }
    requireAll(without);
    return out;
  }

 private:
  /// There is one line of a table for all others, and it says nothing of one surface.
  void checkOthers() const {
    bool there = false;
    for (std::size_t k = 0; k < lines_.size(); ++k) {
      const GivenCondition& line = lines_[k];
      if (line.name != kOthers) continue;
      if (line.power || line.isothermal) {
        fail(line, "power and isothermal are of surfaces together; give them by name, not for *");
      }
      if (k < table_ && there) fail(line, "a second line for *; give one");
      there = there || k < table_;
    }
  }

  /// Surfaces named by exactly these lines.
  std::size_t surfacesOf(const std::vector<std::size_t>& named_by) const {
    return std::size_t(std::ranges::count(of_surface_, named_by));
  }

  void place(std::size_t k) {
    const GivenCondition& line = lines_[k];
    const std::vector<Index> surfaces = surfacesNamed(scene_, line.name);
    if (surfaces.empty()) {
      fail(line,
           fmt::format("no surface, material or object with faces is called {}; there are: {}",
                       line.name, joinNames(knownNames(scene_), kMostNames)));
    }
    for (const Index s : surfaces) {
      std::vector<std::size_t>& named_by = of_surface_[s];
      if (k < table_ && !named_by.empty()) {
        fail(line, fmt::format("{} is named here and in {}; name it once", scene_.surfaces[s].name,
                               lines_[named_by[0]].origin));
      }
      named_by.push_back(k);
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

  /// What all lines say that name a surface; where they are silent, what is said of all others.
  GivenCondition together(const std::vector<std::size_t>& named_by) {
    GivenCondition out;
    for (const GivenCondition& line : lines_) {
      if (line.name == kOthers) add(line, out);
    }
    for (const std::size_t k : named_by) add(lines_[k], out);
    for (const std::size_t k : named_by) {
      const GivenCondition& line = lines_[k];
      const bool shares = (line.power && out.power) || (line.isothermal && *line.isothermal);
      if (!shares) continue;
      if (shared_.contains(k) && shared_[k] != named_by) {
        fail(line, fmt::format("{}: power and isothermal are of all that the name stands for, and "
                               "another setting takes some of it out; name them one by one",
                               line.name));
      }
      shared_[k] = named_by;
    }
    return out;
  }

  static HeatCondition conditionOf(const GivenCondition& given, const std::string& name) {
    if (!given.emissivity) {
      throw InputError(fmt::format(
          "{}: has no emissivity; give one, or one for all others by the name *", name));
    }
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
    condition.emissivity = *given.emissivity;
    condition.temperature = given.temperature;
    condition.flux = given.flux;
    condition.power = given.power;
    condition.convection = given.convection.value_or(0);
    condition.ambient = given.ambient.value_or(0);
    condition.isothermal = given.isothermal.value_or(false);
    return condition;
  }

  static void requireAll(const std::vector<std::string>& without) {
    if (without.empty()) return;
    throw InputError(
        fmt::format("no condition for {}: give a temperature, flux (0: adiabatic), power or "
                    "convection, each by "
                    "name or for all others by the name *",
                    joinNames(without, kMostNames)));
  }

  const Scene& scene_;
  std::vector<GivenCondition> lines_;
  std::size_t table_ = 0;  ///< how many are of the table
  std::vector<std::vector<std::size_t>> of_surface_;
  std::map<std::size_t, std::vector<std::size_t>> shared_;  ///< by line: who shares its power
};

}  // namespace

HeatConditions readHeatConditions(const Scene& scene, const std::string& csv_path,
                                  std::span<const std::string> settings) {
  if (csv_path.empty() && settings.empty()) {
    throw InputError(
        "no conditions are given: name a table of them, --thermal FILE.csv, or give them by name, "
        "--condition NAME.temperature=500");
  }
  return Lines(scene, csv_path, settings).conditions();
}

}  // namespace radiosity
