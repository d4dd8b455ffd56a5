// The scene as other renderers read it, beside or in place of a picture of it.
#pragma once

#include "cli/commands.h"
#include "cli/picture.h"

namespace radiosity::cli {

/// Whether a scene for another program is asked for: .xml or .pbrt.
bool hasForeignScene(const OutputSet& files);

/// Whether nothing else is.
bool onlyForeignScenes(const OutputSet& files);

/// Refuses options that such scenes cannot follow, before the work is done.
void checkForeignScene(const Request& request, const OutputSet& files);

/// Writes the .xml and .pbrt among `files`, and the files that they name beside them. Notes what
/// the other program is not told.
void writeForeignScenes(Session& session, const Scene& scene, const Picture& picture,
                        OutputSet& files);

/// Writes all outputs of a run of which onlyForeignScenes() holds and the camera is known: no light
/// is computed. Returns the exit code.
int writeForeignScenesAlone(Session& session, const Scene& scene, const Picture& picture,
                            OutputSet& files);

}  // namespace radiosity::cli
