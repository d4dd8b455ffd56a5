#include "formfactor/emitter_rows.h"

#include <algorithm>
#include <array>

#include "base/made.h"
#include "base/processor_clock.h"
#include "formfactor/known_entries.h"
#include "formfactor/rays/ray_model.h"

namespace radiosity {
namespace {

/// Tolerances of exact rows beside rays or hemicubes: errors of a pair, relative to the mean form
/// factor. The first that is not too much work is taken. (Furnished room, 2,000 patches: their
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
/// By shadow rays: pairs, in as many bytes, and rays for each of the method's own; in any case they
/// may be as many as take some seconds of a core.
constexpr std::size_t kMostShadowPairs = 10'000'000;
constexpr double kShadowsARay = 4;
constexpr double kFewShadows = 3e7;

}  // namespace

/// What the rows are of, and what they may take.
struct EmitterRows::Room {
  const PatchMesh& mesh;
  const FormFactorOptions& options;
  RoomForExactRows most;
  FormFactorPlan& plan;
};

KnownRows EmitterRows::compute(Progress& progress) const {
  const Stopwatch watch;
  std::vector<KnownRow> computed =
      areExact() ? made(exact_).compute(progress) : made(by_shadows_).compute(progress);
  return {std::move(computed), areExact(), seconds_ + watch.seconds()};
}

std::unique_ptr<const EmitterRows> EmitterRows::planned(const PatchMesh& mesh,
                                                        const FormFactorOptions& options,
                                                        const PreparedMethod& method,
                                                        FormFactorPlan& plan, Progress& progress) {
  const std::optional<RoomForExactRows> most = method.roomForExactRows();
  if (!most || options.exact_rows.empty()) return nullptr;
  const Stopwatch watch;
  auto rows = std::make_unique<EmitterRows>();
  const Room room{mesh, options, *most, plan};
  const bool fits = rows->planExact(room, progress) || rows->planShadows(room, progress);
  rows->seconds_ = watch.seconds();
  return fits ? std::move(rows) : nullptr;
}

bool EmitterRows::planExact(const Room& room, Progress& progress) {
  const std::size_t pairs = room.options.exact_rows.size() * room.mesh.size();
  const double most = std::max(kLittleWork, room.most.work);
  if (pairs > kMostPairs) return false;
  if (kPreparedWork * double(room.mesh.size()) > kPreparedShare * most) return false;
  progress.begin("preparing", ExactScene::kSteps);
  LeadingRows& rows = exact_.emplace(room.mesh, room.options.exact_rows, room.options, progress);
  progress.end();
  RowSample sample = rows.sample(progress);
  for (const double tolerance : kTolerances) {
    rows.setTolerance(std::min(room.options.toleranceOf(room.plan.method), tolerance));
    if (rows.work(sample) > most) continue;
    room.plan.seconds += rows.seconds(sample, progress);
    room.plan.bytes =
        std::max(room.plan.bytes, room.most.bytes + rows.bytes()) +
        KnownEntries::bytes(std::min(double(pairs), sample.unoccluded + sample.occluded));
    return true;
  }
  exact_.reset();
  return false;
}

bool EmitterRows::planShadows(const Room& room, Progress& progress) {
  const std::size_t pairs = room.options.exact_rows.size() * room.mesh.size();
  if (pairs > kMostShadowPairs) return false;
  progress.begin("preparing", 1);
  const ShadowRows& rows =
      by_shadows_.emplace(room.mesh, room.options.exact_rows, room.options.seed);
  progress.end();
  const double most = std::max(kFewShadows, kShadowsARay * room.most.work / kExactWorkARay);
  if (rows.rays() > most) return false;
  const std::size_t bytes = std::max(room.plan.bytes, room.most.bytes + rows.bytes()) +
                            KnownEntries::bytes(double(pairs));
  if (room.options.memory_limit > 0 && bytes > room.options.memory_limit) return false;
  room.plan.seconds += rows.seconds(progress);
  room.plan.bytes = bytes;
  return true;
}

}  // namespace radiosity
