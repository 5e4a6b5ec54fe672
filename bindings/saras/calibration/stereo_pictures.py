"""Pairs of grey pictures for the calibration of a stereo camera: from two folders, or from a bag."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from saras import ConfigError, Error
from saras.calibration import raw_images

Image = npt.NDArray[np.uint8]

PICTURES = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp")
#: Stamps of the two eyes that are further apart are not of one moment.
SKEW_S = 0.005


class Pairs(NamedTuple):
    """As many left as right pictures, (height, width) each, and a name for each pair."""

    left: list[Image]
    right: list[Image]
    names: list[str]


def from_folders(left: Path, right: Path) -> Pairs:
    """Paired by their sorted names. Raises ConfigError for what is no picture, OSError."""
    import cv2

    images, names = [], []
    for folder in (left, right):
        paths = sorted(path for path in folder.iterdir() if path.suffix.lower() in PICTURES)
        names.append([path.name for path in paths])
        images.append([cv2.imread(str(path), cv2.IMREAD_GRAYSCALE) for path in paths])
    broken = [name for side, all_names in zip(images, names) for name, image in zip(all_names, side) if image is None]
    if broken:
        raise ConfigError(f"{broken[0]}: cannot be read as a picture")
    return Pairs(images[0], images[1], names[0])


def from_bag(bag: Path, left_topic: str, right_topic: str, every_s: float = 0.5, skew_s: float = SKEW_S) -> Pairs:
    """Pairs of one moment, at most one every so many seconds, named by their time in the bag.

    Topics of sensor_msgs/Image or CompressedImage. Raises Error for a file that is no bag, a topic that is
    not in it, an encoding that is not known.
    """
    try:
        from rosbags.rosbag1 import Reader
        from rosbags.typesys import Stores, get_typestore
    except ImportError:
        raise Error("reading a bag needs the package rosbags: pip install 'saras[recording]'") from None
    store, newest, pairs = get_typestore(Stores.ROS1_NOETIC), {}, Pairs([], [], [])
    try:
        reader = Reader(bag)
        reader.open()
    except Exception as error:  # rosbags raises ReaderError, AssertionError, struct.error … on damaged files
        raise Error(f"{bag}: cannot be read as a bag: {error or type(error).__name__}") from error
    with contextlib.closing(reader):
        connections = [c for c in reader.connections if c.topic in (left_topic, right_topic)]
        for topic in (left_topic, right_topic):
            if topic not in {c.topic for c in connections}:
                raise Error(f"{bag}: topic {topic}: not in the bag")
        next_s = -np.inf
        for connection, _, raw in reader.messages(connections):
            message: Any = store.deserialize_ros1(raw, connection.msgtype)
            at_s = message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec
            newest[connection.topic] = (at_s, message)
            if len(newest) < 2 or at_s < next_s:
                continue
            (a_s, a), (b_s, b) = newest[left_topic], newest[right_topic]
            if abs(a_s - b_s) > skew_s:
                continue
            pairs.left.append(_grey(a))
            pairs.right.append(_grey(b))
            pairs.names.append(f"at {a_s - 1e-9 * reader.start_time:.2f} s")
            newest.clear()
            next_s = at_s + every_s
    return pairs


def _grey(message: Any) -> Image:
    import cv2

    if hasattr(message, "format"):  # CompressedImage
        picture = cv2.imdecode(np.asarray(message.data, np.uint8), cv2.IMREAD_GRAYSCALE)
        if picture is None:
            raise Error("a compressed picture cannot be decoded")
        return np.asarray(picture, np.uint8)
    return raw_images.grey(message)


__all__ = ["Pairs", "from_bag", "from_folders"]
