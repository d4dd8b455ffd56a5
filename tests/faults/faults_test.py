"""Outputs under faults: the k-th write, sync, rename, read or large allocation fails, the disk is
full, the process is killed. Each time there is the old file or the new one, whole, an exit code that
says which, one line, and nothing beside it.

    faults_test.py          a sample of the calls, some tens of seconds
    faults_test.py --all    every call
    faults_test.py --seed 7 another sample
"""

import hashlib
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import h5py

sys.path.insert(0, str(Path(__file__).parent.parent / "cli"))
from cli_runner import BOX_MTL, BOX_OBJ, HAS_PAGES, PROGRAM  # noqa: E402

LIBRARY = os.environ["RADIOSITY_FAILING_CALLS"]
CALLS = ["write", "sync", "rename", "read", "allocate"]
EVERY = "--all" in sys.argv
SEED = int(sys.argv[sys.argv.index("--seed") + 1]) if "--seed" in sys.argv else 1

# The least work that writes each kind of output.
LITTLE = ["--patches", "40", "--method", "hemicube", "--resolution", "16", "--emitters", "estimated",
          "--elements", "off"]
MATRIX = LITTLE[:-2]
PICTURE = ["--width", "64", "--height", "48"]

# By output: the arguments that write it. The old file is of other patches.
OUTPUTS = {
    "m.obj": ["mesh", "box.obj", "--patches", "40"],
    "m.vtp": ["mesh", "box.obj", "--patches", "40"],
    "f.mtx": ["factors", "box.obj", *MATRIX],
    "f.csv": ["factors", "box.obj", *MATRIX],
    "f.hdf5": ["factors", "box.obj", *MATRIX],
    "s.h5": ["solve", "box.obj", *LITTLE],
    "s.csv": ["solve", "box.obj", *LITTLE],
    "s.glb": ["solve", "box.obj", *LITTLE],
    "p.png": ["render", "box.obj", *LITTLE, *PICTURE],
    "p.exr": ["render", "box.obj", *LITTLE, *PICTURE],
}
if HAS_PAGES:
    OUTPUTS["v.html"] = ["view", "box.obj", *MATRIX, "--symmetrize"]


def stages(path):
    """The values of each group of an HDF5 file without times, and without notes: they say what
    changed, which after a killed run may be nothing."""
    found = {}

    def add(name, item):
        if isinstance(item, h5py.Dataset) and not name.endswith("seconds") and "/notes/" not in name:
            values = found.setdefault(name.split("/")[0], hashlib.sha256())
            values.update(name.encode() + item[()].tobytes())
    with h5py.File(path) as file:
        file.visititems(add)
    return {group: values.hexdigest() for group, values in found.items()}


def identity(path):
    """What an output says, without times; none if there is no such file."""
    if not path.exists():
        return None
    if path.suffix in (".h5", ".hdf5"):
        return stages(path)
    if path.name == "run.json":
        return json.loads(path.read_text())["arguments"]
    content = path.read_bytes()
    # The header of this format has the time in it.
    return hashlib.sha256(content[2048:] if path.suffix == ".exr" else content).hexdigest()


class Case:
    """A folder with an old output, and the command that replaces it."""

    def __init__(self, folder, name, old, new):
        self.folder, self.name, self.new = folder, name, new
        self.run(old)
        self.kept = (folder / name).read_bytes()
        self.old = identity(folder / name)
        self.run(new)
        self.fresh = identity(folder / name)
        assert self.fresh != self.old
        self.restore()
        self.files = self.listed()

    def listed(self):
        return sorted(p.name for p in self.folder.iterdir())

    def restore(self):
        for path in self.folder.iterdir():
            if path.name not in ("box.obj", "box.mtl"):
                path.unlink()
        (self.folder / self.name).write_bytes(self.kept)

    def run(self, arguments):
        run = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True,
                             timeout=300, check=False)
        assert run.returncode == 0, run.stderr

    def start(self, **more):
        return subprocess.Popen([PROGRAM, *self.new], cwd=self.folder, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True, **more)

    def faulty(self, call, at, lasts=False):
        return self.start(env=dict(os.environ, LD_PRELOAD=LIBRARY, FAULT_CALL=call, FAULT_AT=str(at),
                                   FAULT_LASTS="1" if lasts else "0"))

    def state(self):
        found = identity(self.folder / self.name)
        if found == self.old:
            return "old"
        if found == self.fresh:
            return "new"
        # A results file gets each stage as soon as it is computed.
        if self.name == "s.h5" and found and found.items() <= self.fresh.items():
            return "first stages"
        if isinstance(found, dict):
            return "other stages: " + ", ".join(sorted(g for g, v in found.items() if self.fresh.get(g) != v))
        return "damaged or gone"


class Faults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.random = random.Random(SEED)
        cls.top = tempfile.TemporaryDirectory()
        cls.cases = []
        for name, arguments in OUTPUTS.items():
            old = ["6" if word == "40" else word for word in arguments]
            cls.cases.append(cls.case(name, [*old, "-o", name], [*arguments, "-o", name]))
        cls.cases.append(cls.case("run.json", ["info", "box.obj", "--report", "run.json"],
                                  ["mesh", "box.obj", "--patches", "40", "--report", "run.json"]))
        # An update in place: the solution changes, the form factors stay.
        solve = ["solve", "box.obj", *LITTLE, "-o", "s.h5"]
        cls.update = cls.case("s.h5", solve, ["solve", "s.h5", "--set", "wall.reflectance=0.3"])
        cls.cases.append(cls.update)

    @classmethod
    def tearDownClass(cls):
        cls.top.cleanup()

    @classmethod
    def case(cls, name, old, new):
        folder = Path(cls.top.name) / str(len(cls.cases))
        folder.mkdir()
        (folder / "box.obj").write_text(BOX_OBJ)
        (folder / "box.mtl").write_text(BOX_MTL)
        return Case(folder, name, [*old, "--threads", "1"], [*new, "--threads", "1"])

    def judge(self, case, process, what):
        """The run has ended as it says, and left one whole file."""
        _, err = process.communicate(timeout=300)
        label = f"{case.name}: {what}: exit {process.returncode}: {err}"
        self.assertIn(process.returncode, (0, 1, 2), label)
        self.assertEqual(case.listed(), case.files, label)
        state = case.state()
        self.assertIn(state, ("old", "new", "first stages"), label)
        if process.returncode == 0:
            self.assertEqual(state, "new", label)
        else:
            lines = [line for line in err.splitlines() if line.startswith("radiosity: ")]
            self.assertEqual(len(lines), 1, label)
        return process.returncode, state

    def counts(self, case):
        """The number of calls of each kind in a run without faults."""
        counted = Path(self.top.name) / "count"
        process = case.start(env=dict(os.environ, LD_PRELOAD=LIBRARY, FAULT_COUNT=str(counted)))
        self.assertEqual(self.judge(case, process, "no call fails"), (0, "new"))
        case.restore()
        return dict(zip(CALLS, map(int, counted.read_text().split())))

    def chosen(self, count):
        if EVERY:
            return range(1, count + 1)
        return sorted({count, self.random.randint(1, count)}) if count > 0 else []

    def test_a_call_that_fails(self):
        runs = failed = 0
        for case in self.cases:
            for call, count in self.counts(case).items():
                for at in self.chosen(count):
                    # A disk stays full; else one failure is followed by calls that do well.
                    lasts = call == "write" and self.random.random() < 0.5
                    code, _ = self.judge(case, case.faulty(call, at, lasts),
                                         f"{call} {at} of {count}" + (" and later" if lasts else ""))
                    runs += 1
                    failed += code != 0
                    case.restore()
        print(f"{runs} faults, {failed} runs failed")
        self.assertGreater(failed, runs / 3)

    def test_a_file_that_cannot_grow(self):
        for case in self.cases:
            (case.folder / case.name).unlink()
            case.run(case.new) if case is not self.update else case.restore()
            size = (case.folder / case.name).stat().st_size
            case.restore()
            for part in (0.3, 0.99) if not EVERY else [k / 20 for k in range(20)]:
                most = int(part * size)
                limit = lambda most=most: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
                code, state = self.judge(case, case.start(preexec_fn=limit), f"at most {most} bytes")
                self.assertEqual(code, 1, f"{case.name}: {most} of {size} bytes")
                self.assertNotEqual(state, "new", f"{case.name}: {most} of {size} bytes")
                case.restore()

    def test_a_full_disk(self):
        """On a file system of its own, which takes the rights to mount one."""
        if os.geteuid() != 0 or not shutil.which("unshare"):
            print("SKIPPED: a full disk: only root can mount a small one")
            self.skipTest("only root can mount a small disk")
        script = ('mount -t tmpfs -o size="$1" none disk && cp -p *.* disk && cd disk || exit 99\n'
                  'shift; "$@"; code=$?; cd ..; cp -a disk/. found && exit $code')
        for case in self.cases:
            size = sum((case.folder / name).stat().st_size for name in case.files)
            for more in (0,) if not EVERY else range(0, 3 * size, 4096):
                (case.folder / "disk").mkdir()
                (case.folder / "found").mkdir()
                pages = -(-size // 4096) + len(case.files)
                process = subprocess.Popen(
                    ["unshare", "--mount", "sh", "-c", script, "sh", str(pages * 4096 + more), PROGRAM,
                     *case.new], cwd=case.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                _, err = process.communicate(timeout=300)
                if process.returncode == 99:
                    print("SKIPPED: a full disk: none can be mounted here")
                    self.skipTest("no disk can be mounted here")
                found = case.folder / "found"
                label = f"{case.name}: {more} bytes free: exit {process.returncode}: {err}"
                self.assertIn(process.returncode, (0, 1, 2), label)
                self.assertEqual(sorted(os.listdir(found)), case.files, label)
                (case.folder / case.name).write_bytes((found / case.name).read_bytes())
                good = ("new",) if process.returncode == 0 else ("old", "first stages")
                self.assertIn(case.state(), good, label)
                shutil.rmtree(found)
                (case.folder / "disk").rmdir()
                case.restore()

    def test_a_killed_run(self):
        for case in self.cases:
            start = time.monotonic()
            self.judge(case, case.start(), "undisturbed")
            seconds = time.monotonic() - start
            case.restore()
            for _ in range(50 if EVERY else 1):
                process = case.start()
                # Most of the writing is at the end.
                time.sleep(self.random.uniform(0.3, 1.1) * seconds)
                process.send_signal(signal.SIGKILL)
                process.communicate(timeout=300)
                self.assertIn(case.state(), ("old", "new", "first stages"), case.name)
                # The next run removes what is left, and journals are only of rows.
                self.judge(case, case.start(), "after a killed run")
                self.assertEqual(case.state(), "new", case.name)
                case.restore()


if __name__ == "__main__":
    sys.argv = [a for a in sys.argv if a != "--all" and a != "--seed" and a != str(SEED)]
    sys.exit(unittest.main())
