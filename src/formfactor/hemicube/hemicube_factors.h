// The hemicube method: one look a patch.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "formfactor/hemicube/gpu_eye.h"
#include "formfactor/hemicube/near_pairs.h"
#include "formfactor/hemicube/row_builder.h"
#include "formfactor/method.h"

namespace radiosity {

/// The scene as all rows see it.
struct HemicubeScene {
  /// Keeps `mesh` by reference. Throws RunError as openGpuEye().
  HemicubeScene(const PatchMesh& mesh, const FormFactorOptions& options);
  RowBuilder rows;
  std::unique_ptr<GpuEye> gpu;          ///< null: the CPU's eye looks
  std::optional<NearPairs> near_pairs;  ///< if near entries are to be made exact
};

/// Time and memory, foreseen from a sample of rows.
struct HemicubeEstimate {
  RowMemory memory;
  std::size_t matrix_bytes = 0;  ///< of these, the matrix
  double measured = 0;  ///< seconds by the clock on the threads allowed, at the sample's rates
};
HemicubeEstimate estimateHemicubes(const PatchMesh& mesh, const HemicubeScene& scene,
                                   const FormFactorOptions& options, Progress& progress);

/// Raw rows, as they were seen but for the exchange in `known`, rows of patches, unless
/// `symmetrize`. See computeFormFactors(). `scene` is the mesh's; `journal`, which keeps what was
/// seen, and `processes` may be null.
FormFactors hemicubeFactors(const PatchMesh& mesh, const HemicubeScene& scene,
                            std::vector<KnownRow> known, const RowMemory& memory,
                            const FormFactorOptions& options, Progress& progress,
                            RowJournal* journal, Processes* processes);

std::unique_ptr<PreparedMethod> prepareHemicubes(const PatchMesh& mesh,
                                                 const FormFactorOptions& options);

std::shared_ptr<const ExchangeMatrix> hemicubeRowsForOthers(const PatchMesh& mesh,
                                                            const FormFactorOptions& options,
                                                            Processes& processes,
                                                            Progress& progress,
                                                            RowJournal* journal);

}  // namespace radiosity
