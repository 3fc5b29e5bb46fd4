"""Real-time pursuit and evasion for humanoid robots.

What most people need stands at this door; it is imported when it is first
used, so that ``import stepaside`` itself costs nothing.
"""

from .doors import door

TYPE_CHECKING = False  # of typing, which would be loaded first
__version__ = "0.1.0"

if TYPE_CHECKING:
    from .control import Body as Body
    from .control import ControlScheme as ControlScheme
    from .control.assembly import build_scheme as build_scheme
    from .control.balance.settings import ControlSettings as ControlSettings
    from .errors import StepAsideError as StepAsideError
    from .games import Duel as Duel
    from .games import DuelRun as DuelRun
    from .games import DuelSettings as DuelSettings
    from .games import Outcome as Outcome
    from .games import Run as Run
    from .games import WalkRun as WalkRun
    from .games import run_duel as run_duel
    from .games.configuration import load_configuration as load_configuration
    from .games.folder import load_run as load_run
    from .games.settings import StartSettings as StartSettings
    from .games.walk import run_walk as run_walk
    from .games.walk_settings import WalkSettings as WalkSettings
    from .planning import Direction as Direction
    from .planning import Foot as Foot
    from .planning import GaitSettings as GaitSettings
    from .planning import ManeuverPlan as ManeuverPlan
    from .planning import ManeuverPlanner as ManeuverPlanner
    from .report.compare_figure import draw_comparison as draw_comparison
    from .report.duel_figure import draw_duel as draw_duel
    from .report.plan_figure import draw_plan as draw_plan
    from .report.replay_page import write_page as write_page
    from .report.run_folder import write_run as write_run
    from .robots.configuration import Configuration as Configuration
    from .robots.description import load_robot as load_robot
    from .robots.stored import load_tree as load_tree
    from .sensing.measurement import Measurement as Measurement
    from .sensing.measurement import Sighting as Sighting
    from .strategies import Evasion as Evasion
    from .strategies import Intent as Intent
    from .strategies import Knowledge as Knowledge
    from .strategies import Pursuit as Pursuit
    from .strategies import Strategy as Strategy
    from .strategies import load_strategy as load_strategy
    from .unicycle import Start as Start
    from .unicycle import find_circle as find_circle
    from .unicycle import make_game as make_game
    from .unicycle import play_games as play_games
    from .unicycle.certificate import certify as certify
    from .unicycle.simulate import simulate as simulate
    from .world.body_settings import BODIES as BODIES
    from .world.body_settings import BodySettings as BodySettings
    from .world.push import Push as Push

_HOMES = {
    "control": ("Body", "ControlScheme"),
    "control.assembly": ("build_scheme",),
    "control.balance.settings": ("ControlSettings",),
    "errors": ("StepAsideError",),
    "games": (
        "Duel",
        "DuelRun",
        "DuelSettings",
        "Outcome",
        "Run",
        "WalkRun",
        "run_duel",
    ),
    "games.configuration": ("load_configuration",),
    "games.folder": ("load_run",),
    "games.settings": ("StartSettings",),
    "games.walk": ("run_walk",),
    "games.walk_settings": ("WalkSettings",),
    "planning": (
        "Direction",
        "Foot",
        "GaitSettings",
        "ManeuverPlan",
        "ManeuverPlanner",
    ),
    "report.compare_figure": ("draw_comparison",),
    "report.duel_figure": ("draw_duel",),
    "report.plan_figure": ("draw_plan",),
    "report.replay_page": ("write_page",),
    "report.run_folder": ("write_run",),
    "robots.configuration": ("Configuration",),
    "robots.description": ("load_robot",),
    "robots.stored": ("load_tree",),
    "sensing.measurement": ("Measurement", "Sighting"),
    "strategies": (
        "Evasion",
        "Intent",
        "Knowledge",
        "Pursuit",
        "Strategy",
        "load_strategy",
    ),
    "unicycle": (
        "Start",
        "find_circle",
        "make_game",
        "play_games",
    ),
    "unicycle.certificate": ("certify",),
    "unicycle.simulate": ("simulate",),
    "world.body_settings": ("BODIES", "BodySettings"),
    "world.push": ("Push",),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = ["__version__", *sorted(_HOME_OF)]  # noqa: PLE0604

if not TYPE_CHECKING:
    __getattr__ = door(__name__, _HOME_OF)


def __dir__() -> list[str]:
    """Names at the door."""
    return sorted(__all__)
