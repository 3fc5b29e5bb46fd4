"""Test the smooth pieces of the laws and the steps across their edges."""

from math import inf, pi, remainder, sin, tau

import numpy as np
import pytest

from stepaside.unicycle.event_located import careful_step, margin
from stepaside.unicycle.modes import SLIDING, enter, leave, piece

ANGLE, WIDTH, GAIN = 1.1, 0.2, 0.6


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("angle", [0.0, ANGLE, 2.5, pi])
def test_kept_side_starts_with_a_wrapped_error(
    side: int, angle: float
) -> None:
    """The bearing moves by a whole turn or not at all."""
    for bearing in np.linspace(-pi, pi, 41).tolist():
        found, kept, branch = enter(
            bearing, 0.0, side, angle, True, False, GAIN
        )
        assert (kept, branch) == (side, 0)
        assert abs(found + side * angle) <= pi + 1e-12
        assert remainder(found - bearing, tau) == pytest.approx(0.0, abs=1e-12)


def test_side_not_asked_for_is_the_one_behind_the_evader() -> None:
    for bearing, side in ((0.3, -1), (pi, -1), (-0.3, 1), (-pi, 1), (0.0, 1)):
        found = enter(bearing, 0.0, 0, ANGLE, False, False, GAIN)
        assert found == pytest.approx((bearing, side, 0))
    asked = enter(0.3, 0.0, 1, ANGLE, False, False, GAIN)
    assert asked == pytest.approx((0.3, 1, 0))


@pytest.mark.parametrize("side", [1, -1])
def test_saturated_evader_turns_towards_its_error(side: int) -> None:
    zero = -side * ANGLE
    for off, rate, branch in (
        (0.1, 0.0, 1),
        (-0.1, 0.0, -1),
        (0.0, 0.0, SLIDING),
        (0.0, -GAIN, SLIDING),
        (0.0, 1.1 * GAIN, 1),
        (0.0, -1.1 * GAIN, -1),
    ):
        found = enter(zero + off, rate, side, ANGLE, False, True, GAIN)
        assert found == pytest.approx((zero + off, side, branch))


@pytest.mark.parametrize("side", [1, -1])
def test_pieces_reach_from_edge_to_edge(side: int) -> None:
    zero = -side * ANGLE
    low, high, c0, c1, c2 = piece(side, 0, ANGLE, WIDTH, True, GAIN)
    assert (low, high) == pytest.approx((zero - pi, zero + pi))
    assert c1 * zero + c0 == pytest.approx(0.0)  # no turning without error
    assert (c1, c2) == (GAIN, 0.0)
    edges = sorted((side * WIDTH, -side * (pi + WIDTH)))
    low, high, *_ = piece(side, 0, ANGLE, WIDTH, False, GAIN)
    assert (low, high) == pytest.approx(tuple(edges))
    left = piece(side, 1, ANGLE, WIDTH, False, GAIN)
    right = piece(side, -1, ANGLE, WIDTH, False, GAIN)
    assert left == pytest.approx((zero, high, GAIN, 0.0, 0.0))
    assert right == pytest.approx((low, zero, -GAIN, 0.0, 0.0))
    sliding = piece(side, SLIDING, ANGLE, WIDTH, False, GAIN)
    assert sliding == (-inf, inf, 0.0, 0.0, 1.0)


@pytest.mark.parametrize("keeps", [True, False])
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("branch", [0, 1, -1])
@pytest.mark.parametrize("edge", [1, -1])
def test_piece_that_follows_holds_the_same_direction(
    side: int, branch: int, edge: int, keeps: bool
) -> None:
    low, high, *_ = piece(side, branch, ANGLE, WIDTH, keeps, GAIN)
    left = high if edge > 0 else low
    for rate in (0.0, 1.1 * GAIN, -1.1 * GAIN):
        bearing, now, then = leave(
            left, rate, side, branch, edge, ANGLE, keeps, GAIN
        )
        assert remainder(bearing - left, tau) == pytest.approx(0.0, abs=1e-12)
        low, high, *_ = piece(now, then, ANGLE, WIDTH, keeps, GAIN)
        assert low - 1e-12 <= bearing <= high + 1e-12
        at_zero = branch != 0 and edge == -branch
        assert now == (side if keeps or at_zero else -side)
        if at_zero:
            slides = abs(rate) <= GAIN
            assert then == (SLIDING if slides else -branch)
        elif branch != 0:
            error = bearing + now * ANGLE
            assert then * error > 0.0


@pytest.mark.parametrize("sign", [1, -1])
def test_sliding_ends_towards_the_line_of_sight(sign: int) -> None:
    zero = -ANGLE
    found = leave(
        zero + 1e-9, sign * 1.1 * GAIN, 1, SLIDING, 1, ANGLE, False, GAIN
    )
    assert found == (zero, 1, sign)


def test_margins_fall_to_zero_at_their_edges() -> None:
    r, a, psi, vp, ve, ke = 2.0, 0.4, -0.3, 1.2, 0.9, 0.6
    got = [
        margin(what, r, a, psi, vp, ve, ke, -1.0, 0.5, 0.7)
        for what in range(6)
    ]
    rate = (vp * sin(a) - ve * sin(psi)) / r
    closing = vp * np.cos(a) - ve * np.cos(psi)
    expected = [pi - a, 0.7, 0.8, ke - abs(rate), closing, 1.3]
    assert got == pytest.approx(expected)


def test_careful_step_tells_the_closest_approach_and_its_time() -> None:
    """A pursuer drives straight past an evader that stands still."""
    still = (0.0, 0.0, 0.0, 0.0, True)  # no gain, no angle, no hysteresis
    a, psi = np.arctan2(0.3, 0.5), -np.arctan2(0.3, 0.5)
    r = np.hypot(0.3, 0.5)
    step = careful_step(r, a, psi, 1, 0, 2.0, 1.0, 0.0, *still, 0.01)
    assert step[5:] == pytest.approx((0.3, 0.5, -1.0))
    assert step[0] == pytest.approx(np.hypot(0.3, 1.5))
    apart = careful_step(r, pi - a, psi, 1, 0, 0.5, 1.0, 0.0, *still, 0.01)
    assert apart[5:] == pytest.approx((r, 0.0, -1.0))
    caught = careful_step(r, a, psi, 1, 0, 2.0, 1.0, 0.0, *still, 0.5)
    when = 0.5 - np.sqrt(0.5**2 - 0.3**2)
    assert caught[5:] == pytest.approx((0.5, when, when))
