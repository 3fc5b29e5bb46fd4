"""Configuration of the documentation site; ``make docs`` builds it."""

import sys
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

import stepaside

sys.path.insert(0, str(Path(__file__).parents[1]))

from tools.documents.blocks import with_tables  # noqa: E402
from tools.documents.notebooks import complaints  # noqa: E402
from tools.documents.store import Store  # noqa: E402

project = "stepaside"
author = "The stepaside developers"
copyright = f"2026, {author}"
version = release = stepaside.__version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_click",
    "sphinx_copybutton",
    "sphinx_design",
    "tools.documents.mathml",
]
html_math_renderer = "mathml"
myst_enable_extensions = ["colon_fence", "dollarmath"]
myst_heading_anchors = 4
myst_links_external_new_tab = True
nb_execution_mode = "off"  # `make docs-run` executes the tutorials
nb_merge_streams = True
smartquotes = False  # they would spoil options such as --json
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_member_order = "bysource"
napoleon_use_ivar = True
exclude_patterns = ["images/README.md", "tutorials/*.py"]

html_theme = "furo"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_search_scorer = str(Path(__file__).parent / "_static/search_scores.js")
html_title = f"stepaside {version}"
html_theme_options = {
    "light_css_variables": {
        "color-brand-primary": "#1f5fbf",
        "color-brand-content": "#1f5fbf",
    },
    "dark_css_variables": {
        "color-brand-primary": "#7fb0f5",
        "color-brand-content": "#7fb0f5",
    },
}


def refuse_old_outputs(app: Sphinx) -> None:
    """Stop if outputs of tutorials are older than the code they ran."""
    found = complaints()
    if found:
        raise ExtensionError("\n".join(found))


def add_tables(app: Sphinx, name: str, source: list[str]) -> None:
    """Add the tables that are made when the site is built."""
    source[0] = with_tables(source[0], Store())


def setup(app: Sphinx) -> None:
    """Register the check of the tutorials and the tables."""
    app.connect("builder-inited", refuse_old_outputs)
    app.connect("source-read", add_tables)
