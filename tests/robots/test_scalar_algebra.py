"""Test vectors and matrices of single numbers against NumPy."""

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.robots import scalar_algebra as algebra
from stepaside.robots.expression_tracing import Number
from stepaside.robots.scalar_algebra import LuFactors, rotation_about

RANDOM = np.random.default_rng(5)


def numbers(vector: list[Number]) -> Array:
    return np.array(vector, dtype=np.float64)


def test_products_are_those_of_numpy() -> None:
    a, b = RANDOM.uniform(-1, 1, (2, 3, 3))
    u, v = RANDOM.uniform(-1, 1, (2, 3)).tolist()
    product = [numbers(r) for r in algebra.multiply(a.tolist(), b.tolist())]
    np.testing.assert_allclose(product, a @ b)
    np.testing.assert_allclose(numbers(algebra.turn(a.tolist(), u)), a @ u)
    np.testing.assert_allclose(numbers(algebra.cross(u, v)), np.cross(u, v))
    assert algebra.dot(u, v) == pytest.approx(np.dot(u, v))


@pytest.mark.parametrize("axis", [(1.0, 0, 0), (0, 0.6, -0.8), (0, 0, 1.0)])
def test_a_rotation_turns_by_its_angle_about_its_axis(
    axis: tuple[float, float, float],
) -> None:
    turned = np.array([numbers(row) for row in rotation_about(axis, 0.7)])
    x, y, z = axis
    spin = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    expected = np.eye(3) + np.sin(0.7) * spin
    expected += (1.0 - np.cos(0.7)) * spin @ spin
    np.testing.assert_allclose(turned, expected, atol=1e-15)


@pytest.mark.parametrize("size", [1, 2, 4, 6])
def test_factors_solve_both_ways(size: int) -> None:
    matrix = RANDOM.uniform(-1, 1, (size, size))
    matrix[0, 0] = 0.0 if size > 1 else 2.0
    right = RANDOM.uniform(-1, 1, size)
    factors = LuFactors(matrix.tolist())
    straight = numbers(factors.solve(right.tolist()))
    np.testing.assert_allclose(matrix @ straight, right, atol=1e-12)
    transposed = numbers(factors.solve_transposed(right.tolist()))
    np.testing.assert_allclose(matrix.T @ transposed, right, atol=1e-12)


def test_a_singular_matrix_is_refused() -> None:
    with pytest.raises(ZeroDivisionError):
        LuFactors([[1.0, 2.0], [2.0, 4.0]])


@pytest.mark.parametrize("size", [3, 6])
@pytest.mark.parametrize("corner", [0, -1])
def test_an_arrow_matrix_is_solved(size: int, corner: int) -> None:
    arrow = np.diag(RANDOM.uniform(1.0, 2.0, size))
    arrow[corner, :] = arrow[:, corner] = RANDOM.uniform(1.0, 2.0, size)
    arrow[corner, corner] = 9.0
    factors = LuFactors(arrow.tolist())
    right = RANDOM.uniform(-1, 1, size)
    found = numbers(factors.solve(right.tolist()))
    np.testing.assert_allclose(arrow @ found, right, atol=1e-12)
