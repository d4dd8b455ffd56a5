#include "formfactor/rays/sharp_shadows.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "base/geometry/box.h"
#include "base/geometry/clip.h"
#include "base/geometry/plane_frame.h"
#include "base/made.h"
#include "formfactor/rays/patch_points.h"

namespace radiosity {
namespace {

/// Past more triangles, or in more parts, points of the patch are faster.
constexpr std::size_t kMostShadows = 64;
constexpr std::size_t kMostParts = 512;
/// Clipping leaves slivers. One that is not so many times as wide as rounding has no plane of its
/// own, nor has a triangle of less than the share below of the square of its length.
constexpr double kLeastWidth = 1e4;
constexpr double kSliver = 1e-9;
/// What is nearer to a lamp, as a share of its height above the patch, hides nothing, as for rays.
constexpr double kNearLamp = 1e-5;

using Loop = std::vector<Vec2>;

/// Clipping leaves corners twice, or nearly so: the line through two of them would be rounding's.
/// Those no farther apart than `close` become one.
void joinCorners(Loop& loop, double close) {
  const auto isClose = [close](const Vec2& a, const Vec2& b) {
    return glm::distance(a, b) <= close;
  };
  loop.erase(std::unique(loop.begin(), loop.end(), isClose), loop.end());
  while (loop.size() > 1 && isClose(loop.front(), loop.back())) loop.pop_back();
}

Box2 boxOfLoop(const Loop& loop) {
  Box2 box;
  for (const Vec2& p : loop) box.add(p);
  return box;
}

/// Adds what is left of a convex part without a convex shadow, both counter-clockwise: a part for
/// each edge of the shadow that cuts it, or the part as it was if nothing of it is hidden.
void addRest(const Loop& part, const Loop& shadow, std::vector<Loop>& rest) {
  const std::size_t before = rest.size();
  Loop hidden = part;
  Loop scratch;
  for (std::size_t k = 0; k < shadow.size(); ++k) {
    const Vec2 from = shadow[k];
    const Vec2 along = shadow[(k + 1) % shadow.size()] - from;
    Loop outside = hidden;
    clipLoop(outside, scratch, [&](const Vec2& p) { return -cross2(along, p - from); });
    if (polygonArea(outside) > 0) rest.push_back(std::move(outside));
    clipLoop(hidden, scratch, [&](const Vec2& p) { return cross2(along, p - from); });
    if (!(polygonArea(hidden) > 0)) {
      rest.resize(before);
      rest.push_back(part);
      return;
    }
  }
}

/// What is left of a convex part without any of the shadows; none: in too many parts.
std::optional<std::vector<Loop>> litParts(Loop whole, const std::vector<Loop>& shadows) {
  std::vector<Loop> parts{std::move(whole)};
  std::vector<Loop> rest;
  for (const Loop& shadow : shadows) {
    const Box2 box = boxOfLoop(shadow);
    rest.clear();
    for (Loop& part : parts) {
      if (boxOfLoop(part).meets(box)) {
        addRest(part, shadow, rest);
      } else {
        rest.push_back(std::move(part));
      }
    }
    parts.swap(rest);
    if (parts.size() > kMostParts) return std::nullopt;
  }
  return parts;
}

}  // namespace

/// The space between a triangle and a light, as half-spaces. Places are relative to the triangle's
/// first corner, which is the origin of `frame`.
struct SharpShadows::Shaft {
  struct Side {
    Vec3 normal;
    double offset;
    double heightOf(const Vec3& p) const { return glm::dot(normal, p) + offset; }
  };

  Shaft(const Corners& piece, const Vec3& normal, const LightRay& ray)
      : frame(makeFrame(piece[0], normal, axisAcross(normal))),
        is_near(ray.distance != LightRay::kOutside),
        light(is_near ? ray.distance * ray.toward : ray.toward),
        height(glm::dot(normal, light)) {
    sides.push_back({normal, 0});
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const Vec3 from = piece[k] - piece[0];
      const Vec3 edge = piece[(k + 1) % piece.size()] - piece[k];
      const Vec3 inward = glm::cross(is_near ? light - from : light, edge);
      sides.push_back({inward, -glm::dot(inward, from)});
    }
    if (is_near) sides.push_back({-normal, height * (1 - kNearLamp)});
    size = std::max(glm::distance(piece[1], piece[0]), glm::distance(piece[2], piece[0]));
    const double rounding = std::numeric_limits<double>::epsilon() * (glm::length(piece[0]) + size);
    close = std::sqrt(rounding * size);
    least = kLeastWidth * rounding * size;
  }

  bool meets(const Box3& box) const {
    return std::ranges::all_of(sides, [&](const Side& side) {
      Vec3 innermost;
      for (int k = 0; k < 3; ++k) innermost[k] = side.normal[k] < 0 ? box.low[k] : box.high[k];
      return side.heightOf(innermost - frame.origin) >= 0;
    });
  }

  /// The shadow of a place in the frame of the triangle's plane.
  Vec2 shadowOf(const Vec3& p) const {
    const double above = glm::dot(frame.n, p);
    const Vec3 at =
        is_near ? light + height / (height - above) * (p - light) : p - above / height * light;
    return {glm::dot(at, frame.u), glm::dot(at, frame.v)};
  }

  PlaneFrame frame;
  bool is_near;   ///< it has a place
  Vec3 light;     ///< that place, or the direction of one that is beyond the scene
  double height;  ///< of either above the triangle's plane
  double size;    ///< an edge of the triangle
  /// Moving a corner so far costs no more than rounding does to the direction of an edge as short.
  double close;
  double least;  ///< the area of a part that has a plane
  std::vector<Side> sides;
};

SharpShadows::SharpShadows(const PatchMesh& mesh, const PointRays& rays)
    : mesh_(mesh), scene_(rays.embree()), view_(rays.scene()) {
  std::vector<Box3> boxes;
  for (std::size_t t = 0; t < scene_.triangles().size(); ++t) boxes.push_back(boxOf(cornersOf(t)));
  tree_ = BoxTree(boxes);
}

SharpShadows::Corners SharpShadows::cornersOf(std::size_t triangle) const {
  const auto& [a, b, c] = scene_.triangles()[triangle];
  const auto& vertices = scene_.vertices();
  return {vertices[a] / view_.scale, vertices[b] / view_.scale, vertices[c] / view_.scale};
}

/// Triangles that lie in the patch's plane hide nothing. Nothing, if there are too many others.
std::optional<std::vector<std::vector<Vec2>>> SharpShadows::shadowsOn(const Shaft& shaft,
                                                                      Index own) const {
  std::vector<Loop> shadows;
  std::vector<Vec3> loop;
  std::vector<Vec3> scratch;
  const double touching = view_.coincidence / view_.scale;
  const auto visit = [&](Index triangle) {
    if (view_.polygons[scene_.polygonOf()[triangle]].source == own) return true;
    loop.clear();
    double highest = 0;
    for (const Vec3& corner : cornersOf(triangle)) {
      loop.push_back(corner - shaft.frame.origin);
      highest = std::max(highest, glm::dot(shaft.frame.n, loop.back()));
    }
    if (!(highest > touching)) return true;
    for (const Shaft::Side& side : shaft.sides) {
      clipLoop(loop, scratch, [&](const Vec3& p) { return side.heightOf(p); });
    }
    Loop shadow;
    for (const Vec3& p : loop) shadow.push_back(shaft.shadowOf(p));
    joinCorners(shadow, shaft.close);
    if (shadow.size() < 3) return true;
    if (polygonArea(shadow) < 0) std::ranges::reverse(shadow);
    shadows.push_back(std::move(shadow));
    return shadows.size() <= kMostShadows;
  };
  tree_.search([&](const Box3& box) { return shaft.meets(box); }, visit);
  if (shadows.size() > kMostShadows) return std::nullopt;
  return shadows;
}

/// The light of all parts of a triangle, times their areas.
std::optional<double> SharpShadows::shareOfParts(const Light& light, const Shaft& shaft,
                                                 const std::vector<std::vector<Vec2>>& parts) {
  double sum = 0;
  for (const Loop& part : parts) {
    for (std::size_t k = 2; k < part.size(); ++k) {
      const std::array<Vec2, 3> flat{part[0], part[k - 1], part[k]};
      const double area = polygonArea(flat);
      if (!(area > shaft.least)) continue;
      const double share = light
                               .share(shaft.frame.lift(flat[0]), shaft.frame.lift(flat[1]),
                                      shaft.frame.lift(flat[2]))
                               .value_or(-1);
      if (share < 0) return std::nullopt;
      sum += area * share;
    }
  }
  return sum;
}

/// Times the piece's area.
std::optional<double> SharpShadows::overPiece(const Light& light, std::size_t patch,
                                              const Corners& piece) const {
  const Vec3& normal = mesh_.normal[patch];
  const LightRay ray = light.ray(piece[0], 0, 0);
  if (!(ray.share > 0) || !(glm::dot(normal, ray.toward) > 0)) return 0.0;
  const Shaft shaft(piece, normal, ray);
  Loop whole;
  for (const Vec3& corner : piece) whole.push_back(shaft.frame.flat(corner));
  if (!(polygonArea(whole) > std::max(shaft.least, kSliver * shaft.size * shaft.size))) {
    return std::nullopt;
  }
  const auto shadows = shadowsOn(shaft, mesh_.polygon[patch]);
  if (!shadows) return std::nullopt;
  const auto parts = litParts(whole, made(shadows));
  if (!parts) return std::nullopt;
  return shareOfParts(light, shaft, made(parts));
}

std::optional<double> SharpShadows::share(const Light& light, std::size_t patch) const {
  const PatchArea area(mesh_, patch);
  double sum = 0;
  for (std::size_t k = 0; k < area.pieces().size(); ++k) {
    if (!(area.sizeOf(k) > 0)) continue;
    const auto& [a, b, c] = area.pieces()[k];
    const Corners piece{mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]};
    if (light.isWide(piece[0]) || !light.share(piece[0], piece[1], piece[2])) return std::nullopt;
    const std::optional<double> of_piece = overPiece(light, patch, piece);
    if (!of_piece) return std::nullopt;
    sum += *of_piece;
  }
  if (!(area.size() > 0)) return std::nullopt;
  return sum / area.size();
}

}  // namespace radiosity
