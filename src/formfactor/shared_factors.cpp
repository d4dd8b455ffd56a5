#include "formfactor/shared_factors.h"

#include <fmt/format.h>

#include <type_traits>

#include "base/hash.h"
#include "formfactor/method.h"
#include "radiosity/spelling.h"

namespace radiosity {

namespace {

/// Process 0 tells the others the options that rows depend on; they get them.
void broadcastOptions(Processes& processes, FormFactorOptions& options) {
  const auto list = [&](const OptionLine& line, auto& value, const OptionRange& = {}) {
    if constexpr (std::is_trivially_copyable_v<std::remove_reference_t<decltype(value)>>) {
      if (line.in_key != InKey::never) processes.broadcastValue(value);
    }
  };
  FormFactorOptions::describe(list, options);
  processes.broadcastValue(options.simd);
}

std::uint64_t checksumOfMesh(const PatchMesh& mesh) {
  const std::string hash = geometryHash(mesh);
  return checksumOf(hash.data(), hash.size());
}

}  // namespace

void requireShareable(const FormFactorOptions& options) {
  constexpr const char* kNeedsAllRows =
      " needs all rows in one process: leave it out, or start the program without mpirun";
  const MethodTraits& method = traitsOf(options.method);
  const bool automatic = options.method == FormFactorMethod::automatic;
  if (!automatic && method.uses("eye") && options.eye == EyeChoice::gl) {
    throw InputError(
        fmt::format("under mpirun hemicubes are drawn by the processor: give {} or auto, or start "
                    "the program without mpirun",
                    spelled("eye", "cpu")));
  }
  if (options.symmetrize) {
    throw InputError(spelled("symmetrize") + kNeedsAllRows);
  }
  if (options.closure == ClosureMode::enforce && !method.counts_rays) {
    throw InputError(spelled("closure", "enforce") + kNeedsAllRows);
  }
}

void tellOthers(Processes& processes, const PatchMesh& mesh, FormFactorMethod method,
                FormFactorOptions options) {
  options.method = method;
  options.tolerance = options.toleranceOf(method);
  options.precision = options.storedPrecision();
  options.eye = EyeChoice::cpu;
  broadcastOptions(processes, options);
  std::uint64_t checksum = checksumOfMesh(mesh);
  processes.broadcastValue(checksum);
}

std::shared_ptr<const ExchangeMatrix> shareFormFactors(const PatchMesh& mesh, Processes& processes,
                                                       Progress& progress, RowJournal* journal) {
  FormFactorOptions options;
  broadcastOptions(processes, options);
  std::uint64_t checksum = 0;
  processes.broadcastValue(checksum);
  if (checksum != checksumOfMesh(mesh)) {
    throw RunError(
        "the mesh is not that of process 0: give all processes the same scene file and "
        "the same program");
  }
  return prepareMethod(options.method, mesh, options)
      ->computeForOthers(processes, progress, journal);
}

}  // namespace radiosity
