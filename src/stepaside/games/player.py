"""Interface of a player: a simulated robot, a person or a served robot."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from ..core.errors import ConfigurationError
from ..core.poses import Array, Pose
from ..core.row_table import RowTable
from ..locomotion.locomotion import StepStarted
from ..locomotion.maneuver_walk import ManeuverWalk
from ..sim.ground_truth import GroundTruth
from ..sim.push import Push, ScheduledPush

if TYPE_CHECKING:
    from ..perception.pipeline import FrameReport


@dataclass(frozen=True, slots=True, eq=False)
class Snapshot:
    """State of a player at one instant.

    Quantities that a player does not have are None: a person has no plan.

    Attributes:
        name: Name of the player.
        time: The instant, in [s].
        place: Reference point and heading in the world. The reference point
            of a robot is midway between its feet, that of a person on the
            axis of the trunk.
        torso: Origin and heading of the torso in the world.
        com: CoM (x, y, z) in the world, in [m].
        frame: Pose of its odometry in the world.
        walk: State of its walk: plan, references and estimates.
        zmp: Center of its foot forces in the world, in [m]; NaN in flight.
        pushes: Pushes that have been applied or scheduled.
    """

    name: str
    time: float
    place: Pose
    torso: Pose
    com: tuple[float, float, float]
    frame: Pose | None = None
    walk: ManeuverWalk | None = None
    zmp: tuple[float, float] | None = None
    pushes: tuple[ScheduledPush, ...] = ()


class MotionLog(Protocol):
    """Samples of the motion of a player."""

    def add(self) -> None:
        """Sample the present state."""

    def truncate(self, count: int) -> None:
        """Keep only the first samples."""

    def arrays(self) -> dict[str, Array]:
        """Return arrays by their name in :class:`Trajectory`."""


class TruthLog:
    """Samples of the true state of a player without a simulated body."""

    def __init__(self, truth: GroundTruth) -> None:
        """Begin without samples."""
        self._truth = truth
        self._table = RowTable(8)

    def add(self) -> None:
        """Sample the present state."""
        truth = self._truth
        self._table.append()[:] = (
            *truth.position_com_in_world,
            *truth.position_reference_in_world,
            *truth.position_torso_in_world,
            truth.heading_in_world,
        )

    def truncate(self, count: int) -> None:
        """Keep only the first samples."""
        self._table.truncate(count)

    def arrays(self) -> dict[str, Array]:
        """Return CoM, reference point and torso."""
        rows = self._table.rows
        return {
            "com": rows[:, :3].copy(),
            "place": rows[:, [3, 4, 7]],
            "torso": rows[:, 5:].copy(),
        }


class Player:
    """Player of a game in physics: a robot, a person or a moved body.

    Attributes:
        name: Name of the player.
        truth: True state, for the rules of the game and the record.
    """

    name: str
    truth: GroundTruth

    @property
    def begun(self) -> StepStarted | None:
        """Step begun at the last tick, if any."""
        return None

    @property
    def reports(self) -> "Sequence[FrameReport]":
        """Detections of the images that arrived at the last tick."""
        return ()

    @property
    def is_ready(self) -> bool:
        """Whether it is ready for the game to begin."""
        return True

    @property
    def is_moving(self) -> bool:
        """Whether it has left its standing state."""
        return True

    @property
    def has_fallen(self) -> bool:
        """Whether it has fallen, or has detected a fall."""
        return False

    def start(self) -> None:
        """Receive the signal that the game begins."""

    def tick(self) -> None:
        """Perceive, decide and act; physics advances afterwards.

        Raises:
            ReachError: If its legs cannot reach their references.
            StrategyError: If its strategy gives no intent.
        """

    def snapshot(self) -> Snapshot:
        """Return the state at this instant."""
        raise NotImplementedError

    def motion_log(self, *, closely: bool) -> MotionLog:
        """Return an empty log of its motion.

        Args:
            closely: Whether to include foot states and estimates.
        """
        return TruthLog(self.truth)

    def push(self, *pushes: Push) -> None:
        """Schedule pushes of the torso, now or later.

        Raises:
            ConfigurationError: If the player cannot be pushed.
        """
        raise ConfigurationError(
            f"only a robot can be pushed, got {self.name}"
        )

    def close(self) -> None:
        """Release its resources."""
