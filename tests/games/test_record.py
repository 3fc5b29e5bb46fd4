"""Test that each recorded array holds the quantity of its name."""

from math import pi
from typing import Any

import numpy as np
import pytest

from fake_players import FakePlayer, begun, fake_game
from stepaside.core.poses import Array, Pose
from stepaside.games.game import GameInPlay
from stepaside.games.recorder import Recorder
from stepaside.planning import Foot

FRAMES = (Pose(0.0, 0.0, 0.0), Pose(1.0, 2.0, pi / 2))
NAMES = ("a", "b")


def tell(player: FakePlayer, number: int) -> None:
    """Give a player values that identify player and quantity."""
    base = 100.0 * number
    player.seen = {
        "com": (base + 1.0, base + 2.0, base + 3.0),
        "torso": Pose(base + 4.0, base + 5.0, 0.5 * number),
        "place": Pose(base + 14.0, base + 15.0, 0.5 * number),
        "frame": FRAMES[number],
    }


def recorder(
    tick: float = 0.004,
) -> tuple[Recorder, GameInPlay, Any, list[FakePlayer]]:
    match, world = fake_game(0.0, 2.0)
    players = world.players
    world.physics.tick = tick
    for number, player in enumerate(players):
        tell(player, number)
    return Recorder(world), match, world, players


def arrays_of(made: Recorder) -> dict[str, Array]:
    found = {"times_s": made.times}
    for name, track in made.tracks().items():
        found |= track.arrays(name)
    return found


def test_a_record_holds_the_samples_of_each_player() -> None:
    made, match, world, _ = recorder()
    made.before(match)
    world.ticks = 5
    made.before(match)
    arrays = arrays_of(made)
    np.testing.assert_array_equal(arrays["times_s"], [0.0, 0.02])
    for number, name in enumerate(NAMES):
        seen = 100.0 * number + np.array([1.0, 2.0, 3.0])
        np.testing.assert_array_equal(arrays[f"{name}_com"], [seen, seen])


def test_landings_are_in_the_world_with_their_side() -> None:
    made, match, _, players = recorder()
    made.before(match)
    first = begun()
    other = begun(
        landing_time=1.4, foot=Foot.RIGHT, landing=Pose(0.4, -0.1, 0.3)
    )
    for step in (first, None, other, None):
        for player in players:
            player.begun = step
        made.acted(match)
    arrays = arrays_of(made)
    np.testing.assert_allclose(
        arrays["a_landings"],
        [[1.0, 1.0, 0.3, 0.1, 0.2], [1.4, -1.0, 0.4, -0.1, 0.3]],
    )
    np.testing.assert_allclose(
        arrays["b_landings"],
        [
            [1.0, 1.0, 1.0 - 0.1, 2.0 + 0.3, 0.2 + pi / 2],
            [1.4, -1.0, 1.0 + 0.1, 2.0 + 0.4, 0.3 + pi / 2],
        ],
    )


def test_planning_times_are_recorded_for_each_player() -> None:
    """A halt is a step without a planned maneuver."""
    made, match, _, players = recorder()
    steps = (
        begun(velocity_jump=1e-3),
        begun(planning_time=4e-4, velocity_jump=3e-3),
        begun(planning_time=None, velocity_jump=2e-3),
    )
    for step in steps:
        players[1].begun = step
        made.acted(match)
    nothing, planned = (made.planning()[name] for name in NAMES)
    assert planned.steps == 3
    np.testing.assert_allclose(planned.times, [2e-4, 4e-4])
    assert planned.velocity_jump == 3e-3
    assert planned.zmp_margin == pytest.approx(0.02)
    assert nothing.steps == 0 and nothing.times.shape == (0,)
    assert nothing.velocity_jump == 0.0 and nothing.zmp_margin is None


def test_headings_are_unwrapped() -> None:
    made, match, _, players = recorder()
    for heading in (3.0, -3.1, -2.9):
        players[0].seen["torso"] = Pose(0.0, 0.0, heading)
        made.before(match)
    headings = arrays_of(made)["a_torso"][:, 2]
    expected = [3.0, 2 * pi - 3.1, 2 * pi - 2.9]
    np.testing.assert_allclose(headings, expected)


def test_a_player_without_odometry_has_no_landings() -> None:
    made, match, _, players = recorder()
    del players[0].seen["frame"]
    made.before(match)
    assert made.tracks()["a"].landings is None


def test_samples_are_taken_when_due_and_at_the_end() -> None:
    """The last one only once."""
    for ticks, expected in ((12, [0.0, 0.02, 0.04, 0.048]), (10, None)):
        made, match, world, _ = recorder()
        for _ in range(ticks):
            made.before(match)
            world.step()
        for _ in range(2):
            made.ended(match)
        found = [0.0, 0.02, 0.04] if expected is None else expected
        np.testing.assert_allclose(made.times, found)


@pytest.mark.parametrize(
    ("tick", "every"), [(0.004, 5), (0.012, 2), (0.002, 10), (0.06, 1)]
)
def test_samples_are_about_20_ms_apart(tick: float, every: int) -> None:
    assert recorder(tick)[0].every == every
