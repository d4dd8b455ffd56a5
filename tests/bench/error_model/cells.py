"""The error model of cells (cell_error.cpp), anew, and its refitting."""
import math

import numpy as np
from scipy.optimize import minimize

LEAST = 30  # samples that a constant is refitted to, at least
REACH = 4  # logarithms that a search may go from the value held


def is_flat(cells, held):
    all_or_nothing = (cells.fraction <= 0) | (cells.fraction >= 1)
    return all_or_nothing | (np.ptp(cells.r, axis=0) < held["kCellFlat"])


def is_one_shape(cells):
    return cells.one_shape > 0


def seen_parts(cells):
    """The factors of kCellSmooth and kCellKinked, and of kCellSlope9."""
    r = cells.r
    if len(r) == 4:
        along_u = abs(r[1] - r[0]) + abs(r[3] - r[2])
        along_v = abs(r[2] - r[0]) + abs(r[3] - r[1])
        return 0.5 * (along_u + along_v), np.zeros(r.shape[1])
    bend = np.zeros(r.shape[1])
    slope = np.zeros(r.shape[1])
    for k, weight in enumerate((5 / 18, 8 / 18, 5 / 18)):
        row, column = r[3 * k:3 * k + 3], r[k::3]
        bend += weight * (abs(row[0] - 2 * row[1] + row[2]) +
                          abs(column[0] - 2 * column[1] + column[2]))
        slope += weight * (abs(row[2] - row[0]) + abs(column[2] - column[0]))
    return bend, slope


def cell_names(cells):
    count = str(len(cells.r))
    seen = ["kCellSmooth" + count, "kCellKinked" + count]
    unseen = ["kCellUnseen" + kind + count for kind in ("Smooth", "Kinked", "Flat")]
    return seen, unseen, "kCellSlope9" if count == "9" else None


def cell_estimate(cells, held):
    """Seen and unseen part of the cautious estimate."""
    (smooth, kinked), unseen, slope_name = cell_names(cells)
    one = is_one_shape(cells)
    bend, slope = seen_parts(cells)
    seen = bend * np.where(one, held[smooth], held[kinked])
    if slope_name:
        seen += slope * np.where((cells.may_cross > 0) & ~one, held[kinked], held[slope_name])
    share = np.where(one, held[unseen[0]], held[unseen[1]])
    share = np.where(is_flat(cells, held), held[unseen[2]], share)
    return seen, share * cells.change


def flat_share(cells, held):
    count = len(cells.r)
    one = is_one_shape(cells)
    border = np.where(one, 0, held["kCellFlat"])
    inside = (border < cells.fraction) & (cells.fraction < 1 - border)
    if count == 4:
        at_border = np.full(one.shape, held["kCellBorder4"])
    else:
        at_border = np.where(one, 1, held["kCellBorder9"] * 2 ** (cells.level / 2))
    one_shadow = np.where(cells.one_occluder > 0, held[f"kCellInside{count}"], 1)
    return np.where(inside, one_shadow, at_border), inside


def strength(cells, held):
    """The stated error of the seen part, over that part."""
    count = len(cells.r)
    seen, _ = cell_estimate(cells, held)
    strong = held[f"kCellStrong{count}"] * 2.0 ** -cells.level
    factor = np.sqrt(np.minimum(seen / strong, held["kCellStrongest"]))
    return np.where(~is_one_shape(cells) & (cells.may_cross == 0), factor, 1)


def stated_estimate(cells, held):
    seen, unseen = cell_estimate(cells, held)
    share = np.where(is_flat(cells, held), flat_share(cells, held)[0], 1)
    return np.hypot(strength(cells, held) * seen, share * unseen)


def check_cells(samples, held):
    """The formulas above are the library's, as it was built with the values held."""
    for cells in (samples.cell4, samples.cell9):
        cautious = np.hypot(*cell_estimate(cells, held))
        if not (np.allclose(cautious, cells.cautious, rtol=1e-6) and
                np.allclose(stated_estimate(cells, held), cells.stated, rtol=1e-6)):
            raise SystemExit("error_model: error_samples was built with other constants, or "
                             "cell_error.cpp has other formulas than fits.py")


def greatest_likelihood(names, held, model, errors):
    """Values of `names` for which squares of errors scatter about model(values)^2 as counts do: the
    condition is that their sums are alike, for each constant where it matters. (Quasi-likelihood
    with a variance that is proportional to the mean, Wedderburn 1974.) NaN where the search runs to
    its end or stays where it is: the samples do not determine the constant."""
    squares = errors**2
    least = 1e-9 * squares.mean()

    def loss(logs):
        values = held | dict(zip(names, np.exp(logs)))
        expected = model(values)**2 + least
        return (expected - squares * np.log(expected)).sum() / squares.sum()

    start = np.log([held[name] for name in names])
    found = minimize(loss, start, method="L-BFGS-B", bounds=[(x - REACH, x + REACH) for x in start])
    moved = abs(found.x - start)
    determined = (moved > 1e-9) & (moved < REACH - 0.05)
    return dict(zip(names, np.where(determined, np.exp(found.x), math.nan)))


def refit_cells(samples, held):
    values = {}
    for cells in (samples.cell4, samples.cell9):
        seen, unseen, slope = cell_names(cells)
        names = seen + unseen + ([slope] if slope else [])
        if len(cells.error) >= LEAST:
            values |= greatest_likelihood(
                names, held, lambda v, cells=cells: np.hypot(*cell_estimate(cells, v)), cells.error)
    return values


def ratio_of_sums(errors, estimates):
    """The factor of estimates that equates sums of squares."""
    if len(errors) < LEAST or not (estimates**2).sum() > 0:
        return math.nan
    return math.sqrt((errors**2).sum() / (estimates**2).sum())


def refit_strong(cells, held):
    """kCellStrong that equates sums of squares, stated and found; by bisection, for the stated one
    falls with it."""
    name = f"kCellStrong{len(cells.r)}"
    if len(cells.error) < LEAST:
        return math.nan
    low, high = held[name] / 50, held[name] * 50
    wanted = (cells.error**2).sum()
    for _ in range(60):
        middle = math.sqrt(low * high)
        stated = (stated_estimate(cells, held | {name: middle})**2).sum()
        low, high = (middle, high) if stated > wanted else (low, middle)
    return low
