"""Image topics of a simulated robot."""

from ...perception.images import ColourImage
from .dds_domain import DdsParticipant
from .messages import CompressedImage, Header, Image, Time
from .topics import COMPRESSED, IMAGE, dds_topic, frame


class CameraTopics:
    """Publisher of raw and compressed images."""

    def __init__(self, dds: DdsParticipant, namespace: str) -> None:
        """Create the publishers.

        Args:
            dds: DDS participant; the caller closes it.
            namespace: Namespace of the robot, with a leading slash; or empty.
        """
        self._frame = frame(namespace, "camera")
        self._raw = dds.writer(dds_topic(namespace, IMAGE), Image)
        self._compressed = dds.writer(
            dds_topic(namespace, COMPRESSED), CompressedImage
        )
        self._published: ColourImage | None = None

    def publish(self, image: ColourImage | None) -> None:
        """Publish an image that is new, on topics with a subscriber."""
        if image is None or image is self._published:
            return
        # Imported here, as only images need OpenCV.
        from .image_messages import compressed_message, image_message

        self._published = image
        header = Header(Time.of(image.time), self._frame)
        if self._raw.get_matched_subscriptions():
            self._raw.write(image_message(header, image.pixels))
        if self._compressed.get_matched_subscriptions():
            self._compressed.write(compressed_message(header, image.pixels))
