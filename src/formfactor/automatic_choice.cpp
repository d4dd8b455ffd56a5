#include "formfactor/automatic_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/figure_text.h"
#include "base/parallel.h"
#include "base/processor_clock.h"
#include "base/timed_progress.h"
#include "formfactor/rays/ray_model.h"
#include "radiosity/spelling.h"

namespace radiosity {
namespace {

/// Without a tolerance, exact, which then is far more accurate than rays, may take this many times
/// their seconds, or this many seconds.
constexpr double kTimesForAccuracy = 2;
constexpr double kSecondsForAccuracy = 5;

/// A sample of rows may miss the few pairs whose shadows take nearly all of the time (an engraved
/// plate of 2,684 faces: .8 s foreseen, 50 s needed): exact is given up where it takes this much
/// longer than was foreseen.
constexpr double kOverrunTimes = 3;
constexpr double kOverrunSeconds = 3;

/// A plan of exact samples its rows. It may take this share of the seconds that the work may take,
/// so that it stays small beside it, and as long as kFirstSeconds the first time, then
/// kSecondSeconds. If exact is foreseen to take no more than kShortSeconds, rays are not planned.
constexpr double kPlanShare = 0.02;
constexpr double kFirstSeconds = 0.15;
constexpr double kSecondSeconds = 0.3;
constexpr double kShortSeconds = 0.5;
/// What could not be prepared at first would hardly be sampled the second time in less than this.
constexpr double kUnpreparedSeconds = 1;

/// From so many patches on the pairs that rays find take gigabytes, and say no more of the light:
/// rows that are cut take their place, but for a tolerance below this, which asks for more rays
/// than these have.
constexpr std::size_t kManyPatches = 20'000;
/// Of fewer patches, where pairs take more rays than these, and so many times those of cuts.
/// Counts of rays are the same on any machine.
constexpr double kManyRays = 3e7;
constexpr double kTimesForPairs = 3;
constexpr double kFinestCut = 5e-3;

std::string secondsText(double seconds) {
  if (seconds < 0.1) return "less than 0.1 s";
  if (seconds < 10) return fmt::format("about {:.2g} s", seconds);
  return fmt::format("about {} s", countText(std::size_t(std::llround(seconds))));
}

/// The seconds that exact may take and still be chosen.
double secondsExactMayTake(const FormFactorOptions& options, double other_seconds) {
  if (options.tolerance) return other_seconds;
  return std::max(kTimesForAccuracy * other_seconds, kSecondsForAccuracy);
}

Chosen planned(FormFactorMethod method, const PatchMesh& mesh, const FormFactorOptions& options,
               Progress& progress) {
  Chosen chosen{prepareMethod(method, mesh, options), {}};
  chosen.plan = chosen.method->plan(progress);
  return chosen;
}

/// Of a method that casts rays, once it is planned.
double foreseenRays(const PreparedMethod& method) {
  return method.roomForExactRows().value_or(RoomForExactRows()).work / kExactWorkARay;
}

/// Nothing if planning takes longer than `seconds`.
std::optional<FormFactorPlan> planInTime(PreparedMethod& method, double seconds,
                                         Progress& progress) {
  TimedProgress timed(progress, seconds);
  try {
    return method.plan(timed);
  } catch (const Cancelled&) {
    timed.giveUp();
    return std::nullopt;
  }
}

std::string exactReason(const FormFactorPlan& exact, const FormFactorPlan& other, bool smaller) {
  return fmt::format("it takes {}; {}, to {:.2g}, would take {}{}", secondsText(exact.seconds),
                     traitsOf(other.method).word, other.tolerance, secondsText(other.seconds),
                     smaller ? " and " + bytesText(other.bytes) : "");
}

/// `exact`: nothing if its plan took too long.
std::string otherReason(const std::optional<FormFactorPlan>& exact, bool fits,
                        const FormFactorPlan& other) {
  const std::string text =
      fmt::format("to {:.2g} {} {}; exact would take ", other.tolerance,
                  other.method == FormFactorMethod::rays ? "they take" : "it takes",
                  secondsText(other.seconds));
  if (!exact) return text + "longer, as far as it was looked at";
  return fmt::format("{}{} and {}{}", text, secondsText(exact->seconds), bytesText(exact->bytes),
                     fits ? "" : ", more than " + spelled("memory_limit"));
}

}  // namespace

Chosen planBesideExact(const PatchMesh& mesh, const FormFactorOptions& options,
                       Progress& progress) {
  const bool may_cut =
      !options.needs_pairs && options.toleranceOf(FormFactorMethod::cut) >= kFinestCut;
  if (may_cut && mesh.size() >= kManyPatches) {
    return planned(FormFactorMethod::cut, mesh, options, progress);
  }
  Chosen rays = planned(FormFactorMethod::rays, mesh, options, progress);
  if (!may_cut || foreseenRays(*rays.method) < kManyRays) return rays;
  Chosen cut = planned(FormFactorMethod::cut, mesh, options, progress);
  const bool pays = foreseenRays(*cut.method) * kTimesForPairs < foreseenRays(*rays.method);
  return pays ? std::move(cut) : std::move(rays);
}

/// If planning exact takes long beside what rays take, exact is not the faster one: a plan takes
/// about a hundredth of the whole.
Chosen chooseMethod(const PatchMesh& mesh, const FormFactorOptions& options, Progress& progress) {
  const auto fits = [limit = options.memory_limit](const FormFactorPlan& one) {
    return limit == 0 || one.bytes <= limit;
  };
  Chosen exact{prepareMethod(FormFactorMethod::exact, mesh, options), {}};
  std::optional<FormFactorPlan> planned = planInTime(*exact.method, kFirstSeconds, progress);
  if (planned && fits(*planned) && planned->seconds <= kShortSeconds) {
    exact.plan = *std::move(planned);
    exact.plan.reason = fmt::format("it takes {}", secondsText(exact.plan.seconds));
    return exact;
  }
  Chosen other = planBesideExact(mesh, options, progress);
  const double most = secondsExactMayTake(options, other.plan.seconds);
  const bool prepared = exact.method->secondsPreparing() > 0;
  const double least = prepared ? 2 * kSecondSeconds : kUnpreparedSeconds / kPlanShare;
  if (!planned && most > least) {
    planned = planInTime(*exact.method, std::max(kSecondSeconds, kPlanShare * most), progress);
  }
  const bool exact_fits = planned && fits(*planned);
  const bool smaller =
      planned && !exact_fits && !fits(other.plan) && planned->bytes < other.plan.bytes;
  if (smaller || (exact_fits && planned->seconds <= most)) {
    exact.plan = *std::move(planned);
    exact.plan.other = {other.plan.method, other.plan.seconds};
    exact.plan.reason = exactReason(exact.plan, other.plan, smaller);
    return exact;
  }
  if (planned) other.plan.other = {FormFactorMethod::exact, planned->seconds};
  other.plan.reason = otherReason(planned, exact_fits, other.plan);
  return other;
}

/// Time is that of processors, so that other work on the machine does not change the method.
std::optional<FormFactors> computeInTime(const PreparedMethod& exact, double seconds,
                                         Progress& progress, RowJournal* journal) {
  const double over = std::max(kOverrunTimes * seconds, kOverrunSeconds);
  TimedProgress timed(progress, double(allowedThreads()) * (seconds + over), processSeconds);
  try {
    return exact.compute({}, timed, journal, nullptr);
  } catch (const Cancelled&) {
    timed.giveUp();
    return std::nullopt;
  }
}

std::string overrunText(double foreseen, double taken) {
  return fmt::format("exact, which was to take {}, was not done after {}", secondsText(foreseen),
                     secondsText(taken));
}

}  // namespace radiosity
