#include "mesh/faces/plane_groups.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <span>

#include "base/geometry/plane_frame.h"
#include "base/parallel.h"
#include "mesh/box_pairs.h"

namespace radiosity {

namespace {

/// Faces whose boxes overlap: the neighbours of face f are `faces[begin[f]]` to
/// `faces[begin[f + 1] - 1]`, ascending.
struct Neighbours {
  std::vector<std::size_t> begin;
  std::vector<Index> faces;

  explicit Neighbours(const InputFaces& input) : begin(input.faces.size() + 1, 0) {
    std::vector<Box3> boxes;
    boxes.reserve(input.faces.size());
    for (const InputFace& face : input.faces) {
      Box3 box;
      for (const Index v : face.loop) box.add(input.points[v]);
      boxes.push_back(box.grown(face.coincidence));
    }
    const auto pairs = overlappingPairs(boxes);
    for (const auto& [a, b] : pairs) {
      ++begin[a + 1];
      ++begin[b + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    faces.resize(begin.back());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (const auto& [a, b] : pairs) {
      faces[next[a]++] = b;
      faces[next[b]++] = a;
    }
  }

  std::span<const Index> of(Index face) const {
    return std::span(faces).subspan(begin[face], begin[face + 1] - begin[face]);
  }
};

class Grower {
 public:
  explicit Grower(const InputFaces& input)
      : input_(input),
        near_(input),
        taken_(input.faces.size(), false),
        visit_(input.faces.size(), 0) {}

  /// The plane of `seed` and of all free faces that it reaches. The normal of a small seed is not
  /// accurate enough for far faces, so the plane is fitted to the faces again until no more are
  /// found.
  Plane grow(Index seed) {
    Plane plane;
    plane.normal = input_.faces[seed].normal;
    plane.coincidence = input_.faces[seed].coincidence;
    plane.offset = centre(plane.normal, {seed});
    plane.faces = reach(plane, seed);
    while (plane.faces.size() > 1) {
      Plane fit = refit(plane);
      if (!holds(fit, plane.faces)) break;
      fit.faces = reach(fit, seed);
      if (fit.faces.size() <= plane.faces.size()) break;
      plane = fit;
    }
    std::sort(plane.faces.begin(), plane.faces.end());
    for (const Index f : plane.faces) taken_[f] = true;
    return plane;
  }

  bool taken(Index f) const { return taken_[f]; }

 private:
  /// The offset in the middle between the lowest and the highest vertex.
  double centre(const Vec3& normal, const std::vector<Index>& faces) const {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Index f : faces) {
      for (const Index v : input_.faces[f].loop) {
        const double d = glm::dot(normal, input_.points[v]);
        low = std::min(low, d);
        high = std::max(high, d);
      }
    }
    return 0.5 * (low + high);
  }

  bool isAlone(Index f) const { return input_.faces[f].handling == Handling::alone; }

  bool within(const Plane& plane, Index f) const {
    const auto& loop = input_.faces[f].loop;
    const double most = std::min(plane.coincidence, input_.faces[f].coincidence);
    return std::all_of(loop.begin(), loop.end(),
                       [&](Index v) { return std::abs(plane.distance(input_.points[v])) <= most; });
  }

  bool holds(const Plane& plane, const std::vector<Index>& faces) const {
    return std::all_of(faces.begin(), faces.end(), [&](Index f) { return within(plane, f); });
  }

  std::vector<Index> reach(const Plane& plane, Index seed) {
    ++round_;
    std::vector<Index> found{seed};
    visit_[seed] = round_;
    if (isAlone(seed)) return found;
    for (std::size_t k = 0; k < found.size(); ++k) {
      for (const Index next : near_.of(found[k])) {
        if (taken_[next] || visit_[next] == round_ || isAlone(next)) continue;
        visit_[next] = round_;
        if (within(plane, next)) found.push_back(next);
      }
    }
    return found;
  }

  /// Least squares over the vertices: height h = a u + b v above the present plane.
  Plane refit(const Plane& plane) const {
    const Vec3 n = plane.normal;
    const PlaneFrame frame = makeFrame(Vec3(0.0), n, axisAcross(n));
    const Vec3& u = frame.u;
    const Vec3& v = frame.v;
    Vec3 mean(0.0);
    double count = 0;
    for (const Index f : plane.faces) {
      for (const Index p : input_.faces[f].loop) mean += input_.points[p];
      count += double(input_.faces[f].loop.size());
    }
    mean /= count;
    double uu = 0;
    double uv = 0;
    double vv = 0;
    double uh = 0;
    double vh = 0;
    for (const Index f : plane.faces) {
      for (const Index p : input_.faces[f].loop) {
        const Vec3 d = input_.points[p] - mean;
        const double du = glm::dot(d, u);
        const double dv = glm::dot(d, v);
        const double dh = glm::dot(d, n);
        uu += du * du;
        uv += du * dv;
        vv += dv * dv;
        uh += du * dh;
        vh += dv * dh;
      }
    }
    // Never singular: a face is wider than coincidence, so its vertices are not on one line.
    const double determinant = uu * vv - uv * uv;
    Plane out;
    out.normal = n;
    out.coincidence = plane.coincidence;
    if (determinant > 0) {
      const double a = (uh * vv - vh * uv) / determinant;
      const double b = (vh * uu - uh * uv) / determinant;
      out.normal = glm::normalize(n - a * u - b * v);
    }
    out.offset = centre(out.normal, plane.faces);
    return out;
  }

  const InputFaces& input_;
  Neighbours near_;
  std::vector<bool> taken_;
  std::vector<std::size_t> visit_;
  std::size_t round_ = 0;
};

}  // namespace

std::vector<Plane> groupByPlane(const InputFaces& input) {
  // Large faces come first, since they define their plane best.
  std::vector<Index> order(input.faces.size());
  std::iota(order.begin(), order.end(), Index(0));
  parallelSort(order, [&](Index a, Index b) {
    const double area_a = input.faces[a].area;
    const double area_b = input.faces[b].area;
    return area_a > area_b || (area_a == area_b && a < b);
  });
  Grower grower(input);
  std::vector<Plane> planes;
  for (const Index seed : order) {
    if (!grower.taken(seed)) planes.push_back(grower.grow(seed));
  }
  return planes;
}

}  // namespace radiosity
