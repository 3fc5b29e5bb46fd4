"""Formulas of the legs of a robot, kept in the cache folder."""

from collections.abc import Callable
from functools import cache
from pathlib import Path

from ..core.kept_files import files_digest, kept
from .expression_tracing import Formula
from .leg_joints import LegJoints


def kept_formula(
    name: str,
    legs: LegJoints,
    trace: Callable[..., Formula],
    *hints: dict[str, float],
) -> Formula:
    """Return a formula of a robot's legs, traced once on this machine.

    Args:
        name: Name of the formula.
        legs: Leg joints.
        trace: Generates the formula from the legs, and the hints if any.
        hints: A typical posture, by joint, in [rad].
    """
    tree, *others = legs.key
    inputs = tree.to_json(), others, hints, _generator()
    text = kept(name, inputs, lambda: trace(legs, *hints).text.encode())
    return Formula(name, text.decode())


@cache
def _generator() -> str:
    """Return a digest of the code that generates formulas."""
    robots = Path(__file__).parent
    constants = robots.with_name("core") / "constants.py"
    return files_digest(constants, *sorted(robots.glob("*.py")))
