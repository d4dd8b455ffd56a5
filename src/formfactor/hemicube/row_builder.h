// Rows of the form-factor matrix, one hemicube each.
#pragma once

#include <optional>
#include <vector>

#include "formfactor/hemicube/delta_form_factors.h"
#include "formfactor/hemicube/hemicube.h"
#include "formfactor/hidden_backs.h"
#include "formfactor/view_scene.h"
#include "radiosity/form_factors.h"

namespace radiosity {

/// An eye in the coordinates of the scene that it looks at, as Hemicube::look() wants it.
struct PlacedEye {
  EyeFrame frame;
  Index own = kNone;
};

/// Builds the rows of one computation; made once, read by all threads.
class RowBuilder {
 public:
  /// `mesh` is kept by reference.
  RowBuilder(const PatchMesh& mesh, const FormFactorOptions& options);

  const ViewScene& scene() const { return scene_; }
  const RasterKernels& kernels() const { return kernels_; }
  Hemicube makeHemicube() const { return {scene_, weights_, kernels_, tree_ ? &*tree_ : nullptr}; }
  bool isEmpty(std::size_t patch) const;
  const DeltaFormFactors& weights() const { return weights_; }
  /// The eye of a patch that is not empty, and (`hidden`) which black backs it cannot see.
  PlacedEye eyeOf(std::size_t patch, std::vector<std::uint8_t>& hidden) const;
  /// The same of any eye, as lookFrom() has it.
  PlacedEye place(const Vec3& eye, const Vec3& normal, double angle, Index own,
                  std::vector<std::uint8_t>& hidden) const;
  /// The view from a patch that is not empty. `hidden`: scratch.
  const HemicubeView& look(std::size_t patch, Hemicube& hemicube,
                           std::vector<std::uint8_t>& hidden) const;

  /// The view from any eye (metres) that looks along the unit `normal`, its hemicube turned by
  /// `angle`. `own`: polygon of the mesh the eye lies in, or kNone. `runs`: see Hemicube::look().
  const HemicubeView& lookFrom(const Vec3& eye, const Vec3& normal, double angle, Index own,
                               Hemicube& hemicube, std::vector<std::uint8_t>& hidden,
                               RunVisitor* runs = nullptr) const;

  /// Bytes held by all rows and by one thread, without the matrix.
  std::size_t sharedBytes() const {
    return scene_.bytes() + weights_.bytes() + (tree_ ? tree_->bytes() : 0);
  }

  /// True if hemicubes are drawn front to back, without the hidden polygons.
  bool leavesOutHidden() const { return tree_.has_value(); }

 private:
  bool leavingOutPays() const;

  const PatchMesh& mesh_;
  std::uint64_t seed_;
  bool random_turns_;
  ViewScene scene_;
  HiddenBacks hidden_backs_;
  DeltaFormFactors weights_;
  std::optional<PolygonTree> tree_;  ///< if leaving out hidden polygons pays
  RasterKernels kernels_;
  std::vector<Index> polygon_place_;  ///< position in scene_.polygons of each polygon of the mesh
};

/// A row as it is stored: the patches seen, ascending, and their form factors.
struct PackedRow {
  std::vector<Index> columns;
  std::vector<double> values;
  void pack(const HemicubeView& view, std::size_t patches);
  /// Entries that become 0 are dropped.
  void scale(double factor);

  struct Scaled {
    double rest = 1;      ///< factor of the other entries, backs and sky
    double sky = 0;       ///< to be added to it: what the replaced entries leave if none had more
    bool capped = false;  ///< the replaced entries alone exceeded 1: scaled down to it
  };
  /// Scales a row in which entries were `replaced` (by entry), so that it sums to 1 with backs and
  /// sky, which are `beside` it: the rest keeps its proportions. If there is no rest, a closed row
  /// is scaled whole, and what an open one leaves is sky. Entries of 0 are dropped.
  Scaled scaleRest(const std::vector<std::uint8_t>& replaced, double beside, bool closed);
};

}  // namespace radiosity
