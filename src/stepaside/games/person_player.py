"""A player that is a person."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..control.walk_snapshots import StepStarted
from ..core.errors import ConfigurationError
from ..core.poses import Pose
from ..sim.ground_truth import GroundTruth
from ..sim.person_body import PersonBody
from ..sim.push import Push
from .player import Snapshot

if TYPE_CHECKING:
    from ..perception.frame_report import FrameReport


class PersonPlayer:
    """A person who walks, whatever the robots do about it.

    Attributes:
        name: Who it is in the game.
        person: The figure in the world.
        truth: Where it is.
        begun: None: its steps are no plans of ours.
        reports: None: it sees with its own eyes.
        is_moving: True.
        has_fallen: False: this person does not fall.
    """

    begun: StepStarted | None = None
    reports: "Sequence[FrameReport]" = ()
    is_moving = True
    has_fallen = False

    def __init__(self, person: PersonBody, other: GroundTruth) -> None:
        """Let a person know where the other is: people see."""
        self.name, self.person = person.name, person
        self.truth: GroundTruth = person.truth
        self._other = other

    def tick(self) -> None:
        """Walk on."""
        self.person.step(self._other.position)

    def snapshot(self) -> Snapshot:
        """State of this instant."""
        truth = self.truth
        x, y, z = truth.com.tolist()
        return Snapshot(
            name=self.name,
            time=self.person.world.time,
            place=Pose(*truth.place, truth.heading),
            torso=Pose(*truth.position, truth.heading),
            com=(x, y, z),
        )

    def push(self, *pushes: Push) -> None:
        """Refuse.

        Raises:
            ConfigurationError: Always.
        """
        raise ConfigurationError(
            f"a push needs a robot, got {self.name}, who is a person"
        )

    def close(self) -> None:
        """Nothing to let go of."""
