"""Text of anybody, written where it can do nothing but be read.

A run folder may come from anywhere: its name, its messages and its settings
are text that somebody else chose. Every place where such text is shown has
its own characters that do something; here each is written out instead.
"""

import json
import re
from base64 import b64encode
from collections.abc import Mapping
from hashlib import sha256
from html import escape
from typing import Any
from unicodedata import category

UNSEEN = {"Cc", "Cf", "Cs", "Zl", "Zp"}  # control, format, halves, breaks
PLACE = re.compile("@@([A-Z]+)@@")
INLINE = re.compile(r"<(script|style)>(.*?)</\1>", re.DOTALL)
ACTIVE = {ord(c): f"\\u{ord(c):04x}" for c in "<>&\u2028\u2029"}


def visible(text: str, *, but: str = "") -> str:
    r"""Text without anything that is not seen, like ``\x1b`` for escape.

    Args:
        text: Of anybody; it may hold halves of characters, as names of
            files that are no text do.
        but: Characters that stay.
    """
    return "".join(
        c.encode("unicode_escape").decode("ascii")
        if category(c) in UNSEEN and c not in but
        else c
        for c in text
    )


def for_figure(text: str) -> str:
    """Text as a figure shows it: no formula, and never left out.

    A dollar would begin a formula, and labels that begin with an underscore
    stand in no legend.
    """
    text = visible(text).replace("$", r"\$")
    return f" {text}" if text.startswith("_") else text


def for_markdown(text: str) -> str:
    """Text as Markdown shows it, with no mark of Markdown or HTML in it."""
    return "".join(
        c if c.isalnum() or c == " " or not c.isascii() else f"&#{ord(c)};"
        for c in visible(text)
    )


def for_script(value: Any) -> str:
    """JSON that cannot end the script element that it stands in.

    Raises:
        ValueError: If a number is not finite.
    """
    plain = json.dumps(value, separators=(",", ":"), allow_nan=False)
    return plain.translate(ACTIVE)


def fill_page(template: str, texts: Mapping[str, str], run: Any) -> str:
    """Fill a page's places, and let nothing run but its own scripts.

    All places are filled in one pass, so what is filled in holds none.

    Args:
        template: Page with places like ``@@NAME@@``; ``@@RUN@@`` is in a
            script element, ``@@POLICY@@`` in an attribute.
        texts: Text for the places, in whatever characters.
        run: JSON value for ``@@RUN@@``.
    """
    filled = {name: escape(visible(text)) for name, text in texts.items()}
    filled |= {"RUN": for_script(run), "POLICY": policy_of(template)}
    return PLACE.sub(lambda place: filled[place[1]], template)


def policy_of(page: str) -> str:
    """Content security policy: a page's own scripts and styles alone."""
    allowed: dict[str, list[str]] = {"script": [], "style": []}
    for kind, text in INLINE.findall(page):
        digest = b64encode(sha256(text.encode()).digest()).decode("ascii")
        allowed[kind].append(f"'sha256-{digest}'")
    return (
        "default-src 'none'; base-uri 'none'; form-action 'none'; "
        f"script-src {' '.join(allowed['script'])}; "
        f"style-src {' '.join(allowed['style'])}"
    )
