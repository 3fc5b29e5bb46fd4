r"""Intrinsically stable MPC on top of a plan (Scianca et al., 2016).

The ZMP velocity is the decision, constant over N samples of length
:math:`\delta`; here it is the velocity w that is added to the plan's, so that
w = 0 is the closed form itself. With the DCM d and the ZMP z, both less the
plan's, the motion is bounded if and only if

.. math:: \sum_i \kappa_i w_i = d_0 - z_0, \qquad
   \kappa_i = e^{-i \eta \delta} \frac{1 - e^{-\eta \delta}}{\eta},

with the plan's own ZMP beyond the horizon. The ZMP has to stay in the support
polygon (:mod:`stepaside.planning.plan`) at the end of each sample
and whenever a foot lands or lifts off. Between these instants the added ZMP is
linear in time, and so is the plan's, except for its correction (27 a / T^2 in
curvature, at most 0.06 of its amplitude a between two samples) and for the
cubic profile.
"""

from functools import cache
from math import hypot
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from ...core.errors import ConfigurationError
from ...core.poses import Array
from ...planning import GaitSettings, ManeuverPlan
from ...planning.com import evaluate
from ..control_settings import MpcSettings

EQUALITY = 5  # flag of an equality constraint in the solver
INFEASIBLE = -1  # exit flag; other values below 1 mean no convergence
PRECISION = 1e-6  # an excess below this counts as zero, in [m]
# Weight of the violated boundedness over the cost of the ZMP motion: so large
# that the excess is minimal to within a micrometre.
SLACK = 1e11


@cache
def load_solver() -> Any:
    """Import the optional solver of quadratic programs."""
    try:
        import daqp
    except ImportError as error:
        raise ConfigurationError(
            "method 'mpc' needs the solver daqp: pip install 'stepaside[mpc]'"
        ) from error
    return daqp


class _Support(NamedTuple):
    """Support phases of a plan, padded to the same number of half planes."""

    plan: ManeuverPlan
    starts: Array
    single: np.ndarray
    normals: Array
    offsets: Array
    zmp: Array


class MpcResult(NamedTuple):
    """Result of the MPC at one tick, in the plan frame.

    The excess is the DCM that no ZMP in the support polygon can hold; the
    velocity then minimises it.
    """

    velocity: tuple[float, float]  # of the ZMP, added to the plan's [m/s]
    feasible: bool  # whether a bounded motion exists
    excess: tuple[float, float]  # [m]
    iterations: int
    time: float  # of computation [s]


class IntrinsicallyStableMpc:
    """Intrinsically stable MPC for the plans of one gait."""

    def __init__(
        self, gait: GaitSettings, settings: MpcSettings, *, edge: float
    ) -> None:
        """Precompute what does not depend on the plan.

        ``edge`` is the distance of the ZMP from the edge of the sole, in [m].
        """
        self._solver = load_solver()
        self.settings, self._edge = settings, edge
        n = settings.steps * settings.samples
        self.interval = delta = gait.step_duration / settings.samples
        eta = gait.eta
        self._ends: Array = np.linspace(delta, n * delta, n)
        fade = np.exp(-eta * delta)
        self._kappa = fade ** np.arange(n) * (1.0 - fade) / eta
        total = delta * np.tri(n)
        cost = np.eye(n) + settings.pull * total.T @ total
        none = np.zeros((n, n))
        self._cost = np.block([[cost, none], [none, cost]])
        self._drift = settings.pull * total.sum(axis=0)
        self._bounded = np.kron(np.eye(2), self._kappa)
        self._soft_cost = np.zeros((2 * n + 2, 2 * n + 2))
        self._soft_cost[: 2 * n, : 2 * n] = self._cost
        self._soft_cost[-2:, -2:] = SLACK * np.eye(2)
        self._support: _Support | None = None

    def solve(
        self, plan: ManeuverPlan, passed: float, dcm: Array, zmp: Array
    ) -> MpcResult:
        """Solve at one tick, ``passed`` after the plan began, in [s].

        DCM and ZMP are less the plan's, in the plan frame, in [m].
        """
        began = perf_counter()
        rows, high, soon = self._constraints(plan, passed, zmp)
        bounded = dcm - zmp
        gradient = np.concatenate([self._drift * zmp[0], self._drift * zmp[1]])
        w, flag, info = self._program(
            self._cost, gradient, rows, high, bounded
        )
        excess, feasible = (0.0, 0.0), flag > 0
        if not feasible:
            unconverged = flag != INFEASIBLE
            w, flag, info = self._program(
                self._soft_cost, gradient, rows, high, bounded
            )
            if flag <= 0:  # the ZMP itself is outside of the feet
                w, flag, info = self._program(
                    self._soft_cost,
                    gradient,
                    rows,
                    np.maximum(high, soon),
                    bounded,
                )
            excess = float(w[-2]), float(w[-1])
            if unconverged and hypot(*excess) < PRECISION:
                excess, feasible = (0.0, 0.0), True
        return MpcResult(
            (float(w[0]), float(w[self._kappa.size])),
            feasible,
            excess,
            int(info["iterations"]),
            perf_counter() - began,
        )

    def _constraints(
        self, plan: ManeuverPlan, passed: float, zmp: Array
    ) -> tuple[Array, Array, Array]:
        """Return the half planes that keep the ZMP in the support polygon.

        Rows and bounds on the velocities, and bounds that admit a ZMP straight
        on its way back. Shapes (m, 2 n), (m,), (m,).
        """
        support = self._support
        if support is None or support.plan is not plan:
            support = self._support = _support(plan)
        delta, span = self.interval, float(self._ends[-1])
        ends = passed + self._ends
        changes = support.starts[1:]
        inside = (changes > passed) & (changes < passed + span)
        # When a foot lands or lifts off, single support is the constraint.
        after = np.nonzero(inside)[0] + 1
        times = np.concatenate([ends, changes[inside]])
        last = np.searchsorted(support.starts, ends, side="right") - 1
        phase = np.concatenate([last, after - ~support.single[after]])
        ahead = times - passed
        shares = np.clip(
            ahead[:, None] - self._ends + delta, 0.0, delta
        )  # time of each sample before each instant
        normals, offsets = support.normals[phase], support.offsets[phase]
        rows = (normals[..., None] * shares[:, None, None, :]).reshape(
            -1, 2 * self._kappa.size
        )
        schedule = plan.schedule
        piece, local = schedule.zmp_map.locate(times)
        local = np.minimum(local, schedule.durations[piece])
        planned = evaluate(support.zmp[:, piece], local)
        room = offsets - self._edge - (normals @ planned[..., None])[..., 0]
        held = (normals @ zmp).ravel()
        room = room.ravel()
        left = np.maximum(1.0 - ahead / delta, 0.0)
        back = np.repeat(left, normals.shape[1]) * held
        keep = np.isfinite(room)
        high = room - held
        soon = np.where(back == 0.0, high, back - held)
        return rows[keep], high[keep], soon[keep]

    def _program(
        self,
        cost: Array,
        gradient: Array,
        rows: Array,
        high: Array,
        bounded: Array,
    ) -> tuple[Array, int, Any]:
        """Solve for the velocities, and for the excess if it has a cost."""
        count, extra = high.size, cost.shape[0] - gradient.size
        matrix = np.zeros((count + 2, cost.shape[0]))
        matrix[:count, : gradient.size] = rows
        matrix[count:, : gradient.size] = self._bounded
        if extra:
            matrix[count:, gradient.size :] = np.eye(2)
        sense = np.zeros(count + 2, dtype=np.int32)
        sense[count:] = EQUALITY
        w, _, flag, info = self._solver.solve(
            cost,
            np.concatenate([gradient, np.zeros(extra)]),
            matrix,
            np.concatenate([high, bounded]),
            np.concatenate([np.full(count, -np.inf), bounded]),
            sense,
        )
        return w, int(flag), info


def _support(plan: ManeuverPlan) -> _Support:
    """Return the half planes of a plan; padding has infinite offsets."""
    phases = plan.support()
    most = max(phase.offsets.size for phase in phases)
    normals = np.zeros((len(phases), most, 2))
    offsets = np.full((len(phases), most), np.inf)
    for i, phase in enumerate(phases):
        normals[i, : phase.offsets.size] = phase.normals
        offsets[i, : phase.offsets.size] = phase.offsets
    return _Support(
        plan,
        np.array([phase.start for phase in phases]),
        np.array([phase.single for phase in phases]),
        normals,
        offsets,
        plan.zmp_coefficients,
    )
