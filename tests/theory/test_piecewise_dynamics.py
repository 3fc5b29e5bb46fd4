"""Test the smooth pieces of the laws, and which follows which."""

from math import inf, pi, remainder, tau

import numpy as np
import pytest

from stepaside.theory.unicycle.game_parameters import (
    FlatParameters,
    flat_parameters,
)
from stepaside.theory.unicycle.piecewise_dynamics import (
    Branch,
    Edge,
    Mode,
    initial_mode,
    next_mode,
    opposite_branch,
    piece_of,
)
from stepaside.theory.unicycle.unicycle_game import make_game

ANGLE, WIDTH, GAIN = 1.1, 0.2, 0.6
EDGES = tuple(Edge)
FULL = (Branch.LEFT, Branch.RIGHT)


def rules(
    *, angle: float = ANGLE, keeps: bool = False, saturated: bool = False
) -> FlatParameters:
    made = flat_parameters(make_game(1.2, 0.9, 0.5, GAIN, angle), 0.1)
    return made._replace(
        hysteresis=WIDTH, keeps_side=keeps, saturated=saturated
    )


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("angle", [0.0, ANGLE, 2.5, pi])
def test_kept_side_starts_with_a_wrapped_error(
    side: int, angle: float
) -> None:
    """The bearing moves by a whole turn or not at all."""
    for bearing in np.linspace(-pi, pi, 41).tolist():
        found, mode = initial_mode(
            bearing, 0.0, side, rules(angle=angle, keeps=True)
        )
        assert mode == (side, Branch.PROPORTIONAL)
        assert abs(found + side * angle) <= pi + 1e-12
        assert remainder(found - bearing, tau) == pytest.approx(0.0, abs=1e-12)


def test_default_side_is_the_one_behind_the_evader() -> None:
    for bearing, side in ((0.3, -1), (pi, -1), (-0.3, 1), (-pi, 1), (0.0, 1)):
        found, mode = initial_mode(bearing, 0.0, 0, rules())
        assert found == pytest.approx(bearing)
        assert mode == (side, Branch.PROPORTIONAL)
    found, mode = initial_mode(0.3, 0.0, 1, rules())
    assert found == pytest.approx(0.3)
    assert mode == (1, Branch.PROPORTIONAL)


@pytest.mark.parametrize("side", [1, -1])
def test_saturated_evader_turns_towards_its_error(side: int) -> None:
    zero = -side * ANGLE
    for off, rate, branch in (
        (0.1, 0.0, Branch.LEFT),
        (-0.1, 0.0, Branch.RIGHT),
        (0.0, 0.0, Branch.SLIDING),
        (0.0, -GAIN, Branch.SLIDING),
        (0.0, 1.1 * GAIN, Branch.LEFT),
        (0.0, -1.1 * GAIN, Branch.RIGHT),
    ):
        found, mode = initial_mode(
            zero + off, rate, side, rules(saturated=True)
        )
        assert found == pytest.approx(zero + off)
        assert mode == (side, branch)


@pytest.mark.parametrize("side", [1, -1])
def test_pieces_reach_from_edge_to_edge(side: int) -> None:
    zero = -side * ANGLE
    kept = piece_of(Mode(side, Branch.PROPORTIONAL), rules(keeps=True))
    assert kept[:2] == pytest.approx((zero - pi, zero + pi))
    # no turning without error
    assert kept.slope * zero + kept.constant == pytest.approx(0.0)
    assert (kept.slope, kept.free) == (GAIN, 1.0)
    edges = sorted((side * WIDTH, -side * (pi + WIDTH)))
    low, high, *_ = piece_of(Mode(side, Branch.PROPORTIONAL), rules())
    assert (low, high) == pytest.approx(tuple(edges))
    left = piece_of(Mode(side, Branch.LEFT), rules())
    right = piece_of(Mode(side, Branch.RIGHT), rules())
    assert left == pytest.approx((zero, high, GAIN, 0.0, 1.0))
    assert right == pytest.approx((low, zero, -GAIN, 0.0, 1.0))
    sliding = piece_of(Mode(side, Branch.SLIDING), rules())
    assert sliding == (-inf, inf, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("keeps", [True, False])
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("branch", [Branch.PROPORTIONAL, *FULL])
@pytest.mark.parametrize("edge", EDGES)
def test_next_mode_has_the_same_direction(
    side: int, branch: Branch, edge: Edge, keeps: bool
) -> None:
    here = rules(keeps=keeps)
    piece = piece_of(Mode(side, branch), here)
    left = piece.high if edge is Edge.HIGH else piece.low
    at_zero = (branch, edge) in zip(FULL, EDGES, strict=True)
    for rate in (0.0, 1.1 * GAIN, -1.1 * GAIN):
        bearing, mode = next_mode(left, rate, Mode(side, branch), edge, here)
        assert remainder(bearing - left, tau) == pytest.approx(0.0, abs=1e-12)
        low, high, *_ = piece_of(mode, here)
        assert low - 1e-12 <= bearing <= high + 1e-12
        assert mode.side == (side if keeps or at_zero else -side)
        if at_zero:
            slides = abs(rate) <= GAIN
            after = Branch.SLIDING if slides else opposite_branch(branch)
            assert mode.branch == after
        elif branch is not Branch.PROPORTIONAL:
            error = bearing + mode.side * ANGLE
            assert mode.branch == FULL[error < 0.0]


@pytest.mark.parametrize("sign", [1, -1])
def test_sliding_ends_towards_the_line_of_sight(sign: int) -> None:
    mode = Mode(1, Branch.SLIDING)
    for edge in EDGES:
        found = next_mode(
            -ANGLE + 1e-9, sign * 1.1 * GAIN, mode, edge, rules()
        )
        assert found == (-ANGLE, (1, FULL[sign < 0]))
