"""Readers and writers that other participants have on one topic."""

from typing import Any
from uuid import UUID

from .dds_domain import DdsParticipant

from cyclonedds.builtin import (  # isort: skip
    BuiltinDataReader,
    BuiltinTopicDcpsPublication,
    BuiltinTopicDcpsSubscription,
)
from cyclonedds.core import DDSException  # isort: skip

ONCE = 64  # announcements that are taken at once


class Endpoints:
    """Endpoints of others on one topic, whatever their type.

    Unlike a reader or a writer of one's own it sees those that do not
    match, and none of them sees it.
    """

    def __init__(
        self, dds: DdsParticipant, topic: str, *, writers: bool
    ) -> None:
        """Listen to what DDS discovers.

        Args:
            dds: Where; it stays with the caller.
            topic: Name on DDS.
            writers: Whether writers are looked for, or readers.
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
        return len({participant for participant, _ in self._look()})

    @property
    def types(self) -> set[str]:
        """Types of the endpoints, by their names on DDS."""
        return {kind for _, kind in self._look()}

    def _look(self) -> list[tuple[UUID, str]]:
        """Participant and type of each endpoint that is there now."""
        while arrived := self._taken():
            for sample in arrived:
                if not sample.sample_info.valid_data:
                    self._found.pop(sample.key, None)  # it is gone
                elif sample.topic_name == self._topic:
                    if sample.participant_key != self._own:
                        self._found[sample.key] = (
                            sample.participant_key,
                            sample.type_name,
                        )
        return list(self._found.values())

    def _taken(self) -> list[Any]:
        try:
            found: list[Any] = self._reader.take(N=ONCE)
        except DDSException:
            return []
        return found
