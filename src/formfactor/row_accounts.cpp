#include "formfactor/row_accounts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <set>
#include <string>

#include "base/geometry/box.h"
#include "radiosity/spelling.h"
#include "scene/surface_names.h"
#include "scene/text.h"

namespace radiosity {
namespace {

/// Share of the view on black backs above which normals are suspect.
constexpr double kSuspectBacks = 1e-3;
/// The warning names at least this many surfaces, if there are as many, however small their shares.
constexpr std::size_t kNamedBacks = 3;

void noteBacks(const PatchMesh& mesh, FormFactors& result) {
  const std::vector<double>& share = result.backs_by_surface;
  const double total = std::accumulate(share.begin(), share.end(), 0.0);
  if (!(total > kSuspectBacks)) return;
  std::vector<std::size_t> worst(share.size());
  std::iota(worst.begin(), worst.end(), std::size_t(0));
  std::stable_sort(worst.begin(), worst.end(),
                   [&](std::size_t a, std::size_t b) { return share[a] > share[b]; });
  std::string names;
  std::size_t named = 0;
  for (const std::size_t s : worst) {
    // Name the surfaces that make up the warning, not every sliver; of many alike the first few.
    if (share[s] < 0.1 * total && (named >= kNamedBacks || share[s] <= 0)) break;
    names += fmt::format("{}{} ({:.2f}%)", names.empty() ? "" : ", ", mesh.surface_names[s],
                         100 * share[s]);
    ++named;
  }
  const auto all =
      std::size_t(std::count_if(share.begin(), share.end(), [](double v) { return v > 0; }));
  if (all > named) names += fmt::format(" and {} more", all - named);
  result.report.notes.push_back(
      {Severity::warning,
       fmt::format("{:.2f}% of the view ends on black backs, seen from behind: {}; flipped? "
                   "(turn the faces over, {}, or {})",
                   100 * total, names, spelled("flip", "NAME"), spelled("two_sided", "NAME"))});
}

bool isOnePlane(const PlanarPolygons& polygons) {
  constexpr double kSame = 1e-6;
  Box3 box;
  for (const Vec3& origin : polygons.origin) box.add(origin);
  for (std::size_t p = 1; p < polygons.size(); ++p) {
    const double off = glm::dot(polygons.origin[p] - polygons.origin[0], polygons.normal[0]);
    const bool same = glm::dot(polygons.normal[p], polygons.normal[0]) > 1 - kSame &&
                      std::abs(off) <= kSame * glm::distance(box.low, box.high);
    if (!same) return false;
  }
  return true;
}

/// The surfaces of closed shells that face outward, in the order of the scene.
std::vector<std::string> namesOfSolids(const PatchMesh& mesh) {
  std::set<Index> surfaces;
  if (!mesh.enclosures) return {};
  for (const ClosedSurface& closed : mesh.enclosures->surfaces) {
    if (!closed.is_solid) continue;
    for (const Index p : closed.polygons) surfaces.insert(mesh.polygons.surface[p]);
  }
  std::vector<std::string> names;
  names.reserve(surfaces.size());
  for (const Index s : surfaces) names.push_back(mesh.surface_names[s]);
  return names;
}

}  // namespace

std::optional<Note> nothingSeenNote(const PatchMesh& mesh) {
  if (isOnePlane(mesh.polygons)) return std::nullopt;
  constexpr const char* kWhat = "no surface sees another, all form factors are 0";
  const std::vector<std::string> solids = namesOfSolids(mesh);
  if (solids.empty()) {
    return Note{Severity::loud,
                fmt::format("{}: if surfaces are to face each other, turn some over, {}, or "
                            "give them both sides, {}",
                            kWhat, spelled("flip", "NAME"), spelled("two_sided", "NAME"))};
  }
  return Note{
      Severity::loud,
      fmt::format("{}: the closed shell {} faces outward, so nothing inside it sees "
                  "anything; if it is a room, turn it over, {}",
                  kWhat, joinNames(solids, 6), flipOption(solids, mesh.surface_names.size()))};
}

void addBack(const SeenBack& back, std::vector<SeenBack>& backs) {
  const auto same = std::ranges::find(backs, back.surface, &SeenBack::surface);
  if (same == backs.end()) {
    backs.push_back(back);
  } else {
    same->share += back.share;
  }
}

void accountForBacks(const PatchMesh& mesh, std::span<const Index> order,
                     std::span<const double> area,
                     const std::vector<std::vector<SeenBack>>& seen_backs, FormFactors& result) {
  result.backs_by_surface.assign(mesh.surface_names.size(), 0.0);
  double all = 0;
  for (const Index i : order) {
    if (result.fronts[i] + result.backs[i] + result.sky[i] > 0) all += area[i];
    for (const SeenBack& seen : seen_backs[i]) {
      result.backs_by_surface[seen.surface] += area[i] * seen.share;
    }
  }
  if (!(all > 0)) return;
  for (double& share : result.backs_by_surface) share /= all;
  noteBacks(mesh, result);
}

}  // namespace radiosity
