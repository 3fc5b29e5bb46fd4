"""What each viewer of a page has alone: its light, and its camera."""

from collections.abc import Sequence
from math import hypot
from typing import Any

import numpy as np
import viser

from ...poses import Array
from ..palette import FLOORS
from .layers import rgb
from .layout import dress

CAMERAS = ("free", "follow", "top", "evader's eyes")
ASIDE = np.array([-0.55, -0.85, 0.62])  # of a camera that follows, per [m]
UPRIGHT = 0.8  # width over height of a page that is held upright
NARROW, LOWER = 1.5, 0.15  # there: how much farther away, how much lower
SMALL = 3e-3  # moves of a camera that are not worth a message, in [m]


class Viewers:
    """Lights and cameras of all who look, by the number of each.

    Attributes:
        cameras: Which camera each has; "free" if it is not here.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        """Give everybody who comes a floor in its own light."""
        self._server = server
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
            eye, target = _view(camera, places, heights)
            if now.aspect < UPRIGHT and camera != CAMERAS[3]:
                # A phone: sheets cover its lower half, and it is narrow.
                eye = target + NARROW * (eye - target)
                # Whoever looks lower sees the robots higher up.
                down = LOWER * float(np.linalg.norm(eye - target))
                aside = (0.0, -down, 0.0) if camera == "top" else (0, 0, -down)
                target = target + np.array(aside)
            if np.abs(np.array(now.position) - eye).max() > SMALL:
                with client.atomic():
                    now.position, now.look_at = eye, target


def _view(
    camera: str, places: Sequence[Array], heights: Sequence[float]
) -> tuple[Array, Array]:
    """Where a camera is and what it looks at. Shape (3,) each."""
    first, second = places[0], places[min(1, len(places) - 1)]
    middle = 0.5 * (np.min(places, axis=0) + np.max(places, axis=0))
    target = np.array([*middle, 0.2])
    wide = 1.3 + float(hypot(*(first - second)))
    if camera == "top":
        return target + [0.0, -1e-3, 1.5 * wide], target
    if camera == "follow":
        return target + wide * ASIDE, target
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
