// Rates of products with the exchange matrix beside copying and reading memory.
#pragma once

namespace radiosity::bench {

/// Verifies that products with constant columns are row sums, then times products on one thread and
/// on all and prints a table. False where the check failed: nothing was timed.
bool benchProducts();

}  // namespace radiosity::bench
