#include "formfactor/hemicube/hemicube.h"

#include <algorithm>

namespace radiosity {
namespace {

/// Pixels of a band: 8 bytes each, together less than half of a first-level cache of 32 KiB.
constexpr int kBandPixels = 2048;

/// The first whole number not less than x, within [begin, end].
int firstFrom(double x, int begin, int end) {
  const double above = x > begin ? x : begin;
  const double inside = above < end ? above : end;
  const int below = int(inside);  // std::ceil is a library call without SSE4.1
  return below + int(below < inside);
}

int roundUp(int x, int multiple) { return (x + multiple - 1) / multiple * multiple; }

}  // namespace

Hemicube::Hemicube(const ViewScene& scene, const DeltaFormFactors& weights,
                   const RasterKernels& kernels, const PolygonTree* tree)
    : scene_(scene),
      weights_(weights),
      kernels_(kernels),
      resolution_(weights.resolution()),
      stride_(roundUp(weights.resolution(), kRowAlignment)),
      band_rows_(std::max(1, kBandPixels / stride_)),
      tree_(tree),
      loop_offset_(tree == nullptr ? scene.loop_offset : tree->loop_offset),
      scan_(kernels) {
  sums_.resize(scene.items + 1);
  view_.items = std::span(sums_).first(scene.items);
  bands_.resize(std::size_t((resolution_ + band_rows_ - 1) / band_rows_));
  const std::size_t band = std::size_t(stride_) * std::size_t(band_rows_);
  const std::size_t row = std::size_t(stride_) + kRowAlignment;
  depth_.reserve(band);
  buffer_.reserve(band);
  polygon_runs_.reserve(row);
  cells_.reserve(row);
  cell_starts_.reserve(row);
  if (tree_ == nullptr) return;
  for (int face = 0; face < kFaces; ++face) {
    faces_.emplace_back(resolution_, rowCount(FaceGeometry(face)));
  }
  place_.resize(scene.polygons.size());
}

std::size_t Hemicube::bytes() const {
  std::size_t sum = (depth_.size() + buffer_.size()) * 4 + sums_.size() * sizeof(double) +
                    eye_corners_.capacity() * sizeof(Vec3);
  for (const FaceBuffer& face : faces_) sum += face.bytes();
  for (const std::vector<Drawn>& drawn : drawn_) sum += drawn.capacity() * sizeof(Drawn);
  return sum + place_.size() * sizeof(Index) + candidates_.capacity() * sizeof(Candidate);
}

class Hemicube::ItemSums {
 public:
  explicit ItemSums(std::vector<double>& sums) : sums_(sums.data()) {}
  void add(std::int32_t item, int /*begin*/, int /*end*/, double weight) const {
    sums_[std::size_t(item)] += weight;
  }

 private:
  double* sums_;
};

class Hemicube::VisitedRuns {
 public:
  VisitedRuns(RunVisitor& runs, const ItemRun& row) : runs_(runs), row_(row) {}
  void add(std::int32_t item, int begin, int end, double /*weight*/) const {
    ItemRun run = row_;
    run.item = std::uint32_t(item);
    run.begin = begin;
    run.end = end;
    runs_.visit(run);
  }

 private:
  RunVisitor& runs_;
  ItemRun row_;
};

const HemicubeView& Hemicube::look(const EyeFrame& frame, Index own, const std::uint8_t* hidden,
                                   RunVisitor* runs) {
  frame_ = frame;
  own_ = own;
  hidden_ = hidden;
  std::fill(sums_.begin(), sums_.end(), 0.0);
  view_.fronts = view_.backs = view_.sky = 0;
  tree_ != nullptr ? drawFrontToBack() : collectCandidates();
  for (int index = 0; index < kFaces; ++index) {
    const FaceGeometry face(index);
    drawFace(face, [&](int y, const std::uint32_t* row) {
      if (runs == nullptr) return sumRow(face, y, row, ItemSums(sums_));
      const ItemRun whole{kSky, face, rowHeight(face, y), 0.5 * (1 - resolution_),
                          0,    0,    weightsOf(face, y)};
      sumRow(face, y, row, VisitedRuns(*runs, whole));
    });
    counts_.pixels += std::size_t(rowCount(face)) * std::size_t(resolution_);
  }
  ++counts_.hemicubes;
  return view_;
}

template <class Visit>
void Hemicube::drawFace(const FaceGeometry& face, const Visit& visit) {
  const int rows = rowCount(face);
  if (tree_ != nullptr) {
    placeDrawn(face);
    for (int y = 0; y < rows; ++y) visit(y, faces_[face.index()].row(y));
    return;
  }
  prepareFace(face);
  for (int y = 0; y < rows; y += band_rows_) {
    drawBand(face, y / band_rows_);
    for (int k = 0; k < std::min(band_rows_, rows - y); ++k) {
      visit(y + k, buffer_.data() + std::size_t(k) * std::size_t(stride_));
    }
  }
}

void Hemicube::redraw() {
  if (tree_ != nullptr) return drawFrontToBack();
  for (int face = 0; face < kFaces; ++face) {
    drawFace(FaceGeometry(face), [](int, const std::uint32_t*) {});
  }
}

std::vector<Index> Hemicube::picture(int index) {
  const FaceGeometry face(index);
  std::vector<Index> polygons;
  drawFace(face, [&](int, const std::uint32_t* row) {
    for (int x = 0; x < resolution_; ++x) {
      polygons.push_back(row[x] == kSky ? kNone : drawnAs(face, row[x]).polygon);
    }
  });
  return polygons;
}

/// Divides a row into runs of one cell, then sums them in one go.
template <class Sink>
void Hemicube::sumRow(const FaceGeometry& face, int y, const std::uint32_t* row, const Sink& sink) {
  const double* weights = weightsOf(face, y);
  const std::int32_t* runs = polygon_runs_.data();
  const std::size_t count = kernels_.findRuns(row, resolution_, polygon_runs_.data());
  const auto append = [&](int begin, std::int32_t cell) {
    cell_starts_.data()[cell_count_] = begin;
    cells_.data()[cell_count_++] = cell;
  };
  cell_count_ = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const int begin = runs[k];
    const int end = runs[k + 1];
    const double weight = weights[end] - weights[begin];
    if (row[begin] == kSky) {
      view_.sky += weight;
      append(begin, scene_.skyCell());
      continue;
    }
    Drawn& drawn = drawnAs(face, row[begin]);
    if (drawn.grid != nullptr) {
      view_.fronts += weight;
      locatePatches(drawn, rowHeight(face, y), begin, end, weights, sink);
    } else {
      append(begin, std::int32_t(drawn.item));
      (drawn.item < scene_.patches ? view_.fronts : view_.backs) += weight;
    }
  }
  sumCells(resolution_, weights, sink);
}

/// Adds the weights of the row's runs of cells, the last of which ends at pixel `end`, to the
/// cells' items. One long loop for the whole row: runs are short, and a loop for each polygon would
/// spend its time on mispredicted ends.
template <class Sink>
void Hemicube::sumCells(int end, const double* weights, const Sink& sink) {
  const std::int32_t* starts = cell_starts_.data();
  const std::int32_t* cells = cells_.data();
  const std::int32_t* const items = scene_.cells.data();
  cell_starts_.data()[cell_count_] = end;
  double before = cell_count_ > 0 ? weights[starts[0]] : 0;
  for (std::size_t k = 0; k < cell_count_; ++k) {
    const double after = weights[starts[k + 1]];
    sink.add(items[cells[k]], starts[k], starts[k + 1], after - before);
    before = after;
  }
}

/// Appends the cells of a run of pixels of one polygon to the row's. If several patches may share a
/// cell, they are summed at once instead, together with the runs before them.
template <class Sink>
void Hemicube::locatePatches(Drawn& drawn, double height, int begin, int end, const double* weights,
                             const Sink& sink) {
  const auto onRow = [&](const Vec3& linear) {
    return RowLinear{linear.x, linear.y * height + linear.z};
  };
  const RowCoordinates row{onRow(drawn.u), onRow(drawn.v), onRow(drawn.inverse_depth)};
  RowMap& map = drawn.map;
  map.u = float(row.u.base);
  map.v = float(row.v.base);
  map.w = float(row.w.base);
  if (!drawn.grid->hasTrees()) {
    cell_count_ += kernels_.locate(map, begin, end, cell_starts_.data() + cell_count_,
                                   cells_.data() + cell_count_);
    return;
  }
  sumCells(begin, weights, sink);
  cell_count_ = 0;
  std::int32_t* starts = cell_starts_.data();
  const std::size_t count = kernels_.locate(map, begin, end, starts, cells_.data());
  starts[count] = end;
  for (std::size_t k = 0; k < count; ++k) {
    const std::int32_t entry = scene_.cells[std::size_t(cells_.data()[k])];
    if (entry >= 0) {
      sink.add(entry, starts[k], starts[k + 1], weights[starts[k + 1]] - weights[starts[k]]);
    } else {
      sumCell(*drawn.grid, row, starts[k], starts[k + 1], entry, weights, sink);
    }
  }
}

/// Divides a run of pixels within one cell among the patches that share it. A line of the cell's
/// tree, a u + b v + c with u = U/W and v = V/W, has the sign of a U + b V + c W, which is linear
/// along the row: the run falls into at most two parts.
template <class Sink>
void Hemicube::sumCell(const PatchGrid& grid, const RowCoordinates& row, int begin, int end,
                       std::int32_t entry, const double* weights, const Sink& sink) {
  const double first_centre = 0.5 * (1 - resolution_);
  while (entry < 0) {
    const CellNode& node = grid.node(~entry);
    const double slope = node.a * row.u.slope + node.b * row.v.slope + node.c * row.w.slope;
    const double base = node.a * row.u.base + node.b * row.v.base + node.c * row.w.base;
    if (slope == 0) {
      entry = base >= 0 ? node.inside : node.outside;
      continue;
    }
    const std::int32_t left = slope > 0 ? node.outside : node.inside;
    const std::int32_t right = slope > 0 ? node.inside : node.outside;
    const int middle = firstFrom(-base / slope - first_centre, begin, end);
    if (left >= 0 && right >= 0) {
      // The common case, without a branch: an empty part adds 0.
      sink.add(left, begin, middle, weights[middle] - weights[begin]);
      sink.add(right, middle, end, weights[end] - weights[middle]);
      return;
    }
    if (middle == begin) {
      entry = right;
    } else {
      if (middle < end) sumCell(grid, row, middle, end, right, weights, sink);
      end = middle;
      entry = left;
    }
  }
  sink.add(entry, begin, end, weights[end] - weights[begin]);
}

}  // namespace radiosity
