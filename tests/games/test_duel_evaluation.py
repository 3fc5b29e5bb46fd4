"""Test summaries of duels on records with known values."""

from collections.abc import Callable
from dataclasses import asdict, replace
from math import degrees, pi
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Pose
from stepaside.games import duel_evaluation as summary
from stepaside.games.duel_evaluation import summarise
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.sight_summary import (
    SightReport,
)
from stepaside.games.trajectory import PlanningTimes
from stepaside.strategies import Evasion
from stepaside.theory.unicycle.unicycle_game import Unicycle
from synthetic_duel_record import (
    SETTINGS,
    THEORY,
    TIMES,
    Record,
    stepped,
    still,
)


def planned(
    times: Any = (), jump: float = 0.0, margin: float | None = None
) -> PlanningTimes:
    """Return planning times of a player with one step more than plans."""
    return PlanningTimes(len(times) + 1, np.array(times), jump, margin)


STARTS = {
    "pursuer": Pose(0.0, 0.0, 0.0),
    "evader": Pose(0.79, 0.0, 0.0),
}
PLANNED = {
    "pursuer": planned([3e-4, 1e-4, 2e-4], 1e-12, 0.021),
    "evader": planned(),
}


def figures(
    record: Record,
    *,
    settings: DuelSettings = SETTINGS,
    duration: float = 60.0,
    planning: dict[str, PlanningTimes] | None = None,
    sight: SightReport | None = None,
    captured_at: float | None = None,
) -> dict[str, Any]:
    """Return the summary of a duel, as plain values."""
    match: Any = SimpleNamespace(
        world=SimpleNamespace(time=duration),
        message="played",
        closest={("evader", "pursuer"): 0.61},
        touched=(),
        captured_at={("evader", "pursuer"): captured_at}
        if captured_at
        else {},
        real_time_factor=20.0,
    )
    found = summarise(
        settings,
        match,
        record.times,
        record.tracks(),
        PLANNED if planning is None else planning,
        {"evader": (2.5, STARTS)},
        sight,
    )
    return asdict(found)


def test_a_summary_is_of_the_last_third() -> None:
    """Earlier samples differ; distances are of reference points."""
    made = Record(stepped(40.0, 2.0, 0.93), stepped(40.0, 0.2, 1.5))
    found = figures(made)
    assert found["distance_m"] == pytest.approx(0.93)
    assert found["relative_orientation_deg"] == pytest.approx(degrees(1.5))
    assert found["pursuer"] == {"radius_m": pytest.approx(0.4), "sight": None}
    assert found["evader"] == {"radius_m": pytest.approx(0.4), "sight": None}


def test_capture_and_contact_are_reported_separately() -> None:
    """A duel goes on after capture; contact ends it."""
    found = figures(Record(), captured_at=17.5)
    assert found["captured_at_s"] == 17.5
    assert figures(Record())["captured_at_s"] is None


@pytest.mark.parametrize("count", [1, 2])
def test_a_duel_that_ended_at_once_has_a_summary(count: int) -> None:
    found = figures(Record(times=TIMES[:count]), duration=0.0)
    assert found["distance_m"] == pytest.approx(THEORY.distance_m)
    assert found["converged_at_s"] is None


def test_a_value_that_does_not_exist_is_none() -> None:
    back = replace(SETTINGS, strategy=Evasion(angle=0.0))
    theory = figures(Record(), settings=back)["theory"]
    assert theory["exists"] is False
    assert theory["radius_m"] is None and theory["distance_m"] is None
    assert theory["relative_orientation_deg"] is None


def test_a_person_is_compared_with_the_template_in_real_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: dict[str, Any] = {}

    def approach(
        move: Callable[..., Any], person: Pose, evader: Pose, **rest: Any
    ) -> float:
        asked.update(rest, person=person, evader=evader)
        return 0.44

    monkeypatch.setattr(summary, "template_approach", approach)
    settings = replace(SETTINGS, pursuer="person", strategy=Evasion(angle=1.2))
    found = figures(Record(), settings=settings)
    assert found["theory"]["closest_approach_m"] == 0.44
    gait = settings.gait
    pace = gait.path_interval / gait.step_duration
    assert asked == {
        "person": Pose(0.0, 0.0, 0.1),
        "evader": Pose(1.0, 0.0, pi - 0.2),
        "unicycle": Unicycle(gait.speed * pace, gait.gain * pace),
        "angle": 1.2,
        "safety_radius": 0.8,
        "duration": 120.0,
    }
    nowhere = replace(settings, start=StartSettings())
    found = figures(Record(), settings=nowhere)
    assert found["theory"]["closest_approach_m"] is None


def test_no_circle_is_given_if_contact_is_forecast_before_it() -> None:
    """Unless the players converged to it nevertheless."""
    away = replace(SETTINGS, start=StartSettings(1.0, 0.1, pi))
    missed = Record(still(1.5), still(2.0))
    theory = figures(missed, settings=away)["theory"]
    assert theory["expected"] == "contact" and theory["exists"] is False
    assert theory["distance_m"] is None and theory["radius_m"] is None
    theory = figures(Record(), settings=away)["theory"]
    assert theory["expected"] == "contact" and theory["exists"] is True
    assert theory["distance_m"] == pytest.approx(THEORY.distance_m)
