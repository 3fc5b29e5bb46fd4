"""A robot is pushed the way it is impulse_of_drag."""

import asyncio
from math import hypot, pi
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("viser")

from fake_page import Handle, Scene  # noqa: E402
from stepaside.core.errors import ConfigurationError  # noqa: E402
from stepaside.core.poses import Array  # noqa: E402
from stepaside.report.viewer.dragging import (  # noqa: E402
    MAX_IMPULSE,
    PushDragging,
    impulse_of_drag,
)
from stepaside.report.viewer.scene_layers import PUSH_LENGTH  # noqa: E402

EYE = np.array([-1.0, -2.0, 1.5])
GRABBED = np.array([0.2, 0.1, 0.3])


@pytest.mark.parametrize("angle", [0.0, 1.0, -2.5])
@pytest.mark.parametrize("depth", [0.3, 1.0, 4.0])
def test_a_pull_is_as_strong_as_its_way_on_the_level_of_the_grip(
    angle: float, depth: float
) -> None:
    """Wherever along the line of sight the pointer is said to be."""
    impulse = 1.2 * np.array([np.cos(angle), np.sin(angle)])
    tip = GRABBED + [*(PUSH_LENGTH * impulse), 0.0]
    pointed = EYE + depth * (tip - EYE)
    np.testing.assert_allclose(
        impulse_of_drag(EYE, GRABBED, pointed), impulse, atol=1e-12
    )


def test_no_hand_gives_more_than_the_most() -> None:
    far = GRABBED + [30.0, -40.0, 0.0]
    impulse = impulse_of_drag(EYE, GRABBED, far)
    np.testing.assert_allclose(impulse, MAX_IMPULSE * np.array([0.6, -0.8]))


@pytest.mark.parametrize("rise", [0.0, 0.5])
def test_a_level_or_rising_sight_pulls_as_far_as_it_passes_by(
    rise: float,
) -> None:
    eye = np.array([0.0, -1.0, 0.3])
    pointed = np.array([0.3, 0.1, 0.3 + rise])
    np.testing.assert_allclose(
        impulse_of_drag(eye, GRABBED, pointed) * PUSH_LENGTH,
        [0.1, 0.0],
        atol=1e-12,
    )


class Player:
    """Player that can be pushed, or not."""

    def __init__(self, heading: float, *, refuses: bool = False) -> None:
        """Stand with a heading, in [rad]."""
        self.name, self.refuses = "evader", refuses
        self.heading, self.pushes = heading, list[Any]()

    def snapshot(self) -> Any:
        """Pose of the player."""
        return SimpleNamespace(torso=(0.0, 0.0, self.heading))

    def push(self, push: Any) -> None:
        """Keep a push, or refuse it."""
        if self.refuses:
            raise ConfigurationError("a person is not pushed")
        self.pushes.append(push)


def table(player: Player) -> tuple[Any, Any, Handle, list[str]]:
    """Players, scene, drawn arrows and messages."""
    world = SimpleNamespace(time=7.0)
    players = {player.name: player}
    duel = SimpleNamespace(world=world, player=players.__getitem__)
    session: Any = SimpleNamespace(change=lambda request: request(duel))
    scene, mesh, said = Scene(), Handle("mesh"), list[str]()
    PushDragging(scene, session, said.append).add(player.name, [mesh])  # type: ignore[arg-type]
    return session, scene, mesh, said


def drag(mesh: Handle, phase: str, way: Array) -> None:
    """Do what viser does while a pointer pulls, seen from above."""
    event = SimpleNamespace(
        client=SimpleNamespace(
            camera=SimpleNamespace(position=GRABBED + [0.0, 0.0, 2.0])
        ),
        client_id=3,
        phase=phase,
        start_position=tuple(GRABBED),
        end_position=tuple(GRABBED + [*way, 0.0]),
    )
    for call in mesh.callbacks:
        asyncio.run(call(event))


def test_letting_go_pushes_along_the_arrow_that_was_seen() -> None:
    player = Player(heading=3.0)
    _, scene, mesh, said = table(player)
    way = PUSH_LENGTH * np.array([-0.9, -1.2])
    drag(mesh, "start", 0.1 * way)
    drag(mesh, "update", way)
    assert scene.items["/hand/3/strength"].text == "1.5 N s"
    [arrow] = scene.items["/hand/3/arrow"].points
    np.testing.assert_allclose((arrow[1] - arrow[0])[:2], way, rtol=1e-5)
    assert player.pushes == []
    drag(mesh, "end", way)
    assert scene.items == {}
    [push] = player.pushes
    assert (push.impulse, push.time) == (pytest.approx(1.5), 7.0)
    turned = push.direction + player.heading
    np.testing.assert_allclose(
        [np.cos(turned), np.sin(turned)], way / hypot(*way), atol=1e-12
    )
    assert -pi <= push.direction <= pi
    assert said == ["pushed the evader by 1.5 N s"]


def test_a_pull_of_nothing_is_none_and_a_refusal_is_told() -> None:
    player = Player(0.0, refuses=True)
    _, scene, mesh, said = table(player)
    for way in (np.zeros(2), np.array([0.3, 0.0])):
        drag(mesh, "start", way)
        drag(mesh, "end", way)
    assert said == ["a person is not pushed"]
    assert scene.items == {}
