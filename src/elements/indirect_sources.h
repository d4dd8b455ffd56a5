// The indirect light of surfaces as sources of light, from pass to pass.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "elements/surface_points.h"
#include "radiosity/elements.h"

namespace radiosity {

/// Means of a field over patches, N * bands, from 8 x 8 points of each root; 0 where it was not
/// evaluated.
std::vector<double> patchMeans(const PatchMesh& mesh, const ElementRoots& roots,
                               const ElementLookup& lookup, const ElementField& field,
                               std::size_t bands);

/// Indirect light that is reflected on. At first it is the solution's, constant over each patch. So
/// a patch that is partly in a dark gap sends light into the gap and less of it to the room than it
/// does: in a living room by others light was 5% too low. Each pass of rays computes it anew, with
/// the shape that it has within patches, until little changes.
///
/// A pass has errors of its own: interpolation between its few vertices, and noise. Where every
/// patch has an unknown of its own, the solution is what the first pass ought to find: the
/// difference is added to all passes (keepMeans()). Where patches share unknowns the solution has
/// only a fit to the light of each, and the passes' errors are the smaller ones. (In that living
/// room they find 10% more indirect light than it has.) Patches that are not evaluated gain the
/// share of light that the others gain.
class IndirectSources {
 public:
  /// `solved`: N * bands, indirect irradiance of the solution. Keeps all by reference.
  IndirectSources(const PatchMesh& mesh, const PatchMaterials& materials,
                  const ElementSurface& surface, const ElementLookup& lookup,
                  std::span<const double> solved);

  /// The next pass.
  void take(ElementField field);
  /// Of irradiance (N * bands), over all patches and bands, W.
  double reflectedPower(std::span<const double> irradiance) const;
  /// The sum of the sizes of the last pass's changes to all patches, W.
  double moved() const { return moved_; }
  /// After the first pass: patches have the means of the solution, with the shape of that pass.
  void keepMeans();
  /// After the last of two passes or more: adds the changes of all further ones, a geometric series
  /// by what all patches together have gained in the last two. (The sizes of changes fall faster at
  /// first: local ones, which cancel, are among them.)
  void extrapolate();

  /// Adds the light at a place of a root to `sum` (bands).
  void add(std::size_t root, Vec2 at, std::span<double> sum) const;

 private:
  bool isEvaluated(std::size_t patch) const;
  void raiseOthers();

  const PatchMesh& mesh_;
  const PatchMaterials& materials_;
  const ElementSurface& surface_;
  const ElementLookup& lookup_;
  std::size_t bands_;
  std::span<const double> solved_;
  ElementField field_;          ///< of the last pass
  std::vector<double> light_;   ///< N * bands: means of the last pass
  std::vector<double> before_;  ///< the same, a pass before
  std::vector<double> added_;   ///< N * bands: to the last pass
  double moved_ = 0;
  double gained_ = 0;  ///< in the last pass, W
  double gained_before_ = 0;
};

}  // namespace radiosity
