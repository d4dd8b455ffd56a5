// One eye's view through a hemicube: form factors by patch.
//
// Cohen & Greenberg 1985, with two changes. The item buffer holds the scene's planar polygons, not
// its patches; the patch is found afterwards, for the visible pixels only, from the pixel's
// position in the polygon's plane. So the cost of drawing follows the polygons, and a finer mesh
// costs only more look-ups. And a row of pixels is summed by runs: a run of one patch is one
// difference of the delta form factors' running sums.
//
// Pictures are in pixels, centres at half-integers; x runs from 0 to the resolution, y from 0
// upwards, on side faces from the horizon to half the resolution. Depths are inverse distances
// along the face's axis, linear in the pixel coordinates, so the plane of a polygon needs no
// division per pixel. A face is drawn and summed in bands of rows that stay in the first-level
// cache: clearing, depth tests and sums are then bound by arithmetic, not by memory.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/aligned_buffer.h"
#include "formfactor/hemicube/delta_form_factors.h"
#include "formfactor/hemicube/eye_frame.h"
#include "formfactor/hemicube/face_geometry.h"
#include "formfactor/hemicube/raster_kernels.h"
#include "formfactor/hemicube/scan_conversion.h"
#include "formfactor/view_scene.h"

namespace radiosity {

/// Counts of polygons drawn and skipped, summed over hemicubes. See FormFactorReport.
struct HemicubeCounts {
  std::size_t hemicubes = 0;
  std::size_t rasterised_polygons = 0;
  std::size_t skipped_own_plane = 0;
  std::size_t skipped_horizon = 0;
  std::size_t skipped_facing_away = 0;
  std::size_t skipped_face = 0;
  std::size_t pixels = 0;
  std::size_t sky_pixels = 0;
  HemicubeCounts& operator+=(const HemicubeCounts& other);
};

/// Form factors from an eye to every item, and their sums by kind, which add up to 1.
struct HemicubeView {
  std::span<const double> items;  ///< ViewScene::items values: patches, then black backs by surface
  double fronts = 0;              ///< sum over patches
  double backs = 0;               ///< sum over black backs
  double sky = 0;
};

/// Pixels [begin, end) of one row of a face that see one item. Pixel x has its centre at
/// (x + first_centre, height) from the middle of the face, in pixels.
struct ItemRun {
  std::uint32_t item;  ///< patch, black back or (ViewScene::items) the sky
  FaceGeometry face;
  double height;
  double first_centre;
  int begin;
  int end;
  const double* weights;  ///< running sums: pixel x is worth weights[x + 1] - weights[x]
};

/// Receives what an eye sees run by run, where a sum by item says too little.
class RunVisitor {
 public:
  virtual ~RunVisitor() = default;
  /// Runs may be empty.
  virtual void visit(const ItemRun& run) = 0;
};

/// Draws hemicubes of one scene, one after the other. Holds its own scratch memory: one a thread.
class Hemicube {
 public:
  /// The arguments are kept by reference (except `kernels`) and must outlive the hemicube.
  Hemicube(const ViewScene& scene, const DeltaFormFactors& weights, const RasterKernels& kernels);

  /// Looks from `frame` (in the scene's scaled coordinates). `own`: position in scene.polygons of
  /// the polygon the eye lies in, never drawn; kNone for an eye in free space. `hidden[p]` != 0
  /// says the black back of polygon p cannot be seen from here; may be null. Where `runs` is given
  /// it receives all runs, and of the view only the sums by kind are made.
  const HemicubeView& look(const EyeFrame& frame, Index own, const std::uint8_t* hidden,
                           RunVisitor* runs = nullptr);

  const HemicubeCounts& counts() const { return counts_; }
  /// The same, which then start anew.
  HemicubeCounts takeCounts() { return std::exchange(counts_, {}); }

  /// One face of the last view, for tests and comparisons: positions in scene.polygons, or kNone;
  /// rows(face) rows of `resolution` pixels.
  std::vector<Index> picture(int face);
  /// Draws all faces of the last view again without looking at them, to time drawing alone.
  void redraw();
  int rows(int face) const { return rowCount(FaceGeometry(face)); }

  /// Bytes of scratch memory.
  std::size_t bytes() const;

 private:
  /// A polygon that may be seen, in the eye's frame.
  struct Candidate {
    Index polygon;
    SignCode code;  ///< of all its corners
    const PolygonSide* side;
    Vec3 normal;      ///< in the eye's frame
    double distance;  ///< of the plane: dot(normal, p) = distance
  };
  /// A candidate as drawn on the current face. Read once for each run of pixels: the members that
  /// this needs lie together and behind no other pointer.
  struct Drawn {
    const PatchGrid* grid;  ///< null: one item everywhere
    std::uint32_t item;     ///< that item
    Index polygon;
    RowMap map;          ///< to grid cells; u, v and w are those of the row being summed
    Vec3 inverse_depth;  ///< coefficients of (x, y, 1), pixels from the middle of the face
    Vec3 u, v;           ///< the same for the grid coordinates' numerators
  };

  /// Spans [begin, end) of one drawn polygon that lie in one band.
  struct BandSpans {
    std::uint32_t drawn, begin, end;
  };

  /// slope * x + base, with x the pixel centre from the middle of the face.
  struct RowLinear {
    double slope, base;
  };
  /// Grid coordinates along a row of pixels: u / w and v / w.
  struct RowCoordinates {
    RowLinear u, v, w;
  };

  void transformVertices(const EyeFrame& frame);
  void collectCandidates(const EyeFrame& frame, Index own, const std::uint8_t* hidden);
  void prepareFace(const FaceGeometry& face);
  bool scan(const Candidate& candidate, const FaceGeometry& face);
  void queueSpans(const Candidate& candidate, const FaceGeometry& face);
  Drawn prepare(const Candidate& candidate, const FaceGeometry& face) const;
  void drawBand(int band);
  /// Draws a face band by band and calls visit(y, row of drawn polygons) for its rows, ascending.
  template <class Visit>
  void drawFace(const FaceGeometry& face, const Visit& visit);
  /// Where runs go, add(item, begin, end, weight): into a sum by item, or to a visitor.
  class ItemSums;
  class VisitedRuns;
  template <class Sink>
  void sumRow(const FaceGeometry& face, int y, const std::uint32_t* row, const Sink& sink);
  template <class Sink>
  void locatePatches(Drawn& drawn, double height, int begin, int end, const double* weights,
                     const Sink& sink);
  template <class Sink>
  void sumCells(int end, const double* weights, const Sink& sink);
  template <class Sink>
  void sumCell(const PatchGrid& grid, const RowCoordinates& row, int begin, int end,
               std::int32_t entry, const double* weights, const Sink& sink);
  const double* weightsOf(const FaceGeometry& face, int y) const {
    return face.isTop() ? weights_.topRow(y) : weights_.sideRow(y);
  }
  /// Height of a row's pixel centres above the middle of the face, in pixels; on side faces the
  /// middle of the picture plane is the horizon.
  double rowHeight(const FaceGeometry& face, int y) const {
    return face.isTop() ? y + 0.5 * (1 - resolution_) : y + 0.5;
  }
  int rowCount(const FaceGeometry& face) const {
    return face.isTop() ? resolution_ : resolution_ / 2;
  }

  const ViewScene& scene_;
  const DeltaFormFactors& weights_;
  RasterKernels kernels_;
  int resolution_;
  int stride_;
  int band_rows_;  ///< rows drawn at a time: a band stays in the first-level cache
  EyeFrame frame_;
  HemicubeView view_;
  HemicubeCounts counts_;
  std::vector<Vec3> eye_vertices_;
  std::vector<SignCode> codes_;
  std::vector<Candidate> candidates_;
  std::vector<Drawn> drawn_;
  std::vector<FacePoint> loop_;
  std::vector<FacePoint> clipped_;
  std::vector<ScanConversion::Point> pixels_;
  ScanConversion scan_;
  std::vector<Span> spans_;
  std::vector<std::vector<BandSpans>> bands_;
  AlignedBuffer<float> depth_;           ///< of one band
  AlignedBuffer<std::uint32_t> buffer_;  ///< of one band: positions in drawn_
  AlignedBuffer<std::int32_t> polygon_runs_;
  /// Runs of one cell in one row, `cell_count_` of them: where each starts, and in which cell.
  AlignedBuffer<std::int32_t> cell_starts_;
  AlignedBuffer<std::int32_t> cells_;
  std::size_t cell_count_ = 0;
  std::vector<double> sums_;  ///< by item, the sky last
};

}  // namespace radiosity
