"""Generated numbers in the text, each followed by a comment with its source.

``0.655<!--= duel-seed7:summary.distance_m-->``: a code host shows the number
alone. The number of decimals is kept. A factor converts units:
``66<!--= duel-seed7:summary.distance_m * 100--> cm``. The word "no" stands
for zero.
"""

import re
from collections.abc import Iterator

from .parts import Part
from .store import DocumentError, Store

MARK = "<!--="
NUMBER = re.compile(
    r"(?P<shown>(?:(?<![\w>])[-−+])?\d[\d,]*(?:\.\d+)?|\b[Nn]o)?"
    r"<!--= *(?P<source>(?P<address>[^\s>]+)"
    r"(?: (?P<operator>[*/]) (?P<factor>[\d.e-]+))?) *-->"
)


def number_parts(text: str, store: Store) -> Iterator[Part]:
    """Yield every generated number of a document.

    Args:
        text: Text of the document.
        store: Results that the comments name.
    """
    read = set()
    for match in NUMBER.finditer(text):
        shown, source = match["shown"] or "", match["source"]
        read.add(match.start() + len(shown))
        wanted, problem = None, ""
        try:
            if not shown:
                raise DocumentError("a mark must follow a number")
            value = _scaled(store.value(match["address"]), match)
            wanted = show(value, shown)
        except DocumentError as error:
            problem = str(error)
        yield Part(match.start(), shown, wanted, source, problem)
    for match in re.finditer(MARK, text):
        if match.start() not in read:
            problem = "a mark must read <!--= name:path.to.value * factor-->"
            yield Part(match.start(), "", None, MARK, problem)


def show(value: float, like: str) -> str:
    """Format a number like another one.

    Args:
        value: Number.
        like: Formatted number, whose decimals, thousands commas and signs are
            used; "no" stands for zero.
    """
    if like.lower() == "no":
        return like if value == 0 else f"{value:g}"
    decimals = len(like.partition(".")[2])
    comma = "," if "," in like else ""
    sign = "+" if like.startswith("+") else ""
    text = f"{value:{sign}{comma}.{decimals}f}"
    return text.replace("-", "−") if "−" in like else text


def _scaled(value: object, match: re.Match[str]) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise DocumentError(f"{match['address']} is no number, got {value!r}")
    if match["operator"] is None:
        return value
    factor = float(match["factor"])
    return value * factor if match["operator"] == "*" else value / factor
