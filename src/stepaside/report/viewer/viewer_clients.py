"""What each viewer of a page has alone: its light, and its camera."""

from collections.abc import Sequence
from math import hypot, tan
from typing import Any

import numpy as np
import viser

from ...arena import Room
from ...core.poses import Array
from ..palette import FLOORS
from ..room_extent import wall_corners
from .page_layout import dress
from .scene_layers import rgb

CAMERAS = ("free", "follow", "top", "evader's eyes")
ASIDE = np.array([-0.55, -0.85, 0.62])  # of a camera that follows, per [m]
UPRIGHT = 0.8  # width over height of a page that is held upright
NARROW = 1.5  # there: how much farther away a camera that follows is
FREE = 0.52  # there: share of the picture over the sheet, with a margin
BESIDE = 0.15  # margin around a room that is seen from above, in [m]
AROUND = 1.0  # margin around players on an open floor: a safety area, in [m]
LOOKED_AT = 0.2  # height of what is looked at, in [m]
TALL = 0.7  # height of what is to be seen from above, in [m]
SMALL = 3e-3  # moves of a camera that are not worth a message, in [m]


class ViewerClients:
    """Lights and cameras of all who look, by the number of each.

    Attributes:
        cameras: Which camera each has; "free" if it is not here.
    """

    def __init__(
        self, server: viser.ViserServer, plan: Room | None = None
    ) -> None:
        """Give everybody who comes a floor in its own light.

        Args:
            server: Of the page.
            plan: Room that is seen from above; None for an open floor.
        """
        self._server = server
        self._walls = wall_corners(plan)
        self._lights: dict[int, str] = {}
        self.cameras: dict[int, str] = {}
        server.on_client_connect(self._welcome)
        server.on_client_disconnect(self._forget)

    def _welcome(self, client: Any) -> None:
        self._lights[client.client_id] = "light"
        self.cameras.setdefault(client.client_id, "follow")
        _lay_floor(client, "light")

    def _forget(self, client: Any) -> None:
        self._lights.pop(client.client_id, None)
        self.cameras.pop(client.client_id, None)

    def turn_light(self, client: Any) -> None:
        """Let the page of one viewer be dark if it is light, or light."""
        if client is not None:
            was = self._lights.get(client.client_id, "light")
            self.light_up(client, "light" if was == "dark" else "dark")

    def light_up(self, client: Any, light: str) -> None:
        """Let the page of one viewer be light or dark.

        Args:
            client: Who asks for it.
            light: One of :data:`~stepaside.report.palette.LIGHTS`.
        """
        if client is None:
            return
        self._lights[client.client_id] = light
        dress(client.gui, light)
        _lay_floor(client, light)

    def choose(self, client: Any, camera: str) -> None:
        """Give one viewer another camera.

        Args:
            client: Who asks for it.
            camera: One of ``CAMERAS``.
        """
        if client is not None:
            self.cameras[client.client_id] = camera

    def aim(self, places: Sequence[Array], heights: Sequence[float]) -> None:
        """Move the cameras that go along.

        Args:
            places: Of the players, on the floor, in [m]. Shape (2,) each.
            heights: Of their centers of mass, in [m].
        """
        for number, client in self._server.get_clients().items():
            camera = self.cameras.get(number, "free")
            if camera == "free":
                continue
            now = client.camera
            if camera == CAMERAS[3]:
                eye, target = _eyes(places, heights)
            else:
                eye, target = self._over(now, camera == "top", places)
            if np.abs(np.array(now.position) - eye).max() > SMALL:
                with client.atomic():
                    now.position, now.look_at = eye, target

    def _over(
        self, camera: Any, top: bool, places: Sequence[Array]
    ) -> tuple[Array, Array]:
        """Where a camera is that sees all players, and what it looks at.

        On a phone a sheet covers the lower part of the picture: there all of
        them, and from above all of the room, lie in the part over it.
        """
        every = np.array(places)
        low, high = every.min(axis=0), every.max(axis=0)
        if top and len(self._walls):
            low = np.minimum(low, self._walls.min(axis=0)) - BESIDE
            high = np.maximum(high, self._walls.max(axis=0)) + BESIDE
        elif top:
            low, high = low - AROUND, high + AROUND
        target = np.array([*(0.5 * (low + high)), LOOKED_AT])
        share = FREE if camera.aspect < UPRIGHT else 1.0
        steep = tan(0.5 * camera.fov)
        half = 0.5 * (high - low)
        if top:
            way = np.array([0.0, -5e-4, 1.0])
            away = max(half[1] / share, half[0] / camera.aspect) / steep
            away += TALL - LOOKED_AT
        else:
            way = ASIDE / np.linalg.norm(ASIDE)
            wide = 1.3 + float(hypot(*(high - low)))
            away = wide * float(np.linalg.norm(ASIDE))
            away *= NARROW if share < 1.0 else 1.0
        # The picture's own upward direction in the world.
        ahead = -way / np.linalg.norm(way)
        right = np.cross(ahead, [0.0, 1.0, 0.0] if top else [0.0, 0.0, 1.0])
        up = np.cross(right / np.linalg.norm(right), ahead)
        target = target - (1.0 - share) * steep * away * up
        return target - away * ahead, target


def _eyes(
    places: Sequence[Array], heights: Sequence[float]
) -> tuple[Array, Array]:
    """From the evader's head to the pursuer. Shape (3,) each."""
    first, second = places[0], places[min(1, len(places) - 1)]
    toward = (first - second) / max(float(hypot(*(first - second))), 1e-6)
    eye = np.array([*(second + 0.09 * toward), heights[-1] + 0.2])
    return eye, np.array([*first, heights[0]])


def _lay_floor(client: Any, light: str) -> None:
    """Lay the floor of one viewer, on which shadows fall."""
    floor = FLOORS[light]
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
