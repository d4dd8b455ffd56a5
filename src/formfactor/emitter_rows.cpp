#include "formfactor/emitter_rows.h"

#include <algorithm>
#include <array>

#include "base/processor_clock.h"
#include "formfactor/known_entries.h"

namespace radiosity {
namespace {

/// Tolerances of exact rows beside rays or hemicubes: errors of a pair, relative to the mean form
/// factor. The first that is not too much work is taken. (Furnished room, 2,000 unknowns: their
/// view of its lamp differs by .05% rms between the two, and is 3.7% off by rays to 1e-2; the first
/// takes four times as long as the second.)
constexpr std::array<double, 2> kTolerances{FormFactorOptions::kExactTolerance, 1e-2};
/// In any case they may be this much work, about two seconds of a core.
constexpr double kLittleWork = 2e8;
/// Preparing them is about this much work for each patch. It may be kPreparedShare of what the rows
/// may be, so that rows that turn out to be too much have not cost long.
constexpr double kPreparedWork = 3000;
constexpr double kPreparedShare = 0.25;
/// At most this many pairs: all are held at once, in 112 bytes each.
constexpr std::size_t kMostPairs = 1'000'000;

/// The unknowns whose rows are to be exact, or their patches.
std::vector<Index> wantedRows(const PatchMesh& mesh, const std::vector<Index>& unknowns,
                              bool of_unknowns) {
  if (of_unknowns || !mesh.clusters) return unknowns;
  std::vector<Index> patches;
  for (const Index unknown : unknowns) {
    const auto own = mesh.clusters->patchesOf(unknown);
    patches.insert(patches.end(), own.begin(), own.end());
  }
  std::sort(patches.begin(), patches.end());
  return patches;
}

}  // namespace

KnownRows EmitterRows::compute(Progress& progress) const {
  const Stopwatch watch;
  std::vector<KnownRow> computed;
  if (rows) computed = rows->compute(progress);
  return {std::move(computed), seconds + watch.seconds()};
}

std::unique_ptr<const EmitterRows> planEmitterRows(const PatchMesh& mesh,
                                                   const FormFactorOptions& options,
                                                   const PreparedMethod& method,
                                                   FormFactorPlan& plan, Progress& progress) {
  const std::optional<RoomForExactRows> room = method.roomForExactRows();
  if (!room) return nullptr;
  const bool of_unknowns = traitsOf(plan.method).counts_unknowns;
  const std::vector<Index> wanted = wantedRows(mesh, options.exact_rows, of_unknowns);
  const std::size_t pairs = wanted.size() * (of_unknowns ? mesh.unknowns() : mesh.size());
  const double most = std::max(kLittleWork, room->work);
  if (wanted.empty() || pairs > kMostPairs) return nullptr;
  if (kPreparedWork * double(mesh.size()) > kPreparedShare * most) return nullptr;
  const Stopwatch watch;
  auto emitters = std::make_unique<EmitterRows>();
  if (!of_unknowns && mesh.clusters) emitters->patches.emplace(mesh).clusters.reset();
  progress.begin("preparing", ExactScene::kSteps);
  LeadingRows& rows = emitters->rows.emplace(emitters->patches ? *emitters->patches : mesh, wanted,
                                             options, progress);
  progress.end();
  emitters->seconds = watch.seconds();
  RowSample sample = rows.sample(progress);
  for (const double tolerance : kTolerances) {
    rows.setTolerance(std::min(options.toleranceOf(plan.method), tolerance));
    if (rows.work(sample) > most) continue;
    plan.seconds += rows.seconds(sample, progress);
    plan.bytes = std::max(plan.bytes, room->bytes + rows.bytes());
    plan.bytes += KnownEntries::bytes(std::min(double(pairs), sample.unoccluded + sample.occluded));
    return emitters;
  }
  return nullptr;
}

}  // namespace radiosity
