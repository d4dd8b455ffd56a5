"""The time of a call through Python beyond the computation itself, and of views.

    PYTHONPATH=build/release/python python3 tests/bench/python_overhead.py

Each row: the call, the seconds that the library's report says, and those of the call beyond them:
the least of all runs of each, and the middle. At 1,000 patches less than 1% is wanted, and
microseconds for a view.
"""

import time
from pathlib import Path

import numpy as np

import radiosity as rad

SCENE = Path(__file__).parents[2] / "data/cornell-box-closed.obj"
SECONDS = 6  # of each call: a run of milliseconds needs many, to find an undisturbed one


def timed(call, inside):
    """The least seconds inside, the least beyond them and their median."""
    rows = []
    end = time.perf_counter() + SECONDS
    while time.perf_counter() < end:
        start = time.perf_counter()
        result = call()
        seconds = time.perf_counter() - start
        rows.append((seconds - inside(result), inside(result)))
        del result  # outside the time of the next call
    beyond, own = np.transpose(rows)
    return own.min(), beyond.min(), np.median(beyond)


def view_seconds(get, times=10000):
    get()
    start = time.perf_counter()
    for _ in range(times):
        get()
    return (time.perf_counter() - start) / times


def main():
    mesh = rad.mesh(rad.load(SCENE), patches=1000)
    F = rad.form_factors(mesh, method="exact")
    light = rad.solve(F)
    print(f"{len(F)} rows, {F.csr.nnz:,} entries")
    calls = {
        "form_factors": (lambda: rad.form_factors(mesh, method="exact"), lambda r: r.report["seconds"]),
        "solve": (lambda: rad.solve(F, tolerance=1e-6), lambda r: r.summary["seconds"]),
        "heat": (lambda: rad.heat(F, 0.8, {"lamp": 1200, "*": 300}), lambda r: r.summary["seconds"]),
    }
    for name, (call, inside) in calls.items():
        own, least, middle = timed(call, inside)
        print(f"{name:14} {own * 1e3:9.3f} ms, beyond it {least * 1e3:.3f} ms ({middle * 1e3:.3f}), "
              f"{least / own:.2%}")
    start = time.perf_counter()
    fresh = rad.form_factors(mesh, method="exact")
    middle = time.perf_counter()
    fresh.csr
    print(f"{'first csr':14} {(time.perf_counter() - middle) * 1e3:9.3f} ms of {(middle - start) * 1e3:.0f} ms")
    views = {"csr": lambda: F.csr, "mesh.area": lambda: mesh.area, "F.error": lambda: F.error,
             "radiosity": lambda: light.radiosity}
    for name, get in views.items():
        print(f"{name:14} {view_seconds(get) * 1e6:9.3f} us a view")


if __name__ == "__main__":
    main()
