r"""Bounded CoM of the linear inverted pendulum (paper, eqs. (15)-(17)).

With the divergent component of motion :math:`\xi = x + \dot{x} / \eta`,

.. math:: \dot{\xi} = \eta (\xi - p), \qquad \dot{x} = \eta (\xi - x),

the only bounded solution has :math:`\xi = x_u` of (16). For a polynomial
ZMP p both have a closed form in each piece: a polynomial, plus a multiple of
:math:`e^{\eta s}`, plus, for x, a multiple of :math:`e^{-\eta s}`.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..core.poses import Array


@dataclass(frozen=True, slots=True)
class PiecewisePolynomial:
    r"""Piecewise polynomial in local time, then a constant."""

    durations: Array  # duration of each piece [s]. Shape (n,)
    coefficients: Array  # [m/s^j] (degree + 1, n, ...)

    @property
    def end(self) -> Array:
        """Value at the end of the last piece. Shape (...)."""
        value: Array = evaluate(self.coefficients, self.durations)[-1]
        return value

    def locate(self, times: ArrayLike) -> tuple[np.ndarray, Array]:
        """Return the piece of each time, and the local time in it, in [s].

        Local times exceed the duration only after the end.
        """
        t = np.asarray(times, dtype=np.float64)
        starts = np.concatenate([[0.0], np.cumsum(self.durations)[:-1]])
        index = np.searchsorted(starts, t, side="right") - 1
        index = np.clip(index, 0, self.durations.size - 1)
        return index, t - starts[index]


def evaluate(coefficients: Array, local_times: Array) -> Array:
    """Evaluate polynomials (degree + 1, m, ...) at local times (m,) in [s]."""
    s = local_times.reshape(-1, *[1] * (coefficients.ndim - 2))
    value = np.zeros(coefficients.shape[1:])
    for coefficient in coefficients[::-1]:
        value = value * s + coefficient
    return value


def least_values(coefficients: Array, duration: float) -> Array:
    """Return the least values of cubics (4, n) over [0, duration].

    They are at an end or where the derivative vanishes.
    """
    c0, c1, c2, c3 = coefficients
    # Roots of c1 + 2 c2 s + 3 c3 s^2 without cancellation, also if any is 0.
    root = np.sqrt(np.maximum(c2 * c2 - 3.0 * c3 * c1, 0.0))
    half = -(c2 + np.copysign(root, c2))
    with np.errstate(divide="ignore", invalid="ignore"):
        turns = np.array([half / (3.0 * c3), c1 / half])
    # Without a root the candidate is clipped to an end, which is harmless.
    turns = np.clip(np.nan_to_num(turns), 0.0, duration)
    times = np.vstack([np.zeros_like(c1), np.full_like(c1, duration), turns])
    values = c0 + (c1 + (c2 + c3 * times) * times) * times
    least: Array = values.min(axis=0)
    return least


@dataclass(frozen=True, slots=True)
class BoundedCom:
    """Closed-form CoM and DCM over a piecewise polynomial ZMP."""

    zmp: PiecewisePolynomial
    eta: float  # rate of the pendulum [1/s]
    dcm_polynomial: Array  # polynomial part of the DCM, laid out as the ZMP
    com_polynomial: Array  # polynomial part of the CoM
    growth: Array  # DCM less its polynomial at the end of each piece. (n, ...)
    decay: Array  # coefficient of exp(-eta s) in the CoM. (n, ...)

    @classmethod
    def solve(
        cls, zmp: PiecewisePolynomial, eta: float, com_start: ArrayLike
    ) -> "BoundedCom":
        """Solve (15)-(17); the velocity at the start follows from (16)."""
        p = zmp.coefficients
        durations = zmp.durations
        dcm = _particular(p, 1.0 / eta)
        com = _particular(dcm, -1.0 / eta)
        dcm_end = evaluate(dcm, durations)
        com_end = evaluate(com, durations)
        fade = np.exp(-eta * durations)

        growth = np.empty(p.shape[1:])
        xi_next = zmp.end  # at rest over the last ZMP
        for i in reversed(range(durations.size)):
            growth[i] = xi_next - dcm_end[i]
            xi_next = dcm[0, i] + growth[i] * fade[i]
        decay = np.empty(p.shape[1:])
        x = np.asarray(com_start, dtype=np.float64)
        for i in range(durations.size):
            decay[i] = x - com[0, i] - 0.5 * growth[i] * fade[i]
            x = com_end[i] + 0.5 * growth[i] + decay[i] * fade[i]
        return cls(zmp, eta, dcm, com, growth, decay)

    def sample(self, times: ArrayLike) -> tuple[Array, Array, Array]:
        """Evaluate ZMP, DCM and CoM at any times (m,), in [m]. (m, ...) each.

        The CoM velocity is ``eta * (dcm - com)``.
        """
        index, s = self.zmp.locate(times)
        beyond = np.maximum(s - self.zmp.durations[index], 0.0)
        inside = s - beyond
        shape = (-1, *[1] * (self.growth.ndim - 1))
        rise = np.exp(self.eta * (inside - self.zmp.durations[index]))
        fall = np.exp(-self.eta * inside).reshape(shape)
        risen = self.growth[index] * rise.reshape(shape)
        zmp = evaluate(self.zmp.coefficients[:, index], inside)
        dcm = evaluate(self.dcm_polynomial[:, index], inside) + risen
        com = evaluate(self.com_polynomial[:, index], inside)
        com = com + 0.5 * risen + self.decay[index] * fall
        # After the end the DCM rests on the ZMP and the CoM decays to it.
        com = dcm + (com - dcm) * np.exp(-self.eta * beyond).reshape(shape)
        return zmp, dcm, com


def _particular(p: Array, step: float) -> Array:
    r"""Polynomial solution of :math:`q - \mathrm{step}\, \dot{q} = p`."""
    q = p.copy()
    for j in reversed(range(p.shape[0] - 1)):
        q[j] += step * (j + 1) * q[j + 1]
    return q
