// Corrects form factors to near patches, which one point of a patch gets wrong.
#pragma once

#include <vector>

#include "formfactor/exact/unoccluded/unoccluded.h"
#include "formfactor/hemicube/row_builder.h"
#include "visibility/elements/elements.h"

namespace radiosity {

/// Replaces the near entries of hemicube rows by area-to-area form factors.
///
/// A hemicube sees from one point; its error goes as (patch size / distance)^2 and no number of
/// pixels helps (Baum, Rushmeier & Winget 1989). A pair is near if its centroids are closer than
/// two patch sizes. Its new value is the unoccluded area-to-area form factor times the visible
/// fraction, which is the hemicube's value over that of its eye with nothing between. Nearly all
/// seen counts as all: pixels along an edge are no occluder. The rest of the row, backs and sky are
/// scaled to the rest of 1, in the proportions in which they were seen (PackedRow::scaleRest()): a
/// hemicube's row sums to 1, and so does the corrected one.
class NearPairs {
 public:
  /// `mesh` is kept by reference.
  NearPairs(const PatchMesh& mesh, const FormFactorOptions& options);

  struct Outcome {
    std::size_t replaced = 0;
    PackedRow::Scaled scaled;
  };
  /// `row`: of `patch`, as it was seen, with `beside` on backs and sky. Thread-safe.
  Outcome correct(std::size_t patch, PackedRow& row, double beside, bool closed) const;

 private:
  bool near(std::size_t i, std::size_t j) const;
  /// Area-to-area value times the visible fraction; `seen` if all of j is below the horizon of i's
  /// eye.
  double corrected(std::size_t i, std::size_t j, double seen) const;

  const PatchMesh& mesh_;
  ElementSet elements_;
  UnoccludedKernel kernel_;
  double pixels_;                      ///< of a hemicube
  std::vector<std::size_t> first_;     ///< N + 1, into patch_elements_
  std::vector<Index> patch_elements_;  ///< elements by patch
};

}  // namespace radiosity
