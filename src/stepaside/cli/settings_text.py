"""Settings as text: a configuration that explains each of its entries."""

from dataclasses import is_dataclass
from textwrap import wrap
from typing import Any

from ..core.entries import to_entries
from ..core.setting import descriptions_of

WIDTH = 76  # characters of a comment


def commented(settings: Any) -> str:
    """Return a configuration in TOML with a comment above each entry."""
    summary = f"# {(type(settings).__doc__ or '').splitlines()[0]}"
    return "\n".join([summary, *_lines(settings, ())]) + "\n"


def _lines(settings: Any, section: tuple[str, ...]) -> list[str]:
    """Return the entries of a section, then its subsections."""
    lines, subsections = [], []
    for name, each in descriptions_of(type(settings)).items():
        value = getattr(settings, name)
        comment = "\n".join(
            f"# {line}" for line in wrap(each.full_text, WIDTH)
        )
        path = (*section, name)
        if isinstance(value, tuple) and value and is_dataclass(value[0]):
            for one in value:
                subsections += ["", comment, f"[[{'.'.join(path)}]]"]
                subsections += _lines(one, path)
        elif is_dataclass(value):
            subsections += ["", comment, f"[{'.'.join(path)}]"]
            subsections += _lines(value, path)
        elif value is None:
            lines += [comment, f"# {name} ="]
        else:
            lines += [comment, f"{name} = {_inline(value)}"]
    return lines + subsections


def _inline(value: Any) -> str:
    """Return a value as one line of TOML."""
    import tomli_w

    value = to_entries(value)
    if isinstance(value, dict):
        pairs = (f"{name} = {_inline(each)}" for name, each in value.items())
        return f"{{ {', '.join(pairs)} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(_inline, value))}]"
    return tomli_w.dumps({"x": value}).removeprefix("x = ").strip()
