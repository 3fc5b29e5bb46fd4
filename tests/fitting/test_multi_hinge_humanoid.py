"""Test models with several hinges in one body, and refusals of what is none.

MuJoCo hangs any number of joints on a body: all links but the last of such
a body have no mass.
"""

from pathlib import Path

import pytest

import vendor_humanoid as stranger
from stepaside.fitting.derivation import DerivedDescription, derive
from stepaside.fitting.description_writer import write_description
from stepaside.robots.description import FILE

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


@pytest.fixture(scope="module")
def both(
    tmp_path_factory: pytest.TempPathFactory,
) -> tuple[DerivedDescription, DerivedDescription]:
    """The same robot with several hinges in a body, and with one in each."""
    found = []
    for split in (False, True):
        folder = tmp_path_factory.mktemp("hinges")
        model = write(folder, split=split)
        found.append(derive(model, folder, []))
        text = write_description(found[-1])
        (folder / FILE).write_text(text, encoding="utf-8")
    return found[0], found[1]


def test_several_hinges_in_a_body_are_one_joint_each(
    both: tuple[DerivedDescription, DerivedDescription],
) -> None:
    merged, split = both
    assert merged.analysis.model.nbody < split.analysis.model.nbody
    for one, other in zip(
        merged.analysis.legs, split.analysis.legs, strict=True
    ):
        assert one.joints == other.joints and len(one.joints) == 6


def test_what_is_derived_depends_on_masses_and_not_on_bodies(
    both: tuple[DerivedDescription, DerivedDescription],
) -> None:
    """The limit of links that get ever lighter."""
    merged, split = (found.description for found in both)
    assert merged.gait == pytest.approx(split.gait, rel=1e-3, abs=1e-4)
    assert merged.standing == pytest.approx(split.standing, abs=1e-3)
    assert merged.control["method"] == split.control["method"]
    assert both[0].loads.joint == both[1].loads.joint
    assert both[0].loads.usual == pytest.approx(both[1].loads.usual, rel=5e-3)
