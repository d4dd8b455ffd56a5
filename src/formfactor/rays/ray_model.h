// Constants of the model by which rays are foreseen, handed out and judged: fitted to scenes or
// taken from theory. tests/bench shows what they are worth: tools/bench --only choice.
#pragma once

namespace radiosity {

/// Error squared falls as n^-kUsualOrder with the number n of rays, if no better order is known.
/// (In four dimensions scrambled nets reach n^-5/4 on integrands that jump, as visibility does: He
/// & Wang, "On the convergence rate of randomized quasi-Monte Carlo for discontinuous functions",
/// SIAM J. Numer. Anal. 53, 2015.)
inline constexpr double kUsualOrder = 1.25;

// ---- The forecast (ray_estimate.cpp)

/// Merging with the other rows' counts takes about half off the square of an error.
inline constexpr double kMerged = 0.5;
/// Allows for rounding rays up to numbers that suit the net, and for the rough errors of a round:
/// with it, of 28 files that others made .7 to 1.1 times the rays are foreseen that they take. (By
/// the order that each sample shows, and not kUsualOrder, .7 to 1.45 times: it is too rough.)
inline constexpr double kRaysRoundedUp = 1.5;
/// Beyond the most rays that a sampled row is cast with, entries grow at most with this power of
/// the rays: few new ones are found.
inline constexpr double kNewEntries = 0.3;
/// Seconds for counting, merging and closing an entry of the rows, beside the rays.
inline constexpr double kEntrySeconds = 12e-9;

/// Exact rows of emitters may be this much work (RoomForExactRows) for each ray: about half of what
/// it takes.
inline constexpr double kExactWorkARay = 7;

// ---- The rounds (ray_rounds.cpp)

/// Bounds of the order that two rounds show.
inline constexpr double kLeastOrder = 0.9;
inline constexpr double kMostOrder = 2.5;
/// Rows aim at this share of the tolerance, since errors are known to some per cent only.
inline constexpr double kAimedShare = 0.95;

// ---- The error of a row (row_accuracy.cpp)

/// Entries for each independent normal term, about, where entries count as the square of their sum
/// over the sum of their squares: neighbours share the border that rays fall to either side of.
/// (Of the rows of three scenes by others, three seeds each, at 1,000 patches and 1e-2, 98.9 to
/// 100% are below their figures with it, and 97.3% in the worst with 3.)
inline constexpr double kEntriesATerm = 5;
/// Rows with one degree of freedom each, as far off as foreseen, that all scenes have beside their
/// own: next to nothing among hundreds, and what keeps two plates from stopping by chance.
inline constexpr double kUsualRows = 4;
/// Rows with fewer hits than this are patch (RowAccuracy::isUnknown()): by their root, so few are
/// off by a quarter and more.
inline constexpr double kFewHits = 16;
/// Of n scrambled points in four dimensions about n^(3/4) lie in cells that a border runs through.
inline constexpr double kGain = 0.25;

}  // namespace radiosity
