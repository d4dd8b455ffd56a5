#include "formfactor/shared_factors.h"

#include <fmt/format.h>

#include "base/hash.h"
#include "formfactor/method.h"

namespace radiosity {

namespace {

/// The method and the options that rows depend on, and the mesh.
struct Task {
  FormFactorMethod method = FormFactorMethod::exact;
  double tolerance = 0;
  Precision precision = Precision::single_precision;
  ClosureMode closure = ClosureMode::report;
  bool simd = true;
  int resolution = 0;
  std::uint64_t seed = 0;
  bool random_turns = true;
  bool near_exact = false;
  std::uint64_t mesh = 0;  ///< checksum of its hash
};

std::uint64_t checksumOfMesh(const PatchMesh& mesh) {
  const std::string hash = geometryHash(mesh);
  return checksumOf(hash.data(), hash.size());
}

}  // namespace

void requireShareable(const PatchMesh& mesh, const FormFactorOptions& options) {
  const MethodTraits& method = traitsOf(options.method);
  const bool automatic = options.method == FormFactorMethod::automatic;
  if (!automatic && method.uses("eye") && options.eye == EyeChoice::gl) {
    throw InputError(
        "under mpirun hemicubes are drawn by the processor: give --eye cpu or auto, or start the "
        "program "
        "without mpirun");
  }
  if (options.symmetrize) {
    throw InputError(
        "--symmetrize needs all rows in one process: leave it out, or start the program without "
        "mpirun");
  }
  if (options.closure == ClosureMode::enforce && !method.counts_unknowns) {
    throw InputError(
        "--closure enforce needs all rows in one process: leave it out, or start the "
        "program without mpirun");
  }
  if (mesh.clusters && !method.counts_unknowns && !automatic) {
    throw InputError(
        "under mpirun patches share unknowns where rays count between these: give --method rays "
        "or more --patches, or start the program without mpirun");
  }
}

void tellOthers(Processes& processes, const PatchMesh& mesh, FormFactorMethod method,
                const FormFactorOptions& options) {
  Task task{method,
            options.toleranceOf(method),
            options.storedPrecision(),
            options.closure,
            options.simd,
            options.resolution,
            options.seed,
            options.random_turns,
            options.near_exact,
            checksumOfMesh(mesh)};
  processes.broadcastValue(task);
}

ExchangeMatrix shareFormFactors(const PatchMesh& mesh, Processes& processes, Progress& progress,
                                RowJournal* journal) {
  Task task;
  processes.broadcastValue(task);
  if (task.mesh != checksumOfMesh(mesh)) {
    throw RunError(
        "the mesh is not that of process 0: give all processes the same scene file and "
        "the same program");
  }
  FormFactorOptions options;
  options.method = task.method;
  options.tolerance = task.tolerance;
  options.precision = task.precision;
  options.closure = task.closure;
  options.simd = task.simd;
  options.resolution = task.resolution;
  options.seed = task.seed;
  options.random_turns = task.random_turns;
  options.near_exact = task.near_exact;
  return entryOf(task.method).rows_for_others(mesh, options, processes, progress, journal);
}

}  // namespace radiosity
