#include "base/processes.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>

#include "radiosity/base.h"

namespace radiosity {

namespace {

Processes& openProcesses() {
  // The library is found beside this one, whose search path is $ORIGIN. It is never closed. Its
  // symbols stay private: PETSc brings another HDF5 library than the one that writes results files.
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
