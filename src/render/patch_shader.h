// The value of a field at a point of a patch that a sample sees.
#pragma once

#include <array>
#include <vector>

#include "radiosity/elements.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/point_materials.h"
#include "render/item_buffer.h"

namespace radiosity {

/// The cost and accuracy of light evaluated at points.
struct PointSums {
  std::size_t points = 0;
  double rays = 0;
  double noise_square = 0;  ///< sum over pixels of the squared standard error of their mean
  double light_square = 0;  ///< sum over pixels of the squared light, over all bands
  double seconds = 0;       ///< of the thread's time
};

/// Irradiance on roots for drawing. The radiosity of a point is emission + reflectance times the
/// irradiance there, in bands of red, green and blue, or one in grey.
struct ShadedRoots {
  const ElementRoots& roots;
  int bands;
  std::span<const double> reflectance;  ///< N * bands
  std::span<const double> emission;     ///< N * bands
  double factor = 1;                    ///< multiplies the result
  /// Elements, with their lookup; ...
  const Elements* elements = nullptr;
  const ElementLookup* lookup = nullptr;
  /// ... or light at every sample's own point.
  const LightAtPoints* points = nullptr;
  int rays = 0;                     ///< of a pixel
  int every = 1;                    ///< draws only each pixel of this number, across and down
  std::span<PointSums> tiles = {};  ///< of each tile of the item buffer
  /// Of three bands; null: none varies.
  const PointMaterials* materials = nullptr;
};

/// What a sample sees.
struct Shade {
  std::array<double, 3> value{};  ///< of the field
  // Of light on roots:
  std::array<double, 3> direct{};  ///< the part of `value` that is emission and direct light
  std::array<double, 3> albedo{};  ///< reflectance
  double light = 0;                ///< irradiance, summed over the bands
  double noise_square = 0;         ///< the square of its standard error
};

/// A field over the patches: constant on each, interpolated from values at the corners, or taken
/// from elements.
struct PatchField {
  std::span<const double> values;  ///< N * bands, row-major
  std::vector<double> corners;     ///< mesh.corners.size() * bands, or empty: constant patches
  int bands = 1;                   ///< 1 to 3
  /// Shared by the threads; null: none. Of 3 bands.
  const ShadedRoots* roots = nullptr;
};

/// Interpolates with Wachspress' coordinates (Wachspress, "A Rational Finite Element Basis", 1975;
/// Meyer, Lee, Barr & Desbrun 2002). In a convex polygon the weight of corner i is
///   w_i = C_i * product of A_j over the edges j that do not touch corner i,
/// with C_i the area of the triangle of corner i and its two neighbours, and A_j the area of the
/// triangle of edge j and the point. On a triangle these are the barycentric coordinates, on a
/// parallelogram the bilinear ones. Linear fields are reproduced exactly. The field is smooth
/// inside a quadrilateral and linear along its edges, so neighbours agree there. A quadrilateral
/// split into two or four triangles would have creases along its diagonals, which show as Mach
/// bands.
///
/// The areas A_j are the edge functions det(a, b, d) of the rasteriser up to one common factor,
/// which cancels: the interpolation is perspective-correct without a division by depth.
class PatchShader {
 public:
  PatchShader(const PatchMesh& mesh, const ItemBuffer& items, const PatchField& field);

  /// Begins a new pixel with this number of samples.
  void setSamples(int samples);
  /// With light at points: the sums so far.
  PointSums sums() const { return sums_; }
  /// Sets the piece, and so the patch, of the next samples.
  void setPiece(Index piece);
  /// At pixel position (x, y), inside the piece; `value` has `field.bands` values.
  Shade at(double x, double y);

 private:
  void setConvexQuad(Index patch);
  bool convexQuad(Index patch);
  void setTriangle(Index patch, Index piece);

  void setRoot(Index patch, Index piece);
  Shade rootAt(double x, double y);
  Shade patchAt(double x, double y) const;
  std::array<double, 3> interpolated(double x, double y) const;
  void addIrradiance(const Vec3& at, std::span<double> direct, std::span<double> indirect,
                     Shade& shade);
  PointMaterials::Values materialAt(const Vec3& at, double depth) const;

  const PatchMesh& mesh_;
  const ItemBuffer& items_;
  const PatchField& field_;
  int samples_ = 1;  ///< of the pixel
  PointSums sums_;
  std::size_t root_ = kNone;  ///< kNone: the patch has no root, or no root with light
  bool varies_ = false;       ///< the material of the patch, from point to point
  Vec3 normal_{0.0};          ///< of the patch
  double height_ = 0;         ///< of its plane, seen from the eye
  Index patch_ = 0;
  int corners_ = 0;               ///< 0: constant, else 3 or 4
  std::array<Vec3, 4> edge_{};    ///< edge functions, >= 0 inside; edge k: corner k to k + 1
  std::array<double, 4> area_{};  ///< C_i
  std::array<double, 3> base_{};  ///< value of corner 0, or of the patch
  std::array<std::array<double, 3>, 4> rise_{};  ///< values of the corners less `base_`
};

}  // namespace radiosity
