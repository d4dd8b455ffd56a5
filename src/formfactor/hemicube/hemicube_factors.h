// The hemicube method: one look a patch.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "formfactor/hemicube/hemicube_blocks.h"
#include "formfactor/method.h"

namespace radiosity {

/// Time and memory, foreseen from a sample of rows.
struct HemicubeEstimate {
  RowMemory memory;
  std::size_t matrix_bytes = 0;  ///< of these, the matrix
  double measured = 0;  ///< seconds by the clock on the threads allowed, at the sample's rates
};
HemicubeEstimate estimateHemicubes(const PatchMesh& mesh, const HemicubeScene& scene,
                                   const FormFactorOptions& options, Progress& progress);

/// Raw rows, as they were seen but for the exchange in `known`, rows of patches, unless
/// `symmetrize`. See computeFormFactors(). `scene` is the mesh's.
FormFactors hemicubeFactors(const PatchMesh& mesh, const HemicubeScene& scene,
                            std::vector<KnownRow> known, const FormFactorOptions& options,
                            const RowRun& run);

std::unique_ptr<PreparedMethod> prepareHemicubes(const PatchMesh& mesh,
                                                 const FormFactorOptions& options);

}  // namespace radiosity
