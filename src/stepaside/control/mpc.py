r"""Intrinsically stable MPC on top of a plan (Scianca et al., 2016).

The ZMP velocity is the decision, constant over N samples of length
:math:`\delta`; here it is the velocity w that is added to the plan's, so that
w = 0 is the closed form itself. With d the DCM and z the ZMP, both less the
plan's, the motion stays bounded exactly if

.. math:: \sum_i \kappa_i w_i + \mathrm{tail} = d_0 - z_0, \qquad
   \kappa_i = e^{-i \eta \delta} \frac{1 - e^{-\eta \delta}}{\eta},

where the tail is what is assumed beyond the horizon: the plan's own ZMP
(anticipative: 0), a ZMP that rests (truncated), or one whose velocity repeats
(periodic). The ZMP has to stay in the sole, or, in double support, in a box
that moves from one sole to the next.
"""

from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from ..errors import ConfigurationError
from ..planning import GaitSettings, ManeuverPlan
from ..poses import Array
from .settings import MpcSettings
from .step import zmp_box

EQUALITY = 5  # sense of a constraint in the solver
SLACK = 1e6  # weight of a boundedness that cannot be met


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
        self._solver = _solver()
        self.settings, self._gait, self._edge = settings, gait, edge
        n = settings.steps * settings.samples
        self.interval = delta = gait.step_duration / settings.samples
        eta = gait.eta
        self._times: Array = np.linspace(delta, n * delta, n)
        fade = np.exp(-eta * delta)
        self._kappa = fade ** np.arange(n) * (1.0 - fade) / eta
        self._end = float(fade**n)
        self._sum = delta * np.tri(n)
        cost = np.eye(n) + settings.pull * self._sum.T @ self._sum
        zero = np.zeros((n, n))
        self._cost = np.block([[cost, zero], [zero, cost]])
        self._drift = settings.pull * self._sum.sum(axis=0)
        row, none = self._kappa, np.zeros(n)
        bounded = np.array([[*row, *none], [*none, *row]])
        self._rows = np.vstack([np.zeros((2 * n, 2 * n)), bounded])
        self._sense = np.zeros(2 * n + 2, dtype=np.int32)
        self._sense[-2:] = EQUALITY
        self._soft_cost = np.zeros((2 * n + 2, 2 * n + 2))
        self._soft_cost[: 2 * n, : 2 * n] = self._cost
        self._soft_cost[-2:, -2:] = SLACK * np.eye(2)
        self._model: Any = None

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
        times: Array = passed + self._times
        rows, low, high = self._constraints(plan, times, zmp)
        wanted = self._wanted(plan, passed, dcm, zmp)
        low = np.concatenate([low, wanted])
        high = np.concatenate([high, wanted])
        gradient = np.concatenate([self._drift * zmp[0], self._drift * zmp[1]])
        if self._model is None:
            self._model = self._solver.Model()
            self._model.setup(
                self._cost, gradient, rows, high, low, self._sense
            )
        else:
            self._model.update(f=gradient, A=rows, bupper=high, blower=low)
        w, _, flag, info = self._model.solve()
        excess, feasible = (0.0, 0.0), flag > 0
        if not feasible:
            w, excess, info = self._best(gradient, rows, high, low)
            self._model = None
        n = self._kappa.size
        return MpcResult(
            (float(w[0]), float(w[n])),
            feasible,
            excess,
            int(info["iterations"]),
            perf_counter() - began,
        )

    def _constraints(
        self, plan: ManeuverPlan, times: Array, zmp: Array
    ) -> tuple[Array, Array, Array]:
        """Rows and bounds that keep the ZMP in the feet at given times."""
        n = self._kappa.size
        centre, theta, low, high = support_boxes(plan, times, self._edge)
        planned = plan.sample(times).zmp
        c, s = np.cos(theta), np.sin(theta)
        rows = self._rows
        rows[:n, :n], rows[:n, n:] = (
            c[:, None] * self._sum,
            (s[:, None] * self._sum),
        )
        rows[n : 2 * n, :n] = -s[:, None] * self._sum
        rows[n : 2 * n, n:] = c[:, None] * self._sum
        x, y = (planned + zmp - centre).T
        off = np.concatenate([c * x + s * y, c * y - s * x])
        return rows, low.T.ravel() - off, high.T.ravel() - off

    def _wanted(
        self, plan: ManeuverPlan, passed: float, dcm: Array, zmp: Array
    ) -> Array:
        """Right side of the boundedness. Shape (2,)."""
        wanted: Array = dcm - zmp
        if self.settings.tail == "anticipative":
            return wanted
        span = float(self._times[-1])
        samples = plan.sample([passed, passed + span])
        lead = samples.dcm - samples.zmp
        if self.settings.tail == "truncated":
            wanted = wanted + self._end * lead[1]
            return wanted
        # Velocities that repeat: the horizon's sum over 1 - end.
        inside = lead[0] - self._end * lead[1]
        wanted = (1.0 - self._end) * (wanted + lead[0]) - inside
        return wanted

    def _best(
        self, gradient: Array, rows: Array, high: Array, low: Array
    ) -> tuple[Array, tuple[float, float], Any]:
        """Least unbounded motion, for a DCM that cannot be held."""
        slack = np.zeros((rows.shape[0], 2))
        slack[-2:] = np.eye(2)
        w, _, _, info = self._solver.solve(
            self._soft_cost,
            np.concatenate([gradient, np.zeros(2)]),
            np.hstack([rows, slack]),
            high,
            low,
            self._sense,
        )
        return w, (float(w[-2]), float(w[-1])), info


def support_boxes(
    plan: ManeuverPlan, times: Array, edge: float
) -> tuple[Array, Array, Array, Array]:
    """Boxes that the ZMP has to stay in, in the plan frame.

    Args:
        plan: Plan.
        times: Times since it began, in [s]. Shape (n,).
        edge: Distance kept from the edge of the soles, in [m].

    Returns:
        Centers [m], headings [rad], and lowest and highest shift [m] along
        the heading and to its left. Shapes (n, 2), (n,), (n, 2), (n, 2).
    """
    gait = plan.schedule.settings
    walked = times - (gait.start_support if plan.schedule.standing else 0.0)
    step = np.floor(walked / gait.step_duration)
    step = np.clip(step, 0, plan.schedule.count - 1).astype(int)
    stood = walked - step * gait.step_duration - gait.single_support
    share = np.clip(stood / gait.double_support, 0.0, 1.0)
    theta = plan.placements[:, 2]
    ahead = gait.zmp_forward * np.column_stack([np.cos(theta), np.sin(theta)])
    anchors = plan.placements[:, :2] + ahead
    first = np.array(zmp_box(plan.first_foot, gait, edge))
    second = np.array(zmp_box(plan.first_foot.other, gait, edge))
    even = (step % 2 == 0)[:, None]
    weight = share[:, None]

    def between(now: Array, then: Array) -> Array:
        mixed: Array = now + weight * (then - now)
        return mixed

    low = between(
        np.where(even, first[0], second[0]),
        np.where(even, second[0], first[0]),
    )
    high = between(
        np.where(even, first[1], second[1]),
        np.where(even, second[1], first[1]),
    )
    turned = theta[step + 1] + share * (theta[step + 2] - theta[step + 1])
    return between(anchors[step + 1], anchors[step + 2]), turned, low, high


def _solver() -> Any:
    try:
        import daqp
    except ImportError as error:
        raise ConfigurationError(
            "method 'mpc' needs the solver daqp: install stepaside[mpc]"
        ) from error
    return daqp
