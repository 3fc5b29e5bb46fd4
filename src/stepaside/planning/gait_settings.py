"""Settings of a gait and of its maneuvers (paper, Sec. IV)."""

from dataclasses import dataclass, field, replace
from math import sqrt
from typing import ClassVar, Literal, get_args

from ..core.constants import GRAVITY
from ..core.errors import PlanError, check_within
from ..core.ranges import Range, Ranges, check_settings
from .swing import SwingProfile

# From about a thousandth to a hundred times the values of humanoids.
SMALL = "size of a foot"
WIDE = "beyond, exponentials of the gait overflow a double"


@dataclass(frozen=True, slots=True)
class SoleRectangle:
    """Contact rectangle of the left sole; the right one is its mirror image.

    Attributes:
        back: Rear edge in the foot frame, in [m], negative; -10 to -0.001.
        front: Front edge, in [m]; 0.001 to 10.
        outer: Distance of the outer edge from the foot frame, in [m]; 0.001 to
            10.
        inner: Distance of the inner edge, in [m]; 0.001 to 10.
    """

    back: float = -0.05
    front: float = 0.095
    outer: float = 0.042
    inner: float = 0.035

    ranges: ClassVar[Ranges] = {
        "back": Range(-10.0, -1e-3, "m", SMALL),
        "front": Range(1e-3, 10.0, "m", SMALL),
        "outer": Range(1e-3, 10.0, "m", SMALL),
        "inner": Range(1e-3, 10.0, "m", SMALL),
    }

    def __post_init__(self) -> None:
        """Check that the foot frame lies inside the sole."""
        check_settings(self, PlanError, prefix="sole.")


@dataclass(frozen=True, slots=True)
class GaitSettings:
    r"""Parameters of a gait and of its maneuver planner.

    The defaults are the values of Sec. IV for the NAO, except for the two
    durations, which yield a walk only if they are exchanged, and for those
    that the paper does not give.

    Attributes:
        speed: Driving speed :math:`\bar{v}` of the template, in [m/s]; 0.0001
            to 10.
        gain: Steering gain :math:`k`, in [1/s]; 0.0001 to 100.
        stride: Step size :math:`\Delta` along the trajectory, in [m]; 0.0001
            to 10.
        outer_stride: Longest stride of the outer foot in a turn, in [m], to
            which sharper turns reduce the stride; None for no reduction;
            0.0001 to 10 or none.
        foot_spacing: Coronal distance between the foot frames, in [m]; 0.001
            to 10.
        step_height: Apex of the swing foot, in [m]; 0 to 10.
        single_support: Duration of single support, in [s]; 0.001 to 100.
        double_support: Duration of double support, in [s]; 0.001 to 100.
        start_support: Duration of the first double support when the robot
            starts from standing, in [s]; 0.001 to 100.
        com_height: CoM height :math:`z_{CoM}` over the floor, in [m]; 0.01 to
            10.
        zmp_forward: Sagittal coordinate of the ZMP reference in a foot frame,
            in [m]; -10 to 10.
        zmp_profile: Profile of the ZMP between the feet in double support.
        swing_profile: Profile of the swing foot's motion; see
            :func:`~stepaside.planning.swing.swing_progress`.
        swing_reaction: Shift of the ZMP by an acceleration of the swing foot,
            in [s^2]: 0 for massless legs; see
            :class:`~stepaside.planning.schedule.Schedule`; 0 to 0.1.
        horizon: Number of footsteps in a replanned maneuver, at least 2: the
            last one brings the ZMP midway between the feet, where no next
            plan can begin; 2 to 1000.
        gravity: Gravitational acceleration, in [m/s^2]; 0.01 to 100.
        sole: Shape of the soles.
    """

    speed: float = 0.1
    gain: float = 0.2
    stride: float = 0.04
    outer_stride: float | None = None
    foot_spacing: float = 0.1
    step_height: float = 0.02
    single_support: float = 0.425
    double_support: float = 0.122
    start_support: float = 0.8
    com_height: float = 0.268
    zmp_forward: float = 0.02
    zmp_profile: Literal["linear", "cubic"] = "linear"
    swing_profile: SwingProfile = "minimum-jerk"
    swing_reaction: float = 0.0
    horizon: int = 5
    gravity: float = GRAVITY
    sole: SoleRectangle = field(default_factory=SoleRectangle)

    ranges: ClassVar[Ranges] = {
        "speed": Range(1e-4, 10.0, "m/s", WIDE),
        "gain": Range(1e-4, 100.0, "1/s", WIDE),
        "stride": Range(1e-4, 10.0, "m", WIDE),
        "outer_stride": Range(1e-4, 10.0, "m", WIDE, also=(None,)),
        "foot_spacing": Range(1e-3, 10.0, "m", WIDE),
        "step_height": Range(0.0, 10.0, "m", "0 slides the foot"),
        "single_support": Range(1e-3, 100.0, "s", WIDE),
        "double_support": Range(1e-3, 100.0, "s", WIDE),
        "start_support": Range(1e-3, 100.0, "s", WIDE),
        "com_height": Range(1e-2, 10.0, "m", WIDE),
        "zmp_forward": Range(-10.0, 10.0, "m", "and within the sole"),
        "swing_reaction": Range(0.0, 0.1, "s^2", "about ten times the NAO's"),
        "horizon": Range(
            2,
            1000,
            "steps",
            "a plan of one step ends with the ZMP midway between the feet "
            "and the next one begins with it in a foot",
            whole=True,
        ),
        "gravity": Range(1e-2, 100.0, "m/s^2", WIDE),
    }

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
        if self.zmp_profile not in ("linear", "cubic"):
            raise PlanError(
                "zmp_profile must be 'linear' or 'cubic', "
                f"got {self.zmp_profile!r}"
            )
        if self.outer_stride is not None:
            outer = (self.outer_stride, self.stride, 10.0)
            check_within(*outer, "outer_stride", "m")
        if self.swing_profile not in get_args(SwingProfile):
            raise PlanError(
                "swing_profile must be 'minimum-jerk' or 'even', "
                f"got {self.swing_profile!r}"
            )
        if self.foot_spacing <= 2.0 * self.sole.inner:
            raise PlanError(
                "foot_spacing must exceed twice the sole's inner half-width, "
                f"{2.0 * self.sole.inner:g} [m], or the soles overlap, "
                f"got {self.foot_spacing}"
            )

    @property
    def eta(self) -> float:
        r"""Rate :math:`\eta = \sqrt{g / z_{CoM}}` of the LIP, in [1/s]."""
        return sqrt(self.gravity / self.com_height)

    @property
    def step_duration(self) -> float:
        """Time from one landing to the next, in [s]."""
        return self.single_support + self.double_support

    def at_pace(self, pace: float) -> "GaitSettings":
        """Return the gait with a reduced step rate.

        Args:
            pace: Fraction of the step rate, in (0, 1]. The step height
                decreases with it, linearly to half the height at pace 0.

        Returns:
            Gait with longer supports; the same gait at pace 1.
        """
        if pace == 1.0:
            return self
        return replace(
            self,
            single_support=self.single_support / pace,
            double_support=self.double_support / pace,
            start_support=self.start_support / pace,
            step_height=self.step_height * 0.5 * (1.0 + pace),
        )

    def stride_share(self, turn: float) -> float:
        """Return the fraction of the stride that a turn allows.

        Args:
            turn: Turn of one step, in [rad].

        Returns:
            Fraction in [0.1, 1].
        """
        if self.outer_stride is None:
            return 1.0
        room = self.outer_stride - 0.5 * self.foot_spacing * abs(turn)
        return min(1.0, max(0.1, room / self.stride))

    @property
    def path_interval(self) -> float:
        r"""Path time :math:`\Delta / \bar{v}` between footsteps, in [s]."""
        return self.stride / self.speed


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

STABILISED = frozenset({"fast"})
"""Names of gaits that require feedback on every body."""
