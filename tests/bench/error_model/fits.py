"""By constant: its cases, its error figures, and the value that fits samples."""
import dataclasses
import math
from collections.abc import Callable

import numpy as np

from cells import (LEAST, cell_estimate, flat_share, greatest_likelihood, is_flat, is_one_shape,
                   ratio_of_sums, refit_cells, refit_strong, stated_estimate)

TOP = 0.99  # share of rows that are to be below their figure


@dataclasses.dataclass
class Fit:
    errors: Callable  # (samples, held): errors of the constant's cases
    figures: Callable  # (samples, values): bounds of these errors
    refit: Callable  # (samples, held): the value or values


def cell_kind(count, kind):
    def chosen(samples, held):
        cells = getattr(samples, f"cell{count}")
        flat, one = is_flat(cells, held), is_one_shape(cells)
        return cells.where({"Flat": flat, "Smooth": ~flat & one, "Kinked": ~flat & ~one}[kind])
    return chosen


def kept(cells):
    return cells.where((cells.cautious <= cells.allowed) & (cells.outside < 0))


def cell_fit(count, kind):
    of_kind = cell_kind(count, kind)
    return lambda name: Fit(
        lambda s, held: of_kind(s, held).error,
        lambda s, v: v["kPairMargin"] * np.hypot(*cell_estimate(of_kind(s, v), v)),
        lambda s, held: refit_cells(s, held).get(name, math.nan))


def flat_fit(count, wanted):
    def chosen(samples, held):
        cells = kept(cell_kind(count, "Flat")(samples, held))
        inside = flat_share(cells, held)[1]
        if wanted == "inside":
            return cells.where(inside & (cells.one_occluder > 0))
        return cells.where(~inside & ((count == 4) | ~is_one_shape(cells)))

    def refit(samples, held, name):
        cells = chosen(samples, held)
        return held[name] * ratio_of_sums(cells.error, stated_estimate(cells, held))

    return lambda name: Fit(
        lambda s, held: chosen(s, held).error,
        lambda s, v: v["kPairMargin"] * stated_estimate(chosen(s, v), v),
        lambda s, held: refit(s, held, name))


def strong_fit(count):
    def chosen(samples, held):
        cells = kept(cell_kind(count, "Kinked")(samples, held))
        return cells.where(cells.may_cross == 0)

    return lambda name: Fit(
        lambda s, held: chosen(s, held).error,
        lambda s, v: v["kPairMargin"] * stated_estimate(chosen(s, v), v),
        lambda s, held: refit_strong(chosen(s, held), held))


def outside_fit(name):
    def chosen(samples):
        return samples.cell9.where(samples.cell9.outside >= 0)

    def model(cells, values):
        return np.maximum(values["kCellReassured"] * cells.cautious,
                          values["kCellOutside"] * cells.outside)

    def refit(samples, held):
        cells = chosen(samples)
        if len(cells.error) < LEAST:
            return math.nan
        return greatest_likelihood(["kCellOutside", "kCellReassured"], held,
                                   lambda v: model(cells, v), cells.error)[name]

    return Fit(lambda s, held: chosen(s).error,
               lambda s, v: v["kPairMargin"] * model(chosen(s), v), refit)


def expected_fit(name):
    def chosen(samples):
        return samples.cell4.where(samples.cell4.level == 0)

    return Fit(lambda s, held: chosen(s).error,
               lambda s, v: v["kPairMargin"] * v[name] * chosen(s).change,
               lambda s, held: ratio_of_sums(chosen(s).error, chosen(s).change))


def part_estimate(parts, values):
    """part_error.cpp, anew."""
    tiny = np.finfo(float).tiny
    difference = parts.difference
    before = np.maximum(np.maximum(parts.before, difference), tiny)
    by_order = values["kPartOrder"] * np.sqrt(difference / np.maximum(parts.values, tiny))
    least = np.where((parts.one_shape > 0) & (parts.near == 0), values["kPartLeast"],
                     values["kPartLeastDoubtful"])
    share = np.clip(np.maximum(values["kPartFactor"] * difference / before, by_order), least, 1)
    return difference * np.where(parts.overlap > 0, values["kPartOverlap"], share)


def check_parts(samples, held):
    """As check_cells."""
    if not np.allclose(part_estimate(samples.part, held), samples.part.estimate, rtol=1e-6,
                       atol=1e-18):
        raise SystemExit("error_model: error_samples was built with other constants, or "
                         "part_error.cpp has other formulas than fits.py")


def part_fit(choose):
    def chosen(samples):
        parts = samples.part
        doubtful = (parts.one_shape == 0) | (parts.near > 0)
        return parts.where({"overlap": parts.overlap > 0,
                            "smooth": (parts.overlap == 0) & ~doubtful,
                            "doubtful": (parts.overlap == 0) & doubtful}[choose])

    def refit(samples, held, name):
        parts = chosen(samples)
        if len(parts.error) < LEAST:
            return math.nan
        return greatest_likelihood([name], held, lambda v: part_estimate(parts, v),
                                   parts.error)[name]

    return lambda name: Fit(
        lambda s, held: chosen(s).error,
        lambda s, v: v["kPairMargin"] * part_estimate(chosen(s), v),
        lambda s, held: refit(s, held, name))


def stated_part_fit(name):
    def chosen(samples):
        return samples.part.where(samples.part.passes > 0)

    return Fit(lambda s, held: chosen(s).error,
               lambda s, v: v["kPairMargin"] * v[name] * part_estimate(chosen(s), v),
               lambda s, held: ratio_of_sums(chosen(s).error, part_estimate(chosen(s), held)))


def far_fit(name):
    def chosen(samples):
        far = samples.far
        return far.where((far.fraction > 0.05) & (far.fraction < 0.95))

    def unit(far, values):
        return 4 * far.fraction * (1 - far.fraction) * values["kFarError"] / far.distance**3

    return Fit(lambda s, held: abs(chosen(s).difference),
               lambda s, v: v["kPairMargin"] * v[name] * unit(chosen(s), v),
               lambda s, held: ratio_of_sums(chosen(s).difference, unit(chosen(s), held)))


def bound_fit(chosen, unit):
    """`unit`: the bound for a constant of 1."""
    return lambda name: Fit(
        lambda s, held: chosen(s, held).error,
        lambda s, v: v[name] * unit(chosen(s, v)),
        lambda s, held: max(chosen(s, held).error / unit(chosen(s, held)), default=math.nan))


LOOSEST = 1e-2  # tolerance of the formulas for pairs with nothing in between


def eye_fit(name):
    reach = (2 * 0.1) ** (1 / 3)  # h / r, where these kernels begin at the loosest tolerance
    return bound_fit(lambda s, held: s.eye.where((s.eye.h_over_r < reach) & (s.eye.height > 1)),
                     lambda eye: eye.h_over_r**3)(name)


RULES_PLAIN = "kSeriesError kRuleError".split()
ORDERS = [2, 2, None, 3, 4, 5]  # of the series and the rules; None: kStroudOrder


def order_of(k, values):
    return ORDERS[k + 1] or values["kStroudOrder"]


def rule_value(k, values, skewed):
    if k < 0:
        return values["kSkewError" if skewed else "kSeriesError"]
    return values["kSkewRuleError" if skewed else "kRuleError"][k]


def rule_figure(rules, k, values, skewed):
    """The bound of rule k (-1: the series), without its constant."""
    if skewed:
        skew = rules.skew if k < 0 else 1
        return skew * rules.R ** (order_of(k, values) - 0.5)
    return rules.R ** order_of(k, values)


def rule_chosen(samples, k, values, skewed):
    rules = samples.rule.where(samples.rule.k == k)
    plain = rule_value(k, values, False) * rule_figure(rules, k, values, False)
    if not skewed:
        return rules.where((rules.skew < 1e-9) & (plain <= LOOSEST))
    if k >= 0:
        rules = rules.where(rules.skew >= 1 / values["kSkewFactor"])
        plain = rule_value(k, values, False) * rule_figure(rules, k, values, False)
    bound = rule_value(k, values, True) * rule_figure(rules, k, values, True)
    return rules.where((rules.skew > 1e-9) & (np.maximum(plain, bound) <= LOOSEST) &
                       (rules.error > plain))


def rules_fit(skewed, ks):
    def errors(samples, held):
        return np.concatenate([rule_chosen(samples, k, held, skewed).error for k in ks])

    def figures(samples, values, chosen_by):
        return np.concatenate([
            rule_value(k, values, skewed) *
            rule_figure(rule_chosen(samples, k, chosen_by, skewed), k, values, skewed)
            for k in ks])

    def refit(samples, held):
        found = []
        for k in ks:
            rules = rule_chosen(samples, k, held, skewed)
            ratios = rules.error / rule_figure(rules, k, held, skewed)
            found.append(ratios.max() if len(ratios) else math.nan)
        if ks == [-1]:
            return found[0]
        if skewed:
            found.insert(1, math.inf)
        return found

    return lambda name: Fit(errors, lambda s, v: figures(s, v, v["held"]), refit)


def order_fit(name):
    def chosen(samples, held):
        return rule_chosen(samples, 1, held, False)

    def refit(samples, held):
        rules = chosen(samples, held)
        if len(rules.R) < LEAST:
            return math.nan
        place = np.floor(4 * np.log(rules.R)).astype(int)
        points = [(math.log(rules.R[place == p].mean()), math.log(rules.error[place == p].max()))
                  for p in np.unique(place) if (place == p).sum() >= 20]
        return np.polyfit(*zip(*points), 1)[0] if len(points) > 2 else math.nan

    return Fit(lambda s, held: chosen(s, held).error,
               lambda s, v: v["kRuleError"][1] * chosen(s, v["held"]).R ** v[name], refit)


def lambert_fit(name):
    def chosen(samples, held):
        lambert = samples.lambert
        return lambert.where(held[name] * lambert.ratio ** (2 * lambert.n - 1) <= LOOSEST)

    def unit(lambert):
        return lambert.ratio ** (2 * lambert.n - 1)

    return Fit(lambda s, held: chosen(s, held).error,
               lambda s, v: v[name] * unit(chosen(s, v["held"])),
               lambda s, held: max(chosen(s, held).error / unit(chosen(s, held)), default=math.nan))


def digits_fit(name):
    def chosen(samples):
        return samples.digits.where((samples.digits.level > 0) & (samples.digits.error > 1e-14))

    return Fit(lambda s, held: chosen(s).error,
               lambda s, v: np.exp(-v[name] * 2 ** chosen(s).level),
               lambda s, held: min(-np.log(chosen(s).error) / 2 ** chosen(s).level))


def unraised(rows, held):
    return rows.figure / np.maximum(1, held["kRowAlike"] * rows.recheck)


def margin_fit(name):
    def refit(samples, held):
        rows = samples.row
        return held[name] * np.quantile(rows.error / unraised(rows, held), TOP)

    return Fit(lambda s, held: s.row.error,
               lambda s, v: s.row.figure * v[name] / v["held"][name], refit)


def alike_fit(name):
    def refit(samples, held):
        rows = samples.row
        found = []
        for run, tolerance in {*zip(rows.run, rows.tolerance)}:
            of_run = rows.where((rows.run == run) & (rows.tolerance == tolerance))
            exceeded = np.quantile(of_run.error / unraised(of_run, held), TOP)
            if of_run.recheck[0] > 0:
                found.append(exceeded / of_run.recheck[0])
        return np.median(found)

    return Fit(lambda s, held: s.row.error,
               lambda s, v: unraised(s.row, v["held"]) * np.maximum(1, v[name] * s.row.recheck),
               refit)


def points_fit(name):
    """An error here is a factor: of points counted, over foreseen, either way; 1.5 is allowed."""
    def chosen(samples):
        return samples.points.where(samples.points.tolerance >= 2.5e-4)

    def factor(points, more):
        foreseen = 4 * points.pairs + more * (points.foreseen - 4 * points.pairs)
        return np.exp(abs(np.log(points.counted / foreseen)))

    def refit(samples, held):
        points = chosen(samples)
        more = (points.counted - 4 * points.pairs) / (points.foreseen - 4 * points.pairs)
        return held[name] * np.exp(np.log(more[more > 0]).mean())

    return Fit(lambda s, held: np.ones(len(chosen(s).pairs)),
               lambda s, v: 1.5 / factor(chosen(s), v[name] / v["held"][name]), refit)


def closed_fit(name):
    return Fit(lambda s, held: s.closed.error,
               lambda s, v: np.full(len(s.closed.error), v[name]),
               lambda s, held: np.quantile(s.closed.error, TOP))


FITS = {
    "kCellSmooth4": cell_fit(4, "Smooth"), "kCellKinked4": cell_fit(4, "Kinked"),
    "kCellSmooth9": cell_fit(9, "Smooth"), "kCellKinked9": cell_fit(9, "Kinked"),
    "kCellSlope9": cell_fit(9, "Smooth"),
    "kCellUnseenFlat4": cell_fit(4, "Flat"), "kCellUnseenKinked4": cell_fit(4, "Kinked"),
    "kCellUnseenSmooth4": cell_fit(4, "Smooth"), "kCellUnseenFlat9": cell_fit(9, "Flat"),
    "kCellUnseenKinked9": cell_fit(9, "Kinked"), "kCellUnseenSmooth9": cell_fit(9, "Smooth"),
    "kCellStrong4": strong_fit(4), "kCellStrong9": strong_fit(9),
    "kCellInside4": flat_fit(4, "inside"), "kCellInside9": flat_fit(9, "inside"),
    "kCellBorder4": flat_fit(4, "border"), "kCellBorder9": flat_fit(9, "border"),
    "kCellOutside": outside_fit, "kCellReassured": outside_fit,
    "kPairExpected4": expected_fit, "kPairMargin": margin_fit,
    "kPartOrder": part_fit("smooth"), "kPartLeastDoubtful": part_fit("doubtful"),
    "kPartOverlap": part_fit("overlap"), "kPartStated": stated_part_fit,
    "kFarError": eye_fit, "kFarShare": far_fit,
    "kSeriesError": rules_fit(False, [-1]), "kSkewError": rules_fit(True, [-1]),
    "kRuleError": rules_fit(False, [0, 1, 2, 3, 4]),
    "kSkewRuleError": rules_fit(True, [0, 2, 3, 4]),
    "kStroudOrder": order_fit, "kLambertError": lambert_fit, "kTanhSinhDigits": digits_fit,
    "kPointsMore": points_fit, "kRowClosedForms": closed_fit, "kRowAlike": alike_fit,
}


def share_below(name, samples, held, values):
    """Share of a constant's cases whose error is below its figure, with `values`; NaN if there are
    too few."""
    fit = FITS[name](name)
    errors = fit.errors(samples, held)
    if len(errors) == 0:
        return math.nan
    return float((errors <= fit.figures(samples, values | {"held": held}) * (1 + 1e-9)).mean())


def refitted(name, samples, held):
    try:
        return FITS[name](name).refit(samples, held | {"held": held})
    except (ValueError, ZeroDivisionError):  # nothing to fit to
        return math.nan
