"""Claims of the conclusion (Sec. V) and of the paper's sequel."""

from .claims import Claim

STEPS, PHYSICS = "steps", "physics"
CONCLUSION = "V"
SEQUEL = "V; De Simone et al., IROS 2017"
DURATION = 40.0  # of the duels in rooms, in [s]

EVADING = (
    Claim(
        "farther",
        "there are better strategies than moving aside (closest approach of "
        "looking ahead over that of moving aside, on an open floor)",
        CONCLUSION,
        STEPS,
        1.2,
        "1",
        relation=">",
    ),
    Claim(
        "best",
        "and none is much better than looking ahead (its closest approach "
        "over the best that there is against this pursuer)",
        CONCLUSION,
        STEPS,
        0.95,
        "1",
        relation=">",
    ),
    Claim(
        "survives",
        "an evader plays among obstacles (share of games of two minutes in "
        "rooms of 3 x 3 m with three discs that looking ahead survives)",
        SEQUEL,
        STEPS,
        1.0,
        "1",
        0.1,
    ),
    Claim(
        "clear",
        "and touches none (least clearance of its centre, less what its body "
        "needs)",
        SEQUEL,
        STEPS,
        -1e-9,
        "m",
        relation=">",
    ),
    Claim(
        "aside",
        "where moving aside walks into them (share that looking ahead "
        "survives, less that of moving aside)",
        SEQUEL,
        STEPS,
        0.1,
        "1",
        relation=">",
    ),
    Claim(
        "deflected",
        "a direction that obstacles deflect does not do (share that looking "
        "ahead survives, less that of a deflected evader)",
        SEQUEL,
        STEPS,
        0.0,
        "1",
        relation=">",
    ),
    Claim(
        "decision",
        "in the 10 ms that planning may take (mean of its decisions; on the "
        "machine that made this page, not on the NAO's)",
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
        "two NAOs play in rooms of 3 x 3 m with three discs; nobody falls or "
        "touches any of it (1 if somebody does)",
        SEQUEL,
        PHYSICS,
        0.0,
        "1",
    ),
    Claim(
        "clear",
        "and both keep clear (least distance of a trunk from what stands "
        "there)",
        SEQUEL,
        PHYSICS,
        0.0,
        "m",
        relation=">",
    ),
    Claim(
        "free",
        "nor is the evader caught (time that it plays and is free)",
        SEQUEL,
        PHYSICS,
        DURATION,
        "s",
        1e-6,
    ),
)
