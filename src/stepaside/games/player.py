"""Whoever plays: a walking robot, a person, later a robot elsewhere."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from ..control.walk_snapshots import StepStarted, WalkState
from ..core.poses import Array, Pose
from ..sim.ground_truth import GroundTruth
from ..sim.push import Push, ScheduledPush
from ..sim.true_stance import TrueStance

if TYPE_CHECKING:
    from ..perception.frame_report import FrameReport
    from ..sim.simulated_robot import SimulatedRobot


@dataclass(frozen=True, slots=True, eq=False)
class Snapshot:
    """A player at one instant, as far as it is known.

    What a player does not have is None: a person has no plan, a robot far
    away no true posture.

    Attributes:
        name: Who it is.
        time: The instant, in [s].
        place: What stands for it in the game, in the world: of a robot the
            point midway between its feet, of a person the trunk's axis; with
            its heading.
        torso: Origin and heading of the torso in the world.
        com: CoM (x, y, z) in the world, in [m].
        frame: Pose of its odometry in the world.
        walk: What it plans and asks of its body.
        zmp: Center of its foot forces in the world, in [m]; NaN in flight.
        posture: Position and quaternion of the torso, then its joints.
            Shape (7 + joints,).
        stance: How its torso and feet truly stand.
        pushes: Last pushes that it was given.
    """

    name: str
    time: float
    place: Pose
    torso: Pose
    com: tuple[float, float, float]
    frame: Pose | None = None
    walk: WalkState | None = None
    zmp: tuple[float, float] | None = None
    posture: Array | None = None
    stance: TrueStance | None = None
    pushes: tuple[ScheduledPush, ...] = ()


def snapshot_of(
    robot: "SimulatedRobot",
    *,
    frame: Pose | None = None,
    walk: WalkState | None = None,
) -> Snapshot:
    """State of a robot in the world at this instant.

    Args:
        robot: The robot.
        frame: Pose of its odometry in the world, where it is known.
        walk: What it plans, where it is known.
    """
    truth = robot.truth
    x, y, z = truth.com.tolist()
    return Snapshot(
        name=robot.name,
        time=robot.world.time,
        place=Pose(*truth.place, truth.heading),
        torso=Pose(*truth.position, truth.heading),
        com=(x, y, z),
        frame=frame,
        walk=walk,
        zmp=robot.measured_zmp(),
        posture=robot.posture,
        stance=robot.stance,
        pushes=robot.pushes,
    )


class Player(Protocol):
    """Whoever plays.

    Attributes:
        name: Who it is.
        truth: Where it really is, for the rules of the game and the record.
        begun: Step that it began at the last tick, if it did.
        reports: What the images that reached it at the last tick show.
    """

    name: str

    @property
    def truth(self) -> GroundTruth:
        """Where it really is."""

    @property
    def begun(self) -> StepStarted | None:
        """Step that it began at the last tick, if it did."""

    @property
    def reports(self) -> "Sequence[FrameReport]":
        """What the images that reached it at the last tick show."""

    @property
    def is_moving(self) -> bool:
        """Whether it walks, rather than stands and waits."""

    @property
    def has_fallen(self) -> bool:
        """Whether it lies, or feels that it falls."""

    def tick(self) -> None:
        """Perceive, decide and act; time passes afterwards, for all.

        Raises:
            ReachError: If its legs lose what they are asked for.
            StrategyError: If its strategy gives no intent.
        """

    def snapshot(self) -> Snapshot:
        """State of this instant."""

    def push(self, *pushes: Push) -> None:
        """Let somebody push it, now or later.

        Raises:
            ConfigurationError: If it is nobody who can be pushed.
        """

    def close(self) -> None:
        """Let go of what it holds."""
