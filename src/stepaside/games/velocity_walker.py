"""Robots of our world that walk by themselves, at velocities from outside."""

from collections.abc import Mapping
from typing import Protocol

from ..control import Phase
from ..control.sight_sources import MeasuredSight
from ..control.turn_calibration import TurnCalibration
from ..control.velocity_walk import accepted, walk_at
from ..core.poses import Array, Pose, wrap_angle
from ..drivers.velocity.footstep_commands import FootCommand
from ..drivers.velocity.velocity_body import REST, VelocityCommand
from ..drivers.velocity.walking_robot import WalkerState
from ..perception.images import ColourImage, SonarEcho
from ..perception.measurement import Measurement, Sighting
from ..planning import Direction, Foot
from ..strategies import StandStill
from .walker import Walker

HEAD_SPEED = 3.0  # of a head that is turned from outside, in [rad/s]
SOMEBODY = Sighting(0.0, 0.0, 1.0)  # who is driven looks for nobody


class VelocitySource(Protocol):
    """Where velocities come from."""

    def act(self) -> VelocityCommand:
        """What the robot is to do at this tick."""

    def close(self) -> None:
        """Let go of whoever commands."""


class VelocityWalker(Walker):
    """A robot with its own control, which walks as it is told.

    Attributes:
        commander: Who tells it; none yet, and then it stands.
    """

    def __init__(self, walker: Walker, *, offers_sight: bool = True) -> None:
        """Let a walker be driven.

        Args:
            walker: The robot; it is not to be used any more.
            offers_sight: Whether it tells where the other is.
        """
        super().__init__(walker.robot, walker.scheme, walker.frame)
        self.commander: VelocitySource | None = None
        self.scheme.senses = MeasuredSight(SOMEBODY)
        self.scheme.decisions.adopt(StandStill())
        self.scheme.decisions.turns = None  # learnt here, by what was told
        self._offers_sight = offers_sight
        self._under_way: Direction | None = None
        self._velocity = REST
        self._seen: Measurement | None = None
        self._head: dict[int, float] = {}
        self._looks: Array | None = None
        self._image: ColourImage | None = None
        self._echoes: dict[str, float | None] = {}
        self._ticks = -1
        self._steps = 0
        self._updated = False
        self._turns = TurnCalibration(walker.robot.world.physics.tick)

    def tick(self) -> None:
        """Walk on, as it was told."""
        scheme = self.scheme
        if self.commander is not None:
            self._velocity = self.commander.act()
        if scheme.phase is Phase.STANDING:
            self._under_way = None
        measurement = self._measured()
        forward, turn = accepted(*self._velocity, scheme.settings)
        strategy = walk_at(
            forward,
            turn / self._turns.share,
            scheme.settings,
            under_way=self._under_way,
        )
        scheme.decisions.adopt(strategy)
        targets = scheme.update(measurement)
        self.robot.write(self._turned(targets) if self._head else targets)
        self._updated = True
        self._turns.note(
            float(measurement.gyro[2]),
            scheme.decisions.templates.at(measurement.time).theta,
            stands=scheme.phase is Phase.STANDING,
        )
        begun = scheme.begun
        if begun is not None and begun.planning_time is not None:
            self._steps += 1
        if self._under_way is None and scheme.phase is Phase.WALKING:
            self._under_way = strategy.direction

    def state(self) -> WalkerState:
        """What it says of itself now."""
        measurement = self._measured()
        now, scheme = measurement.time, self.scheme
        walk = scheme.state
        pace = accepted(*self._velocity, scheme.settings)
        return WalkerState(
            now,
            scheme.decisions.templates.at(now),
            VelocityCommand(*pace),
            measurement.joint_positions.tolist(),
            self._sighting(measurement),
            self._image,
            (walk.left_foot, walk.right_foot),
            self._making(now),
            self._steps,
            self._echoes.copy(),
        )

    def lead_with(self, foot: Foot) -> None:
        """Make the next first step with a foot, if it stands."""
        self.scheme.lead_with(foot)

    def _making(self, now: float) -> FootCommand | None:
        """Step that is being made, its time what is left of it."""
        walk = self.scheme.state
        plan = walk.plan
        if plan is None:
            return None
        ends = walk.plan_started + plan.schedule.first_step_duration
        placed = Pose(*plan.placements[2].tolist())
        return FootCommand(plan.first_foot, placed, max(0.0, ends - now))

    def look(self, angles: Mapping[str, float]) -> None:
        """Turn the head to angles of its joints, in [rad], by name.

        Raises:
            ValueError: If it has no such joint.
        """
        kinematics = self.scheme.kinematics
        for name, angle in angles.items():
            self._head[kinematics.joint_names.index(name)] = angle

    def _turned(self, targets: Array) -> Array:
        """Joint targets with the head on its way to where it is to be."""
        if self._looks is None:
            self._looks = targets.copy()
        turned = targets.copy()
        most = HEAD_SPEED * self.robot.world.physics.tick
        for joint, angle in self._head.items():
            off = angle - float(self._looks[joint])
            self._looks[joint] += min(max(off, -most), most)
            turned[joint] = self._looks[joint]
        return turned

    def close(self) -> None:
        """Let go of the commander and the eyes."""
        if self.commander is not None:
            self.commander.close()
        super().close()

    def _measured(self) -> Measurement:
        """What the sensors give: read once a tick, as noise is drawn."""
        ticks = self.robot.world.ticks
        if self._seen is None or ticks != self._ticks:
            self._seen, self._ticks = self.robot.read(), ticks
            for percept in self._seen.percepts:
                if isinstance(percept, ColourImage):
                    self._image = percept
                elif isinstance(percept, SonarEcho):
                    self._echoes[percept.sonar] = percept.distance
        return self._seen

    def _sighting(self, measurement: Measurement) -> Sighting | None:
        """The other as the unicycle sees it that stands for the robot."""
        seen, decisions = measurement.sighting, self.scheme.decisions
        if seen is None or not self._offers_sight:
            return None
        heading = (
            decisions.headings.at(seen.time)
            if self._updated
            else self.scheme.kinematics.torso_heading
        )
        ahead = decisions.templates.at(seen.time).theta
        bearing = wrap_angle(heading + seen.bearing - ahead)
        return Sighting(seen.time, bearing, seen.distance)
