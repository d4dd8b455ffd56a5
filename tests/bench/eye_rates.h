// Hemicubes a second by each eye.
#pragma once

namespace radiosity::bench {

/// Verifies that the processor's eye, OpenGL's and Embree see the same polygon in at least 99.9% of
/// pixels, then times them and prints one table. False where that failed, or where there is no
/// OpenGL.
bool benchEyes();

}  // namespace radiosity::bench
