// Pairs whose sampled element is cut along the lines where its view has kinks.
#pragma once

#include <span>
#include <vector>

#include "formfactor/exact/occluded/batch_visibility.h"
#include "formfactor/exact/occluded/cell_rule.h"
#include "formfactor/exact/occluded/critical_lines.h"
#include "formfactor/exact/occluded/part_error.h"

namespace radiosity {

struct VisibleFraction;

/// Integrates one pair over the parts between its critical lines. There the form factor to the
/// visible part is smooth, and Gauss points mostly have it right at once, where halving cells
/// towards a kink takes ten times the points for every digit. (Eight plates with obstacles, 64
/// patches each: 20 points a pair from 1e-5 to 1e-7, for 1,700 at 1e-6.) Holds scratch memory: one
/// a thread.
class CriticalLineQuadrature {
 public:
  static constexpr std::size_t kMostParts = 64;

  explicit CriticalLineQuadrature(BatchVisibility<double>& view) : view_(view) {}

  /// `polygon`: the part of the sampled element, of unit normal `normal`, that sees the target.
  /// Adds to `out`, whose `allowed` is set. Returns false, with nothing added, if there are more
  /// parts than `most_parts` (up to kMostParts). `far`: see BatchVisibility.
  bool integrate(std::span<const Vec3> polygon, const Vec3& normal, const GroupTarget& target,
                 bool far, double coincidence, std::size_t most_parts, VisibleFraction& out);

 private:
  /// A part and its view.
  struct Part : PartValues {
    SampleCell cell;
    int halvings = 0;
  };
  void addPart(const CriticalLines::Part& part);
  void addTriangle(const Vec2& a, const Vec2& b, const Vec2& c);
  void add(const SampleCell& cell, int halvings);

  BatchVisibility<double>& view_;
  CriticalLines lines_;
  const GroupTarget* target_ = nullptr;
  Vec3 normal_{0.0};
  bool far_ = false;
  std::vector<Part> parts_;
};

}  // namespace radiosity
