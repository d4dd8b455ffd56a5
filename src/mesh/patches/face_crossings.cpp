#include "mesh/patches/face_crossings.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "mesh/box_pairs.h"

namespace radiosity {

namespace {

using Triangle = std::array<Vec3, 3>;
struct Chord {
  Vec3 a;
  Vec3 b;
};

Vec3 unitNormal(const Triangle& t) { return glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0])); }

/// The segment where `t` meets the plane through `base` with normal `n`; empty if there is none or
/// only a point.
std::optional<Chord> chord(const Triangle& t, const Vec3& base, const Vec3& n) {
  std::array<double, 3> height{};
  for (std::size_t k = 0; k < 3; ++k) height[k] = glm::dot(t[k] - base, n);
  std::vector<Vec3> ends;
  for (std::size_t k = 0; k < 3; ++k) {
    const double here = height[k];
    const double next = height[(k + 1) % 3];
    if (here == 0) {
      ends.push_back(t[k]);
    } else if ((here < 0 && next > 0) || (here > 0 && next < 0)) {
      ends.push_back(t[k] + (t[(k + 1) % 3] - t[k]) * (here / (here - next)));
    }
  }
  if (ends.size() != 2) return std::nullopt;
  return Chord{ends[0], ends[1]};
}

/// The part of `s`, which lies in the plane of `t`, inside `t`.
std::optional<Chord> clipped(const Chord& s, const Triangle& t) {
  const Vec3 n = unitNormal(t);
  double from = 0;
  double to = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 inward = glm::cross(n, t[(k + 1) % 3] - t[k]);
    const double a = glm::dot(s.a - t[k], inward);
    const double b = glm::dot(s.b - t[k], inward);
    if (a < 0 && b < 0) return std::nullopt;
    if (a < 0) from = std::max(from, a / (a - b));
    if (b < 0) to = std::min(to, a / (a - b));
  }
  if (from >= to) return std::nullopt;
  return Chord{s.a + from * (s.b - s.a), s.a + to * (s.b - s.a)};
}

class CrossingTest {
 public:
  CrossingTest(const Scene& scene, double coincidence) : scene_(scene), coincidence_(coincidence) {}

  bool cross(const FacePiece& p, const FacePiece& q) const {
    const Triangle a = corners(p);
    const Triangle b = corners(q);
    if (!passesThrough(p.face, b) || !passesThrough(q.face, a)) return false;
    const auto line = chord(a, b[0], unitNormal(b));
    if (!line) return false;
    const auto shared = clipped(*line, b);
    if (!shared || glm::length(shared->b - shared->a) <= coincidence_) return false;
    return !runsAlongRim(*shared, a, p.rim) && !runsAlongRim(*shared, b, q.rim);
  }

 private:
  Triangle corners(const FacePiece& piece) const {
    // Relative to a vertex of the scene, so that nothing is lost far from the origin.
    const Vec3& base = scene_.vertices[scene_.corners[0]];
    return {scene_.vertices[piece.corners[0]] - base, scene_.vertices[piece.corners[1]] - base,
            scene_.vertices[piece.corners[2]] - base};
  }

  bool passesThrough(Index face, const Triangle& plane) const {
    const Vec3 n = unitNormal(plane);
    const Vec3& base = scene_.vertices[scene_.corners[0]];
    double lowest = 0;
    double highest = 0;
    for (const Index v : scene_.face(face)) {
      const double height = glm::dot((scene_.vertices[v] - base) - plane[0], n);
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    }
    return lowest < -coincidence_ && highest > coincidence_;
  }

  bool runsAlongRim(const Chord& s, const Triangle& t, unsigned rim) const {
    for (unsigned k = 0; k < 3; ++k) {
      if ((rim >> k & 1u) == 0) continue;
      const Vec3 along = glm::normalize(t[(k + 1) % 3] - t[k]);
      if (glm::length(glm::cross(along, s.a - t[k])) <= coincidence_ &&
          glm::length(glm::cross(along, s.b - t[k])) <= coincidence_) {
        return true;
      }
    }
    return false;
  }

  const Scene& scene_;
  double coincidence_;
};

}  // namespace

std::vector<std::pair<Index, Index>> findCrossings(const Scene& scene,
                                                   std::span<const FacePiece> pieces,
                                                   double coincidence, Progress& progress) {
  std::vector<Box3> boxes(pieces.size());
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    for (const Index v : pieces[k].corners) boxes[k].add(scene.vertices[v]);
  }
  const CrossingTest test(scene, coincidence);
  std::vector<std::pair<Index, Index>> found;
  const auto crosses = [&](Index p, Index q) {
    return pieces[p].face != pieces[q].face && test.cross(pieces[p], pieces[q]);
  };
  for (const auto& [p, q] : overlappingPairs(boxes, &progress, crosses)) {
    found.push_back(std::minmax(pieces[p].face, pieces[q].face));
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace radiosity
