"""Players of a game in physics: simulated robots, and others."""

from typing import TYPE_CHECKING, Any

from ..control.scheme import ControlScheme
from ..core.errors import PolicyError
from ..core.poses import Pose
from ..locomotion.locomotion import Phase
from ..locomotion.maneuver_walk import ManeuverWalk
from ..perception.measurement import RobotState
from ..sim.ground_truth import GroundTruth
from ..sim.simulated_robot import SimulatedRobot
from ..strategies.knowledge import Knowledge

if TYPE_CHECKING:
    from ..perception.pipeline import Perception

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
    def is_moving(self) -> bool:
        """Whether it has left its standing state."""
        return True

    def look(self) -> Knowledge | None:
        """Return the knowledge for a decision in this tick, if one is due."""

    def tick(self) -> None:
        """Perceive, decide and act; physics advances afterwards.

        Raises:
            ReachError: If its legs cannot reach their references.
            StrategyError: If its strategy gives no intent.
        """

    def sample(self, *, closely: bool) -> dict[str, Any]:
        """Return its present motion, by name of what is recorded.

        Closely with all that is measured of it. References of centers are in
        its odometry.
        """
        truth, place = self.truth, self.place_in_world
        torso = (*truth.position_torso_in_world, place.theta)
        com = truth.position_com_in_world
        return {"com": com, "place": place, "torso": torso}


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
        self._coasts = robot.sees_exactly and not scheme.decisions.body
        self._feels = scheme.locomotion.feels or not self._coasts
        robot.world.measures |= self._feels
        self._measured: tuple[int, RobotState] | None = None

    @property
    def perception(self) -> "Perception | None":
        """Perception by cameras, if it has one."""
        return self.scheme.senses.cameras

    def look(self) -> Knowledge | None:
        """Return the knowledge for a decision in this tick, if one is due."""
        due = self.walk.decides(self.robot.world.time)
        return self.scheme.look(self.measure()) if due else None

    def tick(self) -> None:
        """Read the sensors, decide, and send joint targets."""
        robot, scheme = self.robot, self.scheme
        now, targets = robot.world.time, None
        if not self._feels:
            targets = scheme.coast(now)
        if targets is None:
            sees = not self._coasts or scheme.locomotion.decides(now)
            targets = scheme.update(self.measure(sees=sees))
        robot.write(targets)

    def measure(self, *, sees: bool = True) -> RobotState:
        """Return the measurement of this tick; noise is drawn once."""
        ticks = self.robot.world.ticks
        if self._measured is None or self._measured[0] != ticks:
            read = self.robot.read(sees=sees, feels=self._feels)
            self._measured = ticks, read
        return self._measured[1]

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
        found: dict[str, Any] = robot.motion()
        if walk is not None:
            x, y, u, v = walk.planned_centers
            found |= {"com_reference": (x, y), "zmp_reference": (u, v)}
        if not closely:
            return found
        from .close_samples import close_samples

        return found | close_samples(robot, self.scheme, self.frame)
