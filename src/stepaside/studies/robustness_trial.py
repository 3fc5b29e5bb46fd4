"""Trials of a robustness campaign: walks under a disturbance."""

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cache
from math import pi, radians

from ..core.errors import ConfigurationError
from ..games.outcome import Outcome
from ..games.robot_settings import game_settings_from_description
from ..games.walk_game import run_walk
from ..games.walk_settings import WalkSettings
from ..locomotion.zmp.control_settings import ControlSettings, Method
from ..planning import GaitSettings
from ..robots.description import load_robot
from ..robots.forward_kinematics import ForwardKinematics
from ..sim.body_settings import BODIES, BodySettings
from ..sim.push import Push
from .settings_diff import OWN, changed_walk
from .tabulation import Record

DIRECTIONS = {"left": 90.0, "right": -90.0, "forward": 0.0, "backward": 180.0}
STRENGTHS: dict[str, tuple[float, ...]] = {
    "push": (0.4, 0.8, 1.0, 1.2, 1.4, 1.6, 2.0, 2.4, 2.8, 3.2),
    "friction": (0.05, 0.1, 0.2, 0.3, 0.5, 0.8),
    "unevenness": (0.0, 0.002, 0.003, 0.005, 0.008),
    "delay": (0.0, 2.0, 3.0, 4.0, 6.0),
    "backlash": (0.0, 0.5, 1.0, 2.0, 3.0),
    "noise": (0.0, 1.0, 2.0, 4.0, 8.0),
    "model": (0.0, 0.03, 0.06, 0.1, 0.2),
}
KINDS = (*STRENGTHS, "person")  # for the last see encounters
UNITS = {
    "push": "N s",
    "friction": "1",
    "unevenness": "m",
    "delay": "cycles",
    "backlash": "deg",
    "noise": "times the preset",
    "model": "relative mass error",
}
METHODS = ("open-loop", "closed-form", "measured", "mpc")
BEFORE = 6  # steps before a push
AFTER = 4.0  # time after a push, in [s]
REFERENCE = "nao"  # robot to which strengths of pushes refer


@dataclass(frozen=True, slots=True)
class RobustnessTrial:
    """One walk of a campaign.

    Attributes:
        kind: Disturbance, a key of ``STRENGTHS``.
        strength: In the unit of ``UNITS``.
        direction: Direction of a push, a key of ``DIRECTIONS``; else empty.
        phase: Phase of a push, as a fraction of the gait cycle.
        seed: Seed of the walk.
        method: One of ``METHODS``.
        body: Preset of the body; ``OWN`` for the one of ``changes``.
        changes: Other settings that differ from the default, as JSON; see
            :func:`~.settings_diff.changes_of`.
    """

    kind: str
    strength: float
    direction: str
    phase: float
    seed: int
    method: str
    body: str
    changes: str = ""

    @property
    def key(self) -> str:
        """Key of the trial in a file of results."""
        values = list(asdict(self).values())
        return json.dumps(values if self.changes else values[:-1])


def control_of(
    method: str, control: ControlSettings | None = None
) -> ControlSettings:
    """Return the control settings of a method.

    Args:
        method: One of ``METHODS``.
        control: Settings to change; the default ones by default.
    """
    named: dict[str, Method] = {
        "open-loop": "closed-form",
        "closed-form": "closed-form",
        "measured": "measured",
        "mpc": "mpc",
    }
    return replace(
        control or ControlSettings(),
        method=named[method],
        feedback=method != "open-loop",
    )


def push_time(
    phase: float, control: ControlSettings, gait: GaitSettings | None = None
) -> float:
    """Return the time at which a push at a phase begins, in [s]."""
    gait = gait or GaitSettings()
    begins = gait.start_support + (1.0 if control.feedback else 0.0)
    return begins + (BEFORE + 2.0 * phase) * gait.step_duration


def walk_of(trial: RobustnessTrial) -> WalkSettings:
    """Return the walk of a trial without its disturbance."""
    walk = changed_walk(trial.changes)
    return replace(
        walk,
        seed=trial.seed,
        body=walk.body if trial.body == OWN else BODIES[trial.body],
        control=control_of(trial.method, walk.control),
    )


@cache
def mass_of(robot: str) -> float:
    """Return the mass of a robot, in [kg]."""
    return float(ForwardKinematics(load_robot(robot)).mass)


def push_scale(robot: str) -> float:
    """Return the factor on pushes of NAO for the same effect on a robot.

    It is the ratio of the push units of their descriptions, which scale with
    mass and pendulum speed; without them, the ratio of the masses.
    """
    own, nao = (
        game_settings_from_description(load_robot(name))
        for name in (robot, REFERENCE)
    )
    if own is None or nao is None:
        return mass_of(robot) / mass_of(REFERENCE)
    return own.push_unit / nao.push_unit


def settings_of(trial: RobustnessTrial) -> WalkSettings:
    """Return the walk of a trial with its disturbance.

    Raises:
        ConfigurationError: If the kind is unknown.
    """
    walk = walk_of(trial)
    body, physics, control = walk.body, walk.physics, walk.control
    x = trial.strength
    if trial.kind == "push":
        time = push_time(trial.phase, control, walk.gait)
        direction = radians(DIRECTIONS[trial.direction])
        impulse = x * push_scale(walk.robot)
        return replace(
            walk,
            duration=time + AFTER,
            pushes=(Push(impulse, time, direction),),
        )
    if trial.kind in ("friction", "unevenness"):
        physics = (
            replace(physics, friction=x)
            if trial.kind == "friction"
            else replace(physics, unevenness=x)
        )
    elif trial.kind == "delay":
        body = replace(
            body, cycle=0.012, delay_cycles=round(x), imu_delay_cycles=1
        )
    elif trial.kind == "backlash":
        body = replace(body, backlash=x * pi / 180.0)
    elif trial.kind == "noise":
        body = with_noise(body, x)
    elif trial.kind == "model":
        body = replace(body, mass_error=x, com_error=0.1 * x)
    else:
        raise ConfigurationError(
            f"kind must be one of {', '.join(STRENGTHS)}, got {trial.kind!r}"
        )
    return replace(walk, duration=20.0, body=body, physics=physics)


def with_noise(body: BodySettings, factor: float) -> BodySettings:
    """Return a body with the noise and bias of "hardware" times a factor."""
    hardware = BODIES["hardware"]
    names = (
        "gyro_noise",
        "gyro_bias",
        "accelerometer_noise",
        "accelerometer_bias",
        "force_noise",
        "force_gain_error",
    )
    return replace(
        body, **{name: factor * getattr(hardware, name) for name in names}
    )


def run_trial(trial: RobustnessTrial) -> Record:
    """Run a trial; return whether the walk was completed."""
    result = run_walk(settings_of(trial), record=False)
    if result.outcome is Outcome.INTERRUPTED:
        raise KeyboardInterrupt
    return {"survived": result.outcome is Outcome.COMPLETED}


def trials(
    kinds: Iterable[str],
    methods: Sequence[str],
    body: str,
    *,
    seeds: int,
    first_seed: int = 1,
    changes: str = "",
) -> Iterator[RobustnessTrial]:
    """Yield a grid of strengths and seeds; for pushes see ``push_limits``."""
    for method in methods:
        for kind in kinds:
            if kind == "push":
                continue
            for strength in STRENGTHS[kind]:
                for seed in range(first_seed, first_seed + seeds):
                    yield RobustnessTrial(
                        kind, strength, "", 0.0, seed, method, body, changes
                    )
