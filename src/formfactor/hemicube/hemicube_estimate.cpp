// Foresees time and memory of hemicubes from a sample of them.

#include <algorithm>
#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/processor_clock.h"
#include "formfactor/hemicube/gpu_rows.h"
#include "formfactor/hemicube/hemicube_factors.h"
#include "formfactor/row_accounts.h"
#include "matrix/both_estimates.h"
#include "matrix/expected_bytes.h"
#include "matrix/working_memory.h"
#include "radiosity/matrix_functions.h"

namespace radiosity {
namespace {

/// A sample has one row in kOneIn, and kLeastRows to kMostRows of them: it takes a few per cent of
/// the whole, or not long.
constexpr std::size_t kOneIn = 40;
constexpr std::size_t kLeastRows = 8;
constexpr std::size_t kMostRows = 32;

struct SampledRow {
  std::size_t entries = 0;
  std::size_t hemicube_bytes = 0;
  double seconds = 0;  ///< of a processor
  BothClocks taken;    ///< by all of it
};

/// Times the second look: the first one also allocates memory.
SampledRow lookFrom(std::size_t patch, std::size_t patches, const HemicubeScene& scene) {
  const BothWatches watches;
  Hemicube hemicube = scene.rows.makeHemicube();
  std::vector<std::uint8_t> hidden;
  PackedRow row;
  SampledRow sampled;
  for (int look = 0; look < 2; ++look) {
    const double start = processorSeconds();
    const HemicubeView& view = scene.rows.look(patch, hemicube, hidden);
    row.pack(view, patches);
    sampled.entries = row.columns.size();
    if (scene.near_pairs) scene.near_pairs->correct(patch, row, view.backs + view.sky, false);
    sampled.seconds = processorSeconds() - start;
  }
  sampled.hemicube_bytes = hemicube.bytes();
  sampled.taken = watches.elapsed();
  return sampled;
}

/// Figures of all rows, from a sample of them.
struct Sample {
  double entries = 0;         ///< a row
  double seconds = 0;         ///< a row, by the clock, on the threads allowed
  std::size_t eye_bytes = 0;  ///< of all threads
};

Sample sampleByCpu(const std::vector<Index>& patches, std::size_t n, const HemicubeScene& scene,
                   Progress& progress) {
  std::vector<SampledRow> rows(patches.size());
  parallelFor(patches.size(), 1, [&](std::size_t k) {
    if (progress.cancelled() || scene.rows.isEmpty(patches[k])) return;
    rows[k] = lookFrom(patches[k], n, scene);
    progress.advance();
  });
  SampledRow sum;
  for (const SampledRow& row : rows) {
    sum.entries += row.entries;
    sum.seconds += row.seconds;
    sum.taken += row.taken;
    sum.hemicube_bytes = std::max(sum.hemicube_bytes, row.hemicube_bytes);
  }
  const double share = patches.empty() ? 0 : 1 / double(patches.size());
  const auto threads = double(allowedThreads());
  return {share * double(sum.entries), sum.taken.ratio() * share * sum.seconds / threads,
          allowedThreads() * sum.hemicube_bytes};
}

/// Times the second look: before the first one a device compiles. Empty if the device gives up,
/// which the rows' own look will report.
std::optional<Sample> sampleByGpu(const std::vector<Index>& patches, std::size_t n,
                                  const HemicubeScene& scene, Progress& progress) {
  std::vector<Index> looking;
  for (const Index patch : patches) {
    if (!scene.rows.isEmpty(patch)) looking.push_back(patch);
  }
  Progress silent;
  std::atomic<std::size_t> entries = 0;
  const auto count = [&](std::size_t patch, const HemicubeView& view, const HemicubeReport&) {
    PackedRow row;
    row.pack(view, n);
    entries += row.columns.size();
    if (scene.near_pairs) scene.near_pairs->correct(patch, row, view.backs + view.sky, false);
  };
  const auto gaveUp = [&](Progress& watched) {
    entries = 0;
    return !lookFromPatches(*scene.gpu, scene.rows, looking, count, watched).empty();
  };
  if (gaveUp(silent)) return std::nullopt;
  progress.check();
  const double start = clockSeconds();
  if (gaveUp(progress)) return std::nullopt;
  const double share = patches.empty() ? 0 : 1 / double(patches.size());
  return Sample{share * double(entries), share * (clockSeconds() - start), scene.gpu->bytes()};
}

}  // namespace

HemicubeEstimate estimateHemicubes(const PatchMesh& mesh, const HemicubeScene& scene,
                                   const FormFactorOptions& options, Progress& progress) {
  const std::size_t n = mesh.size();
  const std::size_t samples = std::min(n, std::clamp(n / kOneIn, kLeastRows, kMostRows));
  std::vector<Index> patches;
  for (std::size_t k = 0; k < samples; ++k) {
    patches.push_back(Index((2 * k + 1) * n / (2 * samples)));
  }
  progress.begin("planning", samples);
  std::optional<Sample> by_gpu;
  if (scene.gpu) by_gpu = sampleByGpu(patches, n, scene, progress);
  const Sample sample = by_gpu ? *by_gpu : sampleByCpu(patches, n, scene, progress);
  progress.check();
  progress.end();
  const std::size_t threads = allowedThreads();
  HemicubeEstimate estimate;
  estimate.matrix_bytes = estimateRowFormBytes(n, sample.entries, options.storedPrecision());
  // Fronts, backs, sky, area; backs seen; columns and values, with the headers of their memory.
  constexpr std::size_t kAccounts =
      4 * sizeof(double) + sizeof(std::vector<SeenBack>) + 7 * sizeof(std::size_t) + 2 * 16;
  // Looking through columns for reciprocity, and writing, come one after the other.
  const std::size_t finishing = std::max(bothEstimatesBytes(n, threads), kFileChunks);
  // Merging makes a second matrix beside the first, in which a pair is stored once if either of its
  // ends has seen it; closing its rows, after that, takes no more than the first.
  constexpr double kSeenByEither = 1.2;
  const double merged = std::min(double(n), kSeenByEither * sample.entries);
  const std::size_t second =
      options.symmetrize ? expectedSymmetricBytes(n, merged, options.storedPrecision()) : 0;
  const std::size_t beside =
      options.memory_held + n * kAccounts + scene.rows.sharedBytes() + sample.eye_bytes + finishing;
  const std::size_t matrices = estimate.matrix_bytes + second;
  estimate.memory = planRowMemory(beside + matrices, beside, matrices, options);
  estimate.measured = sample.seconds * double(n);
  return estimate;
}

}  // namespace radiosity
