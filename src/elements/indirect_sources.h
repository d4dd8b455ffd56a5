// The light of surfaces as sources of indirect light, from pass to pass.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "elements/field_builder.h"
#include "elements/source_cells.h"
#include "elements/surface_points.h"
#include "formfactor/rays/point_rays.h"
#include "radiosity/elements.h"

namespace radiosity {

/// Means of a field over patches, N * bands, from 8 x 8 points of each root; 0 where it was not
/// evaluated.
std::vector<double> patchMeans(const PatchMesh& mesh, const ElementRoots& roots,
                               const ElementLookup& lookup, const ElementField& field,
                               std::size_t bands);

/// What the sources of a scene are found from; all is kept by reference.
struct SourceScene {
  const PatchMesh& mesh;
  const PatchMaterials& materials;
  const ElementSurface& surface;
  const ElementLookup& lookup;
  const PointRays& rays;
  const ElementField& direct;
  std::span<const double> irradiance;  ///< N * bands: of the solution
  /// N * bands: irradiance of the solution without direct light; with it, where that was not
  /// evaluated.
  std::span<const double> solved;
  std::span<const RootUse> use;  ///< R; empty: all are shown
  bool emission;                 ///< what surfaces emit comes with the indirect light
};

/// Each cell of the sources is a patch of its own: rays go from some of its places, once, and each
/// pass computes its light anew from the cells where they end, as Jacobi's iteration does. It
/// begins with the light of the solution, whose patches are coarser, and ends when little changes.
/// The solution knows what rays ought to find if each patch had a single radiosity: by how much
/// they miss that, in the mean of a patch, is added in all passes (a control variate). Roots that
/// are not evaluated keep the light of the solution, but for the share that all others gain.
class IndirectSources {
 public:
  /// `rays`: of a cell, `most_rays`: of all, but for one place a cell.
  IndirectSources(const SourceScene& scene, double rays, double most_rays, std::uint64_t seed);
  /// Rays that leave one place: the fewest of a HemisphereSet.
  static constexpr std::size_t kRaysOfPlace = 16;

  /// Finds where rays end. Throws Cancelled.
  void trace(Progress& progress);
  /// The next pass.
  void pass();
  /// The reflected power of indirect light over all cells and bands, W.
  double reflectedPower() const { return power_; }
  /// The sum of the sizes of the last pass's changes to cells, W.
  double moved() const { return moved_; }
  /// After the last of two passes or more: adds the changes of all further ones, a geometric series
  /// by what all cells together have gained in the last two. (The sizes of changes fall faster at
  /// first: local ones, which cancel, are among them.)
  void extrapolate();

  std::size_t rays() const { return ends_.size(); }
  std::size_t places() const { return cells_.size() * places_; }
  SourceCells takeCells() { return std::move(sources_); }

 private:
  struct Cell {
    Index root;
    std::uint16_t x, y;
  };
  struct Light;
  bool isEvaluated(std::size_t root) const {
    return scene_.use.empty() || scene_.use[root] != RootUse::none;
  }
  /// What surfaces emit with the indirect light, k = patch * bands + band.
  double emitted(std::size_t k) const {
    return scene_.emission ? scene_.materials.emission[k] : 0.0;
  }
  Vec2 placeOf(const Cell& cell, std::size_t k) const;
  double areaOf(const Cell& cell) const;
  std::size_t slotOf(const Cell& cell) const {
    return sources_.first(cell.root) + std::size_t(cell.y) * sources_.side(cell.root) + cell.x;
  }
  void findCorrections();
  void begin();
  void traceCell(std::size_t e);
  void addPlace(std::size_t e, std::size_t p, Light& light) const;
  double lightCell(std::size_t e, std::vector<float>& values, double& gained);
  void keepOthers(std::vector<float>& values) const;

  SourceScene scene_;
  std::size_t bands_;
  std::size_t places_ = 1;  ///< of a cell
  HemisphereSet set_;
  std::uint64_t seed_;
  Background background_;
  SourceCells sources_;
  std::vector<Cell> cells_;    ///< those evaluated
  std::vector<double> area_;   ///< of these
  std::vector<float> direct_;  ///< of these * places * bands
  /// Of these * places * kRaysOfPlace, the first half of a place's rays before the other: sources,
  /// or what a RayEnd has.
  std::vector<std::uint32_t> ends_;
  /// Of these * places * 2 halves * bands: what the rays that end on the sky bring; empty: dark.
  std::vector<float> sky_;
  std::vector<double> correction_;  ///< N * bands: to indirect irradiance; or empty
  std::vector<float> before_;       ///< values, a pass before
  std::vector<double> indirect_;    ///< of cells evaluated * bands: mean irradiance
  double solved_power_ = 0;
  double power_ = 0;
  double moved_ = 0;
  double gained_ = 0;  ///< in the last pass, W
  double gained_before_ = 0;
};

}  // namespace radiosity
