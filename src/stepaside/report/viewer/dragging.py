"""Pushes by dragging a robot with the pointer."""

from collections.abc import Callable, Iterable
from math import atan2, hypot, pi
from typing import Any

import numpy as np
import viser

from ...core.errors import StepAsideError
from ...core.poses import Array
from ...games.match import Match
from ...sim.push import Push
from ..figure_style import PUSHED
from ..palette import on_both_floors
from .live_session import LiveSession
from .scene_layers import PUSH_LENGTH, rgb

MIN_IMPULSE, MAX_IMPULSE = 0.05, 4.0  # of a push, in [N s]
MIN_SLOPE = 0.1  # of a line of sight that is intersected with a plane


def impulse_of_drag(eye: Array, grabbed: Array, pointed: Array) -> Array:
    """Return the horizontal impulse of a drag, in [N s]. Shape (2,).

    The pointer's line of sight is intersected with the horizontal plane
    through the grabbed point. If it is nearly horizontal, the pointed
    position itself is used.

    Args:
        eye: Position of the camera, in the world, in [m]. Shape (3,).
        grabbed: Position that was grabbed, in the world, in [m]. Shape (3,).
        pointed: Any position on the pointer's line of sight, in the world,
            in [m]. Shape (3,).
    """
    sight = pointed - eye
    slope = sight[2] / max(float(np.linalg.norm(sight)), 1e-9)
    offset = (pointed - grabbed)[:2]
    if abs(slope) > MIN_SLOPE and (grabbed[2] - eye[2]) * slope > 0.0:
        intersection = eye + (grabbed[2] - eye[2]) / sight[2] * sight
        offset = (intersection - grabbed)[:2]
    impulse: Array = offset / PUSH_LENGTH
    strength = hypot(*impulse.tolist())
    return impulse * min(1.0, MAX_IMPULSE / max(strength, 1e-9))


class PushDragging:
    """Lets all viewers of a page push robots by dragging them."""

    def __init__(
        self,
        scene: viser.SceneApi,
        session: LiveSession,
        notify: Callable[[str], None],
    ) -> None:
        """Start without robots.

        Args:
            scene: Scene of the page, for the arrows.
            session: Session whose robots are pushed.
            notify: Function that shows a message.
        """
        self._scene = scene
        self._session = session
        self._notify = notify

    def add(self, player: str, meshes: Iterable[Any]) -> None:
        """Let a robot be dragged.

        Args:
            player: Name of the player.
            meshes: Meshes of the robot.
        """

        # viser keeps the order only of callbacks that are coroutines.
        async def drag(event: Any) -> None:
            self._drag(player, event)

        for mesh in meshes:
            mesh.on_drag(drag)

    def _drag(self, name: str, event: Any) -> None:
        """Draw an arrow during a drag, and push at its end."""
        grabbed = np.array(event.start_position)
        impulse = impulse_of_drag(
            np.array(event.client.camera.position),
            grabbed,
            np.array(event.end_position),
        )
        arrow = f"/hand/{event.client_id}"
        if event.phase != "end":
            self._show(arrow, grabbed, impulse)
            return
        self._scene.remove_by_name(arrow)
        if hypot(*impulse.tolist()) >= MIN_IMPULSE:
            self._session.change(
                lambda match: self._push(match, name, impulse)
            )

    def _show(self, name: str, grabbed: Array, impulse: Array) -> None:
        """Draw the arrow of a drag, labelled with its impulse."""
        tip = grabbed + [*(PUSH_LENGTH * impulse), 0.0]
        self._scene.add_frame(name, show_axes=False)
        self._scene.add_arrows(
            f"{name}/arrow",
            np.array([[grabbed, tip]], dtype=np.float32),
            rgb(on_both_floors(PUSHED)),
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

    def _push(self, match: Match, name: str, impulse: Array) -> None:
        """Push a player between two ticks, relative to its heading then."""
        player = match.player(name)
        heading = player.snapshot().torso[2]
        direction = atan2(impulse[1], impulse[0]) - heading
        direction = (direction + pi) % (2.0 * pi) - pi
        strength = hypot(*impulse.tolist())
        try:
            player.push(Push(strength, match.world.time, direction))
        except StepAsideError as error:
            self._notify(str(error))
        else:
            self._notify(f"pushed the {player.name} by {strength:.1f} N s")
