// The default camera: tries viewpoints with a tiny render each and takes the one that shows most.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "base/parallel.h"
#include "radiosity/render.h"
#include "render/item_buffer.h"

namespace radiosity {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kTrialPixels = 3600;  // of a trial render, 60 x 60 where the picture is square
constexpr double kBetter = 1.01;    // a later candidate must show 1% more than an earlier one
constexpr double kInsideFov = 76;   // degrees; only a wide lens shows a room from within
constexpr double kStraight =
    1.2;  // worth of looking along the room: verticals and corners in order
constexpr double kOutsideFov = 40;  // degrees; little perspective distortion
constexpr double kMargin = 0.95;    // share of the picture that a framed scene fills

struct Box {
  Vec3 low{std::numeric_limits<double>::infinity()};
  Vec3 high{-std::numeric_limits<double>::infinity()};
  Vec3 size() const { return high - low; }
  Vec3 at(const Vec3& share) const { return low + share * size(); }
};

/// Of the patches that have an area.
Box boundingBox(const PatchMesh& mesh) {
  Box box;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (!(mesh.area[i] > 0)) continue;
    for (const Index v : mesh.outline(i)) {
      box.low = glm::min(box.low, mesh.vertices[v]);
      box.high = glm::max(box.high, mesh.vertices[v]);
    }
  }
  return box;
}

/// A camera to try, and how much it is liked for other reasons than what it shows.
struct Candidate {
  Camera camera;
  double liked = 1;
};

/// What a viewpoint sees. Shares of the picture and of the scene, 0 to 1.
struct Glimpse {
  double fronts = 0;  ///< of the picture
  double near = 0;    ///< of the picture: surfaces closer than 4% of the scene's diagonal
  double shown = 0;   ///< of the scene, see shown()
};

/// How much of the scene is shown where `seen` is the area seen of each patch: the sum over the
/// planar polygons of sqrt(area seen * area), over their area. With the root, a tenth of the
/// ceiling is worth a third of it: a view that shows something of everything wins over one that
/// shows all of half the scene.
double shown(const PatchMesh& mesh, const std::vector<double>& seen) {
  std::vector<std::array<double, 2>> polygons;  // area, area seen
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (!(mesh.area[i] > 0)) continue;
    if (mesh.polygon[i] >= polygons.size()) polygons.resize(mesh.polygon[i] + 1, {0.0, 0.0});
    polygons[mesh.polygon[i]][0] += mesh.area[i];
    polygons[mesh.polygon[i]][1] += std::min(seen[i], mesh.area[i]);
  }
  double total = 0;
  double sum = 0;
  for (const auto& [area, part] : polygons) {
    total += area;
    sum += std::sqrt(area * part);
  }
  return sum / total;
}

/// A pixel at depth z sees the area z^2 / (f^2 |n . d|) of a surface with normal n along the ray d
/// (d.z = 1), f the focal length in pixels; a patch is never counted for more than it has.
Glimpse look(const PatchMesh& mesh, const Camera& camera, double aspect, double diagonal) {
  const int width = std::max(8, int(std::lround(std::sqrt(kTrialPixels * aspect))));
  const int height = std::max(8, int(std::lround(std::sqrt(kTrialPixels / aspect))));
  const View view = makeView(camera, width, height);
  const ItemBuffer items(mesh, view, 1, true);
  std::vector<double> seen(mesh.size(), 0.0);
  Glimpse glimpse;
  TileItems tile;
  for (int t = 0; t < items.tileCount(); ++t) {
    items.resolve(t, tile);
    for (int y = tile.y; y < tile.y + tile.height; ++y) {
      for (int x = tile.x; x < tile.x + tile.width; ++x) {
        const std::size_t k = tile.at(x, y, 0);
        if (tile.piece[k] == kNone) continue;
        const double depth = 1 / tile.inverse_depth[k];
        glimpse.near += depth < 0.04 * diagonal;
        if (items.seenFromBehind(tile.piece[k])) continue;
        const Index patch = items.patchOf(tile.piece[k]);
        const Vec3 ray = view.rayThrough(x + 0.5, y + 0.5);
        const double cosine = std::abs(glm::dot(mesh.normal[patch], ray));
        seen[patch] += depth * depth / (view.focal * view.focal * cosine);
        ++glimpse.fronts;
      }
    }
  }
  glimpse.shown = shown(mesh, seen);
  glimpse.fronts /= double(width) * height;
  glimpse.near /= double(width) * height;
  return glimpse;
}

/// The first candidate whose score no later one beats by 1%; the score of all is 0: nothing.
template <class Score>
std::optional<Camera> best(const std::vector<Candidate>& candidates, const Score& score) {
  std::vector<double> scores(candidates.size());
  parallelFor(candidates.size(), 1, [&](std::size_t k) {
    scores[k] = candidates[k].liked * score(candidates[k].camera);
  });
  std::size_t chosen = 0;
  for (std::size_t k = 1; k < scores.size(); ++k) {
    if (scores[k] > kBetter * scores[chosen]) chosen = k;
  }
  return !scores.empty() && scores[chosen] > 0 ? std::optional(candidates[chosen].camera)
                                               : std::nullopt;
}

/// Viewpoints near the ends of the horizontal extents, the longer one first, each looking at the
/// middle of the opposite end. Further steps into the room and to the side find a place where the
/// room is not a box or furniture stands at its end.
std::vector<Candidate> viewpointsInside(const Box& box, double aspect) {
  const Vec3 size = box.size();
  const int longer = size.x > size.z ? 0 : 2;
  std::vector<Candidate> candidates;
  for (const int axis : {longer, 2 - longer}) {
    for (const bool from_high : {true, false}) {  // from +z or +x first: forward is -z by custom
      for (const double lateral : {0.5, 0.25, 0.75}) {
        for (const double height : {0.5, 0.62, 0.38}) {
          for (const double inset : {0.03, 0.15, 0.35}) {
            Vec3 eye(lateral, height, lateral);
            Vec3 target(0.5, 0.47, 0.5);
            eye[axis] = from_high ? 1 - inset : inset;
            target[axis] = from_high ? 0 : 1;
            Camera camera;
            camera.eye = box.at(eye);
            camera.target = box.at(target);
            // A wide picture shows more to the sides, a tall one more above and below.
            camera.vertical_fov =
                2 * std::atan(std::tan(kInsideFov / 2 * kDegree) / std::sqrt(aspect));
            candidates.push_back({camera, lateral == 0.5 ? kStraight : 1.0});
          }
        }
      }
    }
  }
  return candidates;
}

/// Looks at the box's centre from `direction`, from so far that every vertex is in the picture.
Camera framed(const PatchMesh& mesh, const Box& box, const Vec3& direction, double aspect) {
  Camera camera;
  camera.target = box.at(Vec3(0.5));
  camera.vertical_fov = kOutsideFov * kDegree;
  const Vec3 right = glm::normalize(glm::cross(-direction, camera.up));
  const Vec3 up = glm::cross(direction, right);
  const double tan_up = kMargin * std::tan(camera.vertical_fov / 2);
  double distance = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (!(mesh.area[i] > 0)) continue;
    for (const Index v : mesh.outline(i)) {
      const Vec3 p = mesh.vertices[v] - camera.target;
      const double beside =
          std::max(std::abs(glm::dot(p, right)) / aspect, std::abs(glm::dot(p, up)));
      distance = std::max(distance, glm::dot(p, direction) + beside / tan_up);
    }
  }
  camera.eye = camera.target + direction * distance;
  return camera;
}

/// Straight on and level first (an open box, a plate), then from the side and above (a solid, a
/// scene on a floor), at last from below.
std::vector<Candidate> viewpointsOutside(const PatchMesh& mesh, const Box& box, double aspect) {
  std::vector<Candidate> candidates;
  for (const double elevation : {0.0, 20.0, 40.0, -20.0, -40.0}) {
    for (const double azimuth :
         {0.0, 180.0, 90.0, 270.0, 30.0, 330.0, 60.0, 300.0, 120.0, 240.0, 150.0, 210.0}) {
      const Vec3 direction(std::sin(azimuth * kDegree) * std::cos(elevation * kDegree),
                           std::sin(elevation * kDegree),
                           std::cos(azimuth * kDegree) * std::cos(elevation * kDegree));
      candidates.push_back({framed(mesh, box, direction, aspect)});
    }
  }
  return candidates;
}

}  // namespace

Camera framingCamera(const PatchMesh& mesh, bool closed, double aspect) {
  if (!(aspect > 0) || !std::isfinite(aspect)) {
    throw InputError("framing: the picture's aspect ratio must be positive");
  }
  const Box box = boundingBox(mesh);
  if (!(glm::length(box.size()) < std::numeric_limits<double>::infinity())) return {};  // empty
  const double diagonal = glm::length(box.size());
  std::optional<Camera> found;
  if (closed) {
    found = best(viewpointsInside(box, aspect), [&](const Camera& camera) {
      const Glimpse glimpse = look(mesh, camera, aspect, diagonal);
      // Inside a block, or outside the room, the eye sees backs or nothing.
      if (glimpse.fronts < 0.5) return 0.0;
      return glimpse.shown * glimpse.fronts * glimpse.fronts * (1 - glimpse.near);
    });
  }
  if (!found) {  // open, or closed without a place inside: a solid seen from outside
    found = best(viewpointsOutside(mesh, box, aspect),
                 [&](const Camera& camera) { return look(mesh, camera, aspect, diagonal).shown; });
  }
  Camera camera = found.value_or(framed(mesh, box, Vec3(0, 0, 1), aspect));
  camera.name = "framing";
  return camera;
}

}  // namespace radiosity
