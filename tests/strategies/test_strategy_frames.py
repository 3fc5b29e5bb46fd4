"""Test strategies by laws: invariance to frames, and times of sightings."""

from math import atan2, cos, hypot, inf, pi, sin
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stepaside.arena import Box, Disc, Obstacle, ObstacleSet, Polygon, Room
from stepaside.core.poses import Pose, wrap_angle
from stepaside.games import play_strategies
from stepaside.games.floor_games import PAIR
from stepaside.games.floor_world import FloorAgent
from stepaside.strategies import (
    Evasion,
    Intent,
    Knowledge,
    Limits,
    LookAhead,
    OptimalPursuit,
    Pursuit,
)
from stepaside.strategies.approach import Approach
from stepaside.strategies.look_ahead import predict_poses
from stepaside.strategies.opponent_track import OpponentTrack
from stepaside.strategies.search.step_motion import PlayerPair
from stepaside.strategies.strategy_game import StepGame

LIMITS = Limits(0.1, 0.2, 0.04, 0.7)
STEP = LIMITS.step_duration
ANGLE = st.floats(-pi, pi)
METRES = st.floats(-3.0, 3.0)
MOVED = st.builds(Pose, METRES, METRES, ANGLE)
SOLIDS = (Disc(0.9, 0.5, 0.2), Box(-0.4, 0.7, 0.5, 0.3, 0.4))
STRATEGIES: dict[str, Any] = {
    "pursuit": Pursuit(),
    "lead": Pursuit(lead=0.5),
    "optimal pursuit": OptimalPursuit(cells=16),
    "evasion": Evasion(angle=1.0, safety_radius=1e6),
    "evasion in time": Evasion(trigger="time", contact_time=20.0),
    "look-ahead": LookAhead(cells=16),
    "optimal": LookAhead(
        pieces=(1,), turns=15, tail=0, cells=16, obstacles=False
    ),
}


def moved(solid: Obstacle, frame: Pose) -> Obstacle:
    """Express an obstacle in the parent of a frame."""
    if isinstance(solid, Disc):
        x, y, _ = frame.compose(Pose(solid.x, solid.y, 0.0))
        return Disc(x, y, solid.radius)
    points = frame.transform_points(solid.points)
    return Polygon(tuple((x, y) for x, y in points.tolist()))


def known(
    own: Pose, other: Pose, time: float, age: float = 0.0, **more: Any
) -> Knowledge:
    """Return the knowledge for given poses and sighting."""
    x, y = other.x - own.x, other.y - own.y
    return Knowledge(
        time,
        wrap_angle(atan2(y, x) - own.theta),
        hypot(x, y),
        LIMITS,
        age=age,
        pose_in_map=own,
        moving=True,
        **more,
    )


def asked(strategy: Any, frame: Pose, solids: Any = ()) -> list[Intent]:
    """Intents in a game whose odometry lies somewhere else."""
    memory, intents = strategy.begin(), []
    own, other = Pose(0.2, -0.1, 0.4), Pose(1.3, 0.3, 2.2)
    stands = ObstacleSet(moved(solid, frame) for solid in solids)
    for i in range(5):
        velocity = Pose(0.0, 0.0, -own.theta).compose(
            Pose(0.06 * cos(other.theta), 0.06 * sin(other.theta), 0.0)
        )
        knows = known(
            frame.compose(own),
            frame.compose(other),
            STEP * i + 0.1,
            0.1,
            obstacles_in_map=stands,
            velocity=velocity[:2],
            step_start_in_map=frame.compose(
                own.compose(Pose(-0.02, 0.0, 0.1))
            ),
            bearing_rate=0.1,
            closing_speed=0.02,
        )
        intent, memory = strategy.decide(knows, memory)
        intents.append(intent)
        own = own.compose(Pose(-0.03, 0.0, 0.2))
        other = other.compose(Pose(0.04, 0.01, 0.15))
    return intents


@pytest.mark.parametrize("solids", [(), SOLIDS], ids=["open", "room"])
@pytest.mark.parametrize("name", STRATEGIES)
def test_decisions_do_not_depend_on_the_odometry_frame(
    name: str, solids: Any
) -> None:
    strategy = STRATEGIES[name]
    first = asked(strategy, Pose(0.0, 0.0, 0.0), solids)
    for frame in (Pose(2.0, -1.0, 2.1), Pose(-0.7, 3.0, -1.2)):
        for one, two in zip(
            first, asked(strategy, frame, solids), strict=True
        ):
            assert one.walks == two.walks
            off = wrap_angle(one.heading - two.heading)
            assert off == pytest.approx(0.0, abs=1e-4)
            assert (one.speed_factor, one.pace) == pytest.approx(
                (two.speed_factor, two.pace)
            )


@pytest.mark.parametrize("name", STRATEGIES)
def test_a_game_in_steps_has_no_preferred_direction(name: str) -> None:
    strategy = STRATEGIES[name]
    chases = strategy.direction.value > 0
    both = (strategy, STRATEGIES["evasion"])
    players = both if chases else (STRATEGIES["pursuit"], strategy)
    game = StepGame(duration=4.0)
    starts = Pose(0.1, 0.2, 0.5), Pose(0.9, 0.4, 2.4)
    obstacles = (Disc(0.8, -0.7, 0.2), Box(-0.5, 0.9, 0.4, 0.3, 0.4))
    tracks = []
    for frame in (Pose(0.0, 0.0, 0.0), Pose(0.3, -0.2, 1.9)):
        solids = tuple(moved(solid, frame) for solid in obstacles)
        begin = frame.compose(starts[0]), frame.compose(starts[1])
        tracks.append(
            play_strategies(
                *players, begin, room=Room(None, None, solids), game=game
            )
        )
    one, two = tracks
    assert one.outcome == two.outcome
    np.testing.assert_allclose(one.distances, two.distances, atol=1e-6)
    np.testing.assert_allclose(one.clearances, two.clearances, atol=1e-6)
    np.testing.assert_allclose(
        np.cos(one.bearings), np.cos(two.bearings), atol=1e-6
    )


@given(MOVED, ANGLE, st.floats(0.5, 2.0), st.floats(0.0, 1.5))
def test_lead_pursuit_points_ahead_of_a_straight_walk(
    own: Pose, way: float, distance: float, lead: float
) -> None:
    """At a point of its way, as far ahead as a share of the distance."""
    strategy = Pursuit(lead=lead)
    memory = strategy.begin()
    away = Pose(own.x, own.y, own.theta + 0.7)
    last = away.compose(Pose(distance, 0.0, 0.0))
    for i in (2, 1, 0):
        back = 0.04 * i
        there = Pose(last.x - back * cos(way), last.y - back * sin(way), way)
        knows = known(own, there, STEP * (2 - i))
        intent, memory = strategy.decide(knows, memory)
    reach = lead * distance
    aim = Pose(last.x + reach * cos(way), last.y + reach * sin(way), 0.0)
    x, y, _ = own.inverse().compose(aim)
    if hypot(x, y) > 0.05:
        off = wrap_angle(intent.heading - atan2(y, x))
        assert off == pytest.approx(0.0, abs=1e-6)


@given(MOVED, st.floats(-0.8, 0.8), st.floats(0.02, 0.2))
def test_the_heading_of_a_turning_opponent_is_the_tangent(
    start: Pose, turn: float, step: float
) -> None:
    """On a circle it is half a turn ahead of the chord to there."""
    track = OpponentTrack(STEP)
    pose, half = start, 0.5 * turn
    chord = Pose(step * cos(half), step * sin(half), turn)
    for i in range(3):
        track = track.note(STEP * i, pose[:2])
        last, pose = pose, pose.compose(chord)
    assert track.course is not None
    off = wrap_angle(track.course - last.theta)
    assert off == pytest.approx(0.0, abs=1e-6)


@given(MOVED, MOVED, ANGLE, st.floats(0.0, 3.0))
def test_the_pursuer_is_predicted_to_the_start_of_the_step(
    begins: Pose, other: Pose, heading: float, age: float
) -> None:
    """Half a step, until the body passes its foot, and the age."""
    both = PlayerPair(
        *(9.0, 9.0, 1.0, 0.0, other.x, other.y, cos(heading), sin(heading))
    )
    knows = known(Pose(9.0, 9.0, 0.0), other, 5.0, age)
    found = predict_poses(both, knows, begins)
    way = LIMITS.stride * (0.5 + age / STEP)
    ahead = Pose(other.x, other.y, heading).compose(Pose(way, 0.0, 0.0))
    assert (found.px, found.py) == pytest.approx(ahead[:2])
    assert (found.pc, found.ps) == pytest.approx((cos(heading), sin(heading)))
    assert found[:4] == pytest.approx(
        (begins.x, begins.y, cos(begins.theta), sin(begins.theta))
    )


@given(METRES, METRES, METRES, METRES, st.floats(0.0, 2.0))
def test_an_old_approach_is_extrapolated(
    x: float, y: float, u: float, v: float, age: float
) -> None:
    """It equals a new sighting at the extrapolated position."""
    own = Pose(0.0, 0.0, 0.0)
    velocity = (u, v)
    old = known(own, Pose(x, y, 0.0), 4.0, age, velocity=velocity)
    there = Pose(x + age * u, y + age * v, 0.0)
    new = known(own, there, 4.0, velocity=velocity)
    one, two = Approach.of(old), Approach.of(new)
    assert one == pytest.approx(two, abs=1e-9)
    assert one.miss <= one.distance + 1e-9
    soon = one.contact_time(0.5)
    if 0.0 < soon < inf:
        after = hypot(one.x + soon * u, one.y + soon * v)
        assert after == pytest.approx(0.5, abs=1e-6)


def test_the_miss_distance_is_independent_of_the_speed() -> None:
    """Also where the square of the speed is no number but 0."""
    for speed in (1e-203, 1e-160, 1e-3, 1.0):
        assert Approach(0.6, 0.8, -speed, 0.0).miss == pytest.approx(0.8)
    for speed in (0.0, 1e-203, 1e-160):
        approach = Approach(0.6, 0.8, -speed, 0.0)
        assert approach.contact_time(0.5) == inf


class Noting:
    """Strategy that records its knowledge."""

    direction, saturated = STRATEGIES["evasion"].direction, False

    def begin(self) -> tuple[Knowledge, ...]:
        """Nothing yet."""
        return ()

    def decide(self, knowledge: Knowledge, memory: Any) -> Any:
        """Walk straight on."""
        self.told = (*memory, knowledge)
        return Intent(0.0), self.told


@settings(max_examples=30)
@given(MOVED, st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))
def test_a_player_knows_the_opponents_velocity_in_its_own_frame(
    own: Pose, u: float, v: float
) -> None:
    """Of the other on the floor, however the own body moves and turns."""
    strategy: Any = Noting()
    agent = FloorAgent(
        strategy,
        LIMITS,
        PAIR["evader"],
        list(PAIR.values()),
        obstacles=ObstacleSet(SOLIDS),
    )
    moving = False
    for i in range(6):
        time = STEP * i
        here = own.compose(Pose(-0.03 * i, 0.0, 0.3 * i))
        there = Pose(own.x + 2.0 + u * time, own.y + v * time, 0.0)
        known = agent.look(
            time, {"evader": here, "pursuer": there}, moving=moving
        )
        assert known is not None
        moving = agent.evaluate(known).walks
    first, last = strategy.told[0], strategy.told[-1]
    assert first.velocity is None and last.pose_in_map == here
    assert last.obstacles_in_map.shapes == SOLIDS and last.age == 0.0
    turned = Pose(0.0, 0.0, -here.theta).compose(Pose(u, v, 0.0))
    assert last.velocity == pytest.approx(turned[:2], abs=1e-6)
    assert last.moving and not first.moving
