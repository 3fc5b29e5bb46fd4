"""Theme and camera of each viewer of a page."""

from collections.abc import Mapping, Sequence
from math import hypot, tan
from typing import Any

import numpy as np
import viser

from ...arena import Room
from ...core.poses import Array
from ..palette import FLOORS, rgb
from ..scene import wall_corners
from .page_server import set_theme

CAMERAS = ("free", "follow", "top", "player's view")
EVERYBODY = "All players"  # choice of the cameras' target
FOLLOW_DIRECTION = np.array([-0.55, -0.85, 0.62])  # of the following camera
MAX_PHONE_ASPECT = 0.8  # width over height of a phone held upright
PHONE_DISTANCE = 1.5  # factor of the following camera's distance on a phone
PHONE_IMAGE = 0.52  # fraction of the image above the panel of a phone
ROOM_MARGIN = 0.15  # around a room in the top view, in [m]
PLAYER_MARGIN = 1.0  # around players on an open floor, in [m]
TARGET_HEIGHT = 0.2  # in [m]
PLAYER_HEIGHT = 0.7  # that the top view shows, in [m]
MIN_MOVE = 3e-3  # of a camera that is sent to the viewer, in [m]


class ViewerClients:
    """Themes and cameras of all connected viewers.

    Attributes:
        cameras: Camera of each viewer, by client number; "free" if missing.
    """

    def __init__(self, server: viser.ViserServer, room: Room | None) -> None:
        """Serve viewers that connect from now on.

        Args:
            server: Server of the page.
            room: Room that the top view shows; None for an open floor.
        """
        self._server = server
        self.show_room(room)
        self._themes: dict[int, str] = {}
        self.cameras: dict[int, str] = {}
        server.on_client_connect(self._connect)
        server.on_client_disconnect(self._disconnect)

    def _connect(self, client: Any) -> None:
        self._themes[client.client_id] = "light"
        self.cameras.setdefault(client.client_id, "follow")
        _add_floor(client, "light")

    def _disconnect(self, client: Any) -> None:
        self._themes.pop(client.client_id, None)
        self.cameras.pop(client.client_id, None)

    def show_room(self, room: Room | None) -> None:
        """Show a room in the top view; None for an open floor."""
        self._walls = wall_corners(room)

    def toggle_theme(self, client: Any) -> None:
        """Switch the theme of one viewer.

        Args:
            client: The viewer; None if it has disconnected.
        """
        if client is not None:
            theme = self._themes.get(client.client_id, "light")
            self.set_theme(client, "light" if theme == "dark" else "dark")

    def set_theme(self, client: Any, theme: str) -> None:
        """Set the theme of one viewer.

        Args:
            client: The viewer; None if it has disconnected.
            theme: One of :data:`~stepaside.report.palette.THEMES`.
        """
        if client is None:
            return
        self._themes[client.client_id] = theme
        set_theme(client.gui, theme)
        _add_floor(client, theme)

    def choose(self, client: Any, camera: str) -> None:
        """Set the camera of one viewer.

        Args:
            client: The viewer; None if it has disconnected.
            camera: One of ``CAMERAS``.
        """
        if client is not None:
            self.cameras[client.client_id] = camera

    def aim(
        self, positions: Sequence[Array], heights: Sequence[float]
    ) -> None:
        """Move the cameras that are not free.

        Args:
            positions: Of the players in the world, in [m]. Shape (2,) each;
                a player's view is from the second one to the first.
            heights: Of their centers of mass, in [m].
        """
        for number, client in self._server.get_clients().items():
            name = self.cameras.get(number, "free")
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
                    self._walls,
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


def order_in_view(
    positions: Mapping[str, Array],
    opponents: Sequence[tuple[str, str]],
    followed: str,
) -> list[str]:
    """Return the players that cameras show, in the order for them.

    The first pair of opponents comes first. If one player is followed, it is
    the second, after the nearest other one, as the evader of a duel is.

    Args:
        positions: Of all players in the world, in [m], by name.
        opponents: Pairs of opponents.
        followed: Player that is followed; another text for all.
    """
    others = [name for name in positions if name != followed]
    if followed not in positions or not others:
        first = [*opponents[0]] if opponents else []
        return first + [n for n in positions if n not in first]
    here = positions[followed]
    nearest = min(others, key=lambda n: hypot(*(positions[n] - here)))
    return [nearest, followed]


def _player_view(
    positions: Sequence[Array], heights: Sequence[float]
) -> tuple[Array, Array]:
    """Return a player's head and its opponent, in [m]. Shape (3,) each."""
    opponent, own = positions[0], positions[min(1, len(positions) - 1)]
    sight = opponent - own
    ahead = sight / max(float(hypot(*sight)), 1e-6)
    height = heights[min(1, len(heights) - 1)]
    eye = np.array([*(own + 0.09 * ahead), height + 0.2])
    return eye, np.array([*opponent, heights[0]])


def _add_floor(client: Any, theme: str) -> None:
    """Add the floor of one viewer, which receives shadows."""
    floor = FLOORS[theme]
    client.scene.add_grid(
        "/floor",
        width=40.0,
        height=40.0,
        plane="xy",
        cell_size=0.5,
        section_size=1.0,
        cell_color=rgb(floor.line),
        section_color=rgb(floor.line),
        plane_color=rgb(floor.ground),
        plane_opacity=1.0,
        shadow_opacity=floor.shadow,
        fade_distance=25.0,
        position=(0.0, 0.0, -0.002),
    )
