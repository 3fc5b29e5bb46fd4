from .control import ControlScheme as ControlScheme
from .control.scheme import build_walk as build_walk
from .core.errors import StepAsideError as StepAsideError
from .core.poses import Pose as Pose
from .drivers.robot import CameraImage as CameraImage
from .drivers.robot import CameraMount as CameraMount
from .drivers.robot import HeadLimits as HeadLimits
from .drivers.robot import JointRobot as JointRobot
from .drivers.robot import JointTargets as JointTargets
from .drivers.robot import VelocityLimits as VelocityLimits
from .drivers.robot import VelocityRobot as VelocityRobot
from .games import GameSettings as GameSettings
from .games import Outcome as Outcome
from .games import PlayerSettings as PlayerSettings
from .games import RecordedGame as RecordedGame
from .games import Run as Run
from .games import duel as duel
from .games import run_game as run_game
from .games import walk as walk
from .games.game_settings import StartSettings as StartSettings
from .games.run_archive import load_run as load_run
from .games.settings_reader import load_game as load_game
from .locomotion.control_settings import ControlSettings as ControlSettings
from .perception.measurement import RobotState as RobotState
from .perception.measurement import RobotStatus as RobotStatus
from .perception.measurement import Sighting as Sighting
from .planning import Direction as Direction
from .planning import Foot as Foot
from .planning import GaitSettings as GaitSettings
from .planning import ManeuverPlan as ManeuverPlan
from .planning import ManeuverPlanner as ManeuverPlanner
from .report.plan_view import draw_plan as draw_plan
from .report.replay_page import write_page as write_page
from .report.run_figure import draw_run as draw_run
from .report.run_figure import draw_runs as draw_runs
from .report.run_folder import write_run as write_run
from .robots.description import load_robot as load_robot
from .robots.tree_cache import load_tree as load_tree
from .sim.body_settings import BODIES as BODIES
from .sim.body_settings import BodySettings as BodySettings
from .sim.push import Push as Push
from .strategies import Evasion as Evasion
from .strategies import Intent as Intent
from .strategies import Knowledge as Knowledge
from .strategies import Pursuit as Pursuit
from .strategies import Strategy as Strategy
from .strategies import load_strategy as load_strategy
from .studies import load_study as load_study
from .studies import make_study as make_study
from .studies import run_study as run_study
from .studies import tabulate as tabulate
from .theory.unicycle import RelativeStart as RelativeStart
from .theory.unicycle import Unicycles as Unicycles
from .theory.unicycle import find_circle as find_circle
from .theory.unicycle import play_games as play_games
from .theory.unicycle.certificate import certify as certify
from .theory.unicycle.simulation import simulate as simulate

__version__: str

__all__ = [
    "BODIES",
    "BodySettings",
    "CameraImage",
    "CameraMount",
    "ControlScheme",
    "ControlSettings",
    "Direction",
    "Evasion",
    "Foot",
    "GaitSettings",
    "GameSettings",
    "HeadLimits",
    "Intent",
    "JointRobot",
    "JointTargets",
    "Knowledge",
    "ManeuverPlan",
    "ManeuverPlanner",
    "Outcome",
    "PlayerSettings",
    "Pose",
    "Pursuit",
    "Push",
    "RecordedGame",
    "RelativeStart",
    "RobotState",
    "RobotStatus",
    "Run",
    "Sighting",
    "StartSettings",
    "StepAsideError",
    "Strategy",
    "VelocityLimits",
    "VelocityRobot",
    "__version__",
    "build_walk",
    "certify",
    "draw_plan",
    "draw_run",
    "draw_runs",
    "duel",
    "find_circle",
    "load_game",
    "load_robot",
    "load_run",
    "load_strategy",
    "load_study",
    "load_tree",
    "Unicycles",
    "make_study",
    "play_games",
    "run_game",
    "run_study",
    "simulate",
    "tabulate",
    "walk",
    "write_page",
    "write_run",
]
