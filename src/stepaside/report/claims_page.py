"""Page of the paper's claims, in Markdown and HTML."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..core.atomic_output import atomic_draft

HEAD = """# Every claim of the paper, measured

`stepaside reproduce` wrote this page. A row says what the paper claims, as it
should read, at which level it was measured, and whether it holds; where the
text reads otherwise, the last column says how.

What is measured in physics is measured in several duels from random starts:
the page gives their mean, their standard deviation, the least and the
greatest. An equality holds if the mean is within the tolerance and every
single run within twice the tolerance; an inequality holds if every single run
is on its side. A run that has no such value, as after a fall, makes its row
fail.

"""
FIGURES = """## What the paper's own figures show

Read from captions and text only: the drawings themselves were not at hand, so
what can only be measured in them (the radius and the number of turns of
Fig. 2, against its ticks) stands here as not given. Figs. 1, 3 and 4 show no
measurement.

| figure | what | paper | where | ours |
|---|---|---|---|---|
"""
MADE = """## How this page was made

`stepaside reproduce --seed {seed} --runs {runs}`, results version
`{results}`, with {libraries}. `claims.json` holds the same rows.
"""
STYLE = (
    "body{font-family:sans-serif;margin:2rem auto;max-width:75rem;"
    "padding:0 1rem;color:#222;background:#fff}"
    "table{border-collapse:collapse}td,th{border-bottom:1px solid #ccc;"
    "padding:.3rem .6rem;text-align:left;vertical-align:top}"
    "img{max-width:100%}"
)
COLUMNS = (
    *("section", "claim", "level", "expected", "measured"),
    *("least to greatest", "runs", "unit", "verdict", "as printed"),
)


def markdown_page(
    rows: Sequence[Mapping[str, Any]],
    beside: Sequence[tuple[str, ...]],
    figures: Sequence[tuple[str, str]],
    made: Mapping[str, Any],
) -> str:
    """Return the page in Markdown.

    Args:
        rows: Claims as JSON objects.
        beside: Rows about the paper's figures: figure, quantity, value in
            the paper, its source, value measured here.
        figures: Pairs of a caption and the name of a file beside the page.
        made: First seed, number of runs, results version, libraries.
    """
    held = sum(row["verdict"] == "holds" for row in rows)
    lines = [
        HEAD + f"{held} of {len(rows)} hold.",
        "",
        "| " + " | ".join(COLUMNS) + " |",
        "|" + "---|" * len(COLUMNS),
    ]
    lines += [_line(_cells(row)) for row in rows]
    lines += ["", FIGURES + "\n".join(_line(row) for row in beside)]
    for caption, file in figures:
        lines += ["", f"![{caption}]({file})", "", f"*{caption}*"]
    with_what = ", ".join(f"{k} {v}" for k, v in made["libraries"].items())
    lines += ["", MADE.format(**dict(made) | {"libraries": with_what})]
    return "\n".join(lines)


def write_page(
    folder: Path,
    rows: Sequence[Mapping[str, Any]],
    beside: Sequence[tuple[str, ...]],
    figures: Sequence[tuple[str, str]],
    made: Mapping[str, Any],
) -> Path:
    """Write ``claims.md`` and ``claims.html``.

    Args:
        folder: Folder of the files.
        rows: As for :func:`markdown_page`.
        beside: As for :func:`markdown_page`.
        figures: As for :func:`markdown_page`.
        made: As for :func:`markdown_page`.

    Returns:
        Path of ``claims.html``.
    """
    import markdown

    text = markdown_page(rows, beside, figures, made)
    with atomic_draft(folder / "claims.md") as draft:
        draft.write_text(text, encoding="utf-8")
    body = markdown.markdown(text, extensions=["tables"])
    html = folder / "claims.html"
    page = (
        '<!doctype html><html lang="en"><meta charset="utf-8">'
        "<title>Every claim of the paper, measured</title>"
        f"<style>{STYLE}</style>{body}</html>"
    )
    with atomic_draft(html) as draft:
        draft.write_text(page, encoding="utf-8")
    return html


def _cells(row: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the cells of a claim in Markdown."""
    measured, extremes = _number(row["measured"]), ""
    if row["runs"] > 1:
        measured += f" ± {_number(row['spread'], 2)}"
        ends = (_number(row[end]) for end in ("least", "greatest"))
        extremes = " to ".join(ends)
    return (
        row["section"],
        row["claim"],
        row["level"],
        _expected(row),
        measured,
        extremes,
        str(row["runs"]),
        row["unit"],
        row["verdict"],
        row["as_printed"] or "",
    )


def _line(cells: Sequence[str]) -> str:
    """Return one row of a table."""
    return "| " + " | ".join(_text(cell) for cell in cells) + " |"


def _text(text: str) -> str:
    """Escape bars and stars; print verdicts in bold."""
    if text in ("holds", "fails"):
        return f"**{text}**"
    return text.replace("|", "\\|").replace("*", "\\*")


def _expected(row: Mapping[str, Any]) -> str:
    value = _number(row["expected"])
    if row["relation"] != "=":
        sign = "&lt;" if row["relation"] == "<" else "&gt;"
        return f"{sign} {value}"
    return f"{value} ± {row['tolerance']:.2g}"


def _number(value: float | None, digits: int = 5) -> str:
    return "none" if value is None else f"{value:.{digits}g}"
