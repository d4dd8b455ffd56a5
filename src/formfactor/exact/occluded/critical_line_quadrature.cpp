#include "formfactor/exact/occluded/critical_line_quadrature.h"

#include <algorithm>
#include <cmath>

#include "formfactor/exact/occluded/adaptive_integrator.h"

namespace radiosity {
namespace {

/// An end where an estimate does not fall.
constexpr int kMostHalvings = 10;

/// Of what the two rules differ by, the error of the better one, on a smooth part. They are of
/// order four and six in a part's size over the length on which values change; so where the
/// difference is a share d of the values, the error is sqrt(d) of the difference, about. (In the
/// closed Cornell box its root mean square over parts is one to two times this, of parts stated to
/// be off by 1e-6 to 1e-8 of the pair.) ...
constexpr double kOrder = 0.3;
/// ... but not less than the difference is of that between the first rule and a single point in the
/// middle: where a pole lies beside a part, rules gain the same factor with every order. ...
constexpr double kFactor = 1;
/// ... and at least: differences are small by chance, too; ... (A cube in a cube, 200 patches,
/// whose pairs are all alike, so that none makes up for another: the worst row at 1e-5 is off
/// by 2.7 times its figure; with kOrder alone and a kLeast of .02, by 5.2 times.)
constexpr double kLeast = 0.05;
/// ... where shapes differ, mostly because an edge of a shadow touches a corner of the target all
/// along, and is here or there by rounding; or where the target is so near that the form factor
/// itself changes much along the part, and two rules may agree and both be wrong; ...
constexpr double kLeastDoubtful = 0.1;
/// ... and where shadows overlap: edges of two may cross on an edge of the target, along a curve,
/// and of a kink rules of few points miss as much as they see.
constexpr double kOverlap = 1;

/// Of what decides about halving, what is stated: parts that pass are mostly better.
constexpr double kStated = 0.27;

/// The point in the middle, among a part's, and its weight in the rule of 3 x 3.
constexpr std::size_t kMiddle = 8;
constexpr double kMiddleWeight = 64.0 / 324;

}  // namespace

double CriticalLineQuadrature::Part::integral(const std::array<double, kPoints>& values) const {
  double sum = 0;
  for (std::size_t q = kCoarse; q < kPoints; ++q) sum += weight[q] * values[q];
  return sum;
}

double CriticalLineQuadrature::Part::coarseIntegral(
    const std::array<double, kPoints>& values) const {
  double sum = 0;
  for (std::size_t q = 0; q < kCoarse; ++q) sum += weight[q] * values[q];
  return sum;
}

/// Of the integral of visible minus `fraction` times whole form factor.
double CriticalLineQuadrature::Part::error(double fraction, bool near) const {
  std::array<double, kPoints> residual;
  double largest = 0;
  for (std::size_t q = 0; q < kPoints; ++q) {
    residual[q] = visible[q] - fraction * whole[q];
    largest = std::max(largest, std::abs(residual[q]));
  }
  if (!(largest > 0)) return 0;
  const double fine = integral(residual);
  const double coarse = coarseIntegral(residual);
  const double difference = std::abs(fine - coarse);
  if (overlap) return kOverlap * difference;
  if (!(difference > 0)) return 0;
  const double middle = residual[kMiddle] * weight[kMiddle] / kMiddleWeight;
  const double before = std::max(std::abs(coarse - middle), difference);
  const double share =
      std::max(kFactor * difference / before, kOrder * std::sqrt(difference / (largest * area)));
  return difference * std::clamp(share, one_shape && !near ? kLeast : kLeastDoubtful, 1.0);
}

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

/// Around a foot what is seen changes with the direction from it and hardly with the distance.
/// Where the foot is the corner to which a side of the square shrinks, these are the square's two
/// axes, and the integrand is smooth (Duffy 1982). `c` is a foot.
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
  for (std::size_t q = 0; q < kPoints; ++q) {
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
  out.points += kPoints * parts_.size();
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
      out.points += kPoints * (parts_.size() - before);
      continue;
    }
    out.visible += part.integral(part.visible);
    out.whole += part_whole;
    out.error2 += kStated * kStated * error * error;
  }
  return true;
}

}  // namespace radiosity
