"""Settings of a gait and of its maneuvers (paper, Sec. IV)."""

from dataclasses import dataclass
from math import sqrt
from typing import Literal

from ..core.constants import GRAVITY
from ..core.errors import PlanError, check_within
from ..core.ranges import Range
from ..core.setting import CheckedSettings, check_settings, setting

# From about a thousandth to a hundred times the values of humanoids.
SMALL = "size of a foot"
WIDE = "beyond, exponentials of the gait overflow a double"
SwingProfile = Literal["minimum-jerk", "even"]
FAST_STEP = 0.4  # between those of the gaits "fast" and "nao", in [s]


@dataclass(frozen=True, slots=True)
class SoleRectangle(CheckedSettings, error=PlanError, prefix="sole."):
    """Contact rectangle of the left sole; the right one mirrors it."""

    back: float = setting(
        -0.05,
        "Rear edge in the foot frame {unit}, negative",
        Range(-10.0, -1e-3, "m", SMALL),
    )
    front: float = setting(
        0.095, "Front edge in the foot frame", Range(1e-3, 10.0, "m", SMALL)
    )
    outer: float = setting(
        0.042,
        "Distance of the outer edge from the foot frame",
        Range(1e-3, 10.0, "m", SMALL),
    )
    inner: float = setting(
        0.035,
        "Distance of the inner edge from the foot frame",
        Range(1e-3, 10.0, "m", SMALL),
    )


@dataclass(frozen=True, slots=True)
class GaitSettings:
    r"""Parameters of a gait and of its maneuver planner.

    The defaults are the values of Sec. IV for the NAO, except for the two
    durations, which yield a walk only if they are exchanged, and for those
    that the paper does not give.
    """

    speed: float = setting(
        0.1,
        "Driving speed of the template",
        Range(1e-4, 10.0, "m/s", WIDE),
    )
    gain: float = setting(
        0.2,
        "Steering gain k",
        Range(1e-4, 100.0, "1/s", WIDE),
    )
    stride: float = setting(
        0.04,
        "Step size along the path",
        Range(1e-4, 10.0, "m", WIDE),
    )
    outer_stride: float | None = setting(
        None,
        "Longest displacement of the outer foot in a turn {unit}; sharper "
        "turns shorten the stride; none never shortens it",
        Range(1e-4, 10.0, "m", WIDE, also=(None,)),
    )
    foot_spacing: float = setting(
        0.1,
        "Lateral distance between the feet",
        Range(1e-3, 10.0, "m", WIDE),
    )
    step_height: float = setting(
        0.02,
        "Maximum height of the swing foot",
        Range(0.0, 10.0, "m", "0 slides the foot"),
    )
    single_support: float = setting(
        0.425,
        "Duration of single support",
        Range(1e-3, 100.0, "s", WIDE),
    )
    double_support: float = setting(
        0.122,
        "Duration of double support between two steps",
        Range(1e-3, 100.0, "s", WIDE),
    )
    start_support: float = setting(
        0.8,
        "Duration of double support before the first step",
        Range(1e-3, 100.0, "s", WIDE),
    )
    com_height: float = setting(
        0.268,
        "Height of the CoM above the floor",
        Range(1e-2, 10.0, "m", WIDE),
    )
    zmp_forward: float = setting(
        0.02,
        "Forward offset of the ZMP reference from the ankle",
        Range(-10.0, 10.0, "m", "and within the sole"),
    )
    swing_profile: SwingProfile = setting(
        "minimum-jerk",
        "Time profile of the swing foot",
    )
    swing_reaction: float = setting(
        0.0,
        "ZMP shift per acceleration of the swing foot {unit}; 0 for massless "
        "legs",
        Range(0.0, 0.1, "s^2", "about ten times the NAO's"),
    )
    horizon: int = setting(
        5,
        "Footsteps of a maneuver, which is replanned at each step",
        Range(
            2,
            1000,
            "steps",
            "a plan of one step ends with the ZMP midway between the feet "
            "and the next one begins with it in a foot",
            whole=True,
        ),
    )
    sole: SoleRectangle = setting(
        SoleRectangle(),
        "Contact rectangle of the left sole; the right one mirrors it",
    )

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_settings(self, PlanError)
        check_within(
            self.zmp_forward,
            self.sole.back,
            self.sole.front,
            "zmp_forward",
            "m",
        )
        if self.outer_stride is not None:
            outer = (self.outer_stride, self.stride, 10.0)
            check_within(*outer, "outer_stride", "m")
        if self.foot_spacing <= 2.0 * self.sole.inner:
            raise PlanError(
                "foot_spacing must exceed twice the sole's inner half-width, "
                f"{2.0 * self.sole.inner:g} [m], or the soles overlap, "
                f"got {self.foot_spacing}"
            )

    @property
    def eta(self) -> float:
        r"""Rate :math:`\eta = \sqrt{g / z_{CoM}}` of the LIP, in [1/s]."""
        return sqrt(GRAVITY / self.com_height)

    @property
    def step_duration(self) -> float:
        """Time from one landing to the next, in [s]."""
        return self.single_support + self.double_support

    @property
    def is_fast(self) -> bool:
        """Whether steps are too short to walk without feedback.

        Plans then begin at the planned state: the measured one never settles.
        """
        return self.step_duration < FAST_STEP

    def stride_share(self, turn: float) -> float:
        """Return the share of the stride for the turn of a step, [rad]."""
        return stride_share(
            turn, self.stride, self.outer_stride, self.foot_spacing
        )

    @property
    def path_interval(self) -> float:
        r"""Path time :math:`\Delta / \bar{v}` between footsteps, in [s]."""
        return self.stride / self.speed


def stride_share(
    turn: float,
    stride: float,
    outer_stride: float | None,
    foot_spacing: float,
) -> float:
    """Return the fraction of the stride that a turn allows, in [0.1, 1]."""
    if outer_stride is None:
        return 1.0
    room = outer_stride - 0.5 * foot_spacing * abs(turn)
    return min(1.0, max(0.1, room / stride))


PRESETS: dict[str, GaitSettings] = {
    "nao": GaitSettings(),
    "as-printed": GaitSettings(single_support=0.122, double_support=0.425),
    "fast": GaitSettings(
        speed=0.26,
        gain=0.52,
        stride=0.0832,
        outer_stride=0.09,
        step_height=0.016,
        single_support=0.28,
        double_support=0.04,
        start_support=0.16,
        com_height=0.254,
        zmp_forward=0.012,
        swing_profile="even",
        swing_reaction=0.0037,
    ),
}
"""Gaits by name; see ``docs/walking.md``.

The gait "fast" walks the same circle as "nao" in 1/3.6 of the time: speed and
gain are larger by the same factor. Its step takes 0.32 s of both path and gait
time. Its swing reaction is that of the NAO's legs.
"""
