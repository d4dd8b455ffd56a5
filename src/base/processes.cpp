#include "base/processes.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>

#include "base/side_library.h"
#include "radiosity/base.h"

namespace radiosity {

namespace {

Processes& openProcesses() {
  // PETSc brings another HDF5 library than the one that writes results files, so it matters that
  // the symbols stay private.
  void* entry = entryOf("libradiosity_distributed.so", "radiosityProcesses");
  if (entry == nullptr) {
    throw RunError(
        fmt::format("started by mpirun, but libradiosity_distributed.so cannot be used ({}); build "
                    "with -DRADIOSITY_MPI=ON, or start the program without mpirun",
                    dlerror()));
  }
  return *reinterpret_cast<Processes* (*)()>(entry)();
}

}  // namespace

bool startedByMpi() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"}) {
    if (std::getenv(name) != nullptr) return true;
  }
  return false;
}

Processes& joinProcesses() {
  static Processes& processes = openProcesses();
  return processes;
}

}  // namespace radiosity
