"""Construction of a control scheme from settings."""

from typing import NamedTuple

from ..locomotion.control_settings import ControlSettings
from ..locomotion.guard import FootstepAdjustment
from ..locomotion.guard import Guard
from ..locomotion.maneuver_walk import ManeuverWalk
from ..locomotion.guard import Surroundings
from ..locomotion.swept_outline import BodyOutline, lateral_sway
from ..locomotion.zmp.stabiliser import build_balance
from ..planning import GaitSettings, ManeuverPlanner
from ..robots.description import RobotDescription
from ..robots.forward_kinematics import ForwardKinematics
from ..robots.leg_kinematics import LegKinematics
from ..strategies.strategy import Strategy
from .scheme import ControlScheme
from .sight_sources import CameraSight, MeasuredSight, SightSource
from .strategy_runner import StrategyRunner
from .turn_calibration import TurnCalibration


class ClearanceSetup(NamedTuple):
    """Known obstacles, body outline and required clearance of one robot."""

    surroundings: Surroundings  # known obstacles
    outline: BodyOutline
    margin: float  # required clearance [m]


def build_scheme(
    strategy: Strategy,
    description: RobotDescription,
    gait: GaitSettings,
    control: ControlSettings,
    *,
    tick: float,
    delay: float = 0.0,
    senses: SightSource | None = None,
    clearance: ClearanceSetup | None = None,
) -> ControlScheme:
    """Build the control scheme of one robot that walks by maneuvers.

    Args:
        strategy: Strategy of the player.
        description: Robot description.
        gait: Gait.
        control: Control settings.
        tick: Control period, in [s].
        delay: Time from a command to the motion, in [s].
        senses: Source of sightings; by default those that measurements
            bring.
        clearance: Known obstacles and required clearance, if any.

    Raises:
        ReachError: If the standing posture of the gait is out of reach.
    """
    forward = None
    if isinstance(senses, CameraSight):
        body = senses.perception.kinematics
        forward = None if body is None else body.forward
    walk = build_walk(
        *(description, gait, control),
        tick=tick,
        delay=delay,
        clearance=clearance,
        forward=forward,
    )
    decisions = StrategyRunner(
        strategy,
        gait,
        None if clearance is None else clearance.surroundings,
        TurnCalibration(tick) if control.learn_turns else None,
    )
    return ControlScheme(decisions, walk, senses or MeasuredSight())


def build_walk(
    description: RobotDescription,
    gait: GaitSettings,
    control: ControlSettings,
    *,
    tick: float,
    delay: float = 0.0,
    clearance: ClearanceSetup | None = None,
    forward: ForwardKinematics | None = None,
) -> ManeuverWalk:
    """Build the walk by maneuvers of one robot; see :func:`build_scheme`.

    ``forward`` are the kinematics of the measured body; built if not given.
    """
    legs = LegKinematics(description, tick=tick)
    balance = build_balance(
        *(description, gait, control),
        tick=tick,
        delay=delay,
        kinematics=legs,
        forward=forward,
    )
    guard = None
    if clearance is not None:
        guard = build_guard(clearance, gait, control)
    return ManeuverWalk(
        gait, legs, balance, tick=tick, delay=delay, guard=guard
    )


def build_guard(
    clearance: ClearanceSetup, gait: GaitSettings, control: ControlSettings
) -> Guard:
    """Build the guard; with the MPC it also adjusts footsteps."""
    planner = ManeuverPlanner(gait)
    footholds = None
    if control.method == "mpc":
        radius = (
            clearance.outline.radius + clearance.margin + lateral_sway(gait)
        )
        footholds = FootstepAdjustment(planner, control.stabiliser, radius)
    return Guard(
        clearance.surroundings,
        clearance.outline,
        planner,
        margin=clearance.margin,
        footholds=footholds,
    )
