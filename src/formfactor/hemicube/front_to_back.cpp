// Draws a hemicube's polygons front to back, without the hidden ones: a node of a tree of boxes is
// left out if all pixels that it may cover are nearer (Greene, Kass & Miller 1993, with boxes for
// octants).
#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "formfactor/hemicube/box_on_face.h"
#include "formfactor/hemicube/hemicube.h"

namespace radiosity {
namespace {

constexpr unsigned kAllFaces = (1u << kFaces) - 1;
/// Depths of polygons that are seen nearly edge-on are rounded by more than their last bits. A box
/// knows nothing of the planes in it, so its depth allows for this much, relative.
constexpr double kBoxMargin = 1e-4;
/// Three roundings to single precision, relative to the largest term of a depth.
constexpr double kRoundings = 0x1p-22;

/// The square of the distance to the nearest place in a box.
double squaredDistance(const Box3& box, const Vec3& from) {
  const Vec3 away = from - glm::clamp(from, box.low, box.high);
  return glm::dot(away, away);
}

}  // namespace

void Hemicube::drawFrontToBack() {
  for (FaceBuffer& face : faces_) face.clear(kernels_);
  for (std::vector<Drawn>& drawn : drawn_) drawn.clear();
  const std::vector<BoxTree::Node>& nodes = tree_->boxes.nodes();
  if (nodes.empty()) return;
  from_eye_ = BoxesFromEye(frame_);
  pending_.assign(1, {0, 0, 0, 0});
  while (!pending_.empty()) {
    std::pop_heap(pending_.begin(), pending_.end());
    Pending pending = pending_.back();
    pending_.pop_back();
    const BoxTree::Node& node = nodes[pending.node];
    if (isSettled(node.bound, node.below, pending)) continue;
    node.count == 0 ? pushChildren(pending) : drawLeaf(node, pending);
  }
}

void Hemicube::drawLeaf(const BoxTree::Node& leaf, const Pending& pending) {
  for (Index place = leaf.first; place < leaf.first + leaf.count; ++place) {
    Pending of_polygon = pending;
    if (isSettled(tree_->boxes.boxes()[place], 1, of_polygon)) continue;
    drawPolygon(place, of_polygon);
  }
}

/// True, with the polygons counted, if none of those in a box can be seen.
bool Hemicube::isSettled(const Box3& world_box, std::size_t polygons, Pending& pending) {
  const Box3 box = from_eye_(world_box);
  if (isOffHorizon(box, polygons)) return true;
  lookAtFaces(box, pending);
  if (pending.settled() != kAllFaces) return false;
  countUnseen(pending, polygons);
  return true;
}

/// True, with the polygons counted, if all of a box lies below the horizon or in its plane.
bool Hemicube::isOffHorizon(const Box3& box, std::size_t polygons) {
  if (box.high.z > scene_.coincidence) return false;
  if (box.high.z < -scene_.coincidence) {
    counts_.skipped_horizon += polygons;
    return true;
  }
  if (box.low.z < -scene_.coincidence) return false;
  counts_.skipped_own_plane += polygons;
  return true;
}

/// Settles the faces on which no pixel can show anything of the box, which is in the eye's frame.
void Hemicube::lookAtFaces(const Box3& box, Pending& pending) {
  for (int index = 0; index < kFaces; ++index) {
    const unsigned bit = 1u << index;
    if (pending.settled() & bit) continue;
    const BoxOnFace on = boxOnFace(box, FaceGeometry(index), resolution_);
    if (on.pixels.isEmpty()) {
      pending.outside |= bit;
    } else if (faces_[std::size_t(index)].hides(on.pixels, (1 + kBoxMargin) * on.nearest)) {
      pending.hidden |= bit;
    }
  }
}

void Hemicube::pushChildren(const Pending& pending) {
  const Index first = tree_->boxes.nodes()[pending.node].first;
  for (Index node = first; node < first + 2; ++node) {
    const double distance = squaredDistance(tree_->boxes.nodes()[node].bound, frame_.eye);
    pending_.push_back({distance, node, pending.outside, pending.hidden});
    std::push_heap(pending_.begin(), pending_.end());
  }
}

void Hemicube::countUnseen(const Pending& pending, std::size_t polygons) {
  counts_.skipped_face += polygons * std::size_t(std::popcount(pending.outside));
  counts_.skipped_hidden += polygons * std::size_t(std::popcount(pending.hidden));
}

/// `pending`: the faces on which the polygon is known to be out of sight.
void Hemicube::drawPolygon(Index place, Pending pending) {
  Candidate candidate{};
  eye_corners_.clear();
  if (!findCandidate(tree_->boxes.order()[place], tree_->polygons[place], candidate)) return;
  for (int index = 0; index < kFaces; ++index) {
    const unsigned bit = 1u << index;
    if (pending.settled() & bit) continue;
    const FaceGeometry face(index);
    if (!face.mayCover(candidate.code)) {
      pending.outside |= bit;
    } else if (scan(candidate, face) && !drawOnFace(candidate, face)) {
      pending.hidden |= bit;
    }
  }
  countUnseen(pending, 1);
}

/// Draws the polygon that scan() has projected; false if it is hidden.
bool Hemicube::drawOnFace(const Candidate& candidate, const FaceGeometry& face) {
  FaceBuffer& buffer = faces_[face.index()];
  const Vec3 plane = inverseDepth(candidate, face);
  const double half = 0.5 * resolution_;
  const double terms = half * (std::abs(plane.x) + std::abs(plane.y)) + std::abs(plane.z);
  const PixelBox pixels = pixelsWithin(extent_.pixels, resolution_, rowCount(face));
  const double nearest = 1 / extent_.least_w + kRoundings * terms;
  if (pixels.isEmpty() || buffer.hides(pixels, nearest)) return false;
  const std::vector<PixelRun>& runs = scan_.finish();
  ++counts_.rasterised_polygons;
  if (runs.empty()) return true;
  spans_.clear();
  for (const PixelRun& run : runs) {
    const double depth = plane.y * rowHeight(face, run.y) + plane.z;
    spans_.push_back({run.y, run.begin, run.end, float(depth)});
  }
  buffer.fill(kernels_, spans_, float(plane.x), candidate.polygon);
  drawn_[face.index()].push_back(prepare(candidate, face));
  return true;
}

void Hemicube::placeDrawn(const FaceGeometry& face) {
  const std::vector<Drawn>& drawn = drawn_[face.index()];
  for (Index k = 0; k < drawn.size(); ++k) place_[drawn[k].polygon] = k;
}

}  // namespace radiosity
