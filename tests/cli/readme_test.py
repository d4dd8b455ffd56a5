"""Runs every command of the program that a README gives, follows links, measures lines."""
import os
import pathlib
import re
import shlex
import subprocess
import tempfile
import unittest

from cli_runner import HAS_PAGES

PROGRAM = os.environ["RADIOSITY"]
ROOT = pathlib.Path(os.environ["RADIOSITY_SOURCE_DIR"])
WIDTH = 120  # columns of a line, tables too
READMES = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md")] + sorted(
    p for folder in ("data", "src", "tests") for p in (ROOT / folder).rglob("README.md"))


# Commands that all READMEs have together, at least: those of `view`, and the others.
VIEWS = 2
OTHERS = 34


def fenced_lines(readme):
    """Lines of fenced blocks; one that ends in a backslash goes on in the next."""
    for block in re.findall(r"^```[^\n]*\n(.*?)^```", readme.read_text(), re.S | re.M):
        yield from re.sub(r"\\\n\s*", "", block).splitlines()


def tables(readme):
    """Names and contents of its tables for commands: fenced blocks that begin with ```csv NAME."""
    return re.findall(r"^```csv (\S+)\n(.*?)^```", readme.read_text(), re.S | re.M)


def commands(readme):
    """Argument lists of its `radiosity ...` lines."""
    for line in fenced_lines(readme):
        words = shlex.split(line.removeprefix("$ "), comments=True)
        if words and words[0] == "radiosity":
            yield words[1:]


def links(readme):
    """Targets of its links, written in place or named."""
    text = readme.read_text()
    return re.findall(r"\]\(([^)\s]+)\)", text) + re.findall(r"^\[[^\]]+\]: (\S+)$", text, re.M)


def anchors(readme):
    """Headings as links name them."""
    for title in re.findall(r"^#+ (.*)$", readme.read_text(), re.M):
        yield re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


class Readme(unittest.TestCase):
    FILES = READMES
    LEAST = OTHERS + (VIEWS if HAS_PAGES else 0)

    def test_every_command_runs(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "data").symlink_to(ROOT / "data")
            run = 0
            for readme in self.FILES:
                for name, text in tables(readme):
                    (pathlib.Path(folder) / name).write_text(text)
                for arguments in commands(readme):
                    if arguments[0] == "view" and not HAS_PAGES:
                        continue
                    done = subprocess.run([PROGRAM, *arguments], cwd=folder, capture_output=True,
                                          text=True)
                    said = f"{readme.relative_to(ROOT)}: {shlex.join(arguments)}\n{done.stderr}"
                    self.assertEqual(done.returncode, 0, said)
                    run += 1
            self.assertGreaterEqual(run, self.LEAST)

    def test_every_command_stands_in_a_fence(self):
        for readme in self.FILES:
            indented = re.findall(r"^    radiosity .*$", readme.read_text(), re.M)
            self.assertEqual(indented, [], readme.relative_to(ROOT))

    def test_every_link_leads_somewhere(self):
        for readme in self.FILES:
            for target in links(readme):
                if re.match(r"[a-z]+:", target):
                    continue
                path, _, anchor = target.partition("#")
                where = (readme.parent / path).resolve() if path else readme
                said = f"{readme.relative_to(ROOT)}: {target}"
                self.assertTrue(where.exists(), said)
                if anchor:
                    self.assertIn(anchor, list(anchors(where)), said)

    def test_every_line_fits_the_width(self):
        for readme in self.FILES:
            for number, line in enumerate(readme.read_text().splitlines(), 1):
                self.assertLessEqual(len(line), WIDTH, f"{readme.relative_to(ROOT)}:{number}")


if __name__ == "__main__":
    unittest.main()
