"""Shield: a least-restrictive filter around the strategy of a robot.

What is required of each state, and the proof, are in docs/shield-proof.md.
"""

import logging
from dataclasses import dataclass, replace
from functools import lru_cache
from math import ceil, cos, hypot, inf, log2, pi, sin, tau
from typing import Any, NamedTuple

import numpy as np

from ..core.poses import Array, Pose, rotate, wrap_angle
from ..core.progress import ProgressLine
from ..planning import Direction
from ..theory.value import (
    ShieldGame,
    ShieldTable,
    solve_shield,
    sub_poses,
)
from ..theory.value.shield_game import CELLS, HEADINGS
from ..theory.value.table import cached
from .body_departure import BodyDeparture
from .decision_maker import evaluate_strategy
from .knowledge import ON_THE_SPOT, STAND, Intent, Knowledge, Limits
from .observed_course import (
    ChordModel,
    Course,
    observed_course,
    tried_headings,
)
from .opponent_track import SeenOpponent
from .shield_settings import ShieldSettings
from .strategy import BodyStrategy, Strategy
from .velocity_set import (
    BodyVelocity,
    VelocitySet,
    greatest_velocity,
    response_share,
)

LOG = logging.getLogger(__name__)

COARSE, FEW = 4, 12  # cells and headings for the greatest speed of a person
LEAST_SPEED = 0.02  # of a person that is tried, in [m/s]
SPEED_STEP = 1.1  # from one speed to the next
CELLS_PER_PERIOD = 6  # passed by the opponent while a motion is held
TURNS = (-1.0, -0.5, 0.0, 0.5, 1.0)  # of a unicycle's step, of the largest
SETTLING = 1.0  # of the paper's walk after its last step, in [s]
LEGS_PERIOD = 0.48  # of the motions of legs: several cells of the grid, [s]
# Speed at which the template point of legs follows the body, of the greatest
# speed of the legs; a G1 with 29 joints then has a tube of 0.26 m.
PULL = 0.24
LEGS_INTERVAL = 0.08  # between decisions on a body velocity, in [s]
LEGS_DIRECTIONS = 16
UNMEASURED = BodyDeparture(0.4, 0.2, 0.01, 0.005)
ASSUMES = (
    "the shield assumes how far the body departs from its template, "
    f"{UNMEASURED.tube:g} m and {UNMEASURED.loss:g} m per decision: that is "
    "not measured for its gait or its learned legs"
)
PERSON_REACH = 0.32  # of an adult, arms and feet in motion included, in [m]
SIGHTING_INTERVAL = 0.02  # by which a chord may be longer than a window, [s]
KEEPING = 0.005  # value of the last choice before others, in [m]

Vector = tuple[float, float]


class ShieldModel(NamedTuple):
    """Robot and person of a shield."""

    limits: Limits
    settings: ShieldSettings
    direction: Direction  # in which a unicycle drives
    saturated: bool  # whether it turns by (6)
    window: float  # between decisions, over which headings are measured [s]
    period: float  # for which a substituted motion is held [s]
    response: float  # from the decision to start until the robot moves [s]
    halting: float  # in which a robot that halts takes no decision [s]
    chords: ChordModel  # of the heading of the opponent
    displacement: float  # departure of robot and sightings per period [m]
    required: float  # least distance of the observed states [m]
    contact: float  # distance between centres that counts as contact [m]
    departure: BodyDeparture | None  # of the body, if it was measured

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
            heading_error=self.chords.bound,
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
    departure: BodyDeparture | None = None,
) -> ShieldModel:
    """Return the model of a robot, with what docs/shield-proof.md charges.

    A departure is that of its body, if it was measured.
    """
    legs, step, speed = limits.velocities, limits.step_duration, settings.speed
    body = departure or UNMEASURED
    contact, radius = settings.contact, settings.turning_radius
    if contact is None:
        contact = body.reach + PERSON_REACH
    if legs is None:
        longest = min(
            CELLS_PER_PERIOD * contact / CELLS / speed,
            0.5 * radius / speed,
            step / largest_turn(limits, saturated=saturated),  # by a radian
        )
        steps = max(1, round(longest / step))
        window, period = step, steps * step
        response, halting, loss = 2.0 * step, step + SETTLING, 0.0
    else:
        window, period = LEGS_INTERVAL, LEGS_PERIOD
        response, halting, loss = 0.0, 0.0, pull_of(legs) * period
        if departure is None:
            fastest = max(*map(abs, legs.forward))
            tube = legs.tube or body.tube + lag_of(legs) * fastest
            body = body._replace(tube=tube)
    loss += body.loss_in(period / window)
    if settings.loss is not None:
        loss = settings.loss
    if settings.response is not None:
        response = settings.response
    interval, error = window + SIGHTING_INTERVAL, settings.sighting_error
    chords = ChordModel(error, speed, radius, interval)
    for _ in range(3):  # the longer a chord takes, the more is unknown
        taken = chords.best / speed / window + 1.0
        unknown = error + 0.5 * body.loss_in(taken)
        chords = chords._replace(error=unknown)
    required = contact + error + loss + body.tube
    age = settings.sighting_delay
    if legs is not None:  # legs know where they are a tick late
        age += SIGHTING_INTERVAL
    required += speed * age
    return ShieldModel(
        *(limits, settings, direction, saturated, window, period),
        *(response, halting),
        chords,
        *(loss, required, contact),
        departure,
    )


@lru_cache(maxsize=8)
def _table(model: ShieldModel) -> ShieldTable:
    """Load or solve the table of a model; warn of what it does not hold."""
    if model.departure is None:
        LOG.warning(ASSUMES)
    table, person = _solved(model, CELLS, HEADINGS), model.settings
    if not model.certifies(table):
        speed = greatest_speed(model)
        least = f"Nor is any against one at {LEAST_SPEED:g} m/s"
        most = f"The greatest speed against which some are is {speed:.2g} m/s"
        LOG.warning(
            "shield: no state is certified against a person at %g m/s with a "
            "turning radius of %g m, contact at %.3g m; the shield changes "
            "nothing. %s",
            person.speed, person.turning_radius, model.contact,
            most if speed else least,
        )  # fmt: skip
    return table


def greatest_speed(model: ShieldModel) -> float:
    """Return the greatest speed of a person that is certified against, [m/s].

    To a tenth, by tables of fewer cells; 0 if even a slow one is not. What is
    found is kept.
    """
    step, person = SPEED_STEP, model.settings
    speeds = [LEAST_SPEED * step**i for i in range(99)]
    speeds = [speed for speed in speeds if speed < person.speed]
    low, high = -1, len(speeds)  # numbers of one that is and one that is not
    with ProgressLine("greatest speed", unit="tables") as bar:
        total, done = ceil(log2(high + 1.0)), 0
        while high - low > 1:
            middle = (low + high) // 2
            other = shield_model(
                model.limits,
                replace(person, speed=speeds[middle]),
                model.direction,
                saturated=model.saturated,
                departure=model.departure,
            )
            if other.certifies(_solved(other, COARSE, FEW)):
                low = middle
            else:
                high = middle
            done += 1
            bar.show(done, max(total, done))
    return speeds[low] if low >= 0 else 0.0


def _solved(model: ShieldModel, cells: int, headings: int) -> ShieldTable:
    """Return the table of a model, solved once and kept."""
    game, person = model.game(), model.settings
    key = (
        cells, *(headings,) * (headings != HEADINGS),
        person.speed, person.turning_radius, game.period, game.loss,
        game.jump, game.heading_error, model.required, model.response,
        game.motions.tobytes(),
    )  # fmt: skip
    arrays = cached(
        "shield",
        key,
        lambda: solve_shield(
            game,
            model.required,
            response=model.response,
            wait=LEGS_INTERVAL,
            cells=cells,
            headings=headings,
        ).arrays(),
    )
    return ShieldTable.from_arrays(game, arrays)


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
        self,
        command: Vector,
        body: Vector,
        legs: VelocitySet,
        duration: float,
    ) -> "TemplatePoint":
        """Return the point a duration [s] later, at a place of the body."""
        lag = lag_of(legs)
        (u, v), share = self.drift, response_share(duration, lag)
        drift = u + share * (command[0] - u), v + share * (command[1] - v)
        x = self.position[0] + duration * command[0]
        y = self.position[1] + duration * command[1]
        dx = body[0] + lag * drift[0] - x
        dy = body[1] + lag * drift[1] - y
        most = pull_of(legs) * duration
        share = min(1.0, most / max(hypot(dx, dy), 1e-12))
        return TemplatePoint((x + share * dx, y + share * dy), drift)


def pull_of(legs: VelocitySet) -> float:
    """Return the speed at which the template point follows, in [m/s]."""
    return PULL * max(map(abs, legs.forward))


def lag_of(legs: VelocitySet) -> float:
    """Return the lag by which the body follows its commands, in [s]."""
    return max(0.0, *legs.lags[:2])


class HeldMotion(NamedTuple):
    """Motion that replaces decisions of the strategy for a while."""

    number: int  # its number in the choices of the model
    heading: float  # heading in the map at which it began [rad]
    until: float  # time [s]; infinite until the robot has started


class ShieldMemory(NamedTuple):
    """Memory of a shield."""

    inner: Any  # memory of the strategy
    rows: tuple[SeenOpponent, ...] = ()  # positions of the opponent
    course: Course | None = None  # None before the first sighting
    held: HeldMotion | None = None
    time: float = 0.0  # of the last decision [s]
    template: TemplatePoint | None = None  # of legs
    command: Vector = (0.0, 0.0)  # over the floor [m/s]
    # whether, at the last decision, some motion was safe against each heading
    guarded: bool = False
    certified: bool = False  # the same, with the heading known
    stands_until: float = 0.0  # time up to which standing is safe [s]


@dataclass(frozen=True, slots=True)
class ShieldedStrategy(BodyStrategy):
    """Any strategy, of which unsafe decisions are replaced.

    A decision stands if no person within the bounds of the settings can come
    within contact while it is carried out, and if the robot can prevent
    contact for ever afterwards; else the motion is taken that guarantees the
    largest distance. Assumptions and proof are in docs/shield-proof.md.
    """

    strategy: Strategy
    shield: ShieldSettings
    departure: BodyDeparture | None = None  # of the body; None: not measured

    @property
    def assumes(self) -> str:
        """What it assumes of the body; empty for what is measured."""
        return ASSUMES if self.departure is None else ""

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
        now, moves = knowledge.time, knowledge.moving or intent.walks
        if not moves and now < memory.stands_until - 1e-6:
            return intent, memory._replace(inner=inner)
        model = self.model_for(knowledge)
        own = knowledge.step_start_in_map or knowledge.pose_in_map
        body, template = knowledge.pose_in_map[:2], memory.template
        if template is None:
            template = TemplatePoint(body)
        else:
            passed = max(0.0, now - memory.time)
            legs = model.limits.velocities
            if legs is not None:
                template = template.advance(memory.command, body, legs, passed)
        if model.limits.velocities is not None:
            own = Pose(*template.position, own.theta)
        seen = SeenOpponent(now - knowledge.age, *knowledge.position_in_map)
        rows = model.chords.note(memory.rows, seen)
        course = memory.course
        if rows is not memory.rows:
            course = observed_course(course, rows, model.chords)
        memory = memory._replace(
            inner=inner,
            rows=rows,
            course=course,
            template=template,
            time=now,
        )
        intent, memory = self._filter(
            intent, model, own, memory, moving=knowledge.moving
        )
        command, until = (0.0, 0.0), 0.0
        if not (knowledge.moving or intent.walks) and memory.guarded:
            until = now + LEGS_INTERVAL
        if intent.walks:
            (ahead, left, _), _ = model.twist(intent)
            u, v = rotate(ahead, left, own.theta).tolist()
            command = u, v
        known = course is not None and course.error <= model.chords.bound
        certified = memory.guarded and known
        return intent, memory._replace(
            command=command, stands_until=until, certified=certified
        )

    def model_for(self, knowledge: Knowledge) -> ShieldModel:
        """Return the model of the robot that decides."""
        return shield_model(
            knowledge.limits,
            self.shield,
            self.direction,
            saturated=self.saturated,
            departure=self.departure,
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
        """Return the intent, or that of a motion in its place.

        What is safe even if the opponent has turned on the spot comes before
        what is safe if it has not.
        """
        table, course, known = model.table(), memory.course, model.chords.bound
        if course is None or not model.certifies(table):
            # Contact can be forced from everywhere.
            return intent, memory._replace(held=None, guarded=False)
        found = intent, memory
        spreads = [course.spread, course.error]
        for spread in spreads if spreads[0] > spreads[1] else spreads[1:]:
            tried = course._replace(error=spread)
            found = self._choose(
                intent, model, own, memory, tried, moving=moving
            )
            if found[1].guarded or spread <= known:
                break
        return found

    def _choose(
        self,
        intent: Intent,
        model: ShieldModel,
        own: Pose,
        memory: ShieldMemory,
        course: Course,
        *,
        moving: bool,
    ) -> tuple[Intent, ShieldMemory]:
        """Return the same against all headings within an error."""
        table, required, now = model.table(), model.required, memory.time
        seen, known = memory.rows[-1], model.chords.bound
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
        held, guarded = memory.held, False
        if held is not None and held.until == inf:
            # The first step has begun when it was decided, or later; or the
            # robot has not started.
            until = now + model.period - model.window
            held = held._replace(until=until) if moving else None
        if held is not None and now <= held.until - 1e-6:
            # What was found when it began holds until it ends.
            guarded = memory.guarded
        else:
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
    rows = []
    for heading in tried_headings(course, course.error, known):
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
