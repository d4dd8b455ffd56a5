#include "formfactor/row_accounts.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "mesh/clusters/canonical_order.h"

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
                   "(turn the faces over, or make them two-sided)",
                   100 * total, names)});
}

}  // namespace

UnknownOrder unknownOrder(const PatchMesh& mesh) {
  UnknownOrder order;
  std::vector<std::uint8_t> met(mesh.unknowns(), 0);
  for (const Index patch : canonicalOrder(mesh)) {
    const std::size_t unknown = mesh.unknownOf(patch);
    if (std::exchange(met[unknown], 1) != 0) continue;
    order.unknown.push_back(Index(unknown));
    order.first_patch.push_back(patch);
  }
  return order;
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
