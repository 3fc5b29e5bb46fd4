"""Test strategies by laws: invariance to frames, and times of sightings."""

from math import atan2, cos, hypot, pi, sin
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from floor_duels import play_steps
from stepaside.arena import Box, Disc, Obstacle, ObstacleSet, Polygon, Room
from stepaside.core.poses import Pose, wrap_angle
from stepaside.games import duel
from stepaside.games.floor_world import FloorAgent
from stepaside.strategies import (
    Evasion,
    Intent,
    Knowledge,
    Limits,
    LookAhead,
    Pursuit,
)

LIMITS = Limits(0.1, 0.2, 0.04, 0.7)
STEP = LIMITS.step_duration
ANGLE = st.floats(-pi, pi)
METRES = st.floats(-3.0, 3.0)
MOVED = st.builds(Pose, METRES, METRES, ANGLE)
SOLIDS = (Disc(0.9, 0.5, 0.2), Box(-0.4, 0.7, 0.5, 0.3, 0.4))
STRATEGIES: dict[str, Any] = {
    "pursuit": Pursuit(),
    "lead": Pursuit(lead=0.5),
    "evasion": Evasion(angle=1.0, safety_radius=1e6),
    "evasion in time": Evasion(trigger="time", contact_time=20.0),
    "look-ahead": LookAhead(cells=16),
    "optimal": LookAhead(cells=16, obstacles=False),
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
    stands = ObstacleSet(tuple(moved(each, frame) for each in solids))
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
            assert one.speed_factor == pytest.approx(two.speed_factor)


@pytest.mark.parametrize("name", STRATEGIES)
def test_a_game_in_steps_has_no_preferred_direction(name: str) -> None:
    strategy = STRATEGIES[name]
    chases = strategy.direction.value > 0
    both = (strategy, STRATEGIES["evasion"])
    players = both if chases else (STRATEGIES["pursuit"], strategy)
    starts = Pose(0.1, 0.2, 0.5), Pose(0.9, 0.4, 2.4)
    obstacles = (Disc(0.8, -0.7, 0.2), Box(-0.5, 0.9, 0.4, 0.3, 0.4))
    tracks = []
    for frame in (Pose(0.0, 0.0, 0.0), Pose(0.3, -0.2, 1.9)):
        solids = tuple(moved(solid, frame) for solid in obstacles)
        begin = frame.compose(starts[0]), frame.compose(starts[1])
        tracks.append(
            play_steps(*players, begin, 10, room=Room(None, None, solids))
        )
    one, two = tracks
    assert one.outcome == two.outcome
    np.testing.assert_allclose(one.distances, two.distances, atol=1e-6)
    np.testing.assert_allclose(one.clearances, two.clearances, atol=1e-6)
    near, far = (np.cos(t.evader[:, 2] - t.pursuer[:, 2]) for t in tracks)
    np.testing.assert_allclose(near, far, atol=1e-6)


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
    pair = duel().identities
    agent = FloorAgent(
        strategy,
        LIMITS,
        pair["evader"],
        list(pair.values()),
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
