// Assimp by its C functions. It brings libraries of its own, which take a fifth of the program's
// start-up time; so it is opened when the first file that needs it is read.
#pragma once

#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/scene.h>

namespace radiosity {

/// The functions of assimp/cimport.h and assimp/material.h of these names, less `ai`.
struct AssimpLibrary {
  aiPropertyStore* (*createPropertyStore)();
  void (*releasePropertyStore)(aiPropertyStore*);
  void (*setImportPropertyInteger)(aiPropertyStore*, const char*, int);
  const aiScene* (*importFileExWithProperties)(const char*, unsigned, aiFileIO*,
                                               const aiPropertyStore*);
  void (*releaseImport)(const aiScene*);
  const char* (*getErrorString)();
  aiReturn (*getMaterialString)(const aiMaterial*, const char*, unsigned, unsigned, aiString*);
  aiReturn (*getMaterialColor)(const aiMaterial*, const char*, unsigned, unsigned, aiColor4D*);
  aiReturn (*getMaterialFloatArray)(const aiMaterial*, const char*, unsigned, unsigned, ai_real*,
                                    unsigned*);
  aiReturn (*getMaterialIntegerArray)(const aiMaterial*, const char*, unsigned, unsigned, int*,
                                      unsigned*);
  unsigned (*getMaterialTextureCount)(const aiMaterial*, aiTextureType);
  aiReturn (*getMaterialTexture)(const aiMaterial*, aiTextureType, unsigned, aiString*,
                                 aiTextureMapping*, unsigned*, ai_real*, aiTextureOp*,
                                 aiTextureMapMode*, unsigned*);
};

/// Opens the library at the first call. Errors: RunError if it is not installed.
const AssimpLibrary& assimpLibrary();

}  // namespace radiosity
