"""Test errors of sensors and masses."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.core.random_streams import named_generator
from stepaside.sim.body_errors import SensorErrors, perturb_masses
from stepaside.sim.body_settings import BodySettings

TURN = np.array([0.3, -0.2, 0.1])
FORCE = np.array([1.0, 2.0, 9.0])


def errors_of(seed: int = 1, **effects: Any) -> SensorErrors:
    generator = named_generator(seed, "s")
    return SensorErrors(BodySettings(**effects), generator, 2)


def imu(
    sensors: SensorErrors, gyro: Array, force: Array
) -> tuple[Array, Array]:
    """Return the readings of gyro and accelerometer."""
    sensors.exact[:9] = *gyro, *force, *gyro
    _, turn, specific_force, latest, _ = sensors.readings()
    np.testing.assert_allclose(latest, turn, atol=1e-12)
    return turn, specific_force


def feet(sensors: SensorErrors, forces: Array) -> Array:
    """Return the readings of the foot sensors."""
    sensors.exact[9:17] = forces
    return sensors.readings()[4]


@pytest.mark.parametrize(
    ("name", "which", "size"),
    [("gyro_bias", 0, 0.1), ("accelerometer_bias", 1, 0.5)],
)
def test_a_bias_is_constant_and_within_its_bound(
    name: str, which: int, size: float
) -> None:
    """Over many robots it fills minus to plus its size on every axis."""
    truth = (TURN, FORCE)
    drawn = []
    for seed in range(300):
        effects: dict[str, Any] = {name: size}
        sensors = errors_of(seed, **effects)
        first, second = imu(sensors, *truth), imu(sensors, *truth)
        np.testing.assert_array_equal(first[which], second[which])
        np.testing.assert_array_equal(first[1 - which], truth[1 - which])
        drawn.append(first[which] - truth[which])
    biases = np.array(drawn) / size
    assert np.abs(biases).max() <= 1.0 + 1e-12
    assert biases.min(axis=0).max() < -0.95
    assert biases.max(axis=0).min() > 0.95
    np.testing.assert_allclose(biases.std(axis=0), 3**-0.5, rtol=0.1)


@pytest.mark.parametrize(
    ("name", "which", "size"),
    [("gyro_noise", 0, 0.02), ("accelerometer_noise", 1, 0.3)],
)
def test_imu_noise_has_zero_mean_and_the_set_deviation(
    name: str, which: int, size: float
) -> None:
    effects: dict[str, Any] = {name: size}
    sensors = errors_of(**effects)
    truth = (TURN, FORCE)
    readings = [imu(sensors, *truth) for _ in range(4000)]
    off = np.array([r[which] for r in readings]) - truth[which]
    np.testing.assert_allclose(off.std(axis=0), size, rtol=0.05)
    np.testing.assert_allclose(off.mean(axis=0), 0.0, atol=0.06 * size)
    exact = np.array([r[1 - which] for r in readings]) - truth[1 - which]
    np.testing.assert_array_equal(exact, 0.0)


@pytest.mark.parametrize("delay", [0, 1, 3])
def test_the_imu_is_delayed_by_whole_cycles(delay: int) -> None:
    sensors = errors_of(imu_delay_cycles=delay)
    for number in range(8):
        turn, force = imu(sensors, TURN * number, FORCE * number)
        then = max(number - delay, 0)
        np.testing.assert_array_equal(turn, TURN * then)
        np.testing.assert_array_equal(force, FORCE * then)


def test_foot_noise_has_the_set_deviation_and_stays_positive() -> None:
    sensors = errors_of(force_noise=0.4)
    nine = np.full(8, 9.0)
    pressed = np.array([feet(sensors, nine) for _ in range(999)])
    np.testing.assert_allclose(pressed.std(), 0.4, rtol=0.05)
    np.testing.assert_allclose(pressed.mean(), 9.0, atol=0.03)
    free = np.array([feet(sensors, np.zeros(8)) for _ in range(999)])
    assert free.min() == 0.0
    np.testing.assert_allclose((free == 0.0).mean(), 0.5, atol=0.03)


def part(name: str, mass: float = 2.0) -> SimpleNamespace:
    return SimpleNamespace(
        name=name,
        mass=mass,
        fullinertia=np.arange(1.0, 7.0),
        inertia=np.ones(3),
        ipos=np.array([0.1, 0.2, 0.3]),
    )


def test_inertia_scales_with_the_mass() -> None:
    factors = []
    for seed in range(300):
        parts = [part("torso"), part("leg"), part("frame", 0.0)]
        body = BodySettings(mass_error=0.2)
        perturb_masses(parts, body, "torso", named_generator(seed, "m"))
        for one in parts[:2]:
            factor = one.mass / 2.0
            np.testing.assert_allclose(
                one.fullinertia, factor * np.arange(1.0, 7.0)
            )
            np.testing.assert_allclose(one.inertia, factor)
            factors.append(factor)
        assert parts[2].mass == 0.0
        np.testing.assert_array_equal(parts[2].inertia, 1.0)
        np.testing.assert_array_equal(parts[0].ipos, [0.1, 0.2, 0.3])
    assert 0.8 <= min(factors) < 0.805 and 1.195 < max(factors) <= 1.2
    assert factors[0] != factors[1]


def test_only_the_torso_has_its_com_shifted_and_level() -> None:
    shifts = []
    for seed in range(300):
        parts = [part("torso"), part("leg")]
        body = BodySettings(com_error=0.01)
        perturb_masses(parts, body, "torso", named_generator(seed, "m"))
        shifts.append(parts[0].ipos - [0.1, 0.2, 0.3])
        np.testing.assert_array_equal(parts[1].ipos, [0.1, 0.2, 0.3])
        assert parts[0].mass == 2.0
    found = np.array(shifts) / 0.01
    np.testing.assert_array_equal(found[:, 2], 0.0)
    assert found[:, :2].min(axis=0).max() < -0.95
    assert 0.95 < found[:, :2].max(axis=0).min()
    assert np.abs(found).max() <= 1.0 + 1e-12
    assert abs(np.corrcoef(found[:, 0], found[:, 1])[0, 1]) < 0.2
