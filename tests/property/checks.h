// What holds of every scene, by every method.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "model.h"

namespace radiosity::property {

/// An invariant that does not hold.
struct Fault {
  std::string what;    ///< the invariant and the method, for counting: "negative exact"
  std::string detail;  ///< with numbers
};

/// Rows whose error is within the figure that is stated of it, over many scenes.
struct RowCount {
  std::size_t rows = 0;
  std::size_t beyond = 0;   ///< the figure
  double worst = 0;         ///< error over figure
  std::string worst_scene;  ///< "blinds 17"
  void add(const RowCount& other);
};

struct Findings {
  std::vector<Fault> faults;
  std::map<std::string, RowCount> rows;  ///< by method
  std::size_t refused = 0;               ///< 1 if the scene was refused with a reason
  std::size_t too_long = 0;              ///< computations left out
};

/// All invariants of the scene that was written to PATH.obj. Throws nothing.
Findings check(const Model& model, const std::string& path);

}  // namespace radiosity::property
