"""Candidates of the gait search: changes to a robot description."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from math import hypot, log

from ..games.robot_settings import settings_from_description
from ..robots.description import LEAN_LIMIT, RobotDescription
from .derivation import LEAST_SPACING
from .walk_trials import PATHS, WalkTrial, control_with

# Values of each change beside its neutral one. The order is that of how often
# a change helped published robots.
CHOICES: dict[str, tuple[float, ...]] = {
    "times": (0.8, 0.65, 1.25),
    "spacing": (0.85, 0.7, 1.12),
    "lean": (0.06, 0.12),
    "feedback": (0.0, 1.0),
    "zmp": (-0.1, 0.1, -0.2),
    "stride": (0.75, 0.5),
    "stiffness": (1.6, 0.6, 2.5),
    "height": (0.98, 0.95),
    "even": (0.0, 1.0),
}
NEUTRAL_ZERO = ("feedback", "zmp", "lean", "even")  # others are factors
# Greatest distance of the ZMP reference from the middle of the sole, by its
# length.
GREATEST_ZMP_SHIFT = 0.35


@dataclass(frozen=True, slots=True)
class Candidate:
    """Changes to a robot description.

    Attributes:
        feedback: 1 with feedback, 0 without.
        stiffness: Factor on the gains of all servos.
        times: Factor on single and double support durations.
        stride: Factor on stride and speed.
        spacing: Factor on the distance between the feet.
        zmp: Forward shift of the ZMP reference, by the length of the sole.
        height: Factor on the CoM height.
        lean: Additional lean of the torso over the stance foot, in [rad].
        even: 1 for swing feet with constant speed, which twist the stance
            foot less; 0 for the smoothest swing profile.
    """

    feedback: float
    stiffness: float = 1.0
    times: float = 1.0
    stride: float = 1.0
    spacing: float = 1.0
    zmp: float = 0.0
    height: float = 1.0
    lean: float = 0.0
    even: float = 0.0

    @property
    def cost(self) -> float:
        """Penalty of the distance from the description; small."""
        factors = (self.stiffness, self.times, self.spacing, self.height)
        distance = hypot(
            *(log(factor) for factor in factors), self.zmp, self.lean
        )
        return 0.02 * distance + 0.2 * max(0.0, 1.0 - self.stride)

    def neighbours(self) -> Iterator["Candidate"]:
        """Yield the candidates that differ in one change."""
        for name, values in CHOICES.items():
            present = getattr(self, name)
            neutral = 0.0 if name in NEUTRAL_ZERO else 1.0
            others = (*values, neutral) if neutral not in values else values
            for value in [each for each in others if each != present]:
                yield replace(self, **{name: value})

    def applied(self, own: RobotDescription) -> RobotDescription | None:
        """Return the changed description; None if it is not feasible.

        Args:
            own: Description without the changes.
        """
        settings = settings_from_description(own)
        gait, sole = settings.gait, settings.gait.sole
        length = sole.front - sole.back
        spacing = self.spacing * gait.foot_spacing
        zmp_forward = gait.zmp_forward + self.zmp * length
        middle = 0.5 * (sole.front + sole.back)
        if spacing < 2.0 * LEAST_SPACING * sole.inner and self.spacing < 1.0:
            return None
        if abs(zmp_forward - middle) > GREATEST_ZMP_SHIFT * length:
            return None
        if own.lean + self.lean > LEAN_LIMIT:
            return None
        values = {
            "speed": self.stride * gait.speed,
            "stride": self.stride * gait.stride,
            "foot_spacing": spacing,
            "single_support": self.times * gait.single_support,
            "double_support": self.times * gait.double_support,
            "com_height": self.height * gait.com_height,
            "zmp_forward": zmp_forward,
        }
        changed: dict[str, float | str] = {
            name: float(f"{v:.4g}") for name, v in values.items()
        }
        if self.even:
            changed["swing_profile"] = "even"
        control = control_with(settings.control, bool(self.feedback))
        servos = {
            name: replace(
                gains,
                stiffness=float(f"{self.stiffness * gains.stiffness:.3g}"),
                damping=float(f"{self.stiffness * gains.damping:.3g}"),
            )
            for name, gains in own.overlay.servos.items()
        }
        return replace(
            own,
            lean=own.lean + self.lean,
            gait=own.gait | changed,
            control=own.control
            | {"method": control.method, "feedback": control.feedback},
            overlay=replace(own.overlay, servos=servos)
            if servos
            else own.overlay,
        )

    def trials(self, own: RobotDescription) -> tuple[WalkTrial, ...]:
        """Return its walk trials, the hardest first; none if not feasible."""
        changed = self.applied(own)
        if changed is None:
            return ()
        settings = settings_from_description(changed)
        return tuple(
            WalkTrial(changed, settings.gait, settings.control, path)
            for path in reversed(PATHS)
        )

    def to_json(self) -> dict[str, float]:
        """Return the changes by name."""
        return asdict(self)
