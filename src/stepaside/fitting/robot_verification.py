"""Verification of a robot: static requirements and walk trials."""

import re
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import replace
from math import degrees, radians
from typing import Any, NamedTuple

import mujoco
import numpy as np

from ..core.errors import StepAsideError
from ..games.game import play
from ..games.game_settings import walk
from ..games.outcome import Outcome
from ..games.player_settings import WALKER
from ..games.recorded_game import RecordedGame
from ..games.robot_settings import settings_from_description
from ..locomotion.control_settings import ControlSettings
from ..locomotion.zmp.reference_table import initial_stance
from ..planning import GaitSettings
from ..robots.description import FILE, REMEDY, RobotDescription
from ..robots.forward_kinematics import ForwardKinematics
from ..robots.leg_kinematics import LegKinematics
from ..robots.tree_compiler import compile_tree
from .gait_feasibility import TICK, step_loads

CYCLES = 8  # gait cycles of a walk after its first step
START_TIME = 2.5  # time for standing and start-up transients, in [s]
GREATEST_TILT = 8.0  # of the torso in a steady walk, in [deg]
GREATEST_COM_ERROR = 0.06  # rms in a steady walk, by the CoM height
GREATEST_DEVIATION = 0.15  # relative, of speed and turning from the plan
FALLEN = 10.0  # unsteadiness of a walk that ends in a fall


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


class WalkTrial(NamedTuple):
    """Walk of a robot along a path, with its own or other settings."""

    description: RobotDescription
    gait: GaitSettings
    control: ControlSettings
    path: TrialPath


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


def trials_of(
    description: RobotDescription, *, feedback: bool
) -> tuple[WalkTrial, ...]:
    """Return the walk trials of a robot along all paths."""
    own = settings_from_description(description)
    control = control_with(own.control, feedback)
    return tuple(
        WalkTrial(description, own.gait, control, path) for path in PATHS
    )


def walk_trial(trial: WalkTrial) -> WalkTrialResult:
    """Run a walk trial; an invalid one has an error message as its result."""
    gait, path = trial.gait, trial.path
    duration = (
        START_TIME + gait.start_support + 2 * CYCLES * gait.step_duration
    )
    settings = walk(
        path.bearing,
        backward=path.backward,
        duration=duration,
        robot=str(trial.description.folder),
        gait=gait,
        control=trial.control,
    ).resolved()
    feedback = bool(settings.player(WALKER).control.feedback)
    try:
        game = RecordedGame(settings, description=trial.description)
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
        degrees(trial.description.lean),
    )


GREATEST_FOOT_DIFFERENCE = 0.05  # from mirroring each other, by the CoM height
GREATEST_COM_OFFSET = 0.05  # lateral, by the CoM height
LEAST_REACH_MARGIN = 0.01  # of the CoM height, by the greatest in reach
GREATEST_STEP_LOAD = 0.95  # of a torque limit in a step
# Unsteadiness up to which the circle is within 5 % of theory.
ACCURATE = 0.35
TUNE = "`stepaside robot tune` searches for a"


class RequirementCheck(NamedTuple):
    """Result of one check."""

    name: str
    verdict: str  # "pass", "warn" or "fail"
    value: str  # measured value as text
    hint: str = ""  # remedy; empty if it passed


class VerificationReport(NamedTuple):
    """Result of a verification."""

    findings: tuple[RequirementCheck, ...]  # results of the checks
    # walk trials, open loop and with feedback; empty if the robot cannot stand
    walks: tuple[WalkTrialResult, ...]
    feedback: bool  # whether the description uses feedback

    @property
    def passes(self) -> bool:
        """Whether no check failed and the described walks are steady."""
        own = [w for w in self.walks if w.feedback == self.feedback]
        return (
            all(f.verdict != "fail" for f in self.findings)
            and bool(own)
            and all(walk.is_steady for walk in own)
        )

    def to_json(self) -> dict[str, Any]:
        """Return the report as values for JSON."""
        return {
            "passes": self.passes,
            "feedback": self.feedback,
            "findings": [finding._asdict() for finding in self.findings],
            "walks": [walk.to_json() for walk in self.walks],
        }


def check_robot(
    description: RobotDescription,
    executor: Executor,
    report: Callable[[int, int], None] | None = None,
) -> VerificationReport:
    """Check the requirements of a robot and run its walk trials."""
    found = check_requirements(description)
    if any(finding.verdict == "fail" for finding in found):
        return VerificationReport(tuple(found), (), False)
    own = trials_of(description, feedback=False)
    trials = (*own, *trials_of(description, feedback=True))
    walks: list[WalkTrialResult] = []
    for result in executor.map(walk_trial, trials):
        walks.append(result)
        if report is not None:
            report(len(walks), len(trials))
    feedback = bool(description.control.get("feedback", False))
    described = [each for each in walks if each.feedback == feedback]
    others = [each for each in walks if each.feedback != feedback]
    found += [_steadiness(described), _steadiness(others, described=False)]
    return VerificationReport(tuple(found), tuple(walks), feedback)


def check_requirements(
    description: RobotDescription,
) -> list[RequirementCheck]:
    """Check all requirements that need no walking.

    An invalid description ends the list with a failure that gives the
    reason.
    """
    results: list[RequirementCheck] = []
    for name, (check, hint) in CHECKS.items():
        try:
            results += check(description)
        except StepAsideError as error:
            results.append(RequirementCheck(name, "fail", str(error), hint))
            break
    return results


def _judge(
    name: str, value: str, verdict: str | None = None, hint: str = ""
) -> RequirementCheck:
    """Return a check that passes if there is no other verdict."""
    if verdict is None:
        return RequirementCheck(name, "pass", value)
    return RequirementCheck(name, verdict, value, hint)


def _kinematics(description: RobotDescription) -> Iterator[RequirementCheck]:
    tree = compile_tree(description)
    description.check(tree.bodies, tree.sites, tree.joints, tree.motors)
    yield _judge("free joint", f"at {description.torso}")
    legs = len(description.legs)
    yield _judge("joints", f"{len(tree.joints)}, of which {legs} in the legs")


def _estimates(description: RobotDescription) -> Iterator[RequirementCheck]:
    """Name the tables that ``robot init`` marked as estimates."""
    text = (description.folder / FILE).read_text(encoding="utf-8-sig")
    tables = re.findall(r"ASK:.*?\n\[([\w.]+)\]", text, re.DOTALL)
    yield _judge(
        "estimates",
        ", ".join(tables) or "none",
        "warn" if tables else None,
        "replace values marked by ASK by measured ones",
    )


def _masses(description: RobotDescription) -> Iterator[RequirementCheck]:
    model = description.compile()
    empty = [
        model.body(b).name
        for b in range(1, model.nbody)
        if model.body_jntnum[b] and model.body_subtreemass[b] <= 0.0
    ]
    total = f"{float(model.body_mass.sum()):.2f} kg"
    yield _judge(
        "masses",
        total + (f", none for {empty[0]}" if empty else ""),
        "fail" if empty else None,
        "give links an inertial",
    )
    forward = ForwardKinematics(description)
    standing = description.standing
    posture = forward.posture(
        np.array([standing.get(name, 0.0) for name in forward.tree.motors])
    )
    left, right = feet = posture.positions_feet_in_torso
    offset = posture.position_com_in_torso - feet.mean(axis=0)
    aside, high = abs(float(offset[1])), float(offset[2])
    apart = float(np.abs(left * (1.0, -1.0, 1.0) - right).max())
    mirrored = (
        aside < GREATEST_COM_OFFSET * high
        and apart < GREATEST_FOOT_DIFFERENCE * high
    )
    yield _judge(
        "mirror symmetry",
        f"CoM {1e3 * aside:.1f} mm off the middle of the feet, which are "
        f"{1e3 * apart:.1f} mm from mirroring each other",
        None if mirrored else "warn",
        "see standing: angles of both sides must mirror",
    )


def _sensors(description: RobotDescription) -> Iterator[RequirementCheck]:
    model = description.compile()
    names = {model.sensor(i).name for i in range(model.nsensor)}
    own = description.sensors
    required = (own.gyro, own.accelerometer, *own.feet)
    missing = [name for name in required if name not in names]
    yield _judge(
        "sensors",
        f"no {', '.join(missing)}" if missing else "IMU, 4 under each foot",
        "fail" if missing else None,
        f"name them in [sensors]; {REMEDY}",
    )


def _actuators(description: RobotDescription) -> Iterator[RequirementCheck]:
    model = description.compile()
    limits = _torque_limits(model)
    kinds = dict(zip(limits, model.actuator_biastype, strict=True))
    affine = mujoco.mjtBias.mjBIAS_AFFINE
    faults = {
        "no actuator for": [
            name
            for name in description.legs
            if name in description.speed_limits and name not in limits
        ],
        "no force range for": [n for n, high in limits.items() if high <= 0.0],
        "no position servo for": [n for n, k in kinds.items() if k != affine],
    }
    messages = [
        f"{text} {names[0]}" for text, names in faults.items() if names
    ]
    yield _judge(
        "actuators",
        "; ".join(messages) or f"{model.nu} servos with a force range",
        "fail" if messages else None,
        REMEDY,
    )


def _torque_limits(model: mujoco.MjModel) -> dict[str, float]:
    """Return the torque limit of each actuated joint, in [N m]."""
    return {
        model.joint(joint).name: float(high)
        for joint, high in zip(
            model.actuator_trnid[:, 0],
            model.actuator_forcerange[:, 1],
            strict=True,
        )
    }


def _reach(description: RobotDescription) -> Iterator[RequirementCheck]:
    gait = settings_from_description(description).gait
    stance = initial_stance(gait)
    legs = LegKinematics(description, tick=TICK)
    legs.stand(stance)
    _, highest = legs.com_heights(stance)
    near = highest - gait.com_height < LEAST_REACH_MARGIN * highest
    yield _judge(
        "reach",
        f"CoM at {gait.com_height:.3f} of {highest:.3f} m",
        "warn" if near else None,
        "lower gait.com_height: the knees get straight",
    )


def _strength(description: RobotDescription) -> Iterator[RequirementCheck]:
    gait = settings_from_description(description).gait
    torques = _torque_limits(description.compile())
    loads = step_loads(description, gait, torques)
    yield _judge(
        "torque of a step",
        f"{100.0 * loads.usual:.0f} % of the limit of {loads.joint}",
        "warn" if loads.usual > GREATEST_STEP_LOAD else None,
        f"see the torque limit of {loads.joint}: a step leaves no margin for "
        "feedback",
    )


CHECKS: dict[
    str, tuple[Callable[[RobotDescription], Iterator[RequirementCheck]], str]
] = {
    "kinematics": (_kinematics, REMEDY),
    "estimates": (_estimates, ""),
    "masses": (_masses, "give links an inertial"),
    "sensors": (_sensors, REMEDY),
    "actuators": (_actuators, REMEDY),
    "reach": (
        _reach,
        "change gait.com_height, foot_spacing or the standing angles",
    ),
    "torque": (_strength, "see [overlay.servos]"),
}
"""Checks without walking, with remedies for what they cannot compute."""


def _steadiness(
    walks: list[WalkTrialResult], *, described: bool = True
) -> RequirementCheck:
    """Check the walks with or without feedback."""
    name = "walks with feedback" if walks[0].feedback else "walks open loop"
    failed = [walk for walk in walks if not walk.is_steady]
    worst = max(failed or walks, key=lambda walk: walk.unsteadiness)
    if not failed:
        inaccurate = described and worst.unsteadiness > ACCURATE
        return _judge(
            name,
            f"all steady, at worst {worst.unsteadiness:.2f} of 1",
            "warn" if inaccurate else None,
            f"{TUNE} more accurate gait",
        )
    reason = worst.message
    if worst.completed:
        reason = f"{worst.unsteadiness:.2f} of 1"
    return _judge(
        name,
        f"{len(failed)} of {len(walks)} unsteady, worst {worst.way}: {reason}",
        "fail" if described else "warn",
        f"{TUNE} gait that walks"
        if described
        else "the description does not use it",
    )
