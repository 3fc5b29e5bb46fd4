"""Linearisation of the game about a circle."""

from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .unicycle_game import Game

Array = NDArray[np.float64]


def relative_jacobian(
    speeds: tuple[Any, Any], distance: Any, pursuer_error: Any, bearing: Any
) -> Array:
    r"""Linearise the relative motion with the turning rates held.

    Args:
        speeds: Speeds of pursuer and evader, in [m/s]. All arguments are
            numbers, or arrays of one shape.
        distance: Distance :math:`r`, in [m].
        pursuer_error: Error :math:`a`, in [rad].
        bearing: Bearing :math:`\psi` of the pursuer, in [rad].

    Returns:
        Derivative of the rates of :math:`(r, a, \psi)` by the state. Shape
        (..., 3, 3).
    """
    vp, ve = speeds
    along_p, across_p = vp * np.cos(pursuer_error), vp * np.sin(pursuer_error)
    along_e, across_e = ve * np.cos(bearing), ve * np.sin(bearing)
    rate = (across_p - across_e) / distance  # of the line of sight
    sight = np.array([-rate, along_p, -along_e]) / distance
    rows = np.stack(
        [np.array([0.0 * rate, across_p, -across_e]), sight, sight]
    )
    found: Array = np.moveaxis(rows, (0, 1), (-2, -1))
    return found


def loop_matrices(
    speeds: tuple[Any, Any],
    gains: tuple[Any, Any],
    distance: Any,
    pursuer_error: Any,
    bearing: Any,
) -> Array:
    """Linearise the closed loop of one or many games.

    Args:
        speeds: Speeds of pursuer and evader, in [m/s].
        gains: Derivatives of the turning rates of pursuer and evader by
            their errors, in [1/s].
        distance: Distance, in [m].
        pursuer_error: Error of the pursuer, in [rad].
        bearing: Bearing of the pursuer in the evader's frame, in [rad].

    Returns:
        Derivative of the rates of (r, a, psi), in [1/s] and mixed units.
        Shape (..., 3, 3). When sliding, the bearing is constant; ignore its
        row and column.
    """
    loop = relative_jacobian(speeds, distance, pursuer_error, bearing)
    loop[..., 1, 1] -= gains[0]
    loop[..., 2, 2] -= gains[1]
    return loop


def geometry_jacobian(
    game: Game, distance: float, pursuer_error: float, bearing: float
) -> tuple[Array, Array]:
    r"""Linearise the relative motion with the turning rates held.

    Args:
        game: Parameters of the game.
        distance: Distance :math:`r`, in [m].
        pursuer_error: Error :math:`a`, in [rad].
        bearing: Bearing :math:`\psi` of the pursuer, in [rad].

    Returns:
        Derivative of the rates of :math:`(r, a, \psi)` by the state, shape
        (3, 3), and by the turning rates (pursuer, evader), shape (3, 2).
    """
    speeds = game.pursuer.speed, game.evader.speed
    by_state = relative_jacobian(speeds, distance, pursuer_error, bearing)
    by_turning = np.array([[0.0, 0.0], [-1.0, 0.0], [0.0, -1.0]])
    return by_state, by_turning


def feedback_matrix(game: Game) -> Array:
    """Return the derivative of the turning rates by (r, a, psi), (2, 3)."""
    evader = 0.0 if game.saturated else game.evader.gain
    return np.array([[0.0, game.pursuer.gain, 0.0], [0.0, 0.0, evader]])


def jacobian(
    game: Game,
    distance: float,
    pursuer_error: float,
    bearing: float,
    *,
    sliding: bool = False,
) -> Array:
    """Linearise the closed loop.

    Args:
        game: Parameters of the game.
        distance: Distance, in [m].
        pursuer_error: Error of the pursuer, in [rad].
        bearing: Bearing of the pursuer in the evader's frame, in [rad].
        sliding: Whether the saturated evader slides on zero error.

    Returns:
        Derivative of the rates of (r, a, psi), in [1/s] and mixed units,
        shape (3, 3); when sliding, of (r, a), shape (2, 2), because the
        bearing is then constant and reached in finite time.
    """
    speeds = game.pursuer.speed, game.evader.speed
    gains = game.pursuer.gain, 0.0 if game.saturated else game.evader.gain
    loop = loop_matrices(speeds, gains, distance, pursuer_error, bearing)
    size = 2 if sliding else 3
    return loop[:size, :size]


def sorted_eigenvalues(matrix: NDArray[Any]) -> tuple[complex, ...]:
    """Return the eigenvalues, the slowest (largest real part) first."""
    values = [complex(value) for value in np.linalg.eigvals(matrix)]
    return tuple(sorted(values, key=lambda s: (-s.real, -s.imag)))


def time_constant(eigenvalues: tuple[complex, ...]) -> float:
    """Return the time constant of the slowest mode, in [s], or inf."""
    rate = -max(value.real for value in eigenvalues)
    return 1.0 / rate if rate > 0.0 else inf
