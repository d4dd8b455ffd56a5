// --lightmap: light as an image that is laid over the scene's own mesh.
#pragma once

#include "cli/commands.h"
#include "cli/element_use.h"

namespace radiosity::cli {

/// InputError where --lightmap, what goes with it or the other outputs contradict each other:
/// before the work is done.
void checkLightmap(const Request& request, const ElementUse& elements, const OutputSet& files);

/// Writes the map and the .glb among `files`, and reports the charts. `ev`: exposure that suits
/// the scene.
void writeLightmap(Session& session, const Scene& scene, const PatchMesh& mesh,
                   const SurfaceLight& light, double ev, OutputSet& files);

}  // namespace radiosity::cli
