"""Measurement of how far a walking body departs from its template."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import pi

import numpy as np

from ..core.errors import StepAsideError
from ..core.poses import Pose
from ..core.random_streams import named_generator
from ..games.game_settings import walk
from ..games.physics_world import PhysicsWorld
from ..games.player_settings import WALKER, RobotSettings
from ..games.players import RobotPlayer
from ..locomotion.control_settings import LegsSettings
from ..robots.description import RobotDescription
from ..sim.outline_measurement import reach_of, solid_geoms
from ..strategies.body_departure import BodyDeparture
from ..strategies.knowledge import ON_THE_SPOT, STAND, Intent, Knowledge
from ..strategies.strategy import BackwardStrategy, BodyStrategy

DURATION = 60.0  # of a walk, in [s]
SEEDS = 1, 2, 3
HELD = 5  # decisions for which an intent is held at most
NEAR = 1.5  # distance at which somebody is seen, in [m]
SPANS = 1, 2, 4, 8  # decisions over which changes are compared
EVERY = 10  # ticks between two samples of the reach


class DepartureRecord:
    """Motion of one body beside that of its odometry.

    Rows have a time [s] and, for the body and for its odometry, reference
    point and heading.
    """

    def __init__(self) -> None:
        """Begin empty."""
        self.rows: list[tuple[float, ...]] = []
        self.torsos: list[tuple[float, float]] = []
        self.decisions: list[tuple[float, float, float]] = []
        self.reach, self._stood = 0.0, False

    def note(
        self,
        time: float,
        body: Pose,
        odometry: Pose,
        torso: tuple[float, float],
    ) -> None:
        """Add a row."""
        self.rows.append((time, *body, *odometry))
        self.torsos.append(torso)

    def decide(self, time: float, point: Pose, *, moving: bool) -> None:
        """Add the template point of a decision, in odometry.

        Of decisions one after the other of a robot that stands the last one
        counts.
        """
        if self._stood and not moving and len(self.decisions) > 1:
            self.decisions.pop()
        self._stood = not moving
        self.decisions.append((time, point.x, point.y))

    def departure(self) -> BodyDeparture:
        """Return the greatest departure of this motion."""
        time, x, y, theta, u, v, heading = np.array(self.rows).T
        off = np.stack([x - u, y - v], axis=1)
        turned = NEAR * (np.unwrap(theta) - np.unwrap(heading))
        begins, *places = np.array(self.decisions).T
        at = np.minimum(np.searchsorted(time, begins - 1e-6), len(time) - 1)
        shifts, turns = off[at], turned[at]
        changes = {}
        for span in (n for n in SPANS if n < len(at)):
            moved = np.hypot(*(shifts[span:] - shifts[:-span]).T)
            changes[span] = float(
                (moved + np.abs(turns[span:] - turns[:-span])).max()
            )
        drift = max(
            (changes[n] - changes[1]) / (n - 1) for n in changes if n > 1
        )
        # Between decisions the template moves evenly.
        point = [np.interp(time, begins, place) for place in places]
        last = np.searchsorted(begins, time + 1e-6) - 1
        within = (last >= 0) & (time <= begins[-1])
        known = np.array(self.torsos) - shifts[np.maximum(last, 0)]
        away = np.hypot(*(known - np.stack(point, axis=1)).T)
        tube = float(away[within].max())
        return BodyDeparture(self.reach, tube, changes[1], max(0.0, drift))


@dataclass(frozen=True)
class RandomSteps(BackwardStrategy, BodyStrategy):
    """Strategy that walks at random."""

    seed: int
    # what it knew at its last decision, if at all
    known: list[Knowledge] = field(default_factory=list)

    def begin(self) -> tuple[int, Intent]:
        """Return how many decisions an intent is still held, and it."""
        return 0, STAND

    def decide(
        self, knowledge: Knowledge, memory: tuple[int, Intent]
    ) -> tuple[Intent, tuple[int, Intent]]:
        """Hold an intent for a while, then draw the next."""
        self.known[:] = [knowledge]
        left, intent = memory
        if left:
            return intent, (left - 1, intent)
        drawn = named_generator(self.seed, f"step {knowledge.time:.3f}")
        turn = drawn.choice([0.0, -pi, pi, drawn.uniform(-pi, pi)])
        share = drawn.choice([1.0, 1.0, 1.0, ON_THE_SPOT, 0.0])
        intent = Intent(float(turn), float(share))
        return intent, (int(drawn.integers(HELD)), intent)


def walk_departure(
    description: RobotDescription, own: RobotSettings, seed: int
) -> BodyDeparture | None:
    """Walk planned steps at random; return the departure, None of a fall."""
    steps = RandomSteps(seed)
    settings = walk(
        duration=DURATION,
        robot=str(description.folder),
        legs=LegsSettings(),
        gait=own.gait,
        control=own.control,
    ).resolved()
    world = PhysicsWorld(
        settings,
        strategies={WALKER: steps},
        descriptions={WALKER: description},
    )
    (player,) = world.players
    assert isinstance(player, RobotPlayer)
    body, record = player.scheme.decisions.body, DepartureRecord()
    assert body is not None
    root = world.model.body(f"{WALKER}/{description.torso}").rootid[0]
    geoms = solid_geoms(world.model, int(root))
    try:
        while world.time < DURATION:
            world.decide()
            torso = player.truth.position_torso_in_world
            place = player.place_in_world
            record.note(world.time, place, body.pose, torso)
            if steps.known:
                known = steps.known.pop()
                begins, now = known.step_start_in_map, world.time
                begins = begins or body.at(now)
                record.decide(now, begins, moving=known.moving)
            if world.ticks % EVERY == 0:
                reach = reach_of(world.model, world.data, geoms, torso)
                record.reach = max(record.reach, reach)
            world.step()
            if player.has_fallen:
                return None
    except StepAsideError:  # a leg cannot follow its reference
        return None
    finally:
        world.close()
    return record.departure()


def combined(found: Sequence[BodyDeparture | None]) -> BodyDeparture | None:
    """Return the greatest departure of several walks; None after a fall."""
    worst: BodyDeparture | None = None
    for each in found:
        if each is None:
            return None
        worst = each if worst is None else worst.enlarged(each)
    return worst
