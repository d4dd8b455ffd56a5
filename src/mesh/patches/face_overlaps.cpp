#include "mesh/patches/face_overlaps.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <unordered_map>

#include "base/geometry/box_tree.h"
#include "base/hash.h"
#include "base/parallel.h"

namespace radiosity {

namespace {

constexpr std::size_t kAtATime = 256;       // pieces, for each task of a thread
constexpr std::size_t kTasksAtATime = 256;  // before overlaps are counted
/// The least cosine between faces in one plane.
constexpr double kParallel = 0.99;

bool isTwoSided(const Scene& scene, Index face) { return scene.materialOf(face).two_sided; }

/// The corners of a face, beginning with the least, so that faces with the same ones are equal.
std::vector<std::array<double, 3>> cornersOf(const Scene& scene, Index face, bool turned) {
  std::vector<std::array<double, 3>> corners;
  for (const Index v : scene.face(face)) {
    // A sum with 0 makes -0 and 0 the same.
    const Vec3 at = scene.vertices[v] + 0.0;
    corners.push_back({at.x, at.y, at.z});
  }
  if (turned) std::ranges::reverse(corners);
  std::ranges::rotate(corners, std::ranges::min_element(corners));
  return corners;
}

struct CornersHash {
  std::size_t operator()(const std::vector<std::array<double, 3>>& corners) const {
    Hash hash;
    hash.bytes(corners.data(), corners.size() * sizeof corners[0]);
    return std::size_t(hash.value());
  }
};

class OverlapTest {
 public:
  OverlapTest(const Scene& scene, std::span<const FacePiece> pieces, double coincidence)
      : scene_(scene), pieces_(pieces), coincidence_(coincidence) {}

  Box3 boxOf(std::size_t piece) const {
    Box3 box;
    for (const Index v : pieces_[piece].corners) box.add(scene_.vertices[v]);
    return box.grown(0.5 * coincidence_);
  }

  bool overlap(std::size_t first, std::size_t second) const {
    const Triangle a = triangleOf(first);
    const Triangle b = triangleOf(second);
    const double alike = glm::dot(a.normal, b.normal);
    const bool any_side =
        isTwoSided(scene_, pieces_[first].face) || isTwoSided(scene_, pieces_[second].face);
    if ((any_side ? std::abs(alike) : alike) < kParallel) return false;
    return (isIn(b, a) || isIn(a, b)) && reachesInto(b, a) && reachesInto(a, b);
  }

 private:
  struct Triangle {
    std::array<Vec3, 3> corner;
    Vec3 normal;
  };

  Triangle triangleOf(std::size_t piece) const {
    // Relative to a vertex of the scene, so that nothing is lost far from the origin.
    const Vec3& base = scene_.vertices[scene_.corners[0]];
    Triangle t{};
    for (std::size_t k = 0; k < 3; ++k) {
      t.corner[k] = scene_.vertices[pieces_[piece].corners[k]] - base;
    }
    t.normal = glm::cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
    const double length = glm::length(t.normal);
    t.normal = length > 0 ? t.normal / length : Vec3(0.0);
    return t;
  }

  /// Whether a triangle lies in the plane of another.
  bool isIn(const Triangle& t, const Triangle& plane) const {
    return std::ranges::all_of(t.corner, [&](const Vec3& at) {
      return std::abs(glm::dot(at - plane.corner[0], plane.normal)) <= coincidence_;
    });
  }

  /// Whether no edge of a triangle has another, in its plane, wholly outside. If neither of two
  /// has, they overlap (separating axes).
  bool reachesInto(const Triangle& t, const Triangle& other) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 edge = other.corner[(k + 1) % 3] - other.corner[k];
      const Vec3 inward = glm::normalize(glm::cross(other.normal, edge));
      const bool outside = std::ranges::all_of(t.corner, [&](const Vec3& at) {
        return glm::dot(at - other.corner[k], inward) <= coincidence_;
      });
      if (outside) return false;
    }
    return true;
  }

  const Scene& scene_;
  std::span<const FacePiece> pieces_;
  double coincidence_;
};

}  // namespace

std::vector<Index> findRepeats(const Scene& scene) {
  std::unordered_map<std::vector<std::array<double, 3>>, Index, CornersHash> faces;
  std::vector<Index> repeats(scene.faceCount(), kNone);
  for (Index f = 0; f < scene.faceCount(); ++f) {
    const auto [same, fresh] = faces.try_emplace(cornersOf(scene, f, false), f);
    if (!fresh) {
      repeats[f] = same->second;
    } else if (isTwoSided(scene, f)) {
      const auto turned = faces.find(cornersOf(scene, f, true));
      if (turned == faces.end() || turned->second == f || !isTwoSided(scene, turned->second)) {
        continue;
      }
      repeats[f] = turned->second;
    }
  }
  return repeats;
}

std::vector<std::pair<Index, Index>> findOverlaps(const Scene& scene,
                                                  std::span<const FacePiece> pieces,
                                                  double coincidence, Progress& progress) {
  const OverlapTest test(scene, pieces, coincidence);
  std::vector<Box3> boxes;
  for (std::size_t k = 0; k < pieces.size(); ++k) boxes.push_back(test.boxOf(k));
  const BoxTree tree(boxes);
  std::vector<std::pair<Index, Index>> found;
  const std::size_t tasks = (pieces.size() + kAtATime - 1) / kAtATime;
  for (std::size_t begin = 0; begin < tasks && found.size() < kMostOverlaps;
       begin += kTasksAtATime) {
    const std::size_t end = std::min(tasks, begin + kTasksAtATime);
    std::vector<std::vector<std::pair<Index, Index>>> of_task(end - begin);
    parallelFor(of_task.size(), 1, [&](std::size_t task) {
      auto& overlaps = of_task[task];
      const std::size_t first = (begin + task) * kAtATime;
      for (std::size_t k = first; k < std::min(pieces.size(), first + kAtATime); ++k) {
        if (progress.cancelled()) return;
        tree.query(boxes[k], [&](Index other) {
          const Index f = pieces[k].face;
          const Index g = pieces[other].face;
          if (k < other && f != g && test.overlap(k, other)) overlaps.push_back(std::minmax(f, g));
          return overlaps.size() < kMostOverlaps;
        });
      }
    });
    progress.check();
    for (const auto& overlaps : of_task)
      found.insert(found.end(), overlaps.begin(), overlaps.end());
  }
  std::ranges::sort(found);
  const auto again = std::ranges::unique(found);
  found.erase(again.begin(), again.end());
  if (found.size() > kMostOverlaps) found.resize(kMostOverlaps);
  return found;
}

}  // namespace radiosity
