// Pairs that are sampled from the same points, from their first cells to the tolerance.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "formfactor/exact/occluded/batch_visibility.h"
#include "formfactor/exact/occluded/cell_error.h"
#include "formfactor/exact/occluded/critical_line_quadrature.h"
#include "formfactor/exact/occluded/pair_sampling.h"

namespace radiosity {

/// The visible fraction of one pair.
struct VisibleFraction {
  double visible = 0;    ///< integral over the sampled part of the form factor to the visible part
  double whole = 0;      ///< of the form factor to all of the target
  double error2 = 0;     ///< sum of squares of the cells' stated errors, in the same unit
  double allowed = 0;    ///< error of the fraction that is accepted
  double change = 1;     ///< see SampledPair
  double far_error = 0;  ///< error of its kernel in the fraction of a half visible target
  bool near = false;     ///< the target is near: rules may agree and all be wrong
  bool may_cross = false;     ///< see SampledPair
  bool one_occluder = false;  ///< one alone comes between
  std::size_t points = 0;
  bool refined = false;    ///< by more than the first rule
  bool cut_short = false;  ///< kept with a larger error than accepted: it took too much
  double fraction() const { return whole > 0 ? visible / whole : 0; }
  double error() const;
};

/// Most work for a pair: points times the occluders looked past from each, a few tenths of a
/// second. Steps of shadows that no halving resolves would take hundreds of times that.
inline constexpr std::size_t kMostLooks = std::size_t(1) << 20;
/// Work of all pairs of a task that are evaluated again, some seconds. Later pairs get no more than
/// in single precision, and state the error left: of a large face under clutter, thousands of pairs
/// would take the most. There is no such bound if the tolerance asks for double precision, which
/// needs many points.
inline constexpr std::size_t kMostLooksOfAll = std::size_t(1) << 24;
/// Most work for a pair in single precision: others take fewer points between critical lines.
inline constexpr std::size_t kMostSingleLooks = std::size_t(1) << 12;

/// Root mean square of the error of a visible fraction by 2 x 2 points; `change`: SampledPair's.
double expectedError(double change);

/// Integrates groups of pairs by 2 x 2 points, if these are expected to do; otherwise, or if they
/// do not, by 3 x 3 points, then by 3 x 3 in each quarter of the cell, and so on; or, if many
/// points are expected, between critical lines. Holds scratch memory: one a thread.
template <class T>
class AdaptiveIntegrator {
 public:
  /// `far_reach`: targets this many radii away, or more, are far.
  /// `most_looks`: work after which pairs in double precision get no more than in single.
  /// `progress`, if given: integrate() throws Cancelled where it is cancelled.
  AdaptiveIntegrator(const ElementSet& elements, const ClipKernels<T>& kernels, double far_reach,
                     std::size_t most_looks, const Progress* progress = nullptr)
      : elements_(elements),
        far_reach_(far_reach),
        most_looks_(most_looks),
        progress_(progress),
        view_(kernels) {}

  /// `group`: pairs with one sampled element, which is cut by one plane or by none.
  /// fractions[k], of group[k], comes with `allowed` set.
  void integrate(std::span<const SampledPair> group, std::span<const Blocker> blockers,
                 std::span<VisibleFraction> fractions);

 private:
  /// Some members of the group, and the visible fraction about which the error of each is measured:
  /// that of the first rule. Empty: not known yet.
  struct Members {
    std::vector<Index> index;
    std::vector<double> fraction;
  };

  /// The result of one rule for one member in one cell.
  struct CellSum {
    double visible = 0;
    double whole = 0;
    double fraction = 0;     ///< that the error is measured about
    CellError error;         ///< times the cell's area
    bool uncertain = false;  ///< an edge of a shadow may have slipped between the points
  };

  void setTargets(std::span<const SampledPair> group, std::span<const Blocker> blockers);
  Members integrateCell(const SampleCell& cell, std::size_t side, int level, const Members& members,
                        std::span<VisibleFraction> out);
  void sumCell(const SampleCell& cell, std::size_t side, int level, const Members& members,
               std::span<VisibleFraction> out);
  static bool isStep(const VisibleFraction& sum, std::size_t side, double share);
  void lookOutside(const SampleCell& cell, std::size_t side, double share, const Members& members,
                   std::span<VisibleFraction> out);
  void cutCell(const SampleCell& cell, const Members& members, int level,
               std::span<VisibleFraction> out);

  void cutAtLines(std::span<const Vec3> polygon, Members& members, std::span<VisibleFraction> out);

  double distanceInRadii(const SampledPair& pair) const;
  bool isSpent(Index member, const VisibleFraction& so_far) const;
  std::size_t blockersOf(Index member) const {
    return std::max<std::size_t>(targets_[member].blockers.size(), 1);
  }

  const ElementSet& elements_;
  double far_reach_;
  std::size_t most_looks_;
  const Progress* progress_;
  BatchVisibility<T> view_;
  /// See cutAtLines().
  struct Unused {
    explicit Unused(const BatchVisibility<T>& /*view*/) {}
  };
  std::conditional_t<std::is_same_v<T, double>, CriticalLineQuadrature, Unused> between_lines_{
      view_};
  Vec3 normal_{0.0};
  bool far_ = false;       ///< the members at work are far
  std::size_t looks_ = 0;  ///< of all groups so far
  std::vector<GroupTarget> targets_;
  std::vector<const GroupTarget*> chosen_;
  std::vector<CellSum> sums_;     ///< by member
  std::vector<Index> uncertain_;  ///< members
};

extern template class AdaptiveIntegrator<float>;
extern template class AdaptiveIntegrator<double>;

}  // namespace radiosity
