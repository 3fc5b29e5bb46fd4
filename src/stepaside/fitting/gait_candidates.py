"""Ways to walk that a search tries: a description with a few changes."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from math import hypot, log

from ..games.robot_settings import settings_of
from ..robots.description import RobotDescription
from ..robots.description_file import LEANS
from .derivation import SPACE
from .walk_trials import WAYS, WalkTrial, control_with

# What each change may be, beside what it is; what helped strangers most often
# first.
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
FROM_ZERO = ("feedback", "zmp", "lean", "even")  # no factors
FARTHEST = 0.35  # of a sole's length: a ZMP reference beyond is of no use


@dataclass(frozen=True, slots=True)
class Candidate:
    """Changes to a description.

    Attributes:
        feedback: 1 with feedback, 0 without.
        stiffness: Factor on the gains of all servos.
        times: Factor on the supports.
        stride: Factor on stride and speed.
        spacing: Factor on the distance between the feet.
        zmp: Shift of the ZMP reference ahead, by the sole's length.
        height: Factor on the CoM's height.
        lean: Farther lean of the torso over the foot that stands, in [rad].
        even: 1 for swing feet that go evenly, which twists the other foot
            less; 0 for the smoothest ones.
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
        """What it costs to be farther from the description: small."""
        factors = (self.stiffness, self.times, self.spacing, self.height)
        far = hypot(*(log(factor) for factor in factors), self.zmp, self.lean)
        return 0.02 * far + 0.2 * max(0.0, 1.0 - self.stride)

    def neighbours(self) -> Iterator["Candidate"]:
        """Candidates with one change more, or one undone or other."""
        for name, values in CHOICES.items():
            now = getattr(self, name)
            begin = 0.0 if name in FROM_ZERO else 1.0
            others = (*values, begin) if begin not in values else values
            for value in [each for each in others if each != now]:
                yield replace(self, **{name: value})

    def applied(self, own: RobotDescription) -> RobotDescription | None:
        """Description with the changes; None if they are too much for it."""
        settings = settings_of(own)
        gait, sole = settings.gait, settings.gait.sole
        spacing = self.spacing * gait.foot_spacing
        ahead = gait.zmp_forward + self.zmp * (sole.front - sole.back)
        middle = 0.5 * (sole.front + sole.back)
        if spacing < 2.0 * SPACE * sole.inner and self.spacing < 1.0:
            return None
        if abs(ahead - middle) > FARTHEST * (sole.front - sole.back):
            return None
        if own.lean + self.lean > LEANS:
            return None
        values = {
            "speed": self.stride * gait.speed,
            "stride": self.stride * gait.stride,
            "foot_spacing": spacing,
            "single_support": self.times * gait.single_support,
            "double_support": self.times * gait.double_support,
            "com_height": self.height * gait.com_height,
            "zmp_forward": ahead,
        }
        told: dict[str, float | str] = {
            name: float(f"{v:.4g}") for name, v in values.items()
        }
        if self.even:
            told["swing_profile"] = "even"
        control = control_with(settings.control, bool(self.feedback))
        servos = {
            name: gains._replace(
                stiffness=float(f"{self.stiffness * gains.stiffness:.3g}"),
                damping=float(f"{self.stiffness * gains.damping:.3g}"),
            )
            for name, gains in own.overlay.servos.items()
        }
        return replace(
            own,
            lean=own.lean + self.lean,
            gait=own.gait | told,
            control=own.control
            | {"method": control.method, "feedback": control.feedback},
            overlay=replace(own.overlay, servos=servos)
            if servos
            else own.overlay,
        )

    def trials(self, own: RobotDescription) -> tuple[WalkTrial, ...]:
        """Walks that judge it, the hardest first; none if it is too much."""
        made = self.applied(own)
        if made is None:
            return ()
        settings = settings_of(made)
        return tuple(
            WalkTrial(made, settings.gait, settings.control, way)
            for way in reversed(WAYS)
        )

    def to_json(self) -> dict[str, float]:
        """Plain values by name."""
        return asdict(self)
