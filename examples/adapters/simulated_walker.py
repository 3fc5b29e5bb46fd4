# /// script
# dependencies = []
# ///
"""Simulated robot that walks at a velocity, and a person who follows it.

A stand-in for a real robot and its network::

    python simulated_walker.py [--port N] [--timeout S]

Like many robots, it keeps its last velocity for ever; with ``--timeout`` it
stops when no command has come for so long. The person comes from 2 m ahead
and walks toward the robot at 0.2 m/s. In the images of the camera in the
robot's head the person is a small robot with red trim, as the perception of
``stepaside`` looks for.
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
WIDTH, HEIGHT, FOCAL = 160, 120, 140.0  # of an image, in [px]
CAMERA = 0.8  # height of the camera, in [m]
GREY, RED = b"\x80\x80\x80", b"\xc8\x1e\x1e"
# Trim of the person: discs by height and to the left of the axis, in [m].
TRIM = [(0.51 - 0.06 * i, 0.06 * (-1) ** i) for i in range(8)]
TRIM_RADIUS = 0.03  # in [m]


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
        self.head = [0.0, 0.0]  # yaw to the left and pitch downward, in [rad]
        self.subscribers: set[tuple[str, int]] = set()
        self.commanded = self.time = monotonic()
        # Until these times the network loses something.
        self.lost = {"states": -inf, "commands": -inf, "images": -inf}

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

    def image(self) -> bytes:
        """Return an image as a message: values in one line, then pixels."""
        pixels = bytearray(GREY * (WIDTH * HEIGHT))
        yaw, pitch = self.pose[2] + self.head[0], self.head[1]
        dx, dy = self.person[0] - self.pose[0], self.person[1] - self.pose[1]
        ahead = cos(yaw) * dx + sin(yaw) * dy
        left = cos(yaw) * dy - sin(yaw) * dx
        for height, aside in TRIM:
            below = CAMERA - height
            depth = cos(pitch) * ahead + sin(pitch) * below
            if depth > 0.1:
                across = 0.5 * WIDTH - FOCAL * (left + aside) / depth
                down = cos(pitch) * below - sin(pitch) * ahead
                down = 0.5 * HEIGHT + FOCAL * down / depth
                draw_disc(pixels, across, down, FOCAL * TRIM_RADIUS / depth)
        entries = {"time": self.time, "width": WIDTH, "height": HEIGHT}
        more = {"focal": FOCAL, "up": CAMERA, "head": self.head}
        return json.dumps(entries | more).encode() + b"\n" + pixels

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
            elif call["call"] == "image":
                if monotonic() > self.lost["images"]:
                    self.socket.sendto(self.image(), sender)
            elif monotonic() > self.lost["commands"]:
                self.obey(call, sender)

    def obey(self, call: dict[str, Any], sender: tuple[str, int]) -> None:
        """Obey a call of the SDK."""
        if call["call"] == "subscribe":
            self.subscribers.add(sender)
        elif call["call"] == "unsubscribe":
            self.subscribers.discard(sender)
        elif call["call"] == "head":
            self.head = call["angles"]
        else:
            self.velocity, self.commanded = call["velocity"], monotonic()


def draw_disc(pixels: bytearray, u: float, v: float, radius: float) -> None:
    """Draw a red disc at a column and a row, in [px]."""
    for row in range(max(0, round(v - radius)), HEIGHT):
        half = radius**2 - (row + 0.5 - v) ** 2
        if half < 0.0:
            if row > v:
                return
            continue
        first = min(max(0, round(u - half**0.5)), WIDTH)
        last = min(max(first, round(u + half**0.5)), WIDTH)
        at = 3 * (row * WIDTH + first)
        pixels[at : at + 3 * (last - first)] = RED * (last - first)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--port", type=int, default=29600)
    parser.add_argument("--timeout", type=float, default=inf)
    options = parser.parse_args()
    walker = SimulatedWalker(options.port, options.timeout)
    print(f"port {walker.socket.getsockname()[1]}", flush=True)
    walker.run()
