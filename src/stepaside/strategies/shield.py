"""Shield: a least-restrictive filter around the strategy of a robot.

What is required of each state, and the proof, are in docs/shield.md.
"""

import logging
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import asin, atan2, ceil, cos, hypot, inf, pi, sin, tau
from typing import Any, NamedTuple

import numpy as np

from ..core.poses import Array, Pose, rotate, wrap_angle
from ..planning import Direction
from ..theory.value import (
    ShieldGame,
    ShieldTable,
    solve_shield,
    sub_poses,
)
from ..theory.value.table import cached
from .decision_maker import evaluate_strategy
from .knowledge import ON_THE_SPOT, STAND, Intent, Knowledge, Limits
from .opponent_track import OpponentTrack, SeenOpponent
from .shield_settings import ShieldSettings
from .strategy import Strategy
from .velocity_set import BodyVelocity, greatest_velocity, response_share

LOG = logging.getLogger(__name__)

CELLS = 10  # of the grid of the table in the required distance
CELLS_PER_PERIOD = 6  # passed by the opponent while a motion is held
TURNS = (-1.0, -0.5, 0.0, 0.5, 1.0)  # of a unicycle's step, of the largest
WALK_LOSS = 0.01  # of the paper's walk per step, in [m]; see docs/shield.md
SETTLING = 1.0  # of the paper's walk after its last step, in [s]
SWAY = 0.03  # of a body on the paper's legs, in [m]
LEGS_PERIOD = 0.48  # of the motions of legs: several cells of the grid, [s]
# Per period, in [m]; with it a G1 with 29 joints has a tube of 0.28 m.
LEGS_LOSS = 0.08
LEGS_INTERVAL = 0.08  # between decisions on a body velocity, in [s]
LEGS_DIRECTIONS = 16
UNMEASURED = 0.2  # tube of legs beyond their lag, if not measured, in [m]
SIGHTING_INTERVAL = 0.02  # by which a chord may be longer than a window, [s]
TRACE = 4.0  # windows for which positions of the opponent are kept
KEEPING = 0.005  # value of the last choice before others, in [m]
LEAST_MOTION = 0.002  # between two sightings that show a heading, in [m]
SPACING = 0.25  # of the headings of an opponent who stands, in [rad]

Vector = tuple[float, float]


class ShieldModel(NamedTuple):
    """Robot and person of a shield."""

    limits: Limits
    settings: ShieldSettings
    direction: Direction  # in which a unicycle drives
    saturated: bool  # whether it turns by (6)
    window: float  # between decisions, over which headings are measured [s]
    period: float  # for which a substituted motion is held [s]
    lag: float  # by which the body follows its commands [s]
    response: float  # from the decision to start until the robot moves [s]
    halting: float  # in which a robot that halts takes no decision [s]
    heading_error: float  # greatest error of the opponent's heading [rad]
    # departure of robot and observed person per period [m]
    displacement: float
    required: float  # least distance of the observed states [m]

    def twist(self, intent: Intent) -> tuple[BodyVelocity, float]:
        """Return velocity and duration that an intent commits to."""
        limits, sign = self.limits, float(self.direction.value)
        legs, duration = limits.velocities, limits.step_duration
        if legs is not None:
            if intent.velocity is not None:
                return legs.nearest(intent.velocity), LEGS_INTERVAL
            ahead = sign * intent.speed_factor * limits.speed
            twist = BodyVelocity(ahead, 0.0, limits.gain * intent.heading)
            return legs.nearest(twist), duration
        most = largest_turn(limits, saturated=self.saturated)
        turn = intent.heading * (1.0 if self.saturated else limits.share)
        turn = min(max(turn, -most), most)
        share = min(intent.speed_factor, limits.stride_share(turn))
        ahead = sign * share * limits.stride
        return BodyVelocity(ahead / duration, 0.0, turn / duration), duration

    def choices(self) -> Array:
        """Return the velocities among which the shield chooses. (n, 3).

        Components ahead and to the left, in the frame at the begin, in
        [m/s], and turning rate [rad/s].
        """
        limits, legs = self.limits, self.limits.velocities
        if legs is None:
            most = largest_turn(limits, saturated=self.saturated)
            way = self.direction.value * limits.stride
            steps = [
                (way * min(share, limits.stride_share(turn)), 0.0, turn)
                for share in (1.0, ON_THE_SPOT)
                for turn in most * np.array(TURNS)
            ]
            return np.array(steps) / limits.step_duration
        rate = min(-legs.turn[0], legs.turn[1])
        side = min(-legs.lateral[0], legs.lateral[1])
        symmetric = legs.forward, (-side, side)
        found = [(0.0, 0.0, sign * rate) for sign in (0.0, -1.0, 1.0)]
        for turn in (0.0, -rate, rate):
            turned = turn * self.period * np.array([0.0, 0.5, 1.0])
            for angle in tau / LEGS_DIRECTIONS * np.arange(LEGS_DIRECTIONS):
                speed = min(
                    hypot(*greatest_velocity(angle - part, symmetric))
                    for part in turned
                )
                found.append((speed * cos(angle), speed * sin(angle), turn))
        return np.array(found)

    def game(self) -> ShieldGame:
        """Return the game, with losses per decision.

        Legs hold a velocity over the floor while they turn.
        """
        settings, choices = self.settings, self.choices()
        motions = sub_poses(choices, self.period)
        if self.limits.velocities is not None:
            straight = sub_poses(choices * [1.0, 1.0, 0.0], self.period)
            motions[:, :, :2] = straight[:, :, :2]
        return ShieldGame(
            settings.speed,
            settings.turning_radius,
            motions,
            self.period,
            loss=self.displacement,
            jump=2.0 * settings.sighting_error,
        )

    def table(self) -> ShieldTable:
        """Return the table of the game, solved once and kept."""
        return _table(self)

    def certifies(self, table: ShieldTable) -> bool:
        """Return whether any state is certified by a table of the model."""
        return table.outside >= self.required


def largest_turn(limits: Limits, *, saturated: bool) -> float:
    """Return the largest turn of a step of a unicycle, in [rad]."""
    return limits.share if saturated else pi * limits.share


def shield_model(
    limits: Limits,
    settings: ShieldSettings,
    direction: Direction = Direction.BACKWARD,
    *,
    saturated: bool = False,
) -> ShieldModel:
    """Return the model of a robot, with what docs/shield.md charges."""
    legs, step, speed = limits.velocities, limits.step_duration, settings.speed
    if legs is None:
        longest = min(
            CELLS_PER_PERIOD * settings.contact / CELLS / speed,
            0.5 * settings.turning_radius / speed,
            step / largest_turn(limits, saturated=saturated),  # by a radian
        )
        steps = max(1, round(longest / step))
        window, period, lag = step, steps * step, 0.0
        response, halting = 2.0 * step, step + SETTLING
        loss = WALK_LOSS * steps
        # It is half a stride behind the begin of its next step.
        tube = SWAY + 0.5 * limits.stride
    else:
        window, period = LEGS_INTERVAL, LEGS_PERIOD
        lag = max(0.0, *legs.lags[:2])
        response, halting, loss = 0.0, 0.0, LEGS_LOSS
        fastest = max(*map(abs, legs.forward))
        tube = legs.tube or UNMEASURED + lag * fastest
    if settings.loss is not None:
        loss = settings.loss
    if settings.response is not None:
        response = settings.response
    # Within a window the opponent turns, and both ends of a chord are
    # displaced; a chord of half the greatest length is reckoned with.
    turned = speed / settings.turning_radius * (window + SIGHTING_INTERVAL)
    hidden = min(1.0, 2.0 * settings.sighting_error / (0.5 * speed * window))
    heading_error = min(turned + asin(hidden), pi)
    displacement = loss + speed * period * heading_error
    required = settings.contact + settings.sighting_error + displacement
    required += tube + speed * settings.sighting_delay
    return ShieldModel(
        *(limits, settings, direction, saturated, window, period, lag),
        *(response, halting, heading_error, displacement, required),
    )


@lru_cache(maxsize=8)
def _table(model: ShieldModel) -> ShieldTable:
    """Load or solve the table of a model; warn if it certifies nothing."""
    game, person = model.game(), model.settings
    key = (
        CELLS, person.speed, person.turning_radius, game.period, game.loss,
        game.jump, model.required, model.response, game.motions.tobytes(),
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


class Course(NamedTuple):
    """Heading of an opponent, and how far it may be off."""

    time: float  # time of the last sighting [s]
    heading: float  # heading in the map [rad]
    error: float  # greatest error of the heading [rad]


def observed_course(
    before: Course | None,
    seen: Sequence[SeenOpponent],
    window: float,
    person: tuple[float, float],
    known: float,
) -> Course | None:
    """Return the heading of an opponent after its last sighting.

    The chord between two positions, at least a window [s] apart, is off by at
    most the turn between them, and by the errors of both. The heading follows
    it no faster than the opponent turns (docs/shield.md).

    The person is given by its greatest turning rate [rad/s] and the error of a
    position [m]; errors of a heading up to a bound [rad] count as known. None
    before a window has passed for the first time.
    """
    turn, sighting_error = person
    last = seen[-1]
    turned = turn * max(0.0, last.time - before.time) if before else 0.0
    before_it = last.time - window + 1e-6
    earlier = [row for row in seen if row.time <= before_it]
    if not earlier:
        return before and Course(
            last.time, before.heading, min(pi, before.error + turned)
        )
    time, x, y, _ = earlier[-1]
    chord = hypot(last.x - x, last.y - y)
    error, hidden = pi, 2.0 * sighting_error
    if chord > max(LEAST_MOTION, hidden):
        error = min(pi, turn * (last.time - time) + asin(hidden / chord))
    error = max(error, known)
    direction = atan2(last.y - y, last.x - x)
    if before is None or error < before.error:
        return Course(last.time, direction, error)
    if error > before.error + turned:  # the chord shows less than is known
        return Course(last.time, before.heading, before.error + turned)
    off = wrap_angle(direction - before.heading)
    heading = before.heading + min(max(off, -turned), turned)
    return Course(last.time, heading, error)


class TemplatePoint(NamedTuple):
    """Template point of a body on learned legs, which follows at once.

    A body with a lag comes to rest at its position plus the lag times its
    velocity. The point moves with the commanded velocity, and towards that
    place of rest by no more than a loss per period; so the distance of the
    body from it is bounded: the tube that ``robot legs measure`` finds.
    """

    position: Vector  # its position in the map [m]
    drift: Vector = (0.0, 0.0)  # of the body by its lag [m/s]

    def advance(
        self, command: Vector, body: Vector, lag: float, duration: float
    ) -> "TemplatePoint":
        """Return the point a duration [s] later, at a place of the body."""
        (u, v), share = self.drift, response_share(duration, lag)
        drift = u + share * (command[0] - u), v + share * (command[1] - v)
        x = self.position[0] + duration * command[0]
        y = self.position[1] + duration * command[1]
        dx = body[0] + lag * drift[0] - x
        dy = body[1] + lag * drift[1] - y
        most = LEGS_LOSS * duration / LEGS_PERIOD
        share = min(1.0, most / max(hypot(dx, dy), 1e-12))
        return TemplatePoint((x + share * dx, y + share * dy), drift)


class HeldMotion(NamedTuple):
    """Motion that replaces decisions of the strategy for a while."""

    number: int  # its number in the choices of the model
    heading: float  # heading in the map at which it began [rad]
    until: float  # time [s]; infinite until the robot has started


class ShieldMemory(NamedTuple):
    """Memory of a shield."""

    inner: Any  # memory of the strategy
    track: OpponentTrack | None = None  # positions of the opponent
    course: Course | None = None  # None until a window has passed
    held: HeldMotion | None = None
    time: float = 0.0  # of the last decision [s]
    template: TemplatePoint | None = None  # of legs
    command: Vector = (0.0, 0.0)  # over the floor [m/s]
    guarded: bool = False  # whether contact was excluded at the last decision


@dataclass(frozen=True, slots=True)
class ShieldedStrategy:
    """Any strategy, of which unsafe decisions are replaced.

    A decision stands if no person within the bounds of the settings can come
    within contact while it is carried out, and if the robot can prevent
    contact for ever afterwards; else the motion is taken that guarantees the
    largest distance. Assumptions and proof are in docs/shield.md.
    """

    strategy: Strategy
    shield: ShieldSettings

    @property
    def direction(self) -> Direction:
        """That of the strategy."""
        return self.strategy.direction

    @property
    def saturated(self) -> bool:
        """That of the strategy."""
        return self.strategy.saturated

    def begin(self) -> ShieldMemory:
        """Return the memory before the first sighting."""
        return ShieldMemory(self.strategy.begin())

    def decide(
        self, knowledge: Knowledge, memory: ShieldMemory
    ) -> tuple[Intent, ShieldMemory]:
        """Decide as the strategy does, where that is safe."""
        intent, inner = evaluate_strategy(
            self.strategy, knowledge, memory.inner
        )
        model, person, now = (
            self.model_for(knowledge),
            self.shield,
            knowledge.time,
        )
        own = knowledge.step_start_in_map or knowledge.pose_in_map
        body, template = knowledge.pose_in_map[:2], memory.template
        if template is None:
            template = TemplatePoint(body)
        else:
            passed = max(0.0, now - memory.time)
            template = template.advance(
                memory.command, body, model.lag, passed
            )
        if model.limits.velocities is not None:
            own = Pose(*template.position, own.theta)
        # No decision is taken while the robot halts.
        span = TRACE + model.halting / model.window
        track = memory.track or OpponentTrack(model.window, span, 0.0)
        track = track.note(now - knowledge.age, knowledge.position_in_map)
        course = observed_course(
            memory.course,
            track.rows,
            model.window,
            (person.speed / person.turning_radius, person.sighting_error),
            model.heading_error,
        )
        memory = memory._replace(
            inner=inner,
            track=track,
            course=course,
            template=template,
            time=now,
        )
        intent, memory = self._filter(
            intent, model, own, memory, moving=knowledge.moving
        )
        command = (0.0, 0.0)
        if intent.walks:
            (ahead, left, _), _ = model.twist(intent)
            u, v = rotate(ahead, left, own.theta).tolist()
            command = u, v
        return intent, memory._replace(command=command)

    def model_for(self, knowledge: Knowledge) -> ShieldModel:
        """Return the model of the robot that decides."""
        return shield_model(
            knowledge.limits,
            self.shield,
            self.direction,
            saturated=self.saturated,
        )

    def _filter(
        self,
        intent: Intent,
        model: ShieldModel,
        own: Pose,
        memory: ShieldMemory,
        *,
        moving: bool,
    ) -> tuple[Intent, ShieldMemory]:
        """Return the intent, or that of a motion in its place."""
        table, required, now = model.table(), model.required, memory.time
        course, track = memory.course, memory.track
        if course is None or track is None or not model.certifies(table):
            # Unknown as yet; or contact can be forced from everywhere.
            return intent, memory._replace(held=None, guarded=False)
        seen, known = track.rows[-1], model.heading_error
        poses = relative_poses(own, seen, course, known)
        if intent.walks:
            follow = table.outcomes if moving else table.start_outcomes
            twist, duration = model.twist(intent)
            motion = sub_poses([twist], duration)
            value = float(follow(poses, motion, duration)[0])
        elif moving:
            # While it halts it takes no decision, and the opponent may turn.
            turn = self.shield.speed / self.shield.turning_radius
            unseen = course._replace(
                error=min(pi, course.error + turn * model.halting)
            )
            value = table.halting_value(
                relative_poses(own, seen, unseen, known),
                model.halting,
                model.limits.stride,
            )
        else:
            value = float(table.standing_value(poses).min())
        if value >= required:
            return intent, memory._replace(held=None, guarded=True)
        held, guarded = memory.held, memory.guarded
        if held is not None and held.until == inf:
            # The first step has begun when it was decided, or later; or the
            # robot has not started.
            until = now + model.period - model.window
            held = held._replace(until=until) if moving else None
        if held is None or now > held.until - 1e-6:
            found = table.best_starts(poses)
            if moving:
                found = table.outcomes(poses, table.game.motions, model.period)
            worth, hopeless = found.copy(), found.max() < required
            if held and (hopeless or found[held.number] >= required):
                worth[held.number] += KEEPING
            best = int(np.argmax(worth))
            guarded = bool(found[best] >= required)
            waits = not (moving or intent.walks)  # and can no longer
            if found[best] <= value and not waits:
                return intent, memory._replace(held=None, guarded=False)
            until = now + model.period
            if not moving and model.limits.velocities is None:
                until = inf
            held = HeldMotion(best, own.theta, until)
        return _intent_of(held, model, own), memory._replace(
            held=held, guarded=guarded
        )


def relative_poses(
    own: Pose, seen: SeenOpponent, course: Course, known: float
) -> Array:
    """Return the poses of the robot in the frame of the opponent. (n, 3).

    Several headings of the opponent count if its error is above a bound.
    """
    rows, error = [], course.error
    count = ceil(error / SPACING) if error > known + 1e-9 else 0
    for i in range(-count, count + 1):
        heading = course.heading + error * i / max(count, 1)
        opponent = Pose(seen.x, seen.y, heading)
        x, y, turned = opponent.inverse().compose(own)
        rows.append((x, y, wrap_angle(turned)))
    return np.array(rows)


def _intent_of(held: HeldMotion, model: ShieldModel, own: Pose) -> Intent:
    """Return the intent that carries on with a motion."""
    ahead, left, rate = model.choices()[held.number].tolist()
    limits = model.limits
    if limits.velocities is not None:
        if (ahead, left, rate) == (0.0, 0.0, 0.0):
            return STAND
        u, v = rotate(ahead, left, held.heading - own.theta).tolist()
        return Intent(velocity=BodyVelocity(u, v, rate))
    turn = rate * limits.step_duration
    heading = turn if model.saturated else turn / limits.share
    speed = abs(ahead) * limits.step_duration / limits.stride
    return Intent(min(max(heading, -pi), pi), min(speed, 1.0))
