"""Synthetic humanoids whose geometry differs from that of NAO.

Hip yaws are independent, the torso's frame lies behind the hips and is
turned, hip axes do not meet, joints sit off their bodies' origins.
"""

from pathlib import Path

from stepaside.robots.description import RobotDescription, load_robot

LEG = """
<body name="{s}_hip" pos="0.06 {y} -0.12" quat="0.8 0 0.6 0">
  <joint name="{s}_hip_yaw" axis="-0.96 0 0.28" range="-1 1"/>
  <inertial mass="0.6" pos="0.01 0 0" diaginertia="0.002 0.002 0.002"/>
  <body name="{s}_pelvis" quat="0.8 0 -0.6 0" pos="0 0 0">
    <joint name="{s}_hip_roll" axis="1 0 0" pos="0 0 -0.03" range="-0.8 0.8"/>
    <inertial mass="0.2" pos="0 0 0" diaginertia="0.001 0.001 0.001"/>
    <body name="{s}_thigh" pos="0.01 0 -0.05">
      <joint name="{s}_hip_pitch" axis="0 1 0" range="-2 1"/>
      <inertial mass="1.9" pos="0 0.01 -0.12" diaginertia="0.01 0.01 0.01"/>
      <body name="{s}_plate" pos="0.03 0 -0.1">
        <inertial mass="0.2" pos="0 0 0" diaginertia="0.001 0.001 0.001"/>
      </body>
      {extra}
      <body name="{s}_shank" pos="0 0 -0.24">
        <joint name="{s}_knee" axis="0 2 0" range="0 2.4"/>
        <inertial mass="1.2" pos="0 0 -0.1" diaginertia="0.01 0.01 0.01"/>
        <body name="{s}_ankle" pos="0 0 -0.25">
          <joint name="{s}_ankle_pitch" axis="0 -1 0" range="-1 1.2"/>
          <inertial mass="0.1" pos="0 0 0" diaginertia="0.001 0.001 0.001"/>
          <body name="{s}_foot" euler="0 0 0.1">
            <joint name="{s}_ankle_roll" axis="1 0 0" range="-0.7 0.7"/>
            <inertial mass="0.7" pos="0.03 0 -0.03"
              diaginertia="0.002 0.002 0.002"/>
            <geom type="box" size="0.09 0.045 0.01" pos="0.02 0 -0.05"
              mass="0"/>
            <site name="{s}_sole" pos="0 0 -0.06" euler="0 0 -0.1"/>
          </body>
        </body>
      </body>
      {end}
    </body>
  </body>
</body>"""
MODEL = """
<mujoco model="synthetic">
  <compiler angle="radian" inertiafromgeom="false"/>
  <asset><material name="paint" rgba="1 0 0 1"/></asset>
  <worldbody>
    <body name="rail" pos="3 0 0"><geom size="0.1" mass="1"/></body>
    <body name="trunk" pos="0 0 0.8" quat="0.6 0 0 0.8">
      <freejoint/>
      <inertial mass="8" pos="0.05 0 0.1" diaginertia="0.1 0.1 0.1"/>
      {legs}
      <body name="chest" pos="0.05 0 0.2">
        <joint name="waist" axis="0 0 1" ref="0.2" range="-1 1"/>
        <inertial mass="4" pos="0 0 0.1" diaginertia="0.05 0.05 0.05"/>
        <body name="neck" pos="0 0 0.25" euler="0.1 0.2 0.3">
          <joint name="mast" type="slide" axis="0 0 1" range="0 0.2"/>
          <joint name="nod" axis="0 1 0" pos="0 0 0.03" range="-1 1"/>
          <inertial mass="1" pos="0 0.01 0" diaginertia="0.01 0.01 0.01"/>
          <site name="eye" pos="0.05 0 0.02"/>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>{motors}</actuator>
</mujoco>"""
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
