"""Fake legs, strategy, feedback and perception, for tests of control."""

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np

from stepaside.control.scheme import ControlScheme
from stepaside.control.sight_sources import SightSource
from stepaside.core.poses import ALL_AROUND, Array, Pose
from stepaside.locomotion.locomotion import Phase, StepStarted
from stepaside.locomotion.maneuver_walk import ManeuverWalk
from stepaside.locomotion.zmp.open_loop import OpenLoop
from stepaside.locomotion.zmp.stabiliser import Stabiliser
from stepaside.perception.measurement import RobotState, Sighting
from stepaside.planning import Direction, Foot, GaitSettings
from stepaside.robots.leg_kinematics import BodyReference
from stepaside.strategies import Intent, Knowledge

GAIT = GaitSettings()


TICK = 0.004


STEP = GAIT.step_duration


class FakeLegs:
    """Legs that reach everything: the targets are the reference itself."""

    def __init__(self) -> None:
        self.torso_heading = 0.0
        self.tracked: list[BodyReference] = []

    def stand(self, reference: BodyReference) -> Array:
        """Take any posture."""
        return np.array(reference.com)

    def track(self, reference: BodyReference) -> Array:
        """Follow anything."""
        self.tracked.append(reference)
        return np.array(reference.com)

    def track_rows(self, references: Array) -> Any:
        """Follow the first; the heading is the one that is set by then."""
        row = references[0].tolist()
        targets = self.track(BodyReference.from_row(row))[None]
        return SimpleNamespace(
            rows=np.zeros((2, 6)), targets=targets, torso_headings=self
        )

    def __getitem__(self, tick: int) -> float:
        """Return the heading of the torso after any tick."""
        return self.torso_heading


@dataclass
class FakeStrategy:
    """Remembers the bearings that it saw, heads where it is told."""

    going: bool = True
    heading: float = 0.0
    direction: Direction = Direction.FORWARD
    saturated: bool = False
    speed_factor: float = 1.0

    def begin(self) -> tuple[Knowledge, ...]:
        """Nothing was known yet."""
        return ()

    def decide(
        self, knowledge: Knowledge, memory: tuple[Knowledge, ...]
    ) -> tuple[Intent, tuple[Knowledge, ...]]:
        """Go when told, and not too far, and head where told."""
        going = self.going and knowledge.distance < 2.0
        intent = Intent(self.heading, self.speed_factor * going)
        return intent, (*memory, knowledge) if going else memory


class FakeFeedback(Stabiliser):
    """Passes everything on, and can be told to interfere."""

    def __init__(self, legs: Any = None) -> None:
        OpenLoop.__init__(self, legs)
        self.ready, self.measured_heading = True, 0.0
        self.tilt = (0.0, 0.0)
        self.state: Any = None
        self.lift = self.shift = 0.0
        self.jump = (0.0, 0.0)
        self.zmp_shift = (0.0, 0.0)
        self.steps: list[Any] = []
        self.landed: list[Any] = []
        self.fits = 0
        joints: Any = SimpleNamespace(update=lambda angles, t: t + angles)
        self.joints = joints

    def update(self, _: Any, row: Any, step: Any) -> BodyReference:
        """Pass the reference on, lifted."""
        self.steps.append(step)
        x, y, z = row.body.com
        body: BodyReference = row.body._replace(com=(x, y, z + self.lift))
        return body

    def land(self, landed: Pose, position: Any, velocity: Any, step: Any):  # type: ignore[no-untyped-def]
        """Let a foot land, shifted."""
        self.landed.append((landed, step))
        moved = Pose(landed.x + self.shift, landed.y, landed.theta)
        return moved, position, velocity

    def fit(self, plan_from: Any, state: Any, support: Any) -> Any:
        """Plan as asked."""
        self.fits += 1
        (x, y), (u, v) = self.jump, state.velocity
        return plan_from(state), state._replace(velocity=(u + x, v + y))


def measure(
    time: float, distance: float | None = 1.0, bearing: float = 0.0
) -> RobotState:
    seen = None if distance is None else Sighting(time, bearing, distance)
    nothing = np.zeros(3)
    return RobotState(time, nothing, nothing, nothing, np.zeros(8), seen)


def scheme_of(
    strategy: Any,
    gait: GaitSettings,
    legs: Any,
    *,
    tick: float,
    senses: SightSource | None = None,
    **walk: Any,
) -> ControlScheme:
    """Return a scheme whose legs walk by maneuvers."""
    guard = walk.get("guard")
    surroundings = None if guard is None else guard.surroundings
    made = ManeuverWalk(gait, legs, tick=tick, **walk)
    return ControlScheme(strategy, made, senses, surroundings)


def walk_of(scheme: ControlScheme) -> ManeuverWalk:
    """Return the walk of a scheme."""
    assert isinstance(scheme.locomotion, ManeuverWalk)
    return scheme.locomotion


class Run:
    """A scheme on its clock, and the steps that it began."""

    def __init__(
        self,
        strategy: Any = None,
        gait: GaitSettings = GAIT,
        legs: Any = None,
        balance: Any = OpenLoop,
        **changes: Any,
    ) -> None:
        self.legs = legs = legs or FakeLegs()
        changes["balance"] = balance(legs)
        self.strategy = strategy or FakeStrategy()
        self.scheme = scheme_of(
            self.strategy, gait, legs, tick=TICK, **changes
        )
        self.ticks = 0
        self.steps: list[StepStarted] = []

    @property
    def replans(self) -> int:
        """Maneuvers planned so far; a halt is none."""
        return sum(step.planning_time is not None for step in self.steps)

    @property
    def landings(self) -> list[tuple[float, Foot, Pose]]:
        """When each foot that has begun to swing lands, and where."""
        return [(s.landing_time, s.foot, s.landing) for s in self.steps]

    @property
    def asked(self) -> list[float]:
        """Bearings from which it planned, in [rad]."""
        return [known.bearing for known in self.scheme.decisions.memory]

    def phase(self) -> Phase:
        """Present activity of the robot."""
        return self.scheme.phase

    def until(
        self, time: float, distance: float | None = 1.0, bearing: float = 0.0
    ) -> ControlScheme:
        """Run all ticks before a time."""
        while self.ticks * TICK < time - 1e-9:
            now = self.ticks * TICK
            self.scheme.update(measure(now, distance, bearing))
            if self.scheme.begun is not None:
                self.steps.append(self.scheme.begun)
            self.ticks += 1
        return self.scheme


FIRST = GAIT.start_support + STEP  # duration of the first maneuver walked


def feeding(strategy: Any = None) -> tuple[Run, FakeFeedback]:
    run = Run(strategy, balance=FakeFeedback)
    feedback: Any = walk_of(run.scheme).balance
    return run, feedback


class FakePerception:
    """Sees what it is told and turns the head."""

    def __init__(self) -> None:
        self.head, self.views = SimpleNamespace(turning=0.0), ALL_AROUND
        self.seen: Sighting | None = None
        self.stood: list[tuple[Pose, bool]] = []
        self.tilts: list[tuple[float, float]] = []

    def see(
        self,
        measurement: RobotState,
        support: Pose,
        left_supports: bool,
        tilt: tuple[float, float],
    ) -> Sighting | None:
        """See what was told."""
        self.stood.append((support, left_supports))
        self.tilts.append(tilt)
        return self.seen

    def aim(self, targets: Array) -> None:
        """Turn the head."""
        targets[0] = 0.75
