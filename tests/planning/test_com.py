"""Test the bounded CoM (paper, eqs. (15)-(17)) against quadrature."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp

from stepaside.planning.com import BoundedCom, PiecewisePolynomial

ETA = 6.05  # [1/s]


def random_zmp(seed: int, pieces: int, degree: int) -> PiecewisePolynomial:
    draw = np.random.default_rng(seed)
    durations = draw.uniform(0.1, 0.6, pieces)
    coefficients = draw.normal(size=(degree + 1, pieces, 2))
    return PiecewisePolynomial(durations, coefficients)


def zmp_at(zmp: PiecewisePolynomial, time: float) -> np.ndarray:
    """ZMP by plain evaluation, independent of the solver."""
    start = 0.0
    for duration, piece in zip(
        zmp.durations, np.moveaxis(zmp.coefficients, 1, 0), strict=True
    ):
        if time < start + duration:
            s = time - start
            return np.asarray(sum(c * s**j for j, c in enumerate(piece)))
        start += duration
    return np.asarray(sum(c * duration**j for j, c in enumerate(piece)))


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 6), st.integers(0, 5))
def test_dcm_is_the_integral_of_16(
    seed: int, pieces: int, degree: int
) -> None:
    zmp = random_zmp(seed, pieces, degree)
    solution = BoundedCom.solve(zmp, ETA, (0.0, 0.0))
    ends = np.cumsum(zmp.durations)
    for time in (0.0, 0.37 * ends[-1], 1.2 * ends[-1]):
        tail = max(ends[-1], time)
        knots = [k for k in ends if k > time]
        grid = [time, *knots, tail + 8.0]
        integral = np.zeros(2)
        for low, high in zip(grid[:-1], grid[1:], strict=True):
            for axis in range(2):
                integral[axis] += quad(
                    lambda t, a=axis, z=time: (
                        ETA * np.exp(-ETA * (t - z)) * zmp_at(zmp, t)[a]
                    ),
                    low,
                    high,
                    epsabs=1e-12,
                )[0]
        _, dcm, _ = solution.sample([time])
        np.testing.assert_allclose(dcm[0], integral, atol=1e-9)


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 5), st.integers(0, 4))
def test_com_solves_the_pendulum(seed: int, pieces: int, degree: int) -> None:
    zmp = random_zmp(seed, pieces, degree)
    start = np.array([0.1, -0.2])
    solution = BoundedCom.solve(zmp, ETA, start)
    end = float(zmp.durations.sum()) + 0.3
    integrated = solve_ivp(
        lambda t, x: ETA * (solution.sample([t])[1][0] - x),
        (0.0, end),
        start,
        rtol=1e-9,
        atol=1e-11,
        max_step=0.02,
    )
    com = solution.sample([end])[2][0]
    np.testing.assert_allclose(com, integrated.y[:, -1], atol=1e-7)


def test_com_is_continuous_across_pieces_and_after_the_end() -> None:
    zmp = random_zmp(3, 6, 3)
    solution = BoundedCom.solve(zmp, ETA, (0.0, 0.1))
    knots = np.cumsum(zmp.durations)
    before = solution.sample(knots - 1e-10)
    after = solution.sample(knots + 1e-10)
    for a, b in zip(before[1:], after[1:], strict=True):
        np.testing.assert_allclose(a, b, atol=1e-7)


def test_com_stays_bounded_and_rests_on_the_last_zmp() -> None:
    zmp = random_zmp(5, 3, 2)
    solution = BoundedCom.solve(zmp, ETA, (5.0, -5.0))
    _, dcm, com = solution.sample([100.0])
    np.testing.assert_allclose(com[0], zmp.end, atol=1e-12)
    np.testing.assert_allclose(dcm[0], zmp.end, atol=1e-12)
