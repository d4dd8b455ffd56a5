"""Pages of `radiosity view`, read back by another program; when it opens one."""

import base64
import gzip
import json
import os
import pty
import re
import subprocess
import time
import unittest

import h5py
import numpy as np
import scipy.sparse
from PIL import Image

from cli_runner import DATA, HAS_PAGES, PROGRAM, CliTest, limit

BOX = ["--patches", "60"]
TYPES = {"f32": np.float32, "u32": np.uint32, "u16": np.uint16, "u8": np.uint8}


class Page:
    """A page's header and arrays."""

    def __init__(self, path):
        text = path.read_text()
        found = re.findall(r'<script id="radiosity-data" type="application/octet-stream">([^<]*)</script>',
                           text)
        assert len(found) == 1
        assert "<!--radiosity-data-->" not in text
        data = gzip.decompress(base64.b64decode(found[0], validate=True))
        assert data[:8] == b"RADPAGE1"
        length = int.from_bytes(data[8:12], "little")
        self.header = json.loads(data[16:16 + length])
        self.arrays = {name: np.frombuffer(data, TYPES[a["type"]], a["length"], a["offset"])
                       for name, a in self.header["arrays"].items()}

    def __getitem__(self, name):
        return self.arrays[name]

    def rows(self, name):
        return self.arrays[name].reshape(-1, 3).astype(float)

    def factors(self):
        """F between nodes, dense."""
        n, q = self.header["nodes"], self.header["quantisation"]
        begin, column = self["factor_begin"], self["factor_column"]
        code = self["factor_code"].astype(float)
        value = np.where(code == 0, 0, np.exp(q["lowest"] + q["step"] * code))
        upper = np.zeros((n, n))
        for i in range(n):
            part = slice(begin[i], begin[i + 1])
            upper[i, column[part] if column.size else np.s_[i:]] = value[part]
        area = self["node_area"].astype(float)
        lower = np.triu(upper, 1) * area[:, None] / area[None, :]
        return upper + lower.T

    def solved(self, reflectance):
        """Radiosity where every patch is a node, band by band."""
        e, f = self.rows("emission"), self.factors()
        return np.stack([np.linalg.solve(np.eye(len(f)) - reflectance[:, [b]] * f, e[:, b])
                         for b in range(3)], axis=1)


def actions(report):
    return {stage: event["action"] for stage, event in report["stages"].items()}


@unittest.skipIf(HAS_PAGES, "the program was built with node and npm")
class WithoutNode(CliTest):
    def test_the_error_names_the_missing_tools(self):
        self.refuse("view", "box.obj", words=["node", "npm", "tools/setup"])


@unittest.skipUnless(HAS_PAGES, "the program was built without node and npm")
class Pages(CliTest):
    def page(self, name):
        return Page(self.folder / name)

    def test_a_page_holds_the_values_of_the_results_file(self):
        self.run_program("view", DATA / "cornell-box.obj", "--patches", "300", "-o", "p.html",
                         "-o", "p.h5")
        page = self.page("p.html")
        self.assertEqual(page.header["title"], "cornell-box")
        with h5py.File(self.folder / "p.h5") as file:
            light, mesh, f = file["solution"], file["mesh"], file["form_factors"]
            for name in ("reflectance", "emission", "irradiance"):
                # Single precision.
                np.testing.assert_allclose(page.rows(name), light[name][()], rtol=1e-7)
            np.testing.assert_allclose(page["area"], mesh["area"][()], rtol=1e-7)
            np.testing.assert_allclose(page["row_error"], f["error"][()], rtol=1e-7)
            full = scipy.sparse.csr_matrix((f["data"], f["indices"], f["indptr"]),
                                           f["shape"][()]).toarray()
        error = page.header["quantisation"]["largest_relative_error"]
        self.assertLess(error, 2.5e-4)
        # Areas are in single precision.
        np.testing.assert_allclose(page.factors(), full, rtol=error + 2e-7, atol=1e-9 / 300)

    def test_light_solved_from_a_page_is_that_of_solve(self):
        self.run_program("view", DATA / "cornell-box.obj", "--patches", "300", "-o", "p.html",
                         "-o", "p.h5", "--elements", "off")
        page = self.page("p.html")
        self.assertEqual(page["element_irradiance"].size, 0)
        self.run_program("solve", "p.h5", "--set", "white.reflectance=.95", "--solve-tolerance",
                         "1e-9")
        white = [m["name"] for m in page.header["materials"]].index("white")
        material = np.array([s["material"] for s in page.header["surfaces"]])[page["surface"]]
        reflectance = page.rows("reflectance")
        reflectance[material == white] = .95
        with h5py.File(self.folder / "p.h5") as file:
            expected = file["solution/radiosity"][()]
        # Pages may differ by this from the program.
        self.assertLess(abs(page.solved(reflectance) - expected).max(), 1e-3 * expected.max())

    def test_a_results_file_gives_all_stages(self):
        self.run_program("solve", "box.obj", *BOX, "-o", "s.h5")
        first = self.report("view", "s.h5", "-o", "a.html", "-o", "s.h5")
        self.assertEqual(actions(first), {"mesh": "reused", "form_factors": "reused",
                                          "solution": "reused", "elements": "computed"})
        again = self.report("view", "s.h5", "-o", "b.html")
        self.assertEqual(set(actions(again).values()), {"reused"})
        self.assertEqual((self.folder / "a.html").read_bytes(), (self.folder / "b.html").read_bytes())
        self.assertEqual(again["page"]["element_triangles"],
                         self.page("b.html")["element_triangle"].size / 3)

    def test_camera_and_exposure_equal_those_of_render(self):
        self.run_program("solve", "box.obj", *BOX, "-o", "s.h5", "-o", "lit.glb")
        picture = self.report("render", "s.h5", "-o", "p.png")["picture"]
        self.run_program("view", "s.h5", "-o", "p.html")
        header = self.page("p.html").header
        self.assertEqual(header["camera"]["eye"], picture["eye_m"])
        self.assertEqual(header["camera"]["target"], picture["target_m"])
        self.assertEqual(header["exposure"], picture["exposure_ev"])
        self.run_program("view", "s.h5", "-o", "p.html", "--exposure", "-1", "--camera",
                         "eye=.1,.5,.5;target=1,.5,.5;fov=50")
        header = self.page("p.html").header
        self.assertEqual(header["exposure"], -1)
        self.assertEqual(header["camera"]["eye"], [.1, .5, .5])
        self.assertAlmostEqual(header["camera"]["fov"], 50)

    def test_the_page_knows_the_arguments_that_draw_its_light(self):
        run = ["--quiet", "--report=r.json", "--exposure", "2", "--elements=off", "--threads", "1"]
        self.run_program("view", "box.obj", *BOX, *run, "--set", "wal*.reflectance=.5", "-o", "p.html")
        self.assertEqual(self.page("p.html").header["arguments"],
                         "box.obj --patches 60 --set 'wal*.reflectance=.5'")
        self.run_program("view", "box.obj", *BOX, *run, "-o", "p.html", "-o", "kept box.h5")
        self.assertEqual(self.page("p.html").header["arguments"], "'kept box.h5'")

    def heat_of_plates(self):
        self.write("plates.obj", "o floor\nv 0 0 0\nv 2 0 0\nv 2 0 2\nv 0 0 2\nf 4 3 2 1\n"
                                 "o plate\nv 0 1 0\nv 2 1 0\nv 2 1 2\nv 0 1 2\nf 5 6 7 8\n")
        self.run_program("heat", "plates.obj", *BOX, "--condition", "*.emissivity=.9", "--condition",
                         "floor.flux=100", "--condition", "plate.temperature=300", "-o", "s.h5")

    def test_heat_of_a_results_file_is_on_its_page_also_without_light(self):
        self.heat_of_plates()
        self.run_program("view", "s.h5", "-o", "p.html")
        page = self.page("p.html")
        with h5py.File(self.folder / "s.h5") as file:
            heat = file["heat"]
            for name in ("temperature", "net_flux"):
                np.testing.assert_allclose(page["heat_" + name], heat[name][()], rtol=1e-6, atol=1e-9)
            for name in ("irradiance", "radiosity"):
                np.testing.assert_allclose(page["heat_" + name], heat[name][()].sum(1), rtol=1e-6)
        self.assertEqual([s["name"] for s in page.header["heat"]["surfaces"]], ["floor", "plate"])

    def test_the_thumbnail_of_heat_shows_its_temperatures(self):
        self.heat_of_plates()
        view = ["--camera", "eye=3,3,4;target=1,.5,1;up=0,1,0;fov=40"]
        self.run_program("view", "s.h5", *view, "--gallery", "all")
        self.run_program("render", "s.h5", *view, "--show", "temperature", "--width", "480", "--height", "360",
                         "-o", "t.png")
        small, drawn = (np.asarray(Image.open(self.folder / name).convert("RGB")) for name in ("all/s.png", "t.png"))
        np.testing.assert_array_equal(small, drawn)
        self.assertGreater(len(np.unique(small.reshape(-1, 3), axis=0)), 20)

    def test_a_gallery_has_an_index_of_its_pages_with_thumbnails(self):
        (self.folder / "a & b.obj").write_text((self.folder / "box.obj").read_text())
        for scene in ("box.obj", "a & b.obj"):
            self.run_program("view", scene, *BOX, "--elements", "off", "--gallery", "all")
        gallery = self.folder / "all"
        self.assertEqual(sorted(p.name for p in gallery.iterdir()),
                         ["a & b.html", "a & b.png", "box.html", "box.png", "index.html"])
        index = (gallery / "index.html").read_text()
        self.assertEqual(re.findall('href="([^"]*)"', index), ["a%20%26%20b.html", "box.html"])
        self.assertEqual(re.findall('src="([^"]*)"', index), ["a%20%26%20b.png", "box.png"])
        self.assertIn("<span>a &amp; b</span>", index)
        self.assertEqual((gallery / "box.png").read_bytes()[16:24], b"\0\0\1\xe0\0\0\1\x68")  # 480 x 360
        self.assertEqual(self.page("all/box.html").header["arguments"], "box.obj --patches 60")
        (gallery / "index.html").write_text("<p>mine</p>")
        self.refuse("view", "box.obj", *BOX, "--gallery", "all", words=["index.html", "--gallery"])

    def test_one_band_is_grey(self):
        self.run_program("solve", "box.obj", *BOX, "-o", "s.h5")
        with h5py.File(self.folder / "s.h5", "r+") as file:
            for name in ("reflectance", "emission"):
                values = file["solution"][name][()][:, :1]
                del file["solution"][name]
                file["solution"][name] = values
            file["solution"].attrs["sky"] = np.zeros(1)
        self.run_program("view", "s.h5", "-o", "p.html")
        page = self.page("p.html")
        self.assertEqual(page.header["bands"], 1)
        light = page.rows("irradiance")
        np.testing.assert_array_equal(light[:, 0], light[:, 2])

    def test_impossible_pages_are_refused(self):
        for arguments, words in [
                (["-o", "p.png"], ["p.png: view writes .h5, .html"]),
                (["-o", "p.html", "--method", "hemicube"], ["box.obj", "--symmetrize"]),
                (["-o", "p.html", "--set", "lamp.radiance=0"], ["--set"]),
                (["-o", "nowhere/p.html"], ["nowhere"])]:
            with self.subTest(arguments=arguments):
                self.refuse("view", "box.obj", *arguments, words=words)

    def test_a_default_page_name_replaces_only_pages(self):
        self.write("box.html", "<p>mine</p>")
        self.refuse("view", "box.obj", *BOX, words=["box.html", "-o"])
        (self.folder / "box.html").unlink()
        self.run_program("view", "box.obj", *BOX, "--elements", "off")
        run = self.run_program("view", "box.obj", *BOX, "--elements", "off")
        self.assertRegex(run.out, r"(?m)^wrote +box.html ")
        self.assertEqual(self.files(), ["box.html", "box.mtl", "box.obj"])


@unittest.skipUnless(HAS_PAGES, "the program was built without node and npm")
class Desktop(CliTest):
    """With an xdg-open that records the files it is to open."""

    def setUp(self):
        super().setUp()
        self.write("xdg-open", f'#!/bin/sh\necho "$1" > {self.folder}/opened\n')
        (self.folder / "xdg-open").chmod(0o755)
        self.environment = {k: v for k, v in os.environ.items()
                            if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
        self.environment["PATH"] = f"{self.folder}:{os.environ['PATH']}"

    def view(self, *arguments, terminal=True, **environment):
        """The opened file, or None."""
        ours, theirs = pty.openpty()
        try:
            subprocess.run([PROGRAM, "view", "box.obj", *BOX, "--elements", "off", "--quiet", *arguments],
                           cwd=self.folder, env=self.environment | environment, timeout=limit(60),
                           check=True, stdout=theirs if terminal else subprocess.DEVNULL)
        finally:
            os.close(ours)
            os.close(theirs)
        opened = self.folder / "opened"
        # Nobody waits for it; an expected one comes within this.
        until = time.monotonic() + (10 if terminal and environment and not arguments else 0.3)
        while time.monotonic() < until and not (opened.exists() and opened.read_text()):
            time.sleep(0.02)
        if not opened.exists():
            return None
        text = opened.read_text().strip()
        opened.unlink()
        return text

    def test_a_page_with_a_default_name_opens_on_a_desktop(self):
        self.assertEqual(self.view(DISPLAY=":0"), "box.html")
        self.assertEqual(self.view(WAYLAND_DISPLAY="wayland-0"), "box.html")

    def test_nothing_opens_without_desktop_terminal_or_default_name(self):
        self.assertIsNone(self.view())
        self.assertIsNone(self.view("-o", "p.html", DISPLAY=":0"))
        self.assertIsNone(self.view(terminal=False, DISPLAY=":0"))

    def test_a_missing_xdg_open_is_ignored(self):
        (self.folder / "xdg-open").unlink()
        self.environment["PATH"] = str(self.folder)
        self.assertIsNone(self.view("--report", "r.json", DISPLAY=":0"))


if __name__ == "__main__":
    unittest.main()
