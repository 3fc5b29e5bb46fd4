"""Live game for Foxglove, on a WebSocket of this machine.

Messages are those of a bag: topics, ROS 2 types and frames are the same.
"""

from queue import SimpleQueue
from typing import Any

from ...core.errors import ConfigurationError
from .bag_messages import MessageFactory, nanoseconds
from .bag_recording import TopicMessage, messages_of
from .live_recording import LivePiece

HOST = "127.0.0.1"


class LiveFoxglove:
    """WebSocket to which Foxglove connects.

    Foxglove's server keeps no messages. Those that a bag gives to late
    subscribers (URDF, fixed transforms, room) are sent again to each client
    that subscribes.

    Attributes:
        address: Address for Foxglove.
    """

    def __init__(self, port: int) -> None:
        """Serve on a port of this machine.

        Raises:
            ConfigurationError: If the port is in use.
        """
        import foxglove
        from foxglove.websocket import Capability

        self._factory = MessageFactory()
        self._wanted: SimpleQueue[str] = SimpleQueue()
        try:
            self._server = foxglove.start_server(
                name="stepaside",
                host=HOST,
                port=port,
                capabilities=[Capability.Time],
                server_listener=_subscriptions(self._wanted),
                supported_encodings=["cdr"],
            )
        except RuntimeError as error:
            raise ConfigurationError(
                f"Foxglove cannot be served at port {port}: {error}"
            ) from error
        self.address = f"ws://{HOST}:{self._server.port}"
        self._channels: dict[str, Any] = {}
        self._kept: dict[str, TopicMessage] = {}

    def show(self, piece: LivePiece) -> None:
        """Send the messages of a piece; a new game begins a new session."""
        recording, begins = piece
        if begins and self._kept:
            self._kept.clear()
            self._server.clear_session()  # its time goes back
        for message in messages_of(recording, self._factory, room=begins):
            if message.stays:
                known = message.topic in self._kept
                self._kept[message.topic] = message
                if known and not begins and message.topic != "/room":
                    continue  # as it was sent before
            self._send(message)
        while not self._wanted.empty():
            kept = self._kept.get(self._wanted.get())
            if kept is not None:
                self._send(kept)
        now = float(recording.run.times[-1])
        self._server.broadcast_time(nanoseconds(now))

    def _send(self, message: TopicMessage) -> None:
        topic, kind = message.topic, message.kind
        if topic not in self._channels:
            from foxglove import Channel, Schema

            text, _ = self._factory.store.generate_msgdef(kind)
            schema = Schema(name=kind, encoding="ros2msg", data=text.encode())
            self._channels[topic] = Channel(
                topic, schema=schema, message_encoding="cdr"
            )
        data = self._factory.store.serialize_cdr(message.message, kind)
        self._channels[topic].log(
            bytes(data), log_time=nanoseconds(message.time)
        )

    def close(self) -> None:
        """End the server."""
        self._server.stop()


def _subscriptions(wanted: "SimpleQueue[str]") -> Any:
    """Return a listener that notes the topics that clients subscribe to."""
    from foxglove.websocket import ServerListener

    class Subscriptions(ServerListener):  # type: ignore[misc]
        """Listener of subscriptions."""

        def on_subscribe(self, client: Any, channel: Any) -> None:
            """Note the topic."""
            wanted.put(channel.topic)

    return Subscriptions()
