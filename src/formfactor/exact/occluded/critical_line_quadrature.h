// Pairs whose sampled element is cut along the lines where what it sees has kinks.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "formfactor/exact/occluded/batch_visibility.h"
#include "formfactor/exact/occluded/cell_rule.h"
#include "formfactor/exact/occluded/critical_lines.h"

namespace radiosity {

struct VisibleFraction;

/// Integrates one pair over the parts between its critical lines. There the form factor to what is
/// seen is smooth, and Gauss points mostly have it right at once, where halving cells towards a
/// kink takes ten times the points for every digit. (Eight plates with obstacles, 64 patches each:
/// 20 points a pair from 1e-5 to 1e-7, for 1,700 at 1e-6.) Holds scratch memory: one a thread.
class CriticalLineQuadrature {
 public:
  static constexpr std::size_t kMostParts = 64;

  explicit CriticalLineQuadrature(BatchVisibility<double>& view) : view_(view) {}

  /// `polygon`: what of the sampled element, of unit normal `normal`, sees the target. Adds to
  /// `out`, whose `allowed` is set. False, and nothing is added: there are more parts than
  /// `most_parts` (up to kMostParts). `far`: see BatchVisibility.
  bool integrate(std::span<const Vec3> polygon, const Vec3& normal, const GroupTarget& target,
                 bool far, double coincidence, std::size_t most_parts, VisibleFraction& out);

 private:
  static constexpr std::size_t kPoints = 13;  ///< 2 x 2, then 3 x 3
  static constexpr std::size_t kCoarse = 4;   ///< of them the first
  /// A part and what it sees.
  struct Part {
    SampleCell cell;
    int halvings = 0;
    double area = 0;
    std::array<double, kPoints> visible;
    std::array<double, kPoints> whole;
    std::array<double, kPoints> weight;
    bool one_shape = true;
    bool overlap = false;  ///< of shadows on the target

    double integral(const std::array<double, kPoints>& values) const;
    double coarseIntegral(const std::array<double, kPoints>& values) const;
    double error(double fraction, bool near) const;
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
