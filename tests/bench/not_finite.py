#!/usr/bin/env python3
"""Names the fields of a results file with non-finite numbers: not_finite.py FILE"""
import sys

import h5py
import numpy

BLOCK = 1 << 22  # values looked at together


def fields(path):
    bad = []

    def look(name, field):
        if not isinstance(field, h5py.Dataset) or field.dtype.kind != "f" or field.size == 0:
            return
        if not field.shape:
            blocks = [field[()]]
        else:
            rows = max(1, BLOCK * field.shape[0] // field.size)
            blocks = (field[k:k + rows] for k in range(0, field.shape[0], rows))
        if not all(numpy.isfinite(block).all() for block in blocks):
            bad.append(name)

    with h5py.File(path, "r") as results:
        results.visititems(look)
    return bad


if __name__ == "__main__":
    print(", ".join(fields(sys.argv[1])))
