"""Player that is a person."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..core.errors import ConfigurationError
from ..core.poses import Pose
from ..locomotion.walk_snapshots import StepStarted
from ..sim.ground_truth import GroundTruth
from ..sim.person_body import PersonBody
from ..sim.push import Push
from .player import Snapshot, TruthLog

if TYPE_CHECKING:
    from ..perception.percept_stages import FrameReport


class PersonPlayer:
    """Person with a prescribed motion.

    Attributes:
        name: Name of the player.
        person: Body of the person in the world.
        truth: Its true state.
        begun: None: a person plans no footsteps.
        reports: Empty: a person has no cameras.
        is_ready: True.
        is_moving: True.
        has_fallen: False: a person does not fall.
    """

    begun: StepStarted | None = None
    reports: "Sequence[FrameReport]" = ()
    is_ready = True
    is_moving = True
    has_fallen = False

    def __init__(self, person: PersonBody, other: GroundTruth) -> None:
        """Take a person and the true state of the robot that it watches."""
        self.name, self.person = person.name, person
        self.truth: GroundTruth = person.truth
        self._other = other

    def start(self) -> None:
        """Do nothing: a person begins with the simulation."""

    def tick(self) -> None:
        """Advance the motion by one tick."""
        self.person.step(self._other.position_torso_in_world)

    def snapshot(self) -> Snapshot:
        """Return the state at this instant."""
        truth = self.truth
        x, y, z = truth.position_com_in_world.tolist()
        return Snapshot(
            name=self.name,
            time=self.person.world.time,
            place=Pose(
                *truth.position_reference_in_world, truth.heading_in_world
            ),
            torso=Pose(*truth.position_torso_in_world, truth.heading_in_world),
            com=(x, y, z),
        )

    def motion_log(self, *, closely: bool) -> TruthLog:
        """Return an empty log of its motion; a person has no estimates."""
        return TruthLog(self.truth)

    def push(self, *pushes: Push) -> None:
        """Reject pushes.

        Raises:
            ConfigurationError: Always.
        """
        raise ConfigurationError(
            f"a push needs a robot, got {self.name}, which is a person"
        )

    def close(self) -> None:
        """Do nothing: a person holds no resources."""
