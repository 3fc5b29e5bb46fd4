"""Test the template controller, and the timing of its reports."""

from math import atan2, hypot, pi
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fake_robot import FakeStrategy
from stepaside.core.poses import Pose, wrap_angle
from stepaside.drivers.velocity.template_controller import TemplateController
from stepaside.drivers.velocity.velocity_body import (
    VelocityCommand,
    VelocityReport,
)
from stepaside.drivers.velocity.velocity_limits import VelocityLimits
from stepaside.perception.measurement import Sighting
from stepaside.planning import Direction, GaitSettings
from stepaside.strategies import Intent, Knowledge
from stepaside.strategies.velocity_set import BodyVelocity

GAIT = GaitSettings()
ANGLE = st.floats(-pi, pi)
PERIOD = 0.05


class SidestepStrategy:
    """Strategy that wants one body velocity."""

    direction = Direction.FORWARD
    saturated = False

    def __init__(self, velocity: BodyVelocity) -> None:
        self.velocity = velocity

    def begin(self) -> None:
        """Return no memory."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Want the velocity."""
        return Intent(velocity=self.velocity), None


def way(time: float, start: Pose, rate: float) -> Pose:
    """Pose of a robot that walks on an arc."""
    return start.compose(Pose(0.3 * time, -0.1 * time, rate * time))


@given(ANGLE, st.floats(-1.5, 1.5), st.integers(0, 12), st.booleans())
def test_an_old_sighting_is_of_where_the_robot_was_then(
    heading: float, rate: float, late: int, saturated: bool
) -> None:
    """Latency does not move an opponent that stands still."""
    strategy = FakeStrategy(
        heading=0.4, direction=Direction.BACKWARD, saturated=saturated
    )
    start, other = Pose(0.5, -0.2, heading), Pose(1.4, 0.3, 0.0)
    mind = TemplateController(strategy, GAIT)
    for i in range(40):
        now, taken = PERIOD * i, PERIOD * max(0, i - late)
        then = way(taken, start, rate)
        x, y, _ = then.inverse().compose(other)
        seen = Sighting(taken, wrap_angle(atan2(y, x)), hypot(x, y))
        told = mind.decide(VelocityReport(now, way(now, start, rate), seen))
    assert told.forward == pytest.approx(-GAIT.speed)
    turn = GAIT.gain * (1.0 if saturated else 0.4)
    assert told.turn == pytest.approx(turn)


class SlowStrategy(FakeStrategy):
    """Strategy that walks at half the pace."""

    def decide(self, knowledge: Any, memory: Any) -> Any:
        """Want a heading at half the pace."""
        return Intent(0.4, pace=0.5), None


def test_the_pace_slows_speed_and_turn_alike() -> None:
    mind = TemplateController(SlowStrategy(), GAIT)
    ahead = Sighting(0.0, 0.0, 1.0)
    told = mind.decide(VelocityReport(0.0, Pose(0.0, 0.0, 0.0), ahead))
    assert told == pytest.approx((0.5 * GAIT.speed, 0.5 * GAIT.gain * 0.4, 0))


class Noting(FakeStrategy):
    """Strategy that exposes its knowledge."""

    def decide(self, knowledge: Any, memory: Any) -> Any:
        """Note it."""
        self.known = knowledge
        return super().decide(knowledge, memory)


@given(ANGLE, st.floats(-1.5, 1.5), st.integers(0, 12))
def test_it_knows_since_when_and_from_where(
    heading: float, rate: float, late: int
) -> None:
    strategy = Noting()
    start, other = Pose(0.5, -0.2, heading), Pose(1.4, 0.3, 0.0)
    mind = TemplateController(strategy, GAIT)
    for i in range(40):
        now, taken = PERIOD * i, PERIOD * max(0, i - late)
        then = way(taken, start, rate)
        x, y, _ = then.inverse().compose(other)
        seen = Sighting(taken, wrap_angle(atan2(y, x)), hypot(x, y))
        mind.decide(VelocityReport(now, way(now, start, rate), seen))
    known = strategy.known
    assert known.age == pytest.approx(PERIOD * late)
    assert known.pose_in_map == then
    assert wrap_angle(known.bearing - seen.bearing) == pytest.approx(0.0)
    assert known.velocity == pytest.approx((0.0, 0.0), abs=1e-6)


class Remembering:
    """Perception that records poses and has no detection."""

    head = SimpleNamespace(yaw=0.0, pitch=0.0)

    def __init__(self) -> None:
        self.recalled: list[tuple[float, Any, Pose]] = []
        self.frames: list[Pose] = []

    def note_level(self, time: float, joints: Any, frame: Pose) -> None:
        """Note it."""
        self.recalled.append((time, joints, frame))

    def see_level(self, measurement: Any, frame: Pose) -> None:
        """Note it."""
        self.frames.append(frame)


class Image:
    """Something taken at a time."""

    def __init__(self, time: float) -> None:
        self.time = time


@pytest.mark.parametrize("heading", [0.0, 3.0, -3.1])
@pytest.mark.parametrize("late", [0.01, 0.07, 0.31])
def test_an_image_is_of_where_the_robot_was_when_it_was_taken(
    heading: float, late: float
) -> None:
    """Place, heading and joints alike, also where the heading wraps."""
    pytest.importorskip("cv2")
    from stepaside.drivers.velocity.head_control import CameraBody

    start, rate = Pose(0.2, 0.1, heading), 1.7
    made: Any = Remembering()

    def where(time: float) -> Pose:
        x, y, theta = start
        return Pose(x + 0.3 * time, y - 0.2 * time, theta + rate * time)

    class Body:
        """Reports on time; its eyes are late."""

        def __init__(self) -> None:
            self.count, self.joints = -1, np.zeros(2)

        def listen(self, patience: float) -> VelocityReport:
            self.count += 1
            now = PERIOD * self.count
            self.joints = np.array([0.5 * now, -now])
            x, y, theta = where(now)
            return VelocityReport(now, Pose(x, y, wrap_angle(theta)))

        def percepts(self, now: float) -> list[Any]:
            return [Image(now - late)] if now > late else []

        def command(self, velocity: VelocityCommand) -> None:
            """Stand."""

        def look(self, yaw: float, pitch: float) -> None:
            """Look ahead."""

    body: Any = Body()
    looking = CameraBody(body, body, made)
    for _ in range(30):
        looking.listen(0.1)
    assert len(made.recalled) > 20
    for time, joints, frame in made.recalled:
        true = where(time)
        assert frame[:2] == pytest.approx(true[:2])
        off = wrap_angle(frame.theta - true.theta)
        assert off == pytest.approx(0.0, abs=1e-9)
        np.testing.assert_allclose(joints, [0.5 * time, -time], atol=1e-9)


def test_a_body_velocity_reaches_only_a_robot_that_walks_sideways() -> None:
    """A unicycle turns toward it instead."""
    velocities = VelocityLimits(0.5, 0.4, 1.0, lateral=0.3).velocities
    seen = VelocityReport(0.0, Pose(0.0, 0.0, 0.0), Sighting(0.0, 0.4, 1.0))
    wanted = BodyVelocity(0.1, -0.2, 0.3)
    strategy = SidestepStrategy(wanted)
    told = TemplateController(strategy, GAIT, velocities).decide(seen)
    assert told == VelocityCommand(0.1, 0.3, -0.2)
    told = TemplateController(strategy, GAIT).decide(seen)
    assert told.lateral == 0.0 and told.turn < 0.0
