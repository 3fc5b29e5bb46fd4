"""Test that a missing optional dependency is named with its remedy."""

from stepaside.core.extras import install_hint


def test_a_missing_core_dependency_names_the_package() -> None:
    error = ModuleNotFoundError("No module named 'click.x'", name="click.x")
    assert install_hint(error).endswith(
        "click, which is not installed: pip install stepaside"
    )
