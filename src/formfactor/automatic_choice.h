// The choice between exact form factors and rays, or rows that are cut, by their plans.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "formfactor/method.h"

namespace radiosity {

struct Chosen {
  std::unique_ptr<PreparedMethod> method;
  FormFactorPlan plan;  ///< with the reason
};
/// Plans both methods and keeps one.
Chosen chooseMethod(const PatchMesh& mesh, const FormFactorOptions& options, Progress& progress);

/// What takes the place of exact form factors where these take too long: rays, or rows that are cut
/// where patches are many or rays take far longer.
Chosen planBesideExact(const PatchMesh& mesh, const FormFactorOptions& options, Progress& progress);

/// Chosen automatically, exact is given up, and planBesideExact() takes its place, where it takes
/// far longer than was foreseen: then nothing. `seconds`: those foreseen.
std::optional<FormFactors> computeInTime(const PreparedMethod& exact, double seconds,
                                         Progress& progress, RowJournal* journal);
/// The reason for that.
std::string overrunText(double foreseen, double taken);

}  // namespace radiosity
