"""Test LoLA's wire format: fixed vectors and invalid frames."""

from typing import Any

import msgpack
import numpy as np
import pytest

from lola_fakes import sensor_frame
from stepaside.drivers.lola.lola_frames import (
    ActuatorFrame,
    pack_actuators,
    pack_sensors,
    unpack_sensors,
)
from stepaside.drivers.lola.lola_server import ActuatorFrameReader
from stepaside.drivers.lola.wire import (
    SENSOR_BYTES,
    WireError,
)

HALF = b"\xca\x3f\x00\x00\x00"  # 0.5 in single precision
ZERO = b"\xca\x00\x00\x00\x00"
MANY = b"\xdc\x00\x19"  # head of an array of 25
TEXTS = b"\xb4" + b"P" * 20 + b"\xa56.0.0"

# Written by hand from the specification of MessagePack.
SENSOR_VECTOR = (
    b"\x8d"
    + (b"\xa8Position" + MANY + HALF + 24 * ZERO)
    + (b"\xa9Stiffness" + MANY + 25 * ZERO)
    + (b"\xa7Current" + MANY + 25 * ZERO)
    + (b"\xabTemperature" + MANY + 24 * ZERO + HALF)
    + (b"\xa6Status" + MANY + b"\x03" + 24 * b"\x00")
    + (b"\xadAccelerometer" + b"\x93" + 2 * ZERO + b"\xca\xc1\x1c\xf5\xc3")
    + (b"\xa9Gyroscope" + b"\x93" + 3 * HALF)
    + (b"\xa6Angles" + b"\x92" + HALF + ZERO)
    + (b"\xa3FSR" + b"\x98" + HALF + 7 * ZERO)
    + (b"\xa5Sonar" + b"\x92" + ZERO + HALF)
    + (b"\xa5Touch" + b"\x9e" + 13 * ZERO + HALF)
    + (b"\xa7Battery" + b"\x94" + HALF + 3 * ZERO)
    + (b"\xabRobotConfig" + b"\x94" + 2 * TEXTS)
)
ACTUATOR_VECTOR = (
    b"\x8b"
    + (b"\xa8Position" + MANY + HALF + 24 * ZERO)
    + (b"\xa9Stiffness" + MANY + 24 * ZERO + HALF)
    + (b"\xa5Chest" + b"\x93" + 3 * HALF)
    + (b"\xa4LEar" + b"\x9a" + 10 * ZERO)
    + (b"\xa4REar" + b"\x9a" + 10 * ZERO)
    + (b"\xa4LEye" + b"\xdc\x00\x18" + 24 * ZERO)
    + (b"\xa4REye" + b"\xdc\x00\x18" + 24 * ZERO)
    + (b"\xa5LFoot" + b"\x93" + 3 * ZERO)
    + (b"\xa5RFoot" + b"\x93" + 3 * ZERO)
    + (b"\xa5Skull" + b"\x9c" + 12 * ZERO)
    + (b"\xa5Sonar" + b"\x92\xc3\xc2")
)


def one(first: float, count: int = 25, *, at: int = 0) -> np.ndarray:
    values = np.zeros(count)
    values[at] = first
    return values


VECTOR_FRAME = sensor_frame(
    position=one(0.5),
    stiffness=np.zeros(25),
    temperature=one(0.5, at=-1),
    status=(3,) + (0,) * 24,
    accelerometer=np.array([0.0, 0.0, -9.81]),
    gyroscope=np.full(3, 0.5),
    angles=(0.5, 0.0),
    fsr=one(0.5, 8),
    sonar=(0.0, 0.5),
    touch=(0.0,) * 13 + (0.5,),
    battery=(0.5, 0.0, 0.0, 0.0),
    robot_config=("P" * 20, "6.0.0", "P" * 20, "6.0.0"),
)
VECTOR_ANSWER = ActuatorFrame(
    one(0.5),
    one(0.5, at=-1),
    {
        "Chest": (0.5,) * 3,
        "LEar": (0.0,) * 10,
        "REar": (0.0,) * 10,
        "LEye": (0.0,) * 24,
        "REye": (0.0,) * 24,
        "LFoot": (0.0,) * 3,
        "RFoot": (0.0,) * 3,
        "Skull": (0.0,) * 12,
    },
    (True, False),
)


def test_a_sensor_frame_is_these_896_bytes() -> None:
    assert len(SENSOR_VECTOR) == SENSOR_BYTES == 896
    assert pack_sensors(VECTOR_FRAME) == SENSOR_VECTOR


def test_an_actuator_frame_is_these_786_bytes() -> None:
    assert len(ACTUATOR_VECTOR) == 786
    assert pack_actuators(VECTOR_ANSWER) == ACTUATOR_VECTOR


def test_reading_returns_what_was_written() -> None:
    for got, sent in zip(
        unpack_sensors(SENSOR_VECTOR), VECTOR_FRAME, strict=True
    ):
        if isinstance(got, np.ndarray):
            np.testing.assert_array_equal(got, np.float32(sent))  # type: ignore[arg-type]
        else:
            assert got == sent
    answer = read(ACTUATOR_VECTOR)
    np.testing.assert_array_equal(answer.position, VECTOR_ANSWER.position)
    np.testing.assert_array_equal(answer.stiffness, VECTOR_ANSWER.stiffness)
    assert answer[2:] == VECTOR_ANSWER[2:]


def read(data: bytes) -> ActuatorFrame:
    (frame,) = ActuatorFrameReader().feed(data)
    return frame


def repacked(data: bytes, **changes: Any) -> bytes:
    """The map of a frame, changed, as other programs might write it."""
    values = msgpack.unpackb(data) | changes
    for key in [k for k, v in changes.items() if v is None]:
        del values[key]
    packed: bytes = msgpack.packb(values, use_single_float=True)
    return packed


def test_garbage_in_lights_is_cut_but_garbage_in_targets_is_refused() -> None:
    nan = float("nan")
    wild = repacked(
        ACTUATOR_VECTOR, Chest=[nan, -1e30, 7.0], Stiffness=[2] * 25
    )
    answer = read(wild)
    assert answer.lights["Chest"] == (0.0, 0.0, 1.0)
    assert answer.stiffness is not None and answer.stiffness.max() == 1.0
    for key in ("Position", "Stiffness"):
        with pytest.raises(WireError, match=f"{key} must be finite"):
            read(repacked(ACTUATOR_VECTOR, **{key: [nan] * 25}))


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"Position": [0.0] * 24}, "Position must have 25 values, got 24"),
        ({"Position": [True] * 25}, "Position must hold numbers, got bool"),
        ({"Position": 1.0}, "Position must be an array of 25, got float"),
        ({"Stiffness": {"a": 1}}, "Stiffness must be an array .* got map"),
        ({"Sonar": [1.0, 0.0]}, "Sonar must hold bool values, got float"),
        ({"Torque": [1.0]}, "unknown key 'Torque'"),
        ({"Chest": ["red"] * 3}, "Chest must hold numbers, got str"),
        ({"Position": [1e39] + [0] * 24}, "cannot decode|finite"),
    ],
)
def test_an_answer_with_a_fault_is_refused_by_name(
    changes: dict[str, Any], said: str
) -> None:
    values = msgpack.unpackb(ACTUATOR_VECTOR) | changes
    with pytest.raises(WireError, match=said):
        read(msgpack.packb(values))


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"FSR": None}, "must have 896 bytes"),
        ({"Status": [0.0] * 25}, "must have 896 bytes"),
        ({"Angles": [0.0] * 3}, "must have 896 bytes"),
    ],
)
def test_a_sensor_frame_of_another_length_is_refused(
    changes: dict[str, Any], said: str
) -> None:
    with pytest.raises(WireError, match=said):
        unpack_sensors(repacked(SENSOR_VECTOR, **changes))


def test_faults_that_keep_the_length_are_refused_too() -> None:
    twice = SENSOR_VECTOR.replace(b"\xa5Touch", b"\xa5Sonar")
    with pytest.raises(WireError, match="key Sonar must occur once"):
        unpack_sensors(twice)
    spoilt = SENSOR_VECTOR.replace(b"\xa3FSR", b"\xa3FRS")
    with pytest.raises(WireError, match="unknown key 'FRS'"):
        unpack_sensors(spoilt)
    endless = SENSOR_VECTOR.replace(HALF, b"\xca\x7f\x80\x00\x00", 1)
    with pytest.raises(WireError, match="Position must be finite, got inf"):
        unpack_sensors(endless)


def test_no_truncated_frame_is_read() -> None:
    for length in range(SENSOR_BYTES):
        with pytest.raises(WireError):
            unpack_sensors(SENSOR_VECTOR[:length])
    for length in range(len(ACTUATOR_VECTOR)):
        assert not ActuatorFrameReader().feed(ACTUATOR_VECTOR[:length])


def test_answers_are_cut_out_of_a_stream_wherever_it_is_cut() -> None:
    stream = 3 * ACTUATOR_VECTOR
    for at in range(0, len(stream), 97):
        reader = ActuatorFrameReader()
        frames = reader.feed(stream[:at]) + reader.feed(stream[at:])
        assert [f.sonar for f in frames] == 3 * [(True, False)]
