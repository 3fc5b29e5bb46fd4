"""Contract values in the YAML files that trainers keep beside networks."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ...core.errors import PolicyError
from .trainer_conventions import Convention

Entries = dict[str, Any]


def read_deployment(path: Path, convention: Convention) -> Entries:
    """Read the deployment file of a network.

    Args:
        path: YAML file.
        convention: Convention of the trainer that wrote it.

    Returns:
        Entries as in ``[locomotion]`` of a robot description.

    Raises:
        PolicyError: If the trainer writes no such file, or a value is
            missing.
    """
    import yaml

    if convention.name not in DEPLOYMENTS:
        raise PolicyError(
            f"legs: {convention.name} has no deployment file; those that have "
            f"are {', '.join(DEPLOYMENTS)}"
        )
    try:
        given = yaml.safe_load(path.read_text(encoding="utf-8"))
        return DEPLOYMENTS[convention.name](given, convention)
    except OSError as error:
        raise PolicyError(
            f"legs: cannot read {path}: {error.strerror}"
        ) from error
    except KeyError as error:
        raise PolicyError(
            f"legs: {path} is not a deployment file of {convention.name}: "
            f"it lacks {error}"
        ) from error
    except (yaml.YAMLError, RecursionError, TypeError, ValueError) as error:
        raise PolicyError(
            f"legs: {path} is not a deployment file of {convention.name}"
        ) from error


def _legged_gym(given: Mapping[str, Any], convention: Convention) -> Entries:
    """Convert a file of ``deploy/deploy_mujoco/configs``."""
    scales = {
        "base_ang_vel": given["ang_vel_scale"],
        "joint_pos": given["dof_pos_scale"],
        "joint_vel": given["dof_vel_scale"],
        "command": given["cmd_scale"],
    }
    return {
        "stiffness": _numbers(given["kps"]),
        "damping": _numbers(given["kds"]),
        "default_posture": _numbers(given["default_angles"]),
        "action_scale": float(given["action_scale"]),
        "period": _period(given["simulation_dt"], given["control_decimation"]),
        "terms": _terms(convention, scales),
    }


def _booster_gym(given: Mapping[str, Any], convention: Convention) -> Entries:
    """Convert a file of ``deploy/configs``; the policy moves the last joints.

    The robot holds its other joints.
    """
    common, policy = given["common"], given["policy"]
    factors, control = policy["normalization"], policy["control"]
    moved = slice(-int(policy["num_actions"]), None)
    scales = {
        "projected_gravity": factors["gravity"],
        "base_ang_vel": factors["ang_vel"],
        "command": [factors[k] for k in ("lin_vel", "lin_vel", "ang_vel")],
        "joint_pos": factors["dof_pos"],
        "joint_vel": factors["dof_vel"],
    }
    return {
        "stiffness": _numbers(common["stiffness"])[moved],
        "damping": _numbers(common["damping"])[moved],
        "default_posture": _numbers(common["default_qpos"])[moved],
        "action_scale": float(control["action_scale"]),
        "action_clip": float(factors["clip_actions"]),
        "period": _period(common["dt"], control["decimation"]),
        "terms": _terms(convention, scales),
    }


def _numbers(values: Any) -> list[float]:
    return [float(value) for value in values]


def _period(time_step: Any, steps: Any) -> float:
    return round(float(time_step) * int(steps), 9)


def _terms(
    convention: Convention, scales: Mapping[str, Any]
) -> list[dict[str, Any]]:
    """Return the terms of the convention with the scales of a file."""
    return [
        {
            "name": term.name,
            "scale": _numbers(given if isinstance(given, list) else [given]),
        }
        for term in convention.values["terms"]
        for given in [scales.get(term.name, list(term.scale))]
    ]


DEPLOYMENTS: Mapping[
    str, Callable[[Mapping[str, Any], Convention], Entries]
] = {"legged_gym": _legged_gym, "booster_gym": _booster_gym}
"""Conventions whose trainers write such a file."""
