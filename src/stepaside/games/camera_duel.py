"""A duel of robots that see: eyes, perception and their judges."""

from collections.abc import Mapping, Sequence

from ..core.errors import ConfigurationError

try:
    import cv2
except ImportError as error:
    raise ConfigurationError(
        "sensing with cameras needs OpenCV: pip install 'stepaside[vision]'"
    ) from error

from ..core.poses import Array
from ..perception.colour_detector import LOOKS
from ..perception.floor_map import FloorMap
from ..perception.gaze import OFTEN, SELDOM
from ..perception.perception import Perception
from ..robots.description import RobotDescription
from ..robots.head import load_head
from ..sim.ground_truth import GroundTruth
from ..sim.offscreen_rendering import choose_renderer
from ..sim.room_furnishing import furnisher
from ..sim.sensor_suite import SensorSuite
from ..sim.simulated_robot import SimulatedRobot
from ..sim.world import World
from .duel_settings import DuelSettings
from .initial_poses import walls_of
from .match import Match
from .outcome import Outcome
from .sight_evaluation import EvaluatedImage, SightEvaluator
from .sight_summary import PerceptionSummary, SightReport

GLANCES = {"pursuer": SELDOM, "evader": OFTEN}  # around, to map
STILLS = 5  # images that a duel keeps of each camera


class CameraSenses:
    """Everything that a duel with cameras has and an ideal one has not.

    Attributes:
        renderer: What draws the colour images.
        furnish: Puts walls, things and the depth camera into the world.
        perceptions: What each robot sees with, by name.
    """

    def __init__(
        self,
        settings: DuelSettings,
        description: RobotDescription,
        names: Sequence[str],
        *,
        tick: float,
    ) -> None:
        """Prepare the senses of some robots.

        Args:
            settings: Of the duel, with the start filled in.
            description: The robots.
            names: Who they are.
            tick: Control period, in [s].

        Raises:
            StepAsideError: If the robot has no head or the renderer does
                not work here.
        """
        # One core draws, sees and walks; threads would only wait.
        cv2.setNumThreads(1)
        self._settings, self._description = settings, description
        self._head = load_head(description)
        self.renderer = choose_renderer(settings.cameras.colour.renderer)
        self._people = settings.pursuer == "person"
        self._maps = (
            settings.room.plan is not None and settings.map.source == "seen"
        )
        # Where people come the evader alone is a robot.
        self._low = tuple(names) if self._people or self._maps else ()
        self.furnish = furnisher(
            settings.room,
            "evader",
            self._head,
            walls=walls_of(settings),
            lower=self._low,
        )
        self.perceptions = {
            name: Perception(
                description,
                self._head,
                LOOKS[name],
                tick=tick,
                floor=FloorMap() if self._maps else None,
                glances=GLANCES[name] if self._maps else None,
                people=self._people,
            )
            for name in names
        }
        for name, perception in self.perceptions.items():
            if self._maps and name == "pursuer":
                perception.around.company.append(self.perceptions["evader"])

    def eyes(self, world: World, name: str) -> SensorSuite:
        """Open the eyes of a robot of a world."""
        return SensorSuite(
            world,
            name,
            self._description.torso,
            self._head,
            self._settings.cameras,
            self.renderer,
            self._settings.seed,
            with_depth=self._maps or name == "evader",
            looks_low=self.perceptions[name].looks_low
            if name in self._low
            else None,
        )

    def judge(
        self, robot: SimulatedRobot, other: GroundTruth, *, wears_trim: bool
    ) -> SightEvaluator:
        """Judge of what a robot sees of another, who may wear its trim."""
        settings = self._settings
        # Early on more happens: the times grow as squares.
        times = tuple(
            0.98 * settings.duration * ((i + 0.5) / (STILLS - 0.5)) ** 2
            for i in range(STILLS)
        )
        places = [(thing.x, thing.y) for thing in settings.room.things]
        perception = self.perceptions[robot.name]
        return SightEvaluator(
            robot,
            other,
            perception,
            self._head,
            places,
            times,
            wears_trim=wears_trim,
        )


class SightObserver:
    """Lets the judges look on while a game is played.

    Attributes:
        judges: One for each robot that sees, by name.
    """

    def __init__(
        self,
        judges: Mapping[str, SightEvaluator],
        renderer: str,
        *,
        every: int,
    ) -> None:
        """Look on.

        Args:
            judges: Of each robot, by name.
            renderer: What draws the colour images.
            every: Control ticks between samples of their beliefs.
        """
        self.judges = dict(judges)
        self._renderer, self._every = renderer, every

    def before(self, match: Match) -> None:
        """Compare what all believe with the truth, when it is due."""
        if match.world.ticks % self._every == 0:
            for judge in self.judges.values():
                judge.sample(match.world.time)

    def acted(self, match: Match) -> None:
        """Judge what was seen at this tick."""
        for judge in self.judges.values():
            judge.look()

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Nothing is left to be seen."""

    def sight(self) -> dict[str, Array]:
        """Beliefs beside the truth, by name of the robot."""
        return {name: judge.array() for name, judge in self.judges.items()}

    def stills(self) -> dict[str, dict[str, list[EvaluatedImage]]]:
        """Images kept to be looked at, by robot and camera."""
        return {name: judge.stills for name, judge in self.judges.items()}

    def figures(self) -> SightReport:
        """Errors and rates."""
        tallies = [
            tally
            for judge in self.judges.values()
            for tally in (judge.colour, judge.depth)
        ]
        shown = sum(t.shown for t in tallies)
        each = {name: j.figures() for name, j in self.judges.items()}
        found = sum(t.found for t in tallies)
        together = PerceptionSummary(
            camera=self._renderer,
            detection_rate=found / shown if shown else None,
            false_detections=sum(t.false for t in tallies),
            lost_s=sum(f.lost_s for f in each.values()),
        )
        return SightReport(together, each)
