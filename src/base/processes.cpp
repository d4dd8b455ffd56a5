#include "base/processes.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>

#include "radiosity/base.h"

namespace radiosity {

namespace {

Processes& openProcesses() {
  // Found beside this library, which carries $ORIGIN as its search path. Never closed. Its symbols
  // stay its own: PETSc brings an HDF5 library that is not the one that writes results files.
  void* library = dlopen("libradiosity_distributed.so", RTLD_LAZY | RTLD_LOCAL);
  void* entry = library == nullptr ? nullptr : dlsym(library, "radiosityProcesses");
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
