"""What was found in a model and chosen for it, as a report tells it."""

from typing import Any

from .deriving import Derived, coupled_of
from .heads import head_of


def facts_of(derived: Derived) -> dict[str, Any]:
    """What was found and chosen, for a report."""
    found, size = derived.survey, derived.size
    own = derived.description
    untold = [
        name for name in own.overlay.servos if name not in derived.told_torques
    ]
    unlimited = [
        name for name in own.speed_limits if name not in derived.told_speeds
    ]
    return {
        "name": own.name,
        "model": str(found.path),
        "mass_kg": round(found.mass, 3),
        "leg_length_m": round(found.length, 4),
        "com_height_m": round(size.com_height, 4),
        "com_heights_m": [round(derived.lowest, 4), round(derived.highest, 4)],
        "foot_spacing_m": round(size.foot_spacing, 4),
        "hip_width_m": round(
            float(found.legs[0].hip[1] - found.legs[1].hip[1]), 4
        ),
        "sole_m": dict(own.sole),
        "legs": [list(leg.joints) for leg in found.legs],
        "gait": dict(own.gait),
        "lengths_share": round(derived.share, 3),
        "zmp_share": derived.ahead,
        "lean_rad": own.lean,
        "torque_share": round(derived.borne.usual, 3),
        "game": dict(own.game),
        "coupled": sorted(coupled_of(found)),
        "head": head_of(found),
        "left_out_meshes": len(found.missing),
        "asked_for": {
            "sole": any(leg.is_guessed for leg in found.legs),
            "torques": untold,
            "speed_limits": unlimited,
        },
    }
