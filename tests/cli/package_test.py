"""What packages say of themselves. Packages are made, compared and installed by tools/nightly."""

import os
import re
import subprocess
import unittest
from pathlib import Path

ROOT = Path(os.environ["RADIOSITY_SOURCE_DIR"])
BUILD = Path(os.environ["RADIOSITY_BUILD_DIR"])


class Contents(unittest.TestCase):
    def test_what_is_compiled_in_is_listed_with_its_licence(self):
        text = subprocess.run([ROOT / "tools/sbom", BUILD, "1.0~test"], capture_output=True, text=True, check=True,
                              env={**os.environ, "SOURCE_DATE_EPOCH": "86400"}).stdout
        self.assertIn("Created: 1970-01-02T00:00:00Z", text)
        listed = dict(re.findall(r"^PackageName: (\S+)\n(?:.+\n)*?PackageLicenseComments: <text>(.+)</text>", text, re.M))
        # As their own copyright files have it.
        self.assertEqual(listed["debian-libeigen3-dev"], "MPL-2")
        self.assertEqual(listed["debian-libembree-dev"], "Apache-2.0")
        self.assertIn("debian-libcgal-dev", listed)
        self.assertNotIn("debian-libgtest-dev", listed)  # of the tests
        if os.environ["RADIOSITY_PAGES"] == "1":
            self.assertEqual([name for name in listed if name.startswith("npm-")], ["npm-three"])
        # Each is said to be in it, by an identifier of SPDX's letters.
        identifiers = re.findall(r"^SPDXID: (SPDXRef-[A-Za-z0-9.-]+)$", text, re.M)
        self.assertEqual(len(identifiers), len(set(identifiers)))
        self.assertEqual(identifiers[2:], re.findall(r"^Relationship: SPDXRef-radiosity CONTAINS (\S+)$", text, re.M))
        self.assertEqual(len(identifiers), 2 + len(listed))

    def test_the_version_to_cite_is_the_programs(self):
        said = subprocess.run([os.environ["RADIOSITY"], "--version"], capture_output=True, text=True, check=True).stdout
        cited = re.search(r"^version: (.+)$", (ROOT / "CITATION.cff").read_text(), re.M).group(1)
        self.assertEqual(said, f"radiosity {cited}\n")


if __name__ == "__main__":
    unittest.main()
