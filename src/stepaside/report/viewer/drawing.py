"""Draws a live duel into the layers of a page."""

import numpy as np

from ...poses import Array
from ..style import COLOURS, EVADER, THEORY
from .layers import (
    HEIGHTS,
    Layers,
    chain,
    path_of,
    prints_of,
    ring,
    safety_of,
    support_of,
)
from .session import Session

ZMP_COLOURS = {"pursuer": "#e8a598", "evader": "#9bb8e8"}


def draw_session(layers: Layers, session: Session) -> None:
    """Draw every layer of the present moment.

    Args:
        layers: Of the page.
        session: Whose lock the caller does not hold.
    """
    with session.lock:
        duel = session.duel
        now = duel.world.time
        drawn: list[tuple[str, str, Array, str]] = []
        places = []
        for robot, scheme, frame in zip(
            duel.robots, duel.schemes, duel.recorder.frames, strict=True
        ):
            name, colour = robot.name, COLOURS[robot.name]
            places.append(np.array(robot.truth.position))
            path = path_of(scheme, frame)
            drawn += [
                (
                    "planned path",
                    name,
                    chain(path, HEIGHTS["planned path"]),
                    colour,
                ),
                ("footsteps", name, prints_of(scheme, frame), colour),
                (
                    "support polygon",
                    name,
                    support_of(scheme, frame, now),
                    "#2a9d55",
                ),
            ]
            for what, shade in (("CoM", colour), ("ZMP", ZMP_COLOURS[name])):
                trace = np.array(session.traces[f"{name}/{what}"])
                layer = f"{what} trace"
                drawn.append(
                    (
                        layer,
                        name,
                        chain(trace.reshape(-1, 2), HEIGHTS[layer]),
                        shade,
                    )
                )
        radius = session.settings.strategy.safety_radius
        drawn.append(
            ("safety area", "evader", safety_of(places[1], radius), EVADER)
        )
        sight = np.array([[[*places[0], 0.25], [*places[1], 0.25]]])
        drawn.append(("line of sight", "both", sight, THEORY))
        drawn.append(
            (
                "circle of theory",
                "both",
                _circle(session, places),
                THEORY,
            )
        )
    for layer, owner, segments, colour in drawn:
        layers.draw(layer, owner, segments, colour)


def _circle(session: Session, places: list[Array]) -> Array:
    """Circle of theory, laid through where the robots are.

    Its middle is the one from which both robots, a known distance apart,
    are a radius away, on the side to which the pursuer turns.
    """
    radius = session.theory_radius
    if radius is None or session.duel.triggered_at is None:
        return np.zeros((0, 2, 3))
    middle = 0.5 * (places[0] + places[1])
    apart = places[1] - places[0]
    half = 0.5 * float(np.hypot(*apart))
    if half >= radius or half < 1e-6:
        return np.zeros((0, 2, 3))
    plan = session.duel.schemes[0].plan
    side = 1.0 if plan is None or plan.bearing >= 0.0 else -1.0
    normal = side * np.array([-apart[1], apart[0]]) / (2.0 * half)
    x, y = (middle + normal * np.sqrt(radius**2 - half**2)).tolist()
    return ring(x, y, radius, HEIGHTS["circle of theory"])
