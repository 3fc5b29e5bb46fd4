"""Test the ranges of sensors and scenes."""

from math import degrees, inf, nan, radians
from typing import Any

import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.core.setting import ranges_of
from stepaside.games.duel_settings import DuelSettings
from stepaside.sim.camera_settings import (
    CLUTTER,
    DEPTH_CAMERAS,
    KINDS,
    CameraSettings,
    ColourSettings,
    DepthSettings,
    RearSettings,
    RoomObject,
    SceneSettings,
    SonarSettings,
    depth_camera_of,
)
from stepaside.sim.person_settings import PersonSettings

ENDS = [  # settings, name, least, greatest, step beyond them
    (ColourSettings, "rate", 1.0, 60.0, 0.1),
    (ColourSettings, "latency", 0.0, 1.0, 0.01),
    (ColourSettings, "noise", 0.0, 64.0, 0.1),
    (ColourSettings, "width", 8, 4096, 1),
    (DepthSettings, "rate", 1.0, 60.0, 0.1),
    (DepthSettings, "latency", 0.0, 1.0, 0.01),
    (DepthSettings, "far", 0.8, 20.0, 0.01),
    (DepthSettings, "missing", 0.0, 1.0, 0.01),
    (DepthSettings, "height", 8, 4096, 1),
    (SonarSettings, "rate", 1.0, 40.0, 0.1),
    (SonarSettings, "far", 0.2, 10.0, 0.01),
    (SonarSettings, "cone", 0.05, 2.5, 0.005),
    (CameraSettings, "drop_frames", 0.0, 1.0, 0.01),
    (CameraSettings, "added_latency", 0.0, 0.5, 0.01),
    (SceneSettings, "walls", 2.0, 20.0, 0.1),
    (PersonSettings, "miss", -10.0, 10.0, 0.1),
]
POSITIVE = [
    (DepthSettings, "near"),
    (DepthSettings, "step"),
    (SonarSettings, "near"),
    (SonarSettings, "step"),
    (PersonSettings, "speed"),
    (PersonSettings, "gain"),
]
NOT_NEGATIVE = [(DepthSettings, "noise"), (SonarSettings, "noise")]


def refuse(kind: Any, name: str, value: float) -> None:
    with pytest.raises(ConfigurationError, match=name):
        kind(**{name: value})


@pytest.mark.parametrize(("kind", "name", "low", "high", "step"), ENDS)
def test_ranges_include_their_bounds_only(
    kind: Any, name: str, low: float, high: float, step: float
) -> None:
    for value in (low, high):
        assert getattr(kind(**{name: value}), name) == value
    for value in (low - step, high + step, nan, inf):
        refuse(kind, name, value)


@pytest.mark.parametrize(("kind", "name"), POSITIVE)
def test_some_settings_must_be_positive(kind: Any, name: str) -> None:
    kind(**{name: ranges_of(kind)[name].low})
    for value in (0.0, -1e-6, nan, inf):
        refuse(kind, name, value)


@pytest.mark.parametrize(("kind", "name"), NOT_NEGATIVE)
def test_noise_may_be_zero(kind: Any, name: str) -> None:
    kind(**{name: 0.0})
    for value in (-1e-6, nan, inf):
        refuse(kind, name, value)


def test_walls_may_be_zero() -> None:
    assert SceneSettings(walls=0.0).walls == 0.0


def test_the_speed_of_a_person_is_limited() -> None:
    assert PersonSettings(speed=3.0).speed == 3.0
    refuse(PersonSettings, "speed", 3.01)
    with pytest.raises(ConfigurationError, match="got ''"):
        PersonSettings(path="")


def test_a_pursuer_is_a_robot_or_a_person() -> None:
    for pursuer in ("robot", "person"):
        assert DuelSettings(pursuer=pursuer).pursuer == pursuer
    with pytest.raises(ConfigurationError, match="got 'dog'"):
        DuelSettings(pursuer="dog")


@pytest.mark.parametrize("kind", KINDS)
def test_objects_lie_within_twenty_metres(kind: str) -> None:
    for place in ((20.0, -20.0), (-20.0, 20.0)):
        assert (
            RoomObject(kind, *place).x,
            RoomObject(kind, *place).y,
        ) == place
    for place in ((20.1, 0.0), (0.0, 20.1), (-20.1, 0.0), (0.0, -20.1)):
        with pytest.raises(
            ConfigurationError, match="room object [xy] must lie in"
        ):
            RoomObject(kind, *place)
    with pytest.raises(ConfigurationError, match="got 'red ball'"):
        RoomObject("red ball", 0.0, 0.0)


def field_of_view(kind: ColourSettings | DepthSettings) -> tuple[float, ...]:
    model = kind.model()
    assert (model.width, model.height) == (kind.width, kind.height)
    return (
        degrees(2.0 * np.arctan(0.5 * model.width / model.focal_x)),
        degrees(2.0 * np.arctan(0.5 * model.height / model.focal_y)),
    )


def test_optics_are_those_of_the_vendors() -> None:
    """SoftBank's for NAO V5 and V6, ASUS's for the Xtion."""
    assert field_of_view(ColourSettings()) == pytest.approx((60.9, 47.6))
    six = ColourSettings(optics="v6")
    assert field_of_view(six) == pytest.approx((54.7, 42.5))
    assert field_of_view(DepthSettings()) == pytest.approx((58.0, 45.0))
    with pytest.raises(ConfigurationError, match="got 'v7'"):
        ColourSettings(optics="v7")


def test_default_sensors_are_those_of_the_documents() -> None:
    """Values in `docs/sensing.md`."""
    assert ColourSettings() == ColourSettings(
        "v5", 320, 240, 15.0, 0.05, 4.0, "auto"
    )
    errors = 0.0019, 0.00285, 0.02
    assert DepthSettings() == DepthSettings(
        *(80, 60, radians(58.0), radians(45.0)),
        *(15.0, 0.05, 0.8, 3.5, *errors),
    )
    assert RearSettings() == RearSettings(
        *(106, 60, radians(87.0), radians(58.0)),
        *(15.0, 0.05, 0.6, 6.0, *errors),
    )
    sonar = SonarSettings()
    assert (sonar.rate, sonar.near, sonar.far) == (10.0, 0.2, 0.8)
    assert (sonar.noise, sonar.step) == (0.01, 0.01)
    assert degrees(sonar.cone) == pytest.approx(60.0)
    whole = CameraSettings()
    assert (whole.drop_frames, whole.added_latency) == (0.0, 0.0)
    assert SceneSettings() == SceneSettings(5.0, [])
    assert PersonSettings() == PersonSettings("steer", 0.15, 0.2, 0.0)


def test_clutter_has_its_documented_positions() -> None:
    """Out of the way: duels stay within a metre or so of the middle."""
    places = {thing.kind: (thing.x, thing.y) for thing in CLUTTER}
    assert set(places) == set(KINDS)
    assert places["red box"] == (3.4, 1.6)
    assert places["blue box"] == (-1.6, -2.0)
    assert places["white figure"] == (3.2, -1.8)
    assert min(np.hypot(x, y) for x, y in places.values()) > 2.5


def test_depth_cameras_of_a_head_have_names() -> None:
    d455 = DEPTH_CAMERAS["d455"]
    assert (d455.near, d455.far) == (0.6, 6.0)
    assert type(d455) is DepthSettings  # as a configuration file makes it
    assert depth_camera_of(CameraSettings()) == ""
    assert depth_camera_of(CameraSettings(depth=d455)) == "d455"
    own = CameraSettings(depth=DepthSettings(far=3.0))
    assert depth_camera_of(own) == ""


def test_a_rear_camera_is_checked_like_the_one_on_the_head() -> None:
    with pytest.raises(ConfigurationError, match=r"far must lie in \[3"):
        RearSettings(near=3.0, far=2.0)
    with pytest.raises(ConfigurationError, match="across must lie"):
        RearSettings(across=3.0)
