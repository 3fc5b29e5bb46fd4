"""Rounds of a visit: how long, and how near."""

from math import inf

import pytest

pytest.importorskip("viser")

from stepaside.report.viewer.scoreboard import MAX_ROUNDS, Scoreboard  # noqa: E402


def played(score: Scoreboard, *distances: float, began: float = 0.0) -> None:
    """Play a round of a sample every tenth of a second."""
    score.begin(began)
    for number, distance in enumerate(distances, 1):
        score.update(began + 0.1 * number, distance)


def test_an_undriven_game_is_no_round() -> None:
    score = Scoreboard()
    score.update(1.0, 0.3)
    score.end("fall")
    assert score.text() == "" and not score.is_close(0.8)


def test_a_second_command_begins_no_second_round() -> None:
    score = Scoreboard()
    played(score, 0.9, 0.7)
    score.begin(5.0)
    score.update(6.0, 0.8)
    assert score.text().startswith("round 1: the evader survived 6.0 s; ")
    assert "closest approach 0.70 m" in score.text()


def test_the_table_keeps_the_last_rounds_and_marks_the_closest() -> None:
    score = Scoreboard()
    for number in range(MAX_ROUNDS + 2):
        played(score, 0.9, 0.5 + 0.01 * abs(number - 4), began=9.0 * number)
        score.end("released")
    rows = score.text().splitlines()[2:]
    assert len(rows) == MAX_ROUNDS
    assert rows[0].startswith("| 3 | 0.2 s | 0.52 m |")
    assert [row for row in rows if "**" in row] == [
        "| 5 | 0.2 s | **0.50 m** | released |"
    ]


@pytest.mark.parametrize("safety", [0.8, 2.0, inf])
def test_an_approach_is_close_while_it_comes_nearer_than_ever(
    safety: float,
) -> None:
    score = Scoreboard()
    played(score, 0.7, 0.61)
    assert not score.is_close(safety)
    score.update(1.0, 0.59)
    assert score.is_close(safety)
    score.update(1.2, 0.5899)
    assert score.is_close(safety)
    score.update(1.4, 0.62)
    assert not score.is_close(safety)
    score.end("released")
    assert not score.is_close(safety)


def test_a_small_safety_area_is_entered_before_time_slows() -> None:
    score = Scoreboard()
    played(score, 0.5)
    assert not score.is_close(0.6)
    score.update(1.0, 0.44)
    assert score.is_close(0.6)
