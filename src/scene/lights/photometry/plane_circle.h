// Half-planes of intensities about an axis, of which a file gives a part.
#pragma once

#include <vector>

#include "radiosity/photometry.h"

namespace radiosity {

/// Half-planes of type C, as a file has them, on their way to a whole turn.
class PlaneCircle {
 public:
  /// `row`: an intensity for each vertical angle. `angle`: degrees, any turn.
  void add(double angle, std::vector<float> row);
  /// Adds the mirror images of all that are there, in the plane of this angle and the one opposite,
  /// where no other is.
  void mirror(double plane);
  /// Sets horizontal angles 0 to 360 and intensities; a plane at 0 that the file does not have is
  /// interpolated, as intensity() would.
  void fill(Photometry& table);

 private:
  struct Plane {
    double angle;  ///< 0 to below 360
    std::vector<float> row;
  };
  bool has(double angle) const;

  std::vector<Plane> planes_;
};

}  // namespace radiosity
