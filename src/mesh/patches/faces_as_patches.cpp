#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "base/geometry/box.h"
#include "base/geometry/plane_frame.h"
#include "base/geometry/segment.h"
#include "mesh/box_pairs.h"
#include "mesh/patches/face_crossings.h"
#include "mesh/patches/face_overlaps.h"
#include "mesh/patches/face_polygons.h"
#include "mesh/patches/mesh_figures.h"
#include "mesh/patches/patch_arrays.h"
#include "mesh/polygons/complex.h"
#include "mesh/triangulate.h"
#include "radiosity/spelling.h"
#include "scene/checks/close_faces.h"

namespace radiosity {

namespace {

std::string nameOf(const Scene& scene, Index f) {
  return fmt::format("face {} ({}, element {})", f, scene.surfaces[scene.face_surface[f]].name,
                     scene.face_element[f]);
}

/// The distance of a point from an outline.
double distanceToOutline(const Vec2& p, std::span<const Vec2> outline) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < outline.size(); ++k) {
    nearest =
        std::min(nearest, distanceToSegment(p, outline[k], outline[(k + 1) % outline.size()]));
  }
  return nearest;
}

bool insideEvenOdd(const Vec2& p, std::span<const Vec2> outline) {
  bool inside = false;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec2& a = outline[k];
    const Vec2& b = outline[(k + 1) % outline.size()];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * ((p.y - a.y) / (b.y - a.y))) {
      inside = !inside;
    }
  }
  return inside;
}

/// The largest coincidence as a share of a surface's box.
constexpr double kShareOfSurface = 1e-4;
/// The smallest as a share of the scene's: the rounding of a coordinate, with room for some more.
constexpr double kLeastShare = 0x1p-44;

class FacePatches {
 public:
  FacePatches(const Scene& scene, const MeshOptions& options, MeshReport& report,
              Progress& progress)
      : scene_(scene), report_(report), progress_(progress) {
    Box3 box;
    for (const Index v : scene.corners) box.add(scene.vertices[v]);
    centre_ = box.centre();
    coincidence_ = options.weld * box.diagonal();
    std::vector<Box3> boxes(scene.surfaces.size());
    for (Index f = 0; f < scene.faceCount(); ++f) {
      for (const Index v : scene.face(f)) boxes[scene.face_surface[f]].add(scene.vertices[v]);
    }
    for (const Box3& of : boxes) {
      of_surface_.push_back(std::min(coincidence_, kShareOfSurface * of.diagonal()));
    }
  }

  PatchMesh build() {
    // Patches, polygons, T-junctions and crossings take a part each.
    constexpr std::size_t kParts = 4;
    const std::size_t faces = scene_.faceCount();
    progress_.begin("faces as patches", kParts * faces);
    mesh_.vertices = scene_.vertices;
    for (const Surface& surface : scene_.surfaces) {
      mesh_.surface_names.push_back(surface.name);
      report_.surfaces.emplace_back().name = surface.name;
    }
    mesh_.corner_offset = mesh_.piece_offset = {0};
    repeats_ = findRepeats(scene_);
    for (Index f = 0; f < faces; ++f) {
      progress_.check();
      append(f);
      progress_.advance();
    }
    if (report_.degenerate_faces + report_.duplicate_faces == faces) {
      throw InputError(fmt::format("{}: no face has an area", scene_.file));
    }
    mergeFaces(scene_, shapes_, coincidence_, mesh_, progress_);
    progress_.advance(faces);
    std::vector<Index> two_sided;
    for (Index f = 0; f < scene_.faceCount(); ++f) {
      if (scene_.materialOf(f).two_sided && mesh_.area[f] > 0) two_sided.push_back(f);
    }
    appendBacks(mesh_, two_sided);
    numberWithinSurfaces(mesh_);
    keepCoincidence(mesh_,
                    std::max(least_coincidence_, kLeastShare * boxOf(mesh_.vertices).diagonal()));
    fillFigures(mesh_, report_);
    progress_.check();
    report_.t_junctions = countTJunctions(mesh_, coincidence_);
    progress_.advance(faces);
    findings();
    progress_.advance(faces);
    progress_.end();
    return std::move(mesh_);
  }

 private:
  void append(Index f) {
    const auto outline = scene_.face(f);
    std::vector<Vec3> p;
    double longest = 0;
    Vec3 mean(0.0);
    for (const Index v : outline) p.push_back(scene_.vertices[v] - centre_);
    for (const Vec3& a : p) {
      mean += a / double(p.size());
      longest = std::max(longest, glm::length(a - p[0]));
    }
    const Vec3 area = vectorArea(p.size(), [&](std::size_t k) { return p[k]; });
    SurfaceAreas& surface = report_.surfaces[scene_.face_surface[f]];
    surface.given += glm::length(area);
    FaceShape shape;
    // The area of a face that fits between two parallel lines a coincidence apart cannot be told
    // from rounding. Its longest diagonal from one corner is at least half its diameter.
    const double coincidence = of_surface_[scene_.face_surface[f]];
    const bool degenerate = glm::length(area) <= 0.5 * coincidence * longest;
    if (degenerate) {
      surface.degenerate += glm::length(area);
      ++report_.degenerate_faces;
    } else if (repeats_[f] != kNone) {
      surface.overlapped += glm::length(area);
      ++report_.duplicate_faces;
    } else {
      least_coincidence_ = std::min(least_coincidence_, coincidence);
      shape.area = glm::length(area);
      shape.normal = area / shape.area;
      mean = appendPieces(f, p, mean, shape);
    }
    shapes_.push_back(shape);
    mesh_.corners.insert(mesh_.corners.end(), outline.begin(), outline.end());
    mesh_.corner_offset.push_back(mesh_.corners.size());
    mesh_.piece_offset.push_back(mesh_.pieces.size());
    mesh_.centroid.push_back(mean + centre_);
    mesh_.normal.push_back(shape.normal);
    mesh_.area.push_back(shape.area);
    mesh_.surface.push_back(scene_.face_surface[f]);
    mesh_.source_face.push_back(f);
    mesh_.side.push_back(0);
    mesh_.twin.push_back(kNone);
  }

  /// Appends the triangles of a face; returns its area centroid, moved inside.
  Vec3 appendPieces(Index f, const std::vector<Vec3>& p, const Vec3& mean, FaceShape& shape) {
    const PlaneFrame frame = makeFrame(mean, shape.normal, axisAcross(shape.normal));
    std::vector<Vec2> flat;
    double deviation = 0;
    for (const Vec3& a : p) {
      flat.push_back(frame.flat(a));
      deviation = std::max(deviation, std::abs(glm::dot(a - mean, shape.normal)));
    }
    if (deviation > coincidence_) {
      shape.planar = false;
      ++report_.nonplanar_faces;
      if (deviation > report_.largest_deviation) {
        report_.largest_deviation = deviation;
        least_planar_ = f;
      }
    }
    const auto outline = scene_.face(f);
    const std::size_t n = outline.size();
    Vec2 moment(0.0);
    double total = 0;
    std::vector<Vec2> middles;
    for (const auto& t : triangulateOutline(flat)) {
      const double area = 0.5 * cross2(flat[t[1]] - flat[t[0]], flat[t[2]] - flat[t[0]]);
      const Vec2 middle = (flat[t[0]] + flat[t[1]] + flat[t[2]]) / 3.0;
      total += area;
      moment += area * middle;
      if (area == 0) continue;
      if (area > 0) middles.push_back(middle);
      FacePiece piece{f, {outline[t[0]], outline[t[1]], outline[t[2]]}, 0};
      for (unsigned k = 0; k < 3; ++k) {
        if ((t[k] + 1) % n == t[(k + 1) % 3]) piece.rim |= 1u << k;
      }
      mesh_.pieces.push_back(piece.corners);
      pieces_.push_back(piece);
    }
    Vec2 centroid = moment / total;
    if (!insideEvenOdd(centroid, flat) || distanceToOutline(centroid, flat) <= coincidence_) {
      // The face is concave: we take the middle of the nearest piece.
      centroid = *std::ranges::min_element(middles, [&](const Vec2& a, const Vec2& b) {
        return glm::length(a - centroid) < glm::length(b - centroid);
      });
    }
    return frame.lift(centroid);
  }

  /// Pairs of faces that face each other across a gap that counts as nothing.
  void noteLostGaps() {
    std::vector<Box3> boxes;
    std::vector<Index> faces;
    for (Index f = 0; f < scene_.faceCount(); ++f) {
      if (!(shapes_[f].area > 0)) continue;
      Box3 box;
      for (const Index v : scene_.face(f)) box.add(scene_.vertices[v]);
      boxes.push_back(box.grown(0.5 * of_surface_[scene_.face_surface[f]]));
      faces.push_back(f);
    }
    const auto wanted = [&](Index i, Index j) {
      const Index f = faces[i];
      const Index g = faces[j];
      // Planes that are nearer than the coincidence everywhere turn by little.
      if (glm::dot(shapes_[f].normal, shapes_[g].normal) > -1 + 1e-6) return false;
      const double gap = gapBetween(scene_, f, g);
      return gap > 0 && gap < std::min(of_surface_[scene_.face_surface[f]],
                                       of_surface_[scene_.face_surface[g]]);
    };
    LostGaps lost;
    for (const auto& [i, j] : overlappingPairs(boxes, &progress_, wanted)) {
      lost.add(scene_, faces[i], faces[j], gapBetween(scene_, faces[i], faces[j]));
    }
    const std::vector<Note> notes = lost.notes(scene_, coincidence_);
    report_.notes.insert(report_.notes.end(), notes.begin(), notes.end());
  }

  /// Faces that others repeat, and those that share some of their area.
  void noteOverlaps() {
    if (report_.duplicate_faces > 0) {
      Index first = 0;
      while (repeats_[first] == kNone || shapes_[repeats_[first]].area == 0) ++first;
      report_.notes.push_back(
          {Severity::warning,
           fmt::format(
               "{} faces have the corners of others and stay as patches without area, first "
               "{}, which repeats {}",
               report_.duplicate_faces, nameOf(scene_, first), nameOf(scene_, repeats_[first]))});
    }
    const auto overlaps = findOverlaps(scene_, pieces_, coincidence_, progress_);
    if (overlaps.empty()) return;
    report_.notes.push_back(
        {Severity::loud,
         fmt::format("{}{} pairs of faces overlap, first {} and {}: what they share counts twice; "
                     "without {} it is cut off",
                     overlaps.size(), overlaps.size() == kMostOverlaps ? " or more" : "",
                     nameOf(scene_, overlaps[0].first), nameOf(scene_, overlaps[0].second),
                     spelled("faces_as_patches"))});
  }

  void findings() {
    noteLostGaps();
    noteOverlaps();
    const auto crossings = findCrossings(scene_, pieces_, coincidence_, progress_);
    report_.crossings = crossings.size();
    if (!crossings.empty()) {
      report_.notes.push_back(
          {Severity::warning,
           fmt::format("{} pairs of faces cross and are not repaired, first {} and {}",
                       crossings.size(), nameOf(scene_, crossings[0].first),
                       nameOf(scene_, crossings[0].second))});
    }
    if (report_.t_junctions > 0) {
      report_.notes.push_back({Severity::warning, fmt::format("{} T-junctions of the file are kept",
                                                              report_.t_junctions)});
    }
    if (report_.nonplanar_faces > 0) {
      report_.notes.push_back(
          {Severity::warning,
           fmt::format("{} faces are not planar, {} by {:g} m: each is one patch on the plane of "
                       "its vector area",
                       report_.nonplanar_faces, nameOf(scene_, least_planar_),
                       report_.largest_deviation)});
    }
    if (report_.degenerate_faces > 0) {
      report_.notes.push_back(
          {Severity::warning, fmt::format("{} degenerate faces stay as patches without area",
                                          report_.degenerate_faces)});
    }
  }

  const Scene& scene_;
  MeshReport& report_;
  Progress& progress_;
  Vec3 centre_{0.0};
  double coincidence_ = 0;
  std::vector<double> of_surface_;  ///< coincidence: a small thing has less
  double least_coincidence_ = std::numeric_limits<double>::infinity();
  PatchMesh mesh_;
  std::vector<FaceShape> shapes_;
  std::vector<Index> repeats_;  ///< by face, as findRepeats() has it
  std::vector<FacePiece> pieces_;
  Index least_planar_ = kNone;
};

}  // namespace

PatchMesh facesAsPatches(const Scene& scene, const MeshOptions& options, MeshReport& report,
                         Progress& progress) {
  options.validate();
  if (scene.faceCount() == 0) throw InputError(fmt::format("{}: no face has an area", scene.file));
  return FacePatches(scene, options, report, progress).build();
}

}  // namespace radiosity
