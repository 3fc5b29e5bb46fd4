"""Robot of the shield: its motions, margins and table, from its limits."""

import logging
from dataclasses import dataclass
from functools import lru_cache
from math import asin, cos, hypot, pi, sin, tau
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..core.poses import Array
from ..planning import Direction
from .knowledge import ON_THE_SPOT, Intent, Limits
from .shield_settings import ShieldSettings
from .table_cache import cached
from .velocity_set import (
    STILL,
    BodyVelocity,
    VelocitySet,
    greatest_velocity,
)

if TYPE_CHECKING:  # the solver imports Numba
    from ..theory.value import ShieldGame, ShieldTable

LOG = logging.getLogger(__name__)

CELLS = 10  # of the grid of the table in the required distance

LEGS_PERIOD = 0.48  # of the motions of legs: several cells of the grid, [s]
# Per period, in [m]; with it a G1 with 29 joints has a tube of 0.28 m.
LEGS_LOSS = 0.08
LEGS_INTERVAL = 0.08  # between decisions on a body velocity, in [s]
LEGS_DIRECTIONS = 16
SIGHTING_INTERVAL = 0.02  # by which a chord may be longer than a window, [s]
WALK_LOSS = 0.01  # of the paper's walk per step, in [m]; see docs/shield.md
SETTLING = 1.0  # of the paper's walk after its last step, in [s]
SWAY = 0.03  # of a body on the paper's legs, in [m]
UNMEASURED = 0.2  # tube of legs beyond their lag, if not measured, in [m]
CELLS_PER_PERIOD = 6  # passed by the opponent while a motion is held
TURNS = (-1.0, -0.5, 0.0, 0.5, 1.0)  # of a unicycle's step, of the largest


class Motion(NamedTuple):
    """Motion to which a robot commits: poses (parts, 3), and duration [s]."""

    poses: Array
    duration: float


@dataclass(frozen=True, slots=True)
class ShieldModel:
    """Robot and person of a shield."""

    limits: Limits  # limits of the gait, or of the legs
    settings: ShieldSettings  # settings of the shield
    direction: Direction  # direction in which a unicycle drives
    saturated: bool  # whether it turns by (6)

    @property
    def velocities(self) -> VelocitySet | None:
        """Velocities of the legs; None for a unicycle."""
        return self.limits.velocities

    @property
    def lag(self) -> float:
        """Time by which the body follows its commands, in [s]."""
        legs = self.velocities
        return 0.0 if legs is None else max(0.0, *legs.lags[:2])

    @property
    def window(self) -> float:
        """Time between decisions, over which headings are measured [s]."""
        legs = self.velocities is not None
        return LEGS_INTERVAL if legs else self.limits.step_duration

    @property
    def heading_error(self) -> float:
        """Greatest error of the opponent's heading, in [rad].

        Within a window it turns, and both ends of a chord are displaced; a
        chord of half the greatest length is reckoned with.
        """
        person = self.settings
        longest = self.window + SIGHTING_INTERVAL
        turned = person.speed / person.turning_radius * longest
        shortest = 0.5 * person.speed * self.window
        hidden = min(1.0, 2.0 * person.sighting_error / shortest)
        return min(turned + asin(hidden), pi)

    @property
    def loss(self) -> float:
        """Departure of the body from its template per period, in [m]."""
        if self.settings.loss is not None:
            return self.settings.loss
        if self.velocities is not None:
            return LEGS_LOSS
        return WALK_LOSS * round(self.period / self.limits.step_duration)

    @property
    def displacement(self) -> float:
        """Departure of robot and observed person per period, in [m]."""
        walked = self.settings.speed * self.period
        return self.loss + walked * self.heading_error

    @property
    def tube(self) -> float:
        """Greatest distance of the body from its template, in [m]."""
        legs = self.velocities
        if legs is None:  # half a stride behind the begin of its next step
            return SWAY + 0.5 * self.limits.stride
        fastest = max(*map(abs, legs.forward))
        return legs.tube or UNMEASURED + self.lag * fastest

    @property
    def response(self) -> float:
        """Time from the decision to start until the robot moves, in [s]."""
        if self.settings.response is not None:
            return self.settings.response
        legs = self.velocities is not None
        return 0.0 if legs else 2.0 * self.limits.step_duration

    @property
    def halting(self) -> float:
        """Time in which a robot that halts takes no decision, in [s]."""
        legs = self.velocities is not None
        return 0.0 if legs else self.limits.step_duration + SETTLING

    @property
    def required(self) -> float:
        """Least distance of the observed states, in [m]; docs/shield.md."""
        settings = self.settings
        return (
            settings.contact
            + settings.sighting_error
            + self.displacement
            + self.tube
            + settings.speed * settings.sighting_delay
        )

    @property
    def turn(self) -> float:
        """Largest turn of a step of a unicycle, in [rad]."""
        share = self.limits.share
        return share if self.saturated else pi * share

    def twist(self, intent: Intent) -> tuple[BodyVelocity, float]:
        """Return velocity and duration that an intent at pace 1 commits to."""
        limits, sign = self.limits, float(self.direction.value)
        if self.velocities is not None:
            if intent.velocity is not None:
                return self.velocities.nearest(intent.velocity), LEGS_INTERVAL
            ahead = sign * intent.speed_factor * limits.speed
            twist = BodyVelocity(ahead, 0.0, limits.gain * intent.heading)
            return self.velocities.nearest(twist), limits.step_duration
        duration = limits.step_duration
        turn = intent.heading * (1.0 if self.saturated else limits.share)
        turn = min(max(turn, -self.turn), self.turn)
        share = min(intent.speed_factor, limits.stride_share(turn))
        ahead = sign * share * limits.stride
        return BodyVelocity(ahead / duration, 0.0, turn / duration), duration

    def motion_of(self, intent: Intent) -> Motion:
        """Return the motion to which an intent commits."""
        from ..theory.value import sub_poses

        if not intent.walks:
            return Motion(sub_poses([STILL], LEGS_INTERVAL)[0], LEGS_INTERVAL)
        twist, duration = self.twist(intent)
        return Motion(sub_poses([twist], duration)[0], duration)

    @property
    def period(self) -> float:
        """Time for which a substituted motion is held, in [s]."""
        if self.velocities is not None:
            return LEGS_PERIOD
        person, step = self.settings, self.limits.step_duration
        longest = min(
            CELLS_PER_PERIOD * person.contact / CELLS / person.speed,
            0.5 * person.turning_radius / person.speed,
            step / self.turn,  # a turn by one radian
        )
        steps = max(1, round(longest / step))
        return steps * self.limits.step_duration

    def choices(self) -> Array:
        """Return the velocities among which the shield chooses.

        Components ahead and to the left, in the frame at the begin, in
        [m/s], and turning rate [rad/s]. Shape (n, 3).
        """
        legs = self.velocities
        if legs is None:
            limits, sign = self.limits, self.direction.value
            steps = [
                (min(most, limits.stride_share(turn)), turn)
                for most in (1.0, ON_THE_SPOT)
                for turn in self.turn * np.array(TURNS)
            ]
            driven = np.zeros((len(steps), 3))
            driven[:, 0] = [s * sign * limits.stride for s, _ in steps]
            driven[:, 2] = [turn for _, turn in steps]
            return driven / limits.step_duration
        rate = min(-legs.turn[0], legs.turn[1])
        side = min(-legs.lateral[0], legs.lateral[1])
        symmetric = legs.forward, (-side, side)
        angles = tau / LEGS_DIRECTIONS * np.arange(LEGS_DIRECTIONS)
        found = [(0.0, 0.0, sign * rate) for sign in (0.0, -1.0, 1.0)]
        for turn in (0.0, -rate, rate):
            turned = turn * self.period * np.array([0.0, 0.5, 1.0])
            for angle in angles:
                speed = min(
                    hypot(*greatest_velocity(angle - part, symmetric))
                    for part in turned
                )
                found.append((speed * cos(angle), speed * sin(angle), turn))
        return np.array(found)

    def motions(self) -> Array:
        """Return the motions of :meth:`choices`. Shape (n, parts, 3).

        Legs hold a velocity over the floor while they turn.
        """
        from ..theory.value import sub_poses

        choices = self.choices()
        if self.velocities is None:
            return sub_poses(choices, self.period)
        straight = sub_poses(choices * [1.0, 1.0, 0.0], self.period)
        straight[:, :, 2] = sub_poses(choices, self.period)[:, :, 2]
        return straight

    def game(self) -> "ShieldGame":
        """Return the game, with losses per decision."""
        from ..theory.value import PersonModel, ShieldGame

        settings = self.settings
        return ShieldGame(
            PersonModel(settings.speed, settings.turning_radius),
            self.motions(),
            self.period,
            loss=self.displacement,
            jump=2.0 * settings.sighting_error,
        )

    def table(self) -> "ShieldTable":
        """Return the table of the game, solved once and kept."""
        return _table(self)

    def certifies(self, table: "ShieldTable") -> bool:
        """Return whether any state is certified by a table of the model."""
        return table.outside >= self.required


@lru_cache(maxsize=8)
def _table(model: ShieldModel) -> "ShieldTable":
    """Load or solve the table of a model; warn if it certifies nothing."""
    from ..theory.value import ShieldTable, solve_shield

    game, person = model.game(), model.settings
    key = (
        CELLS, game.person, game.period, game.loss, game.jump,
        model.required, model.response, game.motions.tobytes(),
    )  # fmt: skip
    arrays = cached(
        "shield",
        key,
        lambda: solve_shield(
            game,
            model.required,
            response=model.response,
            wait=LEGS_INTERVAL,
            cells=CELLS,
        ).arrays(),
    )
    table = ShieldTable.from_arrays(game, arrays)
    if not model.certifies(table):
        LOG.warning(
            "shield: no state is certified against a person at %g m/s with a "
            "turning radius of %g m, contact at %g m; the shield changes "
            "nothing",
            person.speed, person.turning_radius, person.contact,
        )  # fmt: skip
    return table
