"""Players of a game in physics: simulated robots, and others."""

import logging
from typing import TYPE_CHECKING, Any

import numpy as np

from ..control.scheme import ControlScheme, VelocityScheme
from ..control.sight_sources import CameraSight
from ..core.errors import PolicyError
from ..core.poses import Pose, wrap_angle
from ..locomotion.locomotion import Phase, StepStarted
from ..locomotion.maneuver_walk import ManeuverWalk
from ..perception.images import ColourImage
from ..perception.measurement import RobotState, Sighting
from ..planning import Foot
from ..robots.description import RobotDescription
from ..robots.forward_kinematics import ForwardKinematics, torso_pose_on_foot
from ..sim.ground_truth import GroundTruth, TrueStance
from ..sim.push import Push, ScheduledPush
from ..sim.simulated_robot import SimulatedRobot
from ..strategies.velocity_set import BodyVelocity

if TYPE_CHECKING:
    from ..drivers.ros2_server import BodyPlace
    from ..perception.pipeline import Perception

log = logging.getLogger(__name__)

AT_ONCE = 1.0  # a fall until then is one of the policy, in [s]


class Player:
    """Player of a game in physics: a robot, a person or a moved marker."""

    name: str
    truth: GroundTruth  # true state, for the rules of the game and the record
    frame: Pose | None = None  # of its odometry in the world, if it has one
    maneuvers: ManeuverWalk | None = None  # of a robot that plans its steps

    @property
    def place_in_world(self) -> Pose:
        """Reference point and heading."""
        truth = self.truth
        return Pose(*truth.position_reference_in_world, truth.heading_in_world)

    @property
    def torso_in_world(self) -> Pose:
        """Origin and heading of the torso."""
        truth = self.truth
        return Pose(*truth.position_torso_in_world, truth.heading_in_world)

    @property
    def is_moving(self) -> bool:
        """Whether it has left its standing state."""
        return True

    def tick(self) -> None:
        """Perceive, decide and act; physics advances afterwards.

        Raises:
            ReachError: If its legs cannot reach their references.
            StrategyError: If its strategy gives no intent.
        """

    def sample(self, *, closely: bool) -> dict[str, Any]:
        """Return its present motion, by name in a trajectory.

        Closely with all that is measured of it.
        """
        return {
            "com": self.truth.position_com_in_world,
            "place": self.place_in_world,
            "torso": self.torso_in_world,
        }


class RobotPlayer(Player):
    """Simulated robot with its controller."""

    frame: Pose

    def __init__(
        self, robot: SimulatedRobot, scheme: ControlScheme, frame: Pose
    ) -> None:
        """Combine a robot and its controller."""
        self.name, self.truth, self.robot = robot.name, robot.truth, robot
        self.scheme, self.frame = scheme, frame
        self.walk = scheme.locomotion
        self.maneuvers = self.walk.maneuvers
        # Exact sightings are read when a decision is due.
        self._coasts = robot.sees_exactly
        self._feels = scheme.locomotion.feels or not self._coasts

    @property
    def perception(self) -> "Perception | None":
        """Perception by cameras, if it has one."""
        senses = self.scheme.senses
        return senses.perception if isinstance(senses, CameraSight) else None

    def tick(self) -> None:
        """Read the sensors, decide, and send joint targets."""
        robot, scheme = self.robot, self.scheme
        now, targets = robot.world.time, None
        if self._coasts:
            targets = scheme.coast(now)
        if targets is None:
            sees = not self._coasts or scheme.locomotion.decides(now)
            targets = scheme.update(robot.read(sees=sees, feels=self._feels))
        robot.write(targets)

    @property
    def pushes(self) -> tuple[ScheduledPush, ...]:
        """Pushes that have been applied or scheduled."""
        return self.robot.pushes

    @property
    def begun(self) -> StepStarted | None:
        """Step begun at the last tick, if any."""
        return self.walk.begun

    @property
    def is_moving(self) -> bool:
        """Whether it has left its standing state."""
        return self.walk.phase is not Phase.STANDING

    @property
    def has_fallen(self) -> bool:
        """Whether it has fallen, or has detected a fall.

        Raises:
            PolicyError: If a robot on learned legs fell before it could walk.
        """
        fallen, now = self.truth.has_fallen, self.robot.world.time
        if not fallen or self.maneuvers or now > AT_ONCE:
            return fallen or self.walk.phase is Phase.FALLEN
        raise PolicyError(
            f"legs: {self.name} fell at {now:.2f} s, while it was to "
            "stand: the contract does not fit the network"
        )

    def sample(self, *, closely: bool) -> dict[str, Any]:
        """Return its present motion, closely with all its signals."""
        robot, walk = self.robot, self.maneuvers
        found = super().sample(closely=closely)
        found |= {"zmp": robot.measured_zmp(), "qpos": robot.posture}
        if walk is not None:
            x, y, u, v = walk.planned_centers
            found["com_reference"] = self._in_world(x, y)
            found["zmp_reference"] = self._in_world(u, v)
        if not closely:
            return found
        stance = robot.stance
        found |= robot.signals(self.scheme.joint_targets) | {
            "velocity": stance.velocity,
            "tilt": stance.tilt,
            "phase": list(Phase).index(self.scheme.phase),
        }
        return found if walk is None else found | self._walk(walk, stance)

    def _in_world(self, x: float, y: float) -> tuple[float, float]:
        """Return a point of odometry in the world, in [m]."""
        return self.frame.compose(Pose(x, y, 0.0))[:2]

    def _walk(self, walk: ManeuverWalk, stance: TrueStance) -> dict[str, Any]:
        """Return foot states, references and estimates in the world."""
        frame, state = self.frame, walk.balance.state
        step = walk.step(self.robot.world.time)
        foot = step.swing.other
        estimate: tuple[float, ...] = (np.nan,) * 8
        if state is not None:
            turned = Pose(0.0, 0.0, frame.theta)
            estimate = (
                *self._in_world(*state.com),
                *turned.compose(Pose(*state.velocity, 0.0))[:2],
                *self._in_world(*state.zmp),
                *state.tilt,
            )
        (x, y, _), (u, v) = self.truth.position_com_in_world, stance.velocity
        eta = walk.gait.eta
        single = step.walking and step.remaining > 0.0
        return {
            "sole": stance.left_sole
            if foot is Foot.LEFT
            else stance.right_sole,
            "support": (foot.value, single, *frame.compose(step.support)),
            "heading_reference": walk.balance.planned_heading + frame.theta,
            "estimate": estimate,
            "dcm": (x + u / eta, y + v / eta),
        }

    def push(self, *pushes: Push) -> None:
        """Schedule pushes of the torso, now or later."""
        self.robot.push(*pushes)


class VelocityWalker(RobotPlayer):
    """Simulated robot that walks at velocities that another process commands.

    Attributes:
        description: Description of the robot.
    """

    scheme: VelocityScheme

    def __init__(
        self,
        robot: SimulatedRobot,
        scheme: VelocityScheme,
        frame: Pose,
        description: RobotDescription,
    ) -> None:
        """Combine a robot and its controller."""
        super().__init__(robot, scheme, frame)
        self.description = description
        self._forward = ForwardKinematics(description)
        self._image: ColourImage | None = None
        self._measured: tuple[int, RobotState] | None = None
        self._ignores_lateral = False

    def command(self, velocity: BodyVelocity) -> None:
        """Walk at a velocity from the next tick on.

        A walk by maneuvers has no sidesteps.
        """
        self.scheme.command(velocity)
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
        return self.scheme.velocity

    def tick(self) -> None:
        """Walk at the commanded velocity."""
        self.robot.write(self.scheme.update(self.measure()))

    def measure(self) -> RobotState:
        """Return the measurement of this tick, and keep its last image.

        Noise is drawn once.
        """
        ticks = self.robot.world.ticks
        if self._measured is None or self._measured[0] != ticks:
            self._measured = ticks, self.robot.read()
        measured = self._measured[1]
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
