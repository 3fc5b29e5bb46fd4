"""Derivation of a robot description from a published model."""

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from ..core.errors import ModelError, ReachError
from ..games.player_settings import settings_from_description
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from ..robots.description_types import (
    Overlay,
    ReferencePoint,
    ServoGains,
    SoleFrame,
)
from ..robots.leg_kinematics import BodyReference, LegKinematics
from ..robots.model_reader import read_model
from .gait_feasibility import (
    GREATEST_LOAD,
    TICK,
    JointLoads,
    RobotSize,
    choose_zmp_offset,
    feasible_lengths,
    gait_of,
    game_of_size,
    stabiliser_of,
    step_loads,
)
from .model_analysis import ModelAnalysis, analyse_model, check_size
from .motor_data import (
    DEFAULT_SPEED,
    WEAK_LOAD,
    followers_of,
    gains_of,
    plausible_torques,
    published_speeds,
    published_torques,
    published_values,
)
from .standing_posture import knee_limits, reach_of, standing_of

# CoM heights that are tried, as fractions of the greatest one in reach: the
# lower, the farther a knee is from straight at the end of a step.
HEIGHT_FRACTIONS = (0.96, 0.94, 0.92, 0.9)
LEAST_GAIN = 0.05  # in step length, which justifies a lower CoM
LEAN_CANDIDATES = (0.06, 0.12, 0.18, 0.24)  # in [rad]
LEAN_GAIN = 0.97  # load ratio below which a greater lean is preferred
# Greatest foot spacing: by the distance between the hips, and by the CoM
# height (feet farther apart slide and twist).
GREATEST_BY_HIPS = 1.4
GREATEST_BY_HEIGHT = 0.38
GREATEST_DIFFERENCE = 0.05  # of ranges on both sides, for messages, in [rad]
LEAST_SPACING = 1.25  # foot spacing by twice the inner edge of the sole
# Torque limits of a model are those at the joint, and its joints apply the
# gains that they are sent; the lower values of NAO's hardware body are
# assumptions about its motors and servos.
MODEL_BODY = {"efficiency": 1.0, "servo_gain": 1.0}
FEET = ("stepaside_left_sole", "stepaside_right_sole")


def least_lean(
    description: RobotDescription,
    gait: GaitSettings,
    torques: Mapping[str, float],
) -> tuple[float, JointLoads]:
    """Return the least lean at which a step stays within the torque limits.

    If no candidate is enough, the least that no greater one betters much.
    """
    best: tuple[float, JointLoads] | None = None
    for lean in LEAN_CANDIDATES:
        loads = step_loads(replace(description, lean=lean), gait, torques)
        if best is None or loads.most < LEAN_GAIN * best[1].most:
            best = lean, loads
        if loads.most <= GREATEST_LOAD:
            break
    assert best is not None
    return best


@dataclass(frozen=True, eq=False)
class DerivedDescription:
    """A robot description with the data that it was derived from."""

    # robot description; its folder may not exist yet
    description: RobotDescription
    analysis: ModelAnalysis
    size: RobotSize  # size by which the gait was scaled
    lowest: float  # least CoM height in reach [m]
    highest: float  # greatest CoM height in reach [m]
    assumed_torques: list[str]  # joints whose torque limit is an estimate
    assumed_speeds: list[str]  # likewise of speed limits
    lengths: float  # feasible share of nominal stride and step height
    zmp_offset: float  # likewise of the nominal ZMP offset
    loads: JointLoads  # joint loads of a step, relative to the torque limits
    is_weak: bool  # whether servos are softened, and feedback is needed


def derive(
    model: Path, folder: Path, meshes: list[Path]
) -> DerivedDescription:
    """Derive the description of a robot."""
    if not model.is_file():
        raise ModelError(f"model must be an MJCF or URDF file, got {model}")
    mesh_folders = meshes or [model.parent, model.parent.parent / "meshes"]
    mesh_folders = [path for path in mesh_folders if path.is_dir()]
    analysis = analyse_model(model, mesh_folders)
    left, right = (len(leg.joints) for leg in analysis.legs)
    if left != right:
        raise ModelError(
            f"legs must have equally many joints, got {left} and {right}"
        )
    published = read_model(model)
    torques = plausible_torques(
        published_torques(published), analysis.mass, analysis.length
    )
    own = {name for leg in analysis.legs for name in leg.joints}
    speeds = published_speeds(model, own)
    sole = shared_sole(analysis)
    servos = gains_of(analysis, torques, 0.9 * analysis.length)
    description = _structure(
        analysis, folder, mesh_folders, sole, servos, speeds
    )
    lowest, highest = _reachable_sizes(description, analysis, sole)
    size, lengths = choose_com_height(description, highest, lowest)
    gait = gait_of(size, lengths)
    zmp_offset, loads = choose_zmp_offset(
        *with_gait(description, gait), torques
    )
    gait["zmp_forward"] = round(zmp_offset * gait["zmp_forward"], 4) + 0.0
    overloaded = loads.most > GREATEST_LOAD
    weak = loads.usual > WEAK_LOAD or overloaded or zmp_offset < 1.0
    lean = 0.0
    if overloaded:
        lean, loads = least_lean(*with_gait(description, gait), torques)
    servos = gains_of(analysis, torques, size.com_height, weak=weak)
    description = replace(
        description,
        lean=lean,
        overlay=replace(description.overlay, servos=servos),
        gait=dict(gait),
        control={
            "method": "measured" if weak else "closed-form",
            "feedback": weak,
            "stabiliser": stabiliser_of(size),
        },
        game=game_of_size(size, gait),
        body=dict(MODEL_BODY) if torques else {},
        published=published_values(published),
    )
    return DerivedDescription(
        description,
        analysis,
        size,
        lowest,
        highest.com_height,
        [name for name in servos if name not in torques],
        [name for name in servos if name not in speeds],
        lengths,
        zmp_offset,
        loads,
        weak,
    )


def _reachable_sizes(
    description: RobotDescription,
    analysis: ModelAnalysis,
    sole: tuple[float, float, float, float],
) -> tuple[float, RobotSize]:
    """Return the least CoM height in reach, and the size at the greatest."""
    spacing = spacing_of(analysis, sole[3])
    lowest, highest = _reachable_heights(description, analysis, spacing, sole)
    greatest = max(GREATEST_BY_HEIGHT * highest, LEAST_SPACING * 2.0 * sole[3])
    if spacing > greatest:
        # A narrower stance lifts the CoM; one iteration is enough.
        spacing = greatest
        lowest, highest = _reachable_heights(
            description, analysis, spacing, sole
        )
    reach = description.place.reach
    return lowest, RobotSize(highest, analysis.mass, spacing, sole, reach)


def choose_com_height(
    description: RobotDescription, size: RobotSize, lowest: float
) -> tuple[RobotSize, float]:
    """Choose the CoM height at which the joints are fast enough.

    Knee speed grows without bound as a knee gets straight. The feasible
    fraction of stride and step height comes with it.
    """
    best: tuple[RobotSize, float] | None = None
    for fraction in HEIGHT_FRACTIONS:
        height = fraction * size.com_height
        if best is not None and height < lowest:
            break
        candidate = replace(size, com_height=height)
        lengths = feasible_lengths(*with_gait(description, gait_of(candidate)))
        if best is None or lengths > best[1] + LEAST_GAIN:
            best = candidate, lengths
        if lengths == 1.0:
            break
    assert best is not None
    return best


def with_gait(
    description: RobotDescription, gait: dict[str, float]
) -> tuple[RobotDescription, GaitSettings]:
    """Return the description with gait entries, and the gait settings."""
    changed = replace(description, gait=dict(gait))
    return changed, settings_from_description(changed).gait


def _reachable_heights(
    description: RobotDescription,
    analysis: ModelAnalysis,
    spacing: float,
    sole: tuple[float, float, float, float],
) -> tuple[float, float]:
    """Return least and greatest CoM height with the feet abreast, in [m]."""
    forward = 0.45 * (sole[0] + sole[1])
    half = 0.5 * spacing
    stance = BodyReference(
        (forward, 0.0, 1.0), (0.0, half, 0.0, 0.0), (0.0, -half, 0.0, 0.0)
    )
    kinematics = LegKinematics(description, tick=TICK)
    lowest, highest = kinematics.com_heights(stance)
    if highest == 0.0:
        try:
            kinematics.stand(stance)
        except ReachError as error:
            raise ModelError(
                f"{description.name} can stand at no height with its feet "
                f"{spacing:.3f} m apart: {_uneven_ranges(analysis) or error}"
            ) from error
    return lowest, highest


def _uneven_ranges(analysis: ModelAnalysis) -> str:
    """Return the leg joints whose ranges are farthest from mirror images.

    Empty if all are nearly mirror images.
    """
    farthest, text = GREATEST_DIFFERENCE, ""
    model, axes = analysis.model, analysis.data.xaxis
    for pair in zip(*(leg.joints for leg in analysis.legs), strict=True):
        left, right = (model.joint(name) for name in pair)
        mirrored = axes[left.id] * (-1.0, 1.0, -1.0)
        ends = right.range
        if mirrored @ axes[right.id] < 0.0:
            ends = -ends[::-1]
        difference = float(np.abs(left.range - ends).max())
        if difference > farthest:
            farthest = difference
            ranges = (
                f"{j.name!r} has {j.range[0]:.3g} to {j.range[1]:.3g} rad"
                for j in (left, right)
            )
            text = "legs must be mirror images, but " + " and ".join(ranges)
    return text


def shared_sole(analysis: ModelAnalysis) -> tuple[float, float, float, float]:
    """Return the outline that lies within the soles of both feet.

    Back, front, outer and inner edge, in [m].
    """
    left, right = (leg.outline for leg in analysis.legs)
    edges = (
        max(left[0], right[0]),
        min(left[1], right[1]),
        min(left[3], -right[2]),
        min(-left[2], right[3]),
    )
    back, front, outer, inner = (round(edge, 4) for edge in edges)
    violation = check_size((back, front, -inner, outer), analysis.length)
    if violation:
        raise ModelError(
            f"the common outline of the soles of {analysis.legs[0].foot!r} "
            f"and {analysis.legs[1].foot!r} {violation}: the feet of the "
            "model must be mirror images"
        )
    return back, front, outer, inner


def spacing_of(analysis: ModelAnalysis, inner: float) -> float:
    """Return the foot spacing, in [m].

    That of the ankles in the zero posture, but not wider than the hips
    justify, nor so narrow that soles meet.
    """
    left, right = analysis.legs
    ankles = float(left.ankle[1] - right.ankle[1])
    hips = float(left.hip[1] - right.hip[1])
    return max(
        min(ankles, GREATEST_BY_HIPS * hips), LEAST_SPACING * 2.0 * inner
    )


def _structure(
    analysis: ModelAnalysis,
    folder: Path,
    mesh_folders: list[Path],
    sole: tuple[float, float, float, float],
    servos: dict[str, ServoGains],
    speeds: dict[str, float],
) -> RobotDescription:
    """Return a description without gait, control and game."""
    standing = standing_of(analysis)
    forward = float(np.mean([leg.hip[0] for leg in analysis.legs]))
    knees = {
        leg.pitches[1]: knee_limits(analysis, leg) for leg in analysis.legs
    }
    reach = reach_of(analysis, standing, forward)
    return RobotDescription(
        folder=folder,
        name=analysis.path.stem.replace("_", " "),
        model=_relative_path(folder, analysis.path),
        torso=analysis.torso,
        left_foot=FEET[0],
        right_foot=FEET[1],
        accent="",
        legs=tuple(name for leg in analysis.legs for name in leg.joints),
        standing=standing,
        speed_limits={
            name: speeds.get(name, DEFAULT_SPEED) for name in servos
        },
        working_limits=knees,
        sole=dict(zip(("back", "front", "outer", "inner"), sole, strict=True)),
        place=ReferencePoint(round(forward, 4), reach),
        overlay=Overlay(
            tuple(_sole_frame(analysis, i) for i in (0, 1)),
            servos,
            tuple(_relative_path(folder, path) for path in mesh_folders),
            analysis.turn,
        ),
    )


def _sole_frame(analysis: ModelAnalysis, side: int) -> SoleFrame:
    leg = analysis.legs[side]
    under = leg.ankle - (leg.ankle[2] - leg.sole) * leg.axes[:, 2]
    frame, turn, back = analysis.data.body(leg.foot), np.zeros(4), np.zeros(4)
    place = frame.xmat.reshape(3, 3).T @ (under - frame.xpos)
    x, y, z = (place.round(5) + 0.0).tolist()
    mujoco.mju_mat2Quat(turn, leg.axes.ravel())
    mujoco.mju_negQuat(back, frame.xquat)
    mujoco.mju_mulQuat(turn, back, turn.copy())
    w, a, b, c = (turn.round(7) + 0.0).tolist()
    return SoleFrame(leg.foot, (x, y, z), (w, a, b, c))


def _relative_path(folder: Path, path: Path) -> str:
    return Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()


def report_of(derived: DerivedDescription) -> dict[str, Any]:
    """Return the report as values for JSON."""
    analysis, size = derived.analysis, derived.size
    own = derived.description
    return {
        "name": own.name,
        "model": str(analysis.path),
        "mass_kg": round(analysis.mass, 3),
        "leg_length_m": round(analysis.length, 4),
        "com_height_m": round(size.com_height, 4),
        "com_heights_m": [round(derived.lowest, 4), round(derived.highest, 4)],
        "foot_spacing_m": round(size.foot_spacing, 4),
        "hip_width_m": round(
            float(analysis.legs[0].hip[1] - analysis.legs[1].hip[1]), 4
        ),
        "sole_m": dict(own.sole),
        "legs": [list(leg.joints) for leg in analysis.legs],
        "gait": dict(own.gait),
        "lengths_share": round(derived.lengths, 3),
        "coupled": sorted(followers_of(analysis.model)),
        "omitted_meshes": len(analysis.missing),
        "missing_values": {
            "sole": any(leg.is_guessed for leg in analysis.legs),
            "torques": derived.assumed_torques,
            "speed_limits": derived.assumed_speeds,
        },
    }
