"""Test games of people and the template of an evader."""

from math import atan2, pi, sin
from typing import Any

import pytest

from stepaside.core.poses import Pose
from stepaside.games import duel
from stepaside.games.floor_games import floor_of, play_floor
from stepaside.games.game import GameRules
from stepaside.planning import PRESETS, Direction
from stepaside.sim.person_settings import PersonSettings
from stepaside.strategies import Evasion, Intent, Knowledge

FAST = PRESETS["fast"]
TIMED = Evasion(trigger="time")
START = Pose(-3.0, 0.0, 0.0), Pose(0.0, 0.1, pi - 0.2)


def met(
    person: PersonSettings,
    starts: tuple[Pose, Pose] = START,
    *,
    duration: float = 12.0,
    strategy: Any = TIMED,
) -> float:
    """Return the closest approach of a person to the template, in [m]."""
    game = duel(
        duration=duration,
        person=person,
        gait=FAST,
        pursuer={"body": "person", "start": tuple(starts[0])},
        evader={"start": tuple(starts[1])},
    )
    world = floor_of(game, {"evader": strategy}, 0.01)
    rules = GameRules(duration, identities=game.identities)
    return play_floor(world, rules)[0].closest["evader", "pursuer"]


def straight(
    speed: float, *, miss: float = 0.0, bearing: float = 0.0, far: float = 6.0
) -> float:
    """Return the closest approach of a straight walk, in [m]."""
    person = PersonSettings("straight", speed, miss=miss)
    starts = Pose(0.0, 0.0, 0.0), Pose(far, 0.0, pi - bearing)
    return met(person, starts, duration=(far + 2.0) / speed)


@pytest.mark.parametrize(
    "strategy",
    [Evasion(trigger="time", contact_time=4.0), Evasion(safety_radius=2.0)],
)
def test_the_closest_approach_is_invariant_to_the_frame(
    strategy: Evasion,
) -> None:
    person = PersonSettings("straight", 0.5)
    here = met(person, strategy=strategy)
    for frame in (Pose(4.0, -1.0, 2.0), Pose(0.0, 0.0, -0.9)):
        starts = frame.compose(START[0]), frame.compose(START[1])
        assert met(person, starts, strategy=strategy) == pytest.approx(
            here, abs=1e-6
        )
    assert 0.05 < here < 2.0


class Leaving:
    """Strategy that walks straight backward."""

    direction, saturated = Direction.BACKWARD, False

    def __init__(self) -> None:
        self.told: list[Knowledge] = []

    def begin(self) -> None:
        """Nothing to remember."""

    def decide(self, known: Knowledge, memory: None) -> tuple[Intent, None]:
        """Walk on."""
        self.told.append(known)
        return Intent(0.0), None


def test_a_template_walks_in_path_time() -> None:
    """After the first support, one stride per step."""
    walker = Leaving()
    met(PersonSettings("straight", 0.3), strategy=walker)
    told = [known for known in walker.told if known.limits.speed == FAST.speed]
    first, second, *rest = told  # without those of its validation
    assert not first.moving and all(known.moving for known in rest)
    begun = second.time - first.time
    period = FAST.step_duration
    wanted = FAST.start_support + period
    assert begun == pytest.approx(wanted, abs=0.011)
    times = [known.time for known in rest]
    assert times[1] - times[0] == pytest.approx(period, abs=0.011)
    way = rest[0].pose_in_map.x - rest[8].pose_in_map.x
    back = rest[8].pose_in_map.inverse().compose(rest[0].pose_in_map)
    assert abs(way) == pytest.approx(8 * FAST.stride, rel=0.05)
    assert back.x == pytest.approx(8 * FAST.stride, rel=0.05)


@pytest.mark.parametrize("bearing", [0.0, 1.5, -3.0])
def test_the_template_keeps_a_person_at_a_distance(bearing: float) -> None:
    slow = straight(0.3, bearing=bearing)
    quick = straight(1.6, bearing=bearing)
    assert slow > quick > 0.7
    passed = 6.0 * sin(atan2(1.2, 6.0))  # beside where it aims
    assert straight(1.0, miss=1.2, bearing=bearing) == pytest.approx(
        passed, abs=1e-4
    )
    left, right = straight(1.0, miss=0.4), straight(1.0, miss=-0.4)
    assert left == pytest.approx(right, abs=1e-9)


def test_the_template_steps_aside_as_the_unicycle_of_theory() -> None:
    """Facing the person, until it is where the robot was."""
    speed = 2.0  # too fast to stop beside the robot
    late = FAST.start_support
    time = TIMED.contact_time + TIMED.clearance / speed - late
    turning = 0.5 * pi * FAST.gain  # to across the line of sight, then on
    turned = 0.5 * pi / turning
    aside = FAST.speed * (1.0 / turning + time - turned)
    assert straight(speed, far=9.0) == pytest.approx(aside, abs=0.02)


def test_an_evader_escapes_from_a_slower_pursuer() -> None:
    back = Evasion(0.0, safety_radius=0.8)
    starts = Pose(0.0, 0.0, 0.0), Pose(1.5, 0.0, pi)
    speed = FAST.stride / FAST.step_duration

    def approach(share: float) -> float:
        person = PersonSettings("straight", share * speed)
        return met(person, starts, duration=10.0, strategy=back)

    assert approach(0.9) > 0.6 > 0.3 > approach(2.0)
