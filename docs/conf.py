"""Sphinx's settings of the site (tools/site)."""

project = "radiosity"
author = "the authors of radiosity"
copyright = author
extensions = ["myst_parser"]
master_doc = "docs/index"
exclude_patterns = ["docs/made"]
html_theme = "alabaster"
html_theme_options = {"description": "light by the matrix method", "page_width": "76em", "sidebar_width": "15em",
                      "code_font_size": ".8em"}
html_sidebars = {"**": ["about.html", "navigation.html", "searchbox.html"]}
html_show_sourcelink = False
html_show_sphinx = False
html_copy_source = False
myst_heading_anchors = 4
