"""Run ``stepaside play`` with the options of a parameter file.

    ros2 launch stepaside_bringup player.launch.py role:=pursuer

Topics stay on this machine: other nodes need
``ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST``, or give ``network:=true``.
"""

from pathlib import Path

import yaml
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration

CONFIG = Path(__file__).parents[1] / "config" / "player.yaml"


def generate_launch_description() -> LaunchDescription:
    """Return the arguments and the process, with and without network."""
    options = yaml.safe_load(CONFIG.read_text(encoding="utf-8"))
    arguments = [
        DeclareLaunchArgument(name, default_value=str(value))
        for name, value in options.items()
    ]
    network = DeclareLaunchArgument("network", default_value="false")
    command: list[object] = [
        *("stepaside", "play", LaunchConfiguration("address"))
    ]
    for name in options.keys() - {"address"}:
        command += ["--set", [f"{name}=", LaunchConfiguration(name)]]
    return LaunchDescription(
        [
            *arguments,
            network,
            ExecuteProcess(
                cmd=command,
                output="screen",
                sigterm_timeout="15",
                condition=UnlessCondition(LaunchConfiguration("network")),
            ),
            ExecuteProcess(
                cmd=[*command, "--set", "network=true"],
                output="screen",
                sigterm_timeout="15",
                condition=IfCondition(LaunchConfiguration("network")),
            ),
        ]
    )
