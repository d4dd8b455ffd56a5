"""Lamps of photometric files on the command line: given, kept, changed, described, refused."""

import math
import unittest

import h5py
import numpy as np

from cli_runner import SMALL, CliTest

LUMENS = 683  # a watt
DARK = ["--set", "lamp.radiance=0"]
FLUX = 2 * math.pi * 100  # of a hemisphere of 100 cd


def lamp(candela="100 100", stated="1 -1", opening="0 0 0"):
    return f"IESNA:LM-63-2002\nTILT=NONE\n{stated} 1 2 1 1 2 {opening}\n1 1 0\n0 90\n0\n{candela}\n"


class PhotometricLamps(CliTest):
    def setUp(self):
        super().setUp()
        self.write("lamp.ies", lamp())

    def power(self, *arguments):
        return self.report("solve", *arguments)["solution"]["from_sky_W"]

    def test_a_closed_box_gets_all_of_it(self):
        # Up is y: it hangs at the ceiling and looks down. .25% a patch, each by itself.
        watts = self.power("box.obj", *SMALL, *DARK, "--light", "ies,lamp.ies,at=.5,1,.5")
        np.testing.assert_allclose(watts, FLUX / LUMENS, rtol=1e-3)
        watts = self.power("box.obj", *SMALL, *DARK, "--light", "ies,lamp.ies,at=.5,.9,.5,flux=2,3,4W")
        np.testing.assert_allclose(watts, [2, 3, 4], rtol=1e-3)

    def test_a_results_file_needs_its_file_no_more(self):
        first = self.power("box.obj", *SMALL, *DARK, "--light", "ies,lamp.ies,at=.5,.9,.5,name=Desk", "-o", "a.h5")
        (self.folder / "lamp.ies").unlink()
        run = self.run_program("solve", "a.h5")
        self.assertIn("solution       reused", run.out)
        run = self.run_program("solve", "a.h5", "--set", "Desk.flux=683lm", "--set", "Desk.at=.5,.8,.5")
        self.assertIn("form factors   reused", run.out)
        self.assertIn("W, 683 lm/W at Y of Rec. 709, at 0.5,0.8,0.5, lamp.ies", run.out)
        np.testing.assert_allclose(self.power("a.h5"), 1, rtol=1e-3)
        (light,) = self.report("info", "a.h5")["scene"]["lights"]
        self.assertEqual([light["kind"], light["stands"], light["file"]],
                         ["ies", "at 0.5, 0.8, 0.5", "lamp.ies"])
        self.assertEqual([light["power_W"], light["photometric"]], ["1, 1, 1", "683, 683, 683 lm"])
        run = self.run_program("solve", "a.h5", "--without", "Desk", "--set", "lamp.radiance=1")
        self.assertIn("left out: Desk", run.out)
        self.assertGreater(first[0], 0)

    def test_another_table_is_another_light(self):
        self.run_program("solve", "box.obj", *SMALL, *DARK, "--light", "ies,lamp.ies,at=.5,.9,.5", "-o", "a.h5")
        self.write("lamp.ies", lamp("100 0"))
        run = self.run_program("solve", "a.h5", "--light", "ies,lamp.ies,at=.5,.9,.5,flux=1")
        self.assertIn("form factors   reused", run.out)
        self.assertNotIn("solution       reused", run.out)

    def test_each_is_a_source(self):
        self.run_program("solve", "box.obj", *SMALL, "--light", "ies,lamp.ies,at=.5,.9,.5", "--basis", "surfaces",
                         "-o", "b.h5")
        with h5py.File(self.folder / "b.h5") as file:
            self.assertEqual(sorted(file["basis/names"].asstr()), ["ceiling/lamp", "ies"])

    def test_what_a_user_should_know_is_said(self):
        self.write("lamp.ies", lamp(stated="1 300"))
        run = self.run_program("solve", "box.obj", *SMALL, "--light", "ies,lamp.ies,at=.5,.9,.5")
        self.assertIn("lamp.ies: its table gives 628.319 lm, and its lamps 300 lm", run.out + run.err)
        run = self.run_program("solve", "box.obj", *SMALL, "--light", "ies,lamp.ies,at=5,.9,.5")
        self.assertIn("ies lights nothing: it stands in a body or behind surfaces", run.out)

    def test_a_list_has_several(self):
        (self.folder / "lamps").mkdir()
        self.write("lamps/a, b.ies", lamp())
        self.write("lamps/list.json", """[{"kind": "ies", "file": "a, b.ies", "at": [0.5, 0.9, 0.5], "flux": "683lm"},
            {"kind": "ies", "file": "a, b.ies", "at": [0.2, 0.9, 0.5], "flux": [1, 2, 3], "name": "desk"},
            {"kind": "point", "intensity": 10, "at": [0.5, 0.5, 0.5]}]""")
        self.run_program("solve", "box.obj", *SMALL, *DARK, "--lights", "lamps/list.json", "-o", "a.h5")
        lights = self.report("info", "a.h5")["scene"]["lights"]
        self.assertEqual([(light["name"], light["strength"], light["file"]) for light in lights],
                         [("ies", "1, 1, 1 W", "a, b.ies"), ("desk", "1, 2, 3 W", "a, b.ies"),
                          ("point", "10, 10, 10 W/sr", "")])
        for text, words in [("{}", ["bad.json: is not a list of lights"]), ("[]", ["bad.json: has no lights"]),
                            ("[1]", ["bad.json: light 1 is no object"]), ("[{}]", ["no light is called ''"]),
                            ('[{"kind": "point", "intensity": true}]', ["light 1: intensity is no number"]),
                            ('[{"kind": "point", "intensity": "1,at=2"}]', ["light 1: intensity '1,at=2' has a ="]),
                            ('[{"kind": "point", "intensity": 1, "at": [[1]]}]', ["light 1: at is no number"]),
                            ('[{"kind": "point", "power": 1}]', ["bad.json: light 1: ", "'power' is no parameter"]),
                            ('[{"kind": "ies", "file": "none.ies"}]', ["light 1: none.ies: no such file"]),
                            ("[", ["bad.json: is not JSON"])]:
            with self.subTest(text):
                self.write("bad.json", text)
                self.refuse("solve", "box.obj", "--lights", "bad.json", words=["--lights: ", *words])

    def test_lists_lose_no_lamp(self):
        def names(entries, *before):
            self.write("list.json", "[" + ",".join(
                '{"kind": "%s", "file": "lamp.ies", "at": [0.5, 0.9, 0.5]%s}' % (kind, rest)
                for kind, rest in entries) + "]")
            self.run_program("mesh", "box.obj", *SMALL[:2], *before, "--lights", "list.json", "-o", "a.h5")
            return [light["name"] for light in self.report("info", "a.h5")["scene"]["lights"]]

        single = ["--light", "ies,lamp.ies,at=.5,.5,.5"]
        unnamed = ("ies", "")
        self.assertEqual(names([unnamed, unnamed], *single), ["ies", "ies 2", "ies 3"])
        # The second takes no name that a later one has.
        self.assertEqual(names([unnamed, unnamed, ("ies", ', "name": "ies 2"')]), ["ies", "ies 3", "ies 2"])
        # A name that is there already is meant.
        self.assertEqual(names([("ies", ', "name": "desk"')], *single, "--light", "point,7,name=desk"), ["ies", "desk"])
        for text, line in [('{"kind": "point", "intensity": 1, "name": "desk"}', "'desk'"),
                           ('{"kind": "sun"}', "'sun'"), ('{"kind": "sky", "radiance": 1}', "'sky'")]:
            with self.subTest(text):
                self.write("bad.json", f'[{text}, {{"kind": "point", "intensity": 1}}, {text}]')
                self.refuse("solve", "box.obj", "--lights", "bad.json",
                            words=[f"--lights: bad.json: lights 1 and 3 are both called {line}; give each a name"])

    def test_a_list_and_its_lamps_are_not_replaced(self):
        self.write("a.json", '[{"kind": "ies", "file": "lamp.ies", "at": [0.5, 0.9, 0.5]}]')
        before = {name: (self.folder / name).read_bytes() for name in ("a.json", "lamp.ies")}
        for option in ("-o", "--report"):
            self.refuse("factors", "box.obj", *SMALL, "--lights", "a.json", option, "a.json",
                        words=["a.json: is the list of --lights; write to another name"])
        for lights in (["--lights", "a.json"], ["--light", "ies,lamp.ies"]):
            self.refuse("factors", "box.obj", *SMALL, "--quiet", *lights, "--report", "lamp.ies",
                        words=["lamp.ies: is a file of"])
        self.assertEqual(before, {name: (self.folder / name).read_bytes() for name in before})

    def test_what_is_no_lamp_is_refused(self):
        self.write("bad.ies", lamp("100 -1"))
        self.write("big.ies", lamp().replace("2 1 1 2 0", "2 999999999 1 2 0"))
        for text, words in [("ies", ["ies: it has no file; give file=lamp.ies or file=lamp.ldt"]),
                            ("ies,none.ies", ["none.ies: no such file"]),
                            ("ies,box.obj", ["box.obj: is no file of a lamp"]),
                            ("ies,bad.ies", ["bad.ies:7: an intensity below 0, -1 cd"]),
                            ("ies,big.ies", ["big.ies:3: ", "too short for so many"]),
                            ("ies,lamp.ies,to=1", ["'to' is no parameter of it; there are flux, name, file, at"])]:
            with self.subTest(text):
                self.refuse("solve", "box.obj", "--light", text, words=words)


if __name__ == "__main__":
    unittest.main()
