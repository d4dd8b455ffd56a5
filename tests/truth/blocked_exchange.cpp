#include "blocked_exchange.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "clipped_view.h"
#include "contour.h"
#include "critical_lines.h"
#include "gauss.h"

namespace radiosity::truth {
namespace {

constexpr int kCoarse = 4;
constexpr int kFine = 6;
constexpr std::size_t kMostCells = 400;
/// What 4 x 4 looks alike may have missed, as a part of the whole: a strip between two of them.
/// Each halving that changes nothing takes as much off again.
constexpr double kDoubt = 1.0 / 16;

using Triangle = std::array<Vec3, 3>;

struct Estimate {
  Triangle triangle;
  double blocked = 0;
  double error = 0;
  bool clear = true;
  bool hidden = true;
  int doubts = 0;  ///< halvings in a row that looked clear, or hidden, without proof
  bool operator<(const Estimate& other) const { return error < other.error; }
};

double areaOf(const Triangle& t) { return 0.5 * glm::length(glm::cross(t[1] - t[0], t[2] - t[0])); }

/// The triangle as a square collapsed in its first corner.
double gauss(const ClippedView& view, int order, Estimate& e) {
  double sum = 0;
  for (const GaussPoint& s : gaussRule(order)) {
    for (const GaussPoint& t : gaussRule(order)) {
      const Vec3 across = e.triangle[1] + (e.triangle[2] - e.triangle[1]) * double(t.x);
      const Glimpse seen = view.from(e.triangle[0] + (across - e.triangle[0]) * double(s.x));
      sum += double(2 * s.x * s.weight * t.weight) * seen.blocked;
      e.clear = e.clear && seen.clear;
      e.hidden = e.hidden && seen.hidden;
    }
  }
  return sum * areaOf(e.triangle);
}

class Integral {
 public:
  Integral(const Sheet& source, const Sheet& target, const std::vector<const Blocker*>& blockers,
           double coincidence)
      : source_(source), target_(target), blockers_(blockers), coincidence_(coincidence) {}

  /// `doubts`: of the triangle that this one is a half of.
  void add(const Triangle& triangle, int doubts = 0) {
    Estimate e;
    e.triangle = triangle;
    const Sheet cell(Loop(std::span<const Vec3>(triangle)), source_);
    const Shaft shaft(cell, target_, coincidence_);
    const std::vector<const Blocker*> near = blockersIn(shaft);
    if (near.empty()) {
      e.hidden = false;
    } else {
      const ClippedView view(source_, target_.loop, near);
      const double coarse = gauss(view, kCoarse, e);
      points_ += kCoarse * kCoarse;
      if (!e.clear && !e.hidden) {
        e.blocked = gauss(view, kFine, e);
        e.error = std::abs(e.blocked - coarse);
        points_ += kFine * kFine;
      }
      if (e.clear || e.hidden) {
        const double whole = facingExchange(cell.loop, target_.loop);
        // Where everything is hidden no rule is needed, and none is trusted next to the target.
        if (e.hidden) e.blocked = whole;
        if (!isProven(e, cell, shaft, near)) {
          e.doubts = doubts + 1;
          e.error = whole * std::pow(kDoubt, e.doubts);
        }
      }
    }
    blocked_ += e.blocked;
    error_ += e.error;
    clear_ = clear_ && e.clear;
    hidden_ = hidden_ && e.hidden;
    queue_.push(e);
  }

  /// Halves the triangle with the largest difference across its longest edge.
  void refineWorst() {
    const Estimate worst = queue_.top();
    queue_.pop();
    blocked_ -= worst.blocked;
    error_ -= worst.error;
    halve(worst);
  }

  /// Halves all triangles longer than `size`, whatever their differences.
  static void subdivide(const Triangle& t, double size, std::vector<Triangle>& out) {
    const std::size_t k = longest(t);
    if (glm::distance(t[k], t[(k + 1) % 3]) <= size) {
      out.push_back(t);
      return;
    }
    const auto [left, right] = halves(t, k);
    subdivide(left, size, out);
    subdivide(right, size, out);
  }

  BlockedExchange result() const {
    return {blocked_, std::max(error_, 0.0), points_, clear_, hidden_};
  }
  double error() const { return error_; }
  std::size_t points() const { return points_; }
  bool clear() const { return clear_; }
  bool hidden() const { return hidden_; }

 private:
  static std::size_t longest(const Triangle& t) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (glm::distance(t[k], t[(k + 1) % 3]) > glm::distance(t[best], t[(best + 1) % 3])) best = k;
    }
    return best;
  }
  static std::pair<Triangle, Triangle> halves(const Triangle& t, std::size_t k) {
    const Vec3 middle = 0.5 * (t[k] + t[(k + 1) % 3]);
    const Vec3& apex = t[(k + 2) % 3];
    return {Triangle{apex, t[k], middle}, Triangle{apex, middle, t[(k + 1) % 3]}};
  }
  void halve(const Estimate& e) {
    const auto [left, right] = halves(e.triangle, longest(e.triangle));
    add(left, e.doubts);
    add(right, e.doubts);
  }

  /// Whether looks that all were clear, or all hidden, are so from the whole triangle.
  bool isProven(const Estimate& e, const Sheet& cell, const Shaft& shaft,
                const std::vector<const Blocker*>& near) const {
    if (e.hidden) return hiddenByOne(cell, target_, near);
    return std::none_of(near.begin(), near.end(),
                        [&](const Blocker* blocker) { return shaft.blocks(*blocker); });
  }

  /// Those of the pair's blockers that may come between a triangle and the target.
  std::vector<const Blocker*> blockersIn(const Shaft& shaft) const {
    std::vector<const Blocker*> near;
    std::copy_if(blockers_.begin(), blockers_.end(), std::back_inserter(near),
                 [&](const Blocker* blocker) { return shaft.mayBlock(*blocker); });
    return near;
  }

  const Sheet& source_;
  const Sheet& target_;
  const std::vector<const Blocker*>& blockers_;
  double coincidence_;
  std::priority_queue<Estimate> queue_;
  double blocked_ = 0;
  double error_ = 0;
  std::size_t points_ = 0;
  bool clear_ = true;
  bool hidden_ = true;
};

Loop inFront(const Loop& loop, const Sheet& of) {
  Loop front;
  const double slack = 1e-14 * reach(loop, of.middle);
  split(loop, of.normal, of.offset, slack, &front, static_cast<Loop*>(nullptr));
  return front;
}

bool manyBodies(const std::vector<const Blocker*>& blockers) {
  return std::any_of(blockers.begin(), blockers.end(),
                     [&](const Blocker* b) { return b->body != blockers[0]->body; });
}

}  // namespace

BlockedExchange blockedExchange(const Sheet& source, const Sheet& target,
                                const std::vector<const Blocker*>& blockers, double coincidence,
                                double tolerance, std::size_t most_points) {
  const Loop front = inFront(source.loop, target);
  const Loop visible = inFront(target.loop, source);
  if (front.empty() || visible.empty() || blockers.empty()) return {0, 0, 0, true, false};
  const Sheet seen(visible, target);
  const std::vector<Segment> segments = criticalSegments(source, visible, blockers);
  const std::vector<Loop> cells = cutIntoCells(source, front, segments, kMostCells);
  // Where edges of two bodies cross before the target the critical lines are curves, which no cut
  // follows: such pairs start from cells small enough for the rules to notice.
  const double size = manyBodies(blockers) ? 0.75 * source.radius : 4 * source.radius;
  std::vector<Triangle> triangles;
  for (const Loop& cell : cells) {
    for (std::size_t k = 1; k + 1 < cell.size(); ++k) {
      Integral::subdivide({cell[0], cell[k], cell[k + 1]}, size, triangles);
    }
  }
  Integral integral(source, seen, blockers, coincidence);
  for (const Triangle& triangle : triangles) integral.add(triangle);
  while (integral.error() > tolerance && integral.points() < most_points) integral.refineWorst();
  return integral.result();
}

bool hiddenByOne(const Sheet& a, const Sheet& b, const std::vector<const Blocker*>& blockers) {
  const auto hides = [&](const Blocker* blocker) {
    for (const Vec3& eye : a.loop) {
      const double height = glm::dot(blocker->normal, eye) - blocker->offset;
      if (height == 0) return false;
      const double side = height > 0 ? 1 : -1;
      for (const Vec3& p : b.loop) {
        if (!(side * (glm::dot(blocker->normal, p) - blocker->offset) < 0)) return false;
        for (std::size_t k = 0; k < blocker->loop.size(); ++k) {
          const Vec3 normal = glm::cross(blocker->loop[k] - eye, blocker->loop.next(k) - eye);
          if (!(side * glm::dot(normal, p - eye) <= 0)) return false;
        }
      }
    }
    return true;
  };
  return std::any_of(blockers.begin(), blockers.end(), hides);
}

}  // namespace radiosity::truth
