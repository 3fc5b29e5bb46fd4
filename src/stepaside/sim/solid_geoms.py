"""Geoms that rest on the floor."""

from collections.abc import Sequence
from math import cos, sin
from typing import Any

import mujoco

from .floor import FLOOR_BIT


def add_geom(
    body: mujoco.MjsBody,
    kind: str,
    size: Sequence[float],
    colour: Sequence[float],
    *,
    at: Sequence[float] = (0.0, 0.0, 0.0),
    yaw: float = 0.0,
    bit: int = FLOOR_BIT,
    **more: Any,
) -> None:
    """Add a geom, with sizes as in MuJoCo [m] and a yaw [rad] in its body."""
    body.add_geom(
        type=getattr(mujoco.mjtGeom, f"mjGEOM_{kind}"),
        size=[*size, *(0.0,) * (3 - len(size))],
        rgba=list(colour),
        pos=list(at),
        quat=[cos(0.5 * yaw), 0.0, 0.0, sin(0.5 * yaw)],
        contype=bit,
        conaffinity=0,
        **more,
    )
