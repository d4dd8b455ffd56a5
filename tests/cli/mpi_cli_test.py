"""Several processes, started by mpirun: the same form factors to the bit, the same light, rows
shared between them; unsupported requests are refused in a line."""

import json
import os
import re
import shlex
import signal
import subprocess
import time
import unittest
from pathlib import Path

import h5py
import numpy as np

from cli_runner import DATA, PROGRAM, CliTest, limit

BOX = str(DATA / "cornell-box-closed.obj")
ROOMS = str(DATA / "two-rooms.obj")
CITY = str(DATA / "city.stl")
# As root, and with more processes than cores.
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
BUILT = (Path(PROGRAM).parent / "libradiosity_distributed.so").exists()


def launch(processes, *arguments):
    # Unbound, each with one thread: processes then share cores as they come.
    return ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(processes), PROGRAM,
            *arguments, "--threads", "1"]


def processes_of(launcher):
    """The ids of a launcher's programs."""
    children = Path(f"/proc/{launcher}/task/{launcher}/children").read_text().split()
    return [int(child) for child in children]


def work_of(launcher, count):
    """Processor seconds of its programs; 0 for those of `count` that are not there yet."""
    ticks = [Path(f"/proc/{p}/stat").read_text().split()[13] for p in processes_of(launcher)]
    seconds = [int(t) / os.sysconf("SC_CLK_TCK") for t in ticks]
    return seconds + [0.0] * (count - len(seconds))


def is_running(process):
    try:
        status = Path(f"/proc/{process}/status").read_text()
    except (FileNotFoundError, ProcessLookupError):
        return False
    # A process that ended may still wait to be reaped.
    return not re.search(r"State:\t[ZX]", status)


def peak_bytes(process):
    found = re.search(r"VmHWM:\s+(\d+) kB", Path(f"/proc/{process}/status").read_text())
    return 1024 * int(found[1]) if found else 0


@unittest.skipUnless(BUILT, "built without MPI (RADIOSITY_MPI)")
class MpiTest(CliTest):
    def mpirun(self, processes, *arguments, petsc="", code=0):
        done = subprocess.run(launch(processes, *arguments), cwd=self.folder, timeout=limit(300), text=True,
                              capture_output=True, env={**ENVIRONMENT, "PETSC_OPTIONS": petsc})
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def radiosity_of(self, file):
        with h5py.File(self.folder / file) as results:
            return results["solution/radiosity"][()]

    def assert_same_radiosity(self, first, second):
        """To 1e-12 of the largest: the residuals were asked to be at rounding."""
        expected, found = self.radiosity_of(first), self.radiosity_of(second)
        self.assertLess(np.abs(found - expected).max(), 1e-12 * expected.max())

    def test_form_factors_have_the_same_bits_for_any_number_of_processes(self):
        raw = ["hemicube", "--resolution", "64"]
        for scene, patches, method, counts in [(BOX, "300", ["exact"], [1, 4]),
                                               (ROOMS, "250", ["exact"], [4]),
                                               (CITY, "1200", ["exact"], [2]),
                                               (CITY, "600", ["rays"], [1, 4]),
                                               (CITY, "1200", ["cut"], [1, 2, 4]),
                                               (ROOMS, "250", raw, [2])]:
            with self.subTest(f"{scene} {method}"):
                options = ["factors", scene, "--patches", patches, "--method", *method]
                self.run_program(*options, "-o", "one.h5")
                for processes in counts:
                    self.mpirun(processes, *options, "-o", "many.h5")
                    self.assert_same_factors("one.h5", "many.h5")
                    os.remove(self.folder / "many.h5")

    def test_raw_rows_of_hemicubes_are_solved(self):
        options = ["solve", ROOMS, "--patches", "250", "--method", "hemicube", "--resolution", "64",
                   "--solve-tolerance", "1e-14"]
        self.run_program(*options, "-o", "one.h5")
        self.mpirun(3, *options, "-o", "many.h5")
        self.assert_same_radiosity("one.h5", "many.h5")

    def test_rows_that_are_cut_are_solved_and_read_by_process_0(self):
        options = ["solve", ROOMS, "--patches", "600", "--method", "cut", "--tolerance", ".05"]
        self.run_program(*options, "-o", "one.h5")
        self.mpirun(3, *options, "-o", "many.h5")
        self.assertEqual(self.radiosity_of("one.h5").tobytes(), self.radiosity_of("many.h5").tobytes())
        self.mpirun(2, "solve", "many.h5", "--set", "plaster.reflectance=.2", "-o", "later.h5")
        self.run_program("solve", "one.h5", "--set", "plaster.reflectance=.2", "-o", "alone.h5")
        self.assertEqual(self.radiosity_of("later.h5").tobytes(), self.radiosity_of("alone.h5").tobytes())
        done = self.mpirun(2, "solve", "many.h5", "--solver", "petsc", code=2)
        self.assertIn("rows that are cut", done.stderr)

    def test_a_room_without_light_stays_dark(self):
        (self.folder / "box.mtl").write_text(
            (self.folder / "box.mtl").read_text().replace("Ke 5 4 3", "Ke 0 0 0"))
        done = self.mpirun(2, "solve", "box.obj", "--patches", "150", "--solver", "petsc", "-o", "d.h5")
        self.assertIn("nothing emits light", done.stderr)
        self.assertFalse(self.radiosity_of("d.h5").any())

    def test_more_processes_than_blocks_of_rows_change_no_bit(self):
        options = ["factors", str(DATA / "facing-plates.obj"), "--patches", "2"]
        self.run_program(*options, "--method", "exact", "-o", "one.h5")
        self.mpirun(4, *options, "-o", "many.h5")
        self.assert_same_factors("one.h5", "many.h5")

    def test_solutions_equal_those_of_one_process(self):
        # The residual is at rounding, so that solutions differ by no more than it leaves.
        exactly = ["--solve-tolerance", "1e-14"]
        for scene, patches, runs in [(BOX, "400", [(1, "auto"), (2, "petsc"), (4, "petsc")]),
                                     (ROOMS, "400", [(2, "petsc"), (2, "cg")])]:
            options = ["solve", scene, "--patches", patches, "--method", "exact", *exactly]
            self.run_program(*options, "--solver", "cg", "-o", "one.h5")
            for processes, solver in runs:
                with self.subTest(f"{scene} {processes} {solver}"):
                    done = self.mpirun(processes, *options, "--solver", solver, "-o", "many.h5")
                    self.assertIn("converged", done.stdout)
                    self.assert_same_radiosity("one.h5", "many.h5")
                    os.remove(self.folder / "many.h5")

    def test_results_files_pass_between_one_process_and_many(self):
        options = [BOX, "--patches", "400", "--method", "exact"]
        self.run_program("factors", *options, "-o", "one.h5")
        self.mpirun(3, "factors", *options, "-o", "many.h5")
        self.mpirun(3, "solve", "one.h5", "-o", "solved_by_many.h5")
        self.run_program("solve", "many.h5", "-o", "solved_by_one.h5")
        self.assert_same_factors("solved_by_many.h5", "solved_by_one.h5")
        one = self.radiosity_of("solved_by_one.h5")
        # Both are within their bounds of the solution, of a residual of 1e-6 of the lamp.
        self.assertLess(np.abs(self.radiosity_of("solved_by_many.h5") - one).max(), 1e-5 * one.max())

    def test_tables_are_those_of_one_process(self):
        for method in ("exact", "rays", "hemicube"):
            options = ["factors", BOX, "--patches", "200", "--method", method]
            self.run_program(*options, "-o", "one.json")
            self.mpirun(3, *options, "-o", "many.json", "-o", "many.vf")
            one, many = (json.loads((self.folder / name).read_text()) for name in ("one.json", "many.json"))
            self.assertEqual(one["names"], many["names"])
            # Sums over patches are in another order.
            for key in ("form_factors", "sky", "entry_error"):
                np.testing.assert_allclose(many.get(key, 0), one.get(key, 0), rtol=1e-12, atol=1e-15)

    def test_commands_of_the_readme_run(self):
        (self.folder / "data").symlink_to(DATA)
        readme = Path(os.environ["RADIOSITY_SOURCE_DIR"]) / "src/distributed/README.md"
        lines = re.findall(r'^(?:PETSC_OPTIONS="(.*)" )?mpirun -n \d+ radiosity (.*)$',
                           readme.read_text(), re.M)
        self.assertEqual(len(lines), 3)
        for petsc, arguments in lines:
            self.mpirun(2, *shlex.split(arguments), petsc=petsc)

    def test_petsc_takes_its_own_options(self):
        options = ["solve", BOX, "--patches", "300", "--method", "exact", "--solve-tolerance", "1e-9"]
        self.run_program(*options, "--solver", "cg", "-o", "one.h5")
        expected = self.radiosity_of("one.h5")
        for petsc, printed in [("-ksp_monitor", "KSP Residual norm"),
                               ("-ksp_type richardson -pc_type none -ksp_view", "type: richardson"),
                               ("-radiosity_mat_type aij -ksp_type richardson -pc_type sor -ksp_view",
                                "type: mpiaij")]:
            with self.subTest(petsc):
                done = self.mpirun(2, *options, "--solver", "petsc", "-o", "many.h5", petsc=petsc)
                self.assertIn(printed, done.stdout)
                self.assertLess(np.abs(self.radiosity_of("many.h5") - expected).max(),
                                1e-6 * expected.max())
                os.remove(self.folder / "many.h5")

    def peaks(self, processes, *arguments):
        """The peak memory of any process of a run, and the run's report."""
        run = subprocess.Popen([*launch(processes, *arguments), "--report", "report.json"],
                               cwd=self.folder, env=ENVIRONMENT, stdout=subprocess.DEVNULL)
        most = 0
        while run.poll() is None:
            try:
                most = max([most, *map(peak_bytes, processes_of(run.pid))])
            except (FileNotFoundError, ProcessLookupError):
                pass
            time.sleep(0.01)
        self.assertEqual(run.returncode, 0)
        return most, json.loads((self.folder / "report.json").read_text())

    def test_memory_of_a_process_falls_with_their_number(self):
        options = ["factors", BOX, "--patches", "10000", "--method", "hemicube", "--resolution", "32"]
        alone, report = self.peaks(1, *options)
        matrix = report["form_factors"]["matrix_bytes"]
        fourth, _ = self.peaks(4, *options)
        # Three quarters of the rows are elsewhere, less the extra rows of a process quicker than
        # others, and message buffers.
        self.assertGreater(alone - fourth, 0.5 * matrix)

    def test_a_matrix_of_several_panels_is_written_as_by_one_process(self):
        # Rows are collected a panel at a time: 2.8 million entries, of 9 million.
        options = ["factors", BOX, "--patches", "4000", "--method", "exact", "--tolerance", "1e-2"]
        self.run_program(*options, "-o", "one.h5")
        self.mpirun(2, *options, "-o", "many.h5")
        self.assert_same_factors("one.h5", "many.h5")

    def test_the_largest_matrix_of_one_chunk_and_the_smallest_of_two_are_written(self):
        # Of a million entries, 262,144 fill a chunk: the rows at its end are in two blocks.
        for patches in ("20", "500", "1000"):
            with self.subTest(patches):
                options = ["factors", BOX, "--patches", patches, "--method", "exact",
                           "--precision", "double"]
                self.run_program(*options, "-o", "one.h5")
                self.mpirun(3, *options, "-o", "many.h5")
                self.assert_same_factors("one.h5", "many.h5")
                os.remove(self.folder / "one.h5")
                os.remove(self.folder / "many.h5")

    def test_a_file_that_a_process_cannot_write_is_reported_once(self):
        command = launch(3, "factors", BOX, "--patches", "2000", "--method", "exact", "-o", "f.h5")
        limited = ["bash", "-c", "ulimit -f 9000; " + shlex.join(command)]  # of 24 MB
        done = subprocess.run(limited, cwd=self.folder, timeout=limit(300), text=True, capture_output=True,
                              env=ENVIRONMENT)
        self.assertNotEqual(done.returncode, 0)
        lines = [line for line in done.stderr.splitlines() if line.startswith("radiosity: ")]
        self.assertEqual(len(lines), 1, done.stderr)
        self.assertRegex(lines[0], "f.h5: /form_factors/.* cannot be written: File too large")
        # A run of minutes, under a sanitizer, keeps its rows.
        left = [name for name in self.files() if not name.startswith("f.h5.rows")]
        self.assertEqual(left, ["box.mtl", "box.obj"])

    def run_at_work(self):
        """Three processes that are at work: a launcher that still starts them waits for a dead one."""
        run = subprocess.Popen(launch(3, "factors", str(DATA / "cluttered.obj"), "--patches", "3000",
                                      "--method", "exact", "-o", "f.h5"),
                               cwd=self.folder, env=ENVIRONMENT, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        while run.poll() is None and not all(t > 0.3 for t in work_of(run.pid, 3)):
            time.sleep(0.05)
        return run

    def test_a_killed_process_ends_all_and_is_named(self):
        run = self.run_at_work()
        os.kill(processes_of(run.pid)[1], signal.SIGKILL)
        out, err = run.communicate(timeout=limit(60))
        self.assertNotEqual(run.returncode, 0)
        self.assertRegex(out + err, r"rank 1 .*signal 9")
        self.assertFalse((self.folder / "f.h5").exists())

    def test_rows_that_processes_kept_are_found_by_any_number_of_them(self):
        options = ["factors", BOX, "--patches", "1500", "--method", "exact", "--tolerance", "1e-5"]
        self.run_program(*options, "-o", "one.h5")
        run = subprocess.Popen(launch(3, *options, "--resume", "-o", "f.h5"), cwd=self.folder,
                               env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        kept = [self.folder / name for name in ["f.h5.rows", "f.h5.rows.1", "f.h5.rows.2"]]
        while run.poll() is None and not all(f.exists() and f.stat().st_size > 20000 for f in kept):
            time.sleep(0.002)
        for process in processes_of(run.pid) if run.poll() is None else []:
            os.kill(process, signal.SIGKILL)
        run.wait()
        self.assertTrue(all(file.exists() for file in kept), "the run came to its end")
        done = self.mpirun(2, *options, "--resume", "-o", "f.h5")
        found = re.search(r"resumed: (\d+) of", done.stdout)
        self.assertGreater(int(found[1]), 0)
        self.assert_same_factors("one.h5", "f.h5")
        self.assertFalse([name for name in self.files() if ".rows" in name])

    def test_commands_that_processes_cannot_share_are_refused(self):
        done = self.mpirun(2, "factors", BOX, "--patches", "100", "--method", "hemicube", "--eye", "gl",
                           code=2)
        self.assertIn("--eye cpu", done.stderr)
        done = self.mpirun(2, "solve", BOX, "--patches", "100", "--method", "exact", "--solver",
                           "gauss-seidel", code=2)
        self.assertIn("petsc", done.stderr)
        alone = self.run_program("solve", BOX, "--patches", "100", "--solver", "petsc", code=2)
        self.assertIn("mpirun", alone.err)

    def test_a_fault_of_all_processes_is_reported_once(self):
        done = self.mpirun(3, "factors", "missing.obj", code=2)
        self.assertEqual(done.stderr.count("missing.obj"), 1)
        # A fault found by all processes, in PETSc, with few unknowns.
        done = self.mpirun(3, "solve", "box.obj", "--patches", "150", "--solver", "petsc", code=1,
                           petsc="-ksp_type nonsense")
        self.assertEqual(done.stderr.count("radiosity: "), 1)
        self.assertIn("Unknown type", done.stderr)

    def test_an_interrupt_ends_all_processes(self):
        run = self.run_at_work()
        processes = processes_of(run.pid)
        run.send_signal(signal.SIGINT)
        run.communicate(timeout=limit(60))
        self.assertNotEqual(run.returncode, 0)
        # The launcher kills and does not wait: a killed process gives back its memory for some
        # milliseconds yet, more on a busy machine.
        until = time.monotonic() + limit(10)
        while any(map(is_running, processes)) and time.monotonic() < until:
            time.sleep(0.01)
        self.assertFalse([p for p in processes if is_running(p)])
        self.assertNotIn("f.h5", self.files())


if __name__ == "__main__":
    unittest.main()
