"""Test rates, latencies and losses of cameras."""

from collections import deque
from dataclasses import replace
from math import degrees
from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest

from stepaside.perception.camera_model import CameraModel
from stepaside.perception.images import ColourImage, DepthImage, Percept
from stepaside.robots.description import load_robot
from stepaside.sim.camera_settings import (
    CameraSettings,
    ColourSettings,
    DepthSettings,
)
from stepaside.sim.ranging import SensorStream
from stepaside.sim.sensor_suite import SensorSuite

TICK = 0.004
NAO = load_robot("nao")
PLAIN = CameraSettings(
    colour=ColourSettings(width=80, height=60, noise=0.0),
    depth=DepthSettings(noise=0.0, missing=0.0),
)
CAMERA = CameraModel.of_field_of_view(8, 8, 1.0, 1.0)


def stream(
    period: float = 0.1, latency: float = 0.0, drop: float = 0.0
) -> SensorStream[Percept]:
    def take(now: float) -> Percept:
        return ColourImage(now, CAMERA, np.zeros((8, 8, 3), np.uint8))

    generator = np.random.default_rng(1)
    return SensorStream(take, period, latency, drop, generator, 0, deque())


def watch(
    sensor: SensorStream[Percept], ticks: int
) -> tuple[list[float], list[float]]:
    """Return times of exposure, and ages at arrival."""
    noted: list[Percept] = []
    ages, taken = [], []
    for tick in range(ticks):
        now = tick * TICK
        for percept in sensor.read(now, noted):
            taken.append(percept.time)
            ages.append(now - percept.time)
    assert [p.time for p in noted][: len(taken)] == taken
    return taken, ages


def test_latency_delays_what_arrives_but_not_when_it_is_taken() -> None:
    taken, ages = watch(stream(latency=0.052), 101)
    np.testing.assert_allclose(taken, [0.0, 0.1, 0.2, 0.3])
    np.testing.assert_allclose(ages, 0.052)
    taken, ages = watch(stream(latency=0.25), 101)
    np.testing.assert_allclose(taken, [0.0, 0.1])
    np.testing.assert_allclose(ages, 0.252)


def eyes_of(
    settings: CameraSettings = PLAIN,
    *,
    depth: bool = True,
    seed: int = 3,
    renderer: Any = None,
) -> SensorSuite:
    """Return sensors of a head 0.5 m above a floor, between two boxes.

    One is 1.6 m ahead, one 1 m behind; the torso is 1 m ahead of the head.
    """
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><geom name="floor" type="plane" size="9 9 1"/>'
        '<geom type="box" pos="2.1 0 0.4" size="0.5 0.4 0.4" rgba="1 0 0 1"/>'
        '<geom type="box" pos="-1.5 0 0.4" size="0.5 0.4 0.4"/>'
        '<body name="me/torso" pos="1.0 0 0.3"/>'
        '<camera name="other"/><body name="me/head" pos="0 0 0.5">'
        '<camera name="me/head_camera"/></body></worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    physics = SimpleNamespace(tick=TICK)
    world: Any = SimpleNamespace(model=model, data=data, physics=physics)
    return SensorSuite(
        world, "me", NAO, settings, renderer, seed, with_depth=depth
    )


def arrivals(
    eyes: SensorSuite, ticks: int
) -> dict[str, list[tuple[float, float]]]:
    """Time of each percept and of its arrival, by kind."""
    found: dict[str, list[tuple[float, float]]] = {}
    for tick in range(ticks):
        for percept in eyes.read(tick * TICK):
            kind = type(percept).__name__
            found.setdefault(kind, []).append((percept.time, tick * TICK))
    return found


def test_each_sensor_has_its_own_rate() -> None:
    """Rates become whole ticks: 15 images a second are one in 17 ticks."""
    settings = replace(
        PLAIN,
        colour=replace(PLAIN.colour, rate=15.0, latency=0.05),
        depth=replace(PLAIN.depth, rate=30.0, latency=0.02),
        added_latency=0.008,
    )
    found = arrivals(eyes_of(settings), 60)
    assert sorted(found) == ["ColourImage", "DepthImage"]
    expected = {
        "ColourImage": (17 * TICK, 0.058),
        "DepthImage": (8 * TICK, 0.028),
    }
    for kind, (period, latency) in expected.items():
        taken, arrived = np.array(found[kind]).T
        np.testing.assert_allclose(taken, period * np.arange(len(taken)))
        late = arrived - taken
        assert (late >= latency - 1e-9).all()
        assert (late < latency + TICK).all()


def test_images_are_taken_from_the_sensor_mounts() -> None:
    eyes = eyes_of()
    arrivals(eyes, 1)
    colour, depth = eyes.exposed
    assert isinstance(colour, ColourImage) and isinstance(depth, DepthImage)
    assert (depth.near, depth.far) == (0.8, 3.5)
    # The face of the box, from the depth camera that looks down by 8 deg.
    lift = 0.645 - 0.5
    ahead = (1.6 - 0.03) * np.cos(np.radians(8.0))
    row, column = 30, 40
    assert depth.depths[row, column] == pytest.approx(ahead, abs=0.05)
    assert lift > 0.0 and depth.depths.shape == (60, 80)
    assert colour.camera == eyes.camera
    assert colour.pixels.shape == (60, 80, 3)
    assert colour.pixels[30, 40, 0] > 2 * colour.pixels[30, 40, 1]


def depth_images(eyes: SensorSuite, ticks: int = 60) -> list[DepthImage]:
    """Depth images that arrive in a time."""
    arrived = [p for i in range(ticks) for p in eyes.read(i * TICK)]
    return [p for p in arrived if isinstance(p, DepthImage)]


def test_the_rear_camera_looks_backward_from_the_torso() -> None:
    """The face of the box behind is 2 m behind the torso."""
    eyes = eyes_of(replace(PLAIN, rear_camera=True))
    (first, *_) = (p for p in depth_images(eyes) if p.number == 1)
    assert (first.near, first.far) == (0.6, 6.0)
    assert first.depths.shape == (60, 106)
    assert degrees(2 * np.arctan(53 / first.camera.focal_x)) == pytest.approx(
        87.0
    )
    assert first.depths[30, 53] == pytest.approx(2.0 - 0.075, abs=0.05)
    # Above the box there is nothing; the other box lies ahead.
    assert first.depths[0].max() == 0.0


@pytest.mark.parametrize(("near", "far"), [(0.5, 1.2), (2.0, 4.0)])
def test_a_depth_is_within_the_range_of_its_camera(
    near: float, far: float
) -> None:
    """The box at 1.6 m is seen neither by one nor by the other."""
    depth = replace(PLAIN.depth, near=near, far=far)
    eyes = eyes_of(replace(PLAIN, depth=depth))
    images = [
        percept.depths
        for tick in range(60)
        for percept in eyes.read(tick * TICK)
        if isinstance(percept, DepthImage)
    ]
    seen = images[0][images[0] > 0.0]
    assert ((seen >= near) & (seen <= far)).all()
