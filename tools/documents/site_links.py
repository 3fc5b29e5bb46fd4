"""Check the links of a built site: every file and every anchor exists.

What a page loads, such as scripts, must be of the site too, so that it is
read without a network.

``make docs`` runs this::

    python -m tools.documents.site_links build/site

Links to other sites are not visited.
"""

import sys
from argparse import ArgumentParser
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LINKS = ("href", "src", "poster")


class PageLinks(HTMLParser):
    """Links and anchors of one page.

    Attributes:
        links: Addresses that the page names.
        loaded: Those that a browser loads with the page.
        anchors: Its anchors.
    """

    def __init__(self, text: str) -> None:
        """Read a page."""
        super().__init__()
        self.links: list[str] = []
        self.loaded: set[str] = set()
        self.anchors: set[str] = set()
        self.feed(text)

    def handle_starttag(
        self, tag: str, attrs: list[tuple[str, str | None]]
    ) -> None:
        """Collect the links and the anchor of a tag."""
        for name, value in attrs:
            if value and name in LINKS:
                self.links.append(value)
                if tag != "a":
                    self.loaded.add(value)
            elif value and name in ("id", "name"):
                self.anchors.add(value)


@cache
def read(page: Path) -> PageLinks:
    """Read a page, once."""
    return PageLinks(page.read_text(encoding="utf-8"))


def broken_links(site: Path) -> list[str]:
    """Return messages about links that lead nowhere.

    Args:
        site: Folder of the built site.
    """
    return [
        f"{page.relative_to(site)}: {link}: {reason}"
        for page in sorted(site.rglob("*.html"))
        if not page.is_relative_to(site / "_static")
        for link in dict.fromkeys(read(page).links)
        if (reason := complaint(page, link))
    ]


def complaint(page: Path, link: str) -> str:
    """Return why a link of a page leads nowhere; empty if it is good."""
    parts = urlsplit(link)
    if parts.scheme == "data":
        return ""
    if parts.scheme or parts.netloc:
        return "needs a network" if link in read(page).loaded else ""
    file = page
    if parts.path:
        file = (page.parent / unquote(parts.path)).resolve()
    if not file.is_file():
        return "no such file"
    anchor = unquote(parts.fragment)
    if anchor and file.suffix == ".html" and anchor not in read(file).anchors:
        return "no such anchor"
    return ""


def main() -> int:
    """Report broken links; return 1 if there are any."""
    parser = ArgumentParser(
        prog="python -m tools.documents.site_links", description=__doc__
    )
    parser.add_argument("site", type=Path)
    site = parser.parse_args().site.resolve()
    found = broken_links(site)
    print(*found, sep="\n", file=sys.stderr, end="\n" if found else "")
    pages = len([*site.rglob("*.html")])
    print(f"{len(found)} broken links on {pages} pages")
    return 1 if found else 0


if __name__ == "__main__":
    raise SystemExit(main())
