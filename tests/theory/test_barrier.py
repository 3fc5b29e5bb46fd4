"""Test the barrier of two identical cars in closed form."""

from math import cos, pi, sin, tau

import numpy as np
import pytest
from numpy.typing import NDArray

from stepaside.theory.value.two_cars import (
    POINTS,
    barrier_slice,
    left_half,
    turn_back,
)

Array = NDArray[np.float64]
CAPTURES = (0.3, 1.0, 2.5)


def drive(state: Array, pursuer: float, evader: float, time: float) -> Array:
    """Relative motion by Runge's and Kutta's steps of its equation."""
    step = time / 120

    def rates(s: Array) -> Array:
        return np.array(
            [
                cos(s[2]) - 1.0 + pursuer * s[1],
                sin(s[2]) - pursuer * s[0],
                evader - pursuer,
            ]
        )

    for _ in range(120):
        k1 = rates(state)
        k2 = rates(state + 0.5 * step * k1)
        k3 = rates(state + 0.5 * step * k2)
        k4 = rates(state + step * k3)
        state = state + step / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
    return state


@pytest.mark.parametrize("pursuer", [-1.0, 0.0, 1.0])
@pytest.mark.parametrize("evader", [-1.0, 0.0, 1.0])
def test_backward_integration_inverts_driving(
    pursuer: float, evader: float
) -> None:
    now = np.array([0.4, -1.3, 0.7])
    x, y, theta = now[:, None]
    then = turn_back((x, y, theta), pursuer, evader, np.array([1.7]))
    again = drive(np.concatenate(then), pursuer, evader, 1.7)
    np.testing.assert_allclose(again, now, atol=1e-6)


@pytest.mark.parametrize("capture", CAPTURES)
@pytest.mark.parametrize("theta", [0.4, 1.5, pi, 4.5])
def test_optimal_play_from_the_barrier_grazes_the_capture_circle(
    capture: float, theta: float
) -> None:
    """Played forward, each point ends at the distance of capture."""
    points, pieces = left_half(capture, theta)
    for n in range(0, 3 * POINTS, 8):
        share = (n % POINTS) / (POINTS - 1)
        state = np.array([*points[n], theta])
        if pieces[n] == 1:
            a = theta / 2 * (1 - share)
            end = drive(state, 1.0, -1.0, theta / 2 - a)
            grazing = [capture * cos(a), capture * sin(a), 2 * a]
            np.testing.assert_allclose(end, grazing, atol=1e-6)
            closing = end[0] * (cos(end[2]) - 1.0) + end[1] * sin(end[2])
            assert closing == pytest.approx(0.0, abs=1e-6)
            continue
        chase = theta if pieces[n] == 3 else share * theta
        turn = share * (tau - theta) if pieces[n] == 3 else (theta - chase) / 2
        state = drive(state, -1.0 if pieces[n] == 3 else 1.0, -1.0, turn)
        end = drive(state, 0.0, -1.0, chase)
        np.testing.assert_allclose(end, [capture, 0.0, 0.0], atol=1e-6)


@pytest.mark.parametrize("capture", CAPTURES)
@pytest.mark.parametrize("piece", [1, 2, 3])
def test_neither_player_can_cross_the_barrier(
    capture: float, piece: int
) -> None:
    """Its normal n obeys min max n.f = 0, with n by finite differences."""
    step = 1e-4
    for theta in np.linspace(0.3, 5.5, 9):
        low, here, high = (
            left_half(capture, theta + d)[0].reshape(3, POINTS, 2)
            for d in (-step, 0.0, step)
        )
        row = here[piece - 1]
        along = np.gradient(row, axis=0)[2:-2]
        across = ((high - low)[piece - 1] / (2 * step))[2:-2]
        normal = np.column_stack(
            [
                along[:, 1],
                -along[:, 0],
                -along[:, 1] * across[:, 0] + along[:, 0] * across[:, 1],
            ]
        )
        normal *= -np.sign(normal[:, 2:])  # the evader turns right
        size = np.linalg.norm(normal, axis=1)
        x, y = row[2:-2].T
        drift = normal[:, 0] * (cos(theta) - 1.0) + normal[:, 1] * sin(theta)
        turning = normal[:, 0] * y - normal[:, 1] * x - normal[:, 2]
        flow = drift - np.abs(turning) + np.abs(normal[:, 2])
        keen = size > 1e-3 * size.max()
        np.testing.assert_allclose(flow[keen] / size[keen], 0.0, atol=5e-3)


@pytest.mark.parametrize("capture", CAPTURES)
def test_both_halves_start_on_the_circle_and_meet(capture: float) -> None:
    for theta in (0.3, 1.0, 2.0, pi):
        points, pieces = barrier_slice(capture, theta)
        ends = np.hypot(*points[[0, -1]].T)
        np.testing.assert_allclose(ends, capture, rtol=1e-12)
        assert pieces[0] > 0 > pieces[-1]
        assert np.hypot(*np.diff(points, axis=0).T).max() < 0.5
    head_on, _ = barrier_slice(capture, pi)
    np.testing.assert_allclose(head_on[:, 1], -head_on[::-1, 1], atol=0.1)
    assert head_on[:, 0].max() > capture + 2.0
