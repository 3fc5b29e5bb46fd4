# /// script
# dependencies = []
# ///
"""Simulated robot that walks at a velocity, and a person who follows it.

A stand-in for a real robot and its network::

    python simulated_walker.py [--port N] [--timeout S]

Like many robots, it keeps its last velocity for ever; with ``--timeout`` it
stops when no command has come for so long. The person comes from 2 m ahead
and walks toward the robot at 0.2 m/s.
"""

import argparse
import json
import socket
from math import atan2, cos, hypot, inf, sin
from time import monotonic
from typing import Any

PERIOD = 0.02  # between two states, in [s]
PERSON_SPEED = 0.2  # in [m/s]
NEAREST = 0.3  # distance at which the person stands, in [m]


class SimulatedWalker:
    """Robot, person and the robots' network."""

    def __init__(self, port: int, timeout: float) -> None:
        """Listen on a port of this machine; 0 takes a free one."""
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", port))
        self.timeout = timeout
        self.pose = [0.0, 0.0, 0.0]
        self.person = [2.0, 0.0]
        self.velocity = [0.0, 0.0, 0.0]
        self.subscribers: set[tuple[str, int]] = set()
        self.commanded = self.time = monotonic()
        self.lost = {"states": -inf, "commands": -inf}  # until this time

    def run(self) -> None:
        """Simulate in real time, for ever."""
        while True:
            now = monotonic()
            if now - self.commanded > self.timeout:
                self.velocity = [0.0, 0.0, 0.0]
            self.move(now - self.time)
            self.time = now
            if now > self.lost["states"]:
                for subscriber in tuple(self.subscribers):
                    self.socket.sendto(self.state(), subscriber)
            self.answer(now + PERIOD)

    def move(self, passed: float) -> None:
        """Move robot and person for a time, in [s]."""
        x, y, yaw = self.pose
        ahead, left, turn = self.velocity
        x += passed * (ahead * cos(yaw) - left * sin(yaw))
        y += passed * (ahead * sin(yaw) + left * cos(yaw))
        self.pose = [x, y, yaw + passed * turn]
        dx, dy = x - self.person[0], y - self.person[1]
        if hypot(dx, dy) > NEAREST:
            way = passed * PERSON_SPEED / hypot(dx, dy)
            self.person = [
                self.person[0] + way * dx,
                self.person[1] + way * dy,
            ]

    def state(self) -> bytes:
        """Return the state as a message."""
        x, y, yaw = self.pose
        dx, dy = self.person[0] - x, self.person[1] - y
        person = [cos(yaw) * dx + sin(yaw) * dy, cos(yaw) * dy - sin(yaw) * dx]
        yaw = atan2(sin(yaw), cos(yaw))
        entries = {"time": self.time, "x": x, "y": y, "yaw": yaw}
        return json.dumps(entries | {"person": person}).encode()

    def answer(self, until: float) -> None:
        """Receive calls until a time."""
        while (wait := until - monotonic()) > 0.0:
            self.socket.settimeout(wait)
            try:
                data, sender = self.socket.recvfrom(1024)
            except TimeoutError:
                return
            except ConnectionError:  # a client has gone
                continue
            call = json.loads(data)
            if call["call"] == "lose":  # of a test: its network fails
                self.lost |= {
                    k: monotonic() + v for k, v in call["for"].items()
                }
            elif call["call"] == "inspect":
                report = {"velocity": self.velocity, "pose": self.pose}
                self.socket.sendto(json.dumps(report).encode(), sender)
            elif monotonic() > self.lost["commands"]:
                self.obey(call, sender)

    def obey(self, call: dict[str, Any], sender: tuple[str, int]) -> None:
        """Obey a call of the SDK."""
        if call["call"] == "subscribe":
            self.subscribers.add(sender)
        elif call["call"] == "unsubscribe":
            self.subscribers.discard(sender)
        else:
            self.velocity, self.commanded = call["velocity"], monotonic()


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--port", type=int, default=29600)
    parser.add_argument("--timeout", type=float, default=inf)
    options = parser.parse_args()
    walker = SimulatedWalker(options.port, options.timeout)
    print(f"port {walker.socket.getsockname()[1]}", flush=True)
    walker.run()
