// Rates of the hemicube beside Embree tracing the same pixels.
#pragma once

namespace radiosity::bench {

/// Verifies that both see the same polygon in at least 99.9% of pixels, then times both and prints
/// a table a scene. False where the check failed: that scene was not timed.
bool benchRates();

}  // namespace radiosity::bench
