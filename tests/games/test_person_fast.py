"""Test the fast gait against a person at walking speed."""

from math import atan2, pi, sin

import pytest

from stepaside.core.poses import Pose
from stepaside.games.floor_games import play_template
from stepaside.planning import PRESETS
from stepaside.sim.person_motion import PersonMotion
from stepaside.sim.person_settings import PersonSettings
from stepaside.strategies import Evasion

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
    turning = 0.5 * pi * FAST.gain  # to across the line of sight, then on
    turned = 0.5 * pi / turning
    aside = FAST.speed * (1.0 / turning + time - turned)
    assert met(speed, far=9.0) == pytest.approx(aside, abs=0.02)
