"""Settings that were added after the first records of duels.

They are not part of the key of a record if they have their default value.
"""

LATER = (
    "start.least",
    "start.near",
    "start.far",
    "strategy.trigger",
    "strategy.contact_time",
    "strategy.clearance",
    "strategy.calmest",
    "control.stabiliser.stride_bound",
    "control.stabiliser.load_share",
    "control.learn_turns",
    "gait.outer_stride",
    "gait.swing_profile",
    "gait.swing_reaction",
    "person.halt_after",
    "person.turn_after",
    "person.turn",
    "person.backward",
    "person.figure",
    "room.plan",
    "map",
    "pursuer_robot",
    "evader_robot",
    "pushes",
    "passers",
)
