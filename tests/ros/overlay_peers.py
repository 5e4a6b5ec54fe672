"""A stereo endoscope, distances and transforms for the overlay's test: all is published until told otherwise."""

from __future__ import annotations

import contextlib
import threading
import time

import numpy as np
import rospy
from geometry_msgs.msg import Point, Vector3
from saras_ros1.msg import CollisionState, ToolCollision
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import Float64MultiArray, MultiArrayDimension
from tf2_msgs.msg import TFMessage

from saras_ros1 import convert

WIDTH, HEIGHT = 320, 240
FRAME = "endoscope_left_optical"
EYES = ("left", "right")
TOOLS = ("mesa_left", "mesa_right", "PSM1", "PSM2")
CHANNELS = {"bgr8": 3, "rgb8": 3, "mono8": 1, "bgra8": 4, "rgba8": 4, "bayer_rggb8": 1, "mono16": 2}
#: Tip and trocar of each tool in the camera's frame: shafts across the image, one below the other.
ROWS = (0.012, 0.022, -0.014, -0.004)
FOCAL = 280.0
WORLD_T_CAMERA = np.array([[0.0, -1.0, 0.0, 0.2], [-1.0, 0.0, 0.0, 0.1], [0.0, 0.0, -1.0, 0.3], [0.0, 0.0, 0.0, 1.0]])


def in_world(point: tuple[float, float, float]) -> Point:
    return Point(*(WORLD_T_CAMERA @ [*point, 1.0])[:3].tolist())


class Peers:
    """Attributes are read at each round; images at 20 Hz, /collision at 50 Hz, tf at 20 Hz."""

    def __init__(self) -> None:
        self.reset()
        self._noise = np.random.default_rng(1)
        self._last: dict[str, bytes] = {}
        base = "/endoscope"
        self._images = {eye: rospy.Publisher(f"{base}/{eye}/image_raw", Image, queue_size=2) for eye in EYES}
        self._infos = {eye: rospy.Publisher(f"{base}/{eye}/camera_info", CameraInfo, queue_size=2) for eye in EYES}
        self._state = rospy.Publisher("/collision/state", CollisionState, queue_size=5)
        self._distances = rospy.Publisher("/collision/distances", Float64MultiArray, queue_size=5)
        self._tf = rospy.Publisher("/tf", TFMessage, queue_size=5)
        for period_s, work in ((0.05, self._send_images), (0.02, self._send_collision), (0.05, self._send_tf)):
            threading.Thread(target=self._run, args=(period_s, work), daemon=True).start()

    def reset(self) -> None:
        """All is well."""
        self.states = dict.fromkeys(TOOLS, ToolCollision.CLEAR)
        self.metres = dict.fromkeys(TOOLS, 0.05)
        self.size, self.info_size, self.encoding = (WIDTH, HEIGHT), (WIDTH, HEIGHT), "bgr8"
        self.frozen = {"left": False, "right": False}
        self.silent = {"left": False, "right": False}
        self.delay_s = {"left": 0.0, "right": 0.0}  # of the stamps: pictures of another time
        self.sends_state = self.sends_distances = self.sends_tf = self.sends_info = True

    def _run(self, period_s: float, work) -> None:
        while not rospy.is_shutdown():
            with contextlib.suppress(rospy.ROSException):  # topics close before this thread ends
                work(rospy.Time.now())
            time.sleep(period_s)

    def _send_images(self, now: rospy.Time) -> None:
        for eye in EYES:
            stamp = now - rospy.Duration(self.delay_s[eye])
            if self.sends_info:
                self._infos[eye].publish(self.info(eye, stamp))
            if not self.silent[eye]:
                self._images[eye].publish(self.image(eye, stamp))

    def image(self, eye: str, stamp: rospy.Time) -> Image:
        """Dark noise that changes with each picture, unless it is frozen."""
        width, height = self.size
        step = width * CHANNELS[self.encoding]
        if not self.frozen[eye] or len(self._last.get(eye, b"")) != step * height:
            self._last[eye] = self._noise.integers(20, 30, step * height, dtype=np.uint8).tobytes()
        message = Image(height=height, width=width, encoding=self.encoding, step=step, data=self._last[eye])
        message.header.stamp, message.header.frame_id = stamp, FRAME
        return message

    def info(self, eye: str, stamp: rospy.Time) -> CameraInfo:
        width, height = self.info_size
        message = CameraInfo(width=width, height=height, distortion_model="plumb_bob")
        message.header.stamp, message.header.frame_id = stamp, FRAME
        k = [FOCAL, 0.0, WIDTH / 2, 0.0, FOCAL, HEIGHT / 2, 0.0, 0.0, 1.0]
        message.D, message.K, message.R = [-0.1, 0.02, 0.0, 0.0, 0.0], k, np.eye(3).ravel().tolist()
        shift = 0.0 if eye == "left" else -FOCAL * 0.005
        message.P = [*k[:3], shift, *k[3:6], 0.0, *k[6:], 0.0]
        return message

    def _send_collision(self, now: rospy.Time) -> None:
        if self.sends_distances:
            message = Float64MultiArray(data=[self.metres[name] for name in TOOLS])
            message.layout.dim = [MultiArrayDimension(",".join(TOOLS), 4, 4)]
            self._distances.publish(message)
        if not self.sends_state:
            return
        state = CollisionState()
        state.header.stamp, state.header.frame_id = now, "world"
        for name, y in zip(TOOLS, ROWS):
            tip, trocar = in_world((-0.03, y, 0.1)), in_world((0.1, y, 0.1))
            nan, metres = Point(*3 * [float("nan")]), self.metres[name]
            normal = Vector3(*3 * [float("nan")])
            state.tools.append(
                ToolCollision(
                    name, self.states[name], "", metres, "", metres, nan, nan, normal, tip, trocar, 0.0025, 1.0, 1.0
                )
            )
        self._state.publish(state)

    def _send_tf(self, now: rospy.Time) -> None:
        if self.sends_tf:
            self._tf.publish(TFMessage([convert.transform_msg(WORLD_T_CAMERA, "world", FRAME, now)]))
