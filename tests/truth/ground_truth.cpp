#include "ground_truth.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "blocked_exchange.h"
#include "contour.h"

namespace radiosity::truth {
namespace {

std::vector<Vec3> aboutTheMiddle(const std::vector<Vec3>& vertices) {
  if (vertices.empty()) return {};
  Vec3 low = vertices[0];
  Vec3 high = vertices[0];
  for (const Vec3& v : vertices) {
    low = glm::min(low, v);
    high = glm::max(high, v);
  }
  std::vector<Vec3> moved;
  moved.reserve(vertices.size());
  for (const Vec3& v : vertices) moved.push_back(v - 0.5 * (low + high));
  return moved;
}

double diagonal(const std::vector<Vec3>& about_the_middle) {
  Vec3 most(0.0);
  for (const Vec3& v : about_the_middle) most = glm::max(most, glm::abs(v));
  return 2 * glm::length(most);
}

bool isConvex(const Loop& loop) {
  const Vec3 normal = vectorArea(loop);
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec3& b = loop.next(k);
    const Vec3& c = loop.next(k + 1 == loop.size() ? 0 : k + 1);
    if (!(glm::dot(glm::cross(b - loop[k], c - b), normal) > 0)) return false;
  }
  return true;
}

/// A patch as convex parts: itself where it is a triangle or a convex quadrilateral, else its
/// triangles. Degenerate patches have none.
std::vector<Sheet> partsOf(const PatchMesh& mesh, std::size_t i, const std::vector<Vec3>& points) {
  std::vector<Sheet> parts;
  if (!(mesh.area[i] > 0)) return parts;
  if (const auto outline = mesh.outline(i); outline.size() <= 4) {
    Loop loop;
    for (const Index v : outline) loop.push(points[v]);
    if (isConvex(loop)) return {Sheet(loop)};
  }
  for (std::size_t k = mesh.piece_offset[i]; k < mesh.piece_offset[i + 1]; ++k) {
    Loop loop;
    for (const Index v : mesh.pieces[k]) loop.push(points[v]);
    if (glm::length(vectorArea(loop)) > 0) parts.emplace_back(loop);
  }
  return parts;
}

double distanceToSegment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double square = glm::dot(along, along);
  const double t = square > 0 ? std::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0.0;
  return glm::distance(p, a + along * t);
}

double distanceTo(const Blocker& blocker, const Vec3& p) {
  bool inside = true;
  double rim = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < blocker.loop.size(); ++k) {
    const Vec3& a = blocker.loop[k];
    const Vec3& b = blocker.loop.next(k);
    inside = inside && glm::dot(glm::cross(blocker.normal, b - a), p - a) >= 0;
    rim = std::min(rim, distanceToSegment(p, a, b));
  }
  return inside ? std::abs(glm::dot(blocker.normal, p) - blocker.offset) : rim;
}

/// How far the nearest blocker is from the sheet's middle, in sizes of the sheet.
double clearance(const Sheet& sheet, const std::vector<const Blocker*>& blockers) {
  double nearest = std::numeric_limits<double>::max();
  for (const Blocker* blocker : blockers) {
    nearest = std::min(nearest, distanceTo(*blocker, sheet.middle));
  }
  return nearest / sheet.radius;
}

}  // namespace

GroundTruth::GroundTruth(const PatchMesh& mesh, const TruthOptions& options)
    : mesh_(mesh),
      options_(options),
      vertices_(aboutTheMiddle(mesh.vertices)),
      coincidence_(1e-7 * diagonal(vertices_)),
      blockers_(mesh, vertices_, coincidence_) {
  sheets_.reserve(mesh.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) sheets_.push_back(partsOf(mesh, i, vertices_));
}

GroundTruth::Exchange GroundTruth::exchange(const Sheet& a, const Sheet& b,
                                            double tolerance) const {
  Exchange out;
  const auto facing = [](const Sheet& from, const Sheet& to) {
    return std::any_of(to.loop.begin(), to.loop.end(),
                       [&](const Vec3& p) { return glm::dot(from.normal, p) > from.offset; });
  };
  if (!facing(a, b) || !facing(b, a)) return out;
  const std::vector<const Blocker*> blockers = blockers_.inside(Shaft(a, b, coincidence_));
  if (hiddenByOne(a, b, blockers)) {
    out.hidden = true;
    return out;
  }
  out.value = unoccludedExchange(a.loop, b.loop);
  if (blockers.empty() || out.value == 0) return out;
  const bool from_a = clearance(a, blockers) >= clearance(b, blockers);
  const BlockedExchange blocked = blockedExchange(from_a ? a : b, from_a ? b : a, blockers,
                                                  coincidence_, tolerance, options_.most_points);
  out.points = blocked.points;
  out.hidden = blocked.hidden;
  out.occluded = !blocked.clear && !blocked.hidden;
  out.error = blocked.error;
  out.unfinished = blocked.error > tolerance;
  if (blocked.hidden) {
    out.value = 0;
  } else {
    out.value -= blocked.blocked;
    if (out.value < -10 * std::max(tolerance, blocked.error)) {
      throw std::logic_error("ground truth: more blocked than there is, by " +
                             std::to_string(-out.value));
    }
    out.value = std::max(out.value, 0.0);
  }
  return out;
}

void GroundTruth::addPair(std::size_t i, std::size_t j, TruthRow& row) const {
  const std::size_t parts = sheets_[i].size() * sheets_[j].size();
  if (parts == 0 || (mesh_.polygon[i] == mesh_.polygon[j])) return;
  const double area = mesh_.area[i];
  const double tolerance = options_.accuracy * area / double(mesh_.size() * parts);
  Exchange all;
  for (const Sheet& a : sheets_[i]) {
    for (const Sheet& b : sheets_[j]) {
      const Exchange one = exchange(a, b, tolerance);
      all.value += one.value;
      all.error += one.error;
      row.points += one.points;
      all.occluded = all.occluded || one.occluded;
      all.hidden = all.hidden || one.hidden;
      all.unfinished = all.unfinished || one.unfinished;
    }
  }
  row.form_factors[j] = all.value / area;
  row.largest_error = std::max(row.largest_error, all.error / area);
  row.occluded += all.occluded || (all.hidden && all.value > 0);
  row.hidden += all.hidden && all.value == 0;
  row.unfinished += all.unfinished;
}

TruthRow GroundTruth::row(std::size_t i) const {
  TruthRow row;
  row.form_factors.assign(mesh_.size(), 0.0);
  for (std::size_t j = 0; j < mesh_.size(); ++j) addPair(i, j, row);
  return row;
}

double GroundTruth::formFactor(std::size_t i, std::size_t j) const {
  TruthRow row;
  row.form_factors.assign(mesh_.size(), 0.0);
  addPair(i, j, row);
  return row.form_factors[j];
}

std::vector<double> truthRow(const PatchMesh& mesh, std::size_t i, const TruthOptions& options) {
  return GroundTruth(mesh, options).row(i).form_factors;
}

}  // namespace radiosity::truth
