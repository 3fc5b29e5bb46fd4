"""Test games of people and the template of an evader."""

from math import pi

import pytest

from stepaside.core.poses import Pose
from stepaside.games.floor_games import play_template
from stepaside.planning import PRESETS, Direction
from stepaside.sim.person_motion import PersonMotion, Place
from stepaside.sim.person_settings import PersonSettings
from stepaside.strategies import Evasion, Intent, Knowledge

GAIT = PRESETS["fast"]
EVADER = Evasion(trigger="time", contact_time=4.0)


def met(frame: Pose, speed: float = 0.5, strategy: object = EVADER) -> float:
    """Return the closest approach of a straight walk, in a rotated frame."""
    person = PersonSettings("straight", speed)

    def motion(start: Pose, evader: Place) -> PersonMotion:
        return PersonMotion(person, start, evader)

    start, evader = Pose(-3.0, 0.0, 0.0), Pose(0.0, 0.1, pi - 0.2)
    return play_template(
        motion,
        frame.compose(start),
        frame.compose(evader),
        strategy,  # type: ignore[arg-type]
        GAIT,
        duration=12.0,
    ).closest_distance


@pytest.mark.parametrize("strategy", [EVADER, Evasion(safety_radius=2.0)])
def test_the_closest_approach_is_invariant_to_the_frame(
    strategy: Evasion,
) -> None:
    here = met(Pose(0.0, 0.0, 0.0), strategy=strategy)
    for frame in (Pose(4.0, -1.0, 2.0), Pose(0.0, 0.0, -0.9)):
        assert met(frame, strategy=strategy) == pytest.approx(here, abs=1e-6)
    assert 0.05 < here < 2.0


class Leaving:
    """Strategy that walks straight backward at a time scale."""

    direction, saturated = Direction.BACKWARD, False

    def __init__(self, pace: float) -> None:
        self.pace = pace
        self.told: list[Knowledge] = []

    def begin(self) -> None:
        """Nothing to remember."""

    def decide(self, known: Knowledge, memory: None) -> tuple[Intent, None]:
        """Walk on."""
        self.told.append(known)
        return Intent(0.0, pace=self.pace), None


@pytest.mark.parametrize("pace", [1.0, 0.5])
def test_a_template_walks_in_path_time(pace: float) -> None:
    """After the first support, one stride per step, at its time scale."""
    walker = Leaving(pace)
    met(Pose(0.0, 0.0, 0.0), 0.3, walker)
    first, second, *rest = walker.told
    assert not first.moving and all(known.moving for known in rest)
    begun = second.time - first.time
    period = GAIT.step_duration / pace
    wanted = GAIT.start_support / pace + period
    assert begun == pytest.approx(wanted, abs=0.011)
    times = [known.time for known in rest]
    assert times[1] - times[0] == pytest.approx(period, abs=0.011)
    way = rest[0].pose_in_map.x - rest[8].pose_in_map.x
    back = rest[8].pose_in_map.inverse().compose(rest[0].pose_in_map)
    assert abs(way) == pytest.approx(8 * GAIT.stride, rel=0.05)
    assert back.x == pytest.approx(8 * GAIT.stride, rel=0.05)
