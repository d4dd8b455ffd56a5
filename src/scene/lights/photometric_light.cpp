// A lamp with the distribution of a file: how it hangs, and its opening near by.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/finite.h"
#include "radiosity/light.h"

namespace radiosity {

namespace {

/// A part of a lamp's opening that shows from a place, in the lamp's frame: a flat rectangle, or an
/// ellipse, about its middle.
struct OpeningFace {
  Vec3 middle{0.0};
  Vec3 u{0.0};  ///< half an edge, or half an axis
  Vec3 v{0.0};
  Vec3 normal{0.0};  ///< unit, to the side of the place
  double area = 0;
  bool ellipse = false;

  Vec3 point(double a, double b) const {
    if (!ellipse) return middle + (2 * a - 1) * u + (2 * b - 1) * v;
    const double off = std::sqrt(a);  // alike by area
    const double angle = 2 * std::numbers::pi * b;
    return middle + off * (std::cos(angle) * u + std::sin(angle) * v);
  }
};

constexpr double kFar = 10;  // sizes; PhotometricLight::isWide()

/// The opening as a convex body: a box, a cylinder along z, or what is left of these where it is
/// thin, a plate or a line.
class OpeningBody {
 public:
  explicit OpeningBody(const Photometry& table)
      : half_(table.opening / 2.0), round_(table.round && half_.x > 0 && half_.y > 0) {}

  /// Without a volume: all its points show from everywhere.
  bool isThin() const { return !(half_.x > 0 && half_.y > 0 && half_.z > 0); }
  /// Of a thin one, alike by area or length.
  Vec3 point(double u, double v) const {
    if (round_) return flat().point(u, v);
    // A line takes u, a plate both.
    Vec3 at(0.0);
    const double off[] = {2 * u - 1, 2 * v - 1};
    int used = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (half_[axis] > 0) at[axis] = off[used++] * half_[axis];
    }
    return at;
  }

  /// The area that shows from far away in a direction, unit.
  double shown(const Vec3& direction) const {
    const Vec3 d = glm::abs(direction);
    const double level = (round_ ? std::numbers::pi : 4.0) * half_.x * half_.y * d.z;
    if (round_) return level + 4 * half_.z * widthAcross(direction) * std::hypot(d.x, d.y);
    return level + 4 * half_.z * (half_.y * d.x + half_.x * d.y);
  }

  /// Of one that is not thin: up to three.
  struct Faces {
    std::array<OpeningFace, 3> all;
    std::size_t count = 0;
  };
  /// Those that face a place.
  Faces facesTo(const Vec3& place) const {
    Faces faces;
    const auto add = [&](const OpeningFace& face) {
      if (glm::dot(place - face.middle, face.normal) > 0) faces.all[faces.count++] = face;
    };
    const Vec3 side = glm::sign(place);
    const Vec3 x(half_.x, 0, 0);
    const Vec3 y(0, half_.y, 0);
    const Vec3 z(0, 0, half_.z);
    OpeningFace level = flat();
    level.middle = side.z * z;
    level.normal = {0, 0, side.z};
    add(level);
    if (round_) {
      const double off = std::hypot(place.x, place.y);
      if (!(off > 0)) return faces;
      const Vec3 normal(place.x / off, place.y / off, 0);
      const double width = widthAcross(normal);
      add({Vec3(0.0), width * Vec3(-normal.y, normal.x, 0), z, normal, 4 * width * half_.z, false});
    } else {
      add({side.x * x, y, z, {side.x, 0, 0}, 4 * half_.y * half_.z, false});
      add({side.y * y, x, z, {0, side.y, 0}, 4 * half_.x * half_.z, false});
    }
    return faces;
  }

 private:
  /// The face across z, in the middle, to the front.
  OpeningFace flat() const {
    return {Vec3(0.0),
            {half_.x, 0, 0},
            {0, half_.y, 0},
            {0, 0, 1},
            (round_ ? std::numbers::pi : 4.0) * half_.x * half_.y,
            round_};
  }

  /// Half the width of the ellipse as it shows along a direction, level or not.
  double widthAcross(const Vec3& d) const {
    const double level = std::hypot(d.x, d.y);
    if (!(level > 0)) return 0;
    return std::hypot(half_.x * d.y, half_.y * d.x) / level;
  }

  Vec3 half_;
  bool round_;
};

}  // namespace

// The shortest way from a to b turns v into v cos + k x v + k (k . v) / (1 + cos), with k = a x b.
std::array<Vec3, 3> PhotometricLight::axes() const {
  const Vec3 above = up.value_or(Vec3(0, 1, 0));
  const Vec3 east(1, 0, 0);
  const Vec3 north = glm::cross(above, east);
  const Vec3 z = aim ? glm::normalize(*aim - at) : -above;
  Vec3 x = east;
  Vec3 y = north;
  const double cosine = -glm::dot(above, z);
  constexpr double kUpright = 1e-12;  // of the square of a sine
  if (!file.empty() && file.table().type != PhotometryType::c) {
    const Vec3 upright = above - glm::dot(above, z) * z;
    if (glm::dot(upright, upright) > kUpright) y = glm::normalize(upright);
    x = glm::cross(z, y);
  } else if (1 + cosine > kUpright) {
    const Vec3 k = glm::cross(-above, z);
    const auto tipped = [&](const Vec3& v) {
      return cosine * v + glm::cross(k, v) + glm::dot(k, v) / (1 + cosine) * k;
    };
    x = tipped(east);
    y = tipped(north);
  } else {
    y = -north;
  }
  if (turn == 0) return {x, y, z};
  const double angle = turn * std::numbers::pi / 180;
  return {std::cos(angle) * x + std::sin(angle) * y, std::cos(angle) * y - std::sin(angle) * x, z};
}

bool PhotometricLight::isWide(const Vec3& place) const {
  return !file.empty() && glm::distance(place, at) < kFar * file.table().size();
}

LightRay PhotometricLight::ray(const Vec3& place, double u, double v) const {
  const Vec3 way = place - at;
  if (file.empty() || !(glm::dot(way, way) > 0)) return {};
  const auto [x, y, z] = axes();
  const Photometry& table = file.table();
  Vec3 to(glm::dot(way, x), glm::dot(way, y), glm::dot(way, z));
  double share = 1 / file.flux();
  const OpeningBody body(table);
  if (isWide(place) && body.isThin()) {
    // In every direction each part has the same share of what shows, so of the intensity, too.
    to -= body.point(u, v);
  } else if (isWide(place)) {
    const auto [faces, count] = body.facesTo(to);
    double whole = 0;
    std::array<double, 3> shown{};
    for (std::size_t k = 0; k < count; ++k) {
      shown[k] = faces[k].area * glm::dot(faces[k].normal, glm::normalize(to - faces[k].middle));
      whole += shown[k];
    }
    if (!(whole > 0)) return {};
    double begin = 0;
    std::size_t chosen = 0;
    while (chosen + 1 < count && u * whole >= begin + shown[chosen]) begin += shown[chosen++];
    const OpeningFace& face = faces[chosen];
    to -= face.point(std::clamp((u * whole - begin) / shown[chosen], 0.0, 1.0), v);
    const Vec3 along = glm::normalize(to);
    share *= glm::dot(face.normal, along) * face.area * whole / shown[chosen] / body.shown(along);
  }
  const double square = glm::dot(to, to);
  if (!(square > 0)) return {};
  const double distance = std::sqrt(square);
  return {-(to.x * x + to.y * y + to.z * z) / distance, distance,
          share * table.intensity(to) / square};
}

std::vector<std::string> PhotometricLight::remarks() const {
  if (file.empty()) return {};
  std::vector<std::string> all = file.table().remarks();
  for (std::string& remark : all) remark = fmt::format("{}: {}", file.name(), remark);
  return all;
}

void PhotometricLight::validate() const {
  if (file.empty()) throw InputError("ies: it has no file; give file=lamp.ies or file=lamp.ldt");
  if (up && !(glm::length(*up) > 0.999 && glm::length(*up) < 1.001)) {
    throw InputError("ies: up is not of unit length");
  }
  if (!isFinite(at) || (aim && !isFinite(*aim)) || (aim && *aim == at)) {
    throw InputError("ies: a lamp needs two finite places, other than each other: at and aim");
  }
}

}  // namespace radiosity
