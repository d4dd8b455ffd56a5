// The foreseen cost of the exact method, as ratios of work.
#pragma once

namespace radiosity {

// These are not times: announced seconds come from a sample that is timed where it runs
// (row_times.h). The unit is a twelfth of a clip, which makes all others round. The ratios were
// measured once, on a core with vectors of 512 bits.

/// A clip: from one point, one occluder's shadow cut out of one target.
inline constexpr double kClipWork = 12;
/// Added for each edge of an occluder that a point looks past. (With kClipWork, points of a
/// cluttered scene of 20,000 patches and past the 300 edges of round bodies took from 0.6 to 1.5
/// times the work foreseen.)
inline constexpr double kEdgeWork = 0.35;
/// At most this many clips count for a point, however many occluders may stand in between: the
/// shadows of most of them miss the target.
inline constexpr double kMostClips = 4;
/// The work of a point between critical lines, in double precision and shared with no other pair,
/// over that of a point in a cell.
inline constexpr double kPartPointWork = 2;
/// A pair in closed form or by quadrature, with the unneeded values computed beside it.
inline constexpr double kUnoccludedWork = 5;
/// A test whether something stands between two clusters or elements.
inline constexpr double kShaftTestWork = 9;

}  // namespace radiosity
