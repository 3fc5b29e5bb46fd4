"""Shield: a least-restrictive filter around the strategy of a robot."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import asin, atan2, ceil, hypot, inf, pi
from typing import Any, NamedTuple

import numpy as np

from ..core.errors import StrategyError
from ..core.poses import Array, Pose, rotate, wrap_angle
from ..planning import Direction
from .knowledge import STAND, Intent, Knowledge
from .opponent_track import OpponentTrack, SeenOpponent
from .shield_model import LEGS_LOSS, LEGS_PERIOD, ShieldModel
from .shield_settings import ShieldSettings
from .strategy import Strategy, unicycle_intent
from .velocity_set import BodyVelocity, response_share

TRACE = 4.0  # windows for which positions of the opponent are kept
KEEPING = 0.005  # value of the last choice before others, in [m]
LEAST_MOTION = 0.002  # between two sightings that show a heading, in [m]
SPACING = 0.25  # of the headings of an opponent who stands, in [rad]

Vector = tuple[float, float]


class Course(NamedTuple):
    """Heading of an opponent, and how far it may be off."""

    time: float  # time of the last sighting [s]
    heading: float  # heading in the map [rad]
    error: float  # greatest error of the heading [rad]

    def headings(self, known: float) -> list[float]:
        """Return the heading, and others if its error is above a bound."""
        if self.error <= known + 1e-9:
            return [self.heading]
        count = ceil(self.error / SPACING)
        return [
            self.heading + self.error * i / count
            for i in range(-count, count + 1)
        ]


def observed_course(
    before: Course | None,
    seen: Sequence[SeenOpponent],
    window: float,
    person: tuple[float, float],
    known: float,
) -> Course | None:
    """Return the heading of an opponent after its last sighting.

    The direction of the chord between two positions, at least a window [s]
    apart, is off by at most the turn between them, and by the errors of both.
    The heading follows it no faster than the opponent turns: then it turns as
    the opponent may, and stays within the error of the chord.

    The person is given by its greatest turning rate [rad/s] and the error of a
    position [m]; errors of a heading up to a bound [rad] count as known. None
    before a window has passed for the first time.
    """
    turn, sighting_error = person
    last = seen[-1]
    turned = (
        0.0 if before is None else turn * max(0.0, last.time - before.time)
    )
    before_it = last.time - window + 1e-6
    earlier = [row for row in seen if row.time <= before_it]
    if not earlier:
        if before is None:
            return None
        return Course(
            last.time, before.heading, min(pi, before.error + turned)
        )
    time, x, y, _ = earlier[-1]
    chord = hypot(last.x - x, last.y - y)
    error, hidden = pi, 2.0 * sighting_error
    if chord > max(LEAST_MOTION, hidden):
        error = min(pi, turn * (last.time - time) + asin(hidden / chord))
    error = max(error, known)
    direction = atan2(last.y - y, last.x - x)
    if before is None:
        return Course(last.time, direction, error)
    if error > before.error + turned:  # the chord shows less than is known
        return Course(last.time, before.heading, before.error + turned)
    off = wrap_angle(direction - before.heading)
    if error < before.error:
        return Course(last.time, direction, error)
    heading = before.heading + min(max(off, -turned), turned)
    return Course(last.time, heading, error)


class TemplatePoint(NamedTuple):
    """Template point of a body on learned legs, which follows at once.

    A body that follows commands with a lag comes to rest at its position
    plus the lag times its velocity. The point moves with the commanded
    velocity, and towards that place of rest by no more than a loss per
    period; so the distance of the body from it is bounded: the tube that
    ``robot legs measure`` finds.
    """

    position: Vector  # its position in the map [m]
    drift: Vector = (0.0, 0.0)  # of the body by its lag [m/s]

    def advance(
        self, command: Vector, body: Vector, lag: float, duration: float
    ) -> "TemplatePoint":
        """Return the point a duration [s] later, at a position of the body.

        The velocity over the floor is commanded, and legs lag by ``lag``.
        """
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
    held: HeldMotion | None = None  # None for none
    time: float = 0.0  # time of the last decision [s]
    template: TemplatePoint | None = None  # of legs; None before
    command: tuple[float, float] = (0.0, 0.0)  # over the floor [m/s]
    replaced: int = 0  # number of decisions that were replaced
    guarded: bool = False  # whether contact was excluded at the last decision


@dataclass(frozen=True, slots=True)
class ShieldedStrategy:
    """Any strategy, of which unsafe decisions are replaced.

    A decision stands if no person within the bounds of the settings can come
    within contact while it is carried out, and if the robot can prevent
    contact for ever afterwards; else the motion is taken that guarantees the
    largest distance. A robot that stands must start where standing for its
    response time is no longer safe. Assumptions and proof are in
    docs/shield.md.
    """

    strategy: Strategy  # the strategy
    shield: ShieldSettings  # settings of the shield

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
        decided = self.strategy.decide(knowledge, memory.inner)
        if not (isinstance(decided, tuple) and isinstance(decided[0], Intent)):
            raise StrategyError(f"decide must return an Intent, got {decided}")
        intent, inner = decided
        intent = replace(intent, pace=1.0)  # walkers change theirs slowly
        model = self.model_for(knowledge)
        own = knowledge.step_start_in_map or knowledge.pose_in_map
        theta, body = own.theta, knowledge.pose_in_map[:2]
        template = memory.template
        if template is None:
            template = TemplatePoint(body)
        else:
            passed = max(0.0, knowledge.time - memory.time)
            template = template.advance(
                memory.command, body, model.lag, passed
            )
        if model.velocities is not None:
            own = Pose(*template.position, theta)
        # No decision is taken while the robot halts.
        span = TRACE + model.halting / model.window
        track = memory.track or OpponentTrack(model.window, span, 0.0)
        track = track.note(
            knowledge.time - knowledge.age, knowledge.position_in_map
        )
        person = self.shield
        memory = memory._replace(
            inner=inner,
            track=track,
            course=observed_course(
                memory.course,
                track.rows,
                model.window,
                (person.speed / person.turning_radius, person.sighting_error),
                model.heading_error,
            ),
            template=template,
            time=knowledge.time,
        )
        if intent.walks and intent.velocity and not model.velocities:
            # The nearest intent of a unicycle is what it will walk.
            intent = unicycle_intent(intent, knowledge.limits, self.direction)
        intent, memory = self._filter(intent, model, own, knowledge, memory)
        command = (0.0, 0.0)
        if intent.walks:
            twist, _ = model.twist(intent)
            u, v = rotate(twist.forward, twist.lateral, theta).tolist()
            command = u, v
        return intent, memory._replace(command=command)

    def model_for(self, knowledge: Knowledge) -> ShieldModel:
        """Return the model of the robot that decides."""
        return ShieldModel(
            knowledge.limits, self.shield, self.direction, self.saturated
        )

    def _filter(
        self,
        intent: Intent,
        model: ShieldModel,
        own: Pose,
        knowledge: Knowledge,
        memory: ShieldMemory,
    ) -> tuple[Intent, ShieldMemory]:
        """Return the intent, or that of a motion in its place."""
        table, required = model.table(), model.required
        course, track = memory.course, memory.track
        if course is None or track is None or not model.certifies(table):
            # Unknown as yet; or contact can be forced from everywhere.
            return intent, memory._replace(held=None, guarded=False)
        poses = relative_poses(own, track.rows[-1], course, model)
        moving = knowledge.moving
        if intent.walks:
            follow = table.outcomes if moving else table.start_outcomes
            motion, duration = model.motion_of(intent)
            value = float(follow(poses, motion[None], duration)[0])
        elif moving:
            # While it halts it takes no decision, and the opponent may turn.
            turn = self.shield.speed / self.shield.turning_radius
            unseen = course._replace(
                error=min(pi, course.error + turn * model.halting)
            )
            value = table.halting_value(
                relative_poses(own, track.rows[-1], unseen, model),
                model.halting,
                model.limits.stride,
            )
        else:
            value = float(table.standing_value(poses).min())
        if value >= required:
            return intent, memory._replace(held=None, guarded=True)
        held, now = memory.held, knowledge.time
        guarded = memory.guarded
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
            if not moving and model.velocities is None:
                until = inf
            held = HeldMotion(best, own.theta, until)
        return _intent_of(held, model, own), memory._replace(
            held=held, replaced=memory.replaced + 1, guarded=guarded
        )


def shielded(strategy: Strategy, settings: ShieldSettings) -> Strategy:
    """Return a strategy, within a shield if the settings enable one."""
    if not settings.enabled:
        return strategy
    return ShieldedStrategy(strategy, settings)


def relative_poses(
    own: Pose,
    seen: SeenOpponent,
    course: Course,
    model: ShieldModel,
) -> Array:
    """Return the poses of the robot in the frame of the opponent. (n, 3).

    One for each heading of an opponent whose heading is not known.
    """
    rows = []
    for heading in course.headings(model.heading_error):
        opponent = Pose(seen.x, seen.y, heading)
        x, y, turned = opponent.inverse().compose(own)
        rows.append((x, y, wrap_angle(turned)))
    return np.array(rows)


def _intent_of(held: HeldMotion, model: ShieldModel, own: Pose) -> Intent:
    """Return the intent that carries on with a motion."""
    ahead, left, rate = model.choices()[held.number].tolist()
    if model.velocities is not None:
        if (ahead, left, rate) == (0.0, 0.0, 0.0):
            return STAND
        u, v = rotate(ahead, left, held.heading - own.theta).tolist()
        return Intent(velocity=BodyVelocity(u, v, rate))
    limits = model.limits
    turn = rate * limits.step_duration
    heading = turn if model.saturated else turn / limits.share
    speed = abs(ahead) * limits.step_duration / limits.stride
    return Intent(min(max(heading, -pi), pi), min(speed, 1.0))
