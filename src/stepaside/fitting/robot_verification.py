"""Verification of a robot: static requirements and walk trials."""

import re
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import replace
from math import degrees, radians
from typing import Any, NamedTuple

import mujoco
import numpy as np

from ..core.errors import StepAsideError
from ..games.game import Outcome, play
from ..games.game_settings import walk
from ..games.player_settings import settings_from_description
from ..games.recorded_game import RecordedGame
from ..locomotion.control_settings import ControlSettings, LegsSettings
from ..locomotion.zmp.reference_table import initial_stance
from ..robots.description import FILE, REMEDY, RobotDescription
from ..robots.forward_kinematics import ForwardKinematics
from ..robots.leg_kinematics import LegKinematics
from ..robots.tree_compiler import compile_tree
from ..strategies.body_departure import BodyDeparture
from .departure_measurement import SEEDS, combined, walk_departure
from .gait_feasibility import TICK, step_loads

CYCLES = 8  # gait cycles of a walk after its first step
START_TIME = 2.5  # time for standing and start-up transients, in [s]
GREATEST_TILT = 8.0  # of the torso in a steady walk, in [deg]
GREATEST_COM_ERROR = 0.06  # rms in a steady walk, by the CoM height
GREATEST_DEVIATION = 0.15  # relative, of speed and turning from the plan
FALLEN = 10.0  # unsteadiness of a walk that ends in a fall
GREATEST_FOOT_DIFFERENCE = 0.05  # from mirroring each other, by the CoM height
GREATEST_COM_OFFSET = 0.05  # lateral, by the CoM height
LEAST_REACH_MARGIN = 0.01  # of the CoM height, by the greatest in reach
GREATEST_STEP_LOAD = 0.95  # of a torque limit in a step
# Unsteadiness up to which the circle is within 5 % of theory.
ACCURATE = 0.35
TUNE = "`stepaside robot tune` searches for a"
FEEDBACK = "feedback = true in [control], with which it walks"


class TrialPath(NamedTuple):
    """Path of a walk trial."""

    name: str
    backward: bool
    bearing: float  # desired heading [rad]


PATHS = (
    TrialPath("forward", False, 0.0),
    TrialPath("backward", True, 0.0),
    TrialPath("turning left", False, radians(45.0)),
    TrialPath("backward, sharply left", True, radians(90.0)),
    TrialPath("backward, sharply right", True, radians(-90.0)),
)


class WalkTrialResult(NamedTuple):
    """Result of a walk trial."""

    way: str  # name of the path
    feedback: bool
    message: str
    completed: bool = False
    lasted: float = 0.0  # fraction of the duration that was walked
    # greatest tilt of the torso [deg]; None after an early fall
    tilt: float | None = None
    # rms error of the CoM by its height; None likewise
    strays: float | None = None
    speed: float | None = None  # speed by that of the plan; None likewise
    # turning by that of the plan; None also for a straight path
    turning: float | None = None
    # commanded lean of the torso [deg], which adds to the tilt
    lean: float = 0.0

    def to_json(self) -> dict[str, Any]:
        """Return the result as values for JSON."""
        return self._asdict() | {
            "steady": self.is_steady,
            "unsteadiness": self.unsteadiness,
        }

    @property
    def is_steady(self) -> bool:
        """Whether the walk was completed with all criteria met."""
        return self.completed and self.unsteadiness < 1.0

    @property
    def unsteadiness(self) -> float:
        """Greatest criterion by its limit; 10 to 11 after a fall."""
        if not self.completed:
            return FALLEN + 1.0 - self.lasted
        parts = [
            (self.tilt or 0.0) / (GREATEST_TILT + self.lean),
            (self.strays or 0.0) / GREATEST_COM_ERROR,
            abs((self.speed or 0.0) - 1.0) / GREATEST_DEVIATION,
        ]
        if self.turning is not None:
            parts.append(abs(self.turning - 1.0) / GREATEST_DEVIATION)
        return max(parts)


def control_with(control: ControlSettings, feedback: bool) -> ControlSettings:
    """Return control settings with or without feedback."""
    method = control.method if feedback else "closed-form"
    if feedback and not control.feedback:
        method = "measured"
    return replace(control, method=method, feedback=feedback)


def walk_trial(
    description: RobotDescription, path: TrialPath, feedback: bool
) -> WalkTrialResult:
    """Walk a robot along a path; if it cannot begin, the result says why."""
    own = settings_from_description(description)
    gait = own.gait
    duration = (
        START_TIME + gait.start_support + 2 * CYCLES * gait.step_duration
    )
    settings = walk(
        path.bearing,
        backward=path.backward,
        duration=duration,
        robot=str(description.folder),
        legs=LegsSettings(),  # steps are planned, also of one with a network
        gait=gait,
        control=control_with(own.control, feedback),
    ).resolved()
    try:
        game = RecordedGame(settings, description=description)
    except StepAsideError as error:
        return WalkTrialResult(path.name, feedback, str(error))
    play(game)
    run = game.run()
    walking = run.summary.walking
    assert walking is not None
    tracked = (walking.tracking[f"com_{axis}_m"] for axis in "xy")
    errors = [rms for rms in tracked if rms is not None]
    return WalkTrialResult(
        path.name,
        feedback,
        run.message,
        run.outcome is Outcome.COMPLETED,
        run.duration / duration,
        walking.tilt_max_deg,
        max(errors) / gait.com_height if len(errors) == 2 else None,
        walking.speed_ratio,
        walking.yaw_ratio if path.bearing else None,
        degrees(description.lean),
    )


class RequirementCheck(NamedTuple):
    """Result of one check."""

    name: str
    verdict: str  # "pass", "warn" or "fail"
    value: str  # measured value as text
    hint: str = ""  # remedy; empty if it passed


class VerificationReport(NamedTuple):
    """Result of a verification."""

    findings: list[RequirementCheck]
    # walk trials, open loop and with feedback; empty if the robot cannot stand
    walks: list[WalkTrialResult]
    feedback: bool  # whether the description uses feedback
    # of the body from its template; None if it was not measured, or fell
    departure: BodyDeparture | None = None

    @property
    def passes(self) -> bool:
        """Whether no check failed, those of the described walks included."""
        return all(f.verdict != "fail" for f in self.findings)

    def to_json(self) -> dict[str, Any]:
        """Return the report as values for JSON."""
        return {
            "passes": self.passes,
            "feedback": self.feedback,
            "findings": [finding._asdict() for finding in self.findings],
            "walks": [walk.to_json() for walk in self.walks],
            "departure_m": self.departure and self.departure._asdict(),
        }


def check_robot(
    description: RobotDescription,
    executor: Executor,
    report: Callable[[int, int], None],
) -> VerificationReport:
    """Check the requirements of a robot, and walk it along all paths."""
    found = check_requirements(description)
    feedback = bool(description.control.get("feedback", False))
    walks: list[WalkTrialResult] = []
    if any(finding.verdict == "fail" for finding in found):
        return VerificationReport(found, walks, feedback)
    paths = [(path, fed) for fed in (False, True) for path in PATHS]
    same, total = [description] * len(paths), len(paths) + len(SEEDS)
    for result in executor.map(walk_trial, same, *zip(*paths, strict=True)):
        walks.append(result)
        report(len(walks), total)
    settings = settings_from_description(description)
    departures: list[BodyDeparture | None] = []
    for departure in executor.map(
        walk_departure,
        *([description] * len(SEEDS), [settings] * len(SEEDS), SEEDS),
    ):
        departures.append(departure)
        report(len(walks) + len(departures), total)
    for described in (True, False):
        fed = feedback is described
        own = [each for each in walks if each.feedback is fed]
        found.append(_steadiness(own, described=described))
    open_loop, fed_back = found[-2:]
    if not feedback and fed_back.verdict == "pass" and open_loop.hint:
        hint = f"set {FEEDBACK}; or {open_loop.hint}"
        found[-2] = open_loop._replace(hint=hint)
    return VerificationReport(found, walks, feedback, combined(departures))


def check_requirements(
    description: RobotDescription,
) -> list[RequirementCheck]:
    """Check all requirements that need no walking.

    An invalid description ends the list with a failure that gives the
    reason.
    """
    results: list[RequirementCheck] = []
    for name, (check, verdict, hint) in CHECKS.items():
        try:
            value, passes = check(description)
        except StepAsideError as error:
            results.append(RequirementCheck(name, "fail", str(error), hint))
            break
        told = ("pass", value) if passes else (verdict, value, hint)
        results.append(RequirementCheck(name, *told))
    return results


Finding = tuple[str, bool]  # measured value as text, and whether it passes


def _kinematics(description: RobotDescription) -> Finding:
    tree = compile_tree(description)
    description.check(tree.bodies, tree.sites, tree.joints, tree.motors)
    legs = len(description.legs)
    return f"{len(tree.joints)} joints, of which {legs} in the legs", True


def _estimates(description: RobotDescription) -> Finding:
    """Name the tables that ``robot init`` marked as estimates."""
    text = (description.folder / FILE).read_text(encoding="utf-8-sig")
    tables = re.findall(r"ASK:.*?\n\[([\w.]+)\]", text, re.DOTALL)
    return ", ".join(tables) or "none", not tables


def _masses(description: RobotDescription) -> Finding:
    model = description.compile()
    empty = [
        model.body(b).name
        for b in range(1, model.nbody)
        if model.body_jntnum[b] and model.body_subtreemass[b] <= 0.0
    ]
    total = f"{float(model.body_mass.sum()):.2f} kg"
    return total + (f", none for {empty[0]}" if empty else ""), not empty


def _symmetry(description: RobotDescription) -> Finding:
    forward = ForwardKinematics(description)
    standing = description.standing
    posture = forward.posture(
        np.array([standing.get(name, 0.0) for name in forward.tree.motors])
    )
    left, right = feet = posture.positions_feet_in_torso
    offset = posture.position_com_in_torso - feet.mean(axis=0)
    aside, high = abs(float(offset[1])), float(offset[2])
    apart = float(np.abs(left * (1.0, -1.0, 1.0) - right).max())
    return (
        f"CoM {1e3 * aside:.1f} mm off the middle of the feet, which are "
        f"{1e3 * apart:.1f} mm from mirroring each other",
        aside < GREATEST_COM_OFFSET * high
        and apart < GREATEST_FOOT_DIFFERENCE * high,
    )


def _sensors(description: RobotDescription) -> Finding:
    model = description.compile()
    names = {model.sensor(i).name for i in range(model.nsensor)}
    own = description.sensors
    required = (own.gyro, own.accelerometer, *own.feet)
    missing = [name for name in required if name not in names]
    return (
        f"no {', '.join(missing)}" if missing else "IMU, 4 under each foot",
        not missing,
    )


def _actuators(description: RobotDescription) -> Finding:
    model = description.compile()
    limits = _torque_limits(model)
    kinds = dict(zip(limits, model.actuator_biastype, strict=True))
    affine = mujoco.mjtBias.mjBIAS_AFFINE
    faults = {
        "no force range for": [n for n, high in limits.items() if high <= 0.0],
        "no position servo for": [n for n, k in kinds.items() if k != affine],
    }
    said = [f"{text} {names[0]}" for text, names in faults.items() if names]
    return "; ".join(said) or f"{model.nu} servos with a force range", not said


def _torque_limits(model: mujoco.MjModel) -> dict[str, float]:
    """Return the torque limit of each actuated joint, in [N m]."""
    joints, ranges = model.actuator_trnid[:, 0], model.actuator_forcerange
    return {
        model.joint(joint).name: float(high)
        for joint, (_, high) in zip(joints, ranges, strict=True)
    }


def _reach(description: RobotDescription) -> Finding:
    gait = settings_from_description(description).gait
    stance = initial_stance(gait)
    legs = LegKinematics(description, tick=TICK)
    legs.stand(stance)
    _, highest = legs.com_heights(stance)
    far = highest - gait.com_height >= LEAST_REACH_MARGIN * highest
    return f"CoM at {gait.com_height:.3f} of {highest:.3f} m", far


def _standing(description: RobotDescription) -> Finding:
    """Compare what every servo holds while standing with its limit.

    Each foot carries half of the weight, in line with the CoM.
    """
    model = description.compile()
    data, limits = mujoco.MjData(model), _torque_limits(model)
    for joint, angle in description.standing.items():
        data.joint(joint).qpos[:] = angle
    mujoco.mj_forward(model, data)
    loads, jacobian = data.qfrc_bias.copy(), np.zeros((3, model.nv))
    body = model.body(description.torso).id
    weight = model.body_subtreemass[body] * -model.opt.gravity[2]
    for foot in (description.left_foot, description.right_foot):
        place = data.site(foot).xpos.copy()
        place[0] = data.subtree_com[body, 0]
        below = model.site_bodyid[model.site(foot).id]
        mujoco.mj_jac(model, data, jacobian, None, place, below)
        loads -= 0.5 * weight * jacobian[2]
    shares = {
        name: abs(float(loads[model.joint(name).dofadr[0]])) / high
        for name, high in limits.items()
    }
    most = max(shares, key=lambda name: shares[name])
    return f"{100.0 * shares[most]:.0f} % of the limit of {most}", (
        shares[most] < 1.0
    )


def _strength(description: RobotDescription) -> Finding:
    gait = settings_from_description(description).gait
    torques = _torque_limits(description.compile())
    loads = step_loads(description, gait, torques)
    return (
        f"{100.0 * loads.usual:.0f} % of the limit of {loads.joint}",
        loads.usual <= GREATEST_STEP_LOAD,
    )


Check = Callable[[RobotDescription], Finding]
CHECKS: dict[str, tuple[Check, str, str]] = {
    "kinematics": (_kinematics, "fail", REMEDY),
    "estimates": (
        *(_estimates, "warn"),
        "replace values marked by ASK by measured ones",
    ),
    "masses": (_masses, "fail", "give links an inertial"),
    "mirror symmetry": (
        *(_symmetry, "warn"),
        "see standing: angles of both sides must mirror",
    ),
    "sensors": (_sensors, "fail", f"name them in [sensors]; {REMEDY}"),
    "actuators": (_actuators, "fail", REMEDY),
    "reach": (
        *(_reach, "warn"),
        "change gait.com_height, foot_spacing or the standing angles: near "
        "the greatest height the knees get straight",
    ),
    "torque of standing": (
        *(_standing, "fail"),
        "its servo is too weak to stand, whatever the gait: see the torque "
        "limit in [overlay.servos] and the standing angles",
    ),
    "torque of a step": (
        *(_strength, "warn"),
        "see the torque limit in [overlay.servos]: a step leaves no margin "
        "for feedback",
    ),
}
"""Checks without walking, with the verdict and the remedy if they find a
fault; one that cannot compute fails."""


def _steadiness(
    walks: list[WalkTrialResult], *, described: bool
) -> RequirementCheck:
    """Check the walks with or without feedback."""
    name = "walks with feedback" if walks[0].feedback else "walks open loop"
    failed = [walk for walk in walks if not walk.is_steady]
    worst = max(failed or walks, key=lambda walk: walk.unsteadiness)
    if not failed:
        value = f"all steady, at worst {worst.unsteadiness:.2f} of 1"
        if described and worst.unsteadiness > ACCURATE:
            hint = f"{TUNE} more accurate gait"
            return RequirementCheck(name, "warn", value, hint)
        return RequirementCheck(name, "pass", value)
    reason = worst.message
    if worst.completed:
        reason = f"{worst.unsteadiness:.2f} of 1"
    value = (
        f"{len(failed)} of {len(walks)} unsteady, worst {worst.way}: {reason}"
    )
    if described:
        return RequirementCheck(name, "fail", value, f"{TUNE} gait that walks")
    return RequirementCheck(
        name, "warn", value, "the description does not use it"
    )
