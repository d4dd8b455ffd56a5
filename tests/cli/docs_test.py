"""The same of the pages of the site (docs/): their commands run, in order of the index, and links lead somewhere."""
import re
import unittest

import readme_test

DOCS = readme_test.ROOT / "docs"
MADE = {"reference/index", "depth"}  # by tools/site
ORDER = re.findall(r"^[a-z/]+$", (DOCS / "index.md").read_text().split("{toctree}")[1], re.M)
PAGES = [DOCS / "index.md"] + [DOCS / f"{name}.md" for name in ORDER if name not in MADE]


class Docs(readme_test.Readme):
    FILES = PAGES
    LEAST = 35

    def test_every_page_is_in_the_index(self):
        self.assertEqual(sorted(DOCS.rglob("*.md")), sorted(PAGES))

    def test_every_figure_is_made(self):
        made = "".join(page.read_text() for page in PAGES)
        for name in re.findall(r"\{figure\} /docs/made/(\S+)", made):
            self.assertRegex(made, rf"(?m)^radiosity .*(?:\n .*)? -o {re.escape(name)}\b")


if __name__ == "__main__":
    unittest.main()
