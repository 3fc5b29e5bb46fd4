"""Models of a pursuer, and their fit to its observed motion."""

from math import atan2, hypot
from typing import NamedTuple

from ..core.poses import Pose, wrap_angle
from .search.pursuer_model import BeamRules, PursuerModel, model_turn

MODELS = (
    PursuerModel(),
    PursuerModel(1.5),
    PursuerModel(2.0),
    PursuerModel(3.0),
    PursuerModel(4.0),
    PursuerModel(12.5),
    PursuerModel(1.0, inward=1.0),
    PursuerModel(1.0, lead=0.5),
)
"""Models that are compared: the paper's pursuer with other gains, the last
of them turning by the whole bearing, and pursuers with another target."""
DANGEROUS = (5, 6, 4, 3, 0)  # models to assume until they are ruled out
SETTLING = 2  # steps until the headings are known
MEMORY = 0.9  # weight of the earlier errors after a step
EXACT = 1e-3  # error of a model that counts as none, in [rad] rms; with
# 4e-3 pursuers of gain x3 are told from x4 too late, and capture 13 % sooner
RULED_OUT = 3.0  # times the least error: a model that does not explain
LEAST_MOTION = 0.3  # stride over that of the gait that shows a direction
ASSUMED = 3  # models that are assumed at once
FORGETTING = 0.995  # of the greatest observed speed, per step


class ModelFit(NamedTuple):
    """Errors of every model on the observed motion.

    Attributes:
        time: Time of the last observation, in [s]; negative before it.
        position: Position of the pursuer then, in [m].
        own: Own pose then.
        headings: Heading of the pursuer then by each model, in [rad].
        errors: Forgetting mean of the squared error of each model's
            direction of the next step, in [rad^2].
        speed: Greatest stride that was seen lately, over the own.
        steps: Number of steps that were compared.
    """

    time: float = -1.0
    position: tuple[float, float] = (0.0, 0.0)
    own: Pose = Pose(0.0, 0.0, 0.0)
    headings: tuple[float, ...] = ()
    errors: tuple[float, ...] = (0.0,) * len(MODELS)
    speed: float = 1.0
    steps: int = 0

    def observe(
        self,
        time: float,
        own: Pose,
        position: tuple[float, float],
        rules: BeamRules,
        period: float,
        apart: int = 1,
    ) -> "ModelFit":
        """Compare every model with one more observation.

        Args:
            time: Time of the observation, in [s].
            own: Own pose, with the centre of the room as origin.
            position: Position of the pursuer, likewise, in [m].
            rules: Rules of the steps.
            period: Duration of a step, in [s].
            apart: Number of steps between the observations that are
                compared; 2 for walkers, whose sway repeats every two steps.
        """
        facing = atan2(own.y - position[1], own.x - position[0])
        if self.time < 0.0:
            return ModelFit(time, position, own, (facing,) * len(MODELS))
        if time - self.time < (apart - 0.25) * period:
            return self
        dx = position[0] - self.position[0]
        dy = position[1] - self.position[1]
        stride = hypot(dx, dy) * period / (time - self.time) / rules.stride
        speed = max(1.0, FORGETTING * self.speed, min(stride, 2.0))
        if stride < LEAST_MOTION:
            return self._replace(
                time=time, position=position, own=own, speed=speed
            )
        chord = atan2(dy, dx)
        headings, errors = [], []
        for model, before, error in zip(
            MODELS, self.headings, self.errors, strict=True
        ):
            turn = model_turn(
                (self.own.x, self.own.y, self.own.theta),
                (*self.position, before),
                model,
                rules,
            )
            off = wrap_angle(before + 0.5 * apart * turn - chord)
            if self.steps < SETTLING:  # chords have yet to give the heading
                off = 0.0
            errors.append(MEMORY * error + (1.0 - MEMORY) * off * off)
            headings.append(chord + 0.5 * apart * turn)
        return ModelFit(
            time, position, own, tuple(headings), tuple(errors), speed,
            self.steps + 1,
        )  # fmt: skip

    def plausible(self) -> list[int]:
        """Return the numbers of the models to assume, the best first."""
        least = min(self.errors)
        limit = (RULED_OUT**2) * max(least, EXACT**2)
        best = (
            self.errors.index(least) if self.steps > SETTLING else DANGEROUS[0]
        )
        others = [
            n for n in DANGEROUS if n != best and self.errors[n] <= limit
        ]
        return [best, *others][:ASSUMED]
