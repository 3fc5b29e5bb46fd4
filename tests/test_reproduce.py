"""Test the claims: rows measure something, and broken laws make them fail."""

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from stepaside.cli import main
from stepaside.report.claims_page import markdown_page
from stepaside.studies import reproduce, unicycle_claims
from stepaside.studies.claims import Row

QUICK = ("circle", "saturated", "strategies", "sampled", "path", "com")


@pytest.mark.parametrize("job", [*QUICK, "footsteps"])
def test_claims_of_theory_and_planner_hold(job: str) -> None:
    for row in reproduce.JOBS[job](1):
        assert row.holds, row


def test_feet_that_slip_make_the_circle_smaller() -> None:
    """Under which floor: friction 0.05, against 0.8."""
    for row in reproduce.JOBS["slip"](1):
        assert row.holds, row


@pytest.mark.parametrize(
    ("relation", "measured", "holds"),
    [
        ("=", 1.05, True),
        ("=", 1.2, False),
        ("<", 0.9, True),
        ("<", 1.0, False),
        (">", 1.1, True),
        ("=", float("nan"), False),
        ("<", float("-inf"), False),
    ],
)
def test_verdict(relation: Any, measured: float, holds: bool) -> None:
    row = Row("it is one", "I", "paper", 1.0, measured, 0.1, "m", relation)
    assert row.holds is holds
    assert row.to_json()["verdict"] == ("holds" if holds else "fails")


def test_a_sign_broken_in_the_evaders_law_fails_a_row(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The evader that turns the wrong way ends on no such circle."""
    from stepaside.unicycle.simulate import simulate as right

    def wrong(game: Any, start: Any, duration: float) -> Any:
        from dataclasses import replace

        flipped = replace(game, angle=3.0 - game.angle)
        return right(flipped, start, duration)

    monkeypatch.setattr(unicycle_claims, "simulate", wrong)
    assert not all(row.holds for row in unicycle_claims.circle_rows())


def test_an_arc_that_bends_to_one_side_fails_a_row(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Eq. (10) as printed."""
    from stepaside.planning import UnicycleTrajectory

    right = UnicycleTrajectory.poses

    def printed(self: UnicycleTrajectory, times: Any) -> Any:
        poses = right(self, times)
        poses[..., 1] *= -1.0 if self.bearing < 0.0 else 1.0
        return poses

    monkeypatch.setattr(UnicycleTrajectory, "poses", printed)
    assert not all(row.holds for row in reproduce.JOBS["path"](1))


def test_command_goes_on_where_it_stopped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    measured = []

    def job(seed: int) -> list[Row]:
        measured.append(seed)
        return [Row("it is", "I", "paper", 1.0, 1.0, 0.1, "m")]

    monkeypatch.setattr(reproduce, "JOBS", {"one": job, "two": job})
    rows = reproduce.reproduce(tmp_path, 4)
    assert measured == [4, 4]
    assert reproduce.reproduce(tmp_path, 4) == rows
    assert measured == [4, 4]
    page = markdown_page(rows, [("A figure", "a.png")])
    assert "2 of 2 hold" in page
    assert "![A figure](a.png)" in page


def test_command_prints_rows_and_writes_the_page(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from stepaside.commands import reproduce as command

    quick = {"path": reproduce.JOBS["path"]}
    monkeypatch.setattr(reproduce, "JOBS", quick)
    monkeypatch.setattr(command, "_figures", lambda *_: [])
    result = CliRunner().invoke(
        main, ["reproduce", "--output", str(tmp_path), "--json"]
    )
    assert result.exit_code == 0, result.stderr
    rows = json.loads(result.stdout)
    for row in rows:
        assert row["measured"] is not None
        for key in ("claim", "section", "expected", "tolerance", "verdict"):
            assert key in row
    html = (tmp_path / "claims.html").read_text()
    assert html.count("<tr>") == len(rows) + 1
    assert html.count("<td") == 8 * len(rows)  # bars in texts split no cell
    assert "|theta*|" in html
