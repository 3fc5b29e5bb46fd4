"""Outcome of motions against the walks of a person, in compiled loops."""

from math import cos, sin, sqrt, tau
from typing import Any

from ...core.compilation import compiled, inlined
from .shield_game import OutcomeRules, PoseGrid


@inlined
def look_up(
    v: Any, x: float, y: float, theta: float, grid: PoseGrid, outside: float
) -> float:
    """Interpolate linearly between the nodes of a cell."""
    if y < 0.0 and grid.right == 0.0:
        y, theta = -y, -theta
    u = (x - grid.left) / grid.spacing
    w = (y - grid.right) / grid.spacing
    count = grid.shape[2]
    a = (theta / tau * count) % count
    if u < 0.0 or u >= grid.shape[0] - 1:
        return outside
    if w < 0.0 or w >= grid.shape[1] - 1:
        return outside
    i, j, k = int(u), int(w), int(a) % count
    s, t, r = u - i, w - j, a - int(a)
    n = (k + 1) % count
    p, q = 1.0 - s, 1.0 - t
    low = p * (q * v[i, j, k] + t * v[i, j + 1, k]) + s * (
        q * v[i + 1, j, k] + t * v[i + 1, j + 1, k]
    )
    high = p * (q * v[i, j, n] + t * v[i, j + 1, n]) + s * (
        q * v[i + 1, j, n] + t * v[i + 1, j + 1, n]
    )
    found: float = (1.0 - r) * low + r * high
    return found


@inlined
def outcome_of(
    v: Any,
    pose: tuple[float, float, float],
    motion: Any,
    walk: Any,
    rules: OutcomeRules,
) -> float:
    """Return least distance on the way and value after it.

    Args:
        v: Values at the end.
        pose: Pose of the robot in the frame of the person.
        motion: Poses in the initial frame of the robot. Shape (parts, 3).
        walk: Poses of the person in its initial frame. Shape (parts, 3).
        rules: Grid of the values, and how the distance is reckoned.
    """
    x, y, theta = pose
    c, s = cos(theta), sin(theta)
    px, py = x, y
    least = x * x + y * y
    for n in range(len(motion)):
        nx = x + c * motion[n, 0] - s * motion[n, 1] - walk[n, 0]
        ny = y + s * motion[n, 0] + c * motion[n, 1] - walk[n, 1]
        dx, dy = nx - px, ny - py
        share = -(px * dx + py * dy) / (dx * dx + dy * dy + 1e-30)
        share = min(max(share, 0.0), 1.0)
        cx, cy = px + share * dx, py + share * dy
        least = min(least, cx * cx + cy * cy)
        px, py = nx, ny
    turned = walk[len(motion) - 1, 2]
    c, s = cos(turned), sin(turned)
    after = look_up(
        v,
        c * px + s * py,
        c * py - s * px,
        theta + motion[len(motion) - 1, 2] - turned,
        rules.grid,
        rules.outside,
    )
    return min(after, sqrt(least) - rules.sag)


@inlined
def worst_walk(
    v: Any,
    pose: tuple[float, float, float],
    motion: Any,
    walks: Any,
    first: int,
    floor: float,
    rules: OutcomeRules,
) -> tuple[float, int]:
    """Return the worst outcome over the person's walks, and its number.

    The search ends where the outcome is at most ``floor``; the walk
    ``first`` is tried first.
    """
    worst = outcome_of(v, pose, motion, walks[first], rules)
    at = first
    for m in range(len(walks)):
        if worst <= floor:
            break
        found = outcome_of(v, pose, motion, walks[m], rules)
        if found < worst:
            worst, at = found, m
    return worst, at


@compiled
def evaluate_motions(
    v: Any,
    poses: Any,
    motions: Any,
    walks: Any,
    rules: OutcomeRules,
    out: Any,
) -> None:
    """Lower ``out`` to the worst outcome of each motion from all poses."""
    for n in range(len(poses)):
        pose = (poses[n, 0], poses[n, 1], poses[n, 2])
        for k in range(len(motions)):
            found, _ = worst_walk(v, pose, motions[k], walks, 0, -1.0, rules)
            out[k] = min(out[k], found)


@compiled
def look_up_all(
    v: Any, poses: Any, grid: PoseGrid, outside: float, out: Any
) -> None:
    """Interpolate at many poses. Shape (n, 3)."""
    for n in range(len(poses)):
        x, y = poses[n, 0], poses[n, 1]
        found = look_up(v, x, y, poses[n, 2], grid, outside)
        out[n] = min(found, sqrt(x * x + y * y))
