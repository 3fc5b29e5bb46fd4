"""A description of a stranger's robot, derived from its published model."""

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import mujoco
import numpy as np

from ..core.errors import ModelError
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from ..robots.description_types import (
    Overlay,
    ReferencePoint,
    ServoGains,
    SoleFrame,
)
from ..robots.model_reader import read_model
from .com_height import heights_of, rehearsed, stature_of
from .gait_feasibility import BEARABLE, TorqueShares, torques_borne, zmp_share
from .gait_scaling import RobotSize, gait_of, game_of_size, stabiliser_of
from .model_analysis import ModelAnalysis, survey
from .motor_data import (
    SPEED,
    WEAK,
    followers_of,
    gains_of,
    likely_torques,
    published_speeds,
    published_torques,
)
from .sole_detection import check_size
from .standing_posture import knee_limits, reach_of, standing_of, stiff_joints

LEANS = (0.06, 0.12, 0.18, 0.24)  # that are tried, in [rad]
HELPS = 0.97  # of a torque, if the torso is to lean farther for it


def least_lean(
    description: RobotDescription,
    gait: GaitSettings,
    torques: Mapping[str, float],
) -> tuple[float, TorqueShares]:
    """Least lean at which a step leaves something of each torque.

    To be asked for a robot whose joints bear too much without.

    Args:
        description: The robot, whose torso stays level.
        gait: How it walks.
        torques: Greatest torque of each joint, in [N m].

    Returns:
        The lean, in [rad], and what is borne then; where none of those
        tried is enough, the least that none betters by much.
    """
    best: tuple[float, TorqueShares] | None = None
    for lean in LEANS:
        leaning = replace(description, lean=lean)
        found = torques_borne(leaning, gait, torques)
        if best is None or found.most < HELPS * best[1].most:
            best = lean, found
        if found.most <= BEARABLE:
            break
    assert best is not None
    return best


SPREAD = 1.4  # greatest one by the distance between the hips
WIDE = 0.38  # likewise by the CoM's height: wider feet slide and twist
SPACE = 1.25  # least foot spacing by twice the sole's inner edge
# Names of files and folders that say nothing.
ANYONE = ("model", "models", "robot", "robots", "scene", "urdf", "mjcf", "xml")
FEET = ("stepaside_left_sole", "stepaside_right_sole")


@dataclass(frozen=True, eq=False)
class DerivedDescription:
    """A description, and what it was derived from.

    Attributes:
        description: Of the robot; its folder need not be there yet.
        survey: What was found in the model.
        size: What its gait was scaled by.
        lowest: Least CoM height in reach, in [m].
        highest: Greatest one, in [m].
        told_torques: Joints whose torque the model tells.
        told_speeds: Joints whose speed it tells.
        share: Of stride and step height, for which the joints are fast
            enough.
        ahead: Of the ZMP's place ahead of the ankles, for which these are
            strong enough.
        borne: Shares of their torque that joints bear in a step.
        is_weak: Whether servos are softened, and feedback is needed.
    """

    description: RobotDescription
    survey: ModelAnalysis
    size: RobotSize
    lowest: float
    highest: float
    told_torques: frozenset[str]
    told_speeds: frozenset[str]
    share: float
    ahead: float
    borne: TorqueShares
    is_weak: bool


def derive(
    model: Path, folder: Path, meshes: list[Path]
) -> DerivedDescription:
    """Derive the description of a robot.

    Args:
        model: MJCF or URDF file as published; it is only read.
        folder: Where the description will be.
        meshes: Folders in which mesh files are looked for.

    Raises:
        ModelError: If the model is not one of a humanoid that can walk;
            says what is missing.
    """
    if not model.is_file():
        raise ModelError(f"model must be an MJCF or URDF file, got {model}")
    places = meshes or [model.parent, model.parent.parent / "meshes"]
    places = [place for place in places if place.is_dir()]
    found = survey(model, places)
    _check_legs(found)
    torques = likely_torques(
        published_torques(read_model(model)), found.mass, found.length
    )
    speeds = published_speeds(model)
    sole = shared_sole(found)
    spacing = spacing_of(found, sole[3])
    servos = gains_of(found, torques, 0.9 * found.length)
    description = _structure(found, folder, places, sole, servos, speeds)
    stiff = stiff_joints(found)
    lowest, highest = heights_of(description, spacing, sole, stiff)
    narrow = max(WIDE * highest, SPACE * 2.0 * sole[3])
    if spacing > narrow:  # which lifts the CoM: a second time is enough
        spacing = narrow
        lowest, highest = heights_of(description, spacing, sole, stiff)
    guess = RobotSize(
        highest, found.mass, spacing, sole, description.place.reach
    )
    size, share = stature_of(description, guess, lowest)
    height = size.com_height
    description = replace(
        description,
        overlay=replace(
            description.overlay, servos=gains_of(found, torques, height)
        ),
    )
    gait = gait_of(size, share)
    ahead, borne = zmp_share(*rehearsed(description, gait), torques)
    gait["zmp_forward"] = round(ahead * gait["zmp_forward"], 4) + 0.0
    overlay, lean = description.overlay, 0.0
    weak = borne.usual > WEAK or borne.most > BEARABLE or ahead < 1.0
    if borne.most > BEARABLE:
        lean, borne = least_lean(*rehearsed(description, gait), torques)
    if weak:
        servos = gains_of(found, torques, height, weak=True)
        overlay = replace(overlay, servos=servos)
    description = replace(
        description,
        lean=lean,
        overlay=overlay,
        gait=dict(gait),
        control={
            "method": "measured" if weak else "closed-form",
            "feedback": weak,
            "learn_turns": True,
            "stabiliser": stabiliser_of(size),
        },
        game=game_of_size(size, gait),
    )
    return DerivedDescription(
        description,
        found,
        size,
        lowest,
        highest,
        frozenset(torques),
        frozenset(speeds),
        share,
        ahead,
        borne,
        weak,
    )


def _check_legs(found: ModelAnalysis) -> None:
    """Refuse legs of which one is not like the other."""
    left, right = found.legs
    if len(left.joints) != len(right.joints):
        raise ModelError(
            f"legs must have equally many joints, got {len(left.joints)} and "
            f"{len(right.joints)}"
        )


def shared_sole(found: ModelAnalysis) -> tuple[float, float, float, float]:
    """Back, front, outer and inner edge: what both feet have, in [m]."""
    left, right = (leg.outline for leg in found.legs)
    edges = (
        max(left[0], right[0]),
        min(left[1], right[1]),
        min(left[3], -right[2]),
        min(-left[2], right[3]),
    )
    back, front, outer, inner = (round(edge, 4) for edge in edges)
    wrong = check_size((back, front, -inner, outer), found.length)
    if wrong:
        raise ModelError(
            f"what the soles of {found.legs[0].foot!r} and "
            f"{found.legs[1].foot!r} have in common {wrong}: the feet of "
            "the model must be mirror images"
        )
    return back, front, outer, inner


def spacing_of(found: ModelAnalysis, inner: float) -> float:
    """Distance between ankles in the zero posture, or what soles need.

    Legs that are spread in the zero posture do not stand so.
    """
    left, right = found.legs
    apart = float(left.ankle[1] - right.ankle[1])
    hips = float(left.hip[1] - right.hip[1])
    return max(min(apart, SPREAD * hips), SPACE * 2.0 * inner)


def _structure(
    found: ModelAnalysis,
    folder: Path,
    meshes: list[Path],
    sole: tuple[float, float, float, float],
    servos: dict[str, ServoGains],
    speeds: dict[str, float],
) -> RobotDescription:
    """Description of what a robot is, without how it walks."""
    standing = standing_of(found)
    forward = float(np.mean([leg.hip[0] for leg in found.legs]))
    knees = {leg.pitches[1]: knee_limits(found, leg) for leg in found.legs}
    reach = reach_of(found, standing, forward)
    return RobotDescription(
        folder=folder,
        name=name_of(found),
        model=_path_from(folder, found.path),
        torso=found.torso,
        left_foot=FEET[0],
        right_foot=FEET[1],
        accent="",
        legs=tuple(name for leg in found.legs for name in leg.joints),
        standing=standing,
        speed_limits={name: speeds.get(name, SPEED) for name in servos},
        working_limits=knees,
        sole=dict(zip(("back", "front", "outer", "inner"), sole, strict=True)),
        place=ReferencePoint(round(forward, 4), reach),
        overlay=Overlay(
            tuple(_sole_place(found, i) for i in (0, 1)),
            servos,
            tuple(_path_from(folder, place) for place in meshes),
            found.turn,
        ),
    )


def _sole_place(found: ModelAnalysis, side: int) -> SoleFrame:
    leg = found.legs[side]
    under = leg.ankle - (leg.ankle[2] - leg.sole) * leg.axes[:, 2]
    x, y, z = (found.place_in(leg.foot, under).round(5) + 0.0).tolist()
    turn = np.zeros(4)
    mujoco.mju_mat2Quat(turn, leg.axes.ravel())
    mujoco.mju_mulQuat(turn, found.turn_of(leg.foot), turn.copy())
    w, a, b, c = (turn.round(7) + 0.0).tolist()
    return SoleFrame(leg.foot, (x, y, z), (w, a, b, c))


def name_of(found: ModelAnalysis) -> str:
    """Name of the file, or of a folder where files have all one name."""
    path = found.path.resolve()
    names = (path.stem, *(folder.name for folder in path.parents))
    telling = (name for name in names if name.lower() not in ANYONE)
    return next(telling, "").replace("_", " ") or path.stem


def _path_from(folder: Path, path: Path) -> str:
    """Path of a file as the folder of a description names it."""
    return Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()


def coupled_of(found: ModelAnalysis) -> set[str]:
    """Joints that follow others."""
    return followers_of(found.model)
