// The irradiance an eye receives from radiosities given at the corners of patches.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/hemicube/eye_frame.h"
#include "formfactor/hemicube/hemicube.h"
#include "gather/interpolation_kernels.h"
#include "gather/patch_basis.h"
#include "radiosity/gather.h"

namespace radiosity {

/// Sums over pixels the weight times the radiosity, interpolated at the pixel's point of the patch
/// seen. Scratch memory: one object a thread.
///
/// The areas A_k of the interpolation are, up to one factor that cancels, the determinants
/// det(b, a, r) of an edge's ends, seen from the eye, and the pixel's ray r = (x, y, 1): linear
/// along a row, so that perspective costs one division a pixel.
class InterpolatedView : public RunVisitor {
 public:
  /// Keeps all by reference. `scale`: of the view scene in which the eye's frame is given.
  /// `radiosity` (eyes * bands) may change between views.
  InterpolatedView(const PatchMesh& mesh, const PatchBasis& basis, double scale, int resolution,
                   bool simd, const std::vector<Index>& eye_of_corner,
                   const std::vector<float>& radiosity, std::size_t bands);

  void begin(const EyeFrame& frame);
  void visit(const ItemRun& run) override;
  /// W/m^2, one a band, of all runs since begin().
  void irradiance(std::span<double> sum) const;
  /// Weight of the runs since begin() that show each surface's back.
  std::span<const double> backsBySurface() const { return backs_; }
  /// Bytes of scratch memory.
  std::size_t bytes() const;

 private:
  struct SeenFacet {
    std::size_t count = 3;
    std::array<Vec3, 4> edge{};  ///< in the eye's frame; dot(edge k, r) is A_k
    FacetRow row;                ///< its slopes and bases are those of the last row seen
  };

  void prepare(std::size_t patch);
  void place(const BasisFacet& facet, SeenFacet& seen) const;
  bool setValues(std::size_t patch, const BasisFacet& facet, std::size_t seen);
  double cornerMean(std::size_t patch, std::size_t band) const;
  double valueAt(std::size_t patch, std::size_t corner, std::size_t band) const;
  void alongRow(SeenFacet& facet, const ItemRun& run) const;
  void addRun(const SeenFacet& facet, const ItemRun& run, int begin, int end, bool constant);
  void addManyFacets(std::size_t patch, const ItemRun& run);

  const PatchMesh& mesh_;
  const PatchBasis& basis_;
  InterpolationKernels kernels_;
  double scale_;
  int resolution_;
  const std::vector<Index>& eye_of_corner_;
  const std::vector<float>& radiosity_;
  std::size_t bands_;
  EyeFrame frame_;
  std::vector<double> level_;    ///< bands; the part of corner 0's values
  std::vector<double> backs_;    ///< by surface
  std::vector<LaneSums> above_;  ///< bands; the part of the differences to corner 0
  std::uint32_t view_ = 0;
  std::vector<std::uint32_t> prepared_;  ///< N, the view for which a patch was prepared
  std::vector<std::uint8_t> constant_;   ///< N, of that view: the same value at all corners
  std::vector<SeenFacet> facets_;        ///< as PatchBasis numbers them
  /// facets * bands: FacetRow::rise, and in place 0 the value of corner 0.
  std::vector<std::array<double, 4>> facet_rise_;
};

}  // namespace radiosity
