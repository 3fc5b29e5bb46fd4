"""Settings of a gait and of the maneuvers walked with it (paper, Sec. IV)."""

from dataclasses import dataclass, field
from math import sqrt
from typing import Literal

from ..constants import GRAVITY
from ..errors import (
    PlanError,
    check_not_negative,
    check_positive,
    check_within,
)


@dataclass(frozen=True, slots=True)
class Sole:
    """Rectangle that a left sole can press on; the right one mirrors it.

    Attributes:
        back: Rear edge in the foot frame, in [m], negative.
        front: Front edge, in [m].
        outer: Distance of the outer edge from the foot frame, in [m].
        inner: Distance of the inner edge, in [m].
    """

    back: float = -0.05
    front: float = 0.095
    outer: float = 0.042
    inner: float = 0.035

    def __post_init__(self) -> None:
        """Check that the foot frame lies inside."""
        check_positive(-self.back, "minus sole.back", "m")
        check_positive(self.front, "sole.front", "m")
        check_positive(self.outer, "sole.outer", "m")
        check_positive(self.inner, "sole.inner", "m")


@dataclass(frozen=True, slots=True)
class GaitSettings:
    r"""Everything that a maneuver planner has to be told once.

    The defaults are the values of Sec. IV for the NAO, but for the two
    durations, which only walk when they are exchanged, and for what the
    paper does not give.

    Every number has a range, of :data:`RANGES`, in which a gait can be
    computed.

    Attributes:
        speed: Driving speed :math:`\bar{v}` of the template, in [m/s].
        gain: Steering gain :math:`k`, in [1/s].
        stride: Step size :math:`\Delta` along the trajectory, in [m].
        foot_spacing: Coronal distance between the foot frames, in [m].
        step_height: Apex of the swing foot, in [m].
        single_support: Duration of single support, in [s].
        double_support: Duration of double support, in [s].
        start_support: Duration of the first double support when the robot
            starts from standing, in [s].
        com_height: Height :math:`z_{CoM}` over the floor, in [m].
        zmp_forward: Sagittal place of the ZMP reference in a foot frame,
            in [m].
        zmp_profile: ZMP between two feet in double support.
        horizon: Footsteps in a replanned maneuver, at least 2: the last
            one brings the ZMP midway between the feet, where no next plan
            can begin.
        gravity: Gravitational acceleration, in [m/s^2].
        sole: Shape of the soles.
    """

    speed: float = 0.1
    gain: float = 0.2
    stride: float = 0.04
    foot_spacing: float = 0.1
    step_height: float = 0.02
    single_support: float = 0.425
    double_support: float = 0.122
    start_support: float = 0.8
    com_height: float = 0.268
    zmp_forward: float = 0.02
    zmp_profile: Literal["linear", "cubic"] = "linear"
    horizon: int = 5
    gravity: float = GRAVITY
    sole: Sole = field(default_factory=Sole)

    def __post_init__(self) -> None:
        """Refuse values that no plan can satisfy."""
        for name, (low, high, unit) in RANGES.items():
            value = getattr(self, name)
            check_positive(value, name, unit)
            check_within(value, low, high, name, unit)
        check_not_negative(self.step_height, "step_height", "m")
        check_within(self.step_height, 0.0, 10.0, "step_height", "m")
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
        if not isinstance(self.horizon, int) or not 2 <= self.horizon <= 1000:
            raise PlanError(
                "horizon must be 2 to 1000 [steps], for a plan of one step "
                "ends with the ZMP midway between the feet and the next one "
                f"begins with it in a foot, got {self.horizon}"
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

    @property
    def path_interval(self) -> float:
        r"""Path time :math:`\Delta / \bar{v}` between footsteps, in [s]."""
        return self.stride / self.speed


# From a thousandth of what a humanoid does to some hundred times it: beyond,
# exponentials of a gait leave the numbers that a computer has.
RANGES = {
    "speed": (1e-4, 10.0, "m/s"),
    "gain": (1e-4, 100.0, "1/s"),
    "stride": (1e-4, 10.0, "m"),
    "foot_spacing": (1e-3, 10.0, "m"),
    "single_support": (1e-3, 100.0, "s"),
    "double_support": (1e-3, 100.0, "s"),
    "start_support": (1e-3, 100.0, "s"),
    "com_height": (1e-2, 10.0, "m"),
    "gravity": (1e-2, 100.0, "m/s^2"),
}

PRESETS: dict[str, GaitSettings] = {
    "nao": GaitSettings(),
    "as-printed": GaitSettings(single_support=0.122, double_support=0.425),
}
