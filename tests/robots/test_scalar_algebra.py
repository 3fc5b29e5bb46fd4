"""Test vectors and matrices of single numbers against NumPy."""

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.robots import scalar_algebra as algebra
from stepaside.robots.expression_tracing import ExpressionTrace, Number
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


def test_a_turn_about_an_axis_of_the_frame_leaves_zeros_and_one() -> None:
    turned = rotation_about(
        (0.0, 1.0, 0.0), ExpressionTrace().variable("angle", 0.3)
    )
    assert [turned[i][j] for i, j in ((0, 1), (1, 0), (1, 2), (2, 1))] == [
        0.0
    ] * 4
    assert turned[1][1] == 1.0
    assert turned[0][0] is turned[2][2]


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


def test_rows_that_share_a_number_cost_no_division() -> None:
    """As columns of parallel joints do: the difference is zero for good."""
    trace = ExpressionTrace()
    x, y, z = (
        trace.variable(n, h) for n, h in zip("xyz", (2, 3, 5), strict=True)
    )
    factors = LuFactors([[x, y, 0.0], [x, y, 1.0], [0.0, z, 1.0]])
    text = trace.source("f", factors.solve([1.0, 2.0, 3.0]))
    assert text.count("/") == 2
    formula = trace.formula("f", factors.solve([1.0, 2.0, 3.0]))
    values = formula.function()(4.0, 6.0, 7.0)
    matrix = np.array([[4, 6, 0], [4, 6, 1], [0, 7, 1.0]])
    np.testing.assert_allclose(matrix @ values, [1, 2, 3])


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


def test_pivots_are_not_small() -> None:
    """However many zeros are beside it."""
    matrix = np.array([[1e-13, 1.0, 1.0], [1.0, 1.0, 0.5], [0.0, 1.0, 2.0]])
    factors = LuFactors(matrix.tolist())
    found = numbers(factors.solve([1.0, 2.0, 3.0]))
    np.testing.assert_allclose(matrix @ found, [1, 2, 3], atol=1e-12)
