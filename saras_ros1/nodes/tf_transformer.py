"""tf_transformer, one a side: handle pose from the console's frame to the arm's base, wrench back to the hand."""

from __future__ import annotations

from functools import partial

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped
from sensor_msgs.msg import Joy

from saras import ConfigError
from saras.teleop import FrameMapping, FrameMappingConfig, Mapping
from saras_ros1 import convert
from saras_ros1.channel import SIDES, base_frame
from saras_ros1.node import Node, Tick, run
from saras_ros1.static_frames import StaticFrames

CLUTCH = 0  # index in Joy.buttons


class TfTransformer(Node):
    """Steps on the handle pose; the wrench goes back as soon as it comes, not one period later with the next pose."""

    def __init__(self) -> None:
        super().__init__("tf_transformer")
        self.side = side = self.params.text("side", SIDES)
        period_s = self.params.number("period_s", 0.001, 0.1)
        self.frames_wait_s = self.params.number("frames_wait_s", 0.1, 600.0)
        pose_timeout_s = self.params.number("pose_timeout_s", 0.005, 1.0)
        wrench_timeout_s = self.params.number("wrench_timeout_s", 0.005, 1.0)
        # The frames come through tf2, from the one node that publishes the calibration.
        config = self.params.build(FrameMappingConfig, "law", base_T_console=np.eye(4), touch_T_console=np.eye(4))
        self.params.finish()
        if config.mapping != Mapping.STATIC:
            raise ConfigError("law/mapping = endoscope: must be static until a node publishes the camera's frames")

        self.base = base_frame(side)
        console, touch = f"touchball_{side}/simball_base", f"touchball_{side}/touch_base"
        self.touch = touch
        pose = convert.in_frame(console, convert.pose)
        self.handle = self.input(f"/touchball_{side}/pose", PoseStamped, pose, timeout_s=pose_timeout_s)
        self.buttons = self.input(f"/touchball_{side}/buttons", Joy, timeout_s=pose_timeout_s)
        wrench = convert.in_frame(self.base, convert.wrench)
        self.wrench = self.input(f"/tank_master/{side}/wrench", WrenchStamped, wrench, timeout_s=wrench_timeout_s)
        ours = partial(self.output, message_class=TwistStamped)
        self.tracked_pose = self.output(f"/tf_transformer_{side}/tracked_pose", PoseStamped)
        self.tracked_twist = ours(f"/tf_transformer_{side}/tracked_twist")
        self.tracked_twist_filtered = ours(f"/tf_transformer_{side}/tracked_twist_filtered")
        self.handle_twist = ours(f"/tf_transformer_{side}/handle_twist")
        self.touch_wrench = self.output(f"/touchball_{side}/wrench", WrenchStamped)

        config.base_T_console, config.touch_T_console = self._wait_for_frames(console, touch)
        self.touch_R_base = config.touch_T_console[:3, :3] @ config.base_T_console[:3, :3].T
        self.mapping = self.law(f"frame_mapping_{side}", FrameMapping, config)
        self.status = None
        self.loop(self.step, [self.handle], period_s=period_s)
        self.wrench.listeners.append(self.on_wrench)

    def _wait_for_frames(self, console: str, touch: str) -> tuple[np.ndarray, np.ndarray]:
        """base_T_console and touch_T_console. The time runs from the first handle pose: nothing is late before it."""
        self.state = "WAITING"
        wanted = ((self.base, console), (touch, console))
        frames = StaticFrames()

        def missing() -> list[str]:
            return [f"{target} ← {source}" for target, source in wanted if not frames.known(target, source)]

        while missing() and self.handle.received == 0 and not rospy.is_shutdown():
            rospy.loginfo_throttle(5.0, f"waits for a handle pose and for the transforms {', '.join(missing())}")
            rospy.rostime.wallsleep(0.05)
        self.wait_for(
            lambda: not missing(),
            self.frames_wait_s,
            lambda: f"no static transform {', '.join(missing())} on /tf_static: does the node 'frames' run?",
        )
        return frames.lookup(*wanted[0]), frames.lookup(*wanted[1])

    def step(self, tick: Tick) -> None:
        """One handle pose. A silent handle gives nothing new: ages grow, and everybody downstream sees it."""
        if tick.stale:
            return
        buttons = self.buttons.fresh_value
        out = self.mapping.step(
            console_T_handle=self.handle.value,
            clutch=bool(buttons and buttons.buttons and buttons.buttons[CLUTCH]),
            dt=tick.dt,
        )
        self.status = out.status
        if not out.has_pose:
            return
        self.handle_twist.publish(convert.twist_msg(out.handle_twist, self.base, tick.stamp_ns))
        self.tracked_twist.publish(convert.twist_msg(out.tracked_twist, self.base, tick.stamp_ns))
        filtered = convert.twist_msg(out.tracked_twist_filtered, self.base, tick.stamp_ns)
        self.tracked_twist_filtered.publish(filtered)
        # Last: transparency steps on the pose and finds the twists of the same tick.
        self.tracked_pose.publish(convert.pose_msg(out.tracked_pose, self.base, tick.stamp_ns))

    def on_wrench(self, source) -> None:
        """Rotated only: a wrench refers to the handle in both frames (SPEC, Signs)."""
        touch_wrench = np.concatenate((self.touch_R_base @ source.value[:3], self.touch_R_base @ source.value[3:]))
        self.touch_wrench.publish(convert.wrench_msg(touch_wrench, self.touch, source.stamp_ns))

    def report(self) -> dict:
        """Law status for /diagnostics."""
        return {"status": getattr(self.status, "name", "WAITING")}


def main() -> int:
    """Runs the node."""
    return run(TfTransformer)
