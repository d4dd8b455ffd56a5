#include "formfactor/cut/cut_factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "base/figure_text.h"
#include "base/made.h"
#include "base/parallel.h"
#include "base/processor_clock.h"
#include "formfactor/closed_rows.h"
#include "formfactor/cut/cut_blocks.h"
#include "formfactor/cut/cut_plan.h"
#include "formfactor/rays/ray_model.h"
#include "formfactor/row_accounts.h"
#include "matrix/cut_balance.h"
#include "radiosity/spelling.h"

namespace radiosity {
namespace {

/// Bytes of an entry, a node in the tree with its patch, and an account.
constexpr double kEntryBytes = sizeof(Index) + sizeof(CutRows::Hits) + sizeof(CutRows::Place);
constexpr std::size_t kTreeBytes =
    sizeof(PatchTree::Patch) + 2 * sizeof(PatchTree::Node) + sizeof(PatchTree::Fit);
constexpr std::size_t kAccountBytes = sizeof(CutCounts) + 8 * sizeof(double);

/// The known form factors of all rows; null if there are none. A row that is known whole is scaled
/// to what its account has: if it is closed, to 1 less its backs.
std::shared_ptr<const RowMatrix> knownPairs(const RayScene& scene, const KnownEntries& known,
                                            const std::vector<double>& area,
                                            const std::vector<double>& fronts,
                                            Precision precision) {
  if (known.empty()) return nullptr;
  auto pairs = std::make_shared<RowMatrix>(area, precision);
  for (std::size_t k = 0; k < scene.size(); ++k) {
    if (!(scene.area()[k] > 0)) continue;
    std::vector<std::pair<Index, double>> entries;
    double times = 1 / scene.area()[k];
    if (known.rowAt(k) != nullptr && known.share(k, scene.area()[k]) > 0) {
      times *= fronts[scene.order()[k]] / known.share(k, scene.area()[k]);
    }
    for (const KnownEntries::Entry& entry : known.at(k)) {
      const double factor = times * entry.exchange;
      if (factor > 0) entries.emplace_back(scene.order()[entry.position], factor);
    }
    std::ranges::sort(entries);
    std::vector<Index> columns;
    std::vector<double> values;
    for (const auto& [column, value] : entries) {
      columns.push_back(column);
      values.push_back(value);
    }
    pairs->setRow(scene.order()[k], columns, values);
  }
  return pairs;
}

std::vector<Index> knownWhole(const RayScene& scene, const KnownEntries& known) {
  std::vector<Index> patches;
  for (std::size_t k = 0; k < scene.size(); ++k) {
    if (known.rowAt(k) != nullptr) patches.push_back(scene.order()[k]);
  }
  return patches;
}

/// What process 0 tells the others.
struct CutTask {
  std::uint32_t rays = 0;  ///< of a row, in each replicate
  double opening = 0;
  std::vector<Index> known;  ///< patches whose rows are known whole

  void broadcast(Processes& processes) {
    processes.broadcastValue(rays);
    processes.broadcastValue(opening);
    processes.broadcastArray(known);
  }
};

class Cut final : public PreparedMethod {
 public:
  Cut(const PatchMesh& mesh, const FormFactorOptions& options)
      : PreparedMethod(FormFactorMethod::cut, mesh, options) {}
  std::optional<RoomForExactRows> roomForExactRows() const override {
    return RoomForExactRows{kExactWorkARay * kReplicates * plan_.rays * double(made(scene_).size()),
                            bytes_};
  }

 private:
  Cost foresee(Progress& progress) override;
  FormFactors make(KnownRows exact, const RowRun& run) const override;
  std::shared_ptr<const ExchangeMatrix> share(const RowRun& run) const override;
  CutReport reportOfPlan() const;

  std::optional<RayScene> scene_;
  CutPlan plan_;
  std::size_t bytes_ = 0;
};

Cut::Cost Cut::foresee(Progress& progress) {
  progress.begin("preparing", 1);
  const Stopwatch watch;
  scene_.emplace(mesh(), options().seed);
  // Rows that will be exact are no part of the tree that is used; a few more do no harm here.
  const PatchTree tree = treeOfPatches(mesh(), *scene_, {});
  seconds_preparing_ = watch.seconds();
  progress.advance();
  progress.end();
  progress.begin("planning", 1);
  plan_ = planCuts(mesh(), *scene_, tree, options(), progress);
  progress.end();
  const std::size_t n = scene_->size();
  Cost cost;
  cost.plan.seconds = plan_.seconds * double(n) / double(allowedThreads());
  cost.plan.tolerance = plan_.error();
  cost.plan.refining = 1;
  cost.plan.refining_order = 2 / kUsualOrder;
  cost.plan.matrix_bytes = std::size_t(double(n) * plan_.entries * kEntryBytes) + n * kTreeBytes;
  bytes_ = options().memory_held + scene_->bytes() + cost.plan.matrix_bytes + n * kAccountBytes;
  cost.memory.bytes = bytes_;
  return cost;
}

/// Fills in the accounts of a row, and returns what a hit of it counts. Known entries replace the
/// rays that ended there; all others share the rest of the row.
double setAccount(const CutCounts& counts, double known_share, bool closed, std::size_t row,
                  FormFactors& result, std::vector<SeenBack>& seen) {
  const double sky = closed ? 0.0 : counts.sky;
  const double counted = counts.rays - (counts.sky - sky) - counts.known;
  const double each = counted > 0 ? std::max(0.0, 1 - known_share) / counted : 0.0;
  double on_backs = 0;
  for (const SeenBack& back : counts.backs) {
    on_backs += back.share;
    seen.push_back({back.surface, back.share * each});
  }
  result.backs[row] = on_backs * each;
  result.sky[row] = sky * each;
  result.fronts[row] = known_share + (counted - sky - on_backs) * each;
  return each;
}

void noteShort(const CutPlan& plan, double tolerance, FormFactorReport& report) {
  if (!plan.is_lit) {
    report.notes.push_back({Severity::info,
                            "rows that were tried see next to nothing that light falls on: the "
                            "error of irradiance is not known"});
  } else if (plan.error() > tolerance) {
    report.notes.push_back(
        {Severity::warning,
         fmt::format("irradiance is right to about {:.2g}, not to {:.2g}: rows stopped at {} rays; "
                     "{} or {} comes closer",
                     plan.error(), tolerance, countText(std::size_t(kReplicates) * plan.rays),
                     spelled("method", "exact"), spelled("method", "rays"))});
  }
}

/// Fills in the accounts of all rows, and what a hit counts.
void setAccounts(const RowCutter& cutter, const std::vector<CutCounts>& counts,
                 const KnownEntries& known, ClosedRows& closed, FormFactors& result,
                 std::vector<std::vector<SeenBack>>& seen, std::vector<double>& of_a_hit) {
  const RayScene& scene = cutter.scene();
  for (std::size_t place = 0; place < counts.size(); ++place) {
    const std::size_t k = cutter.positionOf(place);
    const Index i = scene.order()[k];
    const CutCounts& of_row = counts[place];
    const double leaking = of_row.rays > 0 ? of_row.sky / of_row.rays : 0.0;
    const bool is_closed = closed.keeps(i, leaking, ClosedRows::kMostLeaks);
    if (is_closed) result.report.cut.leaked += std::size_t(of_row.sky);
    of_a_hit.push_back(
        setAccount(of_row, known.share(k, scene.area()[k]), is_closed, i, result, seen[i]));
  }
  for (std::size_t k = 0; k < scene.size(); ++k) {
    if (known.rowAt(k) == nullptr) continue;
    const Index i = scene.order()[k];
    const RowAccount account = known.account(k, scene.area()[k], closed.closed(i));
    result.fronts[i] = account.fronts;
    result.backs[i] = account.backs;
    result.sky[i] = account.sky;
    seen[i] = known.rowAt(k)->backs;
  }
}

/// What each row of the tree sees of fronts that are not known pair by pair.
std::vector<double> sumsOfRows(const RowCutter& cutter, const KnownEntries& known,
                               const std::vector<double>& fronts) {
  const RayScene& scene = cutter.scene();
  std::vector<double> sums(cutter.tree().patches().size());
  for (std::size_t place = 0; place < sums.size(); ++place) {
    const std::size_t k = cutter.positionOf(place);
    sums[place] = fronts[scene.order()[k]] - known.share(k, scene.area()[k]);
  }
  return sums;
}

FormFactors Cut::make(KnownRows exact, const RowRun& run) const {
  const Stopwatch watch;
  const RayScene& scene = made(scene_);
  const std::size_t n = scene.size();
  FormFactors result;
  FormFactorReport& report = result.report;
  result.fronts.assign(n, 0.0);
  result.backs.assign(n, 0.0);
  result.sky.assign(n, 0.0);
  CutParts parts;
  parts.area.resize(n);
  for (std::size_t k = 0; k < n; ++k) parts.area[scene.order()[k]] = scene.area()[k];
  report.empty_rows = std::size_t(std::ranges::count(parts.area, 0.0));
  report.cut = reportOfPlan();
  report.cut.seconds_prepare += exact.seconds;
  const KnownEntries known(std::move(exact.rows), scene.position());
  CutTask task{plan_.rays, plan_.opening, knownWhole(scene, known)};
  if (run.processes != nullptr) task.broadcast(*run.processes);
  parts.tree = treeOfPatches(mesh(), scene, task.known);
  parts.bias = plan_.bias;
  const RowCutter cutter(scene, parts.tree, task.opening);
  CutBlocks blocks(cutter, task.rays, run.progress);
  makeAllRows(blocks, run);
  ClosedRows closed(mesh());
  std::vector<std::vector<SeenBack>> seen(n);
  setAccounts(cutter, blocks.counts(), known, closed, result, seen, parts.of_a_hit);
  closed.report(mesh(), report);
  closed.balance(result);
  accountForBacks(mesh(), scene.order(), parts.area, seen, result);
  noteShort(plan_, tolerance(), report);
  parts.blocks = blocks.takeRows();
  parts.pairs = knownPairs(scene, known, parts.area, result.fronts, options().storedPrecision());
  const CutBalance balance =
      balanceCut(parts, sumsOfRows(cutter, known, result.fronts), run.progress);
  report.cut.unbalanced_before = balance.before;
  report.cut.unbalanced = balance.after;
  report.cut.rays = report.cut.rays_a_row * parts.tree.patches().size();
  const auto matrix = std::make_shared<CutOperator>(std::move(parts));
  report.cut.entries = matrix->entries();
  report.cut.seconds_rows = watch.seconds();
  result.matrix = matrix;
  return result;
}

CutReport Cut::reportOfPlan() const {
  CutReport report;
  report.triangles = made(scene_).caster().triangles();
  report.rays_a_row = kReplicates * std::size_t(plan_.rays);
  report.opening = plan_.opening;
  report.noise = plan_.noise;
  report.bias = plan_.bias;
  report.seconds_prepare = seconds_preparing_;
  return report;
}

/// Process 0 gets all rows, which take less than pairs, and keeps the journal.
std::shared_ptr<const ExchangeMatrix> Cut::share(const RowRun& run) const {
  CutTask task;
  task.broadcast(*run.processes);
  const RayScene scene(mesh(), options().seed);
  const PatchTree tree = treeOfPatches(mesh(), scene, task.known);
  const RowCutter cutter(scene, tree, task.opening);
  CutBlocks blocks(cutter, task.rays, run.progress);
  makeBlocks(blocks, {run.progress, nullptr, run.processes});
  return nullptr;
}

}  // namespace

std::unique_ptr<PreparedMethod> prepareCut(const PatchMesh& mesh,
                                           const FormFactorOptions& options) {
  return std::make_unique<Cut>(mesh, options);
}

}  // namespace radiosity
