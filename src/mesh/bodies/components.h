// Finds the sheets that together bound a body.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "mesh/faces/sheets.h"

namespace radiosity {

/// Sheets that are connected by edges.
struct Component {
  std::vector<Index> sheets;
  std::vector<std::array<Vec3, 3>> triangles;  ///< of its faces, outward where `closed`
  std::vector<Index> triangle_plane;
  Box3 box;
  double coincidence = std::numeric_limits<double>::infinity();  ///< the least of its sheets', m
  bool closed = false;     ///< every edge is matched and it has a volume, so it bounds a body
  bool two_sided = false;  ///< all sheets are two-sided
  bool inward = false;     ///< closed, and the file has its faces turned inward
};

struct Components {
  std::vector<Component> list;
  std::vector<Index> of_sheet;
  /// By sheet: +1, or -1 if its faces have to be turned to look out of the closed component.
  std::vector<int> outward;
};

/// Joins sheets along an edge if they bound the same space behind their fronts. If more than two
/// faces meet at an edge, each is matched with the next one behind it, so that bodies which share
/// an edge stay apart. Two-sided sheets may be turned over to match. A component is closed if all
/// its edges are matched and the volume inside, over half its area, is thicker than coincidence.
Components findComponents(const InputFaces& input, const std::vector<Plane>& planes,
                          const std::vector<Sheet>& sheets, const EdgeTable& edges,
                          const Scene& scene);

}  // namespace radiosity
