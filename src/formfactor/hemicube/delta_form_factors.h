// Exact delta form factors: the weight of each pixel of the hemicube.
#pragma once

#include <cstddef>
#include <vector>

namespace radiosity {

/// The form factor from the eye to every pixel, integrated in closed form over the pixel (Cohen &
/// Greenberg 1985 evaluate the integrand at the pixel's centre, which is 5e-4 too much at 32
/// pixels). Stored as running sums along each row, so that a run of pixels costs one subtraction.
///
/// The top face at height 1 spans [-1,1]^2 with weight 1 / (pi (x^2 + y^2 + 1)^2); its integral
/// over [0,a] x [0,b] is
///     1/(2 pi) [a/sqrt(1+a^2) atan(b/sqrt(1+a^2)) + b/sqrt(1+b^2) atan(a/sqrt(1+b^2))]
/// (configuration factor B-3 of Howell's catalogue). A side face at distance 1 spans y in [-1,1]
/// and height z in [0,1] with weight z / (pi (y^2 + z^2 + 1)^2), whose integral over dz dy is
///     -1/(2 pi) atan(y/sqrt(1+z^2)) / sqrt(1+z^2).
/// Summed over the hemicube they give 1; formfactor_delta_test checks it to 1e-14.
class DeltaFormFactors {
 public:
  /// `resolution`: pixels along an edge of the top face; even.
  explicit DeltaFormFactors(int resolution);

  int resolution() const { return resolution_; }
  /// Running sums of row y of the top face: resolution + 1 values, the first 0; pixels [x0, x1) of
  /// the row are worth topRow(y)[x1] - topRow(y)[x0]. Rows y and resolution - 1 - y are alike and
  /// stored once.
  const double* topRow(int y) const;
  /// The same for row y of a side face, 0 <= y < resolution / 2, counted from the horizon.
  const double* sideRow(int y) const { return side_.data() + std::size_t(y) * stride(); }
  /// Bytes of both tables.
  std::size_t bytes() const { return (top_.size() + side_.size()) * sizeof(double); }

 private:
  std::size_t stride() const { return std::size_t(resolution_) + 1; }
  int resolution_;
  std::vector<double> top_;
  std::vector<double> side_;
};

}  // namespace radiosity
