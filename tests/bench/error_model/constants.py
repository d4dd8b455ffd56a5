"""The fitted constants of the exact method, and the header that holds them.

The meaning, the place and the origin of each constant stand here; its value stands in
constants.csv. Both together make src/formfactor/exact/error_model.h.
"""
import csv
import dataclasses
import pathlib
import textwrap

FOLDER = pathlib.Path(__file__).resolve().parent
RECORD = FOLDER / "constants.csv"
HEADER = FOLDER.parents[2] / "src/formfactor/exact/error_model.h"
WIDTH = 100

INTRODUCTION = """\
// Every constant of the exact method that was fitted to observed errors.
//
// This file is written by tests/bench/error_model.py --write; do not edit it: a test compares it
// with the text in tests/bench/error_model/constants.py and the values in constants.csv beside it.
// That script also refits constants: it samples what each decides in scenes that it names, holds it
// against converged values, and scores it on other scenes. The table is in tests/bench/README.md; a
// value is held until another one is shown to be better. Rules by which constants are refitted:
//
"""
INCLUDES = """\
#pragma once

#include <array>
#include <limits>

namespace radiosity {
"""


@dataclasses.dataclass
class Constant:
    name: str
    what: str  # what it multiplies, and where
    rule: str = ""  # by which it is refitted; empty: set by hand
    reason: str = ""  # why it is set by hand
    type: str = "double"


GROUPS = [
    ("Cells (occluded/cell_error.cpp): the error of a cell's mean residual. `change` is "
     "CellValues::change, `whole` the mean of the whole form factor. seen() and unseen() add up in "
     "squares to the cautious estimate.", [
        Constant("kCellFlat", "Share of `whole` below which a cell's values differ by nothing: "
                 "CellValues::flat(), and the border of flatShare().",
                 reason="it separates kinds of cells, for which the constants below are fitted."),
        Constant("kCellSmooth4", "Times first differences of 2 x 2 points, shadows of one shape: "
                 "seen().", rule="cell"),
        Constant("kCellKinked4", "The same where shapes differ.", rule="cell"),
        Constant("kCellSmooth9", "Times second differences of 3 x 3 points, shadows of one shape: "
                 "seen().", rule="cell"),
        Constant("kCellKinked9", "The same where shapes differ.", rule="cell"),
        Constant("kCellSlope9", "Times first differences of 3 x 3 points: seen().", rule="cell"),
        Constant("kCellUnseenFlat4", "Times change * whole, 2 x 2 points, flat cells: unseen().",
                 rule="cell"),
        Constant("kCellUnseenKinked4", "The same where shapes differ, so that differences may be "
                 "small by chance.", rule="cell"),
        Constant("kCellUnseenSmooth4", "The same where there seems to be no kink.", rule="cell"),
        Constant("kCellUnseenFlat9", "Times change * whole, 3 x 3 points, flat cells: unseen().",
                 rule="cell"),
        Constant("kCellUnseenKinked9", "The same where shapes differ.", rule="cell"),
        Constant("kCellUnseenSmooth9", "The same where there seems to be no kink.", rule="cell"),
        Constant("kCellStrong4", "Times whole * side: the seen part at which kinks are as strong as "
                 "it says, 2 x 2 points: meanError(), stated.", rule="stated"),
        Constant("kCellStrong9", "The same for 3 x 3 points.", rule="stated"),
        Constant("kCellStrongest", "Most that the seen part is over that, squared: meanError(), "
                 "stated.", reason="a cap, reached by one cell in a hundred."),
        Constant("kCellInside4", "Times the unseen part of a flat cell with the shadow's edge well "
                 "inside the target, 2 x 2 points: flatShare(), stated.", rule="stated"),
        Constant("kCellInside9", "The same for 3 x 3 points.", rule="stated"),
        Constant("kCellBorder4", "Times the unseen part of a flat cell with the edge at the border "
                 "or not seen, 2 x 2 points: flatShare(), stated.", rule="stated"),
        Constant("kCellBorder9", "The same for 3 x 3 points where shapes differ, over the root of "
                 "the cell's side.", rule="stated"),
        Constant("kCellOutside", "Times the largest residual near the corners: "
                 "meanErrorOutside().", rule="outside"),
        Constant("kCellReassured", "Times the error guessed before the corners were looked from: "
                 "meanErrorOutside().", rule="outside"),
        Constant("kMostChange", "Largest change that counts: changeIn(). Shadows that come and go "
                 "faster are steps, seen or missed alike.",
                 reason="the other constants of cells are fitted with it."),
     ]),
    ("Pairs (occluded/adaptive_integrator.cpp, pair_sampling.cpp, occluded_pairs.cpp).", [
        Constant("kPairExpected4", "Times the change: root mean square of the error of a visible "
                 "fraction by 2 x 2 points: expectedError().", rule="expected"),
        Constant("kPairNear", "Targets nearer than so many of their radii are near: "
                 "VisibleFraction::near.",
                 reason="it separates kinds of parts between critical lines."),
        Constant("kPairDoubtful", "Share of what is accepted above which a cell's estimate is "
                 "looked at from the corners, too: lookOutside().",
                 reason="it trades points for rows above their figure. (A block in a room, 162 "
                 "patches, 1e-3: 7 rows were where only cells that would be cut were looked at so, "
                 "all for cells in which every point saw everything. It takes 0 to 2% more "
                 "points.)"),
        Constant("kPairThin", "Share of its radius below which a body's thickness makes it thin: "
                 "EdgeDistances.", reason="it separates kinds of bodies."),
        Constant("kPairEdgeOn", "Times the change, past a thin body seen edge-on: "
                 "PairPreparation.",
                 reason="too few pairs of the scenes named. (Blades 1 : 40 and 1 : 400 in a room, "
                 "1e-4: 82% of rows are below their figure without, 91% with a factor of 2 and 99% "
                 "with 4; points 728, 662 and 664 thousand.)", type="float"),
        Constant("kPairFewBlockers", "Bodies past which one that is thin and edge-on matters: "
                 "PairPreparation. Past more it is as good as lost among the others, and mostly "
                 "part of a surface that is not thin.", reason="as kPairEdgeOn.",
                 type="unsigned"),
        Constant("kPairMost", "Times the tolerance: what a single entry may be off by: "
                 "allowedError(). The tolerance is for the root mean square over a row's entries; "
                 "few entries are occluded, and of those few are near what they may be.",
                 reason="it trades time for error: what --tolerance means."),
        Constant("kPairMargin", "Times a pair's error as its cells state it: OccludedKernel. Those "
                 "are root mean squares over all pairs of a scene, and rows have luck of their own: "
                 "their points and the shadows' edges that pass them are common to many of their "
                 "pairs, the more so where a scene is symmetric and pairs are alike.", rule="margin"),
        Constant("kPairResolved", "Share of the unoccluded exchange that points may miss, and be "
                 "believed: OccludedKernel.",
                 reason="it separates pairs by what is done with them. (Of pairs that miss by "
                 "less, 1% are off by more than they state; by more, 10% to 25% are, up to a "
                 "hundred times. These are 1% of the pairs of ordinary scenes and 15% of a scan "
                 "with slivers.)"),
     ]),
    ("Parts between critical lines (occluded/part_error.cpp). What the rules of 2 x 2 and 3 x 3 "
     "points differ by, times the largest of these, decides about halving.", [
        Constant("kPartWorth", "Times what is accepted: error of the first rule, a part, from which "
                 "on a pair is cut: cutAtLines(). A part takes 13 points of which no other pair has "
                 "a share.",
                 reason="it trades points of one kind for another's. (Closed Cornell box, 985 "
                 "patches, 1e-5: 3.1 million points and an error of 3.3e-7; 5.1 million and 1.5e-6 "
                 "where pairs that miss by less than ten times are halved.)"),
        Constant("kPartOrder", "Times the root of the difference's share of the values, smooth "
                 "parts: the rules are of order four and six in a part's size over the length on "
                 "which values change.", rule="part"),
        Constant("kPartFactor", "Times the difference over that between the first rule and a "
                 "single point: where a pole lies beside a part, rules gain the same factor with "
                 "every order.", reason="it is what a geometric series says."),
        Constant("kPartLeast", "Least share of the difference: differences are small by chance, "
                 "too.",
                 reason="what it guards against is in few parts. (A cube in a cube, 200 patches, "
                 "whose pairs are all alike, so that none makes up for another: the worst row at "
                 "1e-5 is off by 2.7 times its figure; with kPartOrder alone and a least share of "
                 ".02, by 5.2 times.)"),
        Constant("kPartLeastDoubtful", "The same where shapes differ, mostly because an edge of a "
                 "shadow touches a corner of the target all along, and is here or there by "
                 "rounding; or where the target is near: the form factor itself changes much along "
                 "the part, and two rules may agree and both be wrong.", rule="part"),
        Constant("kPartOverlap", "The share where shadows overlap: edges of two may cross on an "
                 "edge of the target, along a curve, and of a kink rules of few points miss as much "
                 "as they see.", rule="part"),
        Constant("kPartStated", "Times what decides about halving: what is stated of parts that "
                 "pass, for these are mostly better.", rule="part"),
     ]),
    ("Kernels for far targets (clip_kernels.h; occluded/adaptive_integrator.cpp, "
     "occluded_pairs.cpp).", [
        Constant("kFarError", "Times (h/r)^3: bound on the relative error of the form factor to a "
                 "target whose farthest corner is h from its middle, at distance r, where neither is "
                 "nearer than h to the other's plane: ClipKernels::far.", rule="bound"),
        Constant("kFarShare", "Times kFarError: root mean square of what these kernels leave out of "
                 "a half visible target's fraction: VisibleFraction::far_error.", rule="far"),
        Constant("kFarMost", "Times the tolerance: most that they may add to a visible fraction's "
                 "error: OccludedKernel.",
                 reason="it trades time for error: at 1e-3 these kernels begin 8 radii away. Of "
                 "most targets what they add is a tenth of this and of either sign, and none of it "
                 "is seen in the error of the matrix. (From 4 radii on, it would add 4% to that of "
                 "a cluttered scene.)"),
     ]),
    ("Pairs with nothing in between (unoccluded/far_kernels.h, near_exchange.cpp, contour.cpp).", [
        Constant("kSeriesError", "Times R^2: bound on the relative error of the second-order "
                 "series: FarLimits.", rule="bound"),
        Constant("kSkewError", "Times skew R^(3/2): the same of elements that are no "
                 "parallelograms.", rule="bound"),
        Constant("kSkewFactor", "Times the skew, up to 1: how much of a triangle an element is, for "
                 "the rules: FarLimits.",
                 reason="it interpolates between the constants of parallelograms and triangles."),
        Constant("kRuleError", "Times R^order: bound on the relative error of rule k for "
                 "parallelograms: FarLimits.", rule="bound", type="rules"),
        Constant("kSkewRuleError", "Times R^(order - 1/2): the same for triangles. `kNever`: the "
                 "rule is for parallelograms only, for in it densities that are not constant count "
                 "as degrees.", rule="bound", type="rules"),
        Constant("kStroudOrder", "Exponent of R in the error of Stroud's rule, where elements touch "
                 "the other's plane: FarRule::order.", rule="order"),
        Constant("kLambertError", "Times ratio^(2n - 1): bound on the relative error of Lambert's "
                 "formula over n x n points: pointsFor().", rule="bound"),
        Constant("kTanhSinhDigits", "Over the step: natural digits that tanh-sinh quadrature has of "
                 "a logarithm at the end: chooseRule().", rule="digits"),
     ]),
    ("Points foreseen (occluded/occluded_cost.cpp).", [
        Constant("kPointsMore", "Times what the first rule is expected to miss, in what is "
                 "accepted: points that are added to it. Of the parts of an element those are cut "
                 "again that a kink passes, twice as many each time, and what each adds to the "
                 "error falls to a third.", rule="points"),
        Constant("kPointsParts", "Times 13: points of a pair whose element is cut along critical "
                 "lines.", reason="too few runs of the scenes named need it."),
    ]),
    ("Rows (assembly/error_figure.cpp).", [
        Constant("kRowClosedForms", "Times the published accuracy of closed forms: their error, "
                 "over a row: ErrorSums. The accuracy is a bound, which the worst pair comes near.",
                 rule="closed"),
        Constant("kRowAlike", "Times ErrorSums::recheckRatio(), before it raises figures: pairs of "
                 "a real row are more alike than pairs drawn from all.", rule="alike"),
     ]),
]

RULES = {
    "cell": "squares of cells' errors, found, are those of the cautious estimate, by greatest "
            "likelihood",
    "stated": "sums of squares of errors, found and stated, of cells that are kept are alike",
    "outside": "as cell, of cells that are looked at from near their corners, too",
    "expected": "root mean square of errors over changes",
    "margin": "99 of 100 rows are below their figure, before it is raised",
    "part": "sums of squares of errors of parts, found and estimated, are alike",
    "bound": "the largest found among random pairs of all shapes and placements",
    "far": "root mean square over targets 2 to 4 radii away",
    "order": "slope, in logarithms, of the largest errors over R",
    "digits": "the least of all levels, down to rounding",
    "points": "points counted are points foreseen, where no element is cut along lines",
    "closed": "99 of 100 rows are below it",
    "alike": "what 99 of 100 rows stay below, over what is drawn: the median of runs",
}

CONSTANTS = [constant for _, group in GROUPS for constant in group]


def read_record():
    """Rows of constants.csv by the constant's name."""
    with RECORD.open(newline="") as file:
        return {row["constant"]: row for row in csv.DictReader(file)}


def write_record(record):
    columns = ["constant", "value", "refitted", "training", "scoring", "with_refitted"]
    with RECORD.open("w", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        for constant in CONSTANTS:
            writer.writerow(record[constant.name])


def numbers(text):
    """The values of a constant, as the record has them."""
    return [float("inf") if word == "kNever" else float(word) for word in text.split()]


def comment(text, lead):
    return textwrap.wrap(text, WIDTH, initial_indent=lead, subsequent_indent=lead,
                         break_long_words=False, break_on_hyphens=False)


def definition(constant, value):
    if constant.type == "rules":
        return [f"inline constexpr std::array<double, 5> {constant.name} = "
                f"{{{', '.join(value.split())}}};"]
    suffix = "F" if constant.type == "float" and "." in value else ""
    return [f"inline constexpr {constant.type} {constant.name} = {value}{suffix};"]


def header(record):
    """The text of error_model.h."""
    lines = INTRODUCTION.splitlines()
    for rule, text in RULES.items():
        lines += textwrap.wrap(f"{rule}: {text}", WIDTH, initial_indent="//   ",
                               subsequent_indent="//     ")
    lines += INCLUDES.splitlines() + [""]
    for title, group in GROUPS:
        lines += comment(title, "// ") + [""]
        for constant in group:
            obtained = (f"Rule: {constant.rule}." if constant.rule else
                        f"Set by hand: {constant.reason}")
            lines += comment(f"{constant.what} {obtained}", "/// ")
            if constant.name == "kSkewRuleError":
                lines.append("inline constexpr double kNever = "
                             "std::numeric_limits<double>::infinity();")
            lines += definition(constant, record[constant.name]["value"]) + [""]
    lines.append("}  // namespace radiosity")
    return "\n".join(lines) + "\n"
