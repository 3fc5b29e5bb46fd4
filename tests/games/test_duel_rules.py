"""Test how a duel begins, is evaluated and ends."""

from math import pi
from typing import Any

import mujoco
import numpy as np
import pytest

from stepaside.games.game import Outcome
from stepaside.games.game_settings import StartSettings
from stepaside.games.game_settings import duel as make_duel
from stepaside.games.players import RobotPlayer
from stepaside.games.recorded_game import RecordedGame, run_game
from stepaside.sim.camera_settings import RoomObject, SceneSettings
from stepaside.sim.ground_truth import torsos_apart
from stepaside.sim.world import World

START = StartSettings(1.3, 0.4, -0.2)


def begun(**changes: Any) -> RecordedGame:
    return RecordedGame(make_duel(**{"start": START, **changes}))


def walkers(duel: RecordedGame) -> list[RobotPlayer]:
    return [
        player
        for player in duel.in_physics.players
        if isinstance(player, RobotPlayer)
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
    tick = RecordedGame.tick

    def clumsy(duel: RecordedGame) -> Outcome | None:
        if duel.in_physics.ticks == 4:
            for number in fallen:
                lay_down(duel, number)
        return tick(duel)

    monkeypatch.setattr(RecordedGame, "tick", clumsy)
    result = run_game(make_duel(start=START, duration=1.0))
    assert result.outcome is Outcome.FALL and result.message == message
    assert result.duration == pytest.approx(0.02)
    assert result.times[-1] == result.duration


def touching(
    monkeypatch: pytest.MonkeyPatch, *names: str, **changes: Any
) -> tuple[Any, str]:
    """Return outcome and message with bodies in contact, however far."""
    duel = begun(**changes)
    monkeypatch.setattr(World, "robots_touch", lambda world: True)
    monkeypatch.setattr(World, "touching", lambda world: names)
    return duel.tick(), duel.message


def test_contact_ends_a_duel_and_names_who_touched(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    both = ("evader", "pursuer")
    words = "evader and pursuer touched at 0.00 s"
    assert touching(monkeypatch, *both) == (Outcome.CONTACT, words)
    room = SceneSettings(things=[RoomObject("red box", 3.0, 0.0)])
    assert touching(monkeypatch, "evader", "thing 0", scene=room) == (
        Outcome.CONTACT,
        "evader and thing 0 touched at 0.00 s",
    )
    assert touching(monkeypatch, *both, pursuer={"body": "person"}) == (
        Outcome.CONTACT,
        words,
    )
