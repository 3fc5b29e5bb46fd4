"""Test the guard against obstacles with arbitrary intents."""

from math import cos, pi, sin
from typing import Any

import numpy as np
import pytest

from fake_robot import GAIT, FakeLegs, scheme_of
from stepaside.arena import (
    Box,
    Disc,
    Obstacle,
    ObstacleSet,
    Polygon,
    Room,
    RoomRecipe,
    clearance_between,
    generate_room,
    hull,
)
from stepaside.control.scheme import ControlScheme
from stepaside.core.poses import Array, Pose
from stepaside.locomotion.guard import Guard, KnownRoom
from stepaside.locomotion.locomotion import GuardDecision
from stepaside.locomotion.swept_outline import BodyOutline
from stepaside.perception.measurement import RobotState, Sighting
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    ManeuverPlan,
    ManeuverPlanner,
    TemplateDrive,
)
from stepaside.robots.description import load_robot
from stepaside.robots.newton_step import BodyReference
from stepaside.sim.outline_measurement import measure_outline
from stepaside.strategies import Intent, Knowledge
from stored_values import compare_stored, summed

NAO = load_robot("nao")
MARGIN = 0.02
SOLE = np.array([[0.095, 0.042], [-0.05, 0.042], [-0.05, -0.035]])
SOLE = np.concatenate([SOLE, [[0.095, -0.035]]])
TRUNK = np.array([[0.09, 0.1], [0.02, 0.16], [-0.07, 0.1]])
TRUNK = np.concatenate([TRUNK, TRUNK[::-1] * [1, -1]])
OUTLINE = BodyOutline(TRUNK, SOLE, SOLE * [1, -1])


class Whim:
    """Wants anything, and walks or stands for a while each."""

    saturated = False

    def __init__(self, seed: int) -> None:
        self.random = np.random.default_rng(seed)
        self.direction = list(Direction)[seed % 2]
        self.wanted = Intent()
        self.left = 0

    def begin(self) -> None:
        """Nothing to remember."""

    def decide(self, known: Knowledge, memory: None) -> tuple[Intent, None]:
        """Return a random intent for a random number of decisions."""
        if known.moving:
            self.left -= 1
        if self.left < 0:
            self.left = int(self.random.integers(1, 12))
            self.wanted = Intent(
                self.random.uniform(-pi, pi),
                self.random.uniform(0.2, 1.0) * (self.random.random() < 0.9),
            )
        if not known.moving:
            return Intent(self.wanted.heading), None
        return self.wanted, None


def scheme_in(
    room: Room, start: Pose, seed: int, tick: float
) -> ControlScheme:
    legs: Any = FakeLegs()
    guard = Guard(
        KnownRoom(room, start), OUTLINE, ManeuverPlanner(GAIT), margin=MARGIN
    )
    return scheme_of(Whim(seed), GAIT, legs, tick=tick, guard=guard)


def corners_of(body: BodyReference, frame: Pose) -> Array:
    """The outline of a body in the room, reckoned part by part."""
    parts = []
    for place, heading, corners in (
        (body.com[:2], body.heading, OUTLINE.trunk),
        (body.left_foot[:2], body.left_foot[3], OUTLINE.left_sole),
        (body.right_foot[:2], body.right_foot[3], OUTLINE.right_sole),
    ):
        parts.append(Pose(*place, heading).transform_points(corners))
    return frame.transform_points(np.concatenate(parts))


def clearance(room: Room, corners: Array) -> float:
    """Least distance of trunk and soles from everything."""
    parts = np.split(corners, [len(TRUNK), len(TRUNK) + len(SOLE)])
    return min(
        clearance_between(Polygon(tuple(map(tuple, part.tolist()))), solid)
        for part in parts
        for solid in room.solids
    )


@pytest.mark.slow
def test_an_accepted_step_and_its_halt_keep_clear() -> None:
    """The halt after each accepted step, from the step's own end."""
    random = np.random.default_rng(3)
    room = generate_room(RoomRecipe(2.2, 2.2, discs=2, boxes=1), 2)
    planner = ManeuverPlanner(GAIT)
    guard = Guard(
        KnownRoom(room, Pose(0.0, 0.0, 0.0)), OUTLINE, planner, margin=MARGIN
    )
    answers = []
    for _ in range(20):
        support = Pose(
            *random.uniform((-1.1, -1.1, -pi), (1.1, 1.1, pi)).tolist()
        )
        foot = Foot(random.choice([-1, 1]))
        plan = planner.plan(
            random.uniform(-pi, pi),
            list(Direction)[random.integers(2)],
            first_foot=foot,
            standing=True,
        )
        accepted = guard.accepts(plan, support, standing=False)
        answers.append(accepted)
        halt = guard.halt_after(plan)
        landed = support.compose(Pose(*plan.placements[2].tolist()))
        exact = min(
            clearance(room, points)
            for walked, frame in ((plan, support), (halt, landed))
            for points in OUTLINE.along(
                walked, frame, "step" if walked is plan else "all"
            )
        )
        if accepted:
            assert exact >= MARGIN - 1e-9
        else:
            # What is refused is near, but for what 32 directions miss.
            assert exact < MARGIN + 0.01
    assert 3 < sum(answers) < 17


def test_inside_the_margin_only_leaving_is_accepted() -> None:
    room = Room(obstacles=(Box(0.4, 0.0, 0.5, 2.0),))
    planner = ManeuverPlanner(GAIT)
    support = Pose(0.045, -0.05, 0.0)  # its toes are 1 cm from the box
    guard = Guard(
        KnownRoom(room, Pose(0.0, 0.0, 0.0)), OUTLINE, planner, margin=MARGIN
    )

    def accepts(direction: Direction, *, standing: bool) -> bool:
        plan = planner.plan(
            0.0, direction, first_foot=Foot.LEFT, standing=True
        )
        return guard.accepts(plan, support, standing=standing)

    assert accepts(Direction.BACKWARD, standing=True)
    assert not accepts(Direction.BACKWARD, standing=False)
    assert not accepts(Direction.FORWARD, standing=True)


def test_a_blocked_intent_is_slowed_then_turned_then_refused() -> None:
    """Before a wall a robot turns on the spot; in a box it stands."""
    planner = ManeuverPlanner(GAIT)

    def chosen(*solids: Obstacle) -> GuardDecision | None:
        guard = Guard(
            KnownRoom(Room(obstacles=solids), Pose(0.0, 0.0, 0.0)),
            OUTLINE,
            planner,
            margin=MARGIN,
        )
        return guard.choose(
            Intent(0.5),
            lambda choice: planner.plan(
                choice.intent.heading,
                Direction(1 - 2 * choice.back),
                first_foot=Foot.LEFT,
                standing=True,
                drive=TemplateDrive(speed_factor=choice.intent.speed_factor),
            ),
            Pose(0.0, -0.05, 0.0),
            standing=True,
        )

    wall = Box(0.642, 0.0, 1.0, 3.0)
    assert chosen() == GuardDecision(Intent(0.5))
    assert chosen(wall) == GuardDecision(Intent(0.5, 0.05))
    assert chosen(wall, *(Box(0.0, s * 0.3, 3.0, 0.2) for s in (1, -1))) is (
        None
    )


@pytest.mark.parametrize("wanted", [-0.3, 0.0, 0.1, 0.4])
def test_a_robot_before_a_pillar_steps_back(wanted: float) -> None:
    """Recorded case: every step but a sharp turn sways too near the wall."""
    planner, nao = ManeuverPlanner(GAIT), measure_outline(NAO, GAIT)
    room = Room(3.0, 3.0, (Disc(0.0, 0.0, 0.2),))
    around = KnownRoom(room, Pose(0.0, 0.0, 0.0))
    guard = Guard(around, nao, planner, margin=MARGIN)
    left = Pose(-0.3584152, -0.0619644, -0.9484182)
    right = Pose(-0.4396647, -0.1202613, -0.9484182)
    rest = right.inverse().compose(Pose(-0.3866308, -0.107408, 0.0))

    def plan_for(choice: GuardDecision) -> ManeuverPlan:
        return planner.plan(
            choice.intent.heading,
            Direction(1 - 2 * choice.back),
            first_foot=Foot.LEFT,
            state=CenterState(rest[:2], (0.0, 0.0)),
            swing_start=right.inverse().compose(left),
            standing=True,
            drive=TemplateDrive(speed_factor=choice.intent.speed_factor),
        )

    chosen = guard.choose(Intent(wanted), plan_for, right, standing=True)
    assert chosen is not None and chosen.back


def test_distances_are_never_overrated_and_hardly_underrated() -> None:
    random = np.random.default_rng(1)
    solids = (
        Disc(0.5, 0.1, 0.2),
        Box(-0.6, 0.3, 0.4, 0.2, 0.7),
        Polygon(((0.1, -0.9), (0.5, -0.8), (0.2, -0.4))),
        Box(0.0, 1.5, 4.0, 0.1, 0.013),
    )
    for _ in range(200):
        pose = Pose(*random.uniform((-1, -1, -pi), (1, 1, pi)).tolist())
        body = pose.transform_points(TRUNK)
        exact = min(clearance_between(hull(body), s) for s in solids)
        told = float(ObstacleSet(solids).swept_clearances(body[None])[0])
        assert told <= exact + 1e-12
        if exact > 0.0:
            assert told >= exact - 0.01


def test_a_body_between_two_instants_counts() -> None:
    """One that is here and there has been where the pillar stands."""
    pillar = ObstacleSet((Disc(0.0, 0.0, 0.05),))
    away = np.array([[TRUNK + (-1.0, 0.0)], [TRUNK + (1.0, 0.0)]])[:, 0]
    assert pillar.swept_clearances(away[:1])[0] > 0.5
    assert pillar.swept_clearances(away[1:])[0] > 0.5
    assert pillar.swept_clearances(away)[0] < 0.0


def test_a_measured_pose_corrects_odometry() -> None:
    """A robot that is where its odometry does not say knows it."""
    around = KnownRoom(Room(), Pose(1.0, 2.0, 0.5))
    body = Pose(0.3, 0.1, 0.2)
    nothing = np.zeros(3)
    blind = RobotState(0.0, nothing, nothing, nothing, nothing, None)
    around.note(blind, body)
    assert around.pose_odometry_in_map == Pose(1.0, 2.0, 0.5)
    place = Pose(-0.4, 0.7, 1.1)
    around.note(blind._replace(pose_in_room=place), body)
    found = around.pose_odometry_in_map.compose(Pose(0.3, 0.1, 0.2))
    np.testing.assert_allclose(found, place, atol=1e-12)


def test_the_body_has_the_heading_of_its_feet() -> None:
    plan = ManeuverPlanner(GAIT).plan(
        1.0, Direction.BACKWARD, first_foot=Foot.LEFT, standing=True
    )
    placed = OUTLINE.along(plan, Pose(0.0, 0.0, 0.0), "all")[:, : len(TRUNK)]
    turned = TRUNK - TRUNK.mean(axis=0)
    last = plan.placements[-1][2]
    for theta, shape in ((0.0, placed[0]), (last, placed[-1])):
        c, s = cos(theta), sin(theta)
        np.testing.assert_allclose(
            shape - shape.mean(axis=0), turned @ [[c, s], [-s, c]], atol=0.02
        )


@pytest.mark.parametrize("seed", range(10))
def test_a_walk_among_obstacles_goes_as_stored(seed: int) -> None:
    """Where feet land, and how the body moves, clear of all, through halts."""
    recipe = RoomRecipe(2.2, 2.2, discs=2, boxes=1, largest=0.2)
    room = generate_room(recipe, seed)
    assert room.starts is not None
    scheme = scheme_in(room, room.starts[0], seed, 0.04)
    found, least = list[Any](), list[float]()
    for tick in range(500):
        seen = Sighting(0.04 * tick, 0.3, 1.0)
        still = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(8)
        scheme.update(RobotState(0.04 * tick, *still, seen))
        found += [scheme.phase.value, scheme.walk.pose]
        if (begun := scheme.begun) is not None:
            found += [begun[1:5], begun.velocity_jump]
        if tick % 5 == 0:
            corners = corners_of(scheme.walk.reference, room.starts[0])
            least.append(clearance(room, corners))
    assert min(least) >= MARGIN - 1e-4
    compare_stored("walks.json", f"room {seed}", summed(found), 1e-5)
