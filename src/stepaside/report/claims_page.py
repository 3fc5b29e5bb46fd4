"""Page of the paper's claims, in Markdown."""

from collections.abc import Mapping, Sequence
from typing import Any

HEAD = """# Every claim of the paper, measured

`stepaside reproduce` wrote this page. A row says what the paper claims, as it
should read, and at which level it was measured; the last column says how the
text reads otherwise. Units are in brackets.
"""
IN_PHYSICS = """
In physics, {runs} duels from random starts give mean, standard deviation and,
in brackets, the least and the greatest. An equality holds if the mean is
within the tolerance and every run within twice the tolerance; an inequality
if every run is on its side. A run without such a value, as after a fall,
makes its row fail.
"""
MADE = """## How this page was made

`stepaside reproduce --seed {seed} --runs {runs}`, results version
`{results}`, with {libraries}. `claims.json` holds the same rows.
"""
COLUMNS = "section", "claim", "level", "expected", "measured", "as printed"


def markdown_page(
    rows: Sequence[Mapping[str, Any]],
    figures: Sequence[tuple[str, str]],
    made: Mapping[str, Any],
) -> str:
    """Return the page in Markdown.

    Args:
        rows: Claims as JSON objects.
        figures: Pairs of a caption and the name of a file beside the page.
        made: First seed, number of runs, results version, libraries.
    """
    held = sum(row["verdict"] == "holds" for row in rows)
    physics = IN_PHYSICS.format(runs=made["runs"]) if made["runs"] else ""
    lines = [
        HEAD + physics + f"\n{held} of {len(rows)} hold.",
        "",
        _line(COLUMNS),
        "|" + "---|" * len(COLUMNS),
    ]
    lines += [_line(_cells(row)) for row in rows]
    for caption, file in figures:
        lines += ["", f"![{caption}]({file})", "", f"*{caption}*"]
    with_what = ", ".join(f"{k} {v}" for k, v in made["libraries"].items())
    lines += ["", MADE.format(**dict(made) | {"libraries": with_what})]
    return "\n".join(lines)


def _cells(row: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the cells of a claim in Markdown."""
    measured = _number(row["measured"])
    if row["runs"] > 2:  # the spread of two is their difference
        ends = (_number(row[end], 4) for end in ("least", "greatest"))
        spread = _number(row["spread"], 2)
        measured += f" ± {spread} ({' to '.join(ends)})"
    if row["verdict"] != "holds":
        measured += ": fails"
    expected = _expected(row)
    if row["unit"] != "1":
        expected += f" [{row['unit']}]"
    return (
        row["section"],
        row["claim"],
        row["level"],
        expected,
        measured,
        row["as_printed"] or "",
    )


def _line(cells: Sequence[str]) -> str:
    """Return one row of a table."""
    return (
        "| "
        + " | ".join(c.replace("|", "\\|").replace("*", "\\*") for c in cells)
        + " |"
    )


def _expected(row: Mapping[str, Any]) -> str:
    value = _number(row["expected"])
    if row["relation"] != "=":
        sign = "&lt;" if row["relation"] == "<" else "&gt;"
        return f"{sign} {value}"
    return f"{value} ± {row['tolerance']:.2g}"


def _number(value: float | None, digits: int = 5) -> str:
    return "none" if value is None else f"{value:.{digits}g}"
