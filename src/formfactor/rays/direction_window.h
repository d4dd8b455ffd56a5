// A part of the hemisphere over a plane.
#pragma once

namespace radiosity {

/// The directions whose elevation over a plane, and whose azimuth in it, lie in ranges. Of
/// cosine-distributed directions the squared sine of the elevation and the azimuth are distributed
/// evenly (Malley's disc in polar coordinates), so that the window's share of them is the product
/// of the ranges' shares.
struct DirectionWindow {
  double low = 1;     ///< squared sine of the elevation, from here ...
  double high = 0;    ///< ... to here; below `low`: no directions at all
  double centre = 0;  ///< azimuth, rad, from the frame's x towards its y ...
  double half = 0;    ///< ... to both sides; pi: all round

  bool empty() const { return !(high >= low); }
  double share() const;
  bool contains(const DirectionWindow& other) const;
  /// Grows to hold the other one, too.
  void add(const DirectionWindow& other);
};

}  // namespace radiosity
