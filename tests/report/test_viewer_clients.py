"""Test what each client of a page has for itself."""

from typing import Any

import numpy as np
import pytest

from fake_page import Client, Gui, Server
from stepaside.arena import Room
from stepaside.core.poses import Array
from stepaside.report.palette import FLOORS, ON_BOTH_FLOORS, contrast
from stepaside.report.viewer.page_layout import arrange_panels
from stepaside.report.viewer.scene_layers import rgb
from stepaside.report.viewer.viewer_clients import CAMERAS, ViewerClients

PLACES = [np.array([0.0, 0.0]), np.array([1.0, 2.0])]
HEIGHTS = [0.27, 0.28]


@pytest.fixture
def looked() -> tuple[ViewerClients, Any]:
    server: Any = Server()
    viewers = ViewerClients(server)
    for number in (1, 2):
        server.welcome(Client(number))
    return viewers, server


def test_a_light_is_of_one_viewer_alone(
    looked: tuple[ViewerClients, Any],
) -> None:
    viewers, server = looked
    one, other = server.clients[1], server.clients[2]
    viewers.toggle_theme(one)
    assert one.gui.themes == [True] and other.gui.themes == []
    ground = one.scene.items["/floor"].plane_color
    assert ground == rgb(FLOORS["dark"].ground)
    assert other.scene.items["/floor"].plane_color == rgb(
        FLOORS["light"].ground
    )
    viewers.toggle_theme(one)
    assert one.gui.themes == [True, False]
    viewers.set_theme(other, "dark")
    assert other.gui.themes == [True]
    viewers.toggle_theme(None)  # who has gone meanwhile


def test_cameras_follow_until_a_client_moves_them(
    looked: tuple[ViewerClients, Any],
) -> None:
    viewers, server = looked
    one, other = server.clients[1], server.clients[2]
    viewers.choose(other, "free")
    viewers.aim(PLACES, HEIGHTS)
    np.testing.assert_allclose(one.camera.look_at, [0.5, 1.0, 0.2])
    np.testing.assert_array_equal(other.camera.position, 0.0)
    viewers.choose(one, "player's view")
    viewers.aim(PLACES, HEIGHTS)
    np.testing.assert_allclose(one.camera.look_at, [0.0, 0.0, 0.27])
    eye = np.array(one.camera.position)
    assert np.hypot(*(eye[:2] - PLACES[1])) < 0.1 and eye[2] > 0.4
    viewers.choose(one, "top")
    viewers.aim(PLACES, HEIGHTS)
    eye = np.array(one.camera.position)
    np.testing.assert_allclose(eye[:2], [0.5, 1.0], atol=2e-3)
    for place in PLACES:  # with what is 0.8 m around each
        for x, y in ((0.8, 0.0), (-0.8, 0.0), (0.0, 0.8), (0.0, -0.8)):
            spot = seen(one.camera, np.array([*(place + [x, y]), 0.0]))
            assert max(map(abs, spot)) < 1.0


def seen(camera: Any, point: Array) -> tuple[float, float]:
    """Place of a point in a picture, from -1 to 1, rightward and upward."""
    eye, target = np.array(camera.position), np.array(camera.look_at)
    ahead = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(ahead, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    up = np.cross(right, ahead)
    off = point - eye
    scale = float(off @ ahead) * np.tan(0.5 * camera.fov)
    return float(off @ right) / scale / camera.aspect, float(off @ up) / scale


@pytest.mark.parametrize("apart", [0.3, 1.0, 3.0, 12.0])
@pytest.mark.parametrize("bearing", [0.0, 1.0, 2.5, -1.2])
@pytest.mark.parametrize("aspect", [0.46, 0.6, 1.3, 1.8])
def test_both_robots_are_in_the_picture_over_the_sheet_of_a_phone(
    apart: float, bearing: float, aspect: float
) -> None:
    """A sheet covers the lower 45 % where the page is held upright."""
    server: Any = Server()
    viewers = ViewerClients(server)
    server.welcome(Client(1, aspect=aspect))
    way = apart * np.array([np.cos(bearing), np.sin(bearing)])
    places = [np.array([1.0, 2.0]), np.array([1.0, 2.0]) + way]
    for camera in ("follow", "top"):
        viewers.choose(server.clients[1], camera)
        viewers.aim(places, HEIGHTS)
        for place in places:
            for height in (0.0, 0.6):
                point = np.array([*place, height])
                x, y = seen(server.clients[1].camera, point)
                assert abs(x) < 1.0
                assert (-0.1 if aspect < 0.8 else -1.0) < y < 1.0


@pytest.mark.parametrize("shape", [(3.0, 3.0), (2.0, 9.0), (9.0, 2.0)])
@pytest.mark.parametrize("aspect", [0.46, 0.9, 1.8])
def test_all_of_a_room_is_seen_from_above(
    shape: tuple[float, float], aspect: float
) -> None:
    server: Any = Server()
    room = Room(width=shape[0], depth=shape[1])
    viewers = ViewerClients(server, room)
    server.welcome(Client(1, aspect=aspect))
    viewers.choose(server.clients[1], "top")
    viewers.aim([np.array([0.4, 0.3]), np.array([-0.2, 0.1])], HEIGHTS)
    for wall in room.walls:
        for corner in wall.points:
            for height in (0.0, 0.6):
                point = np.array([*corner, height])
                x, y = seen(server.clients[1].camera, point)
                assert abs(x) < 1.0
                assert (-0.1 if aspect < 0.8 else -1.0) < y < 1.0


def test_who_goes_is_forgotten(looked: tuple[ViewerClients, Any]) -> None:
    viewers, server = looked
    for call in server.going:
        call(server.clients[1])
    assert set(viewers.cameras) == {2}


def test_what_all_see_is_seen_on_both_floors() -> None:
    for colour in ON_BOTH_FLOORS.values():
        for floor in FLOORS.values():
            assert contrast(colour, floor.ground) > 2.9, colour


def test_panels_lie_on_both_sides_of_the_scene() -> None:
    gui: Any = Gui()
    layout = arrange_panels(gui)
    assert gui.main_panel.place == "right"
    (acting,) = gui.panels
    tabs = [layout.play, layout.settings, layout.layers]
    assert acting.place == "left" and acting.tabs == tabs
    assert layout.controls is acting
    assert [tab.label for tab in tabs] == ["Play", "Settings", "Layers"]
    assert CAMERAS[0] == "free"
