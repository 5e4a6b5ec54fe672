"""A scripted surgeon for tests and demo: moves the simulated hand and presses pedals."""

from __future__ import annotations

import threading
import time
from typing import Any, Callable

import numpy as np
import rospy
from geometry_msgs.msg import PointStamped
from sensor_msgs.msg import Joy
from std_srvs.srv import SetBool

from saras.csa.setup import Setup

RATE_HZ = 100.0


class Surgeon:
    """`intended` is where the hand wants the slave's tip, from the start [m]; sent at 100 Hz from a thread.

    Needs an initialised rospy node. Pedals as the system file has them.
    """

    def __init__(self, setup: Setup) -> None:
        self.setup = setup
        self._R, self._scale = setup.slave_R_master, setup.teleop_config().scale
        self._hand = rospy.Publisher(f"/{setup.master['name']}/hand/intended", PointStamped, queue_size=5)
        topics = setup.teleop.get("pedals", {})
        self._pedals = {name: rospy.Publisher(topic, Joy, queue_size=5, latch=True) for name, topic in topics.items()}
        self.intended = np.zeros(3)
        self._path: Callable[[float], np.ndarray] | None = None
        self._begun_s = 0.0
        self._stop = threading.Event()
        for name in self._pedals:
            self.press(name, 0)
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def press(self, pedal: str, state: int) -> None:
        """pick, clutch or present; 0 released, 1 pressed, 2 tapped."""
        joy = Joy(buttons=[state])
        joy.header.stamp = rospy.Time.now()
        self._pedals[pedal].publish(joy)

    def click(self, pedal: str) -> None:
        """Pressed and released."""
        self.press(pedal, 1)
        time.sleep(0.1)
        self.press(pedal, 0)
        time.sleep(0.1)

    def enable(self) -> None:
        """Puts the head into the console, and asks for teleoperation."""
        if "present" in self._pedals:
            self.press("present", 1)
        rospy.wait_for_service("/csa/teleop/enable", 30.0)
        rospy.ServiceProxy("/csa/teleop/enable", SetBool)(True)

    def follow(self, path: Callable[[float], np.ndarray], seconds: float) -> None:
        """Moves along path(time), from now; returns when it is over."""
        self._begun_s, self._path = time.monotonic(), path
        end = self._begun_s + seconds
        while time.monotonic() < end and not self._stop.is_set() and not rospy.is_shutdown():
            time.sleep(0.02)
        self.intended, self._path = np.array(path(seconds)), None

    def go(self, to: Any, seconds: float) -> None:
        """To a point (3,) smoothly."""
        start, end = self.intended.copy(), np.array(to, dtype=float)

        def path(t: float) -> np.ndarray:
            share = min(1.0, max(0.0, t / seconds))
            return start + (end - start) * (10 * share**3 - 15 * share**4 + 6 * share**5)

        self.follow(path, seconds)

    def stop(self) -> None:
        """Ends the thread."""
        self._stop.set()

    def _run(self) -> None:
        due_s = time.monotonic()
        while not self._stop.is_set() and not rospy.is_shutdown():
            path = self._path
            if path is not None:
                self.intended = np.array(path(time.monotonic() - self._begun_s))
            message = PointStamped()
            message.header.stamp = rospy.Time.now()
            hand = self._R.T @ self.intended / self._scale
            message.point.x, message.point.y, message.point.z = hand.tolist()
            self._hand.publish(message)
            due_s = max(due_s + 1.0 / RATE_HZ, time.monotonic())
            time.sleep(max(0.0, due_s - time.monotonic()))
