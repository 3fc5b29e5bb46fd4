"""ROS 2 messages of a recording, by the library rosbags."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.poses import Array
from ...perception.camera_model import CameraModel

UNKNOWN = np.full(9, 0.0)
NO_ORIENTATION = np.array([-1.0] + [0.0] * 8)  # as sensor_msgs/Imu says it
JPEG_QUALITY = 90


class MessageFactory:
    """Messages of ROS 2's standard types; quaternions are (w, x, y, z).

    Attributes:
        store: Type store of rosbags, with the definitions of ROS 2 Humble;
            those of its successors are the same for the types used here.
    """

    def __init__(self) -> None:
        """Load the definitions."""
        from rosbags.typesys import Stores, get_typestore

        self.store: Any = get_typestore(Stores.ROS2_HUMBLE)

    def make(self, kind: str, *values: Any) -> Any:
        """Return a message of a type like ``geometry_msgs/Point``."""
        package, _, name = kind.partition("/")
        return self.store.types[f"{package}/msg/{name}"](*values)

    def header(self, time: float, frame: str) -> Any:
        """Return a header."""
        stamp = nanoseconds(time)
        at = self.make(
            "builtin_interfaces/Time", stamp // 10**9, stamp % 10**9
        )
        return self.make("std_msgs/Header", at, frame)

    def vector(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Any:
        """Return a vector."""
        return self.make("geometry_msgs/Vector3", x, y, z)

    def rotation(self, wxyz: Sequence[float]) -> Any:
        """Return a quaternion."""
        w, x, y, z = wxyz
        return self.make("geometry_msgs/Quaternion", x, y, z, w)

    def pose(
        self,
        header: Any,
        position: Sequence[float],
        wxyz: Sequence[float] = (1.0, 0.0, 0.0, 0.0),
    ) -> Any:
        """Return a pose; without z it is on the floor."""
        x, y, *z = position
        point = self.make("geometry_msgs/Point", x, y, *(z or (0.0,)))
        pose = self.make("geometry_msgs/Pose", point, self.rotation(wxyz))
        return self.make("geometry_msgs/PoseStamped", header, pose)

    def transform(
        self, header: Any, child: str, position: Array, wxyz: Array
    ) -> Any:
        """Return the transform of a child frame in that of the header."""
        both = self.make(
            "geometry_msgs/Transform",
            self.vector(*position.tolist()),
            self.rotation(wxyz.tolist()),
        )
        return self.make("geometry_msgs/TransformStamped", header, child, both)

    def points(self, header: Any, points: Array) -> Any:
        """Return a cloud of points, in [m]. Shape (n, 3)."""
        rows = np.ascontiguousarray(points, dtype="<f4")
        field = self.store.types["sensor_msgs/msg/PointField"]
        return self.make(
            "sensor_msgs/PointCloud2",
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
        self, header: Any, names: Sequence[str], *values: Array | None
    ) -> Any:
        """Return joint positions, velocities and efforts, if known."""
        none = np.zeros(0)
        return self.make(
            "sensor_msgs/JointState",
            header,
            list(names),
            *(none if v is None else v.astype(np.float64) for v in values),
        )

    def imu(self, header: Any, gyro: Array, accelerometer: Array) -> Any:
        """Return gyro and accelerometer; the orientation is marked absent."""
        return self.make(
            "sensor_msgs/Imu",
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
            "geometry_msgs/Wrench",
            self.vector(z=force),
            self.vector(*torque.tolist()),
        )
        return self.make("geometry_msgs/WrenchStamped", header, both)

    def number(self, value: float) -> Any:
        """Return a plain number."""
        return self.make("std_msgs/Float64", float(value))

    def text(self, value: str) -> Any:
        """Return a plain text."""
        return self.make("std_msgs/String", value)

    def jpeg(self, header: Any, pixels: NDArray[np.uint8]) -> Any:
        """Return a colour image as JPEG."""
        import cv2

        quality = [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY]
        _, data = cv2.imencode(".jpg", pixels[:, :, ::-1], quality)
        return self.make(
            "sensor_msgs/CompressedImage", header, "jpeg", data.ravel()
        )

    def depth_image(self, header: Any, depths: NDArray[np.float32]) -> Any:
        """Return a depth image in [m]; NaN where there was no return."""
        rows, columns = depths.shape
        values = np.where(depths > 0.0, depths, np.nan).astype("<f4")
        data = np.frombuffer(values.tobytes(), dtype=np.uint8)
        shape = rows, columns, "32FC1", 0, 4 * columns
        return self.make("sensor_msgs/Image", header, *shape, data)

    def camera_info(self, header: Any, camera: CameraModel) -> Any:
        """Return the calibration of a camera without distortion."""
        matrix = camera.calibration_matrix
        return self.make(
            "sensor_msgs/CameraInfo",
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
            self.make("sensor_msgs/RegionOfInterest", 0, 0, 0, 0, False),
        )


def nanoseconds(time: float) -> int:
    """Return a time in [s] as whole nanoseconds."""
    return round(time * 1e9)
