"""endoscope_frames: where a captured endoscope's eyes are, in tf: from the arm that carries it and its camera_info."""

from __future__ import annotations

import rospy
from sensor_msgs.msg import CameraInfo

from saras.calibration.camera_info import right_T_left
from saras_ros1.camera_images import eye_of
from saras_ros1.channel import SIDES
from saras_ros1.endoscope_frames import EndoscopeFrames
from saras_ros1.node import Node, run


class EndoscopeFramesNode(Node):
    """Poses of the arm go out with the time at which they came: tf then has the one of a late picture's own time.

    A picture that is newer than all of them gets the newest.
    """

    def __init__(self) -> None:
        super().__init__("endoscope_frames")
        topics = self.params.text("topics")
        rate_hz = self.params.number("rate_hz", 1.0, 200.0)
        self.frames = EndoscopeFrames(self, self.params.section("mount"))
        self.params.finish()
        self.sent = rospy.Time()
        self.pictures = 0
        self.infos: dict[str, CameraInfo] = {}
        self.placed: tuple | None = None
        for side in SIDES:
            topic = f"{topics}/{side}/camera_info"
            rospy.Subscriber(topic, CameraInfo, self._on_info, side, queue_size=5, tcp_nodelay=True)
        self.every(1.0 / rate_hz, self._follow)

    def _follow(self) -> None:
        age_s = self.frames.arm.age_s
        if age_s < float("inf"):
            self._publish(rospy.Time.now() - rospy.Duration(age_s))

    def _on_info(self, message: CameraInfo, side: str) -> None:
        self.infos[side] = message
        self.pictures += 1
        self._publish(message.header.stamp)
        self._place_right()

    def _publish(self, stamp: rospy.Time) -> None:
        with self.lock:
            # Not later than what tf has: it has that time already. A clock that was set back begins anew.
            if stamp > self.sent or self.sent > rospy.Time.now():
                self.sent = stamp
                self.frames.publish(stamp)

    def _place_right(self) -> None:
        """Once, and when a camera_info says something else than before."""
        with self.lock:
            if len(self.infos) < len(SIDES):
                return
            messages = [self.infos[side] for side in SIDES]
            place = tuple((message.R, message.P) for message in messages)
            eyes = [eye_of(message) for message in messages]
            if place != self.placed and eyes[0] is not None and eyes[1] is not None:
                self.placed = place
                self.frames.place_right(right_T_left(eyes[0], eyes[1]))

    def report(self) -> dict:
        """Pictures heard of, whether the right eye has its place, and the arm."""
        why = self.frames.arm.unknown_reason
        self.state = f"RUNNING: {why}" if why else "RUNNING"
        return {"pictures": self.pictures, "right_eye_placed": self.placed is not None, **self.frames.arm.report()}


def main() -> int:
    """Runs the node."""
    return run(EndoscopeFramesNode)
