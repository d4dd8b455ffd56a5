"""Outputs as an unlucky person meets them: behind links, with long names, on lost standard output,
beside what killed runs left."""

import os
import re
import resource
import signal
import subprocess
import sys
import time
import unittest

import h5py

from cli_runner import DATA, PROGRAM, SMALL, CliTest, limit

# Every subcommand that writes, and what it writes.
WRITES = [("mesh", "box.obj", "m.obj"), ("mesh", "box.obj", "m.h5"), ("factors", "box.obj", "f.mtx"),
          ("factors", "box.obj", "f.hdf5"), ("solve", "box.obj", "s.h5"), ("solve", "box.obj", "s.csv"),
          ("solve", "box.obj", "s.glb"), ("render", "box.obj", "p.png"), ("render", "box.obj", "p.exr")]


def options(command):
    return ["--patches", "60"] if command == "mesh" else SMALL


class Links(CliTest):
    def test_every_output_goes_where_a_link_leads(self):
        (self.folder / "there").mkdir()
        for command, scene, name in WRITES:
            for before in (None, b"old"):
                with self.subTest(name=name, before=before):
                    link, target = self.folder / name, self.folder / "there" / ("real-" + name)
                    # To a link, and relative to the folder of the link.
                    (self.folder / "there" / name).symlink_to(target.name)
                    link.symlink_to("there/" + name)
                    if before:
                        target.write_bytes(before)
                        target.chmod(0o640)
                    self.run_program(command, scene, *options(command), "-o", name)
                    self.assertTrue(link.is_symlink())
                    self.assertTrue((self.folder / "there" / name).is_symlink())
                    self.assertGreater(target.stat().st_size, 30)
                    if before:
                        self.assertEqual(target.stat().st_mode & 0o777, 0o640)
                    self.assertEqual(sorted(os.listdir(self.folder / "there")), sorted([name, target.name]))
                    for path in (link, self.folder / "there" / name, target):
                        path.unlink()

    def test_results_behind_a_link_are_updated_there(self):
        self.run_program("solve", "box.obj", *SMALL, "-o", "real.h5")
        (self.folder / "s.h5").symlink_to("real.h5")
        for change in (["--set", "wall.reflectance=.3"], ["--patches", "90"]):
            before = (self.folder / "real.h5").read_bytes()
            self.run_program("solve", "s.h5", *change)
            self.assertTrue((self.folder / "s.h5").is_symlink())
            self.assertNotEqual(before, (self.folder / "real.h5").read_bytes())

    def test_a_link_to_an_input_or_to_itself_is_refused(self):
        (self.folder / "a.mtx").symlink_to("a.mtx")
        self.refuse("factors", "box.obj", *SMALL, "-o", "a.mtx", words=["a.mtx: is a link that leads to itself"])
        (self.folder / "b.obj").symlink_to("box.obj")
        self.refuse("mesh", "box.obj", "-o", "b.obj", words=["b.obj: is the input itself"])
        (self.folder / "c.csv").symlink_to("d.csv")
        self.refuse("solve", "box.obj", *SMALL, "-o", "c.csv", "-o", "d.csv", words=["named twice"])


class Names(CliTest):
    def test_names_as_long_as_the_system_allows_are_written(self):
        for command, scene, name in WRITES:
            extension = name[name.index("."):]
            longest = "a" * (255 - len(extension)) + extension
            with self.subTest(name=name):
                self.run_program(command, scene, *options(command), "-o", longest)
                (self.folder / longest).unlink()

    def test_longer_names_fail_before_the_work(self):
        for command, scene, name in WRITES:
            extension = name[name.index("."):]
            with self.subTest(name=name):
                self.refuse(command, scene, *options(command), "-o", "a" * (256 - len(extension)) + extension,
                            words=["longer than the system allows", "256 bytes"])
        self.refuse("info", "box.obj", "--report", "a" * 256, words=["longer than the system allows"])

    def test_a_report_over_an_output_is_refused(self):
        (self.folder / "link.csv").symlink_to("s.csv")
        for report in ("s.csv", "./s.csv", str(self.folder / "s.csv"), "link.csv"):
            self.refuse("solve", "box.obj", *SMALL, "-o", "s.csv", "--report", report,
                        words=[f"{report}: ", "an output", "--report"])
        self.refuse("render", "box.obj", *SMALL, "-o", "p.png", "--report", "p.png", words=["--report"])


class StandardOutput(CliTest):
    def run_to(self, out, *arguments, **more):
        return subprocess.run([PROGRAM, *arguments], cwd=self.folder, stdout=out, stderr=subprocess.PIPE,
                              text=True, timeout=limit(300), check=False, **more)

    def test_lost_lines_are_a_failure(self):
        for arguments in (["info", "box.obj"], ["--help"], ["solve", "--help"], ["--version"],
                          ["factors", "box.obj", *SMALL, "--between", "surfaces"]):
            with open("/dev/full", "w", encoding="utf8") as full:
                run = self.run_to(full, *arguments)
            self.assertEqual(run.returncode, 1, arguments)
            self.assertEqual(run.stderr.splitlines()[-1],
                             "radiosity: standard output cannot be written; is its disk full?")

    def test_a_reader_that_has_enough_is_none(self):
        reading, writing = os.pipe()
        os.close(reading)
        run = self.run_to(writing, "info", "box.obj")
        os.close(writing)
        self.assertEqual((run.returncode, run.stderr), (0, ""))

    def test_quiet_runs_lose_nothing(self):
        with open("/dev/full", "w", encoding="utf8") as full:
            self.assertEqual(self.run_to(full, "info", "box.obj", "--quiet").returncode, 0)

    def test_closed_standard_files_are_not_mistaken_for_outputs(self):
        self.run_program("solve", "box.obj", *SMALL, "-o", "a.csv")
        for closed in ([0], [1], [0, 1, 2]):
            run = self.run_to(None, "solve", "box.obj", *SMALL, "-o", "b.csv",
                              preexec_fn=lambda numbers=closed: [os.close(n) for n in numbers])
            self.assertEqual(run.returncode, 1 if 1 in closed else 0)
            self.assertEqual((self.folder / "a.csv").read_bytes(), (self.folder / "b.csv").read_bytes())


class Killed(CliTest):
    def test_the_next_run_removes_what_a_killed_one_left(self):
        # Form factors of so many pixels take long on any machine.
        slow = ["--patches", "2000", "--method", "hemicube", "--resolution", "2048"]
        for name in ("f.mtx", "f.h5"):
            before = self.files()
            run = subprocess.Popen([PROGRAM, "factors", "box.obj", *slow, "-o", name, "--no-resume"],
                                   cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            until = time.monotonic() + limit(60)
            while self.files() == before and time.monotonic() < until:
                time.sleep(0.02)
            left = sorted(set(self.files()) - set(before))
            self.assertRegex(left[0], r"^\.radiosity-.*\.tmp\.")
            # As long as the run lives, others leave its file alone.
            self.run_program("factors", "box.obj", *SMALL, "-o", name)
            self.assertIn(left[0], self.files())
            (self.folder / name).unlink()
            run.send_signal(signal.SIGKILL)
            run.wait()
            self.assertIn(left[0], self.files())
            # Neither does another output's run touch it.
            self.run_program("factors", "box.obj", *SMALL, "-o", "other.mtx")
            (self.folder / "other.mtx").unlink()
            self.assertIn(left[0], self.files())
            self.run_program("factors", "box.obj", *SMALL, "-o", name)
            self.assertEqual(self.files(), sorted([*before, name]))
            (self.folder / name).unlink()


class Memory(CliTest):
    @unittest.skipIf("ASAN_OPTIONS" in os.environ, "sanitizers take more than that for themselves")
    def test_too_little_memory_is_not_another_fault(self):
        said = set()
        # The smallest end before the program's first line.
        for megabytes in range(100, 1000, 50):
            most = megabytes << 20
            run = subprocess.run([PROGRAM, "factors", "box.obj", "--patches", "60", "--method", "rays"],
                                 cwd=self.folder, capture_output=True, text=True, timeout=limit(300), check=False,
                                 preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (most, most)))
            self.assertNotIn("processor", run.stderr)
            if run.returncode == 1:
                said.add(re.sub(r"[0-9.]+", "N", run.stderr))
        self.assertTrue(said)


class ForeignFiles(CliTest):
    """Results files that another program damaged, with the line that says so."""

    def damaged(self, change):
        self.run_program("solve", "box.obj", *SMALL, "-o", "s.h5")
        with h5py.File(self.folder / "s.h5", "r+") as file:
            change(file)

    def refuse_all(self, *words):
        for arguments in (["info"], ["factors", "--resolution", "16"], ["factors", "--between", "surfaces"],
                          ["solve", "--set", "wall.reflectance=.3"], ["render", "-o", "p.png"]):
            self.refuse(arguments[0], "s.h5", *arguments[1:], words=["s.h5: ", *words])

    def test_damaged_meshes_and_accounts_are_refused_by_name(self):
        def all_backs(file):
            file["mesh/side"][...] = 1

        def empty_loop(file):
            file["mesh/polygons/corner_offset"][1] = 0

        def nan_account(file):
            file["form_factors/sky"][...] = float("nan")

        for change, words in ((all_backs, "/mesh/side has a back without a front at 0"),
                              (empty_loop, "/mesh/polygons/corner_offset gives 0 less than 3 values"),
                              (nan_account, "/form_factors/sky holds nan at 0")):
            self.damaged(change)
            self.refuse_all(words)

    def test_what_hdf5_cannot_even_open_gets_one_line(self):
        # Fuzzed: a block of 1 TB. The library said more when the process ended.
        found = DATA.parent / "tests/fuzz/corpus/h5/c06e0f7fd3ae"
        (self.folder / "s.h5").write_bytes(found.read_bytes())
        self.refuse("info", "s.h5", words=["s.h5: is truncated or damaged"])

    def test_moved_vertices_do_not_keep_their_form_factors(self):
        def move(file):
            file["mesh/vertices"][0] += 0.25
        self.damaged(move)
        self.refuse_all("/mesh/geometry_hash is not that of /mesh")

    def test_no_other_file_is_read(self):
        os.mkfifo(self.folder / "pipe")

        def external(file):
            names = file["mesh/surface_names"]
            shape, dtype = names.shape, names.dtype
            del file["mesh/surface_names"]
            file.create_dataset("mesh/surface_names", shape, dtype, external=[("/etc/passwd", 0, 200)])

        def linked(file):
            del file["solution"]
            file["solution"] = h5py.ExternalLink("pipe", "/solution")

        for change, words in ((external, "/mesh/surface_names has its values in another file"),
                              (linked, "/solution is a link to another file")):
            self.damaged(change)
            self.refuse_all(words)


if __name__ == "__main__":
    sys.exit(unittest.main())
