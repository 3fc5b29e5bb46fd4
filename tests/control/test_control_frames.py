"""Test control by laws: invariance to the odometry frame and to delays."""

from collections.abc import Sequence
from math import hypot, pi
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fake_robot import FIRST, GAIT, STEP, TICK, FakeStrategy, Run, walk_of
from stepaside.arena import Disc
from stepaside.arena.obstacles import ObstacleSet
from stepaside.control.strategy_runner import StrategyRunner
from stepaside.core.poses import Array, Pose, wrap_angle
from stepaside.locomotion.zmp.open_loop import OpenLoop
from stepaside.locomotion.zmp.reference_table import (
    ReferenceSample,
    ReferenceTable,
)
from stepaside.perception.measurement import RobotState, Sighting
from stepaside.planning import Foot
from stepaside.strategies import Knowledge

ANGLE = st.floats(-pi, pi)
METRES = st.floats(-3.0, 3.0)
MOVED = st.builds(Pose, METRES, METRES, ANGLE)
HERE = Pose(0.0, 0.0, 0.0)
FEW = settings(max_examples=25)
Vector = tuple[float, float]


def put(frame: Pose, point: Sequence[float]) -> Vector:
    """A point of a frame, in its parent."""
    x, y, _ = frame.compose(Pose(point[0], point[1], 0.0))
    return x, y


def turned(frame: Pose, vector: Sequence[float]) -> Vector:
    """A vector of a frame, in its parent."""
    return put(Pose(0.0, 0.0, frame.theta), vector)


class Around:
    """Surroundings whose frame is not odometry."""

    map_error = 0.01

    def __init__(self, frame: Pose, room: Pose = HERE) -> None:
        self.pose_odometry_in_map = frame
        discs = (1.0, 1.0, 0.2), (-0.4, 0.3, 0.1)
        self.solids = ObstacleSet(
            tuple(Disc(*put(room, (x, y)), radius) for x, y, radius in discs)
        )

    def note(self, measurement: RobotState, pose: Pose) -> None:
        """Learn nothing."""


def told(odometry: Pose, room: Pose) -> Knowledge:
    """Return the knowledge for given frames of odometry and room."""
    strategy = FakeStrategy()
    around: Any = Around(room.compose(odometry.inverse()))
    made = StrategyRunner(strategy, GAIT, around)
    for i in range(8):
        now = 0.4 * i
        own = odometry.compose(Pose(0.02 * i, 0.01 * i, 0.1 * i))
        made.headings.note(now, own.theta + 0.05)
        made.templates.note(now, own)
        other = odometry.compose(Pose(1.0 - 0.1 * now, 0.4 + 0.2 * now, 0.0))
        x, y, _ = own.inverse().compose(other)
        bearing = np.arctan2(y, x) - 0.05
        seen = Sighting(now, float(bearing), hypot(x, y), spread=0.03)
        foot = own.compose(Pose(0.0, 0.05, 0.02))
        made.decide(now + 0.3, seen, 0.0, (foot, Foot.LEFT), moving=True)
    known: Knowledge = made.memory[-1]
    return known


@FEW
@given(MOVED, MOVED)
def test_knowledge_has_poses_in_the_room_and_velocities_in_its_frame(
    odometry: Pose, room: Pose
) -> None:
    """Wherever odometry lies; obstacles and poses are in the same frame."""
    plain = told(Pose(0.0, 0.0, 0.0), Pose(0.0, 0.0, 0.0))
    known = told(odometry, room)
    assert (
        plain.step_start_in_map is not None
        and known.step_start_in_map is not None
    )
    for one, other in (
        (known.pose_in_map, room.compose(plain.pose_in_map)),
        (known.step_start_in_map, room.compose(plain.step_start_in_map)),
    ):
        assert one[:2] == pytest.approx(other[:2], abs=1e-9)
        off = wrap_angle(one.theta - other.theta)
        assert off == pytest.approx(0.0, abs=1e-9)
    assert (
        known.obstacles_in_map == plain.obstacles_in_map
        and known.obstacles_in_map
    )
    for name in (
        "distance",
        "age",
        "closing_speed",
        "bearing_rate",
        "map_error",
    ):
        own = getattr(plain, name)
        assert getattr(known, name) == pytest.approx(own, abs=1e-9)
    off = wrap_angle(known.bearing - plain.bearing)
    assert off == pytest.approx(0.0, abs=1e-9)
    assert known.velocity == pytest.approx(plain.velocity, abs=1e-9)
    # On the floor it walks at (-0.1, 0.2), whatever the own body does.
    heading = plain.pose_in_map.theta
    assert turned(plain.pose_in_map, plain.velocity or ()) == pytest.approx(
        (-0.1, 0.2), abs=1e-6
    )
    assert heading == pytest.approx(0.7)


class Noted(OpenLoop):
    """Open loop that notes what the plan asks for at each tick."""

    def __init__(self, legs: Any) -> None:
        super().__init__(legs)
        self.rows: list[ReferenceSample] = []

    def targets(
        self, measurement: RobotState, table: ReferenceTable, *more: Any
    ) -> Array | None:
        """Note it."""
        self.rows.append(table.at(measurement.time))
        return super().targets(measurement, table, *more)


@pytest.mark.parametrize("late", [0, 3])
def test_a_sighting_is_of_where_the_body_was_then(late: int) -> None:
    """Not to the commanded pose: a command takes effect with a delay."""
    strategy = FakeStrategy(heading=0.6)
    run = Run(strategy, delay=late * TICK, balance=Noted)
    noted: Any = walk_of(run.scheme).balance
    headings = []
    while run.ticks * TICK < FIRST + 3.5 * STEP:
        headings.append(0.01 * (run.ticks % 50))
        run.legs.torso_heading = headings[-1]
        run.until((run.ticks + 1) * TICK, bearing=0.3)
        now = run.ticks - 1
        if run.scheme.begun is not None and now > 0:
            known = run.scheme.decisions.memory[-1]
            then = noted.rows[now - late - 1].template
            assert known.pose_in_map == then
            bearing = headings[now - late] + 0.3 - then.theta
            assert known.bearing == pytest.approx(bearing)
    assert run.replans == 5
