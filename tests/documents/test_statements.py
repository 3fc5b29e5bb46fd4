"""Test that every statement of the docs names a test that exists."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "statements.md").read_text(encoding="utf-8")
NAMED = re.findall(r"`(tests/(?:\w+/)*test_\w+\.py)(?:::(\w+))?`", PAGE)
ROWS = [line for line in PAGE.splitlines() if line.startswith("| ")]


@pytest.mark.parametrize(("file", "name"), NAMED)
def test_the_test_behind_a_statement_exists(file: str, name: str) -> None:
    text = (ROOT / file).read_text(encoding="utf-8")
    wanted = f"\ndef {name}(" if name else "\ndef test_"
    assert wanted in text


def test_every_row_has_a_status_and_something_behind_it() -> None:
    rows = [r for r in ROWS if not r.startswith("| statement")]
    assert len(rows) > 25 and len(NAMED) > 25
    for row in rows:
        cells = [cell.strip() for cell in row.strip("|").split(" | ")]
        assert len(cells) == 3, row
        assert re.search(r"`(tests/(\w+/)*test_|stepaside )", cells[2]), row


def test_all_tests_of_circles_and_diamond_are_on_the_page() -> None:
    """Each theorem of the game has its row."""
    for name in ("Theorem 1", "Theorem 2", "no-capture bound"):
        assert name in PAGE
