"""A duel of robots that see: eyes, perception and their judges."""

from typing import Any

from ..errors import ConfigurationError

try:
    import cv2
except ImportError as error:
    raise ConfigurationError(
        "sensing with cameras needs OpenCV: pip install 'stepaside[vision]'"
    ) from error

from ..perception.perception import Perception
from ..poses import Array
from ..robots.description import RobotDescription
from ..robots.head import load_head
from ..sensing.colour_detector import BLUE, RED
from ..world.eyes import Eyes
from ..world.graphics import choose_renderer
from ..world.robot import SimulatedRobot
from ..world.room import furnisher
from .assembly import with_cycle
from .judge import Judge, Still
from .settings import DuelSettings

LOOKS = {"pursuer": BLUE, "evader": RED}  # what each looks for
STILLS = 5  # images that a duel keeps of each camera


class Seeing:
    """Everything that a duel with cameras has and an ideal one has not.

    Attributes:
        renderer: What draws the colour images.
        furnish: Puts walls, things and the depth camera into the world.
        perceptions: What each robot sees with, by name.
        judges: What judges it.
    """

    def __init__(
        self, settings: DuelSettings, description: RobotDescription
    ) -> None:
        """Prepare the senses of both robots.

        Raises:
            StepAsideError: If the robot has no head or the renderer does
                not work here.
        """
        # One core draws, sees and walks; threads would only wait.
        cv2.setNumThreads(1)
        self._settings, self._description = settings, description
        self._head = load_head(description)
        self.renderer = choose_renderer(settings.cameras.colour.renderer)
        self.furnish = furnisher(settings.room, "evader", self._head)
        tick = with_cycle(settings.physics, settings.body).tick
        self.perceptions = {
            name: Perception(description, self._head, look, tick=tick)
            for name, look in LOOKS.items()
            if name == "evader" or settings.pursuer == "robot"
        }
        self.judges: dict[str, Judge] = {}

    def open(self, robots: list[SimulatedRobot]) -> None:
        """Open the eyes of robots that stand in their world."""
        settings = self._settings
        places = [(thing.x, thing.y) for thing in settings.room.things]
        for own, other in (robots, robots[::-1]):
            if own.name not in self.perceptions:
                continue
            judge = Judge(
                own, other, self.perceptions[own.name], self._head, places
            )
            # Early on more happens: the times grow as squares.
            judge.still_times = tuple(
                0.98 * settings.duration * ((i + 0.5) / (STILLS - 0.5)) ** 2
                for i in range(STILLS)
            )
            own.eyes = Eyes(
                own.world,
                own.name,
                self._description.torso,
                self._head,
                settings.cameras,
                self.renderer,
                settings.seed,
                with_depth=own.name == "evader",
            )
            own.eyes.on_exposure = judge.note
            self.judges[own.name] = judge

    def sample(self, now: float) -> None:
        """Compare what both believe with the truth."""
        for judge in self.judges.values():
            judge.sample(now)

    def arrays(self) -> dict[str, Array]:
        """Beliefs beside the truth, by name of the robot."""
        return {
            f"{name}_sight": judge.array()
            for name, judge in self.judges.items()
        }

    def stills(self) -> dict[str, dict[str, list[Still]]]:
        """Images kept to be looked at, by robot and camera."""
        return {name: judge.stills for name, judge in self.judges.items()}

    def figures(self) -> dict[str, Any]:
        """Errors and rates, ready for JSON."""
        tallies = [
            tally
            for judge in self.judges.values()
            for tally in (judge.colour, judge.depth)
        ]
        shown = sum(t.shown for t in tallies)
        each = {name: j.figures() for name, j in self.judges.items()}
        return {
            "camera": self.renderer,
            "detection_rate": (
                sum(t.found for t in tallies) / shown if shown else None
            ),
            "false_detections": sum(t.false for t in tallies),
            "lost_s": sum(f["lost_s"] for f in each.values()),
            **each,
        }
