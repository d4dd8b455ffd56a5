// The irradiance an eye receives from radiosities given at the corners of patches.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/eye_frame.h"
#include "formfactor/hemicube.h"
#include "gather/patch_basis.h"
#include "radiosity/gather.h"

namespace radiosity {

/// Adds up, pixel by pixel, weight times the radiosity interpolated at the pixel's point of the
/// patch seen. Scratch memory: one a thread.
///
/// The areas A_k of the interpolation are, up to one factor that cancels, the determinants
/// det(b, a, r) of an edge's ends, seen from the eye, and the pixel's ray r = (x, y, 1): linear
/// along a row, so that perspective costs one division a pixel.
class InterpolatedView : public RunVisitor {
 public:
  /// All are kept by reference. `scale`: of the view scene the eye's frame is given in. `radiosity`
  /// (eyes * 3) may change between views.
  InterpolatedView(const PatchMesh& mesh, const PatchBasis& basis, double scale, int resolution,
                   const std::vector<Index>& eye_of_corner, const std::vector<float>& radiosity);

  void begin(const EyeFrame& frame);
  void visit(const ItemRun& run) override;
  /// W/m^2, of all runs since begin().
  const std::array<double, 3>& irradiance() const { return irradiance_; }

 private:
  struct SeenFacet {
    int count = 3;
    std::array<Vec3, 4> edge{};                    ///< in the eye's frame; dot(edge k, r) is A_k
    std::array<double, 4> area{};                  ///< C_k
    std::array<std::array<double, 3>, 4> value{};  ///< corner 0's; of the others, the rise from it
  };
  /// Linear functions along a row of pixels.
  struct RowEdges {
    std::array<double, 4> slope{};
    std::array<double, 4> base{};
  };

  void prepare(std::size_t patch);
  std::array<double, 3> cornerMean(std::size_t patch) const;
  std::array<double, 3> valueAt(std::size_t patch, std::size_t corner) const;
  RowEdges alongRow(const SeenFacet& facet, const ItemRun& run) const;
  void addRun(const SeenFacet& facet, const ItemRun& run, int begin, int end);
  void addManyFacets(std::size_t patch, const ItemRun& run);

  const PatchMesh& mesh_;
  const PatchBasis& basis_;
  double scale_;
  double pixel_;  ///< in units of half a face
  const std::vector<Index>& eye_of_corner_;
  const std::vector<float>& radiosity_;
  EyeFrame frame_;
  std::array<double, 3> irradiance_{};
  std::uint32_t view_ = 0;
  std::vector<std::uint32_t> prepared_;  ///< N, the view a patch was prepared for
  std::vector<std::uint8_t> constant_;   ///< N, of that view: the same value at all corners
  std::vector<SeenFacet> facets_;        ///< as PatchBasis numbers them
};

}  // namespace radiosity
