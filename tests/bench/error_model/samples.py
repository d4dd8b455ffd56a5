"""The output of error_samples, as tables."""
import numpy as np


class Samples:
    """Lines of error_samples by their first word; numbers, a row a line."""

    CELL = ("tolerance level one_shape may_cross one_occluder fraction change error cautious stated "
            "allowed outside").split()
    NAMES = {
        "part": "tolerance one_shape near overlap difference before values error estimate passes",
        "far": "distance fraction difference",
        "row": "tolerance error figure recheck",
        "points": "tolerance pairs foreseen counted",
        "closed": "error",
        "rule": "k R skew error",
        "lambert": "n ratio error",
        "eye": "h_over_r height error",
        "digits": "level error",
    }

    def __init__(self, texts):
        rows = {}
        for run, text in enumerate(texts):
            for line in text.splitlines():
                kind, *words = line.split()
                if kind == "cell":
                    kind += str(len(words) - len(self.CELL))
                rows.setdefault(kind, []).append([*map(float, words), run])
        for kind, names in self.NAMES.items():
            setattr(self, kind, self.table(rows.get(kind, []), names.split()))
        for count in (4, 9):
            names = self.CELL + [f"r{k}" for k in range(count)]
            cells = self.table(rows.get(f"cell{count}", []), names)
            cells.r = np.array([getattr(cells, f"r{k}") for k in range(count)])
            setattr(self, f"cell{count}", cells)

    @staticmethod
    def table(rows, names):
        columns = np.array(rows, dtype=float).reshape(len(rows), len(names) + 1).T
        return Table(dict(zip([*names, "run"], columns)))


class Table:
    """Columns of equal length as attributes."""

    def __init__(self, columns):
        self.__dict__.update(columns)

    def where(self, chosen):
        return Table({name: column[..., chosen] for name, column in self.__dict__.items()})
