#include "mesh/faces/input_faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "base/finite.h"
#include "base/geometry/plane_frame.h"
#include "base/union_find.h"
#include "mesh/box_pairs.h"
#include "mesh/edge_key.h"
#include "mesh/plane_image.h"
#include "mesh/triangulate.h"
#include "radiosity/spelling.h"

namespace radiosity {

namespace {

/// The smallest tolerance, relative: the rounding of a coordinate by a rotation or translation,
/// with room for the few operations of a contact (2^-44 = 6e-14).
constexpr double kRounding = 0x1p-44;
/// The largest coincidence as a share of a thing, unless a larger weld is asked for. A share of its
/// size and not of its shortest edge: that of a sliver, or of a corner that noise has cut off, says
/// nothing of what is meant.
constexpr double kShareOfThing = 1e-4;

Vec3 vectorAreaOf(const std::vector<Vec3>& polygon) {
  return vectorArea(polygon.size(), [&](std::size_t k) { return polygon[k]; });
}

double area(const std::vector<Vec3>& polygon) { return glm::length(vectorAreaOf(polygon)); }

bool lexicographic(const Vec3& a, const Vec3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

/// Cleans the faces of one scene.
class Cleaner {
 public:
  Cleaner(const Scene& scene, MeshReport& report, InputFaces& out)
      : scene_(scene), report_(report), out_(out) {}

  void weld(double weld);
  void refuseVanished() const;
  void addFace(Index f);
  void dropDuplicates();
  void writeNotes();

 private:
  std::vector<double> radii(std::span<const Index> used, double share) const;
  std::vector<Vec3> at(const std::vector<Index>& loop) const;
  std::vector<Index> weldedLoop(std::span<const Index> corners) const;
  void addPlanar(const std::vector<Index>& loop, Index source, double given);
  void addTriangles(std::vector<Index> loop, Index source);
  double deviation(const std::vector<Index>& loop,
                   const std::vector<std::array<Index, 3>>& triangles) const;
  bool isThin(const std::vector<Index>& loop) const;
  bool isPlanar(const std::vector<Index>& loop, const Vec3& normal) const;
  const std::string& nameOf(Index source) const {
    return scene_.surfaces[scene_.face_surface[source]].name;
  }

  /// Polygons of a surface that are not planar.
  struct Bent {
    std::size_t count = 0;
    double deviation = 0;  ///< of the farthest corner, m
  };

  const Scene& scene_;
  MeshReport& report_;
  InputFaces& out_;
  std::vector<Index> welded_;  ///< scene vertex -> point
  /// Faces of a surface that were dropped.
  struct Thin {
    std::size_t count = 0;
    double coincidence = 0;  ///< the largest that they are thinner than, m
  };
  std::map<std::string, Thin> thin_;
  std::map<std::string, Bent> bent_;
  std::map<std::string, std::size_t> twice_;
};

void Cleaner::weld(double weld) {
  std::vector<Index> used(scene_.corners);
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  Box3 box;
  for (const Index v : used) {
    const Vec3& p = scene_.vertices[v];
    if (!isFinite(p)) {
      throw InputError(
          fmt::format("{}: vertex {} is not finite; give it three numbers", scene_.file, v + 1));
    }
    box.add(p);
  }
  if (used.empty()) return;
  out_.origin = box.low + 0.5 * (box.high - box.low);
  out_.diagonal = box.diagonal();
  out_.coincidence = std::max(weld, kRounding) * out_.diagonal;
  if (out_.coincidence <= 0) return;
  // Lexicographic order, so that the points do not depend on the order in the file.
  std::sort(used.begin(), used.end(), [&](Index a, Index b) {
    return lexicographic(scene_.vertices[a], scene_.vertices[b]);
  });
  std::vector<Vec3> places;
  places.reserve(used.size());
  for (const Index v : used) places.push_back(scene_.vertices[v] - out_.origin);
  welded_.assign(scene_.vertices.size(), kNone);
  const std::vector<Index> welded =
      weldPoints(places, radii(used, std::max(weld, kShareOfThing)), out_.points);
  for (std::size_t k = 0; k < used.size(); ++k) welded_[used[k]] = welded[k];
  report_.welded_vertices = used.size() - out_.points.size();
}

/// The coincidence of each used vertex, by the smallest thing that it belongs to. Smaller ones than
/// the scene's are powers of two of it, so that there are few.
std::vector<double> Cleaner::radii(std::span<const Index> used, double share) const {
  WeldedPoints places;
  std::vector<Index> place(scene_.vertices.size(), kNone);
  for (const Index v : used) {
    place[v] = places.insert(scene_.vertices[v] - out_.origin, out_.coincidence);
  }
  // A node is a place on a surface.
  std::unordered_map<std::uint64_t, Index> nodes;
  std::vector<Index> node_of;  // by corner
  node_of.reserve(scene_.corners.size());
  for (std::size_t f = 0; f < scene_.faceCount(); ++f) {
    for (const Index v : scene_.face(f)) {
      const std::uint64_t key = std::uint64_t(scene_.face_surface[f]) << 32U | place[v];
      node_of.push_back(nodes.try_emplace(key, Index(nodes.size())).first->second);
    }
  }
  UnionFind things(nodes.size());
  std::vector<Box3> boxes(nodes.size());
  for (std::size_t f = 0; f < scene_.faceCount(); ++f) {
    for (std::size_t k = scene_.face_offset[f]; k < scene_.face_offset[f + 1]; ++k) {
      things.unite(node_of[scene_.face_offset[f]], node_of[k]);
    }
  }
  for (std::size_t k = 0; k < node_of.size(); ++k) {
    boxes[things.find(node_of[k])].add(scene_.vertices[scene_.corners[k]]);
  }
  std::vector<double> of_vertex(scene_.vertices.size(), out_.coincidence);
  const double least = std::min(out_.coincidence, kRounding * out_.diagonal);
  for (std::size_t k = 0; k < node_of.size(); ++k) {
    const double most = share * boxes[things.find(node_of[k])].diagonal();
    if (most >= out_.coincidence) continue;
    const double halvings = std::ceil(std::log2(out_.coincidence / std::max(most, least)));
    double& radius = of_vertex[scene_.corners[k]];
    radius = std::min(radius, std::ldexp(out_.coincidence, -int(halvings)));
  }
  std::vector<double> out;
  out.reserve(used.size());
  for (const Index v : used) out.push_back(of_vertex[v]);
  return out;
}

std::vector<Vec3> Cleaner::at(const std::vector<Index>& loop) const {
  std::vector<Vec3> out;
  out.reserve(loop.size());
  for (const Index v : loop) out.push_back(out_.points[v]);
  return out;
}

std::vector<Index> Cleaner::weldedLoop(std::span<const Index> corners) const {
  std::vector<Index> loop;
  for (const Index c : corners) {
    if (loop.empty() || loop.back() != welded_[c]) loop.push_back(welded_[c]);
  }
  while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
  return loop;
}

/// Whether all corners are closer than coincidence to the line through two that are about farthest
/// apart.
bool Cleaner::isThin(const std::vector<Index>& loop) const {
  const std::vector<Vec3> polygon = at(loop);
  const double coincidence = coincidenceOf(out_.points, loop);
  const auto farthest = [&](const Vec3& from) {
    return *std::max_element(polygon.begin(), polygon.end(), [&](const Vec3& a, const Vec3& b) {
      return glm::distance(a, from) < glm::distance(b, from);
    });
  };
  const Vec3 a = farthest(polygon[0]);
  const Vec3 b = farthest(a);
  const double length = glm::distance(a, b);
  return std::all_of(polygon.begin(), polygon.end(), [&](const Vec3& p) {
    return glm::length(glm::cross(p - a, b - a)) < coincidence * length;
  });
}

/// Whether the polygon is within a slab one coincidence thick.
bool Cleaner::isPlanar(const std::vector<Index>& loop, const Vec3& normal) const {
  const std::vector<Vec3> polygon = at(loop);
  double low = 0;
  double high = 0;
  for (const Vec3& p : polygon) {
    const double d = glm::dot(p - polygon[0], normal);
    low = std::min(low, d);
    high = std::max(high, d);
  }
  return high - low <= coincidenceOf(out_.points, loop);
}

void Cleaner::addPlanar(const std::vector<Index>& loop, Index source, double given) {
  SurfaceAreas& areas = report_.surfaces[scene_.face_surface[source]];
  areas.given += given;
  if (loop.size() < 3 || isThin(loop)) {
    areas.degenerate += given;
    ++report_.degenerate_faces;
    Thin& thin = thin_[nameOf(source)];
    ++thin.count;
    thin.coincidence = std::max(thin.coincidence, coincidenceOf(out_.points, loop));
    return;
  }
  InputFace face;
  face.loop = loop;
  face.surface = scene_.face_surface[source];
  face.source = source;
  face.normal = glm::normalize(vectorAreaOf(at(face.loop)));
  face.area = given;
  face.coincidence = coincidenceOf(out_.points, face.loop);
  out_.faces.push_back(std::move(face));
}

/// Cuts a polygon into triangles; it begins with its lowest corner. The same polygon in the
/// opposite direction gets the same triangles turned over, so that the two sheets of a face
/// modelled on both sides do not cross.
void Cleaner::addTriangles(std::vector<Index> loop, Index source) {
  ++report_.nonplanar_faces;
  const bool turned = loop.back() < loop[1];
  if (turned) std::reverse(loop.begin() + 1, loop.end());
  const Vec3 normal = vectorAreaOf(at(loop));
  const double size = glm::length(normal);
  const PlaneImage image(size > 0 ? normal / size : Vec3(0, 0, 1));
  std::vector<Vec2> outline;
  for (const Vec3& p : at(loop)) outline.push_back(image(p));
  const auto triangles = triangulateOutline(outline);
  for (const auto& t : triangles) {
    std::vector<Index> corners{loop[t[0]], loop[t[turned ? 2 : 1]], loop[t[turned ? 1 : 2]]};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    addPlanar(corners, source, area(at(corners)));
  }
  const double off = deviation(loop, triangles);
  report_.largest_deviation = std::max(report_.largest_deviation, off);
  Bent& bent = bent_[nameOf(source)];
  ++bent.count;
  bent.deviation = std::max(bent.deviation, off);
}

/// The largest distance of corners from the planes of the triangles beside theirs.
double Cleaner::deviation(const std::vector<Index>& loop,
                          const std::vector<std::array<Index, 3>>& triangles) const {
  double most = 0;
  const auto note = [&](const std::array<Index, 3>& t, Index apex) {
    const std::vector<Index> corners{loop[t[0]], loop[t[1]], loop[t[2]]};
    if (isThin(corners)) return;
    const std::vector<Vec3> plane = at(corners);
    const Vec3 n = glm::normalize(vectorAreaOf(plane));
    most = std::max(most, std::abs(glm::dot(out_.points[loop[apex]] - plane[0], n)));
  };
  struct Side {
    std::size_t triangle = 0;
    Index apex = kNone;
  };
  std::unordered_map<std::uint64_t, Side> open;
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const auto& t = triangles[k];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [other, first] =
          open.try_emplace(edgeKey(t[(i + 1) % 3], t[(i + 2) % 3]), Side{k, t[i]});
      if (first) continue;
      note(t, other->second.apex);
      note(triangles[other->second.triangle], t[i]);
    }
  }
  return most;
}

void Cleaner::addFace(Index f) {
  std::vector<Vec3> given;
  for (const Index c : scene_.face(f)) given.push_back(scene_.vertices[c] - out_.origin);
  std::vector<Index> loop = weldedLoop(scene_.face(f));
  // Triangles must not depend on the corner with which the file begins.
  if (!loop.empty()) {
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  }
  if (loop.size() < 4 || isThin(loop)) return addPlanar(loop, f, area(given));
  const Vec3 normal = vectorAreaOf(at(loop));
  const double size = glm::length(normal);
  if (size > 0 && isPlanar(loop, normal / size)) return addPlanar(loop, f, area(given));
  addTriangles(std::move(loop), f);
}

void Cleaner::dropDuplicates() {
  const auto order = [&](const InputFace& a, const InputFace& b) {
    const std::string& name_a = nameOf(a.source);
    const std::string& name_b = nameOf(b.source);
    return std::tie(a.loop, name_a, a.source) < std::tie(b.loop, name_b, b.source);
  };
  std::sort(out_.faces.begin(), out_.faces.end(), order);
  const auto same = [&](const InputFace& kept, const InputFace& next) {
    if (kept.surface != next.surface || kept.loop != next.loop) return false;
    report_.surfaces[next.surface].overlapped += next.area;
    ++report_.duplicate_faces;
    ++twice_[nameOf(next.source)];
    return true;
  };
  out_.faces.erase(std::unique(out_.faces.begin(), out_.faces.end(), same), out_.faces.end());
}

/// A surface may lose slivers, but not all that it is.
void Cleaner::refuseVanished() const {
  std::vector<bool> left(report_.surfaces.size(), false);
  for (const InputFace& face : out_.faces) left[face.surface] = true;
  for (std::size_t s = 0; s < left.size(); ++s) {
    const SurfaceAreas& areas = report_.surfaces[s];
    // What has no area in the file has none to lose.
    if (left[s] || !(areas.given > kRounding * out_.diagonal * out_.diagonal)) continue;
    throw InputError(fmt::format(
        "{}: {}: all of it ({:.3g} m^2) is thinner than the coincidence of {:.3g} m and would "
        "vanish; take a smaller {} (below {:.1g}), or leave it out",
        scene_.file, areas.name, areas.given, out_.coincidence, spelled("weld"),
        areas.given / (out_.diagonal * out_.diagonal)));
  }
}

void Cleaner::writeNotes() {
  for (const auto& [name, thin] : thin_) {
    report_.notes.push_back(
        {Severity::warning, fmt::format("{}: {} faces thinner than {:.3g} m were dropped", name,
                                        thin.count, thin.coincidence)});
  }
  for (const auto& [name, bent] : bent_) {
    report_.notes.push_back(
        {Severity::info,
         fmt::format(
             "{}: {} not planar (up to {:.3g} m off) and split into triangles", name,
             bent.count == 1 ? "1 polygon was" : fmt::format("{} polygons were", bent.count),
             bent.deviation)});
  }
  for (const auto& [name, count] : twice_) {
    report_.notes.push_back(
        {Severity::warning,
         fmt::format("{}: {} faces are there twice; one of each was kept", name, count)});
  }
}

}  // namespace

double coincidenceOf(const WeldedPoints& points, std::span<const Index> some) {
  double least = std::numeric_limits<double>::infinity();
  for (const Index v : some) least = std::min(least, points.radius(v));
  return least;
}

InputFaces cleanFaces(const Scene& scene, const MeshOptions& options,
                      const std::vector<Handling>& handling, MeshReport& report) {
  report.surfaces.clear();
  for (const Surface& s : scene.surfaces) {
    SurfaceAreas areas;
    areas.name = s.name;
    report.surfaces.push_back(areas);
  }
  InputFaces out;
  Cleaner cleaner(scene, report, out);
  cleaner.weld(options.weld);
  if (out.coincidence > 0) {
    for (std::size_t f = 0; f < scene.faceCount(); ++f) cleaner.addFace(Index(f));
  }
  cleaner.refuseVanished();
  if (out.faces.empty()) {
    throw InputError(
        fmt::format("{}: no face has any area; the scene needs at least one polygon", scene.file));
  }
  cleaner.dropDuplicates();
  cleaner.writeNotes();
  for (InputFace& face : out.faces) face.handling = handling[face.source];
  const auto uncut = std::stable_partition(
      out.faces.begin(), out.faces.end(),
      [](const InputFace& face) { return face.handling != Handling::as_it_is; });
  out.uncut.assign(std::make_move_iterator(uncut), std::make_move_iterator(out.faces.end()));
  out.faces.erase(uncut, out.faces.end());
  return out;
}

}  // namespace radiosity
