"""Humanoid models as vendors publish them, without actuators or sensors.

The models have independent hip yaws, and legs, soles and arms whose joints and
bodies have names of their own. One comes as MJCF with torque motors and a
floor of its own, one as URDF without a free joint.
"""

from pathlib import Path

HIPS = 0.06  # how far they lie ahead of the torso's origin, in [m]
WIDTH = 0.16  # between the hips, in [m]
THIGH, SHANK, FOOT = 0.28, 0.28, 0.05  # lengths, in [m]
SOLE = (-0.07, 0.11, 0.045)  # back, front and half width, in [m]
TORQUE = 90.0  # of a leg joint, in [N m]
# Name, axis, place in the body above [m], range [rad], and mass [kg].
LEG = (
    ("spin", (0, 0, 1), (HIPS, 0.5 * WIDTH, -0.08), (-0.9, 0.9), 0.9),
    ("splay", (1, 0, 0), (0, 0, -0.04), (-0.6, 0.6), 0.8),
    ("swing", (0, 1, 0), (0, 0, 0), (-1.8, 1.2), 2.4),
    ("bend", (0, 1, 0), (0, 0, -THIGH), (0.0, 2.2), 1.6),
    ("tip", (0, 1, 0), (0, 0, -SHANK), (-1.0, 1.0), 0.2),
    ("lean", (1, 0, 0), (0, 0, 0), (-0.5, 0.5), 0.7),
)


def mjcf(folder: Path, *, joints: int = 6, motors: bool = True) -> Path:
    """Write one with torque motors; it stands on a floor of its own.

    Args:
        folder: Where to.
        joints: Of a leg, the lowest of them left out.
        motors: Whether it has any.
    """
    legs = "".join(_leg(side, sign, joints) for side, sign in SIDES)
    names = [f"{side}_{p[0]}" for side, _ in SIDES for p in LEG[:joints]]
    actuators = "".join(
        f'<motor name="push_{n}" joint="{n}" gear="30" '
        f'ctrlrange="{-TORQUE / 30} {TORQUE / 30}"/>'
        for n in names
    )
    text = f"""
    <mujoco model="stranger">
      <compiler angle="radian"/>
      <option timestep="0.005"/>
      <asset><mesh name="shell" file="lost.stl"/></asset>
      <worldbody>
        <light pos="0 0 3"/>
        <geom name="floor" type="plane" size="5 5 0.1"/>
        <body name="chest" pos="0 0 0.9">
          <freejoint/>
          <inertial mass="12" pos="{HIPS} 0 0.15"
            diaginertia="0.3 0.25 0.15"/>
          <geom type="mesh" mesh="shell" contype="0" conaffinity="0"/>
          <geom type="box" size="0.08 0.1 0.2" pos="{HIPS} 0 0.15"/>
          {legs}
        </body>
      </worldbody>
      <actuator>{actuators if motors else ""}</actuator>
      <keyframe><key name="home"/></keyframe>
    </mujoco>"""
    file = folder / "stranger.xml"
    file.write_text(text)
    return file


SIDES = (("near", 1.0), ("far", -1.0))


def _leg(side: str, sign: float, joints: int) -> str:
    begin, end = "", ""
    for i, (name, axis, place, (low, high), mass) in enumerate(LEG[:joints]):
        x, y, z = place
        a, b, c = axis
        if a or c:  # a mirrored joint has the mirrored range
            low, high = (low, high) if sign > 0 else (-high, -low)
        last = i == joints - 1
        shape = _sole() if last else ""
        begin += (
            f'<body name="{side}_{name}_link" pos="{x} {sign * y} {z}">'
            f'<joint name="{side}_{name}" axis="{a} {b} {c}" damping="0.8" '
            f'range="{low} {high}"/>'
            f'<inertial mass="{mass}" pos="0 0 {-0.4 * _below(name)}" '
            f'diaginertia="0.01 0.01 0.004"/>{shape}'
        )
        end += "</body>"
    return begin + end


def _sole() -> str:
    back, front, half = SOLE
    middle, length = 0.5 * (front + back), 0.5 * (front - back)
    return (
        f'<geom type="box" size="{length} {half} 0.01" '
        f'pos="{middle} 0 {0.01 - FOOT}"/>'
    )


def _below(name: str) -> float:
    """Length of the link under a joint, in [m]."""
    return {"swing": THIGH, "bend": SHANK}.get(name, 0.0)


def urdf(folder: Path) -> Path:
    """Write one without a free joint, whose root is a link as any other."""
    links = [_link("chest", 12.0, (HIPS, 0.0, 0.15), 0.2)]
    joints = []
    for side, sign in SIDES:
        above = "chest"
        for name, axis, place, (low, high), mass in LEG:
            link = f"{side}_{name}_link"
            shape = _urdf_sole() if name == "lean" else ""
            middle = (0.0, 0.0, -0.4 * _below(name))
            links.append(_link(link, mass, middle, 0.01, shape))
            x, y, z = place
            joints.append(
                f'<joint name="{side}_{name}" type="revolute">'
                f'<parent link="{above}"/><child link="{link}"/>'
                f'<origin xyz="{x} {sign * y} {z}"/>'
                f'<axis xyz="{axis[0]} {axis[1]} {axis[2]}"/>'
                f'<limit lower="{low}" upper="{high}" effort="{TORQUE}" '
                f'velocity="9.5"/></joint>'
            )
            above = link
    file = folder / "stranger.urdf"
    body = "".join([*links, *joints])
    file.write_text(f'<robot name="stranger">{body}</robot>')
    return file


def _link(
    name: str,
    mass: float,
    middle: tuple[float, float, float],
    inertia: float,
    shape: str = "",
) -> str:
    x, y, z = middle
    return (
        f'<link name="{name}"><inertial><origin xyz="{x} {y} {z}"/>'
        f'<mass value="{mass}"/><inertia ixx="{inertia}" ixy="0" ixz="0" '
        f'iyy="{inertia}" iyz="0" izz="{inertia}"/></inertial>{shape}</link>'
    )


def _urdf_sole() -> str:
    back, front, half = SOLE
    return (
        f'<collision><origin xyz="{0.5 * (front + back)} 0 {0.01 - FOOT}"/>'
        f'<geometry><box size="{front - back} {2 * half} 0.02"/></geometry>'
        "</collision>"
    )
