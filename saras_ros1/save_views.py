"""Pairs of the live endoscope as pictures, for `saras calibrate camera`.

rosrun saras_ros1 save_views --out views --count 20
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import rospy
from sensor_msgs.msg import Image

from saras import Error
from saras.calibration.stereo_pictures import SKEW_S
from saras_ros1.camera_images import grey
from saras_ros1.channel import SIDES

SILENT_S = 10.0


class Views:
    """The newest picture of each eye."""

    def __init__(self, topics: str) -> None:
        self.newest: dict[str, Image] = {}
        for side in SIDES:
            rospy.Subscriber(f"{topics}/{side}/image_raw", Image, self._on_image, side, queue_size=1, buff_size=1 << 24)

    def _on_image(self, message: Image, side: str) -> None:
        self.newest[side] = message

    def pair(self) -> dict[str, Image] | None:
        """Both eyes of one moment, or None."""
        newest = dict(self.newest)
        if len(newest) < 2:
            return None
        apart_s = abs((newest["left"].header.stamp - newest["right"].header.stamp).to_sec())
        return newest if apart_s <= SKEW_S else None


def save(pair: dict[str, Image], out: Path, number: int) -> None:
    """As OUT/left/NUMBER.png and OUT/right/NUMBER.png. Raises Error for encodings that are not known."""
    import cv2

    for side, image in pair.items():
        path = out / side / f"{number:03d}.png"
        path.parent.mkdir(parents=True, exist_ok=True)
        if not cv2.imwrite(str(path), grey(image)):
            raise Error(f"{path}: cannot be written")


def main() -> int:
    """Exit code: 0 all saved, 1 no pictures came, 2 refused."""
    parser = argparse.ArgumentParser(prog="rosrun saras_ros1 save_views", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("views"), help="folder (default %(default)s)")
    parser.add_argument("--count", type=int, default=20, help="pairs (default %(default)s)")
    parser.add_argument("--every-s", type=float, default=2.0, help="between two, to move the pattern (%(default)s)")
    parser.add_argument("--topics", default="/endoscope", help="what the image topics begin with (%(default)s)")
    arguments = parser.parse_args(rospy.myargv()[1:])
    if arguments.out.exists() and any(arguments.out.iterdir()):
        print(f"{arguments.out}: holds files already", file=sys.stderr)
        return 2
    rospy.init_node("save_views", anonymous=True)
    views, saved, heard_s = Views(arguments.topics), 0, time.monotonic()
    while saved < arguments.count and not rospy.is_shutdown():
        pair = views.pair()
        if pair is None:
            if time.monotonic() - heard_s > SILENT_S:
                print(f"no pair of pictures on {arguments.topics}/{{left,right}}/image_raw", file=sys.stderr)
                return 1
            rospy.rostime.wallsleep(0.02)
            continue
        views.newest.clear()
        try:
            save(pair, arguments.out, saved)
        except (Error, OSError) as error:
            print(error, file=sys.stderr)
            return 2
        saved, heard_s = saved + 1, time.monotonic()
        print(f"{saved} of {arguments.count}; move the pattern")
        rospy.rostime.wallsleep(arguments.every_s if saved < arguments.count else 0.0)
    left, right = (arguments.out / side for side in SIDES)
    print(f"saras calibrate camera {left} {right} --columns 9 --rows 6 --square-m 0.007 --out camera")
    return 0
