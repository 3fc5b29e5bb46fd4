r"""Intrinsically stable MPC on top of a plan (Scianca et al., 2016).

The ZMP velocity is the decision, constant over N samples of length
:math:`\delta`; here it is the velocity w that is added to the plan's, so that
w = 0 is the closed form itself. With d the DCM and z the ZMP, both less the
plan's, the motion stays bounded exactly if

.. math:: \sum_i \kappa_i w_i + \mathrm{tail} = d_0 - z_0, \qquad
   \kappa_i = e^{-i \eta \delta} \frac{1 - e^{-\eta \delta}}{\eta},

where the tail is what is assumed beyond the horizon: the plan's own ZMP
(anticipative: 0), a ZMP that rests (truncated), or one whose velocity repeats
(periodic). The ZMP has to stay under the feet on the floor
(:mod:`stepaside.planning.support_polygon`), at the end of each sample and
whenever a
foot lands or leaves. Between these instants the added ZMP runs straight, and
so does the plan's, but for its correction (27 a / T^2 in curvature, at most
0.06 of its amplitude a between two samples) and for the cubic profile.
"""

from math import hypot
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from ...core.poses import Array
from ...planning import GaitSettings, ManeuverPlan
from ...planning.zmp import evaluate
from .control_settings import MpcSettings
from .qp_solver import load_solver

EQUALITY = 5  # sense of a constraint in the solver
INFEASIBLE = -1  # what it answers; others below 1 mean that it gave up
PRECISION = 1e-6  # an excess below this is none, in [m]
# Weight of a boundedness that cannot be met against the cost of moving the
# ZMP: so large that the excess is the least there is to a micrometre.
SLACK = 1e11


class _Feet(NamedTuple):
    """Support of one plan, each phase with the same number of half planes."""

    plan: ManeuverPlan
    starts: Array
    single: np.ndarray
    normals: Array
    offsets: Array
    zmp: Array


class MpcResult(NamedTuple):
    """Answer of the MPC at one tick, in the plan frame.

    Attributes:
        velocity: ZMP velocity to add to the plan's now, in [m/s].
        feasible: Whether a bounded motion exists with the ZMP in the feet.
        excess: DCM that no ZMP in the feet can hold, in [m]; zero if
            feasible. The velocity is then the best that can be done.
        iterations: Of the solver.
        time: That the answer took, in [s].
    """

    velocity: tuple[float, float]
    feasible: bool
    excess: tuple[float, float]
    iterations: int
    time: float


class IntrinsicallyStableMpc:
    """Solver for the plans of one gait.

    Attributes:
        settings: Horizon and weights.
        interval: Length of a sample, in [s].
    """

    def __init__(
        self, gait: GaitSettings, settings: MpcSettings, *, edge: float
    ) -> None:
        """Precompute what does not depend on the plan.

        Args:
            gait: Gait.
            settings: Horizon and weights.
            edge: Distance that the ZMP keeps from the edge of the sole, [m].

        Raises:
            ConfigurationError: If the solver is not installed.
        """
        self._solver = load_solver()
        self.settings, self._edge = settings, edge
        n = settings.steps * settings.samples
        self.interval = delta = gait.step_duration / settings.samples
        eta = gait.eta
        self._ends: Array = np.linspace(delta, n * delta, n)
        fade = np.exp(-eta * delta)
        self._kappa = fade ** np.arange(n) * (1.0 - fade) / eta
        self._end = float(fade**n)
        total = delta * np.tri(n)
        cost = np.eye(n) + settings.pull * total.T @ total
        none = np.zeros((n, n))
        self._cost = np.block([[cost, none], [none, cost]])
        self._drift = settings.pull * total.sum(axis=0)
        self._bounded = np.kron(np.eye(2), self._kappa)
        self._soft_cost = np.zeros((2 * n + 2, 2 * n + 2))
        self._soft_cost[: 2 * n, : 2 * n] = self._cost
        self._soft_cost[-2:, -2:] = SLACK * np.eye(2)
        self._feet: _Feet | None = None

    def solve(
        self, plan: ManeuverPlan, passed: float, dcm: Array, zmp: Array
    ) -> MpcResult:
        """Answer at one tick.

        Args:
            plan: Plan being walked.
            passed: Time since it began, in [s].
            dcm: DCM less the plan's, in the plan frame, in [m]. Shape (2,).
            zmp: ZMP less the plan's, likewise.
        """
        began = perf_counter()
        rows, high, soon = self._constraints(plan, passed, zmp)
        wanted = self._wanted(plan, passed, dcm, zmp)
        gradient = np.concatenate([self._drift * zmp[0], self._drift * zmp[1]])
        w, flag, info = self._program(self._cost, gradient, rows, high, wanted)
        excess, feasible = (0.0, 0.0), flag > 0
        if not feasible:
            gave_up = flag != INFEASIBLE
            w, flag, info = self._program(
                self._soft_cost, gradient, rows, high, wanted
            )
            if flag <= 0:  # the ZMP itself is where no foot is
                w, flag, info = self._program(
                    self._soft_cost,
                    gradient,
                    rows,
                    np.maximum(high, soon),
                    wanted,
                )
            excess = float(w[-2]), float(w[-1])
            if gave_up and hypot(*excess) < PRECISION:
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
        """Half planes that keep the ZMP under the feet.

        Returns:
            Rows and bounds on the velocities, and what the bounds of the
            first sample have to be for a ZMP that heads straight back to
            the plan's. Shapes (m, 2 n), (m,), (m,).
        """
        feet = self._feet
        if feet is None or feet.plan is not plan:
            feet = self._feet = _feet(plan)
        delta, span = self.interval, float(self._ends[-1])
        ends = passed + self._ends
        changes = feet.starts[1:]
        inside = (changes > passed) & (changes < passed + span)
        # When a foot lands or leaves, the phase of the one foot decides.
        after = np.nonzero(inside)[0] + 1
        times = np.concatenate([ends, changes[inside]])
        last = np.searchsorted(feet.starts, ends, side="right") - 1
        phase = np.concatenate([last, after - ~feet.single[after]])
        ahead = times - passed
        shares = np.clip(
            ahead[:, None] - self._ends + delta, 0.0, delta
        )  # time of each sample before each instant
        normals, offsets = feet.normals[phase], feet.offsets[phase]
        rows = (normals[..., None] * shares[:, None, None, :]).reshape(
            -1, 2 * self._kappa.size
        )
        schedule = plan.schedule
        piece, local = schedule.zmp_map.locate(times)
        local = np.minimum(local, schedule.durations[piece])
        planned = evaluate(feet.zmp[:, piece], local)
        room = offsets - self._edge - (normals @ planned[..., None])[..., 0]
        held = (normals @ zmp).ravel()
        room = room.ravel()
        left = np.maximum(1.0 - ahead / delta, 0.0)
        back = np.repeat(left, normals.shape[1]) * held
        keep = np.isfinite(room)
        high = room - held
        soon = np.where(back == 0.0, high, back - held)
        return rows[keep], high[keep], soon[keep]

    def _wanted(
        self, plan: ManeuverPlan, passed: float, dcm: Array, zmp: Array
    ) -> Array:
        """Right side of the boundedness. Shape (2,)."""
        wanted: Array = dcm - zmp
        if self.settings.tail == "anticipative":
            return wanted
        span = float(self._ends[-1])
        samples = plan.sample([passed, passed + span])
        lead = samples.dcm - samples.zmp
        if self.settings.tail == "truncated":
            wanted = wanted + self._end * lead[1]
            return wanted
        # Velocities that repeat: the horizon's sum over 1 - end.
        inside = lead[0] - self._end * lead[1]
        wanted = (1.0 - self._end) * (wanted + lead[0]) - inside
        return wanted

    def _program(
        self,
        cost: Array,
        gradient: Array,
        rows: Array,
        high: Array,
        wanted: Array,
    ) -> tuple[Array, int, Any]:
        """Solve for the velocities, and for the excess if the cost has it."""
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
            np.concatenate([high, wanted]),
            np.concatenate([np.full(count, -np.inf), wanted]),
            sense,
        )
        return w, int(flag), info


def _feet(plan: ManeuverPlan) -> _Feet:
    """Half planes of a plan; what a phase lacks of them is infinite."""
    phases = plan.support()
    most = max(phase.offsets.size for phase in phases)
    normals = np.zeros((len(phases), most, 2))
    offsets = np.full((len(phases), most), np.inf)
    for i, phase in enumerate(phases):
        normals[i, : phase.offsets.size] = phase.normals
        offsets[i, : phase.offsets.size] = phase.offsets
    return _Feet(
        plan,
        np.array([phase.start for phase in phases]),
        np.array([phase.single for phase in phases]),
        normals,
        offsets,
        plan.zmp_coefficients,
    )
