#include "formfactor/hemicube/hemicube_factors.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/byte_stream.h"
#include "base/figure_text.h"
#include "base/hand_out.h"
#include "base/made.h"
#include "base/parallel.h"
#include "formfactor/closed_rows.h"
#include "formfactor/hemicube/gpu_rows.h"
#include "formfactor/hemicube/kept_row.h"
#include "formfactor/hemicube/row_builder.h"
#include "formfactor/known_entries.h"
#include "formfactor/row_accounts.h"
#include "matrix/shared_rows.h"
#include "mesh/clusters/canonical_order.h"
#include "radiosity/closure.h"
#include "radiosity/matrix_functions.h"

namespace radiosity {
namespace {

/// Of the view of a closed row a share this large may show between faces, which meet but for
/// rounding: some pixels.
constexpr double kMostLeaks = 1e-3;

/// Memory in which a thread stores rows, and their counts.
struct RowStore {
  PackedRow row;
  HemicubeReport counts;
};

/// Memory in which a thread makes rows.
struct Worker {
  Hemicube hemicube;
  std::vector<std::uint8_t> hidden;
  RowStore store;
};

/// The rows of one computation.
struct Rows {
  const HemicubeScene& scene;
  const KnownEntries& known;  ///< by patch
  ClosedRows& closed;
  RowJournal* journal;
  RowMatrix& matrix;
  FormFactors& result;
  std::vector<std::vector<SeenBack>>& seen_backs;
  std::vector<std::uint8_t> made;  ///< by row; 1 also for empty ones
};

/// Stores row i as it was seen, or with its near entries corrected. The sky of a closed one is
/// leaks: it goes without.
void storeRow(std::size_t i, const HemicubeView& view, bool closed, const NearPairs* near_pairs,
              PackedRow& row, Rows& rows, HemicubeReport& counts) {
  FormFactors& result = rows.result;
  const std::size_t n = result.fronts.size();
  row.pack(view, n);
  const double sky = closed ? 0.0 : view.sky;
  double rest = closed ? 1 / (1 - view.sky) : 1.0;
  for (double& value : row.values) value *= rest;
  result.fronts[i] = rest * view.fronts;
  result.sky[i] = sky;
  if (near_pairs != nullptr) {
    const auto [replaced, scaled] = near_pairs->correct(i, row, rest * view.backs + sky, closed);
    counts.near_pairs += replaced;
    counts.capped += scaled.capped ? 1 : 0;
    rest *= scaled.rest;
    result.fronts[i] = std::accumulate(row.values.begin(), row.values.end(), 0.0);
    result.sky[i] = scaled.rest * sky + scaled.sky;
  }
  rows.matrix.setRow(i, row.columns, row.values);
  result.backs[i] = rest * view.backs;
  for (std::size_t item = n; view.backs > 0 && item < view.items.size(); ++item) {
    if (!(view.items[item] > 0)) continue;
    rows.seen_backs[i].push_back({Index(item - n), rest * view.items[item]});
  }
}

/// Puts the known entries into row i, and scales the rest. A row that is known whole is scaled to
/// its account.
void replaceKnown(Rows& rows, std::size_t i, PackedRow& row) {
  const auto entries = rows.known.at(i);
  FormFactors& result = rows.result;
  const double area = rows.matrix.area()[i];
  if (rows.known.empty() || !(area > 0)) return;
  row.columns.clear();
  row.values.clear();
  std::vector<std::uint8_t> replaced;
  auto next = entries.begin();
  const auto addKnownBefore = [&](std::size_t end) {
    for (; next != entries.end() && next->position < end; ++next) {
      row.columns.push_back(next->position);
      row.values.push_back(next->exchange / area);
      replaced.push_back(1);
    }
  };
  const bool whole = rows.known.rowAt(i) != nullptr;
  bool seen = false;  // known ones, from the eye
  rows.matrix.forRow(i, [&](Index j, double value) {
    if (whole || rows.known.rowAt(j) != nullptr) {
      seen = true;
      return;
    }
    addKnownBefore(j);
    row.columns.push_back(j);
    row.values.push_back(value);
    replaced.push_back(0);
  });
  addKnownBefore(result.fronts.size());
  if (whole) {
    const RowAccount account = rows.known.account(i, area, rows.closed.closed(i));
    result.fronts[i] = account.fronts;
    result.backs[i] = account.backs;
    result.sky[i] = account.sky;
    rows.seen_backs[i] = rows.known.rowAt(i)->backs;
    // All hemicubes' rows sum to what was seen, so that closed furnaces are uniform.
    const double share = rows.known.share(i, area);
    for (double& value : row.values) value *= account.fronts / share;
  } else {
    if (!seen && entries.empty()) return;
    const PackedRow::Scaled scaled =
        row.scaleRest(replaced, result.backs[i] + result.sky[i], rows.closed.closed(i));
    result.backs[i] *= scaled.rest;
    result.sky[i] = scaled.rest * result.sky[i] + scaled.sky;
    for (SeenBack& back : rows.seen_backs[i]) back.share *= scaled.rest;
    result.fronts[i] = std::accumulate(row.values.begin(), row.values.end(), 0.0);
  }
  rows.matrix.setRow(i, row.columns, row.values);
}

/// The number of rows that need not be made: empty ones and those in the journal.
std::size_t rowsThere(const RowBuilder& rows, std::size_t n, RowJournal* journal) {
  std::size_t found = 0;
  std::size_t all = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (rows.isEmpty(i)) continue;
    ++all;
    found += journal != nullptr && journal->has(RowBlock::hemicube_row, i) ? 1 : 0;
  }
  if (journal != nullptr) journal->found(found, all);
  return n - all + found;
}

/// Stores row i and keeps it. `counts`: of its look.
void finishRow(Rows& rows, std::size_t i, const HemicubeView& view, HemicubeReport counts,
               RowStore& store) {
  const NearPairs* near_pairs = rows.scene.near_pairs ? &*rows.scene.near_pairs : nullptr;
  const bool closed = rows.closed.keeps(i, view.sky, kMostLeaks);
  storeRow(i, view, closed, near_pairs, store.row, rows, counts);
  if (rows.journal != nullptr) {
    keepRow(*rows.journal, i, rows.matrix, rows.result, rows.seen_backs[i], counts);
  }
  replaceKnown(rows, i, store.row);
  store.counts += counts;
  rows.made[i] = 1;
}

struct RowRange {
  std::size_t first;
  std::size_t last;  ///< one beyond
  std::size_t size() const { return last - first; }
};

/// Takes the rows that need not be made: empty ones and those in the journal.
HemicubeReport takeRows(Rows& rows, RowRange range, const Progress& progress) {
  tbb::enumerable_thread_specific<RowStore> stores;
  parallelFor(range.size(), 1, [&](std::size_t k) {
    if (progress.cancelled()) return;
    const std::size_t i = range.first + k;
    rows.made[i] = rows.scene.rows.isEmpty(i);
    if (rows.made[i] != 0 || rows.journal == nullptr) return;
    RowStore& store = stores.local();
    const bool taken =
        takeRow(*rows.journal, i, rows.matrix, rows.result, rows.seen_backs[i], store.counts);
    rows.made[i] = taken ? 1 : 0;
    if (rows.made[i] == 0) return;
    rows.closed.keeps(i, rows.result.sky[i], 0);
    replaceKnown(rows, i, store.row);
  });
  HemicubeReport all;
  for (const RowStore& store : stores) all += store.counts;
  return all;
}

/// Makes rows by the GPU's eye. If that gives up, a note says why; other rows are still to be made.
HemicubeReport makeRowsByGpu(Rows& rows, Progress& progress) {
  std::vector<Index> patches;
  for (std::size_t i = 0; i < rows.made.size(); ++i) {
    if (rows.made[i] == 0) patches.push_back(Index(i));
  }
  tbb::enumerable_thread_specific<RowStore> stores;
  const std::string problem = lookFromPatches(
      *rows.scene.gpu, rows.scene.rows, patches,
      [&](std::size_t i, const HemicubeView& view, const HemicubeReport& counts) {
        finishRow(rows, i, view, counts, stores.local());
      },
      progress);
  const std::string& name = rows.scene.gpu->device().name;
  std::vector<Note>& notes = rows.result.report.notes;
  const auto left = std::size_t(std::count(rows.made.begin(), rows.made.end(), 0));
  const bool drew = left < patches.size();
  if (drew) notes.push_back({Severity::info, "hemicubes drawn by " + name});
  if (!problem.empty()) {
    notes.push_back(
        {Severity::warning, fmt::format("{}: {}; {} {} hemicubes were drawn by the processor", name,
                                        problem, drew ? "the other" : "all", countText(left))});
  }
  HemicubeReport all;
  for (const RowStore& store : stores) all += store.counts;
  return all;
}

using Workers = tbb::enumerable_thread_specific<Worker>;

/// Makes the rows that are left by the CPU's eye. Returns their number.
std::size_t makeRows(Rows& rows, RowRange range, Workers& workers, Progress& progress) {
  std::atomic<std::size_t> made{0};
  parallelFor(range.size(), 1, [&](std::size_t k) {
    const std::size_t i = range.first + k;
    if (progress.cancelled() || rows.made[i] != 0) return;
    Worker& worker = workers.local();
    const HemicubeView& view = rows.scene.rows.look(i, worker.hemicube, worker.hidden);
    finishRow(rows, i, view, worker.hemicube.takeCounts(), worker.store);
    made.fetch_add(1, std::memory_order_relaxed);
    progress.advance();
  });
  progress.check();
  return made;
}

/// The counts of all workers since the last call.
HemicubeReport takeCounts(Workers& workers) {
  HemicubeReport all;
  for (Worker& worker : workers) all += std::exchange(worker.store.counts, {});
  return all;
}

/// Makes rows in blocks by all processes; process 0 gets accounts and counts of all of them.
HemicubeReport shareRows(Processes& processes, Rows& rows, Workers& workers, Progress& progress) {
  constexpr std::size_t kBlocksAProcess = 32;
  constexpr std::size_t kMostBlocksAProcess = 40;  // rows stay in the process that made them
  const std::size_t n = rows.made.size();
  FormFactors& result = rows.result;
  HemicubeReport all;
  BlockWork work;
  work.blocks = std::min(n, kBlocksAProcess * std::size_t(processes.size()));
  work.most_a_process = kMostBlocksAProcess;
  const auto rangeOf = [&](std::size_t block) {
    return RowRange{block * n / work.blocks, (block + 1) * n / work.blocks};
  };
  work.run = [&](std::size_t block) {
    const RowRange range = rangeOf(block);
    HemicubeReport counts = takeRows(rows, range, progress);
    const std::size_t made = makeRows(rows, range, workers, progress);
    counts += takeCounts(workers);
    ByteWriter bytes;
    bytes.put(made);
    bytes.put(counts);
    for (std::size_t i = range.first; i < range.last; ++i) {
      bytes.put(result.fronts[i]);
      bytes.put(result.backs[i]);
      bytes.put(result.sky[i]);
      bytes.putArray(std::span<const SeenBack>(rows.seen_backs[i]));
    }
    return std::vector<std::byte>(bytes.bytes().begin(), bytes.bytes().end());
  };
  work.take = [&](std::size_t block, std::span<const std::byte> from, int process) {
    ByteReader bytes(from);
    const auto made = bytes.get<std::size_t>();
    if (process != 0) progress.advance(made);
    all += bytes.get<HemicubeReport>();
    const RowRange range = rangeOf(block);
    for (std::size_t i = range.first; i < range.last; ++i) {
      result.fronts[i] = bytes.get<double>();
      result.backs[i] = bytes.get<double>();
      result.sky[i] = bytes.get<double>();
      rows.seen_backs[i] = bytes.getArray<SeenBack>();
      rows.closed.keeps(i, result.sky[i], 0);  // another process may have found it open
    }
  };
  handOut(processes, work, progress);
  return all;
}

/// The exchange known beforehand, by patch. Process 0 has it, the others get it.
KnownEntries knownByPatch(std::vector<KnownRow> rows, std::size_t patches, Processes* processes) {
  if (processes != nullptr) {
    std::size_t count = rows.size();
    processes->broadcastValue(count);
    rows.resize(count);
    for (KnownRow& row : rows) {
      processes->broadcastValue(row.unknown);
      processes->broadcastArray(row.entries);
      processes->broadcastArray(row.backs);
    }
  }
  std::vector<Index> position(patches);
  std::iota(position.begin(), position.end(), Index(0));
  return {std::move(rows), position};
}

HemicubeReport fillRows(Rows rows, Processes* processes, Progress& progress) {
  const RowBuilder& builder = rows.scene.rows;
  const std::size_t n = rows.matrix.size();
  rows.made.assign(n, 0);
  Workers workers([&] { return Worker{builder.makeHemicube(), {}, {}}; });
  progress.begin("form factors", n, "rows", rowsThere(builder, n, rows.journal));
  HemicubeReport counts;
  if (processes != nullptr) {
    counts = shareRows(*processes, rows, workers, progress);
  } else {
    counts = takeRows(rows, {0, n}, progress);
    if (rows.scene.gpu != nullptr) counts += makeRowsByGpu(rows, progress);
    makeRows(rows, {0, n}, workers, progress);
    counts += takeCounts(workers);
  }
  progress.check();
  progress.end();
  return counts;
}

/// Form factors without a matrix yet.
FormFactors emptyAccounts(std::size_t n) {
  FormFactors result;
  for (std::vector<double>* account : {&result.fronts, &result.backs, &result.sky}) {
    account->assign(n, 0.0);
  }
  return result;
}

/// The smallest area above 0.
double smallestOf(std::span<const double> area) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const double a : area) smallest = a > 0 ? std::min(smallest, a) : smallest;
  return smallest;
}

/// The errors of a merged matrix's entries: their squares go with the exchange area, as in van
/// Leersum's closure (closure.h); known ones have none. The unit, the `smallest` area, keeps errors
/// of F below 1.
UncertainEntries uncertainEntries(const SymmetricMatrix& matrix, double smallest,
                                  const KnownEntries& known) {
  const std::size_t n = matrix.size();
  UncertainEntries uncertain(n, matrix.scratch());
  parallelFor(n, 1, [&](std::size_t k) {
    const SymmetricMatrix::UpperEntries upper = matrix.upperEntries(k);
    const double share = smallest / matrix.area()[matrix.order()[k]];
    std::vector<Index> later;
    std::vector<double> errors;
    for (std::size_t m = 0; m < upper.positions.size(); ++m) {
      if (upper.positions[m] == k) continue;
      const Index other = matrix.order()[upper.positions[m]];
      if (known.rowAt(matrix.order()[k]) != nullptr || known.rowAt(other) != nullptr) continue;
      later.push_back(upper.positions[m]);
      errors.push_back(std::sqrt(upper.factors[m] * share));
    }
    uncertain.setRow(k, later, errors);
  });
  return uncertain;
}

/// The errors of the sky of open rows: an eye may miss as much as it may leak. So entries, which
/// are off by more, move where they can.
std::vector<double> skyErrors(const ClosedRows& closed, double smallest, const FormFactors& f) {
  std::vector<double> errors(f.sky.size(), 0.0);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (closed.closed(i) || !(f.fronts[i] > 0)) continue;
    errors[i] = std::sqrt(kMostLeaks * smallest / f.matrix->area()[i]);
  }
  return errors;
}

void symmetrize(std::shared_ptr<const RowMatrix> rows, const KnownEntries& known,
                const ClosedRows& closed, FormFactors& result, Progress& progress) {
  constexpr double kTolerance = 1e-12;
  const auto merged = std::make_shared<SymmetricMatrix>(symmetrized(*rows));
  result.matrix = merged;
  rows.reset();
  // The sums to restore are the raw ones: with backs and, in an open row, the sky they are 1.
  const double smallest = smallestOf(merged->area());
  const std::vector<double> sky_errors = skyErrors(closed, smallest, result);
  result.report.closure = closeRows(*merged, uncertainEntries(*merged, smallest, known),
                                    result.fronts, progress, kTolerance, {result.sky, sky_errors});
  result.report.symmetrized = true;
  const std::vector<double> sums = merged->rowSums();
  for (std::size_t i = 0; i < sums.size(); ++i) {
    // Keep a sum aimed at: storing rounds those of the matrix.
    if (!closed.closed(i) || !result.report.closure.reached) result.fronts[i] = sums[i];
  }
  closed.balance(result);
}

void checkRows(FormFactors& result) {
  for (std::size_t i = 0; i < result.fronts.size(); ++i) {
    const double sum = result.fronts[i] + result.backs[i] + result.sky[i];
    if (sum > 0) {
      result.report.largest_row_error =
          std::max(result.report.largest_row_error, std::abs(sum - 1));
    }
  }
}

}  // namespace

HemicubeScene::HemicubeScene(const PatchMesh& mesh, const FormFactorOptions& options)
    : rows(mesh, options), gpu(openGpuEye(options.eye, rows.scene(), mesh, rows.weights())) {
  if (options.near_exact) near_pairs.emplace(mesh, options);
}

FormFactors hemicubeFactors(const PatchMesh& mesh, const HemicubeScene& scene,
                            std::vector<KnownRow> known_rows, const RowMemory& memory,
                            const FormFactorOptions& options, Progress& progress,
                            RowJournal* journal, Processes* processes) {
  const std::size_t n = mesh.size();
  auto rows = std::make_shared<RowMatrix>(mesh.area, options.storedPrecision(),
                                          makeRowMemory(memory, options, n));
  FormFactors result = emptyAccounts(n);
  FormFactorReport& report = result.report;
  report.simd_target = scene.rows.kernels().target;
  const KnownEntries known = knownByPatch(std::move(known_rows), n, processes);
  std::vector<std::vector<SeenBack>> seen_backs(n);
  ClosedRows closed(mesh, false);
  report.hemicube =
      fillRows({scene, known, closed, journal, *rows, result, seen_backs, {}}, processes, progress);
  report.empty_rows = n - report.hemicube.hemicubes;
  closed.report(mesh, report);
  result.matrix = wholeMatrix(processes, rows, [&progress] { progress.check(); });
  constexpr std::size_t kSteps = 2;
  progress.begin("finishing", kSteps);
  const auto step = [&] {
    progress.advance();
    progress.check();
  };
  accountForBacks(mesh, canonicalOrder(mesh), mesh.area, seen_backs, result);
  checkRows(result);
  step();
  report.reciprocity_residual = reciprocityResidual(pairsOf(*result.matrix));
  step();
  progress.end();
  if (options.symmetrize) symmetrize(std::move(rows), known, closed, result, progress);
  return result;
}

namespace {

/// Exact rows may be this much work for each hemicube and polygon that it looks at: about half of
/// what these take (a hemicube of 256 pixels .15 ms with 17 polygons, .95 ms with 17,672).
constexpr double kExactRowWork = 1e4;
constexpr double kExactRowWorkAPolygon = 2;

class Hemicubes final : public PreparedMethod {
 public:
  Hemicubes(const PatchMesh& mesh, const FormFactorOptions& options)
      : PreparedMethod(FormFactorMethod::hemicube, mesh, options) {}
  /// Hemicubes' own rows come after these.
  std::optional<RoomForExactRows> roomForExactRows() const override {
    const double of_each = kExactRowWork + kExactRowWorkAPolygon * double(mesh().polygons.size());
    return RoomForExactRows{of_each * double(mesh().size()), options().memory_held};
  }

 private:
  Cost foresee(Progress& progress) override;
  FormFactors make(KnownRows exact, Progress& progress, RowJournal* journal,
                   Processes* processes) const override {
    return hemicubeFactors(mesh(), made(scene_), std::move(exact.rows), memory(processes),
                           options(), progress, journal, processes);
  }

  std::optional<HemicubeScene> scene_;
};

Hemicubes::Cost Hemicubes::foresee(Progress& progress) {
  progress.begin("preparing", 1);
  const HemicubeScene& scene = scene_.emplace(mesh(), options());
  progress.advance();
  progress.end();
  progress.check();
  const HemicubeEstimate estimate = estimateHemicubes(mesh(), scene, options(), progress);
  Cost cost{{}, estimate.memory};
  cost.plan.matrix_bytes = estimate.matrix_bytes;
  cost.plan.seconds = estimate.measured;
  const std::size_t n = mesh().size();
  cost.plan.what = fmt::format("{} {} of {} pixels", countText(n),
                               n == 1 ? "hemicube" : "hemicubes", options().resolution);
  return cost;
}

}  // namespace

std::unique_ptr<PreparedMethod> prepareHemicubes(const PatchMesh& mesh,
                                                 const FormFactorOptions& options) {
  return std::make_unique<Hemicubes>(mesh, options);
}

std::shared_ptr<const ExchangeMatrix> hemicubeRowsForOthers(const PatchMesh& mesh,
                                                            const FormFactorOptions& options,
                                                            Processes& processes,
                                                            Progress& progress,
                                                            RowJournal* journal) {
  const HemicubeScene scene(mesh, options);
  auto rows = std::make_shared<RowMatrix>(mesh.area, options.storedPrecision());
  FormFactors result = emptyAccounts(mesh.size());
  std::vector<std::vector<SeenBack>> seen_backs(mesh.size());
  const KnownEntries known = knownByPatch({}, mesh.size(), &processes);
  ClosedRows closed(mesh, false);
  fillRows({scene, known, closed, journal, *rows, result, seen_backs, {}}, &processes, progress);
  return rows;
}

}  // namespace radiosity
