"""Test figures of a game in physics: whole turns change none of them."""

from dataclasses import replace
from math import tau

import numpy as np
import pytest

from stepaside.games.duel_summary import PlanTimes
from stepaside.games.run import DuelRun
from stepaside.games.trajectory import Trajectory
from stepaside.studies.tournament_physics import record_values_of
from synthetic_duel_record import Record
from synthetic_run import figures, run_of


def played(turns: float = 0.0) -> DuelRun:
    """A duel whose evader has turned some whole times before it began."""
    made = Record()
    tracks = made.tracks()
    evader = tracks["evader"]
    place = evader.unicycle + np.array([0.0, 0.0, tau * turns])
    tracks["evader"] = Trajectory(evader.com, evader.torso, place)
    run = run_of(made.times, tracks)
    spent = PlanTimes(median=300.0, p99=900.0)
    return replace(run, summary=figures(plan_time_us=spent))


def test_whole_turns_of_a_record_change_no_figure() -> None:
    plain = record_values_of(played(), 0.2)
    for turns in (-3.0, 1.0, 2.0):
        found = record_values_of(played(turns), 0.2)
        for name in ("unseen", "turning_rad_s", "walked_m", "floor_m2"):
            assert found[name] == pytest.approx(plain[name]), name
    assert 0.0 <= plain["unseen"] <= 1.0


def test_decisions_are_told_in_seconds() -> None:
    found = record_values_of(played(), 0.2)
    assert found["decision_s"] == pytest.approx(300e-6)
    assert found["longest_decision_s"] == pytest.approx(900e-6)
    run = played()
    assert found["survived_s"] == run.duration
    way = np.diff(run.tracks["evader"].unicycle[:, :2], axis=0)
    assert found["walked_m"] == pytest.approx(float(np.hypot(*way.T).sum()))
