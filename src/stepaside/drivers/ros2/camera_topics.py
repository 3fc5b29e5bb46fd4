"""What the camera of a simulated robot shows, on topics."""

from ...perception.images import ColourImage
from .dds_domain import DdsParticipant
from .messages import CompressedImage, Header, Image, Time
from .topics import COMPRESSED, IMAGE, dds_topic, frame


class CameraTopics:
    """Writes images, whole and compressed, for those who read them."""

    def __init__(self, dds: DdsParticipant, namespace: str) -> None:
        """Take part in the topics of a robot's camera.

        Args:
            dds: Where; it stays with the caller.
            namespace: Of the robot, with a slash before it, or empty.
        """
        self._frame = frame(namespace, "camera")
        self._whole = dds.writer(dds_topic(namespace, IMAGE), Image)
        self._squeezed = dds.writer(
            dds_topic(namespace, COMPRESSED), CompressedImage
        )
        self._told: ColourImage | None = None

    def tell(self, image: ColourImage | None) -> None:
        """Write an image, if it is new and somebody reads it."""
        if image is None or image is self._told:
            return
        from .image_messages import compressed_message, image_message

        self._told = image
        header = Header(Time.of(image.time), self._frame)
        if self._whole.get_matched_subscriptions():
            self._whole.write(image_message(header, image.pixels))
        if self._squeezed.get_matched_subscriptions():
            self._squeezed.write(compressed_message(header, image.pixels))
