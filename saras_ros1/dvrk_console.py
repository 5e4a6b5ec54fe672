"""The surgeon's console and pedals of a simulated da Vinci: topics as the dVRK has them, old and new prefix."""

from __future__ import annotations

from typing import Any

import rospy
from diagnostic_msgs.msg import KeyValue
from sensor_msgs.msg import Joy
from std_msgs.msg import Bool, Empty, Float64, Header

CONSOLE = ("camera", "clutch", "operator_present")
PEDALS = ("clutch", "camera", "cam_minus", "cam_plus", "bicoag", "coag")
# What switches all arms at once → their state command; below console/, in the newest dVRK below system/.
POWER = {"power_on": "enable", "power_off": "disable", "home": "home"}
BUTTON_STATES = (0, 1, 2)  # released, pressed, quick tap


class Console:
    """Latched events, and teleoperation's switches, which are remembered and echoed only: there are no master arms."""

    def __init__(self, node: Any, scale: float, old_names: bool) -> None:
        prefixes = ["/", *(["/dvrk/"] if old_names else [])]
        self._buttons = {
            name: [rospy.Publisher(prefix + name, Joy, queue_size=20, latch=True) for prefix in prefixes]
            for name in [*(f"console/{name}" for name in CONSOLE), *(f"footpedals/{name}" for name in PEDALS)]
        }
        self._enabled = [
            rospy.Publisher(p + "console/teleop/enabled", Bool, queue_size=20, latch=True) for p in prefixes
        ]
        self._scale = [
            rospy.Publisher(p + "console/teleop/scale", Float64, queue_size=20, latch=True) for p in prefixes
        ]
        self._selected = [
            rospy.Publisher(p + "console/teleop/selected", KeyValue, queue_size=20, latch=True) for p in prefixes
        ]
        for p in prefixes:
            rospy.Subscriber(p + "console/teleop/enable", Bool, lambda m: self._tell(self._enabled, Bool(m.data)))
            rospy.Subscriber(p + "console/teleop/set_scale", Float64, self._on_scale)
            for name in ("console/teleop/select_teleop", "teleop/select", "console/teleop/select"):
                rospy.Subscriber(p + name, KeyValue, lambda m: self._tell(self._selected, m))
            for name, command in POWER.items():
                for place in ("console/", "system/"):
                    rospy.Subscriber(p + place + name, Empty, lambda _, command=command: node.command_all(command))
        # Someone must be able to press the pedals: key clutch, value 0, 1 or 2.
        rospy.Subscriber(f"{node.name}/press", KeyValue, self._on_press)
        for name in self._buttons:
            self.press(name, 0)
        self._tell(self._enabled, Bool(False))
        self._tell(self._scale, Float64(scale))

    def press(self, name: str, state: int) -> None:
        """A button of the console or a pedal, named as its topic; state 0, 1 or 2."""
        joy = Joy(header=Header(stamp=rospy.Time.now()), buttons=[state])
        for publisher in self._buttons[name]:
            publisher.publish(joy)

    def _on_press(self, message: KeyValue) -> None:
        names = [name for name in self._buttons if name.split("/")[1] == message.key]
        if not names or message.value not in map(str, BUTTON_STATES):
            known = ", ".join(sorted({name.split("/")[1] for name in self._buttons}))
            rospy.logerr(f"press '{message.key}' '{message.value}' refused: key one of {known}, value 0, 1 or 2")
            return
        for name in names:
            self.press(name, int(message.value))

    def _on_scale(self, message: Float64) -> None:
        if not 0.0 < message.data <= 1.0:
            rospy.logerr(f"set_scale = {message.data:g} refused: must be in (0, 1]")
            return
        self._tell(self._scale, message)

    @staticmethod
    def _tell(publishers: list[rospy.Publisher], message: Any) -> None:
        for publisher in publishers:
            publisher.publish(message)
