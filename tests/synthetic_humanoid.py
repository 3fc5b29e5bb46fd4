"""Synthetic humanoids whose geometry differs from that of NAO.

Hip yaws are independent, the torso's frame lies behind the hips and is
turned, hip axes do not meet, joints sit off their bodies' origins.
"""

from pathlib import Path

from stepaside.robots.description import RobotDescription, load_robot
from stored_values import DATA

LEG = (DATA / "synthetic_leg.xml").read_text("utf-8")
MODEL = (DATA / "synthetic_humanoid.xml").read_text("utf-8")
JOINTS = (
    *("hip_yaw", "hip_roll", "hip_pitch"),
    *("knee", "ankle_pitch", "ankle_roll"),
)
BENT = {"hip_pitch": -0.35, "knee": 0.7, "ankle_pitch": 0.35}
TURNED = """<body name="{s}_twist" pos="0 0 -0.05">
<joint name="{s}_twist" axis="0 0 1" range="-1 1"/>
<inertial mass="0.1" pos="0 0 0" diaginertia="0.001 0.001 0.001"/>"""


def synthetic_humanoid(
    folder: Path, *, twists: bool = False
) -> RobotDescription:
    """Write a humanoid into a folder, and load it.

    Args:
        folder: An empty folder.
        twists: Whether each leg has a seventh joint, in the thigh.
    """
    names = (*JOINTS[:3], "twist", *JOINTS[3:]) if twists else JOINTS
    legs = ""
    for s, y in (("l", 0.09), ("r", -0.09)):
        extra, end = (TURNED.format(s=s), "</body>") if twists else ("", "")
        legs += LEG.format(s=s, y=y, extra=extra, end=end)
    all_legs = [f"{s}_{name}" for s in "lr" for name in names]
    motors = [*reversed(all_legs), "nod", "waist"]
    actuators = "".join(
        f'<position name="{m}" joint="{m}" kp="10"/>' for m in motors
    )
    (folder / "synthetic.xml").write_text(
        MODEL.format(legs=legs, motors=actuators)
    )
    standing = {f"{s}_{n}": a for s in "lr" for n, a in BENT.items()}
    standing |= {"waist": 0.3, "mast": 0.05}
    quoted = ", ".join(f'"{name}"' for name in all_legs)
    lines = [
        'name = "Synthetic"',
        'model = "synthetic.xml"',
        'torso = "trunk"',
        'left_foot = "l_sole"',
        'right_foot = "r_sole"',
        'accent = "paint"',
        f"legs = [{quoted}]",
        "[standing]",
        *(f"{name} = {angle}" for name, angle in standing.items()),
        "[speed_limits]",
        *(f"{name} = 8.0" for name in motors),
    ]
    (folder / "robot.toml").write_text("\n".join(lines))
    return load_robot(folder)
