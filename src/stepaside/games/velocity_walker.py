"""Robots that walk at velocities that another process commands."""

import logging
from math import inf, pi
from typing import TYPE_CHECKING

from ..control.scheme import ControlScheme
from ..control.sight_sources import MeasuredSight
from ..core.poses import Pose, wrap_angle
from ..locomotion.maneuver_walk import ManeuverWalk, velocity_limits
from ..perception.images import ColourImage
from ..perception.measurement import RobotState, Sighting
from ..planning import Direction, Foot, GaitSettings
from ..robots.description import RobotDescription
from ..robots.forward_kinematics import ForwardKinematics, torso_pose_on_foot
from ..sim.simulated_robot import SimulatedRobot
from ..strategies.knowledge import STAND, Intent, Knowledge
from ..strategies.velocity_set import STILL, BodyVelocity, VelocitySet
from .players import RobotPlayer

if TYPE_CHECKING:
    from ..drivers.ros2_server import BodyPlace
    from ..locomotion.policy.policy_legs import PolicyWalk

log = logging.getLogger(__name__)

SLOW = 1e-3  # speed [m/s] or turning rate [rad/s] that counts as zero
IN_PLACE = 1e-3  # speed factor of a turn on the spot


class CommandedVelocity:
    """Strategy that walks at a velocity, which is replaced from outside.

    Learned legs follow the velocity itself. A walk by maneuvers has no
    sidesteps, and halts before it reverses its direction.

    Attributes:
        command: The velocity, also one that is too fast.
    """

    saturated = False

    def __init__(
        self, gait: GaitSettings, legs: VelocitySet | None = None
    ) -> None:
        """Stand, on learned legs or by maneuvers of a gait."""
        self._limits, self._legs = velocity_limits(gait), legs
        self.direction, self.command = Direction.FORWARD, STILL

    @property
    def velocity(self) -> BodyVelocity:
        """Velocity that it follows: the nearest, or slower on the path."""
        if self._legs is not None:
            return self._legs.nearest(self.command)
        (forward, _, turn), (speed, rate) = self.command, self._limits
        share = 1.0 / max(1.0, abs(forward) / speed, abs(turn) / rate)
        return BodyVelocity(share * forward, 0.0, share * turn)

    def begin(self) -> None:
        """Return no memory."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Return the step that follows the command."""
        velocity = self.velocity
        if self._legs is not None:
            walks = velocity != STILL
            return Intent(velocity=velocity) if walks else STAND, None
        (forward, _, turn), (speed, rate) = velocity, self._limits
        under_way = self.direction if knowledge.moving else None
        wanted = Direction.FORWARD if forward >= 0.0 else Direction.BACKWARD
        if abs(forward) < SLOW:
            wanted = under_way or Direction.FORWARD
        rests = abs(forward) < SLOW and abs(turn) < SLOW
        if rests or under_way not in (None, wanted):
            return STAND, None
        self.direction = wanted
        share = max(IN_PLACE, min(1.0, abs(forward) / speed))
        return Intent(pi * turn / rate, share), None


class VelocityWalker(RobotPlayer):
    """Simulated robot that walks at velocities of another process."""

    def __init__(
        self,
        robot: SimulatedRobot,
        walk: "ManeuverWalk | PolicyWalk",
        frame: Pose,
        description: RobotDescription,
    ) -> None:
        """Combine a robot and its walk."""
        legs = None if walk.maneuvers else walk.velocities
        self._strategy = CommandedVelocity(walk.gait, legs)
        # It walks without sightings.
        senses = MeasuredSight(Sighting(0.0, 0.0, inf))
        scheme = ControlScheme(self._strategy, walk, senses)
        super().__init__(robot, scheme, frame)
        self.description = description
        scheme.decisions.headings.note(0.0, walk.torso_heading)
        self._forward = ForwardKinematics(description)
        self._image: ColourImage | None = None
        self._feels = True
        self._ignores_lateral = False

    def command(self, velocity: BodyVelocity) -> None:
        """Walk at a velocity from the next tick on.

        A walk by maneuvers has no sidesteps.
        """
        self._strategy.command = velocity
        ignores = velocity.lateral and not self.velocity.lateral
        if ignores and not self._ignores_lateral:
            self._ignores_lateral = True
            log.warning(
                "%s does not step sideways; its lateral velocity is ignored",
                self.name,
            )

    @property
    def velocity(self) -> BodyVelocity:
        """Velocity that it follows."""
        return self._strategy.velocity

    @property
    def ready(self) -> bool:
        """Whether it can walk; with feedback it calibrates its gyro first."""
        return self.maneuvers is None or self.maneuvers.balance.ready

    def tick(self) -> None:
        """Walk at the commanded velocity."""
        self.robot.write(self.scheme.update(self.measure()))

    def measure(self, *, sees: bool = True) -> RobotState:
        """Return the measurement of this tick, and keep its last image."""
        measured = super().measure(sees=sees)
        for percept in measured.percepts:
            if isinstance(percept, ColourImage):
                self._image = percept
        return measured

    def state(self) -> RobotState:
        """Return the state that the robot reports to its client."""
        measured = self.measure()
        return RobotState(
            measured.time,
            measured.joint_positions,
            sighting=self._seen(measured.sighting),
            percepts=() if self._image is None else (self._image,),
            pose=self.scheme.decisions.templates.at(measured.time),
        )

    def _seen(self, sighting: Sighting | None) -> Sighting | None:
        """Return a sighting with its bearing relative to the template."""
        if sighting is None:
            return None
        scheme, time = self.scheme, sighting.time
        past = scheme.decisions
        turned = past.headings.at(time) - past.templates.at(time).theta
        bearing = wrap_angle(turned + sighting.bearing)
        return Sighting(time, bearing, sighting.distance)

    def torso(self) -> "BodyPlace":
        """Return the pose of the torso by the stance foot and the tilt."""
        measured, walk = self.measure(), self.scheme.locomotion
        step, tilt = walk.step(measured.time), walk.tilt or (0.0, 0.0)
        torso = torso_pose_on_foot(
            self._forward.posture(measured.joint_positions),
            0 if step.swing is Foot.RIGHT else 1,
            step.support,
            tilt,
        )
        x, y, z = torso.position_in_odometry.tolist()
        place = Pose(x, y, torso.heading_in_odometry)
        template = self.scheme.decisions.templates.at(measured.time)
        planar = template.inverse().compose(place)
        return (planar.x, planar.y, z), (*tilt, wrap_angle(planar.theta))
