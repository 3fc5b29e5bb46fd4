"""Contract of a walking policy: observations, actions and clocks.

Networks of different trainers differ in order and scale of the observed
quantities, in the meaning of their actions and in their clocks. A contract
states them for one network, so that one runtime serves all.
"""

from dataclasses import dataclass
from math import inf, pi
from typing import Literal, NamedTuple, get_args

from ...core.errors import PolicyError

HistoryOrder = Literal["term", "frame"]
Standing = Literal["runs", "holds", "silent"]


class ObservationTerm(NamedTuple):
    """One quantity of an observation.

    Attributes:
        name: Name of the quantity, a key of :data:`TERMS`.
        scale: Factor on each of its values, or one factor for all.
        clip: Largest magnitude of a value before scaling; inf for none.
    """

    name: str
    scale: tuple[float, ...] = (1.0,)
    clip: float = inf


TERMS = {
    "base_lin_vel": "velocity of the torso in its frame [m/s]",
    "base_ang_vel": "angular velocity of the torso in its frame [rad/s]",
    "projected_gravity": "unit vector of gravity in the torso frame",
    "command": "commanded vx, vy [m/s] and turning rate [rad/s]",
    "command_lin_vel": "commanded vx, vy [m/s]",
    "command_ang_vel": "commanded turning rate [rad/s]",
    "joint_pos": "joint angles relative to the default posture [rad]",
    "joint_vel": "joint velocities [rad/s]",
    "actions": "previous action",
    "sin_phase": "sine of each phase of the clock",
    "cos_phase": "cosine of each phase of the clock",
    "frequency": "previous output for the frequency of the clock [1/s]",
}
"""Quantities that an observation may contain, by name."""

WIDTHS = {"command_lin_vel": 2, "command_ang_vel": 1, "frequency": 1}
OF_JOINTS = frozenset({"joint_pos", "joint_vel", "actions"})
OF_CLOCK = frozenset({"sin_phase", "cos_phase"})


@dataclass(frozen=True, slots=True)
class PhaseClock:
    """Clock of the gait that a policy observes.

    Attributes:
        period: Duration of a gait cycle, in [s].
        offsets: Phase of each foot when the robot starts to walk, in [rad].
        standing: Behaviour while the command is zero: the clock "runs",
            "holds" all phases at pi and starts anew with the next command,
            or is "silent": sine and cosine are zero.
        settling: Time for which the clock still runs when the command has
            become zero, in [s]: the robot steps on the spot before it stands.
        spread: Largest change of the frequency by the last output of the
            network, in [1/s]; 0 for a network without such an output.
    """

    period: float
    offsets: tuple[float, ...] = (0.0, pi)
    standing: Standing = "runs"
    settling: float = 0.0
    spread: float = 0.0


class CommandRanges(NamedTuple):
    """Ranges of the commands that a policy was trained for.

    Attributes:
        forward: Least and greatest velocity ahead, in [m/s].
        lateral: Least and greatest velocity to the left, in [m/s].
        turn: Least and greatest turning rate, in [rad/s].
    """

    forward: tuple[float, float] = (-1.0, 1.0)
    lateral: tuple[float, float] = (-1.0, 1.0)
    turn: tuple[float, float] = (-1.0, 1.0)


@dataclass(frozen=True, slots=True)
class PolicyContract:
    r"""Complete contract of a walking policy.

    Joint targets are :math:`q^* = q_0 + s a` with the default posture
    :math:`q_0`, the scale :math:`s` and the action :math:`a`; the body applies
    the torque :math:`k_p (q^* - q) - k_d \dot q`.

    Attributes:
        convention: Name of the convention, a file of ``conventions``.
        joints: Joints in the order of actions and observations.
        terms: Terms of the observation, in order.
        default_posture: Joint angles at action zero, in [rad].
        stiffness: Gain :math:`k_p` of each joint, in [N m/rad].
        damping: Gain :math:`k_d` of each joint, in [N m s/rad].
        action_scale: Factor on each action, in [rad].
        action_clip: Largest magnitude of an action; inf for none.
        observes_clipped: Whether the previous action is observed after
            clipping.
        action_filter: Share of the previous joint targets in the new ones, in
            [0, 1).
        history: Number of past observations in the input, the present one
            included; the oldest is first.
        history_order: Whether the input holds the history term by term or
            frame by frame.
        period: Control period, in [s].
        clock: Clock of the gait; None if the policy observes none.
        command_ranges: Ranges of the commands.
        command_rate: Largest change of a command, in its unit per second;
            inf for none.
    """

    convention: str
    joints: tuple[str, ...]
    terms: tuple[ObservationTerm, ...]
    default_posture: tuple[float, ...]
    stiffness: tuple[float, ...]
    damping: tuple[float, ...]
    action_scale: tuple[float, ...]
    action_clip: float = inf
    observes_clipped: bool = True
    action_filter: float = 0.0
    history: int = 1
    history_order: HistoryOrder = "term"
    period: float = 0.02
    clock: PhaseClock | None = None
    command_ranges: CommandRanges = CommandRanges()
    command_rate: float = inf

    def __post_init__(self) -> None:
        """Check names, numbers and ranges of entries.

        Raises:
            PolicyError: If a term is unknown, an entry does not fit the
                number of joints, or a value is out of its range.
        """
        self._check_ranges()
        for name in PER_JOINT:
            given = len(getattr(self, name))
            if given != len(self.joints):
                raise PolicyError(
                    f"{name} must have one value for each of the "
                    f"{len(self.joints)} joints, got {given}"
                )
        for term in self.terms:
            if term.name not in TERMS:
                raise PolicyError(
                    f"unknown observation term {term.name!r}; there are "
                    f"{', '.join(TERMS)}"
                )
            if term.name in OF_CLOCK and self.clock is None:
                raise PolicyError(
                    f"observation term {term.name!r} needs a clock"
                )
            if len(term.scale) not in (1, self.width_of(term)):
                raise PolicyError(
                    f"the scale of {term.name!r} must have 1 or "
                    f"{self.width_of(term)} values, got {len(term.scale)}"
                )

    def _check_ranges(self) -> None:
        """Check values by themselves."""
        orders, standings = get_args(HistoryOrder), get_args(Standing)
        clock = self.clock or PhaseClock(1.0)
        settling, spread = clock.settling, clock.spread
        share, rate = self.action_filter, self.command_rate
        twice = [x for x in self.joints if self.joints.count(x) > 1]
        rules = [
            ("joints", twice, not twice, "be named once each"),
            ("history", self.history, self.history >= 1, "be >= 1"),
            ("period", self.period, self.period > 0.0, "be > 0 [s]"),
            ("action_filter", share, 0.0 <= share < 1.0, "lie in [0, 1)"),
            ("command_rate", rate, rate > 0.0, "be > 0 [1/s]"),
            ("clock.period", clock.period, clock.period > 0.0, "be > 0 [s]"),
            ("clock.settling", settling, settling >= 0.0, "be >= 0 [s]"),
            ("clock.spread", spread, spread >= 0.0, "be >= 0 [1/s]"),
        ]
        for name, word, words in (
            ("history_order", self.history_order, orders),
            ("clock.standing", clock.standing, standings),
        ):
            rule = f"be one of {', '.join(words)}"
            rules.append((name, word, word in words, rule))
        for axis, limits in self.command_ranges._asdict().items():
            low, high = limits
            holds = low <= 0.0 <= high and low < high
            name = f"command_ranges.{axis}"
            rules.append((name, limits, holds, "ascend and contain 0"))
        for name in ("stiffness", "damping"):
            least = min(getattr(self, name), default=0.0)
            rules.append((name, least, least >= 0.0, "be >= 0"))
        for name, value, holds, rule in rules:
            if not holds:
                raise PolicyError(f"{name} must {rule}, got {value}")

    def width_of(self, term: ObservationTerm) -> int:
        """Return the number of values of a term."""
        if term.name in OF_JOINTS:
            return len(self.joints)
        if term.name in OF_CLOCK:
            return 0 if self.clock is None else len(self.clock.offsets)
        return WIDTHS.get(term.name, 3)

    @property
    def action_width(self) -> int:
        """Number of values of the output."""
        changes_clock = self.clock is not None and self.clock.spread > 0.0
        return len(self.joints) + changes_clock

    @property
    def observation_width(self) -> int:
        """Number of values of the whole input, its history included."""
        return self.history * sum(self.width_of(term) for term in self.terms)


PER_JOINT = ("default_posture", "stiffness", "damping", "action_scale")
"""Fields of a contract with one value for each joint."""
