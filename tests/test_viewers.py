"""What each viewer of a page has alone."""

from typing import Any

import numpy as np
import pytest

from fake_page import Client, Gui, Server
from stepaside.report.palette import FLOORS, FOR_BOTH, contrast
from stepaside.report.viewer.layers import rgb
from stepaside.report.viewer.layout import arrange
from stepaside.report.viewer.viewers import CAMERAS, Viewers

PLACES = [np.array([0.0, 0.0]), np.array([1.0, 2.0])]
HEIGHTS = [0.27, 0.28]


@pytest.fixture
def looked() -> tuple[Viewers, Any]:
    server: Any = Server()
    viewers = Viewers(server)
    for number in (1, 2):
        server.welcome(Client(number))
    return viewers, server


def test_a_light_is_of_one_viewer_alone(looked: tuple[Viewers, Any]) -> None:
    viewers, server = looked
    one, other = server.clients[1], server.clients[2]
    viewers.turn_light(one)
    assert one.gui.themes == [True] and other.gui.themes == []
    ground = one.scene.items["/floor"].plane_color
    assert ground == rgb(FLOORS["dark"].ground)
    assert other.scene.items["/floor"].plane_color == rgb(
        FLOORS["light"].ground
    )
    viewers.turn_light(one)
    assert one.gui.themes == [True, False]
    viewers.light_up(other, "dark")
    assert other.gui.themes == [True]
    viewers.turn_light(None)  # who has gone meanwhile


def test_cameras_go_along_until_somebody_takes_them(
    looked: tuple[Viewers, Any],
) -> None:
    viewers, server = looked
    one, other = server.clients[1], server.clients[2]
    viewers.choose(other, "free")
    viewers.aim(PLACES, HEIGHTS)
    np.testing.assert_allclose(one.camera.look_at, [0.5, 1.0, 0.2])
    np.testing.assert_array_equal(other.camera.position, 0.0)
    viewers.choose(one, "evader's eyes")
    viewers.aim(PLACES, HEIGHTS)
    np.testing.assert_allclose(one.camera.look_at, [0.0, 0.0, 0.27])
    eye = np.array(one.camera.position)
    assert np.hypot(*(eye[:2] - PLACES[1])) < 0.1 and eye[2] > 0.4
    viewers.choose(one, "top")
    viewers.aim(PLACES, HEIGHTS)
    eye = np.array(one.camera.position)
    np.testing.assert_allclose(eye[:2], [0.5, 1.0], atol=2e-3)
    assert eye[2] > 4.0


def test_on_a_phone_the_robots_are_in_the_upper_half() -> None:
    server: Any = Server()
    viewers = Viewers(server)
    desk, phone = Client(1), Client(2, aspect=0.46)
    server.welcome(desk)
    server.welcome(phone)
    for camera in ("follow", "top"):
        viewers.choose(desk, camera)
        viewers.choose(phone, camera)
        viewers.aim(PLACES, HEIGHTS)
        away = [
            np.linalg.norm(np.array(c.camera.position) - [0.5, 1.0, 0.2])
            for c in (desk, phone)
        ]
        assert away[1] > 1.3 * away[0]
        lower = np.array(phone.camera.look_at) - desk.camera.look_at
        assert lower.min() < -0.3


def test_who_goes_is_forgotten(looked: tuple[Viewers, Any]) -> None:
    viewers, server = looked
    for call in server.going:
        call(server.clients[1])
    assert set(viewers.cameras) == {2}


def test_what_all_see_is_seen_on_both_floors() -> None:
    for colour in {*FOR_BOTH.values(), "#c8321f"}:
        for floor in FLOORS.values():
            assert contrast(colour, floor.ground) > 2.9, colour


def test_panels_lie_on_both_sides_of_the_scene() -> None:
    gui: Any = Gui()
    layout = arrange(gui)
    assert gui.main_panel.place == "right"
    (acting,) = gui.panels
    assert acting.place == "left" and acting.tabs == list(layout)
    assert [tab.label for tab in layout] == ["Play", "Settings", "Shown"]
    assert CAMERAS[0] == "free"
