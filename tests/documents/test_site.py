"""Test that the documentation site holds every page and public name."""

import re
from pathlib import Path

import stepaside
from tools.documents import notebooks, site_links

DOCS = Path(__file__).parents[2] / "docs"
TREE = re.compile(r"```{toctree}\n(.*?)```", re.DOTALL)
NOT_ON_THE_SITE = {"images/README"}


def entries(page: Path) -> set[str]:
    """Return the pages that the tables of contents of a page list."""
    lines = "\n".join(TREE.findall(page.read_text(encoding="utf-8")))
    return {
        (page.parent / line).relative_to(DOCS).as_posix()
        for line in lines.splitlines()
        if line and not line.startswith(":")
    }


def test_every_page_is_in_one_table_of_contents() -> None:
    pages = [*DOCS.rglob("*.md")]
    found = [entry for page in pages for entry in entries(page)]
    assert len(found) == len(set(found))
    names = {p.relative_to(DOCS).with_suffix("").as_posix() for p in pages}
    names |= {f"tutorials/{script.stem}" for script in notebooks.scripts()}
    assert names - NOT_ON_THE_SITE - {"index"} == set(found)


def test_every_public_name_is_in_the_reference() -> None:
    page = (DOCS / "api.md").read_text(encoding="utf-8")
    listed = set(
        re.findall(r"^\.\. (?!py:c)[\w:]+:: (\w+)$", page, re.MULTILINE)
    ) - {"stepaside"}
    assert listed == set(stepaside.__all__) - {"__version__"}


def test_broken_links_of_a_site_are_found(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    (tmp_path / "index.html").write_text(
        '<a href="sub/page.html#good">1</a><a href="sub/page.html#bad">2</a>'
        '<a href="https://example.org/gone">3</a><img src="gone.png">'
        '<script src="https://example.org/set.js"></script>'
    )
    (tmp_path / "sub/page.html").write_text(
        '<p id="good"></p><a href="../index.html">4</a><a href="#good">5</a>'
    )
    assert site_links.broken_links(tmp_path) == [
        "index.html: sub/page.html#bad: no such anchor",
        "index.html: gone.png: no such file",
        "index.html: https://example.org/set.js: needs a network",
    ]
