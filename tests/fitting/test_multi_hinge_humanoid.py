"""Test models with several hinges in one body, and refusals of what is none.

MuJoCo hangs any number of joints on a body: all links but the last of such
a body have no mass.
"""

import pytest

import multi_hinge_humanoid
from stepaside.fitting.derivation import DerivedDescription, derive
from stepaside.fitting.description_writer import write_description
from stepaside.robots.description import FILE


@pytest.fixture(scope="module")
def both(
    tmp_path_factory: pytest.TempPathFactory,
) -> tuple[DerivedDescription, DerivedDescription]:
    """The same robot with several hinges in a body, and with one in each."""
    found = []
    for split in (False, True):
        folder = tmp_path_factory.mktemp("hinges")
        model = multi_hinge_humanoid.write(folder, split=split)
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
