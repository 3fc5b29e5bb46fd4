"""Simulated robots with their own walk, commanded by velocities."""

import logging
from typing import TYPE_CHECKING

from ..control.scheme_builder import ClearanceSetup, build_walk
from ..control.velocity_scheme import VelocityScheme
from ..core.poses import Pose, wrap_angle
from ..locomotion.control_settings import LegsSettings
from ..locomotion.locomotion import Phase, StepStarted
from ..locomotion.maneuver_walk import ManeuverWalk
from ..locomotion.policy.policy_legs import load_legs
from ..locomotion.policy.policy_walk import PolicyWalk
from ..locomotion.surroundings import Surroundings
from ..perception.images import ColourImage
from ..perception.measurement import RobotState, Sighting
from ..planning import Foot
from ..robots.description import RobotDescription
from ..robots.forward_kinematics import ForwardKinematics, torso_pose_on_foot
from ..sim.ground_truth import TrueRobotState
from ..sim.simulated_robot import SimulatedRobot
from ..sim.world import World
from ..strategies.velocity_set import BodyVelocity
from .player import MotionLog, PhysicalPlayer, Snapshot, snapshot_of
from .policy_player import place_on_legs, velocity_guard
from .walker_factory import RobotSensing, WalkerSetup, place_robot
from .walker_log import WalkerLog

if TYPE_CHECKING:
    from ..drivers.ros2_server import BodyPlace

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
        surroundings: Surroundings,
    ) -> None:
        """Combine a robot and its controller.

        Args:
            robot: The robot.
            scheme: Controller.
            frame: Pose of its odometry in the world.
            description: Description of the robot.
            surroundings: Known obstacles.
        """
        super().__init__(robot)
        self._surroundings = surroundings
        self.description = description
        self._forward = ForwardKinematics(description)
        self.scheme, self.frame = scheme, frame
        self._image: ColourImage | None = None
        self._ignores_lateral = False

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
        """Walk at a velocity from the next tick on.

        A walk by maneuvers has no sidesteps.
        """
        self.scheme.command(velocity)
        ignores = velocity.lateral and not self.scheme.velocity.lateral
        if ignores and not self._ignores_lateral:
            self._ignores_lateral = True
            log.warning(
                "%s does not step sideways; its lateral velocity is ignored",
                self.name,
            )

    def tick(self) -> None:
        """Walk at the commanded velocity."""
        measured = self.measure()
        self._surroundings.note(measured, self.scheme.locomotion.pose)
        self.robot.write(self.scheme.update(measured))

    def snapshot(self) -> Snapshot:
        """Return the state at this instant."""
        walk = self.scheme.locomotion.maneuvers
        return snapshot_of(self.robot, frame=self.frame, walk=walk)

    def motion_log(self, *, closely: bool) -> MotionLog:
        """Return an empty log of its motion."""
        walk = self.scheme.locomotion
        if not isinstance(walk, ManeuverWalk):
            return super().motion_log(closely=closely)
        return WalkerLog(self.robot, walk, self.frame, closely=closely)

    @property
    def velocity(self) -> BodyVelocity:
        """Velocity that it follows."""
        return self.scheme.velocity

    def state(self) -> RobotState:
        """Return the state that the robot reports to its client."""
        measurement = self.measure()
        return RobotState(
            measurement.time,
            measurement.joint_positions,
            sighting=self._sighting(measurement),
            percepts=() if self._image is None else (self._image,),
            pose=self.scheme.templates.at(measurement.time),
        )

    def torso(self) -> "BodyPlace":
        """Return the pose of the torso by the stance foot and the tilt."""
        measurement = self.measure()
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
        return (planar.x, planar.y, z), (*tilt, wrap_angle(planar.theta))

    def measure(self) -> RobotState:
        """Return the measurement of this tick, and keep its last image."""
        measured = super().measure()
        for percept in measured.percepts:
            if isinstance(percept, ColourImage):
                self._image = percept
        return measured

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
    legs: LegsSettings,
    *,
    truth: TrueRobotState,
    sensing: RobotSensing | None = None,
    clearance: ClearanceSetup | None = None,
) -> VelocityWalker:
    """Place a robot that walks at commanded velocities in a world.

    Args:
        world: World that contains the robot.
        setup: The robot.
        legs: Its walking policy, if it has one.
        truth: True state of the robot.
        sensing: Senses that are reported to the client.
        clearance: Knowledge of the room and required clearance.

    Raises:
        ReachError: If the legs cannot reach the initial stance of the gait.
        PolicyError: If the network cannot run on the robot.
    """
    tick = world.physics.tick
    if legs.walks:
        policy = load_legs(legs, setup.description, tick=tick)
        around, guard = velocity_guard(policy, clearance)
        world.measures_always = True
        return VelocityWalker(
            place_on_legs(
                world,
                setup,
                policy,
                sensing=sensing,
                truth=truth,
                clearance=clearance,
            ),
            VelocityScheme(PolicyWalk(policy, setup.gait, guard), tick),
            setup.odometry_in_world,
            setup.description,
            around,
        )
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
        robot,
        scheme,
        setup.odometry_in_world,
        setup.description,
        Surroundings(),  # the walk itself notes its surroundings
    )
