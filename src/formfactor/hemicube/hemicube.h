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
//
// If most polygons are hidden, whole faces are drawn, polygons front to back, and boxes of polygons
// behind those drawn are left out (front_to_back.cpp). The pixels are the same; the cost follows
// the visible polygons.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "base/aligned_buffer.h"
#include "base/geometry/box.h"
#include "base/geometry/box_tree.h"
#include "formfactor/hemicube/box_on_face.h"
#include "formfactor/hemicube/delta_form_factors.h"
#include "formfactor/hemicube/eye_frame.h"
#include "formfactor/hemicube/face_buffer.h"
#include "formfactor/hemicube/face_geometry.h"
#include "formfactor/hemicube/polygon_tree.h"
#include "formfactor/hemicube/raster_kernels.h"
#include "formfactor/hemicube/scan_conversion.h"
#include "formfactor/view_scene.h"
#include "radiosity/form_factors.h"

namespace radiosity {

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

/// Receives a view run by run, for callers that need more than a sum by item.
class RunVisitor {
 public:
  virtual ~RunVisitor() = default;
  /// Runs may be empty.
  virtual void visit(const ItemRun& run) = 0;
};

/// Draws hemicubes of one scene, one after the other. Holds its own scratch memory: one a thread.
class Hemicube {
 public:
  /// The arguments are kept by reference (except `kernels`) and must outlive the hemicube. `tree`:
  /// the scene's; polygons are then drawn front to back without the hidden ones. Null: all are
  /// drawn. Both give the same view.
  Hemicube(const ViewScene& scene, const DeltaFormFactors& weights, const RasterKernels& kernels,
           const PolygonTree* tree = nullptr);

  /// Looks from `frame` (in the scene's scaled coordinates). `own`: position in scene.polygons of
  /// the polygon the eye lies in, never drawn; kNone for an eye in free space. `hidden[p]` != 0
  /// says the black back of polygon p cannot be seen from here; may be null. `runs`, if given,
  /// receives all runs; of the view only the sums by kind are then made.
  const HemicubeView& look(const EyeFrame& frame, Index own, const std::uint8_t* hidden,
                           RunVisitor* runs = nullptr);

  const HemicubeReport& counts() const { return counts_; }
  /// Returns the counts and sets them to 0.
  HemicubeReport takeCounts() { return std::exchange(counts_, {}); }

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
    const ViewPolygon* shape;
    std::uint32_t first_corner;  ///< into eye_corners_
    SignCode code;               ///< of all its corners
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

  /// A node of the tree that is still to be looked at, and the faces (bits) on which it is known
  /// to be out of sight.
  struct Pending {
    double squared_distance;  ///< of its nearest place
    Index node;
    unsigned outside, hidden;
    unsigned settled() const { return outside | hidden; }
    /// In a heap, the nearest is the largest.
    bool operator<(const Pending& other) const {
      return std::tie(other.squared_distance, other.node) < std::tie(squared_distance, node);
    }
  };
  /// The extent of the polygon that scan() has projected, and its least distance along the axis.
  struct Extent {
    Box2 pixels;
    double least_w;
  };

  void collectCandidates();
  Vec3 cornerAt(std::uint32_t c) const {
    return tree_ != nullptr ? tree_->corners[c] : scene_.vertices[scene_.corners[c]];
  }
  bool findCandidate(Index p, const ViewPolygon& shape, Candidate& candidate);
  void prepareFace(const FaceGeometry& face);
  bool scan(const Candidate& candidate, const FaceGeometry& face);
  void queueSpans(const Candidate& candidate, const FaceGeometry& face);
  Vec3 inverseDepth(const Candidate& candidate, const FaceGeometry& face) const;
  Drawn prepare(const Candidate& candidate, const FaceGeometry& face) const;
  void drawBand(const FaceGeometry& face, int band);

  void drawFrontToBack();
  bool isOffHorizon(const Box3& box, std::size_t polygons);
  bool isSettled(const Box3& box, std::size_t polygons, Pending& pending);
  void lookAtFaces(const Box3& box, Pending& pending);
  void pushChildren(const Pending& pending);
  void countUnseen(const Pending& pending, std::size_t polygons);
  void drawLeaf(const BoxTree::Node& leaf, const Pending& pending);
  void drawPolygon(Index place, Pending pending);
  bool drawOnFace(const Candidate& candidate, const FaceGeometry& face);
  void placeDrawn(const FaceGeometry& face);
  Drawn& drawnAs(const FaceGeometry& face, std::uint32_t value) {
    std::vector<Drawn>& drawn = drawn_[face.index()];
    return drawn[tree_ == nullptr ? value : place_[value]];
  }
  /// Draws a face band by band and calls visit(y, row of drawn polygons) for its rows, ascending.
  template <class Visit>
  void drawFace(const FaceGeometry& face, const Visit& visit);
  /// Sinks for runs, with add(item, begin, end, weight): a sum by item, or a visitor.
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
  const PolygonTree* tree_;
  const std::vector<std::uint32_t>& loop_offset_;  ///< of the tree or the scene
  EyeFrame frame_;
  BoxesFromEye from_eye_{frame_};
  Index own_ = kNone;
  const std::uint8_t* hidden_ = nullptr;
  HemicubeView view_;
  HemicubeReport counts_;
  std::vector<Vec3> eye_corners_;  ///< of the candidates, in the eye's frame
  std::vector<Candidate> candidates_;
  std::array<std::vector<Drawn>, kFaces> drawn_;
  std::vector<FacePoint> loop_;
  std::vector<FacePoint> clipped_;
  std::vector<ScanConversion::Point> pixels_;
  Extent extent_{};
  ScanConversion scan_;
  std::vector<Span> spans_;
  std::vector<std::vector<BandSpans>> bands_;
  AlignedBuffer<float> depth_;           ///< of one band
  AlignedBuffer<std::uint32_t> buffer_;  ///< of one band: positions in drawn_
  /// For drawing front to back: buffers of whole faces, of positions in scene_.polygons; the
  /// position in drawn_ of each of these that is drawn; a heap of nodes still to be looked at.
  std::vector<FaceBuffer> faces_;
  std::vector<Index> place_;
  std::vector<Pending> pending_;
  AlignedBuffer<std::int32_t> polygon_runs_;
  /// Runs of one cell in one row, `cell_count_` of them: where each starts, and in which cell.
  AlignedBuffer<std::int32_t> cell_starts_;
  AlignedBuffer<std::int32_t> cells_;
  std::size_t cell_count_ = 0;
  std::vector<double> sums_;  ///< by item, the sky last
};

}  // namespace radiosity
