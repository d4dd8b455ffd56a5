// Draws a hemicube's faces: polygons are found, clipped, scan-converted and filled, nearest first.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "formfactor/hemicube/clip.h"
#include "formfactor/hemicube/hemicube.h"

namespace radiosity {
namespace {

/// Below this distance (in scenes of size 1) a plane counts as passing through the eye: it is seen
/// exactly edge-on, and inverse depths would leave the range of single precision. Far below any
/// rounding error of the distance itself.
constexpr double kEdgeOn = 1e-30;

}  // namespace

void Hemicube::transformVertices(const EyeFrame& frame) {
  for (std::size_t v = 0; v < scene_.vertices.size(); ++v) {
    const Vec3 p = frame.toEye(scene_.vertices[v]);
    const bool off_plane = std::abs(p.z) > scene_.coincidence;
    eye_vertices_[v] = p;
    codes_[v] = SignCode(signCode(p) | (off_plane ? kOffPlane : 0u));
  }
}

void Hemicube::collectCandidates(const EyeFrame& frame, Index own, const std::uint8_t* hidden) {
  candidates_.clear();
  for (Index p = 0; p < scene_.polygons.size(); ++p) {
    const ViewPolygon& polygon = scene_.polygons[p];
    unsigned code = 0;
    for (std::uint32_t c = scene_.loop_offset[polygon.loop_begin];
         c < scene_.loop_offset[polygon.loop_end]; ++c) {
      code |= codes_[scene_.corners[c]];
    }
    const double distance = glm::dot(polygon.normal, polygon.origin - frame.eye);
    if (p == own || !(code & kOffPlane) || !(std::abs(distance) > kEdgeOn)) {
      ++counts_.skipped_own_plane;
    } else if (!(code & kAboveHorizon)) {
      ++counts_.skipped_horizon;
    } else if (distance > 0 && hidden && hidden[p]) {
      ++counts_.skipped_facing_away;
    } else {
      candidates_.push_back(
          {p, SignCode(code), &polygon.side[distance > 0], polygon.normal * frame.axes, distance});
    }
  }
}

void Hemicube::prepareFace(const FaceGeometry& face) {
  drawn_.clear();
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

void Hemicube::drawBand(int band) {
  const std::size_t pixels = std::size_t(band_rows_) * std::size_t(stride_);
  kernels_.clear(depth_.data(), buffer_.data(), pixels);
  const FillTarget target{depth_.data(), buffer_.data(), stride_, 0.5F * float(1 - resolution_)};
  for (const BandSpans& part : bands_[std::size_t(band)]) {
    kernels_.fill(target, spans_.data() + part.begin, part.end - part.begin,
                  float(drawn_[part.drawn].inverse_depth.x), part.drawn);
  }
}

/// Clips and scan-converts; false if no pixel centre is inside.
bool Hemicube::scan(const Candidate& candidate, const FaceGeometry& face) {
  const ViewPolygon& polygon = scene_.polygons[candidate.polygon];
  const double half = 0.5 * resolution_;
  const double bottom = face.isTop() ? half : 0.0;
  scan_.begin(resolution_, face.isTop() ? resolution_ : resolution_ / 2);
  for (std::uint32_t l = polygon.loop_begin; l < polygon.loop_end; ++l) {
    loop_.clear();
    for (std::uint32_t c = scene_.loop_offset[l]; c < scene_.loop_offset[l + 1]; ++c) {
      loop_.push_back(face.project(eye_vertices_[scene_.corners[c]]));
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
      pixels_.push_back({half + half * (p.x / p.w), bottom + half * (p.y / p.w)});
    }
    scan_.addLoop(pixels_);
  }
  return true;
}

Hemicube::Drawn Hemicube::prepare(const Candidate& candidate, const FaceGeometry& face) const {
  // A pixel's ray is r = (X, Y, 1), with X and Y in units of half the face; it meets the plane at
  // w r with w = distance / dot(normal, r). A linear function of the point, dot(a, w r) + k, is
  // therefore (dot(a, r) + k / w) / (1 / w): a ratio of functions linear in the pixel.
  const double pixel = 2.0 / resolution_;
  const auto perPixel = [&](const FacePoint& p) { return Vec3(p.x * pixel, p.y * pixel, p.w); };
  const bool uniform = candidate.side->grid == kNone;
  Drawn drawn{uniform ? nullptr : &scene_.grids[candidate.side->grid],
              candidate.side->item,
              candidate.polygon,
              {},
              Vec3(0.0),
              Vec3(0.0),
              Vec3(0.0)};
  drawn.inverse_depth = perPixel(face.project(candidate.normal)) / candidate.distance;
  if (!uniform) {
    const PatchGrid& grid = *drawn.grid;
    const Vec3 eye = frame_.eye - scene_.polygons[candidate.polygon].origin;
    const auto numerator = [&](const Vec3& axis, double offset) {
      return perPixel(face.project(axis * frame_.axes)) +
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
  drawn_.push_back(prepare(candidate, face));
  const auto drawn = std::uint32_t(drawn_.size() - 1);
  const Vec3& plane = drawn_.back().inverse_depth;
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
