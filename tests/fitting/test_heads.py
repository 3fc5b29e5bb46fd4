"""Test that heads are found in published models."""

from pathlib import Path

import vendor_humanoid as stranger
from stepaside.fitting.derivation import head_of
from stepaside.fitting.model_analysis import analyse_model

HEAD = """
<body name="neck" pos="0.06 0 0.4">
  <joint name="look" axis="0 0 1" range="-1 1"/>
  <inertial mass="0.4" pos="0 0 0" diaginertia="0.001 0.001 0.001"/>
  <body name="skull">
    <joint name="nod" axis="0 1 0" range="-0.5 0.5"/>
    <inertial mass="0.8" pos="0 0 0.1" diaginertia="0.002 0.002 0.002"/>
    <camera name="eye" pos="0.1 0 0.1"/>
  </body>
</body>
<body name="wing" pos="0.06 0.3 0.3">
  <joint name="flap" axis="0 0 1" range="-1 1"/>
  <inertial mass="0.1" pos="0 0 0" diaginertia="0.001 0.001 0.001"/>
</body>
</body>
</worldbody>"""


def test_head_joints_are_in_the_sagittal_plane(
    tmp_path: Path,
) -> None:
    file = stranger.mjcf(tmp_path)
    none = head_of(analyse_model(file, []))
    assert none == {"yaw": None, "pitch": None, "cameras": []}
    before, after = file.read_text().split("</worldbody>")
    body = before.rstrip().removesuffix("</body>")
    file.write_text(body + HEAD + after)
    found = head_of(analyse_model(file, []))
    assert found == {"yaw": "look", "pitch": "nod", "cameras": ["eye"]}
