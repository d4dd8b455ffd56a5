// The default camera: takes a tiny picture from each viewpoint, by rays, and keeps the viewpoint
// that shows most.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <numbers>

#include "base/geometry/box.h"
#include "base/parallel.h"
#include "formfactor/rays/point_rays.h"
#include "radiosity/render.h"
#include "render/view.h"

namespace radiosity {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kTrialPixels = 3600;  // of a trial render, 60 x 60 if the picture is square
constexpr double kBetter = 1.01;    // a later candidate must show 1% more than an earlier one
constexpr double kInsideFov = 76;   // degrees; only a wide lens shows a room from within
constexpr double kStraight =
    1.2;  // worth of looking along the room: verticals and corners in order
constexpr double kOutsideFov = 40;  // degrees; little perspective distortion
constexpr double kBelow = 0.3;      // worth of looking up from below
constexpr double kMargin = 0.95;    // share of the picture that a framed scene fills
constexpr double kEyeHeight = 1.6;  // metres above the floor, if the scene is as high as a room
constexpr double kStanding = 1.1;   // worth of standing at that height
constexpr double kEnclosed = 0.75;  // share of all directions that end on fronts within a room
constexpr double kRoom = 1.5;       // worth of being in a room that has an outside too
/// If the best view has less light than this and most polygons lie within a box of kCrowded of the
/// scene's diagonal, these are framed.
constexpr double kDark = 0.05;
constexpr double kCrowded = 0.1;
/// If what stands in the scene covers less of the best picture than this, a few dots, the
/// neighbourhood of the largest patch is framed: six houses in a plain of ten kilometres.
constexpr double kEmpty = 0.01;

/// Turn vectors about the x axis so that the scene's z becomes y, and back.
Vec3 turnedUp(const Vec3& v) { return {v.x, v.z, -v.y}; }
Vec3 turnedBack(const Vec3& v) { return {v.x, 0 - v.z, v.y}; }  // avoids -0, which would be printed

PatchMesh turnedUp(const PatchMesh& mesh) {
  PatchMesh turned = mesh;
  for (auto* const vectors : {&turned.vertices, &turned.centroid, &turned.normal,
                              &turned.polygons.normal, &turned.polygons.origin}) {
    for (Vec3& v : *vectors) v = turnedUp(v);
  }
  return turned;
}

Camera turnedBack(Camera camera) {
  for (Vec3* const v : {&camera.eye, &camera.target, &camera.up}) *v = turnedBack(*v);
  return camera;
}

/// The box around all patches with an `area` above 0.
Box3 boundingBox(const PatchMesh& mesh, std::span<const double> area) {
  Box3 box;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (!(area[i] > 0)) continue;
    for (const Index v : mesh.outline(i)) box.add(mesh.vertices[v]);
  }
  return box;
}

/// The box of the middle 60% of all polygons in each direction, and its surroundings.
Box3 crowdedBox(const PatchMesh& mesh) {
  std::vector<Vec3> sum(mesh.polygons.size(), Vec3(0.0));
  std::vector<double> area(sum.size(), 0.0);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.polygon[i] >= sum.size()) continue;
    sum[mesh.polygon[i]] += mesh.area[i] * mesh.centroid[i];
    area[mesh.polygon[i]] += mesh.area[i];
  }
  Box3 box;
  constexpr std::size_t kLeft = 5;  // a fifth at either end
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> places;
    for (std::size_t p = 0; p < sum.size(); ++p) {
      if (area[p] > 0) places.push_back(sum[p][axis] / area[p]);
    }
    if (places.size() < kLeft) return {};
    std::sort(places.begin(), places.end());
    box.low[axis] = places[places.size() / kLeft];
    box.high[axis] = places[places.size() - 1 - places.size() / kLeft];
  }
  // Surfaces end beyond their middles, and a wall may be the end of its room.
  constexpr double kAround = 0.6;
  const Vec3 size = box.size();
  const double around = kAround * std::max({size.x, size.y, size.z});
  return box.grown(around);
}

/// The areas of patches, 0 for those that are not to be framed: a stray object far away, or the
/// rest of a ground much larger than what stands on it, would leave the scene a dot in the picture.
std::vector<double> framedAreas(const PatchMesh& mesh) {
  std::vector<double> areas(mesh.area.begin(), mesh.area.end());
  const Box3 crowd = crowdedBox(mesh);
  const double whole = boundingBox(mesh, mesh.area).diagonal();
  if (!(crowd.diagonal() > 0 && crowd.diagonal() < kCrowded * whole)) return areas;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const Vec3& c = mesh.centroid[i];
    const bool inside = glm::all(glm::greaterThanEqual(c, crowd.low)) &&
                        glm::all(glm::lessThanEqual(c, crowd.high));
    if (!inside) areas[i] = 0;
  }
  const bool any = std::ranges::any_of(areas, [](double area) { return area > 0; });
  return any ? areas : std::vector<double>(mesh.area.begin(), mesh.area.end());
}

/// A camera to try, and its worth apart from the view.
struct Candidate {
  Camera camera;
  double liked = 1;
};

/// The mesh, rays to look at it, and the brightness of each patch: 1 for the typical light of lit
/// patches, or more light.
struct LitMesh {
  const PatchMesh& mesh;
  const PointRays rays;
  std::vector<double> area;        ///< N, of patches that are to be framed; 0: not
  std::vector<double> brightness;  ///< N, 0 to 1

  LitMesh(const PatchMesh& patches, std::span<const double> light)
      : mesh(patches), rays(patches), area(patches.area) {
    brightness.assign(mesh.size(), 1.0);
    const double typical = light.empty() ? 0 : typicalLight(mesh, light);
    if (!(typical > 0)) return;
    // A root, as in human vision: half of the typical light counts as 0.7.
    for (std::size_t i = 0; i < light.size(); ++i) {
      brightness[i] = std::sqrt(std::min(1.0, light[i] / typical));
    }
  }
};

/// The areas of patches in the neighbourhood of the largest lit one, 0 for those farther away.
std::vector<double> areasAroundLargest(const LitMesh& scene) {
  const PatchMesh& mesh = scene.mesh;
  std::size_t largest = 0;
  for (std::size_t i = 1; i < mesh.size(); ++i) {
    const auto worth = [&](std::size_t k) { return mesh.area[k] * scene.brightness[k]; };
    if (worth(i) > worth(largest)) largest = i;
  }
  constexpr double kSizes = 10;
  const double reach = kSizes * std::sqrt(mesh.area[largest]);
  std::vector<double> areas(mesh.area.begin(), mesh.area.end());
  for (std::size_t i = 0; i < areas.size(); ++i) {
    if (glm::distance(mesh.centroid[i], mesh.centroid[largest]) > reach) areas[i] = 0;
  }
  return areas;
}

/// The view from one point: shares of the picture and of the scene, 0 to 1.
struct Glimpse {
  double fronts = 0;  ///< of the picture
  double lit = 0;     ///< mean brightness of the fronts seen
  double near = 0;    ///< of the picture: surfaces closer than 4% of the scene's diagonal
  double shown = 0;   ///< of the scene, see shown()
};

/// The share of the scene that is shown: the sum over planar polygons of sqrt(area seen * area),
/// over their area. `seen`: the visible area of each patch. With the root, a tenth of the ceiling
/// counts as a third of it: a view that shows a part of everything wins over one that shows all of
/// half the scene.
double shown(const LitMesh& scene, const std::vector<double>& seen) {
  const PatchMesh& mesh = scene.mesh;
  std::vector<std::array<double, 2>> polygons;  // area, area seen
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (!(scene.area[i] > 0)) continue;
    if (mesh.polygon[i] >= polygons.size()) polygons.resize(mesh.polygon[i] + 1, {0.0, 0.0});
    polygons[mesh.polygon[i]][0] += scene.area[i];
    polygons[mesh.polygon[i]][1] += std::min(seen[i], scene.area[i]);
  }
  double total = 0;
  double sum = 0;
  for (const auto& [area, part] : polygons) {
    total += area;
    sum += std::sqrt(area * part);
  }
  return sum / total;
}

/// A tiny picture: where the ray through each pixel's centre ends.
struct Trial {
  View view;
  std::vector<Vec3> ray;  ///< unit vectors
  std::vector<RayEnd> end;

  Trial(const PointRays& rays, const Camera& camera, int width, int height)
      : view(makeView(camera, width, height)) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        ray.push_back(glm::normalize(view.rayThrough(x + 0.5, y + 0.5)));
      }
    }
    end.resize(ray.size());
    rays.trace(view.eye, ray, end);
  }
};

/// A pixel at depth z sees the area z^2 / (f^2 |n . d|) of a surface with normal n along the ray d
/// (d.z = 1); f is the focal length in pixels. The visible area of a patch is at most its area.
Glimpse look(const LitMesh& scene, const Camera& camera, double aspect, double diagonal) {
  const PatchMesh& mesh = scene.mesh;
  // Even, so that no row or column of pixels is in the middle, where a flat scene, seen from the
  // side, would fill it alone and be taken for all of the picture.
  const int width = std::max(8, 2 * int(std::lround(std::sqrt(kTrialPixels * aspect) / 2)));
  const int height = std::max(8, 2 * int(std::lround(std::sqrt(kTrialPixels / aspect) / 2)));
  const Trial trial(scene.rays, camera, width, height);
  const View& view = trial.view;
  std::vector<double> seen(mesh.size(), 0.0);
  Glimpse glimpse;
  for (std::size_t k = 0; k < trial.end.size(); ++k) {
    const std::uint32_t patch = trial.end[k].patch;
    if (patch == RayEnd::kSky) continue;
    const double depth = glm::dot(trial.end[k].at - view.eye, view.forward);
    glimpse.near += depth < 0.04 * diagonal;
    if (patch >= mesh.size()) continue;  // a back
    const double along = glm::dot(trial.ray[k], view.forward);
    const double cosine = std::abs(glm::dot(mesh.normal[patch], trial.ray[k])) / along;
    seen[patch] += depth * depth / (view.focal * view.focal * cosine);
    ++glimpse.fronts;
    glimpse.lit += scene.brightness[patch];
  }
  glimpse.shown = shown(scene, seen);
  if (glimpse.fronts > 0) glimpse.lit /= glimpse.fronts;
  glimpse.fronts /= double(width) * height;
  glimpse.near /= double(width) * height;
  return glimpse;
}

/// The share of all directions from a point that end on fronts: the share of pixels on the six
/// faces of a cube, which all count the same.
double enclosure(const LitMesh& scene, const Vec3& eye) {
  constexpr int kPixels = 16;
  double fronts = 0;
  for (int face = 0; face < 6; ++face) {
    Camera camera;
    camera.eye = eye;
    camera.target = eye;
    camera.target[face / 2] += (face % 2 == 0 ? 1 : -1) * (1 + std::abs(eye[face / 2]));
    camera.up = face / 2 == 1 ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
    camera.vertical_fov = 90 * kDegree;
    for (const RayEnd& end : Trial(scene.rays, camera, kPixels, kPixels).end) {
      fronts += end.patch < scene.mesh.size();
    }
  }
  return fronts / (6.0 * kPixels * kPixels);
}

struct Scored {
  Camera camera;
  double score = 0;
};

/// The first allowed candidate whose score no later one beats by 1%; score 0: none shows a surface.
template <class Score, class Allowed>
Scored best(const std::vector<Candidate>& candidates, const Score& score, const Allowed& allowed) {
  std::vector<double> scores(candidates.size());
  parallelFor(candidates.size(), 1, [&](std::size_t k) {
    scores[k] = candidates[k].liked * score(candidates[k].camera);
  });
  // If the best candidates are not allowed, others hardly are.
  constexpr int kTries = 12;
  for (int tried = 0; tried < kTries && !scores.empty(); ++tried) {
    std::size_t chosen = 0;
    for (std::size_t k = 1; k < scores.size(); ++k) {
      if (scores[k] > kBetter * scores[chosen]) chosen = k;
    }
    if (!(scores[chosen] > 0)) break;
    if (allowed(candidates[chosen].camera)) return {candidates[chosen].camera, scores[chosen]};
    scores[chosen] = 0;
  }
  return {};
}

/// The eye heights to try, as shares of the box's height, with the worth of each: that of a
/// person's eyes, if the box has the height of a room or a hall, and heights near the middle.
std::vector<std::pair<double, double>> eyeHeights(double height) {
  std::vector<std::pair<double, double>> shares = {{0.5, 1.0}, {0.62, 1.0}, {0.38, 1.0}};
  if (height > 1.2 * kEyeHeight && height < 40 * kEyeHeight) {
    shares.insert(shares.begin(), {kEyeHeight / height, kStanding});
  }
  return shares;
}

Camera insideCamera(const Vec3& eye, const Vec3& target, double aspect) {
  Camera camera;
  camera.eye = eye;
  camera.target = target;
  // A wide picture shows more to the sides, a tall one more above and below.
  camera.vertical_fov = 2 * std::atan(std::tan(kInsideFov / 2 * kDegree) / std::sqrt(aspect));
  return camera;
}

/// Whether a direction is level enough, and its target is not at the eye's feet.
bool isLevel(const Vec3& way, const Box3& box) {
  return std::hypot(way.x, way.z) > 0.02 * glm::length(box.size());
}

/// Viewpoints near the ends of the horizontal extents, the longer one first, each looking at the
/// middle of the opposite end. Further ones lie deeper in the room and to the side, for rooms that
/// are not boxes or have furniture at the end.
std::vector<Candidate> viewpointsInside(const Box3& box, double aspect) {
  const Vec3 size = box.size();
  const int longer = size.x > size.z ? 0 : 2;
  std::vector<Candidate> candidates;
  for (const int axis : {longer, 2 - longer}) {
    for (const bool from_high : {true, false}) {  // from +z or +x first: forward is -z by custom
      for (const double lateral : {0.5, 0.25, 0.75}) {
        for (const auto& [height, liked] : eyeHeights(size.y)) {
          for (const double inset : {0.03, 0.15, 0.35}) {
            Vec3 eye(lateral, height, lateral);
            Vec3 target(0.5, std::min(0.47, std::max(height, 0.3)), 0.5);
            eye[axis] = from_high ? 1 - inset : inset;
            target[axis] = from_high ? 0 : 1;
            if (!isLevel(box.at(target) - box.at(eye), box)) continue;
            candidates.push_back({insideCamera(box.at(eye), box.at(target), aspect),
                                  liked * (lateral == 0.5 ? kStraight : 1.0)});
          }
        }
      }
    }
  }
  return candidates;
}

/// Viewpoints all over the box that look at the middle of the lit patches, for scenes with light in
/// one room of many.
std::vector<Candidate> viewpointsAtLight(const LitMesh& scene, const Box3& box, double aspect) {
  Vec3 middle(0.0);
  double total = 0;
  for (std::size_t i = 0; i < scene.mesh.size(); ++i) {
    const double weight = scene.area[i] * scene.brightness[i];
    middle += weight * scene.mesh.centroid[i];
    total += weight;
  }
  if (!(total > 0)) return {};
  middle /= total;
  const auto [height, liked] = eyeHeights(box.size().y).front();
  std::vector<Candidate> candidates;
  for (const double x : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    for (const double z : {0.9, 0.7, 0.5, 0.3, 0.1}) {
      const Vec3 eye = box.at(Vec3(x, height, z));
      const Vec3 target(middle.x, 0.5 * (middle.y + eye.y), middle.z);
      if (!isLevel(target - eye, box)) continue;
      candidates.push_back({insideCamera(eye, target, aspect), liked});
    }
  }
  return candidates;
}

/// A camera that looks at the box's centre from `direction`, so far away that every vertex that is
/// to be framed is in the picture.
Camera framed(const LitMesh& scene, const Box3& box, const Vec3& direction, double aspect) {
  const PatchMesh& mesh = scene.mesh;
  Camera camera;
  camera.target = box.at(Vec3(0.5));
  camera.vertical_fov = kOutsideFov * kDegree;
  const Vec3 right = glm::normalize(glm::cross(-direction, camera.up));
  const Vec3 up = glm::cross(direction, right);
  const double tan_up = kMargin * std::tan(camera.vertical_fov / 2);
  double distance = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (!(scene.area[i] > 0)) continue;
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
std::vector<Candidate> viewpointsOutside(const LitMesh& scene, const Box3& box, double aspect) {
  std::vector<Candidate> candidates;
  for (const double elevation : {0.0, 20.0, 40.0, -20.0, -40.0}) {
    for (const double azimuth :
         {0.0, 180.0, 90.0, 270.0, 30.0, 330.0, 60.0, 300.0, 120.0, 240.0, 150.0, 210.0}) {
      const Vec3 direction(std::sin(azimuth * kDegree) * std::cos(elevation * kDegree),
                           std::sin(elevation * kDegree),
                           std::cos(azimuth * kDegree) * std::cos(elevation * kDegree));
      candidates.push_back({framed(scene, box, direction, aspect), elevation < 0 ? kBelow : 1.0});
    }
  }
  return candidates;
}

/// The best place to stand in the scene's room; score 0: there is none.
Scored standInside(const LitMesh& scene, const Box3& box, bool closed, double aspect) {
  std::vector<Candidate> candidates = viewpointsInside(box, aspect);
  for (Candidate& c : viewpointsAtLight(scene, box, aspect)) candidates.push_back(c);
  const double diagonal = glm::length(box.size());
  return best(
      candidates,
      [&](const Camera& camera) {
        const Glimpse glimpse = look(scene, camera, aspect, diagonal);
        // Inside a block, or outside the room, the eye sees backs or nothing.
        if (glimpse.fronts < 0.5) return 0.0;
        return glimpse.shown * glimpse.fronts * glimpse.fronts * (1 - glimpse.near) * glimpse.lit;
      },
      [&](const Camera& camera) { return closed || enclosure(scene, camera.eye) >= kEnclosed; });
}

Scored standOutside(const LitMesh& scene, const Box3& box, double aspect) {
  const double diagonal = glm::length(box.size());
  return best(
      viewpointsOutside(scene, box, aspect),
      [&](const Camera& camera) {
        const Glimpse glimpse = look(scene, camera, aspect, diagonal);
        return glimpse.shown * glimpse.lit;
      },
      [](const Camera&) { return true; });
}

Camera named(Camera camera, const char* name) {
  camera.name = name;
  return camera;
}

/// The best camera for what is to be framed.
Camera bestCamera(const LitMesh& scene, const Box3& box, bool closed, double aspect) {
  const Scored inside = standInside(scene, box, closed, aspect);
  if (closed && inside.score > 0) return named(inside.camera, "framed from inside");
  const Scored outside = standOutside(scene, box, aspect);
  if (kRoom * inside.score > outside.score) return named(inside.camera, "framed from inside");
  return named(outside.score > 0 ? outside.camera : framed(scene, box, Vec3(0, 0, 1), aspect),
               "framed from outside");
}

}  // namespace

double typicalLight(const PatchMesh& mesh, std::span<const double> light) {
  if (light.size() != mesh.size()) {
    throw InputError(fmt::format("framing: {} brightnesses were given for {} patches", light.size(),
                                 mesh.size()));
  }
  double sum = 0;
  double squares = 0;
  for (std::size_t i = 0; i < light.size(); ++i) {
    sum += mesh.area[i] * light[i];
    squares += mesh.area[i] * light[i] * light[i];
  }
  return sum > 0 ? squares / sum : 0;
}

Camera framingCamera(const PatchMesh& mesh, bool closed, double aspect,
                     std::span<const double> light, Up up) {
  if (up == Up::z) return turnedBack(framingCamera(turnedUp(mesh), closed, aspect, light));
  if (!(aspect > 0) || !std::isfinite(aspect)) {
    throw InputError("framing: the picture's aspect ratio must be positive");
  }
  const Box3 box = boundingBox(mesh, mesh.area);
  if (!(box.diagonal() < std::numeric_limits<double>::infinity())) return {};  // empty
  LitMesh scene(mesh, light);
  Camera camera = bestCamera(scene, box, closed, aspect);
  const Glimpse glimpse = look(scene, camera, aspect, box.diagonal());
  const bool empty = glimpse.fronts < kEmpty;
  if (!empty && glimpse.lit >= kDark) return camera;
  scene.area = framedAreas(mesh);
  if (scene.area == mesh.area) {
    if (!empty) return camera;
    scene.area = areasAroundLargest(scene);
  }
  return bestCamera(scene, boundingBox(mesh, scene.area), closed, aspect);
}

}  // namespace radiosity
