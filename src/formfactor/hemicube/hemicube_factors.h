// The hemicube method: one look a patch.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "base/processes.h"
#include "formfactor/hemicube/gpu_eye.h"
#include "formfactor/hemicube/near_pairs.h"
#include "formfactor/hemicube/row_builder.h"
#include "formfactor/known_rows.h"
#include "formfactor/row_memory.h"
#include "radiosity/form_factors.h"

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
/// `symmetrize`. See computeFormFactors(). `scene` is the mesh's, `estimate` the scene's;
/// `journal`, which keeps what was seen, and `processes` may be null.
FormFactors hemicubeFactors(const PatchMesh& mesh, const HemicubeScene& scene,
                            std::vector<KnownRow> known, const HemicubeEstimate& estimate,
                            const FormFactorOptions& options, Progress& progress,
                            RowJournal* journal, Processes* processes);

/// For the other processes, while process 0 is in hemicubeFactors(): makes the rows of this one.
ExchangeMatrix hemicubeRowsForOthers(const PatchMesh& mesh, const FormFactorOptions& options,
                                     Processes& processes, Progress& progress, RowJournal* journal);

}  // namespace radiosity
