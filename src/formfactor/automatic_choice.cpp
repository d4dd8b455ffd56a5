#include "formfactor/automatic_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/figure_text.h"
#include "base/parallel.h"
#include "base/processor_clock.h"
#include "base/timed_progress.h"
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

std::string secondsText(double seconds) {
  if (seconds < 0.1) return "less than 0.1 s";
  if (seconds < 10) return fmt::format("about {:.2g} s", seconds);
  return fmt::format("about {} s", countText(std::size_t(std::llround(seconds))));
}

/// The seconds that exact may take and still be chosen. With shared unknowns it must be the faster
/// one: an error of their light is larger than that of either method's form factors.
double secondsExactMayTake(const PatchMesh& mesh, const FormFactorOptions& options,
                           double ray_seconds) {
  if (options.tolerance || mesh.clusters) return ray_seconds;
  return std::max(kTimesForAccuracy * ray_seconds, kSecondsForAccuracy);
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

std::string exactReason(const FormFactorPlan& exact, const FormFactorPlan& rays, bool smaller) {
  return fmt::format("it takes {}; rays, to {:.2g}, would take {}{}", secondsText(exact.seconds),
                     rays.tolerance, secondsText(rays.seconds),
                     smaller ? " and " + bytesText(rays.bytes) : "");
}

/// `exact`: nothing if its plan took too long.
std::string raysReason(const std::optional<FormFactorPlan>& exact, bool fits,
                       const FormFactorPlan& rays) {
  const std::string text = fmt::format("to {:.2g} they take {}; exact would take ", rays.tolerance,
                                       secondsText(rays.seconds));
  if (!exact) return text + "longer, as far as it was looked at";
  return fmt::format("{}{} and {}{}", text, secondsText(exact->seconds), bytesText(exact->bytes),
                     fits ? "" : ", more than " + spelled("memory_limit"));
}

}  // namespace

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
  Chosen rays{prepareMethod(FormFactorMethod::rays, mesh, options), {}};
  rays.plan = rays.method->plan(progress);
  const double most = secondsExactMayTake(mesh, options, rays.plan.seconds);
  const bool prepared = exact.method->secondsPreparing() > 0;
  const double least = prepared ? 2 * kSecondSeconds : kUnpreparedSeconds / kPlanShare;
  if (!planned && most > least) {
    planned = planInTime(*exact.method, std::max(kSecondSeconds, kPlanShare * most), progress);
  }
  const bool exact_fits = planned && fits(*planned);
  const bool smaller =
      planned && !exact_fits && !fits(rays.plan) && planned->bytes < rays.plan.bytes;
  if (smaller || (exact_fits && planned->seconds <= most)) {
    exact.plan = *std::move(planned);
    exact.plan.other = {FormFactorMethod::rays, rays.plan.seconds};
    exact.plan.reason = exactReason(exact.plan, rays.plan, smaller);
    return exact;
  }
  if (planned) rays.plan.other = {FormFactorMethod::exact, planned->seconds};
  rays.plan.reason = raysReason(planned, exact_fits, rays.plan);
  return rays;
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
