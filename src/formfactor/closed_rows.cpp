#include "formfactor/closed_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>

#include "mesh/patches/enclosures.h"
#include "radiosity/spelling.h"
#include "scene/text.h"

namespace radiosity {

ClosedRows::ClosedRows(const PatchMesh& mesh) : state_(mesh.size(), kClosed) {
  std::optional<Enclosures> found;
  const Enclosures& enclosures = enclosuresOf(mesh, found);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (enclosures.enclosed[i] == 0) state_[i] = kOpen;
  }
}

bool ClosedRows::any() const { return std::ranges::count(state_, kClosed) > 0; }

void ClosedRows::balance(FormFactors& result) const {
  double& largest = result.report.largest_row_error;
  for (std::size_t i = 0; i < result.fronts.size(); ++i) {
    if (result.fronts[i] + result.backs[i] + result.sky[i] == 0) continue;
    const double rest = 1 - result.fronts[i] - result.backs[i];
    result.sky[i] = closed(i) ? 0.0 : std::max(0.0, rest);
    largest = std::max(largest, std::abs(rest - result.sky[i]));
  }
}

void ClosedRows::report(const PatchMesh& mesh, FormFactorReport& report) const {
  report.closed = report.empty_rows < state_.size() &&
                  std::ranges::count(state_, kClosed) == std::ssize(state_);
  const auto refuted = std::ranges::count(state_, kRefuted);
  if (refuted == 0) return;
  std::set<std::string> names;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (state_[i] == kRefuted) names.insert(mesh.surface_names[mesh.surface[i]]);
  }
  report.notes.push_back(
      {Severity::warning,
       fmt::format("{} rows see too little for patches that are closed in; what they miss counts "
                   "as sky: {}; do faces lie on others, or cross them? (without {} "
                   "they are cut)",
                   refuted, joinNames(std::vector<std::string>(names.begin(), names.end())),
                   spelled("faces_as_patches"))});
}

}  // namespace radiosity
