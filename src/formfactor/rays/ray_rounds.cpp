#include "formfactor/rays/ray_rounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "base/processor_clock.h"
#include "base/scratch_rows.h"
#include "formfactor/rays/cast_blocks.h"
#include "formfactor/rays/ray_model.h"
#include "formfactor/rays/ray_scene.h"
#include "formfactor/rays/round_journal.h"

namespace radiosity {
namespace {

/// A round gives a row at most this many times the rays that it had: an error known from few rays
/// is rough.
constexpr double kMostGrowth = 32;
/// A row that is still short after this many rounds is given up: its error does not fall.
constexpr int kMostRounds = 24;

class Rounds {
 public:
  Rounds(const RayScene& scene, const KnownEntries& known, const RayAim& aim, RayReport& report,
         const RowRun& run)
      : scene_(scene),
        known_(known),
        aim_(aim),
        report_(report),
        run_(run),
        progress_(run.progress),
        journal_(run.journal, scene.size(), known.identity()),
        before_(scene.size()),
        now_(scene.size()) {
    rows_.reserve(scene.size());
    for (std::size_t k = 0; k < scene.size(); ++k) {
      rows_.emplace_back(rowMemory(run.scratch.get()));
    }
  }

  std::vector<RayRow> run() {
    std::vector<std::uint32_t> rays(rows_.size(), 0);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (scene_.area()[k] > 0) rays[k] = kPilotRays;
    }
    resume(rays);
    while (cast(rays)) {
      measure(rays);
      if (report_.rounds == kMostRounds) break;
      loosened_ =
          std::max(loosened_,
                   loosening(aim_.most_rays, [&](double times) { return raysOf(wishes(times)); }));
      rays = wishes(loosened_);
      if (matrixIsShort()) rays = raysForMatrix();
      journal_.keep(report_.rounds,
                    {rays, before_, now_, common_, usual_norm_, usual_whole_norm_, loosened_});
    }
    CastBlocks::endRounds(run_);
    finish();
    return std::move(rows_);
  }

 private:
  /// Continues from the last of the journal's unbroken series of rounds, whose targets `rays`
  /// become. The same rays cast in the same order count the same hits.
  void resume(std::vector<std::uint32_t>& rays) {
    std::vector<std::vector<std::uint32_t>> targets{rays};
    while (std::optional<RayRound> round = journal_.take(int(targets.size()))) {
      targets.push_back(std::move(round->rays));
      before_ = std::move(round->before);
      now_ = std::move(round->now);
      common_ = round->common;
      usual_norm_ = round->usual_norm;
      usual_whole_norm_ = round->usual_whole_norm;
      loosened_ = round->loosened;
    }
    rays = std::move(targets.back());
    targets.pop_back();
    report_.rounds = int(targets.size());
    parallelFor(rows_.size(), 16, [&](std::size_t k) { restore(k, targets); });
    progress_.check();
    std::size_t found = 0;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      report_.rays += kReplicates * std::size_t(rows_[k].rays);
      const bool done = rows_[k].rays > 0 && rays[k] <= rows_[k].rays;
      found += done || journal_.hasRow(report_.rounds, k) ? 1 : 0;
    }
    journal_.found(found);
  }

  /// Restores a row as it was after rounds with these targets: from the last of them, or, if that
  /// is not there, from an earlier one and the rays of those after it.
  void restore(std::size_t k, const std::vector<std::vector<std::uint32_t>>& targets) {
    std::vector<int> continued;  // rounds that have cast rays of this row
    std::uint32_t most = 0;
    for (std::size_t r = 0; r < targets.size(); ++r) {
      if (targets[r][k] <= most) continue;
      most = targets[r][k];
      continued.push_back(int(r));
    }
    std::size_t next = continued.size();
    while (next > 0 && !journal_.takeRow(continued[next - 1], k,
                                         targets[std::size_t(continued[next - 1])][k], rows_[k])) {
      --next;
    }
    for (; next < continued.size() && !progress_.cancelled(); ++next) {
      scene_.cast(k, targets[std::size_t(continued[next])][k], rows_[k], progress_);
      touchRows(run_.scratch.get(), rows_[k].bytes());
    }
  }

  /// Continues rows to as many rays as given, if that is more than they have.
  bool cast(const std::vector<std::uint32_t>& rays) {
    std::vector<Index> todo;
    std::size_t all = 0;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (rays[k] <= rows_[k].rays) continue;
      todo.push_back(Index(k));
      all += rays[k] - rows_[k].rays;
      if (journal_.hasRow(report_.rounds, k)) kept += rays[k] - rows_[k].rays;
    }
    if (todo.empty()) return false;
    const double start = clockSeconds();
    // The longest first, so that no thread is left with one at the end.
    std::stable_sort(todo.begin(), todo.end(), [&](Index a, Index b) {
      return rays[a] - rows_[a].rays > rays[b] - rows_[b].rays;
    });
    if (report_.rounds == 0) {
      progress_.begin("first rays", kReplicates * all, "rays", kReplicates * kept);
    } else {
      // One bar for all rounds; the last one may be longer than foreseen.
      const std::size_t least = report_.rays + kReplicates * all;
      progress_.begin("form factors", std::max(least, std::size_t(aim_.foreseen_rays)), "rays",
                      report_.rays + kReplicates * kept);
    }
    const std::vector<RowToCast> left = takeKept(todo, rays);
    if (!left.empty()) {
      CastBlocks blocks(scene_, left, rows_, report_.rounds, run_);
      makeBlocks(blocks, run_);
    }
    progress_.check();
    progress_.end();
    ++report_.rounds;
    report_.rays += kReplicates * all;
    report_.seconds_cast += clockSeconds() - start;
    return true;
  }

  /// Takes what the journal has of a round, and returns the rest.
  std::vector<RowToCast> takeKept(const std::vector<Index>& todo,
                                  const std::vector<std::uint32_t>& rays) {
    std::vector<std::uint32_t> from(todo.size());
    for (std::size_t t = 0; t < todo.size(); ++t) from[t] = rows_[todo[t]].rays;
    parallelFor(todo.size(), 16, [&](std::size_t t) {
      const Index k = todo[t];
      if (journal_.takeRow(report_.rounds, k, rays[k], rows_[k])) from[t] = rays[k];
    });
    std::vector<RowToCast> left;
    for (std::size_t t = 0; t < todo.size(); ++t) {
      if (from[t] < rays[todo[t]]) left.push_back({todo[t], from[t], rays[todo[t]]});
    }
    return left;
  }

  /// The relative error that a row is to bring down: that of its fronts over their norm or, if
  /// larger, that of its backs over the norm of all it sees. Usual norms replace smaller ones.
  /// While no row has seen a front, what they may see of fronts counts beside the backs.
  double relativeError(const RowState& row) const {
    const double norm = std::max(row.norm, usual_norm_);
    const double whole = std::max(row.whole_norm, usual_whole_norm_);
    return std::max(relativeTo(norm > 0 ? norm : whole, row.error),
                    relativeTo(whole, row.backs_error));
  }

  /// Rays for a relative error of `aim`, from the errors with fewer rays.
  std::uint32_t raysNeeded(const RowState& before, const RowState& now, double aim) const {
    const double error = relativeError(now);
    const double error_before = relativeError(before);
    double order = kUsualOrder;
    if (before.rays > 0 && now.rays > before.rays && error > 0 && error_before > error) {
      order = 2 * std::log(error_before / error) / std::log(double(now.rays) / before.rays);
      order = std::clamp(order, kLeastOrder, kMostOrder);
    }
    const double growth = std::pow(error / aim, 2 / order);
    const std::uint32_t most = now.is_unknown != 0 ? most_of_unknown_ : kMostRays;
    return std::min(roundedRays(now.rays * std::min(growth, kMostGrowth)), most);
  }

  /// The rays, in each replicate, that rows need for errors `loosened` times those aimed at.
  std::vector<std::uint32_t> wishes(double loosened) const {
    std::vector<std::uint32_t> rays(rows_.size(), 0);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const double allowed = loosened * aim();
      if (relativeError(now_[k]) <= allowed || now_[k].rays >= kMostRays) continue;
      rays[k] = raysNeeded(before_[k], now_[k], allowed);
    }
    return rays;
  }
  /// True once all rows have reached their aim and the matrix has not: rows of a small norm may be
  /// off by the tolerance of a usual one.
  bool matrixIsShort() const {
    bool is_done = loosened_ == 1;
    for (std::size_t k = 0; k < rows_.size() && is_done; ++k) is_done = isGoodEnough(k);
    return is_done && matrixSquares() > squaresAllowed(kAimedShare);
  }
  /// A row's part of the squared error of the matrix, ||dF||^2 = sum_k A_k e_k^2.
  double squareOf(std::size_t k) const { return scene_.area()[k] * now_[k].error * now_[k].error; }
  double matrixSquares() const {
    double sum = 0;
    for (std::size_t k = 0; k < rows_.size(); ++k) sum += squareOf(k);
    return sum;
  }
  /// The squared error of a matrix that is off by `share` of the tolerance.
  double squaresAllowed(double share) const {
    double norms = 0;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      norms += scene_.area()[k] * now_[k].norm * now_[k].norm;
    }
    return share * share * aim_.tolerance * aim_.tolerance * norms;
  }
  /// The rays that bring the matrix within the tolerance, none if that takes more than allowed. A
  /// row's part s_k of the square falls as n_k^-p, p = kUsualOrder. So the sum of all is least for
  /// its rays if s_k / n_k is the same for all rows that get more (Lagrange): a level, which is
  /// lowered until the square is small enough.
  std::vector<std::uint32_t> raysForMatrix() const {
    constexpr double kStep = 0.8;     // of the level
    constexpr double kLowest = 1e-9;  // of the highest level
    const double allowed = squaresAllowed(kAimedShare * kAimedShare);
    double highest = 0;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (rows_[k].rays > 0) highest = std::max(highest, squareOf(k) / rows_[k].rays);
    }
    std::vector<std::uint32_t> rays(rows_.size(), 0);
    double squares = std::numeric_limits<double>::infinity();
    for (double level = highest; squares > allowed && level > kLowest * highest; level *= kStep) {
      squares = 0;
      for (std::size_t k = 0; k < rows_.size(); ++k) {
        rays[k] = raysAtLevel(k, level);
        const double growth = rays[k] > 0 ? double(rays[k]) / rows_[k].rays : 1.0;
        squares += squareOf(k) * std::pow(growth, -kUsualOrder);
      }
    }
    // Rows that have the most rays already may keep it from its aim; others would cast in vain.
    if (squares > allowed || raysOf(rays) > aim_.most_rays) std::fill(rays.begin(), rays.end(), 0);
    return rays;
  }
  /// The rays that bring s_k / n_k down to a level; 0 if the row has as many.
  std::uint32_t raysAtLevel(std::size_t k, double level) const {
    const double n = rows_[k].rays;
    if (n == 0) return 0;
    const double growth = std::pow(squareOf(k) / (n * level), 1 / (1 + kUsualOrder));
    constexpr double kMiddle = 0.9;  // rounding is up, by a quarter at most
    const std::uint32_t wanted =
        std::min(roundedRays(kMiddle * n * std::min(growth, kMostGrowth)), kMostRays);
    return wanted > rows_[k].rays ? wanted : 0;
  }
  /// All rays, of both replicates, once rows have those wished for.
  double raysOf(const std::vector<std::uint32_t>& wished) const {
    double sum = 0;
    for (std::size_t k = 0; k < rows_.size(); ++k) sum += std::max(wished[k], rows_[k].rays);
    return kReplicates * sum;
  }

  /// Measures the rows just continued; others, which these counts improve, too, are left.
  void measure(const std::vector<std::uint32_t>& rays) {
    const double start = clockSeconds();
    std::vector<std::uint8_t> wanted(rows_.size());
    for (std::size_t k = 0; k < rows_.size(); ++k) wanted[k] = rays[k] > 0;
    std::vector<RowAccuracy> measured(rows_.size());
    forMergedRows(rows_, scene_.area(), known_, wanted, run_.scratch.get(),
                  [&](const MergedRow& merged) {
                    const std::size_t k = merged.position;
                    measured[k] = accuracyOf(merged, rows_[k], scene_.area()[k]);
                  });
    for (const RowAccuracy& row : measured) common_.add(row);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (wanted[k] == 0) continue;
      const RowAccuracy accuracy = common_.moderated(measured[k]);
      before_[k] = now_[k];
      const double norm = std::hypot(accuracy.norm, aim_.sky_weight * rows_[k].skyShare());
      now_[k] = {
          rows_[k].rays, accuracy.isUnknown() ? 1u : 0u, accuracy.expectedError(),
          norm,          accuracy.backs_error,           std::hypot(norm, accuracy.backs_norm)};
    }
    UsualNorm usual;
    UsualNorm whole;
    for (std::size_t k = 0; k < now_.size(); ++k) {
      usual.add(now_[k].norm, scene_.area()[k]);
      whole.add(now_[k].whole_norm, scene_.area()[k]);
    }
    usual_norm_ = usual.value();
    usual_whole_norm_ = whole.value();
    limitUnknown();
    progress_.check();
    report_.seconds_merge += clockSeconds() - start;
  }

  void limitUnknown() {
    double unknown = 0;
    for (const RowState& row : now_) unknown += row.is_unknown;
    most_of_unknown_ = std::uint32_t(mostOfUnknown(unknown));
  }

  /// The aim of relative errors.
  double aim() const { return kAimedShare * aim_.tolerance; }
  bool isGoodEnough(std::size_t k) const { return relativeError(now_[k]) <= aim(); }

  void finish() {
    if (loosened_ > 1) report_.loosened_tolerance = loosened_ * aim_.tolerance;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      // While no row has seen a front, rows stop for what they see of backs.
      const bool saw_nothing = usual_norm_ == 0 && now_[k].is_unknown != 0;
      report_.short_rows += isGoodEnough(k) && !saw_nothing ? 0 : 1;
    }
  }

  const RayScene& scene_;
  const KnownEntries& known_;
  RayAim aim_;
  double loosened_ = 1;
  std::uint32_t most_of_unknown_ = kMostRays;
  RayReport& report_;
  RowRun run_;
  Progress& progress_;
  RoundJournal journal_;
  std::vector<RayRow> rows_;
  std::vector<RowState> before_;
  std::vector<RowState> now_;
  CommonError common_;  ///< of all rounds
  double usual_norm_ = 0;
  double usual_whole_norm_ = 0;
};

}  // namespace

std::uint32_t roundedRays(double rays) {
  double power = 1;
  while (2 * power <= rays) power *= 2;
  constexpr double kStep = 0.25;
  return std::uint32_t(std::ceil(rays / (kStep * power)) * kStep * power);
}

double mostOfUnknown(double rows) {
  constexpr double kShare = 0.5;
  const double most =
      kShare * FormFactorOptions::kMostRaysUnasked / (kReplicates * std::max(rows, 1.0));
  return std::clamp(most, double(kPilotRays), double(kMostRays));
}

RayAim::RayAim(const FormFactorOptions& options)
    : tolerance(options.toleranceOf(FormFactorMethod::rays)),
      most_rays(options.tolerance ? std::numeric_limits<double>::infinity()
                                  : FormFactorOptions::kMostRaysUnasked),
      sky_weight(options.skyWeight()) {}

double loosening(double most, const std::function<double(double)>& raysAt) {
  if (raysAt(1) <= most) return 1;
  constexpr double kLoosest = 1e3;
  constexpr double kClose = 1.01;
  double low = 1;
  double high = kLoosest;
  while (high > kClose * low) {
    const double middle = std::sqrt(low * high);
    (raysAt(middle) <= most ? high : low) = middle;
  }
  return high;
}

std::vector<RayRow> castRows(const RayScene& scene, const KnownEntries& known, const RayAim& aim,
                             RayReport& report, const RowRun& run) {
  return Rounds(scene, known, aim, report, run).run();
}

}  // namespace radiosity
