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
from .zmp import PiecewisePolynomial, evaluate


@dataclass(frozen=True, slots=True)
class BoundedCom:
    """Closed-form CoM and DCM over a piecewise polynomial ZMP."""

    zmp: PiecewisePolynomial
    eta: float  # rate of the pendulum [1/s]
    # polynomial part of the DCM, in the frame of the ZMP and laid out like it
    dcm_polynomial: Array
    # polynomial part of the CoM, in the frame of the ZMP
    com_polynomial: Array
    # DCM less its polynomial at the end of each piece [m]. Shape (n, ...)
    growth: Array
    # coefficient of exp(-eta s) in the CoM of each piece [m]. Shape (n, ...)
    decay: Array

    @classmethod
    def solve(
        cls, zmp: PiecewisePolynomial, eta: float, com_start: ArrayLike
    ) -> "BoundedCom":
        """Solve (15)-(17); the velocity at the start follows from (16).

        ``com_start``: CoM at the start, in [m]. Shape (...), as the ZMP.
        """
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
        """Evaluate ZMP, DCM and CoM, in [m]. Shape (m, ...) each.

        The CoM velocity is ``eta * (dcm - com)``.

        ``times``: Times since the start, in [s]; any, also after the end of
        the ZMP's last piece. Shape (m,).
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
