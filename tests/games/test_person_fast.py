"""Test the fast gait against a person at walking speed."""

from dataclasses import replace
from math import atan2, pi, radians, sin
from typing import Any

import pytest

from stepaside.core.poses import Pose
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.game import play
from stepaside.games.initial_poses import draw_start
from stepaside.games.outcome import Outcome
from stepaside.games.recorded_game import RecordedGame
from stepaside.games.template_game import play_template
from stepaside.locomotion.zmp.control_settings import ControlSettings
from stepaside.planning import PRESETS
from stepaside.sim.person_motion import PersonMotion
from stepaside.sim.person_settings import PersonSettings
from stepaside.strategies import Evasion
from stepaside.theory.unicycle.lateral_evasion import lateral_displacement

FAST = PRESETS["fast"]
TIMED = Evasion(trigger="time")


def met(
    speed: float, *, miss: float = 0.0, bearing: float = 0.0, far: float = 6.0
) -> float:
    """Return the closest approach of a straight walk to the template [m]."""
    return play_template(
        lambda pose, evader: PersonMotion(
            PersonSettings("straight", speed, miss=miss), pose, evader
        ),
        Pose(0.0, 0.0, 0.0),
        Pose(far, 0.0, pi - bearing),
        TIMED,
        FAST,
        duration=(far + 2.0) / speed,
    ).closest_distance


def duel(**changes: Any) -> DuelSettings:
    """Return a duel with a person at 1 m/s, 20 deg off the evader's front."""
    return DuelSettings(
        duration=7.0,
        gait=FAST,
        control=ControlSettings("closed-form", True),
        pursuer="person",
        person=PersonSettings("straight", 1.0, **changes),
        strategy=TIMED,
        start=StartSettings(5.5, 0.0, radians(20.0)),
    )


def test_a_person_at_one_metre_a_second_is_evaded() -> None:
    """Afterwards the robot stands again."""
    game = RecordedGame(replace(duel(), duration=9.0))
    play(game)
    assert game.outcome is Outcome.COMPLETED
    assert not game.in_physics.players[1].is_moving
    summary = game.run().summary
    begun = summary.triggered_at_distance_m
    assert begun == pytest.approx(0.7 + 3.5 * 1.0, abs=0.1)
    theory = summary.theory.closest_approach_m
    assert summary.min_distance_m > 0.7
    assert summary.min_distance_m == pytest.approx(theory, abs=0.15)


@pytest.mark.parametrize("bearing", [0.0, 1.5, -3.0])
def test_the_template_keeps_a_person_at_a_distance(
    bearing: float,
) -> None:
    slow, quick = met(0.3, bearing=bearing), met(1.6, bearing=bearing)
    assert slow > quick > 0.7
    passed = 6.0 * sin(atan2(1.2, 6.0))  # beside where it aims
    assert met(1.0, miss=1.2, bearing=bearing) == pytest.approx(
        passed, abs=1e-4
    )
    assert met(1.0, miss=0.4) == pytest.approx(met(1.0, miss=-0.4), abs=1e-9)


def test_the_template_steps_aside_as_the_unicycle_of_theory() -> None:
    """Facing the person, until it is where the robot was."""
    speed = 2.0  # too fast to stop beside the robot
    late = FAST.start_support
    time = TIMED.contact_time + TIMED.clearance / speed - late
    aside = lateral_displacement(FAST.speed, 0.5 * pi * FAST.gain, time)
    assert met(speed, far=9.0) == pytest.approx(aside, abs=0.02)


def test_a_faster_person_begins_farther_away() -> None:
    def drawn(speed: float) -> float:
        start = draw_start(
            DuelSettings(pursuer="person", person=PersonSettings(speed=speed))
        )
        assert start.distance is not None
        return start.distance

    assert drawn(0.05) == drawn(0.15) < 3.0
    assert drawn(1.0) - drawn(0.15) == pytest.approx(0.85 * 5.0)
