#include "formfactor/rays/ray_origins.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/geometry/plane_frame.h"

namespace radiosity {

namespace {

constexpr float kBelowOne = 1 - 0x1p-24F;

RayFrame frameAround(const Vec3& normal) {
  const Vec3 x = glm::normalize(glm::cross(axisAcross(normal), normal));
  return {glm::vec3(x), glm::vec3(glm::cross(normal, x)), glm::vec3(normal), 0.0F, 1.0F};
}

}  // namespace

RayOrigins::RayOrigins(const PatchMesh& mesh, std::size_t patch, double scale, const Vec3& middle)
    : polygon_(mesh.polygon[patch]) {
  if (polygon_ == kNone || !(mesh.area[patch] > 0)) return;
  frame_ = frameAround(mesh.normal[patch]);
  addParts(mesh, patch, scale, middle);
  if (parts_.empty()) return;
  const double sum = end_.back();
  double begin = 0;
  for (double& end : end_) {
    end /= sum;
    first_.push_back(float(begin));
    stretch_.push_back(float(1 / std::max(end - begin, 1e-30)));
    begin = end;
  }
  std::uint32_t part = 0;
  for (std::size_t step = 0; step < parts_.size(); ++step) {
    while (part + 1 < parts_.size() && end_[part] <= double(step) / double(parts_.size())) ++part;
    part_of_step_.push_back(part);
  }
}

void RayOrigins::addParts(const PatchMesh& mesh, std::size_t patch, double scale,
                          const Vec3& middle) {
  const auto vertex = [&](Index v) { return mesh.vertices[v] * scale - middle; };
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c, bool parallelogram) {
    const double area = glm::length(glm::cross(b - a, c - a)) * (parallelogram ? 2 : 1);
    if (!(area > 0)) return;
    parts_.push_back({glm::vec3(a), glm::vec3(b - a), glm::vec3(c - a), parallelogram ? 1u : 0u});
    end_.push_back((end_.empty() ? 0.0 : end_.back()) + area);
  };
  const auto outline = mesh.outline(patch);
  if (outline.size() == 4) {
    const Vec3 a = vertex(outline[0]);
    const Vec3 b = vertex(outline[1]);
    const Vec3 c = vertex(outline[2]);
    const Vec3 d = vertex(outline[3]);
    // To single precision, which is all the rays have.
    if (glm::length(a - b + c - d) <= 1e-7 * glm::length(c - a)) {
      add(a, b, d, true);
      return;
    }
  }
  for (std::size_t t = mesh.piece_offset[patch]; t < mesh.piece_offset[patch + 1]; ++t) {
    const auto& [a, b, c] = mesh.pieces[t];
    add(vertex(a), vertex(b), vertex(c), false);
  }
}

std::uint32_t RayOrigins::partAt(float x, float& within) const {
  if (parts_.size() == 1) {
    within = x;
    return 0;
  }
  std::uint32_t k = part_of_step_[std::size_t(double(x) * double(parts_.size()))];
  while (k + 1 < parts_.size() && end_[k] <= double(x)) ++k;
  within = std::clamp((x - first_[k]) * stretch_[k], 0.0F, kBelowOne);
  return k;
}

std::vector<Vec3> RayOrigins::corners() const {
  std::vector<Vec3> corners;
  for (const Part& part : parts_) {
    const Vec3 corner(part.corner);
    const Vec3 ab(part.ab);
    const Vec3 ac(part.ac);
    corners.insert(corners.end(), {corner, corner + ab, corner + ac});
    if (part.parallelogram != 0) corners.push_back(corner + ab + ac);
  }
  return corners;
}

double RayOrigins::aim(const DirectionWindow& window) {
  is_aimed_ = true;
  range_ = float(window.high - window.low);
  half_turn_ = float(window.half);
  const double low = std::clamp(window.low, 0.0, 1.0 - double(range_));
  frame_.low = float(low);
  frame_.across = float(1 - low);
  const Vec3 x(frame_.x);
  const Vec3 y(frame_.y);
  const double cosine = std::cos(window.centre);
  const double sine = std::sin(window.centre);
  frame_.x = glm::vec3(cosine * x + sine * y);
  frame_.y = glm::vec3(cosine * y - sine * x);
  return double(range_) * double(half_turn_) / std::numbers::pi;
}

}  // namespace radiosity
