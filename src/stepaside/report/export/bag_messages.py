"""ROS 2 messages of a recording, by the library rosbags."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.poses import Array
from ...perception.camera_model import CameraModel

UNKNOWN = np.full(9, 0.0)
NO_ORIENTATION = np.array([-1.0] + [0.0] * 8)  # as sensor_msgs/Imu says it
JPEG_QUALITY = 90


class MessageFactory:
    """Messages of the ROS 2 standard types.

    Attributes:
        store: Type store of rosbags, with the definitions of ROS 2 Humble;
            those of its successors are the same for the types used here.
    """

    def __init__(self) -> None:
        """Load the definitions."""
        from rosbags.typesys import Stores, get_typestore

        self.store = get_typestore(Stores.ROS2_HUMBLE)
        self._types: Mapping[str, Any] = self.store.types

    def make(self, kind: str, *values: Any) -> Any:
        """Return a message of a type like ``geometry_msgs/msg/Point``."""
        return self._types[kind](*values)

    def time(self, time: float) -> Any:
        """Return a time stamp of a time, in [s]."""
        stamp = nanoseconds(time)
        return self.make(
            "builtin_interfaces/msg/Time", stamp // 10**9, stamp % 10**9
        )

    def header(self, time: float, frame: str) -> Any:
        """Return a header."""
        return self.make("std_msgs/msg/Header", self.time(time), frame)

    def vector(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Any:
        """Return a vector."""
        return self.make("geometry_msgs/msg/Vector3", x, y, z)

    def rotation(self, wxyz: Sequence[float]) -> Any:
        """Return a quaternion; its order in memory is (w, x, y, z)."""
        w, x, y, z = wxyz
        return self.make("geometry_msgs/msg/Quaternion", x, y, z, w)

    def upright(self, heading: float) -> Any:
        """Return the rotation about the vertical by a heading, in [rad]."""
        half = 0.5 * heading
        return self.rotation((np.cos(half), 0.0, 0.0, np.sin(half)))

    def pose(self, position: Sequence[float], rotation: Any) -> Any:
        """Return a pose."""
        x, y, *z = position  # on the floor without z
        point = self.make("geometry_msgs/msg/Point", x, y, *(z or (0.0,)))
        return self.make("geometry_msgs/msg/Pose", point, rotation)

    def transform(
        self,
        header: Any,
        child: str,
        position: Sequence[float],
        rotation: Any,
    ) -> Any:
        """Return the transform of a child frame in that of the header."""
        both = self.make(
            "geometry_msgs/msg/Transform", self.vector(*position), rotation
        )
        return self.make(
            "geometry_msgs/msg/TransformStamped", header, child, both
        )

    def points(self, header: Any, points: Array) -> Any:
        """Return a cloud of points, in [m]. Shape (n, 3)."""
        rows = np.ascontiguousarray(points, dtype="<f4")
        field = self._types["sensor_msgs/msg/PointField"]
        return self.make(
            "sensor_msgs/msg/PointCloud2",
            header,
            1,
            len(rows),
            [
                field(name, 4 * i, field.FLOAT32, 1)
                for i, name in enumerate("xyz")
            ],
            False,
            12,
            12 * len(rows),
            np.frombuffer(rows.tobytes(), dtype=np.uint8),
            True,
        )

    def joint_state(
        self,
        header: Any,
        names: Sequence[str],
        position: Array,
        velocity: Array | None,
        effort: Array | None,
    ) -> Any:
        """Return joint positions, with velocities and efforts if known."""
        none = np.zeros(0)
        return self.make(
            "sensor_msgs/msg/JointState",
            header,
            list(names),
            np.asarray(position, dtype=np.float64),
            none if velocity is None else velocity,
            none if effort is None else effort,
        )

    def imu(self, header: Any, gyro: Array, accelerometer: Array) -> Any:
        """Return gyro and accelerometer; the orientation is marked absent."""
        return self.make(
            "sensor_msgs/msg/Imu",
            header,
            self.rotation((1.0, 0.0, 0.0, 0.0)),
            NO_ORIENTATION,
            self.vector(*gyro.tolist()),
            UNKNOWN,
            self.vector(*accelerometer.tolist()),
            UNKNOWN,
        )

    def wrench(self, header: Any, force: float, torque: Array) -> Any:
        """Return the upward force and torque (x, y) on a sole."""
        both = self.make(
            "geometry_msgs/msg/Wrench",
            self.vector(z=force),
            self.vector(*torque.tolist()),
        )
        return self.make("geometry_msgs/msg/WrenchStamped", header, both)

    def number(self, value: float) -> Any:
        """Return a plain number."""
        return self.make("std_msgs/msg/Float64", value)

    def text(self, value: str) -> Any:
        """Return a plain text."""
        return self.make("std_msgs/msg/String", value)

    def jpeg(self, header: Any, pixels: NDArray[np.uint8]) -> Any:
        """Return a colour image as JPEG."""
        import cv2

        quality = [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY]
        _, data = cv2.imencode(".jpg", pixels[:, :, ::-1], quality)
        return self.make(
            "sensor_msgs/msg/CompressedImage", header, "jpeg", data.ravel()
        )

    def depth_image(self, header: Any, depths: NDArray[np.float32]) -> Any:
        """Return a depth image in [m]; NaN where there was no return."""
        rows, columns = depths.shape
        values = np.where(depths > 0.0, depths, np.nan).astype("<f4")
        data = np.frombuffer(values.tobytes(), dtype=np.uint8)
        return self.make(
            "sensor_msgs/msg/Image",
            header,
            rows,
            columns,
            "32FC1",
            0,
            4 * columns,
            data,
        )

    def camera_info(self, header: Any, camera: CameraModel) -> Any:
        """Return the calibration of a camera without distortion."""
        matrix = camera.calibration_matrix
        return self.make(
            "sensor_msgs/msg/CameraInfo",
            header,
            camera.height,
            camera.width,
            "plumb_bob",
            np.zeros(5),
            matrix.ravel(),
            np.eye(3).ravel(),
            np.column_stack([matrix, np.zeros(3)]).ravel(),
            0,
            0,
            self.make("sensor_msgs/msg/RegionOfInterest", 0, 0, 0, 0, False),
        )


def nanoseconds(time: float) -> int:
    """Return a time in [s] as whole nanoseconds."""
    return round(time * 1e9)
