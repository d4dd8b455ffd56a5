// Accounts of rows, the same for every method: which surfaces are seen from behind, what is
// missing.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "radiosity/form_factors.h"

namespace radiosity {

/// Black backs of one surface that one row sees.
struct SeenBack {
  Index surface;
  double share;
};

/// Adds to the share of a surface.
void addBack(const SeenBack& back, std::vector<SeenBack>& backs);

/// Fills backs_by_surface from the backs that each row saw, and warns, by name, of surfaces whose
/// backs take more than 0.1% of the view. Needs the accounts. `area` and `seen_backs`: a value a
/// row; `order`: each row once.
void accountForBacks(const PatchMesh& mesh, std::span<const Index> order,
                     std::span<const double> area,
                     const std::vector<std::vector<SeenBack>>& seen_backs, FormFactors& result);

/// A loud note for a mesh in which no patch sees the front of another: as a rule a room that faces
/// outward. Nothing if all lies in one plane and faces alike, which is as it must be.
std::optional<Note> nothingSeenNote(const PatchMesh& mesh);

}  // namespace radiosity
