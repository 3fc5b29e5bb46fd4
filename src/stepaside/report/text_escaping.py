"""Escaping of untrusted text for terminals, figures, Markdown and HTML.

A run folder may come from anywhere: its name, messages and settings are
untrusted text. Each output has its own active characters; the functions here
escape those of one output each.
"""

import json
import re
from base64 import b64encode
from collections.abc import Mapping
from hashlib import sha256
from typing import Any

from ..core.errors import visible

PLACEHOLDER = re.compile("@@([A-Z]+)@@")
INLINE = re.compile(r"<(script|style)>(.*?)</\1>", re.DOTALL)
ACTIVE = {ord(c): f"\\u{ord(c):04x}" for c in "<>&\u2028\u2029"}


def for_figure(text: str) -> str:
    """Escape text for Matplotlib.

    A dollar sign would begin a formula, and a label that begins with an
    underscore would be missing from the legend.
    """
    text = visible(text).replace("$", r"\$")
    return f" {text}" if text.startswith("_") else text


def for_markdown(text: str) -> str:
    """Escape text for Markdown, including HTML in it."""
    return "".join(
        c if c.isalnum() or c == " " or not c.isascii() else f"&#{ord(c)};"
        for c in visible(text)
    )


def for_script(value: Any) -> str:
    """Return JSON that cannot end the script element around it.

    Raises:
        ValueError: If a number is NaN or inf.
    """
    plain = json.dumps(value, separators=(",", ":"), allow_nan=False)
    return plain.translate(ACTIVE)


def fill_page(template: str, texts: Mapping[str, str], run: Any) -> str:
    """Fill in a page template and allow only its own scripts.

    Placeholders are like ``@@NAME@@``; ``@@RUN@@`` is a JSON value in a
    script element, ``@@POLICY@@`` in an attribute. All are replaced in one
    pass, so that those in the untrusted texts have no effect.
    """
    from html import escape

    filled = {name: escape(visible(text)) for name, text in texts.items()}
    filled |= {"RUN": for_script(run), "POLICY": policy_of(template)}
    return PLACEHOLDER.sub(lambda match: filled[match[1]], template)


def policy_of(page: str) -> str:
    """Return a policy that allows a page's inline scripts and styles only."""
    allowed: dict[str, list[str]] = {"script": [], "style": []}
    for kind, text in INLINE.findall(page):
        digest = b64encode(sha256(text.encode()).digest()).decode("ascii")
        allowed[kind].append(f"'sha256-{digest}'")
    return (
        "default-src 'none'; base-uri 'none'; form-action 'none'; "
        f"script-src {' '.join(allowed['script'])}; "
        f"style-src {' '.join(allowed['style'])}"
    )
