// Reads View3D input: surfaces with emissivities, and subsurfaces that are cut out of their bases.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/geometry/clip.h"
#include "base/geometry/plane_frame.h"
#include "base/input_file.h"
#include "scene/meshes/view3d_scan.h"
#include "scene/readers.h"
#include "scene/scene_builder.h"

namespace radiosity {

namespace {

using Kind = View3dSurface::Kind;
using Loop = std::vector<Vec3>;

/// The largest distance of a subsurface from its base's plane, or of its corners beyond an edge,
/// over the base's size: View3D itself accepts as much (coordinates of five digits).
constexpr double kOffPlane = 1e-5;
/// Points closer to a cut than this, over the base's size, count as on it, so that touching edges
/// make no splinters.
constexpr double kOnEdge = 1e-7;

class View3dReader {
 public:
  View3dReader(const std::string& path, const View3dScan& scan, const SceneOptions& options)
      : scan_(scan), builder_(scene_, options), holes_(scan.surfaces.size()) {
    scene_.file = path;
    scene_.notes = scan.notes;
    scene_.vertices = scan.vertices;
    for (std::size_t k = 0; k < scan_.surfaces.size(); ++k) {
      if (scan_.surfaces[k].base > 0) holes_[scan_.surfaces[k].base - 1].push_back(k);
    }
  }

  Scene read() {
    for (std::size_t k = 0; k < scan_.surfaces.size(); ++k) addSurface(k);
    notes_.appendTo(scene_.notes);
    builder_.finish();
    return std::move(scene_);
  }

 private:
  [[noreturn]] void fail(const View3dSurface& surface, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", scene_.file, surface.line, what));
  }

  void addSurface(std::size_t k) {
    const View3dSurface& surface = scan_.surfaces[k];
    surface_of_.push_back(kNone);
    if (surface.kind == Kind::mask || surface.kind == Kind::null) {
      notes_.add("mask and null surfaces see nothing but what they cover: both are left out",
                 surface.name, Severity::warning);
      return;
    }
    surface_of_[k] = surface.combined > 0 ? surface_of_[surface.combined - 1] : newSurface(k);
    if (holes_[k].empty()) {
      builder_.addFace(surface.corners, {}, surface_of_[k], surface.line);
    } else {
      addWithHoles(k);
    }
  }

  Index newSurface(std::size_t k) {
    const View3dSurface& surface = scan_.surfaces[k];
    Material material;
    material.name = names_.make(surface.name);
    material.reflectance = Vec3(1 - surface.emissivity);
    scene_.materials.push_back(material);
    if (surface.kind == Kind::obstruction) {
      notes_.add(surface.emissivity == 1 ? "obstruction surfaces block and absorb (reflectance 0)"
                                         : "obstruction surfaces block, and reflect as they say",
                 material.name);
    }
    return builder_.surface(material.name, Index(scene_.materials.size() - 1));
  }

  Loop placesOf(const View3dSurface& surface) const {
    Loop places;
    for (const Index v : surface.corners) places.push_back(scan_.vertices[v]);
    return places;
  }

  static double sizeOf(const Loop& loop) {
    double size = 0;
    for (const Vec3& p : loop) size = std::max(size, glm::distance(p, loop[0]));
    return size;
  }

  /// The unit normal. Errors: InputError if the surface has no area or is not convex.
  Vec3 normalOf(const View3dSurface& surface, const Loop& loop) const {
    const Vec3 area = vectorArea(loop.size(), [&](std::size_t k) { return loop[k]; });
    const double size = sizeOf(loop);
    if (!(glm::length(area) > kOnEdge * size * size)) {
      fail(surface, "a surface without area cannot be a base or a subsurface; correct it");
    }
    const Vec3 normal = glm::normalize(area);
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vec3& a = loop[k];
      const Vec3& b = loop[(k + 1) % loop.size()];
      const Vec3& c = loop[(k + 2) % loop.size()];
      if (glm::dot(glm::cross(b - a, c - b), normal) < -kOnEdge * size * size) {
        fail(surface, "a base or subsurface is convex, this one is not; divide and combine it");
      }
    }
    return normal;
  }

  /// Checks View3D's conditions for a subsurface.
  void checkWithin(const View3dSurface& sub, const Loop& hole, const Loop& base,
                   const Vec3& normal) const {
    const bool turned = sub.kind == Kind::mask || sub.kind == Kind::null;
    const double facing = glm::dot(normalOf(sub, hole), normal);
    if ((turned ? -facing : facing) < 0.999) {
      fail(sub, fmt::format("it must lie in the plane of its base surface {} and face {}; correct "
                            "the order of its vertices",
                            sub.base, turned ? "against it" : "as it does"));
    }
    const double tolerance = kOffPlane * sizeOf(base);
    for (const Vec3& p : hole) {
      if (std::abs(glm::dot(p - base[0], normal)) > tolerance) {
        fail(sub, fmt::format("it does not lie in the plane of its base surface {}; correct it",
                              sub.base));
      }
      for (std::size_t k = 0; k < base.size(); ++k) {
        if (insideOf(base, k, normal, p) >= -tolerance) continue;
        fail(sub,
             fmt::format("it is not within its base surface {}; correct or divide it", sub.base));
      }
    }
  }

  /// Distance of p from edge k, positive on the side of the loop.
  static double insideOf(const Loop& loop, std::size_t k, const Vec3& normal, const Vec3& p) {
    const Vec3& a = loop[k];
    const Vec3 along = loop[(k + 1) % loop.size()] - a;
    const double length = glm::length(along);
    return length > 0 ? glm::dot(glm::cross(normal, along), p - a) / length : 0.0;
  }

  void addWithHoles(std::size_t k) {
    const View3dSurface& surface = scan_.surfaces[k];
    const Loop base = placesOf(surface);
    const Vec3 normal = normalOf(surface, base);
    std::vector<Loop> pieces = {base};
    for (const std::size_t sub : holes_[k]) {
      Loop hole = placesOf(scan_.surfaces[sub]);
      checkWithin(scan_.surfaces[sub], hole, base, normal);
      if (glm::dot(normalOf(scan_.surfaces[sub], hole), normal) < 0) {
        std::reverse(hole.begin(), hole.end());
      }
      pieces = without(pieces, hole, normal, kOnEdge * sizeOf(base));
    }
    for (const Loop& piece : pieces) {
      std::vector<Index> corners;
      for (const Vec3& p : piece) {
        corners.push_back(Index(scene_.vertices.size()));
        scene_.vertices.push_back(p);
      }
      builder_.addFace(corners, {}, surface_of_[k], surface.line);
    }
    if (pieces.empty()) {
      notes_.add("subsurfaces cover it whole: left out", surface.name, Severity::warning);
    }
  }

  /// Subtracts a convex hole from convex pieces: along each edge of the hole, the part beyond it is
  /// cut off.
  static std::vector<Loop> without(const std::vector<Loop>& pieces, const Loop& hole,
                                   const Vec3& normal, double tolerance) {
    std::vector<Loop> result;
    for (const Loop& piece : pieces) {
      Loop rest = piece;
      std::vector<Loop> cut_off;
      for (std::size_t k = 0; k < hole.size() && !rest.empty(); ++k) {
        const auto inside = [&](const Vec3& p) {
          const double distance = insideOf(hole, k, normal, p);
          return std::abs(distance) <= tolerance ? 0.0 : distance;
        };
        const auto isInside = [&](const Vec3& p) { return inside(p) > 0; };
        const auto isOutside = [&](const Vec3& p) { return inside(p) < 0; };
        if (std::any_of(rest.begin(), rest.end(), isOutside)) {
          cut_off.push_back(clipped(
              rest, [&](const Vec3& p) { return -inside(p); }, tolerance));
        }
        if (std::any_of(rest.begin(), rest.end(), isInside)) {
          rest = clipped(rest, inside, tolerance);
        } else {
          rest.clear();
        }
      }
      if (rest.empty()) cut_off.assign(1, piece);  // the hole is elsewhere
      result.insert(result.end(), cut_off.begin(), cut_off.end());
    }
    return result;
  }

  /// The part of a loop where side(p) >= 0; it has a corner on the line only once.
  template <class Side>
  static Loop clipped(const Loop& loop, const Side& side, double tolerance) {
    Loop part;
    clipCorners(loop, side, [&](const Vec3& p) {
      if (part.empty() || glm::distance(part.back(), p) > tolerance) part.push_back(p);
    });
    while (part.size() > 1 && glm::distance(part.back(), part.front()) <= tolerance) {
      part.pop_back();
    }
    return part;
  }

  const View3dScan& scan_;
  Scene scene_;
  SceneBuilder builder_;
  std::vector<std::vector<std::size_t>> holes_;  ///< by surface: its subsurfaces
  std::vector<Index> surface_of_;                ///< by surface of the file
  UniqueNames names_;
  FeatureNotes notes_;
};

}  // namespace

Scene loadView3d(const std::string& path, const SceneOptions& options) {
  const View3dScan scan = scanView3d(path, readWholeFile(path));
  return View3dReader(path, scan, options).read();
}

}  // namespace radiosity
