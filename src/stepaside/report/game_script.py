"""JavaScript of an ideal duel: formulas, constant maps and model.

Kinematics and joint loads are the formulas that :mod:`.expression_tracing`
generates; the planner is traced, and its schedules are constant maps; laws
and loops are translated from their Python source.
"""

import inspect
import re
from base64 import b64encode
from collections.abc import Mapping, Sequence
from math import ceil, pi, tau
from typing import Any, NamedTuple
from xml.etree import ElementTree

import mujoco
import numpy as np

from ..control.maneuver_walk import SETTLING, ManeuverWalk
from ..core.errors import ConfigurationError
from ..core.javascript import javascript_of
from ..core.poses import Array
from ..games.duel import Duel
from ..games.duel_settings import EVADER, DuelSettings
from ..games.policy_player import PolicyPlayer
from ..games.walker import SimulatedPlayer
from ..locomotion.zmp.feedback_loop import OpenLoop
from ..locomotion.zmp.feedforward import BOUND, LoadFeedforward
from ..locomotion.zmp.feedforward import LOOP as OFFSET_LOOP
from ..planning import CenterState, GaitSettings, ManeuverPlanner
from ..planning.footsteps import beside_path
from ..planning.maneuver import plan_inputs
from ..planning.path import arc_then_line
from ..planning.schedule import Schedule
from ..planning.template_path import SHORT, STILL
from ..robots.description import load_robot
from ..robots.expression_tracing import ExpressionTrace, Formula
from ..robots.ik_step import step_loop, trace_step
from ..robots.joint_loads import LIFTED
from ..robots.leg_kinematics import LegKinematics
from ..sim.body_settings import BODIES
from ..sim.ground_truth import FALLEN
from ..sim.physics_settings import SightSettings
from ..sim.servos import WRITE_LOOP
from ..sim.simulated_robot import motor_of
from ..sim.world import build_model
from ..strategies import Evasion
from ..theory import laws
from .legs_script import legs_data, legs_sources

LAWS = (
    *(laws.wrap_once, laws.evasion_heading, laws.side_behind),
    *(laws.update_side, laws.is_evading),
)
MAX_OFFSETS = 16  # of the starts of plans from ticks
MODEL_PARTS = (
    *("actuator_", "body_", "dof_", "eq_"),
    *("geom_", "jnt_", "site_"),
)


class WalkingParts(NamedTuple):
    """Parts of a robot that walks in open loop.

    Attributes:
        walk: Its locomotion.
        kinematics: Joint motion generation.
        feedforward: Feedforward of servo deflection.
    """

    walk: ManeuverWalk
    kinematics: LegKinematics
    feedforward: LoadFeedforward

    @classmethod
    def of(cls, player: object) -> "WalkingParts":
        """Take the parts of a player.

        Raises:
            ConfigurationError: If it walks in any other way.
        """
        if isinstance(player, SimulatedPlayer):
            walk = player.scheme.locomotion
            if isinstance(walk, ManeuverWalk) and isinstance(
                walk.balance, OpenLoop
            ):
                feedforward = walk.balance.feedforward
                legs = walk.kinematics.legs
                plain = legs.is_plain and legs.lean == 0.0
                reacts = walk.gait.swing_reaction > 0.0
                if feedforward is not None and plain and not reacts:
                    return cls(walk, walk.kinematics, feedforward)
        raise ConfigurationError(
            "a page plays duels of ideal robots that walk by maneuvers in "
            "open loop, such as two NAOs with the paper's gait"
        )


def check_playable(settings: DuelSettings) -> None:
    """Check that a page can play a duel.

    Raises:
        ConfigurationError: If it cannot.
    """
    strategies = (settings.pursuer_strategy, settings.evader_strategy)
    law = settings.strategy
    alike = settings.robot_of("pursuer") == settings.robot_of(EVADER)
    if (
        strategies != ("pursuit", "evasion")
        or law.trigger != "distance"
        or law.saturated
        or not alike
        or settings.sensing != "ideal"
        or settings.sight != SightSettings()
        or settings.body != BODIES["ideal"]
        or settings.physics.slope + settings.physics.unevenness > 0.0
        or settings.pushes
        or settings.room.things
        or settings.room.plan
        or settings.passers
    ):
        raise ConfigurationError(
            "a page plays the paper's duel: two equal robots with ideal "
            "bodies and sensing on a level floor, pursuit, and evasion by "
            "distance and eq. (4)"
        )


def game_script(duel: Duel) -> str:
    """Return ``makeFormulas``, which returns the functions of a duel.

    Args:
        duel: Duel whose robots are of one kind.
    """
    if isinstance(duel.pursuer, PolicyPlayer):
        robot = duel.settings.robot_of("pursuer").robot
        return functions_of(legs_sources(load_robot(robot)))
    parts = WalkingParts.of(duel.pursuer)
    legs = parts.kinematics.legs
    step = trace_step(legs, parts.kinematics.description.standing)
    loads = parts.feedforward.loads.formulas
    plans = schedules_of(ManeuverPlanner(parts.walk.gait))
    sources = [
        *(step.text, step_loop(legs)),
        *(loads.tick_formula.text, loads.loop),
        *(OFFSET_LOOP, WRITE_LOOP),
        *(trace_plan(f"plan_{n}", s).text for n, s in plans.items()),
    ]
    return functions_of(sources)


def functions_of(sources: Sequence[str]) -> str:
    """Return ``makeFormulas`` of the laws and of further functions.

    Args:
        sources: Functions in Python.
    """
    constants = {"pi": pi, "tau": tau}
    sources = [*(inspect.getsource(law) for law in LAWS), *sources]
    functions = [javascript_of(text, constants) for text in sources]
    names = re.findall(r"^function (\w+)", "\n".join(functions), re.MULTILINE)
    lines = [*functions, f"return {{ {', '.join(names)} }};"]
    return "\n".join(["function makeFormulas() {", *lines, "}"])


def schedules_of(planner: ManeuverPlanner) -> dict[str, Schedule]:
    """Return the schedules of a start, of a step and of a halt."""
    count = planner.settings.horizon
    return {
        "start": planner.schedule(count, standing=True),
        "step": planner.schedule(count, standing=False),
        "halt": planner.schedule(1, standing=False),
    }


def trace_plan(name: str, schedule: Schedule) -> Formula:
    """Trace the planner, for gains whose arcs outlast the plan.

    Args:
        name: Name of the function.
        schedule: Schedule of the plan; of one footstep, a halt.

    Returns:
        Function of desired heading [rad], driving velocity [m/s], gain
        [1/s], and the side of the first foot; pose of the swing foot, then
        of the support foot, which is 0, in the plan frame; position and
        velocity of the CoM. Its results are the placements and the inputs
        of a :class:`~stepaside.planning.plan.ManeuverPlan`, row by row.
    """
    trace, gait, n = ExpressionTrace(), schedule.settings, schedule.count

    def variables(*names: str) -> Any:
        return [trace.variable(name) for name in names]

    bearing, velocity, gain, side = variables(
        *("bearing", "velocity", "gain", "side")
    )
    feet = [
        variables(*(f"{foot}_{axis}" for axis in "xyt"))
        for foot in ("swing", "support")
    ]
    x, y, u, v = variables(*(f"com_{each}" for each in "xyuv"))
    times = gait.path_interval * np.arange(1.0, n + 1.0)
    half = 0.5 * gait.foot_spacing * side
    if n == 1:
        steps = np.array([[feet[1][0], 2.0 * half, feet[1][2]]])
    else:
        # Arrays of one element, which NumPy multiplies by those of times.
        rate = np.array([laws.proportional_rate(bearing, gain)])
        driven = np.array([velocity])
        path = arc_then_line(times, 0.0 * times, rate, driven)
        steps = beside_path(path, half)
    placements = np.concatenate([np.array(feet), steps])
    state = CenterState((x, y), (u, v))
    inputs = plan_inputs(schedule, placements, state)
    results = [*placements.ravel().tolist(), *inputs.ravel().tolist()]
    return trace.formula(name, results)


def game_data(duel: Duel) -> dict[str, Any]:
    """Return the values of a duel at its start, as plain values.

    Args:
        duel: Duel whose robots are of one kind, before its first tick.
    """
    physics = duel.world.physics
    if isinstance(duel.pursuer, PolicyPlayer):
        return common_data(duel) | {"learned": legs_data(duel)}
    parts = [WalkingParts.of(player) for player in duel.players]
    own, gait = parts[0], parts[0].walk.gait
    legs, tree = own.kinematics.legs, own.kinematics.legs.tree
    columns = dict(zip(tree.joints, legs.columns[1:], strict=True))
    fixed = dict(zip(tree.joints, legs.fixed, strict=True))
    planner = ManeuverPlanner(gait)
    return common_data(duel) | {
        "free": len(legs.free),
        "state": own.kinematics.state,
        "posture": own.kinematics.posture.tolist(),
        "columns": [columns[name] for name in tree.motors],
        "fixed": [fixed[name] for name in tree.motors],
        "limits": np.column_stack(
            [legs.speeds * physics.tick, legs.low, legs.high]
        ).tolist(),
        "legs": own.feedforward.loads.leg_motors,
        "masses": own.feedforward.loads.formulas.coordinates,
        "compliance": own.feedforward.compliance.tolist(),
        "weight": own.feedforward.gain.tolist(),
        "memory": own.feedforward.memory.tolist(),
        "bound": BOUND,
        "lifted": LIFTED,
        "still": STILL,
        "short": SHORT * gait.foot_spacing,
        "spacing": gait.foot_spacing,
        "height": gait.com_height,
        "support": gait.single_support,
        "eta": gait.eta,
        "most_gain": 1.0 / (gait.horizon * gait.path_interval),
        "plans": {
            name: schedule_data(schedule, name, physics.tick)
            for name, schedule in schedules_of(planner).items()
        },
        "servos": [servo_data(player) for player in duel.players],
    }


def common_data(duel: Duel) -> dict[str, Any]:
    """Return the values that games on any legs have.

    Args:
        duel: Duel whose robots are of one kind, before its first tick.
    """
    settings, physics = duel.settings, duel.world.physics
    first: Any = duel.pursuer
    gait: GaitSettings = first.scheme.gait
    return {
        "tick": physics.tick,
        "steps": physics.steps_per_tick,
        "fallen": FALLEN,
        "ahead": gait.zmp_forward,
        "step": gait.step_duration,
        "speed": gait.speed,
        "gain": gait.gain,
        "players": [player_data(duel, player) for player in duel.players],
        "start": [
            settings.start.distance,
            settings.start.pursuer_offset,
            settings.start.evader_offset,
        ],
        "evasion": evasion_data(settings.strategy),
        "model": model_data(duel),
    }


def evasion_data(law: Evasion) -> dict[str, float | None]:
    """Return the parameters of the evader; None for never."""
    release = law.release_distance
    return {
        "angle": law.angle,
        "radius": law.safety_radius,
        "release": release if np.isfinite(release) else None,
        "hysteresis": law.side_hysteresis,
    }


def servo_data(player: Any) -> list[list[float]]:
    """Return lead and reach of a robot's servos."""
    servos = player.robot.servos
    return [servos.lead.tolist(), servos.reach.tolist()]


def player_data(duel: Duel, player: Any) -> dict[str, Any]:
    """Return the addresses of a robot in the model, and its servos."""
    model, robot = duel.world.model, player.robot
    description = load_robot(duel.settings.robot_of(player.name).robot)
    torso = int(model.body(f"{player.name}/{description.torso}").id)
    feet = description.left_foot, description.right_foot
    motors = [
        motor_of(model, model.joint(f"{player.name}/{name}").id)
        for name in robot.joint_names
    ]
    return {
        "name": player.name,
        "direction": player.scheme.decisions.strategy.direction.value,
        "torso": torso,
        "bodies": [torso, torso + int((model.body_rootid == torso).sum())],
        "soles": [model.site(f"{player.name}/{foot}").id for foot in feet],
        "qpos": robot.qpos_slice.start,
        "joints": len(motors),
        "ctrl": motors[0],
        "hips": description.place.forward,
        "radius": player.truth.reach,
    }


def schedule_data(
    schedule: Schedule, name: str, tick: float
) -> dict[str, Any]:
    """Return the maps of a schedule at the ticks of its first part.

    Plans begin when a step ends, which need not be on a tick: there are maps
    for each offset that occurs.

    Raises:
        ConfigurationError: If the step takes no rational number of ticks.
    """
    first = schedule.first_step_duration
    lasts = schedule.duration + SETTLING if name == "halt" else first
    period = schedule.settings.step_duration
    begins = np.arange(1 if name == "start" else MAX_OFFSETS + 1) * period
    offsets = np.ceil((begins - 1e-9) / tick) * tick - begins
    offsets = sorted(set(np.round(np.maximum(offsets, 0.0), 9).tolist()))
    if len(offsets) > MAX_OFFSETS:
        raise ConfigurationError(
            f"steps of a page must end on one of {MAX_OFFSETS} parts of the "
            f"control period, {tick:g} [s], got a step of {period:g} [s]"
        )
    landing = schedule.first_step_sampler.pendulum
    return {
        "first": first,
        "lasts": lasts,
        "begun": float(schedule.starts[1]) if schedule.standing else 0.0,
        "standing": schedule.standing,
        "landing": landing.tolist(),
        "maps": [
            map_data(schedule, offset, lasts, tick) for offset in offsets
        ],
    }


def map_data(
    schedule: Schedule, offset: float, lasts: float, tick: float
) -> dict[str, Any]:
    """Return the maps at the ticks from an offset on, in [s]."""
    count = max(1, ceil((lasts - offset) / tick - 1e-6))
    sampler = schedule.sampler(offset + tick * np.arange(count))
    return {
        "offset": offset,
        "count": count,
        "pendulum": packed(sampler.pendulum),
        "feet": packed(sampler.feet),
        "heights": packed(
            np.stack([sampler.support_height, sampler.swing_height])
        ),
    }


def model_data(duel: Duel) -> dict[str, Any]:
    """Return the model as XML, and its numbers in full precision.

    XML has six digits.
    """
    settings, world = duel.settings, duel.world
    specs: list[mujoco.MjSpec] = []
    robots = {
        name: load_robot(settings.robot_of(name).robot)
        for name in settings.robots
    }
    model = build_model(
        *(robots, world.physics, settings.body, settings.seed),
        furnish=specs.append,
        rendered=False,
    )
    # Older versions of MuJoCo refuse this attribute; it is the default.
    xml = specs[0].to_xml().replace(' input="pos"', "")
    xml, hulls = inline_meshes(xml, model)
    arrays: Mapping[str, Array] = {
        name: getattr(world.model, name)
        for name in dir(world.model)
        if name.startswith(MODEL_PARTS)
    } | {"mesh_vert": hulls}
    return {
        "xml": xml,
        "arrays": {
            name: packed(array)
            for name, array in arrays.items()
            if isinstance(array, np.ndarray) and array.dtype == np.float64
        },
    }


def inline_meshes(xml: str, model: mujoco.MjModel) -> tuple[str, Array]:
    """Write the convex hulls of meshes into a model instead of their files.

    MuJoCo collides hulls only.

    Args:
        xml: Model.
        model: The same model, compiled.

    Returns:
        The model, and the vertices of all hulls in the frames of the
        compiled meshes, in [m]. Shape (n, 3).
    """
    root, hulls = ElementTree.fromstring(xml), [np.zeros((0, 3))]
    for element in root.iterfind("asset/mesh"):
        name = element.attrib["name"]
        number = model.mesh(name).id
        first = int(model.mesh_vertadr[number])
        graph = int(model.mesh_graphadr[number])
        count = int(model.mesh_graph[graph])
        corners = model.mesh_graph[graph + 2 + count : graph + 2 + 2 * count]
        hulls.append(model.mesh_vert[first + corners].astype(np.float64))
        vertices = " ".join(f"{x:.7g}" for x in hulls[-1].ravel().tolist())
        element.attrib.clear()
        element.attrib.update(name=name, vertex=vertices, inertia="convex")
    return ElementTree.tostring(root, encoding="unicode"), np.concatenate(
        hulls
    )


def packed(array: Array) -> str:
    """Return an array of doubles as text."""
    return b64encode(array.astype("<f8").tobytes()).decode("ascii")
