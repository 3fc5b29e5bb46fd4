"""Contract of a walking policy: observations, actions and clocks.

Networks of different trainers differ in order and scale of the observed
quantities, in the meaning of their actions and in their clocks. A contract
states them for one network, so that one runtime serves all.
"""

from dataclasses import dataclass
from itertools import accumulate
from math import inf, pi
from typing import Literal, NamedTuple

from ...core.errors import PolicyError
from ...core.ranges import Range
from ...core.setting import REQUIRED, CheckedSettings, check_settings, setting

GAIN = "no motor is stiffer"
NOT_FINITE = (inf,)
HistoryOrder = Literal["term", "frame"]
Standing = Literal["runs", "holds", "silent"]


class ObservationTerm(NamedTuple):
    """One quantity of an observation."""

    name: str  # name of the quantity, a key of :data:`TERMS`
    # factor on each of its values, or one factor for all
    scale: tuple[float, ...] = (1.0,)
    # largest magnitude of a value before scaling; inf for none
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


@dataclass(frozen=True, slots=True)
class PhaseClock(CheckedSettings, error=PolicyError, prefix="clock."):
    """Clock of the gait that a policy observes."""

    period: float = setting(
        REQUIRED,
        "Duration of a gait cycle",
        Range(0.0, 100.0, "s", "above zero", above=True),
    )
    offsets: tuple[float, ...] = setting(
        (0.0, pi),
        "Phase of each foot when the robot starts to walk",
        Range(-100.0, 100.0, "rad", "some turns"),
    )
    standing: Standing = setting(
        "runs",
        "Behaviour while the command is zero: the clock runs; holds all "
        "phases at pi and starts anew with the next command; or is silent: "
        "sine and cosine are zero",
    )
    settling: float = setting(
        0.0,
        "Time for which the clock still runs when the command has become "
        "zero {unit}: the robot steps on the spot before it stands",
        Range(0.0, 100.0, "s", "not negative"),
    )
    spread: float = setting(
        0.0,
        "Largest change of the frequency by the last output of the network "
        "{unit}; 0 for a network without such an output",
        Range(0.0, 100.0, "1/s", "not negative"),
    )


class CommandRanges(NamedTuple):
    """Ranges of the commands that a policy was trained for."""

    # least and greatest velocity ahead [m/s]
    forward: tuple[float, float] = (-1.0, 1.0)
    # least and greatest velocity to the left [m/s]
    lateral: tuple[float, float] = (-1.0, 1.0)
    # least and greatest turning rate [rad/s]
    turn: tuple[float, float] = (-1.0, 1.0)


@dataclass(frozen=True, slots=True)
class PolicyContract:
    r"""Complete contract of a walking policy.

    Joint targets are :math:`q^* = q_0 + s a` with the default posture
    :math:`q_0`, the scale :math:`s` and the action :math:`a`; the body applies
    the torque :math:`k_p (q^* - q) - k_d \dot q`.
    """

    convention: str = setting(
        REQUIRED, "Name of the convention, a file of ``conventions``"
    )
    joints: tuple[str, ...] = setting(
        REQUIRED, "Joints in the order of actions and observations"
    )
    terms: tuple[ObservationTerm, ...] = setting(
        REQUIRED, "Terms of the observation, in order"
    )
    default_posture: tuple[float, ...] = setting(
        REQUIRED,
        "Joint angles at action zero",
        Range(-3.2, 3.2, "rad", "half a turn; more may be in degrees"),
    )
    stiffness: tuple[float, ...] = setting(
        REQUIRED,
        "Gain :math:`k_p` of each joint",
        Range(0.0, 1e6, "N m/rad", GAIN),
    )
    damping: tuple[float, ...] = setting(
        REQUIRED,
        "Gain :math:`k_d` of each joint",
        Range(0.0, 1e6, "N m s/rad", GAIN),
    )
    action_scale: tuple[float, ...] = setting(
        REQUIRED, "Factor on each action [rad]"
    )
    action_clip: float = setting(
        inf,
        "Largest magnitude of an action; inf for none",
        Range(0.0, 1e9, "1", "not negative", also=NOT_FINITE),
    )
    observes_clipped: bool = setting(
        True, "Whether the previous action is observed after clipping"
    )
    action_filter: float = setting(
        0.0,
        "Share of the previous joint targets in the new ones",
        Range(0.0, 0.999, "1", "below 1, at which nothing moves"),
    )
    history: int = setting(
        1,
        "Number of past observations in the input, the present one "
        "included; the oldest is first",
        Range(1, 1000, "1", "the present one", whole=True),
    )
    history_order: HistoryOrder = setting(
        "term",
        "Whether the input holds the history term by term or frame by frame",
    )
    period: float = setting(
        0.02, "Control period", Range(0.0, 0.1, "s", "above zero", above=True)
    )
    clock: PhaseClock | None = setting(
        None, "Clock of the gait; None if the policy observes none"
    )
    command_ranges: CommandRanges = setting(
        CommandRanges(), "Ranges of the commands"
    )
    command_rate: float = setting(
        inf,
        "Largest change of a command, in its unit per second; inf for none",
        Range(0.0, 1e9, "1/s", "above zero", above=True, also=NOT_FINITE),
    )

    def __post_init__(self) -> None:
        """Check entries by themselves, and that they fit together."""
        check_settings(self, PolicyError)
        twice = [x for x in self.joints if self.joints.count(x) > 1]
        if twice:
            raise PolicyError(f"joints must be named once each, got {twice}")
        for axis, (low, high) in self.command_ranges._asdict().items():
            if not low <= 0.0 <= high or low == high:
                raise PolicyError(
                    f"command_ranges.{axis} must ascend and contain 0, got "
                    f"[{low}, {high}]"
                )
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
            if self.clock is None and term.name.endswith("_phase"):
                raise PolicyError(
                    f"observation term {term.name!r} needs a clock"
                )
            if len(term.scale) not in (1, self.width_of(term)):
                raise PolicyError(
                    f"the scale of {term.name!r} must have 1 or "
                    f"{self.width_of(term)} values, got {len(term.scale)}"
                )

    def places(self) -> dict[str, slice]:
        """Return the place of each quantity among all that are observed."""
        joints = len(self.joints)
        phases = 0 if self.clock is None else len(self.clock.offsets)
        velocities = dict.fromkeys(("base_lin_vel", "base_ang_vel"), 3)
        widths = {
            **velocities,
            **{"projected_gravity": 3, "command": 3},
            **dict.fromkeys(("joint_pos", "joint_vel", "actions"), joints),
            **{"sin_phase": phases, "cos_phase": phases, "frequency": 1},
        }
        ends = accumulate(widths.values())
        found = {
            name: slice(end - width, end)
            for (name, width), end in zip(widths.items(), ends, strict=True)
        }
        first = found["command"].start
        found["command_lin_vel"] = slice(first, first + 2)
        return found | {"command_ang_vel": slice(first + 2, first + 3)}

    def width_of(self, term: ObservationTerm) -> int:
        """Return the number of values of a term."""
        place = self.places()[term.name]
        return int(place.stop - place.start)

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
