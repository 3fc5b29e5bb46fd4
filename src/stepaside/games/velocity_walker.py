"""Simulated robots with their own walk, commanded by velocities."""

import logging

from ..control.scheme_builder import ClearanceSetup, build_walk
from ..control.velocity_scheme import VelocityScheme
from ..core.poses import Pose, wrap_angle
from ..drivers.walking_robot import TorsoInFootprint, WalkerState
from ..locomotion.walk_snapshots import Phase, StepStarted
from ..perception.images import ColourImage
from ..perception.measurement import RobotState, Sighting
from ..planning import Foot
from ..robots.body_pose import torso_pose_on_foot
from ..robots.description import RobotDescription
from ..robots.forward_kinematics import ForwardKinematics
from ..sim.ground_truth import TrueRobotState
from ..sim.simulated_robot import SimulatedRobot
from ..sim.world import World
from ..strategies.velocity_set import BodyVelocity
from .player import PhysicalPlayer, Snapshot, snapshot_of
from .walker_factory import RobotSensing, WalkerSetup, place_robot
from .walker_log import WalkerLog

log = logging.getLogger(__name__)


class VelocityWalker(PhysicalPlayer):
    """Simulated robot that walks at commanded velocities.

    Attributes:
        scheme: Controller.
        frame: Pose of its odometry in the world.
        description: Description of the robot.
    """

    def __init__(
        self,
        robot: SimulatedRobot,
        scheme: VelocityScheme,
        frame: Pose,
        description: RobotDescription,
    ) -> None:
        """Combine a robot and its controller.

        Args:
            robot: The robot.
            scheme: Controller.
            frame: Pose of its odometry in the world.
            description: Description of the robot.
        """
        super().__init__(robot)
        self.description = description
        self._forward = ForwardKinematics(description)
        self.scheme, self.frame = scheme, frame
        self._measurement: RobotState | None = None
        self._image: ColourImage | None = None
        self._ticks, self._ignores_lateral = -1, False

    @property
    def begun(self) -> StepStarted | None:
        """Step begun at the last tick, if any."""
        return self.scheme.locomotion.begun

    @property
    def is_moving(self) -> bool:
        """Whether it has left its standing state."""
        return self.scheme.locomotion.phase is not Phase.STANDING

    @property
    def has_fallen(self) -> bool:
        """Whether it has fallen, or has detected a fall."""
        detected = self.scheme.locomotion.phase is Phase.FALLEN
        return self.truth.has_fallen or detected

    def command(self, velocity: BodyVelocity) -> None:
        """Walk at a velocity from the next tick on; it has no sidesteps."""
        if velocity.lateral and not self._ignores_lateral:
            self._ignores_lateral = True
            log.warning(
                "%s does not step sideways; its lateral velocity is ignored",
                self.name,
            )
        self.scheme.command(velocity.forward, velocity.turn)

    def tick(self) -> None:
        """Walk at the commanded velocity."""
        self.robot.write(self.scheme.update(self._read()))

    def snapshot(self) -> Snapshot:
        """Return the state at this instant."""
        walk = self.scheme.locomotion.state
        return snapshot_of(self.robot, frame=self.frame, walk=walk)

    def motion_log(self, *, closely: bool) -> WalkerLog:
        """Return an empty log of its motion."""
        return WalkerLog(
            self.robot, self.scheme.locomotion, self.frame, closely=closely
        )

    def state(self) -> WalkerState:
        """Return the state that the robot reports to its client."""
        measurement = self._read()
        now, scheme = measurement.time, self.scheme
        forward, turn = scheme.velocity
        return WalkerState(
            now,
            scheme.templates.at(now),
            BodyVelocity(forward, 0.0, turn),
            measurement.joint_positions.tolist(),
            self._sighting(measurement),
            self._image,
            self._torso(measurement),
        )

    def _torso(self, measurement: RobotState) -> TorsoInFootprint:
        """Return the pose of the torso by the stance foot and the tilt."""
        scheme, now = self.scheme, measurement.time
        step = scheme.locomotion.step(now)
        tilt = scheme.locomotion.tilt or (0.0, 0.0)
        torso = torso_pose_on_foot(
            self._forward.posture(measurement.joint_positions),
            0 if step.swing is Foot.RIGHT else 1,
            step.support,
            tilt,
        )
        x, y, z = torso.position_in_odometry.tolist()
        template = scheme.templates.at(now)
        planar = template.inverse().compose(
            Pose(x, y, torso.heading_in_odometry)
        )
        return TorsoInFootprint(
            (planar.x, planar.y, z), (*tilt, wrap_angle(planar.theta))
        )

    def _read(self) -> RobotState:
        """Return the measurement of this tick; noise is drawn once."""
        ticks = self.robot.world.ticks
        if self._measurement is None or ticks != self._ticks:
            self._measurement, self._ticks = self.robot.read(), ticks
            for percept in self._measurement.percepts:
                if isinstance(percept, ColourImage):
                    self._image = percept
        return self._measurement

    def _sighting(self, measurement: RobotState) -> Sighting | None:
        """Return the sighting with its bearing relative to the template."""
        sighting, scheme = measurement.sighting, self.scheme
        if sighting is None:
            return None
        template_heading = scheme.templates.at(sighting.time).theta
        torso_heading = scheme.headings.at(sighting.time)
        bearing = wrap_angle(
            torso_heading + sighting.bearing - template_heading
        )
        return Sighting(sighting.time, bearing, sighting.distance)


def place_velocity_walker(
    world: World,
    setup: WalkerSetup,
    *,
    truth: TrueRobotState,
    sensing: RobotSensing | None = None,
    clearance: ClearanceSetup | None = None,
) -> VelocityWalker:
    """Place a robot that walks at commanded velocities in a world.

    Args:
        world: World that contains the robot.
        setup: The robot.
        truth: True state of the robot.
        sensing: Senses that are reported to the client.
        clearance: Knowledge of the room and required clearance.

    Raises:
        ReachError: If the legs cannot reach the initial stance of the gait.
    """
    tick = world.physics.tick
    walk = build_walk(
        setup.description,
        setup.gait,
        setup.control,
        tick=tick,
        delay=setup.body.delay_cycles * tick,
        clearance=clearance,
    )
    robot = place_robot(
        world,
        setup,
        walk.kinematics,
        sensing=sensing,
        truth=truth,
        clearance=clearance,
    )
    scheme = VelocityScheme(walk, tick)
    return VelocityWalker(
        robot, scheme, setup.odometry_in_world, setup.description
    )
