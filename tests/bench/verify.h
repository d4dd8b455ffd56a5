// Checks before anything is timed.
#pragma once

#include "bench_scenes.h"
#include "truth_rows.h"

namespace radiosity::bench {

/// Checks truth against independent estimates, and prints the results:
///   - some rows against rays (Embree, another code path and another principle): each entry's
///     number of hits against its binomial spread, and the shares of fronts;
///   - exchange areas of pairs of rows against each other (A_i F_ij = A_j F_ji).
/// Owen-scrambled points spread less than independent ones, so passing is expected and a single
/// wrong value of some standard deviations is not.
bool verifyTruth(const BenchScene& scene, const TruthRows& truth, double accuracy);

}  // namespace radiosity::bench
