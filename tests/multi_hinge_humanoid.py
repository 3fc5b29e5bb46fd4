"""Humanoid whose bodies carry several hinges each, as MJCF allows."""

from pathlib import Path

import vendor_humanoid as stranger

# Bodies of a leg: name, joints of :data:`vendor_humanoid.LEG`, place of
# the body in the one above [m], mass [kg].
BODIES = (
    ("thigh", 3, -0.12, 4.1),
    ("shin", 1, -stranger.THIGH, 1.6),
    ("foot", 2, -stranger.SHANK, 0.9),
)
NEXT_TO_NOTHING = 1e-5  # mass of a body that only carries a hinge, in [kg]


def write(folder: Path, *, split: bool) -> Path:
    """Write its MJCF.

    Args:
        folder: Where to.
        split: Whether each hinge has a body of its own, nearly without mass;
            else three hinges share the thigh and two the foot.
    """
    legs = "".join(_leg(*side, split=split) for side in stranger.SIDES)
    motors = "".join(
        f'<motor joint="{side}_{part[0]}" gear="30" '
        f'ctrlrange="{-stranger.TORQUE / 30} {stranger.TORQUE / 30}"/>'
        for side, _ in stranger.SIDES
        for part in stranger.LEG
    )
    file = folder / "hinges.xml"
    file.write_text(f"""
    <mujoco model="hinges">
      <compiler angle="radian"/>
      <worldbody>
        <body name="chest" pos="0 0 0.9">
          <freejoint/>
          <inertial mass="12" pos="{stranger.HIPS} 0 0.15"
            diaginertia="0.3 0.25 0.15"/>
          {legs}
        </body>
      </worldbody>
      <actuator>{motors}</actuator>
    </mujoco>""")
    return file


def _leg(side: str, sign: float, *, split: bool) -> str:
    begin, end, number = "", "", 0
    for name, count, down, mass in BODIES:
        x, y = 0.0, 0.0
        if name == "thigh":
            x, y = stranger.HIPS, 0.5 * sign * stranger.WIDTH
        place = f"{x} {y} {down}"
        hinges = [
            _hinge(side, sign, number + i, highest=i == 0 and name == "thigh")
            for i in range(count)
        ]
        number += count
        begin += f'<body name="{side}_{name}" pos="{place}">'
        end += "</body>"
        for i, hinge in enumerate(hinges):
            begin += hinge
            if split and i < count - 1:
                begin += (
                    f'<inertial mass="{NEXT_TO_NOTHING}" pos="0 0 0" '
                    'diaginertia="1e-7 1e-7 1e-7"/>'
                    f'<body name="{side}_{name}_{i}">'
                )
                end += "</body>"
        back, front, half = stranger.SOLE
        begin += (
            f'<inertial mass="{mass}" pos="0 0 {0.0 if count == 2 else -0.1}"'
            ' diaginertia="0.02 0.02 0.006"/>'
        )
        if name == "foot":
            begin += (
                f'<geom type="box" size="{0.5 * (front - back)} {half} 0.01" '
                f'pos="{0.5 * (front + back)} 0 {0.01 - stranger.FOOT}"/>'
            )
    return begin + end


def _hinge(side: str, sign: float, number: int, *, highest: bool) -> str:
    name, axis, _, (low, high), _ = stranger.LEG[number]
    a, b, c = axis
    if (a or c) and sign < 0.0:
        low, high = -high, -low
    return (
        f'<joint name="{side}_{name}" axis="{a} {b} {c}" damping="0.8" '
        f'pos="0 0 {0.04 if highest else 0.0}" range="{low} {high}"/>'
    )
