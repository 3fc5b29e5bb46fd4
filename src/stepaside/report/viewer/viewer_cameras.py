"""Camera of each viewer of a page."""

from collections.abc import Sequence
from math import hypot, tan
from typing import Any

import numpy as np
import viser

from ...core.poses import Array

CAMERAS = ("free", "follow", "top", "player's view")
FOLLOW_DIRECTION = np.array([-0.55, -0.85, 0.62])  # of the following camera
MAX_PHONE_ASPECT = 0.8  # width over height of a phone held upright
PHONE_DISTANCE = 1.5  # factor of the following camera's distance on a phone
PHONE_IMAGE = 0.52  # fraction of the image above the panel of a phone
ROOM_MARGIN = 0.15  # around a room in the top view, in [m]
PLAYER_MARGIN = 1.0  # around players on an open floor, in [m]
TARGET_HEIGHT = 0.2  # in [m]
PLAYER_HEIGHT = 0.7  # that the top view shows, in [m]
MIN_MOVE = 3e-3  # of a camera that is sent to the viewer, in [m]


class ViewerCameras:
    """Cameras of all viewers; each follows the players at first."""

    def __init__(self, server: viser.ViserServer) -> None:
        """Serve the viewers of a page."""
        self._server = server
        self._chosen: dict[int, str] = {}

    def choose(self, client: Any, camera: str) -> None:
        """Set the camera of a viewer, one of ``CAMERAS``.

        The viewer is None if it has disconnected.
        """
        if client is not None:
            self._chosen[client.client_id] = camera

    def aim(
        self,
        positions: Sequence[Array],
        heights: Sequence[float],
        walls: Array,
    ) -> None:
        """Move the cameras that are not free.

        Args:
            positions: Of the players in the world, in [m]. Shape (2,) each;
                a player's view is from the second one to the first.
            heights: Of their centers of mass, in [m].
            walls: Corners of the walls, in [m]. Shape (n, 2).
        """
        for number, client in self._server.get_clients().items():
            name = self._chosen.get(number, "follow")
            if name == "free":
                continue
            camera = client.camera
            if name == CAMERAS[3]:
                eye, target = _player_view(positions, heights)
            else:
                eye, target = overview(
                    camera.aspect,
                    camera.fov,
                    positions,
                    walls,
                    top=name == "top",
                )
            if np.abs(np.array(camera.position) - eye).max() > MIN_MOVE:
                with client.atomic():
                    camera.position, camera.look_at = eye, target


def overview(
    aspect: float,
    fov: float,
    positions: Sequence[Array],
    walls: Array,
    *,
    top: bool,
) -> tuple[Array, Array]:
    """Return eye and target of a camera that shows all players, in [m].

    On a phone the panel covers the lower part of the image, so that the
    players, or the room in the top view, are shown above it.

    Args:
        aspect: Width over height of the image.
        fov: Vertical field of view, in [rad].
        positions: Of the players in the world, in [m]. Shape (2,) each.
        walls: Corners of the walls, in [m]. Shape (n, 2).
        top: Whether the view is from above.
    """
    points = np.array(positions)
    low, high = points.min(axis=0), points.max(axis=0)
    if top and len(walls):
        low = np.minimum(low, walls.min(axis=0)) - ROOM_MARGIN
        high = np.maximum(high, walls.max(axis=0)) + ROOM_MARGIN
    elif top:
        low, high = low - PLAYER_MARGIN, high + PLAYER_MARGIN
    target = np.array([*(0.5 * (low + high)), TARGET_HEIGHT])
    fraction = PHONE_IMAGE if aspect < MAX_PHONE_ASPECT else 1.0
    slope = tan(0.5 * fov)
    half = 0.5 * (high - low)
    if top:
        direction = np.array([0.0, -5e-4, 1.0])
        distance = max(half[1] / fraction, half[0] / aspect) / slope
        distance += PLAYER_HEIGHT - TARGET_HEIGHT
    else:
        norm = float(np.linalg.norm(FOLLOW_DIRECTION))
        direction = FOLLOW_DIRECTION / norm
        distance = (1.3 + float(hypot(*(high - low)))) * norm
        distance *= PHONE_DISTANCE if fraction < 1.0 else 1.0
    # The image's upward direction in the world.
    ahead = -direction / np.linalg.norm(direction)
    right = np.cross(ahead, [0.0, 1.0, 0.0] if top else [0.0, 0.0, 1.0])
    up = np.cross(right / np.linalg.norm(right), ahead)
    target = target - (1.0 - fraction) * slope * distance * up
    return target - distance * ahead, target


def _player_view(
    positions: Sequence[Array], heights: Sequence[float]
) -> tuple[Array, Array]:
    """Return a player's head and its opponent, in [m]. Shape (3,) each."""
    second = min(1, len(positions) - 1)
    opponent, own = positions[0], positions[second]
    sight = opponent - own
    ahead = sight / max(float(hypot(*sight)), 1e-6)
    eye = np.array([*(own + 0.09 * ahead), heights[second] + 0.2])
    return eye, np.array([*opponent, heights[0]])
