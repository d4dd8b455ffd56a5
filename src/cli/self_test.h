// Whether this installation computes what it should, on this machine.
#pragma once

namespace radiosity::cli {

/// Computes what has a known answer: form factors of closed forms, a furnace by every method and
/// its picture; and writes and reads files with the libraries that are opened only then. Takes
/// seconds, prints a line a check. Errors: RunError with the first that fails.
void selfTest();

}  // namespace radiosity::cli
