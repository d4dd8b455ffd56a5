"""What the program says of itself: -h and --help, manual pages, completions of shells."""

import re
import shutil
import subprocess
import unittest

from cli_runner import CliTest

COMMANDS = ["info", "mesh", "factors", "solve", "gather", "heat", "compare", "render", "illuminance", "view"]


def long_options(text):
    return set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", text))


def listed(help_text):
    """The long options that a whole help lists: one a line, or two, the second for its opposite."""
    return {name for line in help_text.splitlines() if re.match(r"  (-\w, )?--", line)
            for name in re.findall(r"--[a-z-]+", re.split("  +", line.strip())[0])}


class Help(CliTest):
    def test_the_short_one_names_all_options_on_a_screen(self):
        for command in COMMANDS:
            whole = self.run_program(command, "--help").out
            short = self.run_program(command, "-h").out
            wanted = {name for name in listed(whole) if not name.startswith("--no-")}
            self.assertGreater(len(wanted), 20)
            self.assertEqual(wanted - long_options(short), set(), command)
            self.assertLessEqual(len(short.splitlines()), 70)
            self.assertLessEqual(max(map(len, short.splitlines())), 100)


class Manuals(CliTest):
    def setUp(self):
        super().setUp()
        self.assertEqual(self.run_program("--manuals", "share").code, 0)
        self.pages = self.folder / "share/man/man1"

    def test_a_page_has_each_option_of_the_help(self):
        self.assertEqual(len(list(self.pages.iterdir())), 1 + len(COMMANDS))
        for command in COMMANDS:
            page = (self.pages / f"radiosity-{command}.1").read_text().replace("\\-", "-")
            bold = "\n".join(line for line in page.splitlines() if line.startswith(".B -"))
            self.assertEqual(long_options(bold), listed(self.run_program(command, "--help").out))
            self.assertIn(".SH EXAMPLES\n.nf\n", page)

    @unittest.skipUnless(shutil.which("groff"), "no groff")
    def test_groff_reads_the_pages_without_a_warning(self):
        for page in self.pages.iterdir():
            done = subprocess.run(["groff", "-man", "-ww", "-Tutf8", page], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
        # An example that begins with a quote or a dot would be taken for a request and vanish.
        self.assertIn("'*.flux=0'", subprocess.run(["groff", "-man", "-Tascii", self.pages / "radiosity-heat.1"],
                                                   capture_output=True, text=True).stdout)

    def bash(self, *words):
        """What bash offers for the last of these words."""
        script = self.folder / "share/bash-completion/completions/radiosity"
        done = subprocess.run(
            ["bash", "-c", f'. {script}; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _radiosity; '
             'printf "%s\\n" "${COMPREPLY[@]}"', "bash", "radiosity", *words],
            capture_output=True, text=True)
        self.assertEqual(done.stderr, "")
        return done.stdout.split()

    def test_bash_completes_subcommands_options_and_their_words(self):
        self.assertEqual(self.bash("re"), ["render"])
        self.assertEqual(set(COMMANDS) - set(self.bash("")), set())
        self.assertEqual(self.bash("--man"), ["--manuals"])
        for command in COMMANDS:
            self.assertEqual(set(name for name in self.bash(command, "--") if name.startswith("--")),
                             listed(self.run_program(command, "--help").out))
        self.assertEqual(self.bash("solve", "--method", "ex"), ["exact"])
        self.assertEqual(self.bash("solve", "--method", "=", "ex"), ["exact"])
        self.assertEqual(self.bash("solve", "x"), [])  # a file: bash's own

    def test_zsh_and_fish_read_theirs(self):
        for shell, place in [("zsh", "zsh/site-functions/_radiosity"),
                             ("fish", "fish/vendor_completions.d/radiosity.fish")]:
            text = (self.folder / "share" / place).read_text()
            for name in ["render", "final-gather", "gauss-seidel"]:
                self.assertIn(name, text)
            if shutil.which(shell):
                done = subprocess.run([shell, "-n", self.folder / "share" / place], capture_output=True, text=True)
                self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_a_folder_that_cannot_be_written_is_named(self):
        self.write("taken", "a file")
        self.refuse("--manuals", "taken", words=["taken/man"], code=2)
        self.refuse("--manuals", words=["--manuals"])


if __name__ == "__main__":
    unittest.main()
