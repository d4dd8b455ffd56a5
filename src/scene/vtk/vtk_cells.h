// Cells of VTK files, legacy or XML, as faces (Schroeder, Martin & Lorensen, "The Visualization
// Toolkit", file formats).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/grouped_faces.h"

namespace radiosity {

/// Cells and their points. Cell k has the points from connectivity[end[k - 1]] up to end[k].
struct VtkCells {
  std::vector<Index> points;            ///< vertices of the scene, by the number of the point
  std::vector<long long> connectivity;  ///< numbers of points, from 0
  std::vector<long long> ends;
  std::vector<long long> types;     ///< VTK's numbers of cell types
  std::vector<std::string> groups;  ///< names of cells, one each, or none at all
};

/// VTK's types of the four kinds of cells of POLYDATA, in the order of their data.
inline constexpr long long kVtkPolyVertex = 2;
inline constexpr long long kVtkPolyLine = 4;
inline constexpr long long kVtkPolygon = 7;
inline constexpr long long kVtkStrip = 6;

/// The rank of an array with names of groups: the array with the lowest rank counts, of equal ones
/// the first. Words come first. Numbers that differ from cell to cell are numbers of cells, and
/// count only if there is no other array. `array`: see groupArrayRank().
using VtkGroupRank = std::pair<int, std::size_t>;
VtkGroupRank vtkGroupRank(std::string_view array, bool has_words, bool differs_everywhere);

/// Whether no two values are equal.
bool allDiffer(std::span<const long long> values);

/// "group 3": the name of an integer group.
std::string vtkGroupName(const std::string& array, long long value);

/// Adds the faces of `cells`, to the surface `name` if they have no groups. `first`: the number of
/// cells in the pieces before. Errors: InputError "FILE: cell N: what; cure".
void addVtkCells(const VtkCells& cells, const std::string& file, const std::string& name,
                 std::size_t first, GroupedFaces& faces);

}  // namespace radiosity
