// Every constant of the exact method that was fitted to observed errors.
//
// This file is written by tests/bench/error_model.py --write; do not edit it: a test compares it
// with the text in tests/bench/error_model/constants.py and the values in constants.csv beside it.
// That script also refits constants: it samples what each decides in scenes that it names, holds it
// against converged values, and scores it on other scenes. The table is in tests/bench/README.md; a
// value is held until another one is shown to be better. Rules by which constants are refitted:
//
//   cell: squares of cells' errors, found, are those of the cautious estimate, by greatest
//     likelihood
//   stated: sums of squares of errors, found and stated, of cells that are kept are alike
//   outside: as cell, of cells that are looked at from near their corners, too
//   expected: root mean square of errors over changes
//   margin: 99 of 100 rows are below their figure, before it is raised
//   part: sums of squares of errors of parts, found and estimated, are alike
//   bound: the largest found among random pairs of all shapes and placements
//   far: root mean square over targets 2 to 4 radii away
//   order: slope, in logarithms, of the largest errors over R
//   digits: the least of all levels, down to rounding
//   points: points counted are points foreseen, where no element is cut along lines
//   closed: 99 of 100 rows are below it
//   alike: what 99 of 100 rows stay below, over what is drawn: the median of runs
#pragma once

#include <array>
#include <limits>

namespace radiosity {

// Cells (occluded/cell_error.cpp): the error of a cell's mean residual. `change` is
// CellValues::change, `whole` the mean of the whole form factor. seen() and unseen() add up in
// squares to the cautious estimate.

/// Share of `whole` below which a cell's values differ by nothing: CellValues::flat(), and the
/// border of flatShare(). Set by hand: it separates kinds of cells, for which the constants below
/// are fitted.
inline constexpr double kCellFlat = 0.05;

/// Times first differences of 2 x 2 points, shadows of one shape: seen(). Rule: cell.
inline constexpr double kCellSmooth4 = 0.010;

/// The same where shapes differ. Rule: cell.
inline constexpr double kCellKinked4 = 0.038;

/// Times second differences of 3 x 3 points, shadows of one shape: seen(). Rule: cell.
inline constexpr double kCellSmooth9 = 0.003;

/// The same where shapes differ. Rule: cell.
inline constexpr double kCellKinked9 = 0.022;

/// Times first differences of 3 x 3 points: seen(). Rule: cell.
inline constexpr double kCellSlope9 = 0.002;

/// Times change * whole, 2 x 2 points, flat cells: unseen(). Rule: cell.
inline constexpr double kCellUnseenFlat4 = 0.008;

/// The same where shapes differ, so that differences may be small by chance. Rule: cell.
inline constexpr double kCellUnseenKinked4 = 0.008;

/// The same where there seems to be no kink. Rule: cell.
inline constexpr double kCellUnseenSmooth4 = 0.003;

/// Times change * whole, 3 x 3 points, flat cells: unseen(). Rule: cell.
inline constexpr double kCellUnseenFlat9 = 0.004;

/// The same where shapes differ. Rule: cell.
inline constexpr double kCellUnseenKinked9 = 0.002;

/// The same where there seems to be no kink. Rule: cell.
inline constexpr double kCellUnseenSmooth9 = 0.0006;

/// Times whole * side: the seen part at which kinks are as strong as it says, 2 x 2 points:
/// meanError(), stated. Rule: stated.
inline constexpr double kCellStrong4 = 0.0163;

/// The same for 3 x 3 points. Rule: stated.
inline constexpr double kCellStrong9 = 0.0067;

/// Most that the seen part is over that, squared: meanError(), stated. Set by hand: a cap, reached
/// by one cell in a hundred.
inline constexpr double kCellStrongest = 6;

/// Times the unseen part of a flat cell with the shadow's edge well inside the target, 2 x 2
/// points: flatShare(), stated. Rule: stated.
inline constexpr double kCellInside4 = 0.36;

/// The same for 3 x 3 points. Rule: stated.
inline constexpr double kCellInside9 = 0.22;

/// Times the unseen part of a flat cell with the edge at the border or not seen, 2 x 2 points:
/// flatShare(), stated. Rule: stated.
inline constexpr double kCellBorder4 = 1.25;

/// The same for 3 x 3 points where shapes differ, over the root of the cell's side. Rule: stated.
inline constexpr double kCellBorder9 = 0.75;

/// Times the largest residual near the corners: meanErrorOutside(). Rule: outside.
inline constexpr double kCellOutside = 0.0135;

/// Times the error guessed before the corners were looked from: meanErrorOutside(). Rule: outside.
inline constexpr double kCellReassured = 0.2;

/// Largest change that counts: changeIn(). Shadows that come and go faster are steps, seen or
/// missed alike. Set by hand: the other constants of cells are fitted with it.
inline constexpr double kMostChange = 5;

// Pairs (occluded/adaptive_integrator.cpp, pair_sampling.cpp, occluded_pairs.cpp).

/// Times the change: root mean square of the error of a visible fraction by 2 x 2 points:
/// expectedError(). Rule: expected.
inline constexpr double kPairExpected4 = 0.009;

/// Targets nearer than so many of their radii are near: VisibleFraction::near. Set by hand: it
/// separates kinds of parts between critical lines.
inline constexpr double kPairNear = 4;

/// Share of what is accepted above which a cell's estimate is looked at from the corners, too:
/// lookOutside(). Set by hand: it trades points for rows above their figure. (A block in a room,
/// 162 patches, 1e-3: 7 rows were where only cells that would be cut were looked at so, all for
/// cells in which every point saw everything. It takes 0 to 2% more points.)
inline constexpr double kPairDoubtful = 0.7;

/// Share of its radius below which a body's thickness makes it thin: EdgeDistances. Set by hand: it
/// separates kinds of bodies.
inline constexpr double kPairThin = 0.1;

/// Times the change, past a thin body seen edge-on: PairPreparation. Set by hand: too few pairs of
/// the scenes named. (Blades 1 : 40 and 1 : 400 in a room, 1e-4: 82% of rows are below their figure
/// without, 91% with a factor of 2 and 99% with 4; points 728, 662 and 664 thousand.)
inline constexpr float kPairEdgeOn = 4;

/// Bodies past which one that is thin and edge-on matters: PairPreparation. Past more it is as good
/// as lost among the others, and mostly part of a surface that is not thin. Set by hand: as
/// kPairEdgeOn.
inline constexpr unsigned kPairFewBlockers = 2;

/// Times the tolerance: what a single entry may be off by: allowedError(). The tolerance is for the
/// root mean square over a row's entries; few entries are occluded, and of those few are near what
/// they may be. Set by hand: it trades time for error: what --tolerance means.
inline constexpr double kPairMost = 12;

/// Times a pair's error as its cells state it: OccludedKernel. Those are root mean squares over all
/// pairs of a scene, and rows have luck of their own: their points and the shadows' edges that pass
/// them are common to many of their pairs, the more so where a scene is symmetric and pairs are
/// alike. Rule: margin.
inline constexpr double kPairMargin = 2.2;

/// Share of the unoccluded exchange that points may miss, and be believed: OccludedKernel. Set by
/// hand: it separates pairs by what is done with them. (Of pairs that miss by less, 1% are off by
/// more than they state; by more, 10% to 25% are, up to a hundred times. These are 1% of the pairs
/// of ordinary scenes and 15% of a scan with slivers.)
inline constexpr double kPairResolved = 0.01;

// Parts between critical lines (occluded/part_error.cpp). What the rules of 2 x 2 and 3 x 3 points
// differ by, times the largest of these, decides about halving.

/// Times what is accepted: error of the first rule, a part, from which on a pair is cut:
/// cutAtLines(). A part takes 13 points of which no other pair has a share. Set by hand: it trades
/// points of one kind for another's. (Closed Cornell box, 985 patches, 1e-5: 3.1 million points and
/// an error of 3.3e-7; 5.1 million and 1.5e-6 where pairs that miss by less than ten times are
/// halved.)
inline constexpr double kPartWorth = 1.5;

/// Times the root of the difference's share of the values, smooth parts: the rules are of order
/// four and six in a part's size over the length on which values change. Rule: part.
inline constexpr double kPartOrder = 0.3;

/// Times the difference over that between the first rule and a single point: where a pole lies
/// beside a part, rules gain the same factor with every order. Set by hand: it is what a geometric
/// series says.
inline constexpr double kPartFactor = 1;

/// Least share of the difference: differences are small by chance, too. Set by hand: what it guards
/// against is in few parts. (A cube in a cube, 200 patches, whose pairs are all alike, so that none
/// makes up for another: the worst row at 1e-5 is off by 2.7 times its figure; with kPartOrder
/// alone and a least share of .02, by 5.2 times.)
inline constexpr double kPartLeast = 0.05;

/// The same where shapes differ, mostly because an edge of a shadow touches a corner of the target
/// all along, and is here or there by rounding; or where the target is near: the form factor itself
/// changes much along the part, and two rules may agree and both be wrong. Rule: part.
inline constexpr double kPartLeastDoubtful = 0.1;

/// The share where shadows overlap: edges of two may cross on an edge of the target, along a curve,
/// and of a kink rules of few points miss as much as they see. Rule: part.
inline constexpr double kPartOverlap = 1;

/// Times what decides about halving: what is stated of parts that pass, for these are mostly
/// better. Rule: part.
inline constexpr double kPartStated = 0.27;

// Kernels for far targets (clip_kernels.h; occluded/adaptive_integrator.cpp, occluded_pairs.cpp).

/// Times (h/r)^3: bound on the relative error of the form factor to a target whose farthest corner
/// is h from its middle, at distance r, where neither is nearer than h to the other's plane:
/// ClipKernels::far. Rule: bound.
inline constexpr double kFarError = 1;

/// Times kFarError: root mean square of what these kernels leave out of a half visible target's
/// fraction: VisibleFraction::far_error. Rule: far.
inline constexpr double kFarShare = 0.2;

/// Times the tolerance: most that they may add to a visible fraction's error: OccludedKernel. Set
/// by hand: it trades time for error: at 1e-3 these kernels begin 8 radii away. Of most targets
/// what they add is a tenth of this and of either sign, and none of it is seen in the error of the
/// matrix. (From 4 radii on, it would add 4% to that of a cluttered scene.)
inline constexpr double kFarMost = 2;

// Pairs with nothing in between (unoccluded/far_kernels.h, near_exchange.cpp, contour.cpp).

/// Times R^2: bound on the relative error of the second-order series: FarLimits. Rule: bound.
inline constexpr double kSeriesError = 1.7;

/// Times skew R^(3/2): the same of elements that are no parallelograms. Rule: bound.
inline constexpr double kSkewError = 6;

/// Times the skew, up to 1: how much of a triangle an element is, for the rules: FarLimits. Set by
/// hand: it interpolates between the constants of parallelograms and triangles.
inline constexpr double kSkewFactor = 2.5;

/// Times R^order: bound on the relative error of rule k for parallelograms: FarLimits. Rule: bound.
inline constexpr std::array<double, 5> kRuleError = {0.8, 0.22, 0.15, 0.02, 0.0025};

/// Times R^(order - 1/2): the same for triangles. `kNever`: the rule is for parallelograms only,
/// for in it densities that are not constant count as degrees. Rule: bound.
inline constexpr double kNever = std::numeric_limits<double>::infinity();
inline constexpr std::array<double, 5> kSkewRuleError = {6, kNever, 3, 0.4, 0.06};

/// Exponent of R in the error of Stroud's rule, where elements touch the other's plane:
/// FarRule::order. Rule: order.
inline constexpr double kStroudOrder = 2.75;

/// Times ratio^(2n - 1): bound on the relative error of Lambert's formula over n x n points:
/// pointsFor(). Rule: bound.
inline constexpr double kLambertError = 10;

/// Over the step: natural digits that tanh-sinh quadrature has of a logarithm at the end:
/// chooseRule(). Rule: digits.
inline constexpr double kTanhSinhDigits = 4.0;

// Points foreseen (occluded/occluded_cost.cpp).

/// Times what the first rule is expected to miss, in what is accepted: points that are added to it.
/// Of the parts of an element those are cut again that a kink passes, twice as many each time, and
/// what each adds to the error falls to a third. Rule: points.
inline constexpr double kPointsMore = 5;

/// Times 13: points of a pair whose element is cut along critical lines. Set by hand: too few runs
/// of the scenes named need it.
inline constexpr double kPointsParts = 5;

// Rows (assembly/error_figure.cpp).

/// Times the published accuracy of closed forms: their error, over a row: ErrorSums. The accuracy
/// is a bound, which the worst pair comes near. Rule: closed.
inline constexpr double kRowClosedForms = 0.06;

/// Times ErrorSums::recheckRatio(), before it raises figures: pairs of a real row are more alike
/// than pairs drawn from all. Rule: alike.
inline constexpr double kRowAlike = 1.75;

}  // namespace radiosity
