"""Joint targets of a plan in open loop, with load feedforward."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from ...core.compilation import bound, compiled
from ...core.poses import Array, Pose
from ...perception.measurement import RobotState
from ...planning import CenterState, ManeuverPlan
from ...robots.joint_loads import LegLoads
from ...robots.leg_kinematics import BodyReference, LegKinematics
from ..locomotion import CurrentStep
from .reference_table import ReferenceTable

if TYPE_CHECKING:
    from .mpc import MpcResult
    from .state_estimator import BodyState

STANDING_TICKS = 64  # computed at once
BOUND = 0.03  # of the feedforward, in [rad]: a lost leg reference jumps
Vector = tuple[float, float]
PlanFrom = Callable[[CenterState], ManeuverPlan]
StepAt = Callable[[float], CurrentStep]


class OpenLoop:
    """Joint targets of the plan as it is, on stiff joints.

    Those of a whole step are computed at once, unless a joint limit acts.
    """

    feels = False  # joint angles, IMU or forces on the soles
    state: "BodyState | None" = None  # last estimate
    solved: "MpcResult | None" = None  # at this tick
    adapted = 0  # footsteps moved so far
    commanded: BodyReference | None = None  # if feedback changes it
    ready = True  # to begin to walk
    tilt: Vector | None = None  # roll and pitch of the torso [rad]
    measured_heading: float | None = None  # of the torso in odometry [rad]

    def __init__(
        self,
        kinematics: LegKinematics,
        feedforward: "LoadFeedforward | None" = None,
    ) -> None:
        """Prepare the open loop, with load feedforward if given."""
        self._kinematics, self.feedforward = kinematics, feedforward
        self._references: Array | None = None  # of the computed ticks
        self._targets: list[Array] = []
        self._headings: list[float] = []
        self._used = 0  # number of the computed ticks that were used
        self._index = 0  # of the last tick in the table

    def targets(
        self,
        measurement: RobotState,
        table: ReferenceTable,
        index: int,
        step: StepAt,
    ) -> Array | None:
        """Return the joint targets of a tick of the table, in [rad].

        None after a fall.
        """
        return self.planned_targets(table, index)

    def planned_targets(
        self, table: ReferenceTable, index: int
    ) -> Array | None:
        """Return the same if it needs no measurement; None with feedback."""
        used = self._used
        if (
            used == len(self._targets)
            or index != self._index + 1
            or table.references is not self._references
        ):
            self._compute(table, index)
            used = 0
        self._index, self._used = index, used + 1
        return self._targets[used]

    @property
    def planned_heading(self) -> float:
        """Heading of the torso of the last targets, in [rad]."""
        if not self._headings:
            return self._kinematics.torso_heading
        return self._headings[self._used - 1]

    def _compute(self, table: ReferenceTable, index: int) -> None:
        """Compute the targets from a tick on, up to one out of reach."""
        kinematics, feedforward = self._kinematics, self.feedforward
        if self._used < len(self._targets):
            kinematics.rewind(self._used)
            if feedforward is not None:
                feedforward.rewind(self._used)
        self._references, self._targets, self._used = table.references, [], 0
        last = len(table.references) - 1
        rows = slice(min(index, last), last + 1)
        references, zmp = table.references[rows], table.zmp[rows]
        if last == 0:  # standing
            references = np.repeat(references, STANDING_TICKS, axis=0)
            zmp = np.repeat(zmp, STANDING_TICKS, axis=0)
        states = kinematics.track_rows(references)
        targets, count = states.targets, len(states.targets)
        self._headings = states.torso_headings
        if feedforward is not None:
            targets = targets + feedforward.offset_rows(
                states.rows, references[:count], zmp[:count]
            )
        self._targets = list(targets)

    def land(
        self,
        landed: Pose,
        position: Vector,
        velocity: Vector,
        step: CurrentStep,
    ) -> tuple[Pose, Vector, Vector]:
        """Return what the next plan begins with.

        It is the landed foot in odometry, and CoM and its velocity in the
        frame of that foot, in [m] and [m/s]; here as planned.
        """
        return landed, position, velocity

    def fit(
        self, plan_from: PlanFrom, state: CenterState, support: Pose
    ) -> tuple[ManeuverPlan, CenterState]:
        """Plan from a state in the frame of the support foot, in odometry."""
        return plan_from(state), state


@compiled
def offset_rows(
    soon: Array, offsets: Array, gain: Array, memory: Array
) -> None:
    """Set the offsets of all ticks but the first from it."""
    for i in range(soon.shape[0]):
        for j in range(soon.shape[1]):
            held = memory[j] * offsets[i, j]
            offsets[i + 1, j] = gain[j] * soon[i, j] + held


class LoadFeedforward:
    r"""Joint offsets that compensate the deflection of servos under load.

    A servo of stiffness k deflects by :math:`\tau / k`: in a stance leg of the
    NAO by up to a degree at the hip. Servos that feed the rate of their
    targets forward also add :math:`d / k` times the rate of the offset, with
    damping d. So the offset :math:`\delta` solves :math:`\delta + (d / k)\,
    \dot\delta = \tau / k`, one tick ahead.
    """

    def __init__(
        self, kinematics: LegKinematics, *, zmp_forward: float, tick: float
    ) -> None:
        """Prepare the feedforward of a robot; see :class:`LegLoads`."""
        self.loads = LegLoads(kinematics, zmp_forward=zmp_forward, tick=tick)
        servos = np.array(kinematics.tree.servos, dtype=np.float64)
        stiffness, damping = servos.reshape(-1, 2).T
        stiff = stiffness > 0.0
        self.compliance = np.where(
            stiff, 1.0 / np.where(stiff, stiffness, 1.0), 0
        )  # [rad/(N m)], of each joint
        lead = damping * self.compliance / tick
        # Weights of the deflection and of the last offset in the offset.
        self.gain, self.memory = 1.0 / (1.0 + lead), lead / (1.0 + lead)
        # Before the present tick, then of the last rows.
        self._offsets = np.zeros((1, stiffness.size))
        self._deflections: Array | None = None
        one = self._offsets
        bound(offset_rows, one, one, self.gain, self.memory)  # compiles

    def added(self, reference: BodyReference, zmp: Vector) -> Array:
        """Return the offsets of one tick, in [rad]. Shape (joints,)."""
        torques = self.loads.torques(reference, zmp)
        offsets: Array = self._filtered(torques[None])[0]
        return offsets

    def offset_rows(
        self, states: Array, references: Array, zmp: Array
    ) -> Array:
        """Return the offsets of consecutive ticks. Shape (ticks, joints)."""
        return self._filtered(self.loads.torque_rows(states, references, zmp))

    def rewind(self, ticks: int) -> None:
        """Return to the state after the first ``ticks`` of the last rows."""
        assert self._deflections is not None
        self.loads.rewind(ticks)
        self._offsets = self._offsets[: ticks + 1]
        self._deflections = self._deflections[:ticks]

    def _filtered(self, torques: Array) -> Array:
        """Return the offsets for torques, in [N m]. Shapes (n, joints)."""
        deflections = self.compliance * torques
        last = self._deflections
        before = np.empty_like(deflections)
        before[0] = deflections[0] if last is None else last[-1]
        before[1:] = deflections[:-1]
        soon = 2.0 * deflections - before
        soon.clip(-BOUND, BOUND, out=soon)
        offsets = np.empty((len(soon) + 1, soon.shape[1]))
        offsets[0] = self._offsets[-1]
        offset_rows(soon, offsets, self.gain, self.memory)
        self._offsets, self._deflections = offsets, deflections
        return offsets[1:]
