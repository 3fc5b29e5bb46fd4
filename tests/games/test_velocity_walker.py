"""Test simulated robots commanded by velocities."""

from dataclasses import replace
from math import atan2, hypot
from pathlib import Path

import pytest

from stepaside.core.poses import Pose, wrap_angle
from stepaside.drivers.robot import REST
from stepaside.drivers.watchdog import STUCK
from stepaside.games.game_settings import GameSettings, StartSettings, duel
from stepaside.games.player_settings import PLAYERS
from stepaside.games.recorded_game import RecordedGame
from stepaside.games.velocity_walker import VelocityWalker
from stepaside.locomotion.control_settings import STABILISED, LegsSettings
from stepaside.planning import GaitSettings
from stepaside.sim.body_settings import BODIES
from stepaside.strategies.velocity_set import BodyVelocity


def commanded_robots(
    settings: GameSettings, *, ideal_sight: bool = True
) -> tuple[RecordedGame, list[VelocityWalker]]:
    """Return a duel of two robots that are commanded by velocities."""
    game = RecordedGame(settings, remote=dict.fromkeys(PLAYERS, ideal_sight))
    robots = [
        p for p in game.in_physics.players if isinstance(p, VelocityWalker)
    ]
    assert len(robots) == 2
    return game, robots


SETTINGS = duel(
    seed=7,
    start=StartSettings(2.0, 0.2, 0.1),
    body=replace(BODIES["delayed"], cycle=0.012),
    control=STABILISED,
)


STEP = 0.547  # of the gait, in [s]


@pytest.fixture(scope="module")
def walked() -> tuple[VelocityWalker, VelocityWalker, list[BodyVelocity]]:
    """Return two robots that walked for 5 s, then rested for 3 s."""
    game, players = commanded_robots(SETTINGS)
    world = game.in_physics
    before = [player.velocity for player in players]
    players[0].command(BodyVelocity(0.06, 0.0, 0.1))
    players[1].command(BodyVelocity(-0.2, 0.0, 0.2))
    for tick in range(667):
        for player in players:
            if tick == 417:
                player.command(REST)
            player.tick()
        world.step()
    return players[0], players[1], before


def test_a_robot_walks_at_its_command_and_rests_on_command(
    walked: tuple[VelocityWalker, VelocityWalker, list[BodyVelocity]],
) -> None:
    ahead, back, before = walked
    assert before == [REST, REST]
    for robot, forward, turn in ((ahead, 0.06, 0.1), (back, -0.073, 0.073)):
        assert not robot.has_fallen and not robot.is_moving
        state = robot.state()
        # 4.2 s are seven steps, and the last one comes to rest.
        assert state.pose.theta == pytest.approx(6 * STEP * turn, rel=0.01)
        way = hypot(state.pose.x, state.pose.y)
        assert way == pytest.approx(6 * STEP * abs(forward), rel=0.1)
        assert state.pose.x * forward > 0.0
        assert robot.velocity == REST


def test_a_ready_robot_moves_before_a_watchdog_takes_it_for_frozen() -> None:
    game, players = commanded_robots(SETTINGS)
    world, robot = game.in_physics, players[0]
    robot.command(BodyVelocity(0.06, 0.0, 0.1))
    stands, ready_at = robot.state().pose, 0.0
    while robot.state().pose == stands:
        ready_at = ready_at if robot.ready else world.time
        robot.tick()
        world.step()
    longest = GaitSettings().start_support + STUCK
    assert 0.9 < ready_at < world.time < ready_at + longest


def test_odometry_is_where_the_robot_is(
    walked: tuple[VelocityWalker, VelocityWalker, list[BodyVelocity]],
) -> None:
    for robot in walked[:2]:
        state = robot.state()
        x, y, heading = robot.frame.compose(state.pose)
        u, v = robot.truth.position_reference_in_world
        assert hypot(x - u, y - v) < 0.02
        assert abs(wrap_angle(heading - robot.truth.heading_in_world)) < 0.05


def test_a_served_sighting_is_relative_to_the_heading_of_its_time() -> None:
    """Also while the robot turns."""
    game, players = commanded_robots(SETTINGS)
    world = game.in_physics
    for robot in players:
        robot.command(BodyVelocity(0.05, 0.0, 0.12))
    poses: list[dict[int, tuple[Pose, float]]] = [{}, {}]
    checked = 0
    for _ in range(420):
        for i, robot in enumerate(players):
            other = players[1 - i].truth.position_reference_in_world
            state = robot.state()
            pose = robot.frame.compose(state.pose)
            own = robot.truth.position_reference_in_world
            sight = atan2(other[1] - own[1], other[0] - own[0])
            poses[i][round(1000 * state.time)] = pose, sight
            seen = state.sighting
            key = None if seen is None else round(1000 * seen.time)
            if seen is not None and key in poses[i]:
                pose, sight = poses[i][key]
                off = wrap_angle(pose.theta + seen.bearing - sight)
                # 0.0124 by the odometry; 0.0156 from headings a tick older.
                assert abs(off) < 0.0135
                checked += state.time > 2.5
        for robot in players:
            robot.tick()
        world.step()
    assert checked > 50


def test_a_robot_on_learned_legs_steps_sideways(tmp_path: Path) -> None:
    pytest.importorskip("onnx")
    pytest.importorskip("onnxruntime")
    from imitated_walk import nao_on_imitated_walk

    folder = nao_on_imitated_walk(tmp_path / "nao", lateral=0.05)
    legs = LegsSettings(str(folder / "policy.onnx"))
    settings = duel(
        start=StartSettings(2.0, 0.0, 0.0), robot=str(folder), legs=legs
    )
    game, robots = commanded_robots(settings)
    world = game.in_physics
    robots[0].command(BodyVelocity(0.0, 0.03, 0.0))
    robots[1].command(BodyVelocity(0.0, -9.0, 0.0))
    for _ in range(round(6.0 / world.physics.tick)):
        for robot in robots:
            robot.tick()
        world.step()
    for robot, lateral in zip(robots, (0.03, -0.05), strict=True):
        state = robot.state()
        assert not robot.has_fallen
        assert robot.velocity == pytest.approx((0.0, lateral, 0.0))
        assert 0.5 < state.pose.y / (6.0 * lateral) < 1.3
        assert abs(state.pose.x) < 0.1 and abs(state.pose.theta) < 0.3
