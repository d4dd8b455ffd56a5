#include "formfactor/rays/ray_origins.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/geometry/plane_frame.h"

namespace radiosity {

namespace {

constexpr float kBelowOne = 1 - 0x1p-24F;

/// `across`: a direction off every normal, if possible, and the same for all patches of an unknown,
/// so that frames of patches that bend a little turn a little.
RayFrame frameAround(const Vec3& normal, Vec3 across) {
  constexpr double kParallel = 0.1;
  if (glm::length(glm::cross(across, normal)) < kParallel) across = axisAcross(normal);
  const Vec3 x = glm::normalize(glm::cross(across, normal));
  return {glm::vec3(x), glm::vec3(glm::cross(normal, x)), glm::vec3(normal), 0.0F, 1.0F};
}

}  // namespace

RayOrigins::RayOrigins(const PatchMesh& mesh, std::span<const Index> patches, double scale,
                       const Vec3& middle) {
  for (const Index patch : patches) addPatch(mesh, patch, scale, middle);
  if (parts_.empty()) return;
  const double sum = end_.back();
  size_ = std::sqrt(0.5 * sum);  // parts count twice their area
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

void RayOrigins::addPatch(const PatchMesh& mesh, std::size_t patch, double scale,
                          const Vec3& middle) {
  if (mesh.polygon[patch] == kNone || !(mesh.area[patch] > 0)) return;
  const auto vertex = [&](Index v) { return mesh.vertices[v] * scale - middle; };
  const Vec3 across = parts_.empty() ? axisAcross(mesh.normal[patch]) : Vec3(frames_[0].y);
  const RayFrame frame = frameAround(mesh.normal[patch], across);
  if (frames_.empty() || frames_.back().z != frame.z) frames_.push_back(frame);
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c, bool parallelogram) {
    const double area = glm::length(glm::cross(b - a, c - a)) * (parallelogram ? 2 : 1);
    if (!(area > 0)) return;
    parts_.push_back({glm::vec3(a), glm::vec3(b - a), glm::vec3(c - a),
                      std::uint32_t(frames_.size() - 1), mesh.polygon[patch],
                      parallelogram ? 1u : 0u});
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

void RayOrigins::addCorners(std::uint32_t k, std::vector<Vec3>& corners) const {
  const Part& part = parts_[k];
  const Vec3 corner(part.corner);
  const Vec3 ab(part.ab);
  const Vec3 ac(part.ac);
  corners.insert(corners.end(), {corner, corner + ab, corner + ac});
  if (part.parallelogram != 0) corners.push_back(corner + ab + ac);
}

double RayOrigins::aim(std::span<const DirectionWindow> windows) {
  double range = 0;
  double half_turn = 0;
  for (const DirectionWindow& window : windows) {
    range = std::max(range, window.high - window.low);
    half_turn = std::max(half_turn, window.half);
  }
  is_aimed_ = true;
  range_ = float(range);
  half_turn_ = float(half_turn);
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    const double low = std::clamp(windows[k].low, 0.0, 1.0 - double(range_));
    RayFrame& frame = frames_[k];
    frame.low = float(low);
    frame.across = float(1 - low);
    const Vec3 x(frame.x);
    const Vec3 y(frame.y);
    const double cosine = std::cos(windows[k].centre);
    const double sine = std::sin(windows[k].centre);
    frame.x = glm::vec3(cosine * x + sine * y);
    frame.y = glm::vec3(cosine * y - sine * x);
  }
  return double(range_) * double(half_turn_) / std::numbers::pi;
}

}  // namespace radiosity
