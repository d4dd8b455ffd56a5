#include "gather/eyes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "base/geometry/box.h"
#include "base/geometry/segment.h"
#include "base/parallel.h"
#include "formfactor/hemicube/eye_frame.h"
#include "mesh/patches/enclosures.h"

namespace radiosity {
namespace {

/// One patch at the vertex: the angle from the edge to `after`, counter-clockwise, to `before`.
struct Wedge {
  Index patch;
  Index before;
  Index after;
  double angle;
};

double angleBetween(const Vec3& a, const Vec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// The patches of one corner group about their vertex.
class VertexSide {
 public:
  VertexSide(const PatchMesh& mesh, std::span<const std::size_t> corners,
             std::span<const Index> patches)
      : mesh_(mesh), vertex_(mesh.corners[corners.front()]) {
    for (std::size_t k = 0; k < corners.size(); ++k) addWedge(patches[k], corners[k]);
  }

  /// `coincidence`: points within this distance of a plane count as in it, metres.
  Eye eye(double inset, double coincidence) const {
    Eye eye;
    eye.position = mesh_.vertices[vertex_];
    if (wedges_.empty()) return eye;
    eye.looks = true;
    const double step = inset * room_;
    Index patch = wedges_.front().patch;
    eye.position += step * inward(patch);
    eye.normal = mesh_.normal[patch];
    if (isFlat(eye.normal, coincidence)) {
      eye.own = mesh_.polygon[patch];
      return eye;
    }
    // The side bends, so the horizon about the mean normal cuts through its patches. The eye stands
    // a step above them and sees them like all other patches.
    Vec3 normal(0.0);
    for (const Wedge& wedge : wedges_) normal += mesh_.normal[wedge.patch] * wedge.angle;
    eye.normal = glm::normalize(normal);
    eye.position += step * eye.normal;
    return eye;
  }

 private:
  void addWedge(Index patch, std::size_t corner) {
    if (!(mesh_.area[patch] > 0)) return;
    const std::span<const Index> outline = mesh_.outline(patch);
    const std::size_t n = outline.size();
    const std::size_t k = corner - mesh_.corner_offset[patch];
    const Vec3& vertex = mesh_.vertices[vertex_];
    Wedge wedge{patch, outline[(k + n - 1) % n], outline[(k + 1) % n], 0};
    const Vec3 from = mesh_.vertices[wedge.after] - vertex;
    const Vec3 to = mesh_.vertices[wedge.before] - vertex;
    wedge.angle = angleBetween(from, to);
    if (glm::dot(glm::cross(from, to), mesh_.normal[patch]) < 0) {
      wedge.angle = 2 * std::numbers::pi - wedge.angle;  // the outline is concave here
    }
    wedges_.push_back(wedge);
    for (std::size_t e = 0; e < n; ++e) {
      const Index a = outline[e];
      const Index b = outline[(e + 1) % n];
      if (a == vertex_ || b == vertex_) continue;
      const double distance = distanceToSegment(vertex, mesh_.vertices[a], mesh_.vertices[b]);
      room_ = std::min(room_, distance);
    }
  }

  /// The unit direction half-way round an open fan of patches, and the patch that it points into; 0
  /// if the fan is closed and the vertex lies inside the sheet.
  Vec3 inward(Index& patch) const {
    const Wedge* first = nullptr;
    double total = 0;
    for (const Wedge& wedge : wedges_) {
      total += wedge.angle;
      if (first == nullptr && followerOf(wedge.after, &Wedge::before) == nullptr) first = &wedge;
    }
    if (first == nullptr) return Vec3(0.0);
    double left = 0.5 * total;
    const Wedge* wedge = first;
    for (std::size_t k = 0; k < wedges_.size() && wedge->angle < left; ++k) {
      const Wedge* next = followerOf(wedge->before, &Wedge::after);
      if (next == nullptr) break;
      left -= wedge->angle;
      wedge = next;
    }
    patch = wedge->patch;
    const Vec3 along = glm::normalize(mesh_.vertices[wedge->after] - mesh_.vertices[vertex_]);
    const Vec3 across = glm::cross(mesh_.normal[patch], along);
    left = std::min(left, wedge->angle);
    return std::cos(left) * along + std::sin(left) * across;
  }

  const Wedge* followerOf(Index edge, Index Wedge::*end) const {
    const auto found = std::find_if(wedges_.begin(), wedges_.end(),
                                    [&](const Wedge& w) { return w.*end == edge; });
    return found == wedges_.end() ? nullptr : &*found;
  }

  bool isFlat(const Vec3& normal, double coincidence) const {
    const Vec3& vertex = mesh_.vertices[vertex_];
    return std::all_of(wedges_.begin(), wedges_.end(), [&](const Wedge& wedge) {
      if (mesh_.polygon[wedge.patch] == mesh_.polygon[wedges_.front().patch]) return true;
      const std::span<const Index> outline = mesh_.outline(wedge.patch);
      return std::all_of(outline.begin(), outline.end(), [&](Index v) {
        return std::abs(glm::dot(normal, mesh_.vertices[v] - vertex)) <= coincidence;
      });
    });
  }

  const PatchMesh& mesh_;
  Index vertex_;
  std::vector<Wedge> wedges_;
  double room_ =
      std::numeric_limits<double>::infinity();  ///< to the nearest edge not at the vertex
};

/// A different seed for each corner of a patch, so that the eyes of one patch have different turns.
std::uint64_t cornerSeed(std::uint64_t seed, std::size_t corner) {
  return seed + 0x9e3779b97f4a7c15ull * (corner + 1);
}

}  // namespace

std::vector<Eye> patchEyes(const PatchMesh& mesh, const GatherOptions& options) {
  std::vector<Eye> eyes(mesh.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (!(mesh.area[i] > 0) || mesh.polygon[i] == kNone) continue;
    const double angle = options.random_turns ? turnAngle(mesh, i, options.seed) : 0.0;
    eyes[i] = {mesh.centroid[i], mesh.normal[i], mesh.polygon[i], angle, true};
  }
  return eyes;
}

std::vector<Eye> vertexEyes(const PatchMesh& mesh, const CornerGroups& groups,
                            const GatherOptions& options) {
  std::vector<Eye> eyes(groups.size());
  const double coincidence = coincidenceOf(mesh);
  constexpr std::size_t kGrain = 256;
  parallelFor(groups.size(), kGrain, [&](std::size_t g) {
    const VertexSide side(mesh, groups.cornersOf(g), groups.patchesOf(g));
    eyes[g] = side.eye(options.inset, coincidence);
    if (!eyes[g].looks || !options.random_turns) return;
    const Index patch = groups.patchesOf(g).front();
    const std::size_t corner = groups.cornersOf(g).front() - mesh.corner_offset[patch];
    eyes[g].angle = turnAngle(mesh, patch, cornerSeed(options.seed, corner));
  });
  return eyes;
}

}  // namespace radiosity
