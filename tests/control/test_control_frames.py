"""Test control by laws: invariance to the odometry frame and to delays."""

from collections.abc import Sequence
from math import hypot, pi
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fake_robot import FIRST, GAIT, STEP, TICK, FakeStrategy, Run, walk_of
from stepaside.arena import Disc, Room
from stepaside.arena.obstacles import ObstacleSet
from stepaside.control.clearance.guard import Guard
from stepaside.control.clearance.surroundings import KnownRoom
from stepaside.control.clearance.swept_outline import BodyOutline
from stepaside.control.strategy_runner import StrategyRunner
from stepaside.core.poses import Array, Pose, wrap_angle
from stepaside.locomotion.walk_snapshots import Phase
from stepaside.locomotion.zmp.feedback_loop import OpenLoop
from stepaside.locomotion.zmp.reference_table import (
    ReferenceSample,
    ReferenceTable,
    resting_sample,
)
from stepaside.locomotion.zmp.state_estimator import StateEstimator
from stepaside.perception.measurement import RobotState, Sighting
from stepaside.planning import (
    PRESETS,
    CenterState,
    Direction,
    Foot,
    ManeuverPlan,
    ManeuverPlanner,
)
from stepaside.robots.description import load_robot
from stepaside.robots.forward_kinematics import ForwardKinematics
from stepaside.robots.leg_kinematics import BodyReference
from stepaside.strategies import Intent, Knowledge
from synthetic_state import (
    MEASUREMENT,
    ROW,
    SUPPORT,
    FakeEstimator,
    stabiliser,
    step,
)

ANGLE = st.floats(-pi, pi)
METRES = st.floats(-3.0, 3.0)
MOVED = st.builds(Pose, METRES, METRES, ANGLE)
CORNERS = np.array([[0.09, 0.1], [-0.07, 0.1], [-0.07, -0.1], [0.09, -0.1]])
OUTLINE = BodyOutline(CORNERS, 0.4 * CORNERS, 0.4 * CORNERS)
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


def body_in(frame: Pose, body: BodyReference) -> BodyReference:
    """Express a body reference in the parent of its frame."""

    def foot(asked: Any) -> tuple[float, float, float, float]:
        x, y, height, yaw = asked
        return (*put(frame, (x, y)), height, yaw + frame.theta)

    return body._replace(
        com=(*put(frame, body.com), body.com[2]),
        left_foot=foot(body.left_foot),
        right_foot=foot(body.right_foot),
    )


def row_in(frame: Pose, row: ReferenceSample) -> ReferenceSample:
    """References of a plan in a frame, expressed in the parent frame."""
    return ReferenceSample(
        body_in(frame, row.body),
        put(frame, row.zmp),
        put(frame, row.dcm),
        frame.compose(row.template),
        turned(frame, row.reaction),
    )


def same_row(one: ReferenceSample, other: ReferenceSample) -> None:
    """Compare all of two rows."""
    for a, b in zip(one, other, strict=True):
        parts = zip(a, b, strict=True) if isinstance(a, BodyReference) else ()
        for c, d in parts or ((a, b),):
            np.testing.assert_allclose(c, d, atol=1e-9)


class Around:
    """Surroundings whose frame is not odometry."""

    map_error = 0.01

    def __init__(self, frame: Pose, room: Pose = HERE) -> None:
        self.pose_odometry_in_map = frame
        discs = (1.0, 1.0, 0.2), (-0.4, 0.3, 0.1)
        self.solids = ObstacleSet(
            [Disc(*put(room, (x, y)), radius) for x, y, radius in discs]
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


@FEW
@given(MOVED, MOVED, st.booleans())
def test_how_clear_a_maneuver_is_depends_on_no_odometry(
    odometry: Pose, support: Pose, standing: bool
) -> None:
    planner = ManeuverPlanner(GAIT)
    plan = planner.plan(
        0.4,
        Direction.BACKWARD,
        first_foot=Foot.LEFT,
        state=CenterState((0.01, 0.03), (0.02, -0.05)),
        swing_start=Pose(-0.02, 0.1, 0.0),
        standing=standing,
    )
    here: Any = Around(Pose(0.2, 0.1, 0.3))
    there: Any = Around(here.pose_odometry_in_map.compose(odometry.inverse()))
    one, two = (
        Guard(around, OUTLINE, planner, margin=0.02)
        for around in (here, there)
    )
    moved = odometry.compose(support)
    assert one.evaluate(plan, support) == pytest.approx(
        two.evaluate(plan, moved), abs=1e-9
    )


@FEW
@given(MOVED, MOVED, MOVED)
def test_a_measured_pose_aligns_odometry_with_the_body(
    start: Pose, planned: Pose, place: Pose
) -> None:
    """The planned pose in odometry maps to the measured pose in the room."""
    around = KnownRoom(Room(None, None, (Disc(9.0, 9.0, 0.2),)), start)
    around.note(MEASUREMENT, planned)
    assert around.pose_odometry_in_map == start
    around.note(MEASUREMENT._replace(pose_in_room=place), planned)
    found = around.pose_odometry_in_map.compose(planned)
    assert found[:2] == pytest.approx(place[:2], abs=1e-9)
    assert wrap_angle(found.theta - place.theta) == pytest.approx(0, abs=1e-9)


@FEW
@given(METRES, METRES, st.integers(0, 63), MOVED)
def test_maneuver_clearance_is_invariant_to_rotation(
    x: float, y: float, turns: int, support: Pose
) -> None:
    """Step and halt alike, for rotations on the grid of directions."""
    planner = ManeuverPlanner(GAIT)
    plan = planner.plan(
        -0.7, Direction.FORWARD, first_foot=Foot.RIGHT, standing=True
    )
    room, here = Pose(x, y, pi * turns / 32.0), Pose(0.2, 0.1, 0.3)
    found = []
    for moved in (Pose(0.0, 0.0, 0.0), room):
        around: Any = Around(moved.compose(here), moved)
        guard = Guard(around, OUTLINE, planner, margin=0.02)
        found.append(guard.evaluate(plan, support))
    assert found[0] == pytest.approx(found[1], abs=1e-9)


@FEW
@given(MOVED, st.sampled_from(list(Foot)), st.booleans())
def test_a_reference_turns_with_the_frame_of_its_plan(
    frame: Pose, foot: Foot, swings: bool
) -> None:
    """ZMP, DCM, feet, template, and what the swing leg shifts the ZMP by."""
    gait = PRESETS["fast"] if swings else GAIT
    plan: ManeuverPlan = ManeuverPlanner(gait).plan(
        0.6,
        Direction.BACKWARD,
        first_foot=foot,
        state=CenterState((0.01, 0.03), (0.05, -0.1)),
        swing_start=Pose(-0.03, foot.value * 0.1, 0.05),
    )
    tables = []
    for place in (Pose(0.0, 0.0, 0.0), frame):
        table = ReferenceTable(TICK)
        # What was sampled before, between other ticks, changes nothing.
        if place is frame:
            table.load(plan, frame, 0.0013, 0.4)
        table.load(plan, place, 1.0, 0.4)
        tables.append(table)
    for time in (1.0, 1.1, 1.2, 1.3):
        plain, row = (table.at(time) for table in tables)
        same_row(row, row_in(frame, plain))
    if swings:
        assert plan.schedule.has_swing_reaction
        assert any(hypot(*tables[0].at(t).reaction) > 1e-4 for t in (1.1, 1.2))


@FEW
@given(MOVED, MOVED, MOVED)
def test_a_body_rests_midway_between_its_feet_in_any_frame(
    frame: Pose, left: Pose, right: Pose
) -> None:
    plain = resting_sample(left, right, GAIT)
    feet = frame.compose(left), frame.compose(right)
    row = resting_sample(*feet, GAIT)
    wanted = row_in(frame, plain)
    off = wrap_angle(row.template.theta - wanted.template.theta)
    template = row.template._replace(theta=wanted.template.theta)
    if abs(abs(wrap_angle(left.theta - right.theta)) - pi) > 1e-6:
        assert off == pytest.approx(0.0, abs=1e-9)
    same_row(row._replace(template=template), wanted)


NAO = load_robot("nao")
FORWARD = ForwardKinematics(NAO)
BENT = np.array([NAO.standing.get(name, 0.0) for name in FORWARD.tree.motors])


def estimates(frame: Pose) -> list[Any]:
    """States of a body that leans and sways over feet in some odometry."""
    random = np.random.default_rng(5)
    made = StateEstimator(FORWARD, FORWARD.force_sensors(), 6.0, TICK)
    found = []
    for _ in range(700):
        feet = BodyReference(
            (0.1, 0.2, 0.27), (0.3, 0.25, 0.0, 0.4), (0.32, 0.15, 0.0, 0.3)
        )
        joints = BENT + 0.02 * random.normal(size=BENT.size)
        measured = RobotState(
            0.0,
            joints,
            0.02 * random.normal(size=3),
            np.array([0.6, -0.3, 9.7]),
            random.uniform(2.0, 9.0, 8),
            None,
        )
        asked = random.normal(size=2), 0.01 * random.normal(size=2)
        acceleration, reaction = (turned(frame, v.tolist()) for v in asked)
        found.append(
            made.update(measured, body_in(frame, feet), acceleration, reaction)
        )
    return found[::50] + found[-1:]


@pytest.mark.parametrize("frame", [Pose(1.0, -2.0, 2.3), Pose(0, 0, -1.1)])
def test_an_estimate_turns_with_odometry(frame: Pose) -> None:
    """Quantities in the torso frame, tilt and rates, do not turn."""
    plain, moved = estimates(Pose(0.0, 0.0, 0.0)), estimates(frame)
    for one, two in zip(plain, moved, strict=True):
        for name, law in (
            ("com", put),
            ("zmp", put),
            ("dcm", put),
            ("velocity", turned),
        ):
            wanted = law(frame, getattr(one, name))
            assert getattr(two, name) == pytest.approx(wanted, abs=1e-8)
        for name in ("tilt", "rate", "left_share", "weight"):
            assert getattr(two, name) == pytest.approx(getattr(one, name))


def fed_back(frame: Pose, method: str) -> list[Any]:
    """Correction of a disturbed state, in some odometry frame."""
    feedback, fake = stabiliser(method, delay=3 * TICK, lean=0.1)
    made: Any = fake
    off = (0.03, -0.02), (0.05, 0.04)
    made.off_com, made.off_dcm = (turned(frame, each) for each in off)
    made.tilt = (0.05, -0.04)
    moved = row_in(frame, ROW)
    plain = ROW.body.com[:2], ROW.dcm, ROW.zmp
    shift = [
        (b[0] - a[0], b[1] - a[1])
        for a, b in zip(
            plain, (moved.body.com, moved.dcm, moved.zmp), strict=True
        )
    ]
    made.off_com = (
        made.off_com[0] + shift[0][0],
        made.off_com[1] + shift[0][1],
    )
    made.off_dcm = (
        made.off_dcm[0] + shift[1][0],
        made.off_dcm[1] + shift[1][1],
    )
    found: list[Any] = []
    support = frame.compose(SUPPORT)
    landing = support.compose(Pose(0.04, 0.1, 0.0))
    for _ in range(12):
        stepped = step(support=support, landing=landing)
        body = feedback.update(MEASUREMENT, moved, stepped)
        found.append((body, feedback.zmp_shift, feedback.step_shift))
    landed = feedback.land(landing, (0.01, 0.02), (0.03, 0.04), stepped)
    told = [(feet, asked) for feet, asked in made.told]
    return [found, landed, told]


@pytest.mark.parametrize("method", ["closed-form", "measured"])
@pytest.mark.parametrize("frame", [Pose(1.0, -2.0, 2.3), Pose(0, 0, -1.1)])
def test_feedback_turns_with_odometry(frame: Pose, method: str) -> None:
    plain, moved = (fed_back(f, method) for f in (Pose(0, 0, 0), frame))
    for one, two in zip(plain[0], moved[0], strict=True):
        wanted = body_in(frame, one[0])
        for a, b in zip(two[0], wanted, strict=True):
            np.testing.assert_allclose(a, b, atol=1e-9)
        for a, b in zip(one[1:], two[1:], strict=True):
            assert b == pytest.approx(turned(frame, a), abs=1e-9)
    foot, position, velocity = moved[1]
    assert foot[:2] == pytest.approx(put(frame, plain[1][0]), abs=1e-9)
    # Of the CoM in the frame of the foot nothing turns.
    assert position == pytest.approx(plain[1][1], abs=1e-9)
    assert velocity == pytest.approx(plain[1][2], abs=1e-9)
    for one, two in zip(plain[2], moved[2], strict=True):
        assert two[1] == pytest.approx(turned(frame, one[1]), abs=1e-9)


@pytest.mark.parametrize("late", [0, 1, 4])
def test_the_estimator_gets_the_delayed_command_in_any_frame(
    late: int,
) -> None:
    """Feet, acceleration and swing reaction, all of the same instant."""
    feedback, fake = stabiliser(delay=late * TICK)
    made: FakeEstimator = fake
    asked = []
    for i in range(12):
        row = ROW._replace(
            body=ROW.body._replace(
                com=(1.0 + 0.001 * i, -1.95, 0.27),
                left_foot=(0.1 + 0.01 * i, 0.2, 0.01, 0.3),
                right_foot=(0.4, 0.5 + 0.01 * i, 0.02, 0.6),
            ),
            reaction=(0.002 * i, -0.001 * i),
        )
        asked.append(row)
        feedback.update(MEASUREMENT, row, step())
        then = asked[max(0, i - late)]
        feet, _ = made.told[-1]
        assert made.reactions[-1] == then.reaction
        assert feet.right_foot == pytest.approx(then.body.right_foot)


class Noted(OpenLoop):
    """Open loop that notes what the plan asks for at each tick."""

    def __init__(self, legs: Any) -> None:
        super().__init__(legs)
        self.rows: list[ReferenceSample] = []

    def targets(
        self, measurement: RobotState, table: ReferenceTable, *more: Any
    ) -> Array:
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


class Paced:
    """Strategy that walks at a pace until it stands."""

    direction, saturated = Direction.BACKWARD, False

    def __init__(self, pace: float) -> None:
        self.pace, self.walks = pace, True

    def begin(self) -> None:
        """Nothing to remember."""

    def decide(self, known: Knowledge, memory: None) -> tuple[Intent, None]:
        """Walk on, or stand."""
        return Intent(0.3, moving=self.walks, pace=self.pace), None


@pytest.mark.parametrize("lost", [False, True])
@pytest.mark.parametrize("pace", [1.0, 0.75, 0.5])
def test_a_halt_has_the_pace_of_the_walk(pace: float, lost: bool) -> None:
    """After a decision to stand, and after loss of the opponent."""
    strategy = Paced(pace)
    run = Run(strategy)
    run.until(FIRST + 4.2 * STEP / pace)
    walked = run.steps[-1].plan.schedule
    assert walked.first_step_duration == pytest.approx(STEP / pace)
    strategy.walks = lost
    if lost:
        run.scheme.senses = SimpleNamespace(
            see=lambda *seen: None,
            turning=0.0,
            in_sight=None,
            aim=lambda targets: None,
        )
    run.until(FIRST + 8.0 * STEP / pace + 3.0)
    assert run.phase() is Phase.STANDING
    halt = run.steps[-1].plan.schedule
    assert run.steps[-1].planning_time is None
    assert halt.first_step_duration == pytest.approx(STEP / pace)
    gait = run.steps[-1].plan.gait
    assert gait.double_support == pytest.approx(GAIT.double_support / pace)
