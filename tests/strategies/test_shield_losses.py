"""Test that the shield charges each loss of docs/shield-proof.md.

What is charged is computed here, by the formulas of that page.
"""

from dataclasses import dataclass, replace
from math import asin, atan2, ceil, cos, hypot, pi, sin
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Array, Pose, wrap_angle
from stepaside.planning import Direction
from stepaside.strategies import StandStill
from stepaside.strategies.body_departure import BodyDeparture
from stepaside.strategies.knowledge import STAND, Intent, Knowledge, Limits
from stepaside.strategies.observed_course import Course
from stepaside.strategies.opponent_track import SeenOpponent
from stepaside.strategies.shield import ShieldedStrategy, ShieldMemory
from stepaside.strategies.shield_settings import ShieldSettings
from stepaside.strategies.velocity_set import (
    AxisValues,
    BodyVelocity,
    VelocitySet,
)
from stepaside.theory.value import ShieldTable, sub_poses

STEP, STRIDE = 0.5, 0.04  # of the paper's walk, in [s] and [m]
WALK = Limits(0.1, 0.2, STRIDE, STEP)
LEGS = VelocitySet(
    (-0.5, 0.6), (-0.1, 0.3), (-0.9, 0.4), AxisValues(0.2, 0.4, 0.1), tube=0.25
)
PERSON = ShieldSettings(True, 0.03, 0.5, 0.3)
BODY = BodyDeparture(0.2, 0.05, 0.004, 0.001)
HALT = STEP + 1.0  # until a walking robot stands and decides again, in [s]


@pytest.fixture(autouse=True)
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("stepaside.strategies.shield.CELLS", 5)
    # Whom else it could evade is not asked.
    monkeypatch.setattr("stepaside.strategies.shield.LEAST_SPEED", 9.0)


def heading_error(person: ShieldSettings, window: float) -> float:
    """Return b: of the best chord that decisions a window [s] apart show."""
    error, apart = person.sighting_error, person.speed * (window + 0.02)
    radius = person.turning_radius
    for _ in range(3):
        best = max(0.002, 2.0 * (error * radius) ** 0.5)
        taken = best / person.speed / window + 1.0
        error = person.sighting_error + 0.5 * lost(taken)
    best = 2.0 * (error * radius) ** 0.5
    apart += 2.0 * error + best / 8.0
    short = max(2.0 * error, best - 0.5 * apart)
    return max(
        asin(2.0 * error / chord) + asin((0.5 * chord + error) / radius)
        for chord in (short, short + apart)
    )


def lost(decisions: float) -> float:
    """Return what the odometry of the body does not know, in [m]."""
    return BODY.loss + BODY.drift * max(0.0, decisions - 1.0)


KNOWN = heading_error(PERSON, STEP)
UNSEEN = PERSON.speed / PERSON.turning_radius * HALT


def walk_loss(person: ShieldSettings, period: float) -> float:
    """Return epsilon of the paper's walk, in [m]."""
    return lost(period / STEP) if person.loss is None else person.loss


def walk_required(person: ShieldSettings, period: float) -> float:
    """Return r of the paper's walk, in [m]."""
    assert person.contact is not None
    return (
        person.contact
        + person.sighting_error
        + walk_loss(person, period)
        + BODY.tube
        + person.speed * person.sighting_delay
    )


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"turning_radius": 5.0},
        {"loss": 0.07},
        {"sighting_delay": 0.4},
        {"sighting_error": 0.001},
        {"contact": 0.5},
    ],
)
def test_required_distance_of_the_papers_walk(changes: dict[str, Any]) -> None:
    person = replace(PERSON, **changes)
    shield = ShieldedStrategy(StandStill(), person, BODY)
    model = shield.model_for(Knowledge(0.0, 0.0, 3.0, WALK))
    game = model.game()
    assert game.loss == pytest.approx(walk_loss(person, game.period))
    assert game.jump == pytest.approx(2.0 * person.sighting_error)
    assert game.person_speed == person.speed
    assert game.person_turn == person.speed / person.turning_radius
    assert game.heading_error == pytest.approx(heading_error(person, STEP))
    required = walk_required(person, game.period)
    assert model.required == pytest.approx(required)
    assert model.response == pytest.approx(2.0 * STEP)


def test_required_distance_of_learned_legs() -> None:
    person = replace(PERSON, sighting_delay=0.4, sighting_error=1e-4)
    models = [
        ShieldedStrategy(StandStill(), person, body).model_for(
            Knowledge(0.0, 0.0, 3.0, replace(WALK, velocities=legs))
        )
        for legs, body in (
            (LEGS, BODY),
            (LEGS._replace(tube=0.0), None),
            (LEGS._replace(tube=0.0, lags=AxisValues(0.2, 0.7, 0.1)), None),
        )
    ]
    epsilon = 0.24 * 0.6 * 0.48 + lost(6)
    assert models[0].game().loss == pytest.approx(epsilon)
    assert models[0].game().period == 0.48
    required = 0.3 + 1e-4 + epsilon + BODY.tube + person.speed * 0.42
    assert models[0].required == pytest.approx(required)
    # A body is its lag behind: by 0.3 s more at 0.6 m/s.
    more = models[2].required - models[1].required
    assert more == pytest.approx(0.3 * 0.6)


def test_motions_are_those_that_both_sides_of_the_legs_deliver() -> None:
    """Legs hold a velocity over the floor while they turn."""
    limits = replace(WALK, velocities=LEGS)
    shield = ShieldedStrategy(StandStill(), PERSON, BODY)
    model = shield.model_for(Knowledge(0.0, 0.0, 3.0, limits))
    motions = model.game().motions
    fastest = 0.0
    for motion in motions:
        u, v, turned = motion[-1]
        rate, moved = turned / 0.48, hypot(u, v) / 0.48
        fastest = max(fastest, moved)
        mirrored = np.abs(motions - motion * [1.0, -1.0, -1.0])
        assert mirrored.max(axis=(1, 2)).min() < 1e-9
        for share in (0.0, 0.5, 1.0):
            angle = atan2(v, u) - share * turned
            body = BodyVelocity(moved * cos(angle), moved * sin(angle), rate)
            assert np.allclose(LEGS.nearest(body), body)
    assert fastest == pytest.approx(0.6)


def test_template_of_lagging_legs_is_where_they_come_to_rest() -> None:
    """Legs that follow with their lag exactly displace it by nothing."""
    legs = LEGS._replace(lags=AxisValues(0.4, 0.3, 0.1))
    limits = replace(WALK, velocities=legs)
    # Nothing is certified against this person: the strategy decides.
    person = ShieldSettings(True, 3.0, 0.5, 0.3)
    strategy = ShieldedStrategy(Walking(Intent(pi, 1.0)), person)
    memory, body, velocity = strategy.begin(), 0.0, 0.0
    for i in range(60):
        known = Knowledge(
            0.08 * i, 0.0, 5.0, limits,
            pose_in_map=Pose(body, 0.0, 0.0), moving=True,
        )  # fmt: skip
        _, memory = strategy.decide(known, memory)
        assert memory.template is not None
        rest = body + 0.4 * velocity
        assert memory.template.position[0] == pytest.approx(rest, abs=1e-9)
        command = memory.command[0]
        change = (1.0 - np.exp(-0.08 / 0.4)) * (command - velocity)
        body += 0.08 * command - 0.4 * change
        velocity += change
    assert body < -0.2


@dataclass(frozen=True)
class Walking:
    """Evader that always decides the same.

    Attributes:
        intent: Its decision.
    """

    intent: Intent
    direction: Direction = Direction.BACKWARD
    saturated: bool = False

    def begin(self) -> None:
        """Return an empty memory."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Return the decision."""
        return self.intent, None


def decides(
    intent: Intent, pose: Array, *, moving: bool, error: float
) -> tuple[bool, ShieldTable]:
    """Return whether a decision stands as a safe one, and the table.

    Args:
        intent: Decision of the strategy.
        pose: Pose of the robot in the frame of the person.
        moving: Whether it walks.
        error: How far the heading of the person may be off, in [rad].
    """
    strategy = ShieldedStrategy(Walking(intent), PERSON, BODY)
    turned = Pose(0.3, -0.2, 0.7)  # of the person in the map
    own = turned.compose(Pose(*pose.tolist()))
    memory: ShieldMemory = strategy.begin()._replace(
        rows=(SeenOpponent(1.0, turned.x, turned.y),),
        course=Course(1.0, turned.theta, error, error),
        time=1.0,
    )
    bearing = wrap_angle(atan2(turned.y - own.y, turned.x - own.x) - own.theta)
    away = hypot(turned.x - own.x, turned.y - own.y)
    known = Knowledge(1.0, bearing, away, WALK, pose_in_map=own, moving=moving)
    decided, memory = strategy.decide(known, memory)
    return decided == intent and memory.guarded, strategy.model_for(
        known
    ).table()


def after_walks(pose: Array, duration: float) -> tuple[Array, float]:
    """Return poses of a standing robot after walks, and the least distance."""
    most = PERSON.speed / PERSON.turning_radius
    twists = [
        (share * PERSON.speed, 0.0, rate)
        for share in (0.0, 0.5, 1.0)
        for rate in (-most, -0.5 * most, 0.0, 0.5 * most, most)
    ]
    twists += [  # beside the heading by which it is known
        (PERSON.speed * cos(off), PERSON.speed * sin(off), rate)
        for off in (-KNOWN, KNOWN)
        for rate in (-most, 0.0, most)
    ]
    walks = sub_poses(twists, duration)
    x, y = pose[0] - walks[:, :, 0], pose[1] - walks[:, :, 1]
    turned = walks[:, -1, 2]
    c, s = np.cos(turned), np.sin(turned)
    later = np.stack(
        [
            c * x[:, -1] + s * y[:, -1],
            c * y[:, -1] - s * x[:, -1],
            pose[2] - turned,
        ],
        axis=1,
    )
    return later, float(np.hypot(x, y).min())


def guaranteed(
    table: ShieldTable, intent: Intent, poses: Array, *, moving: bool
) -> float:
    """Return what a decision leaves guaranteed, by docs/shield-proof.md."""
    if intent.walks:
        turn = 0.08 * intent.heading
        twist = (-STRIDE * intent.speed_factor / STEP, 0.0, turn / STEP)
        motion = sub_poses([twist], STEP)
        follow = table.outcomes if moving else table.start_outcomes
        return float(follow(poses, motion, STEP)[0])
    if not moving:
        return float(table.standing_value(poses).min())
    # Less a stride and the loss of the time in which nothing is decided.
    lost = STRIDE + walk_loss(PERSON, 2.0) * HALT / 2.0
    found = []
    for pose in poses:
        later, least = after_walks(pose, HALT)
        found += [least, table.standing_value(later).min()]
    return float(min(found)) - lost


def turned_to(pose: Array, spread: float) -> Array:
    """Return a pose for headings of the person. Shape (n, 3)."""
    x, y, theta = pose
    count = ceil(spread / 0.25)
    rows = []
    for heading in np.linspace(-spread, spread, 2 * count + 1):
        c, s = cos(heading), sin(heading)
        rows.append((c * x + s * y, c * y - s * x, theta - heading))
    return np.array(rows)


@pytest.mark.parametrize("error", [KNOWN, KNOWN + 0.6])
@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("intent", [STAND, Intent(2.0, 0.8)])
def test_decision_stands_where_the_required_distance_stays_guaranteed(
    intent: Intent, moving: bool, error: float
) -> None:
    """Against all headings that the person can have."""
    # What is known of a heading is charged by the walks of the game.
    spread = 0.0 if error == KNOWN else error
    if moving and not intent.walks:
        spread = error + UNSEEN
    random, counts = np.random.default_rng(7), [0, 0]
    required = walk_required(PERSON, 2.0)
    for pose in random.uniform([-0.8, -0.9, -pi], [1.2, 0.9, pi], (150, 3)):
        stands, table = decides(intent, pose, moving=moving, error=error)
        poses = turned_to(pose, spread)
        value = guaranteed(table, intent, poses, moving=moving)
        if abs(value - required) > 0.002:
            assert stands == (value > required)
            counts[stands] += 1
    assert min(counts) > 10


def test_walks_beside_the_heading_that_is_known_are_charged() -> None:
    """A person reaches a side that its heading does not show."""
    _, table = decides(
        STAND, np.array([2.0, 0.0, 0.0]), moving=True, error=KNOWN
    )
    ends = table.game.walks(2.0)[:, -1, :2]
    beside = np.abs(np.arctan2(ends[:, 1], ends[:, 0]))[ends[:, 0] > 0.01]
    turned = PERSON.speed / PERSON.turning_radius * 2.0
    assert beside.max() == pytest.approx(KNOWN + 0.5 * turned)


@pytest.mark.parametrize(
    ("name", "least", "greatest"),
    [("response", 1.0, 3.0), ("sighting_delay", 0.0, 2.0)],
)
def test_robot_must_start_earlier_by_the_way_of_the_person_meanwhile(
    name: str, least: float, greatest: float
) -> None:
    """A robot that responds late, or acts on old sightings."""
    begins = []
    for value in (least, greatest):
        changes: dict[str, Any] = {name: value}
        person = replace(PERSON, **changes)
        strategy = ShieldedStrategy(StandStill(), person, BODY)
        for away in np.arange(1.2, 0.3, -0.01).tolist():
            memory = strategy.begin()._replace(
                rows=(SeenOpponent(1.0, 0.0, 0.0),),
                course=Course(1.0, 0.0, KNOWN, KNOWN),
            )
            own = Pose(away, 0.0, pi)
            known = Knowledge(1.0, 0.0, away, WALK, pose_in_map=own)
            intent, _ = strategy.decide(known, memory)
            if intent.walks:
                break
        begins.append(away)
    walked = PERSON.speed * (greatest - least)
    assert begins[1] - begins[0] > walked - 0.02
