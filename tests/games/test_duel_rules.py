"""Test how a duel begins, is evaluated and ends."""

from math import pi
from typing import Any

import mujoco
import numpy as np
import pytest

from fake_players import clock
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.game import Progress
from stepaside.games.outcome import Outcome
from stepaside.games.recorded_game import RecordedGame, run_duel
from stepaside.games.walker import SimulatedPlayer
from stepaside.sim.camera_settings import RoomObject, SceneSettings
from stepaside.sim.ground_truth import torsos_apart
from stepaside.sim.simulated_robot import SimulatedRobot
from stepaside.sim.world import World

START = StartSettings(1.3, 0.4, -0.2)


def begun(**changes: Any) -> RecordedGame:
    return RecordedGame(DuelSettings(**{"start": START, **changes}))


def walkers(duel: RecordedGame) -> list[SimulatedPlayer]:
    return [
        player
        for player in duel.in_physics.players
        if isinstance(player, SimulatedPlayer)
    ]


def test_robots_begin_at_the_poses_of_the_start() -> None:
    duel = begun()
    pursuer, evader = (player.truth for player in duel.in_physics.players)
    assert [player.name for player in duel.in_physics.players] == [
        "pursuer",
        "evader",
    ]
    assert duel.in_physics.player("evader") is duel.in_physics.players[1]
    assert duel.distance == pytest.approx(1.3, abs=1e-6)
    assert pursuer.heading_in_world == pytest.approx(0.4)
    assert abs(evader.heading_in_world) == pytest.approx(pi - 0.2)
    np.testing.assert_allclose(
        pursuer.position_reference_in_world, [0.0, 0.0], atol=1e-6
    )
    np.testing.assert_allclose(
        evader.position_reference_in_world, [1.3, 0.0], atol=1e-6
    )
    assert duel.settings.start == START
    assert duel.closest == {
        ("evader", "pursuer"): torsos_apart(pursuer, evader)
    }
    assert duel.in_physics.first_moves == {}


def lay_down(duel: RecordedGame, number: int) -> None:
    robot = walkers(duel)[number].robot
    at = robot.qpos_slice.start
    duel.in_physics.data.qpos[at + 2] = 1.0
    duel.in_physics.data.qpos[at + 3 : at + 7] = (0.5**0.5, 0.5**0.5, 0.0, 0.0)
    mujoco.mj_forward(duel.in_physics.model, duel.in_physics.data)


@pytest.mark.parametrize(
    ("fallen", "message"),
    [
        ((0,), "pursuer fell at 0.02 s"),
        ((1,), "evader fell at 0.02 s"),
        ((0, 1), "pursuer and evader fell at 0.02 s"),
    ],
)
def test_a_fall_ends_a_duel_and_is_reported(
    monkeypatch: pytest.MonkeyPatch, fallen: tuple[int, ...], message: str
) -> None:
    decide = RecordedGame.decide

    def clumsy(duel: RecordedGame) -> None:
        if duel.in_physics.ticks == 4:
            for number in fallen:
                lay_down(duel, number)
        decide(duel)

    monkeypatch.setattr(RecordedGame, "decide", clumsy)
    result = run_duel(DuelSettings(start=START, duration=1.0))
    assert result.outcome is Outcome.FALL and result.message == message
    assert result.duration == pytest.approx(0.02)
    assert result.times[-1] == result.duration


def touching(
    monkeypatch: pytest.MonkeyPatch,
    distance: float,
    *names: str,
    **changes: Any,
) -> tuple[Any, str]:
    """Return outcome and message with bodies in contact at a distance."""
    duel = begun(start=StartSettings(distance, 0.0, 0.0), **changes)
    monkeypatch.setattr(World, "robots_touch", lambda world: True)
    monkeypatch.setattr(World, "touching", lambda world: names)
    return duel.tick(), duel.message


def test_contact_is_checked_where_it_is_possible(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Robots two arm spans apart can only touch obstacles."""
    both = ("evader", "pursuer")
    words = "evader and pursuer touched at 0.00 s"
    assert touching(monkeypatch, 0.6, *both) == (Outcome.CONTACT, words)
    assert touching(monkeypatch, 0.9, *both) == (None, "")
    room = SceneSettings(things=[RoomObject("red box", 3.0, 0.0)])
    assert touching(monkeypatch, 0.9, "evader", "thing 0", room=room) == (
        Outcome.CONTACT,
        "evader and thing 0 touched at 0.00 s",
    )
    assert touching(monkeypatch, 0.6, *both, pursuer="person") == (
        Outcome.CONTACT,
        words,
    )


def test_without_contact_a_near_duel_goes_on() -> None:
    duel = begun(start=StartSettings(0.6, 0.0, 0.0))
    assert duel.tick() is None


def test_the_first_motion_of_each_player_is_noted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    duel = begun()
    world = duel.in_physics
    pursuer, evader = walkers(duel)
    moves = {pursuer: 0, evader: 3}
    monkeypatch.setattr(
        SimulatedPlayer,
        "is_moving",
        property(lambda walker: world.ticks >= moves[walker]),
    )
    monkeypatch.setattr(SimulatedPlayer, "tick", lambda walker: None)
    for _ in range(4):
        duel.tick()
    times = {name: time for name, (time, _) in world.first_moves.items()}
    assert times == pytest.approx({"pursuer": 0.004, "evader": 0.012})
    _, poses = world.first_moves["evader"]
    assert poses["evader"].x - poses["pursuer"].x == pytest.approx(
        1.3, abs=0.01
    )


def test_a_duel_begins_when_all_players_are_ready(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Earlier motion does not count."""
    duel = begun()
    world = duel.in_physics
    monkeypatch.setattr(
        SimulatedPlayer, "is_ready", property(lambda _: world.ticks >= 2)
    )
    monkeypatch.setattr(SimulatedPlayer, "is_moving", True)
    for _ in range(2):
        duel.tick()
        assert world.started_at is None and world.first_moves == {}
    duel.tick()
    assert world.started_at == pytest.approx(0.008)
    assert world.first_moves["evader"][0] == pytest.approx(0.012)


def test_a_duel_lasts_its_duration() -> None:
    ticks = 11
    result = run_duel(DuelSettings(start=START, duration=0.0401))
    assert result.outcome is Outcome.COMPLETED
    assert result.duration == pytest.approx(0.004 * ticks)
    assert result.message == f"played {0.004 * ticks:.2f} s"
    samples = [*0.02 * np.arange((ticks - 1) // 5 + 1), 0.004 * ticks]
    np.testing.assert_allclose(result.times, samples)
    # The pursuer plans at once; its first ZMP is midway between its feet.
    summary = result.summary
    assert summary.replans == 1 and summary.plan_time_us.median is not None
    assert summary.plan_time_us.median == summary.plan_time_us.p99
    assert summary.max_com_velocity_jump_m_s == 0.0
    assert summary.sight is None and summary.evader.sight is None
    assert result.stills == {}
    assert result.evader.sight is None
    assert summary.min_distance_m == pytest.approx(1.3, abs=0.03)
    assert result.outcome is Outcome.COMPLETED


def test_an_interrupted_duel_is_recorded_and_its_robots_closed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    closed: list[str] = []
    monkeypatch.setattr(
        SimulatedRobot, "close", lambda robot: closed.append(robot.name)
    )
    clock(monkeypatch, 0.05)

    def interrupt(progress: Progress) -> None:
        raise KeyboardInterrupt

    result = run_duel(DuelSettings(start=START, duration=5.0), interrupt)
    assert result.outcome is Outcome.INTERRUPTED
    assert result.message == "interrupted at 0.02 s"
    assert result.duration == pytest.approx(0.02)
    assert closed == ["pursuer", "evader"]
