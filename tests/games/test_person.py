"""Test a person as pursuer."""

from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Pose
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.recorded_game import RecordedGame, run_duel
from stepaside.sim.person_motion import (
    PersonMotion,
    read_path,
    template_approach,
)
from stepaside.sim.person_settings import PersonSettings
from stepaside.theory.unicycle.unicycle_game import Unicycle

pytestmark = pytest.mark.usefixtures("blank_figures")

START = StartSettings(distance=1.5, pursuer_offset=0.0, evader_offset=0.0)


def duel_with(person: PersonSettings, duration: float) -> DuelSettings:
    return DuelSettings(
        duration=duration, start=START, pursuer="person", person=person
    )


def walk(person: PersonSettings, start: Pose, evader: Pose) -> PersonMotion:
    return PersonMotion(person, start, evader[:2])


def test_a_straight_walk_passes_at_its_miss_distance() -> None:
    person = PersonSettings("straight", 0.5, miss=0.7)
    motion = walk(person, Pose(0.0, 0.0, 0.0), Pose(3.0, 0.0, pi))
    nearest = 10.0
    for k in range(1200):
        motion.advance(0.01 * (k + 1), 0.01, (3.0, 0.0))
        x, y, _ = motion.pose
        nearest = min(nearest, float(np.hypot(x - 3.0, y)))
    assert nearest == pytest.approx(0.7 * 3.0 / np.hypot(3.0, 0.7), abs=1e-3)
    assert motion.pose.y > 0.0


def test_steering_turns_by_the_pursuers_law() -> None:
    person = PersonSettings("steer", 0.1, 0.5)
    motion = walk(person, Pose(0.0, 0.0, 1.0), Pose(100.0, 0.0, pi))
    for k in range(1000):
        motion.advance(0.002 * (k + 1), 0.002, (100.0, 0.0))
    assert motion.pose.theta == pytest.approx(np.exp(-1.0), abs=3e-3)


def test_a_recorded_path_is_walked(tmp_path: Path) -> None:
    file = tmp_path / "walk.csv"
    file.write_text("time,x,y\n0,0,0\n10,1,0\n20,1,1\n", encoding="utf-8")
    person = PersonSettings(str(file))
    motion = walk(person, Pose(5.0, 5.0, 0.0), Pose(3.0, 0.0, pi))
    motion.advance(5.0, 0.01, (3.0, 0.0))
    assert motion.pose == pytest.approx((0.5, 0.0, 0.0))
    motion.advance(15.0, 0.01, (3.0, 0.0))
    assert motion.pose == pytest.approx((1.0, 0.5, pi / 2))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x,y\n0,0\n", "first line"),
        ("time,x,y\n0,0,a\n1,1,1\n", "could not convert"),
        ("time,x,y\n0,0,0\n", "two rows"),
        ("time,x,y\n1,0,0\n0,1,0\n", "increase"),
    ],
)
def test_invalid_paths_are_refused(
    tmp_path: Path, text: str, message: str
) -> None:
    file = tmp_path / "walk.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigurationError, match=message):
        read_path(file)


def test_a_person_that_passes_outside_triggers_nothing() -> None:
    person = PersonSettings("straight", 0.5, miss=1.3)
    result = run_duel(duel_with(person, 6.0))
    summary = result.summary
    assert summary.triggered_at_s is None and summary.replans == 0
    assert result.outcome.value == "completed"
    theory = summary.theory.closest_approach_m
    assert summary.min_distance_m == pytest.approx(theory, abs=0.05)


def test_a_slow_person_is_evaded_close_to_theory() -> None:
    """The robot loses the person's path until its first step lands."""
    result = run_duel(duel_with(PersonSettings("steer", 0.073, 0.146), 40.0))
    summary = result.summary
    assert result.outcome.value == "completed"
    assert summary.triggered_at_distance_m == pytest.approx(0.8, abs=0.02)
    assert summary.triggered_at_s is not None
    assert result.evader.landings is not None
    late = result.evader.landings[0, 0] - summary.triggered_at_s
    assert 1.0 < late < 1.5
    theory = summary.theory.closest_approach_m
    assert theory is not None
    assert summary.min_distance_m == pytest.approx(
        theory - 0.073 * late, abs=0.03
    )


def test_touching_a_person_ends_the_duel() -> None:
    result = run_duel(duel_with(PersonSettings("straight", 0.6), 10.0))
    assert result.outcome.value == "contact"
    assert result.message.startswith("evader and pursuer touched at ")


def test_a_person_without_a_solid_body_walks_through_a_robot() -> None:
    person = PersonSettings("straight", 0.6, solid=False)
    standing = replace(duel_with(person, 5.0), evader_strategy="stand")
    result = run_duel(standing)
    assert result.outcome.value == "completed"
    assert result.summary.min_distance_m < 0.05
    model = RecordedGame(standing).in_physics.model
    assert model.body("pursuer/trunk").geomnum[0] > 0  # sensors see it


def test_the_template_evader_escapes_from_a_slower_pursuer() -> None:
    def approach(speed: float) -> float:
        person = PersonSettings("straight", speed)
        return template_approach(
            lambda pose, evader: PersonMotion(person, pose, evader),
            Pose(0.0, 0.0, 0.0),
            Pose(1.5, 0.0, pi),
            unicycle=Unicycle(0.1, 0.2),
            angle=0.0,
            safety_radius=0.8,
            duration=60.0,
        )

    assert approach(0.1) == pytest.approx(0.8, abs=0.01)
    assert approach(0.2) < 0.1 < approach(0.05)
