#include "scene/assimp/assimp_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "radiosity/base.h"

namespace radiosity {

namespace {

[[noreturn]] void fail() {
  throw RunError(
      fmt::format("{} cannot be used ({}); install Debian's libassimp5, or export the "
                  "scene as .obj or .glb",
                  RADIOSITY_ASSIMP, dlerror()));
}

template <class Function>
void find(void* library, const char* name, Function*& function) {
  void* entry = dlsym(library, name);
  if (entry == nullptr) fail();
  function = reinterpret_cast<Function*>(entry);
}

AssimpLibrary openLibrary() {
  void* library = dlopen(RADIOSITY_ASSIMP, RTLD_LAZY | RTLD_LOCAL);  // never closed
  if (library == nullptr) fail();
  AssimpLibrary found{};
  find(library, "aiCreatePropertyStore", found.createPropertyStore);
  find(library, "aiReleasePropertyStore", found.releasePropertyStore);
  find(library, "aiSetImportPropertyInteger", found.setImportPropertyInteger);
  find(library, "aiImportFileExWithProperties", found.importFileExWithProperties);
  find(library, "aiReleaseImport", found.releaseImport);
  find(library, "aiGetErrorString", found.getErrorString);
  find(library, "aiGetMaterialString", found.getMaterialString);
  find(library, "aiGetMaterialColor", found.getMaterialColor);
  find(library, "aiGetMaterialFloatArray", found.getMaterialFloatArray);
  find(library, "aiGetMaterialIntegerArray", found.getMaterialIntegerArray);
  find(library, "aiGetMaterialTextureCount", found.getMaterialTextureCount);
  find(library, "aiGetMaterialTexture", found.getMaterialTexture);
  return found;
}

}  // namespace

const AssimpLibrary& assimpLibrary() {
  static const AssimpLibrary library = openLibrary();
  return library;
}

}  // namespace radiosity
