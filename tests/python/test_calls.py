"""Long calls: Ctrl-C, other threads, progress; and the package as the command line."""

import os
import re
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import radiosity as rad
from conftest import ROOT


# On a quiet machine half a second, 50 ms of it to see the signal. Several tests run at a time, as in
# interrupt_test.py; the computation itself takes a minute.
LONGEST_ANSWER = 5  # seconds


@pytest.fixture(scope="module")
def slow():
    """A mesh whose form factors take far longer than a test waits."""
    return rad.mesh(rad.load(ROOT / "data/furnished-room.obj"), patches=2000)


def test_ctrl_c_raises_keyboard_interrupt(slow):
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        rad.form_factors(slow, method="exact")
    assert time.monotonic() - start < 0.5 + LONGEST_ANSWER


def test_ctrl_c_does_not_wait_until_a_file_is_read(tmp_path):
    side = 700
    path = tmp_path / "grid.obj"
    with path.open("w") as file:
        for i in range(side + 1):
            file.writelines(f"v {i} 0 {j}\n" for j in range(side + 1))
        for corner in range(1, side * (side + 1)):
            file.write(f"f {corner} {corner + 1} {corner + side + 2}\n")
    start = time.monotonic()
    with pytest.warns(UserWarning, match="no material"):
        rad.load(path)
    whole = time.monotonic() - start
    threading.Timer(0.1 * whole, os.kill, (os.getpid(), signal.SIGINT)).start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        rad.load(path)
    # The signal comes after a tenth, and is seen within 50 ms, a tenth or less.
    assert time.monotonic() - start < 0.6 * whole
    assert rad.load(ROOT / "data/cornell-box.obj").surface_names  # while the thread may read on


def test_ctrl_c_ends_a_solve_on_the_calling_thread():
    """Few rows: the solve is not handed to another thread. These sweeps, each of which takes away
    1e-9 of the error, would take hours."""
    F = rad.from_csr([[0, 1], [1, 0]], area=[1, 1])
    told = []
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        rad.solve(F, 1 - 1e-9, [1.0, 0.0], solver="jacobi", max_iterations=2**31 - 1,
                  progress=lambda *step: told.append(step))
    assert time.monotonic() - start < 0.3 + LONGEST_ANSWER
    assert told


def test_ctrl_c_ends_the_meshing_of_faces_as_they_are():
    side = 500  # seconds
    x, y = np.meshgrid(np.arange(side + 1.0), np.arange(side + 1.0))
    corner = np.arange(side * (side + 1)).reshape(side, side + 1)[:, :-1].reshape(-1, 1)
    grid = rad.Scene(np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)]),
                     corner + [0, 1, side + 2, side + 1])
    told = []

    def interrupt(stage, done, total):
        told.append((stage, done < total))
        if stage == "faces as patches" and len(told) == told.index(("faces as patches", True)) + 1:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        rad.mesh(grid, faces_as_patches=True, progress=interrupt)
    assert told[-1] == ("faces as patches", True)


def test_the_process_ends_while_threads_compute():
    code = ("import threading, time\n"
            "import radiosity as rad\n"
            f"F = rad.form_factors(rad.mesh(rad.load({str(ROOT / 'data/cornell-box.obj')!r}), patches=600))\n"
            "def work():\n"
            "    while True: rad.solve(F); rad.form_factors(F.mesh, 0.1)\n"
            "for _ in range(2): threading.Thread(target=work, daemon=True).start()\n"
            "time.sleep(0.5)\n")
    run = subprocess.run([sys.executable, "-W", "ignore", "-c", code], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr


def test_a_finalizer_at_the_end_may_compute():
    code = ("import radiosity as rad\n"
            "F = rad.from_csr([[0, 1], [1, 0]], [1, 1])\n"
            "class Last:\n"
            "    def __del__(self, solve=rad.solve, F=F): solve(F, 0.5, [1.0, 0.0])\n"
            "import builtins\n"
            "builtins.last = Last()\n")
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


def test_threads_get_the_same_csr(cornell):
    F = rad.form_factors(cornell.mesh, 0.1)
    found = []
    threads = [threading.Thread(target=lambda: found.append(F.csr)) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(csr is found[0] for csr in found)


def test_a_signal_handler_may_raise_any_exception(slow):
    def handler(number, frame):
        raise TimeoutError("enough")

    before = signal.signal(signal.SIGUSR1, handler)
    try:
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGUSR1)).start()
        with pytest.raises(TimeoutError, match="enough"):
            rad.form_factors(slow, method="exact")
    finally:
        signal.signal(signal.SIGUSR1, before)


def test_other_threads_run_during_a_computation(slow):
    class Stop(Exception):
        pass

    counted = []

    def count():
        while len(counted) < 5:
            counted.append(time.monotonic())
            time.sleep(0.01)

    def stop(stage, done, total):
        if len(counted) >= 5:
            raise Stop

    thread = threading.Thread(target=count)
    thread.start()
    # It ends only because the other thread counts meanwhile.
    with pytest.raises(Stop):
        rad.form_factors(slow, method="exact", progress=stop)
    thread.join()


def test_other_threads_run_while_rows_are_made():
    mesh = rad.mesh(rad.load(ROOT / "data/cornell-box.obj"), patches=3000)
    F = rad.form_factors(mesh, 0.1, method="exact")
    ticks = []
    made = threading.Event()

    def tick():
        while not made.wait(0.0005):
            ticks.append(time.monotonic())

    thread = threading.Thread(target=tick)
    thread.start()
    start = time.monotonic()
    F.csr
    end = time.monotonic()
    made.set()
    thread.join()
    within = [start, *(t for t in ticks if start < t < end), end]
    # Counting the entries takes half of the time, filling in most of the rest.
    assert max(b - a for a, b in zip(within, within[1:])) < 0.3 * (end - start)


def test_two_threads_may_compute_at_once(cornell):
    results = [None, None]

    def compute(k):
        results[k] = rad.form_factors(cornell.mesh, method="exact").csr.data

    threads = [threading.Thread(target=compute, args=(k,)) for k in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert (results[0] == cornell.csr.data).all() and (results[1] == cornell.csr.data).all()


def test_a_forked_process_computes_too(cornell):
    """It has no copies of its parent's threads, which computed before."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        signal.alarm(60)  # ends it if it waits for a missing thread
        os.write(write, rad.solve(cornell).radiosity.tobytes())
        os._exit(0)
    os.close(write)
    with os.fdopen(read, "rb") as pipe:
        radiosity = pipe.read()
    assert os.waitpid(child, 0)[1] == 0
    assert radiosity == rad.solve(cornell).radiosity.tobytes()


def test_progress_gives_stage_done_and_total(slow):
    told = []

    class Enough(Exception):
        pass

    def progress(stage, done, total):
        told.append((stage, done, total))
        if stage == "form factors" and done > 0:
            raise Enough

    with pytest.raises(Enough):
        rad.form_factors(slow, method="hemicube", progress=progress)
    assert all(0 <= done <= total for _, done, total in told)
    assert told[-1][2] == len(slow)  # a hemicube a patch


def test_progress_is_shown_on_standard_error(capsys, monkeypatch, slow, cornell):
    monkeypatch.setattr("radiosity._progress.SHOWN_AFTER", 0)
    threading.Timer(0.6, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        rad.form_factors(slow, method="exact", progress=True)
    said = capsys.readouterr().err
    assert re.search(r"\r[a-z ]+ \d+%.*, 0 s", said) and said.endswith(" \r")  # it is cleared
    rad.form_factors(cornell.mesh, method="exact", progress=False)
    assert capsys.readouterr().err == ""


def module(*arguments, folder):
    return subprocess.run([sys.executable, "-m", "radiosity", *arguments], cwd=folder, text=True,
                          capture_output=True, timeout=120)


def test_the_module_is_the_command_line(run_program, tmp_path):
    run_program("mesh", "data/furnace-cube.obj", "--patches", 24, "-o", "a.obj")
    done = module("mesh", "data/furnace-cube.obj", "--patches", "24", "-o", "b.obj", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "a.obj").read_bytes() == (tmp_path / "b.obj").read_bytes()
    wrong = module("mesh", "none.obj", folder=tmp_path)
    assert wrong.returncode == 2 and wrong.stderr.startswith("radiosity: none.obj")
    assert module("--version", folder=tmp_path).stdout.strip().endswith(rad.__version__)
