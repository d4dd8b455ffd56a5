#include "heat/condition_targets.h"

#include <fmt/format.h>

#include <set>

#include "base/name_pattern.h"
#include "base/parse.h"
#include "scene/surface_names.h"

namespace radiosity {

std::vector<std::string> SurfaceTargets::ownNames() const {
  std::vector<std::string> names;
  names.reserve(size());
  for (const Surface& surface : scene_.surfaces) names.push_back(surface.name);
  return names;
}

std::vector<Index> SurfaceTargets::named(const std::string& name) const {
  return surfacesNamed(scene_, name);
}

std::vector<Index> SurfaceTargets::matching(const std::string& pattern) const {
  return surfacesMatching(scene_, pattern);
}

std::optional<double> SurfaceTargets::emissivityOfMaterial(Index target) const {
  const Surface& surface = scene_.surfaces[target];
  const Material& material = scene_.materials[surface.material];
  const Vec3& reflectance = material.reflectance;
  if (material.texture != kNone) {
    throw InputError(
        fmt::format("{}: material {} has a texture, and no single emissivity; give a number for {}",
                    scene_.file, material.name, surface.name));
  }
  if (reflectance.r != reflectance.g || reflectance.r != reflectance.b) {
    throw InputError(fmt::format(
        "{}: material {} reflects the colour {:g}, {:g}, {:g}, and has no single emissivity; give "
        "a number for {}",
        scene_.file, material.name, reflectance.r, reflectance.g, reflectance.b, surface.name));
  }
  return 1 - reflectance.r;
}

std::vector<std::string> SurfaceTargets::knownNames() const {
  return radiosity::knownNames(scene_);
}

RowTargets::RowTargets(std::span<const std::string> names, std::span<const double> emissivity)
    : names_(names), emissivity_(emissivity) {
  for (Index i = 0; i < names.size(); ++i) {
    if (!names[i].empty()) by_name_[names[i]].push_back(i);
  }
}

std::string RowTargets::nameOf(Index target) const {
  const std::string& name = names_[target];
  return name.empty() ? fmt::format("row {}", target + 1)
                      : fmt::format("row {} ({})", target + 1, name);
}

std::vector<Index> RowTargets::named(const std::string& name) const {
  if (const auto found = by_name_.find(name); found != by_name_.end()) return found->second;
  // Tables call a row without a name "row 3".
  constexpr std::string_view kRow = "row ";
  const std::optional<long long> number =
      parseInteger(std::string_view(name).substr(name.starts_with(kRow) ? kRow.size() : 0));
  if (!number || *number < 1 || std::size_t(*number) > names_.size()) return {};
  return {Index(*number - 1)};
}

std::vector<Index> RowTargets::matching(const std::string& pattern) const {
  std::vector<Index> found;
  for (Index i = 0; i < names_.size(); ++i) {
    if (!names_[i].empty() && matchesPattern(pattern, names_[i])) found.push_back(i);
  }
  return found;
}

std::vector<std::string> RowTargets::knownNames() const {
  std::vector<std::string> known;
  std::set<std::string_view> seen;
  for (const std::string& name : names_) {
    if (!name.empty() && seen.insert(name).second) known.push_back(name);
  }
  known.push_back(fmt::format("numbers from 1 to {}", names_.size()));
  return known;
}

std::optional<double> RowTargets::emissivityOf(Index target) const {
  if (emissivity_.empty()) return std::nullopt;
  return emissivity_[target];
}

}  // namespace radiosity
