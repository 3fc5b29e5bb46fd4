"""Discovery of the readers or writers of other participants."""

from typing import Any
from uuid import UUID

from .dds_domain import DdsParticipant

from cyclonedds.builtin import (  # isort: skip
    BuiltinDataReader,
    BuiltinTopicDcpsPublication,
    BuiltinTopicDcpsSubscription,
)
from cyclonedds.core import DDSException  # isort: skip

BATCH = 64  # announcements taken per call


class Endpoints:
    """Endpoints of other participants on one topic, of any type.

    Includes endpoints whose type or QoS would not match, and creates no
    endpoint that others could match.
    """

    def __init__(
        self, dds: DdsParticipant, topic: str, *, writers: bool
    ) -> None:
        """Subscribe to the discovery of DDS.

        Args:
            dds: DDS participant; the caller closes it.
            topic: Name of the topic on DDS.
            writers: Whether to list writers, or readers.
        """
        builtin = (
            BuiltinTopicDcpsPublication
            if writers
            else BuiltinTopicDcpsSubscription
        )
        self._topic, self._own = topic, dds.participant.guid
        self._reader = BuiltinDataReader(dds.participant, builtin)
        self._found: dict[UUID, tuple[UUID, str]] = {}

    @property
    def participants(self) -> int:
        """Number of participants that have such an endpoint."""
        return len({participant for participant, _ in self._present()})

    @property
    def types(self) -> set[str]:
        """Types of the endpoints, by their names on DDS."""
        return {kind for _, kind in self._present()}

    def _present(self) -> list[tuple[UUID, str]]:
        """Return participant and type of each endpoint present now."""
        while arrived := self._taken():
            for sample in arrived:
                if not sample.sample_info.valid_data:
                    self._found.pop(sample.key, None)  # endpoint removed
                elif sample.topic_name == self._topic:
                    if sample.participant_key != self._own:
                        self._found[sample.key] = (
                            sample.participant_key,
                            sample.type_name,
                        )
        return list(self._found.values())

    def _taken(self) -> list[Any]:
        try:
            found: list[Any] = self._reader.take(N=BATCH)
        except DDSException:
            return []
        return found
