// Draws a hemicube's faces: polygons are found, clipped, scan-converted and filled, nearest first.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "formfactor/hemicube/clip.h"
#include "formfactor/hemicube/hemicube.h"

namespace radiosity {
namespace {

/// Below this distance (in scenes of size 1) a plane counts as passing through the eye: it is seen
/// exactly edge-on, and inverse depths would leave the range of single precision. Far below any
/// rounding error of the distance itself.
constexpr double kEdgeOn = 1e-30;

/// Coefficients of (x, y, 1), pixels from the middle of the face, of a dot product with a ray.
Vec3 perPixel(const FacePoint& p, int resolution) {
  const double pixel = 2.0 / resolution;
  return {p.x * pixel, p.y * pixel, p.w};
}

}  // namespace

/// False, with the polygon counted, if the eye sees it on no face.
bool Hemicube::findCandidate(Index p, const ViewPolygon& shape, Candidate& candidate) {
  const auto first_corner = std::uint32_t(eye_corners_.size());
  unsigned code = 0;
  for (std::uint32_t c = loop_offset_[shape.loop_begin]; c < loop_offset_[shape.loop_end]; ++c) {
    const Vec3 corner = frame_.toEye(cornerAt(c));
    code |= signCode(corner) | (std::abs(corner.z) > scene_.coincidence ? kOffPlane : 0u);
    eye_corners_.push_back(corner);
  }
  const double distance = glm::dot(shape.normal, shape.origin - frame_.eye);
  if (p == own_ || !(code & kOffPlane) || !(std::abs(distance) > kEdgeOn)) {
    ++counts_.skipped_own_plane;
    return false;
  }
  if (!(code & kAboveHorizon)) {
    ++counts_.skipped_horizon;
    return false;
  }
  if (distance > 0 && hidden_ && hidden_[p]) {
    ++counts_.skipped_facing_away;
    return false;
  }
  candidate = {p,
               &shape,
               first_corner,
               SignCode(code),
               &shape.side[distance > 0],
               shape.normal * frame_.axes,
               distance};
  return true;
}

void Hemicube::collectCandidates() {
  candidates_.clear();
  eye_corners_.clear();
  Candidate candidate{};
  for (Index p = 0; p < scene_.polygons.size(); ++p) {
    const std::size_t corners = eye_corners_.size();
    if (findCandidate(p, scene_.polygons[p], candidate)) {
      candidates_.push_back(candidate);
    } else {
      eye_corners_.resize(corners);
    }
  }
}

void Hemicube::prepareFace(const FaceGeometry& face) {
  drawn_[face.index()].clear();
  spans_.clear();
  for (std::vector<BandSpans>& band : bands_) band.clear();
  for (const Candidate& candidate : candidates_) {
    if (!face.mayCover(candidate.code)) {
      ++counts_.skipped_face;
    } else if (scan(candidate, face)) {
      queueSpans(candidate, face);
    }
  }
}

void Hemicube::drawBand(const FaceGeometry& face, int band) {
  const std::size_t pixels = std::size_t(band_rows_) * std::size_t(stride_);
  kernels_.clear(depth_.data(), buffer_.data(), pixels);
  const FillTarget target{depth_.data(), buffer_.data(), stride_, 0.5F * float(1 - resolution_)};
  for (const BandSpans& part : bands_[std::size_t(band)]) {
    kernels_.fill(target, spans_.data() + part.begin, part.end - part.begin,
                  float(drawn_[face.index()][part.drawn].inverse_depth.x), part.drawn);
  }
}

/// Clips and scan-converts; false if no pixel centre is inside.
bool Hemicube::scan(const Candidate& candidate, const FaceGeometry& face) {
  const ViewPolygon& shape = *candidate.shape;
  const double half = 0.5 * resolution_;
  const double bottom = face.isTop() ? half : 0.0;
  scan_.begin(resolution_, rowCount(face));
  extent_ = {{}, std::numeric_limits<double>::infinity()};
  const Vec3* corner = eye_corners_.data() + candidate.first_corner;
  for (std::uint32_t l = shape.loop_begin; l < shape.loop_end; ++l) {
    loop_.clear();
    for (std::uint32_t c = loop_offset_[l]; c < loop_offset_[l + 1]; ++c) {
      loop_.push_back(face.project(*corner++));
    }
    for (const SidePlane plane : kSidePlanes) {
      if (!(candidate.code & face.outsideBit(plane))) continue;
      clipLoop(loop_, face, plane, clipped_);
      loop_.swap(clipped_);
    }
    if (loop_.empty()) continue;
    pixels_.clear();
    for (const FacePoint& p : loop_) {
      // Only the eye itself has w = 0 inside the pyramid: the polygon passes through the eye to
      // within rounding and is seen edge-on.
      if (!(p.w > 0)) return false;
      const double x = half + half * (p.x / p.w);
      const double y = bottom + half * (p.y / p.w);
      pixels_.push_back({x, y});
      extent_.pixels.add({x, y});
      extent_.least_w = std::min(extent_.least_w, p.w);
    }
    scan_.addLoop(pixels_);
  }
  return true;
}

/// See prepare().
Vec3 Hemicube::inverseDepth(const Candidate& candidate, const FaceGeometry& face) const {
  return perPixel(face.project(candidate.normal), resolution_) / candidate.distance;
}

Hemicube::Drawn Hemicube::prepare(const Candidate& candidate, const FaceGeometry& face) const {
  // A pixel's ray is r = (X, Y, 1), with X and Y in units of half the face; it meets the plane at
  // w r with w = distance / dot(normal, r). A linear function of the point, dot(a, w r) + k, is
  // therefore (dot(a, r) + k / w) / (1 / w): a ratio of functions linear in the pixel.
  const bool uniform = candidate.side->grid == kNone;
  Drawn drawn{uniform ? nullptr : &scene_.grids[candidate.side->grid],
              candidate.side->item,
              candidate.polygon,
              {},
              Vec3(0.0),
              Vec3(0.0),
              Vec3(0.0)};
  drawn.inverse_depth = inverseDepth(candidate, face);
  if (!uniform) {
    const PatchGrid& grid = *drawn.grid;
    const Vec3 eye = frame_.eye - candidate.shape->origin;
    const auto numerator = [&](const Vec3& axis, double offset) {
      return perPixel(face.project(axis * frame_.axes), resolution_) +
             (glm::dot(axis, eye) + offset) * drawn.inverse_depth;
    };
    drawn.u = numerator(grid.uAxis(), grid.uOffset());
    drawn.v = numerator(grid.vAxis(), grid.vOffset());
    drawn.map.u_slope = float(drawn.u.x);
    drawn.map.v_slope = float(drawn.v.x);
    drawn.map.w_slope = float(drawn.inverse_depth.x);
    drawn.map.first_centre = 0.5F * float(1 - resolution_);
    drawn.map.last_column = float(grid.columns() - 1);
    drawn.map.last_row = float(grid.rows() - 1);
    drawn.map.columns = float(grid.columns());
    drawn.map.first_cell = scene_.first_cell[candidate.side->grid];
  }
  return drawn;
}

/// Turns the runs just scanned into spans with depths, band by band.
void Hemicube::queueSpans(const Candidate& candidate, const FaceGeometry& face) {
  const std::vector<PixelRun>& runs = scan_.finish();
  ++counts_.rasterised_polygons;
  if (runs.empty()) return;
  std::vector<Drawn>& all = drawn_[face.index()];
  all.push_back(prepare(candidate, face));
  const auto drawn = std::uint32_t(all.size() - 1);
  const Vec3& plane = all.back().inverse_depth;
  int band = -1;
  for (const PixelRun& run : runs) {
    if (run.y / band_rows_ != band) {
      band = run.y / band_rows_;
      const auto first = std::uint32_t(spans_.size());
      bands_[std::size_t(band)].push_back({drawn, first, first});
    }
    const double depth = plane.y * rowHeight(face, run.y) + plane.z;
    spans_.push_back({run.y - band * band_rows_, run.begin, run.end, float(depth)});
    ++bands_[std::size_t(band)].back().end;
  }
}

}  // namespace radiosity
