"""Decompose the effect of a push: ZMP, angular momentum, early landing.

The ground force on a pendulum points from the ZMP to the CoM. For a body, the
moment pivot is the point where a ground force through the CoM would meet the
floor. Outside the feet it is unreachable for a pendulum; a body reaches it by
rotating: ``m g`` times its distance from the ZMP is the rate of the angular
momentum about the CoM.
"""

from dataclasses import replace
from math import cos, radians, sin
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from benchmark_options import RESULTS, ask

from stepaside.core.poses import Array
from stepaside.games.walk_game import WalkGame
from stepaside.games.walk_settings import WALKER
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlanner,
)
from stepaside.planning.push_bound import push_bound
from stepaside.planning.steady_gait import steady_plan
from stepaside.studies.result_files import header, read_result, write_result
from stepaside.studies.robustness_trial import (
    DIRECTIONS,
    RobustnessTrial,
    settings_of,
)
from stepaside.studies.survival_statistics import (
    PUSH,
    foot_reach,
    push_bound_at,
)

GAIT = GaitSettings()


def ground(model: Any, data: Any, foot: int) -> tuple[Array, float]:
    """Return the centre of pressure, in [m], and one foot's load fraction."""
    total, share, moment, force = 0.0, 0.0, np.zeros(2), np.zeros(6)
    for i, contact in enumerate(data.contact):
        mujoco.mj_contactForce(model, data, i, force)
        total += force[0]
        moment += force[0] * contact.pos[:2]
        if foot in model.geom_bodyid[contact.geom]:
            share += force[0]
    total = max(total, 1e-9)
    return moment / total, share / total


def bound_with_landing(
    trial: RobustnessTrial, rest: float, mass: float
) -> float:
    """Return the bound for another landing time, in [N s]."""
    passed = 2.0 * trial.phase * GAIT.step_duration
    foot = Foot.LEFT if passed < GAIT.step_duration else Foot.RIGHT
    walk = steady_plan(
        ManeuverPlanner(GAIT), 0.0, Direction.FORWARD, first_foot=foot
    )
    now = walk.sample([passed % GAIT.step_duration])
    x, y = now.com[0].tolist()
    vx, vy = now.com_velocity[0].tolist()
    plan = ManeuverPlanner(replace(GAIT, single_support=rest)).plan(
        0.0,
        Direction.FORWARD,
        first_foot=foot,
        state=CenterState((x, y), (vx, vy)),
    )
    angle = radians(DIRECTIONS[trial.direction])
    return push_bound(plan, 0.0, angle, mass, foot_reach(), lasts=PUSH)


def follow(trial: RobustnessTrial) -> dict[str, float | str | bool]:
    """Return moment pivot and ZMP from the push until the swing foot lands.

    The push must be in single support.

    Means are weighted by exp(-eta t) from the beginning of the push, as in the
    DCM dynamics. Lengths are from the ankle of the stance foot, along the
    push, in [mm].
    """
    walking = WalkGame(settings_of(trial), recorded=False)
    world, walker = walking.world, walking.walker
    robot, scheme = walker.robot, walker.scheme
    model, data = world.model, world.data
    torso = model.body(f"{WALKER}/torso").id
    [push] = walking.settings.pushes
    heading = np.array([cos(push.direction), sin(push.direction)])
    mass = float(model.body_subtreemass[torso])
    rows: list[tuple[float, ...]] = []
    landing, stood, before = np.inf, True, np.zeros(3)
    edge = 0.0
    while stood and world.time < walking.settings.duration:
        stood = walking.tick() is None
        mujoco.mj_subtreeVel(model, data)
        velocity = data.subtree_linvel[torso].copy()
        now = world.time
        step = scheme.locomotion.step(now)
        waiting = not rows and step.remaining <= 0.0
        if now < push.time or now > landing or waiting:
            before = velocity
            continue
        if not rows:
            landing = now + step.remaining
            foot = step.swing.other.name.lower()
            site = getattr(scheme.kinematics.description, f"{foot}_foot")
            stands = model.site(f"{WALKER}/{site}").id
            site = getattr(
                scheme.kinematics.description,
                f"{step.swing.name.lower()}_foot",
            )
            swings = int(model.site(f"{WALKER}/{site}").bodyid[0])
            sole, left = GAIT.sole, foot == "left"
            sides = (sole.outer, sole.inner)
            edge = (heading[0] > 0.5) * sole.front
            edge -= (heading[0] < -0.5) * sole.back
            edge += (heading[1] > 0.5) * sides[0 if left else 1]
            edge += (heading[1] < -0.5) * sides[1 if left else 0]
        force = mass * (velocity - before) / robot.tick
        force[2] += mass * GAIT.gravity
        if now <= push.time + PUSH:
            force[:2] -= push.impulse / PUSH * heading
        before = velocity
        com = robot.truth.position_com_in_world
        ankle = data.site_xpos[stands]
        pivot = com[:2] - com[2] * force[:2] / force[2] - ankle[:2]
        zmp, share = ground(model, data, swings)
        zmp -= ankle[:2]
        momentum = data.subtree_angmom[torso]
        rows.append(
            (
                now - push.time,
                1e3 * float(pivot @ heading),
                1e3 * float(zmp @ heading),
                float(heading[0] * momentum[1] - heading[1] * momentum[0]),
                share,
            )
        )
    table = np.array(rows)
    lifted = int(np.argmax(table[:, 4] < 0.01))
    bears = lifted + np.argmax(table[lifted:, 4] > 0.1)
    early = table[-1, 0] - table[bears, 0] if bears > lifted else 0.0
    weight = np.exp(-GAIT.eta * table[:, 0])
    pivot_mm, zmp_mm = (weight @ table[:, 1:3] / weight.sum()).tolist()
    return {
        "method": trial.method,
        "direction": trial.direction,
        "phase": trial.phase,
        "impulse_n_s": trial.strength,
        "bound_n_s": push_bound_at(trial.direction, trial.phase),
        "survived": stood,
        "until_landing_s": float(table[-1, 0]),
        "landed_too_early_by_s": float(early),
        "bound_if_landed_then_n_s": bound_with_landing(
            trial, float(table[-1, 0] - early), mass
        ),
        "edge_mm": 1e3 * edge,
        "mean_moment_pivot_mm": pivot_mm,
        "mean_zmp_mm": zmp_mm,
        "farthest_zmp_mm": float(table[:, 2].max()),
        "largest_angular_momentum_nms": float(np.abs(table[:, 3]).max()),
    }


def trials_above(file: Path) -> list[RobustnessTrial]:
    """Return the largest survived pushes above their bound, from a result."""
    made = read_result(file)
    body, seed = made["settings"]["body"], made["settings"]["seed"]
    return [
        RobustnessTrial(
            *("push", row["limit_n_s"], row["direction"], row["phase"]),
            *(seed, row["method"], body),
        )
        for row in made["rows"]
        if row["ratio"] > 1.0
    ]


def main() -> None:
    """Simulate the pushes and write the results."""
    parser = ask(__doc__, "push-moments.json")
    parser.add_argument("--pushes", type=Path, default=RESULTS / "pushes.json")
    asked = parser.parse_args()
    trials = trials_above(asked.pushes)
    head = header({"walks": len(trials)})
    rows = [follow(trial) for trial in trials]
    write_result(asked.output, head, rows=rows)


if __name__ == "__main__":
    main()
