"""Claims of the conclusion (Sec. V) and of the follow-up paper."""

from .claims import Claim

STEPS, PHYSICS = "steps", "physics"
CONCLUSION = "V"
SEQUEL = "V; De Simone et al., IROS 2017"
DURATION = 40.0  # of the duels in rooms, in [s]

EVADING = (
    Claim(
        "farther",
        "against the paper's pursuer there are better strategies than "
        "moving aside (closest approach of look-ahead over that of moving "
        "aside, on an open floor)",
        CONCLUSION,
        STEPS,
        1.2,
        "1",
        relation=">",
    ),
    Claim(
        "best",
        "and none is much better than look-ahead (its closest approach over "
        "the best possible one against this pursuer)",
        CONCLUSION,
        STEPS,
        0.95,
        "1",
        relation=">",
    ),
    Claim(
        "survives",
        "an evader plays among obstacles (fraction of games of two minutes "
        "against the paper's pursuer, in rooms of 3 x 3 m with three discs, "
        "that look-ahead survives: without capture, at 0.35 m, and without "
        "contact with an obstacle)",
        SEQUEL,
        STEPS,
        1.0,
        "1",
        0.1,
    ),
    Claim(
        "clear",
        "and touches none (least clearance of its centre, less its body "
        "radius)",
        SEQUEL,
        STEPS,
        -1e-9,
        "m",
        relation=">",
    ),
    Claim(
        "aside",
        "where moving aside walks into them (fraction that look-ahead "
        "survives against the paper's pursuer, less that of moving aside)",
        SEQUEL,
        STEPS,
        0.1,
        "1",
        relation=">",
    ),
    Claim(
        "decision",
        "in the 10 ms that planning may take (mean time of its decisions, "
        "on the computer that made this report, not on a NAO)",
        CONCLUSION,
        STEPS,
        10.0,
        "ms",
        relation="<",
    ),
)
ROOM = (
    Claim(
        "touched",
        "two NAOs play in rooms of 3 x 3 m with three discs; neither falls or "
        "touches an obstacle (1 if one does)",
        SEQUEL,
        PHYSICS,
        0.0,
        "1",
    ),
    Claim(
        "clear",
        "and both keep clear (least distance of a trunk from obstacles and "
        "walls)",
        SEQUEL,
        PHYSICS,
        0.0,
        "m",
        relation=">",
    ),
    Claim(
        "free",
        "nor does the paper's pursuer capture the evader, at 0.35 m, or "
        "touch it (time for which the evader is free)",
        SEQUEL,
        PHYSICS,
        DURATION,
        "s",
        1e-6,
    ),
)
