#include "mesh/faces/input_faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "base/finite.h"
#include "base/geometry/plane_frame.h"
#include "mesh/box_pairs.h"
#include "mesh/edge_key.h"
#include "mesh/plane_image.h"
#include "mesh/triangulate.h"

namespace radiosity {

namespace {

/// The smallest tolerance, relative: the rounding of a coordinate by a rotation or translation,
/// with room for the few operations of a contact (2^-44 = 6e-14).
constexpr double kRounding = 0x1p-44;

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
  void addFace(Index f);
  void dropDuplicates();
  void writeNotes();

 private:
  std::vector<Vec3> at(const std::vector<Index>& loop) const;
  std::vector<Index> weldedLoop(std::span<const Index> corners) const;
  void addPlanar(const std::vector<Index>& loop, Index source, double given);
  void addTriangles(std::vector<Index> loop, Index source);
  double deviation(const std::vector<Index>& loop,
                   const std::vector<std::array<Index, 3>>& triangles) const;
  bool isThin(const std::vector<Vec3>& polygon) const;
  bool isPlanar(const std::vector<Vec3>& polygon, const Vec3& normal) const;
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
  std::map<std::string, std::size_t> thin_;
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
  out_.coincidence = std::max(weld, kRounding) * glm::distance(box.low, box.high);
  if (out_.coincidence <= 0) return;
  // Lexicographic order, so that the points do not depend on the order in the file.
  std::sort(used.begin(), used.end(), [&](Index a, Index b) {
    return lexicographic(scene_.vertices[a], scene_.vertices[b]);
  });
  std::vector<Vec3> places;
  places.reserve(used.size());
  for (const Index v : used) places.push_back(scene_.vertices[v] - out_.origin);
  welded_.assign(scene_.vertices.size(), kNone);
  const std::vector<Index> welded = weldPoints(places, out_.coincidence, out_.points);
  for (std::size_t k = 0; k < used.size(); ++k) welded_[used[k]] = welded[k];
  report_.welded_vertices = used.size() - out_.points.size();
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
bool Cleaner::isThin(const std::vector<Vec3>& polygon) const {
  const auto farthest = [&](const Vec3& from) {
    return *std::max_element(polygon.begin(), polygon.end(), [&](const Vec3& a, const Vec3& b) {
      return glm::distance(a, from) < glm::distance(b, from);
    });
  };
  const Vec3 a = farthest(polygon[0]);
  const Vec3 b = farthest(a);
  const double length = glm::distance(a, b);
  return std::all_of(polygon.begin(), polygon.end(), [&](const Vec3& p) {
    return glm::length(glm::cross(p - a, b - a)) < out_.coincidence * length;
  });
}

/// Whether the polygon is within a slab one coincidence thick.
bool Cleaner::isPlanar(const std::vector<Vec3>& polygon, const Vec3& normal) const {
  double low = 0;
  double high = 0;
  for (const Vec3& p : polygon) {
    const double d = glm::dot(p - polygon[0], normal);
    low = std::min(low, d);
    high = std::max(high, d);
  }
  return high - low <= out_.coincidence;
}

void Cleaner::addPlanar(const std::vector<Index>& loop, Index source, double given) {
  SurfaceAreas& areas = report_.surfaces[scene_.face_surface[source]];
  areas.given += given;
  if (loop.size() < 3 || isThin(at(loop))) {
    areas.degenerate += given;
    ++report_.degenerate_faces;
    ++thin_[nameOf(source)];
    return;
  }
  InputFace face;
  face.loop = loop;
  face.surface = scene_.face_surface[source];
  face.source = source;
  face.normal = glm::normalize(vectorAreaOf(at(face.loop)));
  face.area = given;
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
    const std::vector<Vec3> plane = at({loop[t[0]], loop[t[1]], loop[t[2]]});
    if (isThin(plane)) return;
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
  if (loop.size() < 4 || isThin(at(loop))) return addPlanar(loop, f, area(given));
  const Vec3 normal = vectorAreaOf(at(loop));
  const double size = glm::length(normal);
  if (size > 0 && isPlanar(at(loop), normal / size)) return addPlanar(loop, f, area(given));
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

void Cleaner::writeNotes() {
  for (const auto& [name, count] : thin_) {
    report_.notes.push_back(
        {Severity::warning, fmt::format("{}: {} faces thinner than {:.3g} m were dropped", name,
                                        count, out_.coincidence)});
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
