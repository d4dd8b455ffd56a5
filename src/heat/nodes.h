// Nodes: sets of rows with one unknown temperature.
#pragma once

#include <span>
#include <vector>

#include "radiosity/heat.h"

namespace radiosity {

/// One unknown temperature: a row, both sides of a sheet, or all rows of an isothermal surface.
struct HeatNode {
  std::vector<Index> rows;  ///< ascending
  Index condition = 0;
  double area = 0;      ///< m^2
  double supplied = 0;  ///< W
};

struct HeatNodes {
  std::vector<HeatNode> nodes;  ///< by their first row
  std::vector<Index> of_row;    ///< N; kNone if a temperature is given
};

/// `area`: N. Errors: InputError if a row has no condition, or if two sides of a sheet differ.
HeatNodes heatNodes(const HeatRows& rows, std::span<const double> area);

}  // namespace radiosity
