"""Messages of the RoboCup simulator: S-expressions after their length."""

import re
import socket
from typing import Any

_TOKEN = re.compile(rb"[()]|[^\s()]+")
PREFIX = 4  # bytes of a message's length, the most significant first
LONGEST = 1 << 20  # plausible length of a message, in bytes
Expression = list[Any]


class MessageError(ConnectionError):
    """Data that are no message of the simulator."""


def parse_expressions(text: bytes) -> list[Expression]:
    """Parse a sequence of S-expressions to nested lists of words.

    Args:
        text: For example ``(time (now 0.02))(GYR (n torso) (rt 0 0 0))``.

    Raises:
        MessageError: If parentheses do not match.
    """
    stack: list[Expression] = [[]]
    for token in _TOKEN.findall(text):
        if token == b"(":
            stack.append([])
        elif token != b")":
            stack[-1].append(token.decode("utf-8", "replace"))
        elif len(stack) > 1:
            done = stack.pop()
            stack[-1].append(done)
        else:
            raise MessageError("a message has too many closing parentheses")
    if len(stack) > 1:
        raise MessageError("a message ends within an expression")
    return [each for each in stack[0] if isinstance(each, list) and each]


class MessageSocket:
    """Connection to the simulator."""

    def __init__(self, host: str, port: int, timeout: float) -> None:
        """Connect.

        Args:
            host: Name of the computer.
            port: Port for agents.
            timeout: Of connecting and of each message, in [s].

        Raises:
            OSError: If the simulator does not answer.
        """
        self._socket = socket.create_connection((host, port), timeout)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def send(self, text: str) -> None:
        """Send a message."""
        data = text.encode()
        self._socket.sendall(len(data).to_bytes(PREFIX, "big") + data)

    def receive(self) -> bytes:
        """Receive the next message.

        Raises:
            OSError: If the simulator has ended or is silent.
        """
        length = int.from_bytes(self._exactly(PREFIX), "big")
        if length > LONGEST:
            raise MessageError(f"a message of {length} bytes: is this the "
                               "port for agents?")  # fmt: skip
        return self._exactly(length)

    def close(self) -> None:
        """Disconnect."""
        self._socket.close()

    def _exactly(self, count: int) -> bytes:
        data = b""
        while len(data) < count:
            part = self._socket.recv(count - len(data))
            if not part:
                raise ConnectionError("the simulator closed the connection")
            data += part
        return data
