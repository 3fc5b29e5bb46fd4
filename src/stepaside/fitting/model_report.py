"""Report on a derived description, for ``robot init``."""

from typing import Any

import numpy as np

from .derivation import DerivedDescription, coupled_of
from .leg_detection import ALIGNED, JOINT_TYPES
from .model_analysis import ModelAnalysis

GREATEST_HEAD = 0.2  # mass of a head, by that of the robot
MIDDLE = 0.05  # distance from the sagittal plane, by the length of a leg


def head_of(analysis: ModelAnalysis) -> dict[str, Any]:
    """Return the joints of the head and the cameras of a model.

    The head joints are those over the hips in the sagittal plane with a
    vertical axis (yaw) and a lateral axis (pitch) that carry the least mass.

    Returns:
        Joints ``yaw`` and ``pitch``, each None if there is none, and the
        names of all ``cameras`` of the model.
    """
    model, data = analysis.model, analysis.data
    hips = max(leg.hip[2] for leg in analysis.legs)
    by_axis: dict[int, str] = {}
    for axis in (2, 1):
        joints = [
            j
            for j in range(model.njnt)
            if model.jnt_type[j] in JOINT_TYPES
            and abs(data.xaxis[j, axis]) > ALIGNED
            and data.xanchor[j, 2] > hips
            and abs(data.xanchor[j, 1]) < MIDDLE * analysis.length
            and _carried_mass(analysis, j) < GREATEST_HEAD * analysis.mass
        ]
        if joints:
            lightest = joints[
                int(np.argmin([_carried_mass(analysis, j) for j in joints]))
            ]
            by_axis[axis] = model.joint(lightest).name
    return {
        "yaw": by_axis.get(2),
        "pitch": by_axis.get(1),
        "cameras": [model.camera(i).name for i in range(model.ncam)],
    }


def _carried_mass(analysis: ModelAnalysis, joint: int) -> float:
    """Return the mass that a joint carries, in [kg]."""
    body = int(analysis.model.jnt_bodyid[joint])
    return float(analysis.model.body_subtreemass[body])


def report_of(derived: DerivedDescription) -> dict[str, Any]:
    """Return the report as values for JSON."""
    analysis, size = derived.analysis, derived.size
    own = derived.description
    assumed_torques = [
        name
        for name in own.overlay.servos
        if name not in derived.published_torques
    ]
    assumed_speeds = [
        name
        for name in own.speed_limits
        if name not in derived.published_speeds
    ]
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
        "zmp_share": derived.zmp_offset,
        "lean_rad": own.lean,
        "torque_share": round(derived.loads.usual, 3),
        "game": dict(own.game),
        "coupled": sorted(coupled_of(analysis)),
        "head": head_of(analysis),
        "omitted_meshes": len(analysis.missing),
        "missing_values": {
            "sole": any(leg.is_guessed for leg in analysis.legs),
            "torques": assumed_torques,
            "speed_limits": assumed_speeds,
        },
    }
