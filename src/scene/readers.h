// The readers of scene files.
#pragma once

#include <string>

#include "radiosity/scene.h"

namespace radiosity {

/// Wavefront OBJ with its MTL files; file units, overrides not yet applied.
Scene loadObj(const std::string& path, const SceneOptions& options);

/// glTF 2.0, .gltf or .glb; metres, overrides not yet applied.
Scene loadGltf(const std::string& path, const SceneOptions& options);

/// Radiance scene, .rad, its commands expanded; file units, overrides not yet applied.
Scene loadRadiance(const std::string& path, const SceneOptions& options);

/// STL, ASCII or binary by the content; file units, overrides not yet applied.
Scene loadStl(const std::string& path, const SceneOptions& options);

/// View3D input, .vs3 or .v3d, F = 3 or 3a; file units, overrides not yet applied.
Scene loadView3d(const std::string& path, const SceneOptions& options);

/// Gmsh .msh, versions 2.2 and 4.1, ASCII or binary; file units, overrides not yet applied.
Scene loadGmsh(const std::string& path, const SceneOptions& options);

/// CalculiX or Abaqus input, .inp; file units, overrides not yet applied.
Scene loadInp(const std::string& path, const SceneOptions& options);

/// PLY, ASCII or binary; file units, overrides not yet applied.
Scene loadPly(const std::string& path, const SceneOptions& options);

/// Legacy .vtk, POLYDATA or UNSTRUCTURED_GRID; file units, overrides not yet applied.
Scene loadVtk(const std::string& path, const SceneOptions& options);

/// XML .vtp or .vtu; file units, overrides not yet applied.
Scene loadVtkXml(const std::string& path, const SceneOptions& options);

/// OFF, in text; file units, overrides not yet applied.
Scene loadOff(const std::string& path, const SceneOptions& options);

/// 3MF; scene.unit as the file names it, overrides not yet applied.
Scene load3mf(const std::string& path, const SceneOptions& options);

/// Collada, FBX, 3DS, IFC, DXF by Assimp; Collada, FBX and IFC in metres, else file units,
/// overrides not yet applied.
Scene loadAssimp(const std::string& path, const SceneOptions& options);

}  // namespace radiosity
