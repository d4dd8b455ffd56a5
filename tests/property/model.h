// A random scene as it is written to a file: parts with a material, and what is known of it because
// of how it was made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity::property {

using Loop = std::vector<Vec3>;

/// A surface of the scene, by name.
struct Part {
  std::string name;
  double reflectance = 0.5;
  double radiance = 0;  ///< W/m^2/sr
  bool two_sided = false;
  std::vector<Loop> faces;
};

/// What the way in which a scene was made tells of its answer.
struct Known {
  std::optional<bool> closed;
  /// Sum of A_i F_i,sky, m^2: the area of the flat gap that is the only way out of a room, since
  /// all that comes in through it falls on something.
  std::optional<double> sky_area;
  /// F between two parts, with the relative error of the formula.
  struct Factor {
    std::string from, to;
    double value = 0;
    double error = 0;
  };
  std::optional<Factor> factor;
  /// A gap in the scene, or the noise of its corners, is about as wide as what the program takes
  /// for no gap at all. It may be welded, if a note says so, and methods may differ there.
  bool at_weld_distance = false;
  /// All fronts face out of the shell that encloses the scene.
  bool inside_out = false;
};

/// A scene and how it is meshed.
struct Model {
  std::string kind;
  std::uint64_t seed = 0;
  std::vector<Part> parts;
  Known known;
  std::size_t patches = 60;
  double sky = 0;  ///< radiance, W/m^2/sr
  bool exact_emitters = false;
  /// The smallest length that the answer depends on, as a share of the scene's size: the farther
  /// the scene is moved away, the fewer digits are left of it.
  double finest = 1e-4;

  std::size_t faceCount() const;
  /// Largest extent along an axis; 0 without corners.
  double extent() const;
  /// Writes PATH.obj and PATH.mtl with 17 digits, every face with corners of its own.
  void write(const std::string& path) const;
  /// What a file cannot hold: two-sided surfaces and the sky.
  SceneOptions options() const;
  /// The same as a command: "factors PATH.obj --patches 60 --two-sided sheet".
  std::string command(const std::string& path) const;
};

}  // namespace radiosity::property
