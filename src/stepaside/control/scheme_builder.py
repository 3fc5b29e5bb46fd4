"""Putting a mind together: kinematics, balance, senses and scheme."""

from typing import TYPE_CHECKING, NamedTuple

from ..locomotion.zmp.control_settings import ControlSettings
from ..locomotion.zmp.feedback_loop import Balance, ClosedLoop, OpenLoop
from ..locomotion.zmp.feedforward import LoadFeedforward
from ..locomotion.zmp.stabiliser import Stabiliser
from ..locomotion.zmp.state_estimator import StateEstimator
from ..perception.measurement import Sighting
from ..planning import Direction, GaitSettings, ManeuverPlanner
from ..robots.description import RobotDescription
from ..robots.forward_kinematics import ForwardKinematics
from ..robots.leg_kinematics import LegKinematics
from ..strategies.strategy import Strategy
from .clearance.footholds import Footholds
from .clearance.guard import Guard
from .clearance.surroundings import Surroundings
from .clearance.swept_outline import BodyOutline, sway_of
from .scheme import ControlScheme
from .sight_sources import CameraSight, MeasuredSight
from .turn_calibration import TurnCalibration

if TYPE_CHECKING:
    from ..perception.perception import Perception


def build_balance(
    description: RobotDescription,
    gait: GaitSettings,
    control: ControlSettings,
    *,
    tick: float,
    delay: float,
    kinematics: LegKinematics,
    forward: ForwardKinematics | None = None,
) -> Balance:
    """What keeps a robot up, as its settings ask.

    Args:
        description: The robot.
        gait: How it walks.
        control: How it controls its walk.
        tick: Control period, in [s].
        delay: Time from a request to the motion, in [s].
        kinematics: Its joint motion generation.
        forward: Kinematics of the measured body, if somebody has it already.
    """
    loads = None
    if not control.feedback or control.stabiliser.load_share > 0.0:
        loads = LoadFeedforward(
            kinematics, zmp_forward=gait.zmp_forward, tick=tick
        )
    if not control.feedback:
        return OpenLoop(loads)
    forward = forward or ForwardKinematics(description)
    estimator = StateEstimator(
        forward, forward.force_sensors(), gait.eta, tick
    )
    return ClosedLoop(
        Stabiliser(
            *(control, estimator, gait),
            tick=tick,
            delay=delay,
            lean=description.lean,
        ),
        loads,
    )


class ClearanceSetup(NamedTuple):
    """What a robot knows of a room, and how clear it keeps.

    Attributes:
        surroundings: What it knows.
        outline: Of its body.
        margin: Distance that it keeps, in [m].
    """

    surroundings: Surroundings
    outline: BodyOutline
    margin: float


def build_scheme(
    strategy: Strategy,
    description: RobotDescription,
    gait: GaitSettings,
    control: ControlSettings,
    *,
    tick: float,
    delay: float = 0.0,
    sighting: Sighting | None = None,
    perception: "Perception | None" = None,
    clearance: ClearanceSetup | None = None,
) -> ControlScheme:
    """Control of one robot, whatever body it will move.

    Args:
        strategy: From what it knows to what it wants.
        description: The robot.
        gait: How it walks.
        control: How it controls its walk.
        tick: Control period, in [s].
        delay: Time from a request to the motion, in [s].
        sighting: What is known of the other before anything is seen.
        perception: What turns its images into sightings, if it has eyes.
        clearance: What it knows of a room, and how clear it keeps.

    Raises:
        ReachError: If the robot cannot stand as the gait asks.
    """
    kinematics = LegKinematics(description, tick=tick)
    if perception is not None:
        perception.around.behind = strategy.direction is Direction.BACKWARD
    scheme = ControlScheme(
        strategy,
        gait,
        kinematics,
        tick=tick,
        delay=delay,
        balance=build_balance(
            description,
            gait,
            control,
            tick=tick,
            delay=delay,
            kinematics=kinematics,
            forward=None if perception is None else perception.forward,
        ),
        senses=MeasuredSight(sighting)
        if perception is None
        else CameraSight(perception, tick=tick),
        guard=None
        if clearance is None
        else guard_of(clearance, gait, control),
    )
    if control.learn_turns:
        scheme.decisions.turns = TurnCalibration(tick)
    return scheme


def guard_of(
    clearance: ClearanceSetup, gait: GaitSettings, control: ControlSettings
) -> Guard:
    """What keeps a robot clear; with the MPC it also moves footsteps."""
    planner = ManeuverPlanner(gait)
    footholds = None
    if control.method == "mpc":
        needs = clearance.outline.radius + clearance.margin + sway_of(gait)
        footholds = Footholds(planner, control.stabiliser, needs)
    return Guard(
        clearance.surroundings,
        clearance.outline,
        planner,
        margin=clearance.margin,
        footholds=footholds,
    )
