"""Test that each recorded array holds the quantity of its name."""

from math import pi
from types import SimpleNamespace

import numpy as np
import pytest

from made_up_players import FakePlayer, FakeWorld, begun, game
from stepaside.core.poses import Array, Pose
from stepaside.games.match import Match
from stepaside.games.outcome import Outcome
from stepaside.games.recorder import Recorder
from stepaside.games.trajectory import Trajectory
from stepaside.planning import Foot

FRAMES = (Pose(0.0, 0.0, 0.0), Pose(1.0, 2.0, pi / 2))
NAMES = ("a", "b")


def tell(player: FakePlayer, number: int, row: int = 0) -> None:
    """Give a player values that identify player and quantity."""
    base = 100.0 * number
    walk = SimpleNamespace(
        reference=SimpleNamespace(com=(base + 8.0, base + 9.0, 0.3)),
        zmp_reference=(base + 10.0, base + 11.0),
    )
    player.seen = {
        "com": (base + 1.0, base + 2.0, base + 3.0),
        "torso": Pose(base + 4.0, base + 5.0, 0.5 * number),
        "place": Pose(base + 14.0, base + 15.0, 0.5 * number),
        "frame": FRAMES[number],
        "walk": walk,
        "zmp": (base + 6.0, base + 7.0),
        "posture": np.arange(3.0) + 3.0 * number + 0.5 * row,
    }


def recorder(
    tick: float = 0.004,
) -> tuple[Recorder, Match, FakeWorld, list[FakePlayer]]:
    match, world, players = game(0.0, 2.0)
    world.physics.tick = tick
    for number, player in enumerate(players):
        tell(player, number)
    return Recorder(players, tick=tick), match, world, players


def sample(made: Recorder, match: Match) -> None:
    """Take one sample at any time."""
    made._sample(match)


def arrays_of(made: Recorder) -> dict[str, Array]:
    found = {"times_s": made.times}
    for name, track in made.tracks().items():
        found |= track.arrays(name)
    return found


def test_a_record_holds_each_quantity_under_its_name() -> None:
    """References are in odometry, whose frame is rotated for the second."""
    made, match, world, players = recorder()
    made.before(match)
    world.ticks = 5
    for number, player in enumerate(players):
        tell(player, number, row=1)
    made.before(match)
    arrays = arrays_of(made)
    np.testing.assert_array_equal(arrays["times_s"], [0.0, 0.02])
    for number, name in enumerate(NAMES):
        base = 100.0 * number
        for row in (0, 1):
            np.testing.assert_allclose(
                arrays[f"{name}_com"][row], base + np.array([1, 2, 3])
            )
            np.testing.assert_allclose(
                arrays[f"{name}_torso"][row],
                [base + 4.0, base + 5.0, 0.5 * number],
            )
            np.testing.assert_allclose(
                arrays[f"{name}_place"][row],
                [base + 14.0, base + 15.0, 0.5 * number],
            )
            np.testing.assert_allclose(
                arrays[f"{name}_zmp"][row], [base + 6.0, base + 7.0]
            )
            posture = np.arange(3.0) + 3.0 * number + 0.5 * row
            np.testing.assert_array_equal(arrays[f"{name}_qpos"][row], posture)
    np.testing.assert_allclose(arrays["a_com_reference"][0], [8, 9])
    np.testing.assert_allclose(arrays["a_zmp_reference"][0], [10, 11])
    np.testing.assert_allclose(
        arrays["b_com_reference"][0], [1 - 109, 2 + 108]
    )
    np.testing.assert_allclose(
        arrays["b_zmp_reference"][0], [1 - 111, 2 + 110]
    )
    assert arrays["a_qpos"].dtype == np.float32
    assert set(arrays) == {"times_s"} | {
        f"{name}_{key}"
        for name in NAMES
        for key in (
            *(
                "com",
                "torso",
                "place",
                "com_reference",
                "zmp_reference",
                "zmp",
            ),
            *("qpos", "landings"),
        )
    }


def test_landings_are_in_the_world_with_their_side() -> None:
    made, match, _, players = recorder()
    sample(made, match)
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
        sample(made, match)
    headings = arrays_of(made)["a_torso"][:, 2]
    expected = [3.0, 2 * pi - 3.1, 2 * pi - 2.9]
    np.testing.assert_allclose(headings, expected)


def test_an_empty_record_has_the_usual_shapes() -> None:
    made, match, _, _ = recorder()
    assert made.times.shape == (0,)
    for track in made.tracks().values():
        assert track.com.shape == track.torso.shape == (0, 3)
        assert track.com_reference is None and track.landings is None
    sample(made, match)
    assert arrays_of(made)["a_landings"].shape == (0, 5)


def test_missing_quantities_are_none_in_a_trajectory() -> None:
    """A person has no plan; arrays are not filled with NaN."""
    made, match, _, players = recorder()
    players[0].seen = {}
    for _ in range(3):
        sample(made, match)
    person, robot = (made.tracks()[name] for name in NAMES)
    assert set(person.arrays("a")) == {"a_com", "a_torso", "a_place"}
    np.testing.assert_array_equal(person.com, [[0.0, 0.0, 0.3]] * 3)
    np.testing.assert_array_equal(person.torso, np.zeros((3, 3)))
    assert robot.qpos is not None and robot.qpos.shape == (3, 3)


@pytest.mark.parametrize(
    ("lacking", "arrays"),
    [
        ("posture", {"qpos"}),
        ("zmp", {"zmp"}),
        ("walk", {"com_reference", "zmp_reference"}),
        ("frame", {"landings"}),
    ],
)
def test_a_robot_without_plans_lacks_only_its_references(
    lacking: str, arrays: set[str]
) -> None:
    made, match, _, players = recorder()
    del players[1].seen[lacking]
    for _ in range(2):
        sample(made, match)
    whole, part = (made.tracks()[name] for name in NAMES)
    missing = whole.arrays("").keys() - part.arrays("").keys()
    assert missing == {f"_{name}" for name in arrays}
    for name in ("zmp", "com_reference"):
        value = getattr(part, name)
        assert value is None or value.shape == (2, 2)


def test_the_zmp_in_flight_is_nan_in_the_record() -> None:
    made, match, _, players = recorder()
    sample(made, match)
    players[0].seen["zmp"] = (np.nan, np.nan)
    sample(made, match)
    zmp = arrays_of(made)["a_zmp"]
    assert np.isfinite(zmp[0]).all() and np.isnan(zmp[1]).all()


def test_returned_trajectories_do_not_change_later() -> None:
    made, match, _, players = recorder()
    sample(made, match)
    first = made.tracks()["a"]
    tell(players[0], 1)
    sample(made, match)
    assert isinstance(first, Trajectory) and first.com.shape == (1, 3)
    np.testing.assert_array_equal(first.com, [[1.0, 2.0, 3.0]])
    assert made.tracks()["a"].com.shape == (2, 3)


def test_samples_are_taken_when_due_and_at_the_end() -> None:
    """The last one only once."""
    for ticks, expected in ((12, [0.0, 0.02, 0.04, 0.048]), (10, None)):
        made, match, world, _ = recorder()
        for _ in range(ticks):
            made.before(match)
            world.step()
        for _ in range(2):
            made.ended(match, Outcome.COMPLETED)
        found = [0.0, 0.02, 0.04] if expected is None else expected
        np.testing.assert_allclose(made.times, found)


@pytest.mark.parametrize(
    ("tick", "every"), [(0.004, 5), (0.012, 2), (0.002, 10), (0.06, 1)]
)
def test_samples_are_about_20_ms_apart(tick: float, every: int) -> None:
    assert recorder(tick)[0].every == every
