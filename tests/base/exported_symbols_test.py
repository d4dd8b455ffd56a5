"""What programs are linked to stays in the shared library as long as its SOVERSION does.

exported_symbols.txt has the functions of the version before. One that is gone, or has other arguments, is a
function that programs no longer find: raise SOVERSION in CMakeLists.txt, or put it back. New ones do no harm.
After a release, or with a new SOVERSION, the list is written anew:

    RADIOSITY_BUILD_DIR=build/release python3 tests/base/exported_symbols_test.py --write

Sizes of structs do not show here: it takes debug symbols to see those.
"""

import os
import re
import subprocess
import sys
import unittest
from pathlib import Path

LIST = Path(__file__).with_name("exported_symbols.txt")
LIBRARY = Path(os.environ["RADIOSITY_BUILD_DIR"]) / "libradiosity.so"


def read(*command):
    return subprocess.run([*command, LIBRARY], capture_output=True, text=True, check=True).stdout


def exported():
    """SONAME, and the functions that are defined here, without inline ones."""
    soname = re.search(r"soname: \[(.+)\]", read("readelf", "-dW"))[1]
    lines = read("nm", "-DC", "--defined-only").splitlines()
    return soname, {found[1] for line in lines if (found := re.match(r"\w+ T (.+)", line)) and "radiosity" in found[1]}


class ExportedSymbols(unittest.TestCase):
    def test_none_is_gone(self):
        soname, now = exported()
        listed_soname, *before = LIST.read_text().splitlines()
        self.assertEqual(soname, listed_soname, "the list is of another SOVERSION; write it anew (--write)")
        self.assertGreater(len(before), 400)
        self.assertEqual(sorted(set(before) - now), [], "gone: raise SOVERSION, or put them back")

    def test_all_belong_to_the_library(self):
        """No function of a package that is compiled in is to be found by others."""
        lines = read("nm", "-DC", "--defined-only").splitlines()
        foreign = [line for line in lines if re.match(r"\w+ T ", line) and "radiosity" not in line]
        self.assertEqual(foreign, [])


if __name__ == "__main__":
    if sys.argv[1:] == ["--write"]:
        name, functions = exported()
        LIST.write_text("\n".join([name, *sorted(functions)]) + "\n")
    else:
        unittest.main()
