#include "formfactor/exact/occluded/critical_line_quadrature.h"

#include <algorithm>
#include <cmath>

#include "formfactor/exact/error_model.h"
#include "formfactor/exact/occluded/adaptive_integrator.h"

namespace radiosity {
namespace {

/// The most halvings of a part: an end if an estimate does not fall.
constexpr int kMostHalvings = 10;

}  // namespace

void CriticalLineQuadrature::addPart(const CriticalLines::Part& part) {
  const std::size_t n = part.size();
  const auto foot = std::find_if(part.begin(), part.end(),
                                 [&](const Vec2& corner) { return lines_.isFoot(corner); });
  if (foot != part.end()) {
    const auto first = std::size_t(foot - part.begin());
    for (std::size_t k = 1; k + 1 < n; ++k) {
      addTriangle(part[(first + k) % n], part[(first + k + 1) % n], *foot);
    }
    return;
  }
  const auto corner = [&](std::size_t k) { return lines_.lift(part[std::min(k, n - 1)]); };
  for (std::size_t k = 1; k + 1 < n; k += 2) {
    add({{corner(0), corner(k), corner(k + 1), corner(k + 2)}}, 0);
  }
}

/// Around a foot the view changes with the direction from it and hardly with the distance. If the
/// foot is the corner to which a side of the square shrinks, these are the square's two axes, and
/// the integrand is smooth (Duffy 1982). `c` is a foot.
void CriticalLineQuadrature::addTriangle(const Vec2& a, const Vec2& b, const Vec2& c) {
  for (const bool first : {true, false}) {
    const Vec2& other = first ? a : b;
    const Vec2 middle = 0.5 * (other + c);
    if (!lines_.isFoot(other) || lines_.isFoot(middle)) continue;
    // One triangle a foot.
    addTriangle(first ? middle : a, first ? b : middle, c);
    addTriangle(first ? b : middle, first ? middle : a, other);
    return;
  }
  const Vec3 apex = lines_.lift(c);
  add({{lines_.lift(a), lines_.lift(b), apex, apex}}, 0);
}

void CriticalLineQuadrature::add(const SampleCell& cell, int halvings) {
  Part part;
  part.area = cell.area();
  if (!(part.area > 0)) return;
  part.cell = cell;
  part.halvings = halvings;
  SamplePoints points = cell.points(2);
  const SamplePoints more = cell.points(3);
  for (const SamplePoint& p : more.all()) points.point[points.count++] = p;
  view_.look(points.all(), cell.middle(), normal_, std::span(&target_, 1), far_);
  for (std::size_t q = 0; q < PartValues::kPoints; ++q) {
    part.weight[q] = points.point[q].weight;
    part.visible[q] = view_.visible(q)[0];
    part.whole[q] = view_.whole(q)[0];
    part.one_shape &= view_.shape(q)[0] == view_.shape(0)[0];
    part.overlap |= view_.overlapping(q, 0);
  }
  parts_.push_back(part);
}

bool CriticalLineQuadrature::integrate(std::span<const Vec3> polygon, const Vec3& normal,
                                       const GroupTarget& target, bool far, double coincidence,
                                       std::size_t most_parts, VisibleFraction& out) {
  const auto outline = std::span(target.corners).first(target.corner_count);
  if (!lines_.cut(polygon, normal, outline, target.blockers, coincidence, most_parts)) return false;
  target_ = &target;
  normal_ = normal;
  far_ = far;
  parts_.clear();
  for (const CriticalLines::Part& part : lines_.parts()) addPart(part);
  out.refined = true;
  out.points += PartValues::kPoints * parts_.size();
  double visible = 0;
  double whole = 0;
  for (const Part& part : parts_) {
    visible += part.integral(part.visible);
    whole += part.integral(part.whole);
  }
  const double fraction = whole > 0 ? visible / whole : 0;
  const std::size_t most_points = kMostLooks / std::max<std::size_t>(target.blockers.size(), 1);
  while (!parts_.empty()) {
    const Part part = parts_.back();
    parts_.pop_back();
    const double part_whole = part.integral(part.whole);
    const double error = part.error(fraction, out.near);
    // Squares of errors add up: each part may have its share of the square.
    const bool too_large = error > out.allowed * std::sqrt(std::max(whole * part_whole, 0.0));
    const bool spent = part.halvings >= kMostHalvings || out.points > most_points;
    out.cut_short = out.cut_short || (too_large && spent);
    if (too_large && !spent) {
      const std::size_t before = parts_.size();
      for (std::size_t c = 0; c < 4; ++c) add(part.cell.child(c), part.halvings + 1);
      out.points += PartValues::kPoints * (parts_.size() - before);
      continue;
    }
    out.visible += part.integral(part.visible);
    out.whole += part_whole;
    out.error2 += kPartStated * kPartStated * error * error;
  }
  return true;
}

}  // namespace radiosity
