"""Test how a duel begins, is evaluated and ends."""

from math import pi
from typing import Any

import mujoco
import numpy as np
import pytest

from fake_players import clock
from stepaside.core.constants import CAPTURE_DISTANCE
from stepaside.games.duel import Duel, run_duel
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.game import Progress
from stepaside.games.outcome import Outcome
from stepaside.games.walker import SimulatedPlayer
from stepaside.sim.camera_settings import RoomObject, SceneSettings
from stepaside.sim.ground_truth import torsos_apart
from stepaside.sim.simulated_robot import SimulatedRobot

START = StartSettings(1.3, 0.4, -0.2)


def begun(**changes: Any) -> Duel:
    return Duel(DuelSettings(**{"start": START, **changes}))


def walkers(duel: Duel) -> list[SimulatedPlayer]:
    return [
        player
        for player in duel.players
        if isinstance(player, SimulatedPlayer)
    ]


def test_robots_begin_at_the_poses_of_the_start() -> None:
    duel = begun()
    pursuer, evader = (player.truth for player in duel.players)
    assert [player.name for player in duel.players] == ["pursuer", "evader"]
    assert duel.player("evader") is duel.players[1]
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
    assert duel.min_distance == torsos_apart(pursuer, evader)
    assert duel.triggered_at is None and duel.triggered_distance is None


def lay_down(duel: Duel, number: int) -> None:
    robot = walkers(duel)[number].robot
    at = robot.qpos_slice.start
    duel.world.data.qpos[at + 2] = 1.0
    duel.world.data.qpos[at + 3 : at + 7] = (0.5**0.5, 0.5**0.5, 0.0, 0.0)
    mujoco.mj_forward(duel.world.model, duel.world.data)


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
    decide = Duel.decide

    def clumsy(duel: Duel) -> Outcome | None:
        if duel.world.ticks == 4:
            for number in fallen:
                lay_down(duel, number)
        return decide(duel)

    monkeypatch.setattr(Duel, "decide", clumsy)
    result = run_duel(DuelSettings(start=START, duration=1.0))
    assert result.outcome is Outcome.FALL and result.message == message
    assert result.duration == pytest.approx(0.02)
    assert result.times[-1] == result.duration


def touching(distance: float, *names: str, **changes: Any) -> tuple[Any, str]:
    """Return outcome and message with bodies in contact at a distance."""
    duel = begun(start=StartSettings(distance, 0.0, 0.0), **changes)
    world: Any = duel.world
    world.robots_touch = lambda: True
    world.touching = lambda: names
    return duel.tick(), duel.message


def test_contact_is_checked_where_it_is_possible() -> None:
    """Robots two arm spans apart can only touch obstacles."""
    both = ("evader", "pursuer")
    words = "evader and pursuer touched at 0.00 s"
    assert touching(0.6, *both) == (Outcome.CONTACT, words)
    assert touching(0.9, *both) == (None, "")
    room = SceneSettings(things=[RoomObject("red box", 3.0, 0.0)])
    assert touching(0.9, "evader", "thing 0", room=room) == (
        Outcome.CONTACT,
        "evader and thing 0 touched at 0.00 s",
    )
    assert touching(0.6, *both, pursuer="person") == (Outcome.CONTACT, words)


def test_without_contact_a_near_duel_goes_on() -> None:
    duel = begun(start=StartSettings(0.6, 0.0, 0.0))
    assert duel.tick() is None


def test_closest_approach_and_trigger_are_recorded(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The last player triggers; motion of the pursuer does not."""
    duel = begun()
    pursuer, evader = walkers(duel)
    ways = iter((1.0, 0.9, 0.95, 0.85))
    moves = {pursuer: True, evader: False}

    def apart(duel: Duel) -> float:
        moves[evader] = duel.world.ticks >= 3
        return next(ways)

    monkeypatch.setattr(Duel, "torsos_apart", property(apart))
    monkeypatch.setattr(Duel, "distance", 0.7)
    monkeypatch.setattr(SimulatedPlayer, "is_moving", property(moves.get))
    monkeypatch.setattr(SimulatedPlayer, "tick", lambda walker: None)
    duel.min_distance = 5.0
    closest = []
    for _ in range(4):
        duel.tick()
        closest.append(duel.min_distance)
    assert closest == [1.0, 0.9, 0.9, 0.85]
    assert duel.triggered_at == pytest.approx(0.012)
    assert duel.triggered_distance == 0.7


def test_capture_is_the_first_time_at_the_capture_distance(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The game goes on, and the first time is kept."""
    duel = begun()
    ways = iter((0.4, CAPTURE_DISTANCE, 0.3, 0.4, 0.2))
    monkeypatch.setattr(Duel, "torsos_apart", property(lambda _: next(ways)))
    monkeypatch.setattr(SimulatedPlayer, "tick", lambda walker: None)
    monkeypatch.setattr(Duel, "distance", 0.3)
    told = []
    for _ in range(5):
        assert duel.tick() is None
        told.append(duel.captured_at)
    assert told[0] is None
    assert told[1:] == 4 * [pytest.approx(0.008)]


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
    clock(monkeypatch, 1.0)

    def interrupt(progress: Progress) -> None:
        raise KeyboardInterrupt

    result = run_duel(DuelSettings(start=START, duration=5.0), interrupt)
    assert result.outcome is Outcome.INTERRUPTED
    assert result.message == "interrupted at 0.10 s"
    assert result.duration == pytest.approx(0.1)
    assert closed == ["pursuer", "evader"]
