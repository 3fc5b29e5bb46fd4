"""Build of the package, by colcon."""

from setuptools import setup

NAME = "stepaside_bringup"
setup(
    name=NAME,
    version="0.1.0",
    packages=[NAME],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/launch", ["launch/player.launch.py"]),
        (f"share/{NAME}/config", ["config/player.yaml"]),
    ],
    zip_safe=True,
    license="BSD-3-Clause",
)
