"""Pushes by pulling a robot with the pointer: an arrow, then the push."""

from collections.abc import Callable, Iterable
from math import atan2, hypot, pi
from typing import Any

import numpy as np
import viser

from ...core.errors import StepAsideError
from ...core.poses import Array
from ...games.duel import Duel
from ...sim.push import Push
from ..figure_style import PUSHED
from ..palette import seen_by_all
from .live_session import LiveSession
from .scene_layers import PUSH_LENGTH, rgb

LEAST, MOST = 0.05, 4.0  # impulse of a hand, in [N s]
LEVEL = 0.1  # slope of a line of sight that meets the floor nowhere near


def pulled(eye: Array, grabbed: Array, pointed: Array) -> Array:
    """Impulse of a pull, level with the floor, in [N s]. Shape (2,).

    The pointer is where its line of sight is as high as what was grabbed; if
    that line is level, where it passes the grabbed point.

    Args:
        eye: Place of the camera, in the world, in [m]. Shape (3,).
        grabbed: Place that was grabbed, likewise.
        pointed: Any place on the line of sight of the pointer, likewise.
    """
    sight = pointed - eye
    steep = sight[2] / max(float(np.linalg.norm(sight)), 1e-9)
    way = (pointed - grabbed)[:2]
    if abs(steep) > LEVEL and (grabbed[2] - eye[2]) * steep > 0.0:
        met = eye + (grabbed[2] - eye[2]) / sight[2] * sight
        way = (met - grabbed)[:2]
    impulse: Array = way / PUSH_LENGTH
    strength = hypot(*impulse.tolist())
    return impulse * min(1.0, MOST / max(strength, 1e-9))


class PushDragging:
    """Lets all who look pull the robots of a page."""

    def __init__(
        self,
        scene: viser.SceneApi,
        session: LiveSession,
        say: Callable[[str], None],
    ) -> None:
        """Watch nothing yet.

        Args:
            scene: Of the page, for the arrows.
            session: Whose robots are pushed.
            say: Shows a message.
        """
        self._scene, self._session, self._say = scene, session, say

    def attend(self, number: int, meshes: Iterable[Any]) -> None:
        """Let a robot be pushed by what is seen of it.

        Args:
            number: 0 for the pursuer, 1 for the evader.
            meshes: What is seen of it.
        """

        # viser keeps the order only of callbacks that are coroutines.
        async def pull(event: Any) -> None:
            self._pull(number, event)

        for mesh in meshes:
            mesh.on_drag(pull)

    def _pull(self, number: int, event: Any) -> None:
        """Draw the arrow while the hand pulls, and push when it lets go."""
        grabbed = np.array(event.start_position)
        impulse = pulled(
            np.array(event.client.camera.position),
            grabbed,
            np.array(event.end_position),
        )
        name = f"/hand/{event.client_id}"
        if event.phase != "end":
            self._show(name, grabbed, impulse)
            return
        self._scene.remove_by_name(name)
        if hypot(*impulse.tolist()) >= LEAST:
            self._session.change(
                lambda duel: self._push(duel, number, impulse)
            )

    def _show(self, name: str, grabbed: Array, impulse: Array) -> None:
        """Draw the arrow with its impulse."""
        tip = grabbed + [*(PUSH_LENGTH * impulse), 0.0]
        self._scene.add_frame(name, show_axes=False)
        self._scene.add_arrows(
            f"{name}/arrow",
            np.array([[grabbed, tip]], dtype=np.float32),
            rgb(seen_by_all(PUSHED)),
            shaft_radius=0.012,
            head_radius=0.03,
            head_length=0.07,
        )
        self._scene.add_label(
            f"{name}/strength",
            f"{hypot(*impulse.tolist()):.1f} N s",
            position=tuple(tip.tolist()),
            anchor="bottom-center",
            depth_test=False,
        )

    def _push(self, duel: Duel, number: int, impulse: Array) -> None:
        """Push between two ticks, from the heading of that time."""
        player = duel.players[number]
        heading = player.snapshot().torso[2]
        toward = atan2(impulse[1], impulse[0]) - heading
        toward = (toward + pi) % (2.0 * pi) - pi
        strength = hypot(*impulse.tolist())
        try:
            player.push(Push(strength, duel.world.time, toward))
        except StepAsideError as error:
            self._say(str(error))
        else:
            self._say(f"pushed the {player.name} by {strength:.1f} N s")
