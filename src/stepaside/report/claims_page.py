"""The page of claims, in Markdown and HTML."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

HEAD = """# Every claim of the paper, measured

`stepaside reproduce` wrote this page. A row says what the paper claims, as it
should read, at which level it was measured, and whether it holds; where the
text reads otherwise, the last column says how.

"""
STYLE = (
    "body{font-family:sans-serif;margin:2rem auto;max-width:75rem;"
    "padding:0 1rem;color:#222;background:#fff}"
    "table{border-collapse:collapse}td,th{border-bottom:1px solid #ccc;"
    "padding:.3rem .6rem;text-align:left;vertical-align:top}"
    "img{max-width:100%}"
)


def markdown_page(
    rows: Sequence[dict[str, Any]], figures: Sequence[tuple[str, str]]
) -> str:
    """Text of the page.

    Args:
        rows: Claims as JSON objects.
        figures: Pairs of a caption and the name of a file beside the page.
    """
    held = sum(row["verdict"] == "holds" for row in rows)
    lines = [
        HEAD + f"{held} of {len(rows)} hold.",
        "",
        "| section | claim | level | expected | measured | unit | verdict "
        "| as printed |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        lines.append(
            f"| {row['section']} | {_text(row['claim'])} | {row['level']} "
            f"| {_expected(row)} | {_number(row['measured'])} "
            f"| {row['unit']} | **{row['verdict']}** "
            f"| {_text(row['as_printed'] or '')} |"
        )
    for caption, file in figures:
        lines += ["", f"![{caption}]({file})", "", f"*{caption}*"]
    return "\n".join(lines) + "\n"


def write_page(
    folder: Path,
    rows: Sequence[dict[str, Any]],
    figures: Sequence[tuple[str, str]],
) -> Path:
    """Write ``claims.md`` and ``claims.html``; return the latter."""
    import markdown

    text = markdown_page(rows, figures)
    (folder / "claims.md").write_text(text, encoding="utf-8")
    body = markdown.markdown(text, extensions=["tables"])
    html = folder / "claims.html"
    html.write_text(
        '<!doctype html><html lang="en"><meta charset="utf-8">'
        "<title>Every claim of the paper, measured</title>"
        f"<style>{STYLE}</style>{body}</html>",
        encoding="utf-8",
    )
    return html


def _text(text: str) -> str:
    """Keep the table and the stars of a text that Markdown would take."""
    return text.replace("|", "\\|").replace("*", "\\*")


def _expected(row: dict[str, Any]) -> str:
    value = _number(row["expected"])
    if row["relation"] != "=":
        sign = "&lt;" if row["relation"] == "<" else "&gt;"
        return f"{sign} {value}"
    return f"{value} ± {row['tolerance']:.2g}"


def _number(value: float | None) -> str:
    return "none" if value is None else f"{value:.5g}"
