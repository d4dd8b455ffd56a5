// --lightmap: light as an image for the scene's own mesh.
#pragma once

#include "cli/commands.h"
#include "cli/element_use.h"

namespace radiosity::cli {

/// Throws InputError if --lightmap, its options or the other outputs contradict each other, before
/// any work is done.
void checkLightmap(const Request& request, const ElementUse& elements, const OutputSet& files);

/// Writes the map and the .glb among `files`, and reports the charts. `ev`: the exposure for the
/// scene.
void writeLightmap(Session& session, const Scene& scene, const PatchMesh& mesh,
                   const SurfaceLight& light, double ev, OutputSet& files);

}  // namespace radiosity::cli
