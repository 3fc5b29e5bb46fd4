"""Models of a pursuer, and their fit to its observed motion."""

from math import atan2, hypot
from typing import NamedTuple

import numpy as np

from ..core.poses import Array, Pose, wrap_angle
from .search.step_motion import (
    PursuerModel,
    StepRules,
    fit_heading,
    pair_of,
    pursuer_turn,
)

MODELS = (
    PursuerModel(),
    PursuerModel(1.5),
    PursuerModel(2.0),
    PursuerModel(3.0),
    PursuerModel(4.0),
    PursuerModel(12.5),
    PursuerModel(1.0, pull=1.0),
    PursuerModel(1.0, lead=0.5),
)
"""Models that are compared: the paper's pursuer with other gains, the last
of them turning by the whole bearing, and pursuers with another target."""
DANGEROUS = (6, 3, 0, 5, 4)  # models to search until they are ruled out
SHARPNESS = 5.0  # with which the weight of a model falls with the square of
# its error
MEMORY = 0.93  # weight of the earlier errors after a step
EXACT = 1e-5  # error of a model that counts as none, in [m] rms; with
# 2e-4 pursuers of gain x3 are not told from x4
GAP = 1.5  # steps between observations, beyond which the path begins anew
LEAST_MOTION = 0.3  # stride over that of the gait that shows a direction
ASSUMED = 3  # models that are assumed at once
FORGETTING = 0.995  # of the greatest observed speed, per step


class FitRules(NamedTuple):
    """Rules of the fit, by the errors of the observed positions."""

    window: int  # positions that a model is fitted to
    settling: int  # positions that show an error
    # error over the least, rms, from which on a model does not explain the
    # path
    ruled_out: float


EXACT_SIGHT = FitRules(3, 3, 3.0)
"""Without errors the last steps say most: in longer windows the random turns
of ``noisy`` add up, and it captures 4 of 12 evaders, not 1."""
SWAYING_SIGHT = FitRules(6, 4, 1.2)
"""With 10 positions herding walkers that change their side too early or late
rule out their own model. In walks the true model is within 1.2 times the least
error in 97 % of the steps; with 1.4 herding walkers are told from pure ones so
late that they capture 3 of 10 evaders, not 0."""


class ModelFit(NamedTuple):
    """Fit of every model to the observed motion."""

    time: float = -1.0  # time of the last observation [s]; negative before it
    # own pose, position of the pursuer and time in steps then. (6,)
    seen: Array = np.zeros(6)
    # last observations, a step apart, without sway
    # (:func:`~.search.step_motion.fit_heading`). (n, 6)
    path: Array = np.empty((0, 6))
    # pose of the pursuer at the end of the path by each model
    poses: tuple[tuple[float, float, float], ...] = ()
    # forgetting mean of the mean squared distance of each model from the path
    # [m^2]
    errors: tuple[float, ...] = (0.0,) * len(MODELS)
    speed: float = 1.0  # greatest stride that was seen lately, over the own
    fitting: FitRules = EXACT_SIGHT  # rules of the fit

    def observe(
        self,
        time: float,
        own: Pose,
        position: tuple[float, float],
        rules: StepRules,
        period: float,
        sways: bool = False,
    ) -> "ModelFit":
        """Fit every model to the path with one more observation.

        Poses are relative to the centre of the room; a step takes a period
        [s]. Positions of walking bodies alternate with their sway from step to
        step: then the path is that of the mean of two, half a step earlier.
        """
        passed = time - self.time
        if self.time >= 0.0 and passed < 0.75 * period:
            return self
        follows = self.time >= 0.0 and passed <= GAP * period
        seen = np.array([*own, *position, time / period])
        fitting = SWAYING_SIGHT if sways else EXACT_SIGHT
        now = self._replace(time=time, seen=seen, fitting=fitting)
        point = seen
        if sways:
            point = 0.5 * (self.seen + seen)
            point[2] = own.theta - 0.5 * wrap_angle(own.theta - self.seen[2])
        path = self.path if follows else self.path[:0]
        if not len(path):
            known = follows or not sways
            x, y = (point if known else seen)[3:5].tolist()
            pose = x, y, atan2(own.y - y, own.x - x)
            path = point[None] if known else path
            return now._replace(path=path, poses=(pose,) * len(MODELS))
        if hypot(*(point - path[-1])[3:5]) < LEAST_MOTION * rules.stride:
            return now._replace(path=np.array([*path[:-1], point]))
        kept = path[1 - fitting.window :]
        return now._fitted(np.array([*kept, point]), rules)

    def _fitted(self, path: Array, rules: StepRules) -> "ModelFit":
        """Return the fit to a path with a new point."""
        fits = [fit_heading(path, model, rules) for model in MODELS]
        moved = self._replace(path=path, poses=tuple(pose for pose, _ in fits))
        if len(path) < self.fitting.settling:
            return moved
        errors = (
            MEMORY * error + (1.0 - MEMORY) * found
            for error, (_, found) in zip(self.errors, fits, strict=True)
        )
        dx, dy, steps = np.diff(path[:, 3:], axis=0).T
        speed = float(np.hypot(dx, dy).sum() / steps.sum()) / rules.stride
        return moved._replace(
            errors=tuple(errors),
            speed=max(1.0, FORGETTING * self.speed, min(speed, 2.0)),
        )

    def pose(self, number: int, rules: StepRules, ahead: float) -> Pose:
        """Return the pose of the pursuer by a model, steps after the path."""
        pose = Pose(*self.poses[number])
        if not len(self.path):
            return pose
        both = pair_of(self.path[-1], pose)
        turn = ahead * pursuer_turn(both, MODELS[number], rules)
        return pose.along_arc(ahead * self.speed * rules.stride, turn)

    def weights(self) -> Array:
        """Return the weight of each model, 1 for the best; 0 if ruled out."""
        squares = np.maximum(self.errors, EXACT**2)
        ratios = squares / squares.min()
        weights: Array = np.exp(-SHARPNESS * (ratios - 1.0))
        weights[ratios > self.fitting.ruled_out**2] = 0.0
        return weights

    def plausible(self) -> list[int]:
        """Return the numbers of the models to search, the best first."""
        weights = self.weights()
        seen = max(self.errors) > 0.0
        best = int(weights.argmax()) if seen else DANGEROUS[0]
        others = [n for n in DANGEROUS if n != best and weights[n] > 0.0]
        return [best, *others][:ASSUMED]
