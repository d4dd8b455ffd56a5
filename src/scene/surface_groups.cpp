// Groups surfaces under one name by patterns.
#include "radiosity/surface_groups.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/name_pattern.h"
#include "base/near_names.h"
#include "radiosity/spelling.h"
#include "scene/text.h"

namespace radiosity {

namespace {

struct Wish {
  std::string option;  ///< the text as given, for messages
  std::string name;
  std::string pattern;
};

Wish parse(const std::string& text) {
  const std::size_t equals = text.find('=');
  Wish wish;
  wish.option = spelled("groups", text);
  if (equals != std::string::npos) {
    wish.name = trimmed(std::string_view(text).substr(0, equals));
    wish.pattern = text.substr(equals + 1);
  }
  if (wish.name.empty() || wish.pattern.empty()) {
    throw InputError(
        fmt::format("{}: is no NAME=PATTERN; e.g. {} joins surfaces with wall in their name",
                    wish.option, spelled("groups", "walls='*wall*'")));
  }
  return wish;
}

/// Whether a surface matches. Its literal name does, too: it may have special characters of
/// patterns.
bool matches(const Wish& wish, const std::string& surface) {
  return surface == wish.pattern || matchesPattern(wish.pattern, surface);
}

class Grouping {
 public:
  explicit Grouping(std::span<const std::string> surfaces) : surfaces_(surfaces) {
    result_.of_surface.assign(surfaces.size(), kNone);
  }

  void join(const Wish& wish) {
    const Index group = groupOf(wish.name);
    bool any = false;
    for (std::size_t s = 0; s < surfaces_.size(); ++s) {
      if (!matches(wish, surfaces_[s])) continue;
      any = true;
      Index& of = result_.of_surface[s];
      if (of == kNone) of = group;
      if (of == group) continue;
      result_.notes.push_back(
          {Severity::info, fmt::format("{}: surface {} is in group {} already", wish.option,
                                       surfaces_[s], result_.names[of])});
    }
    if (!any) {
      throw InputError(fmt::format("{}: matches no surface; there are: {}", wish.option,
                                   joinNames(nearestFirst(wish.pattern, surfaces_), 40)));
    }
    options_.resize(result_.names.size());
    options_[group] = wish.option;
  }

  SurfaceGroups finish() {
    const std::size_t groups = result_.groups = result_.names.size();
    for (Index group = 0; group < groups; ++group) {
      if (std::ranges::find(result_.of_surface, group) != result_.of_surface.end()) continue;
      throw InputError(fmt::format(
          "{}: all surfaces that it matches are in groups before it; put it before them, or leave "
          "it out",
          options_[group]));
    }
    for (std::size_t s = 0; s < surfaces_.size(); ++s) {
      if (result_.of_surface[s] != kNone) continue;
      const auto named = result_.names.begin() + std::ptrdiff_t(groups);
      if (std::find(result_.names.begin(), named, surfaces_[s]) != named) {
        throw InputError(
            fmt::format("{}: surface {} has that name and is not in the group; choose another name",
                        spelled("groups", surfaces_[s] + "=..."), surfaces_[s]));
      }
      result_.of_surface[s] = Index(result_.names.size());
      result_.names.push_back(surfaces_[s]);
    }
    return std::move(result_);
  }

 private:
  Index groupOf(const std::string& name) {
    const auto found = std::find(result_.names.begin(), result_.names.end(), name);
    if (found == result_.names.end()) {
      result_.names.push_back(name);
      return Index(result_.names.size() - 1);
    }
    return Index(found - result_.names.begin());
  }

  std::span<const std::string> surfaces_;
  SurfaceGroups result_;
  std::vector<std::string> options_;  ///< by group, the last that added to it
};

}  // namespace

SurfaceGroups groupSurfaces(std::span<const std::string> surfaces,
                            std::span<const std::string> groups) {
  Grouping grouping(surfaces);
  for (const std::string& group : groups) grouping.join(parse(group));
  return grouping.finish();
}

}  // namespace radiosity
