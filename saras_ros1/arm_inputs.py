"""What teleoperation nodes read of one arm."""

from __future__ import annotations

import numpy as np
from geometry_msgs.msg import PointStamped, PoseStamped, WrenchStamped

from saras.teleop import TwistEstimator, TwistEstimatorConfig
from saras_ros1 import convert
from saras_ros1.channel import base_frame
from saras_ros1.inputs import NANOSECONDS, Input
from saras_ros1.node import Node


class ArmInputs:
    """Tip pose, trocar and, where asked for, tip twist and exerted wrench of one arm, all in mesa_{side}/sbs_world.

    twist: parameters of the estimator that gives `twist_filtered`, over the interval between the stamps of two poses.
    """

    def __init__(
        self,
        node: Node,
        side: str,
        timeout_s: float,
        *,
        wrench: bool = False,
        twist: TwistEstimatorConfig | None = None,
    ) -> None:
        frame = base_frame(side)
        read_pose = convert.in_frame(frame, convert.pose)
        self.pose = node.input(f"/mesa_{side}/ee_pose", PoseStamped, read_pose, timeout_s=timeout_s)
        # Latched: it changes only when the trocar is set anew.
        self.rcm = node.input(f"/mesa_{side}/rcm", PointStamped, convert.in_frame(frame, convert.point))
        self.wrench: Input | None = None
        self.twist_filtered = np.zeros(6)
        self._estimator = None if twist is None else TwistEstimator(twist)
        self._stamp_ns = 0
        if wrench:
            read_wrench = convert.in_frame(frame, convert.wrench)
            self.wrench = node.input(f"/mesa_{side}/measured_cf", WrenchStamped, read_wrench, timeout_s=timeout_s)
        if twist is not None:
            self.pose.listeners.append(self._on_pose)

    @property
    def fresh(self) -> bool:
        """Whether the pose is young enough and the trocar known."""
        return self.pose.fresh and self.rcm.value is not None

    @property
    def exerted_wrench(self) -> np.ndarray:
        """(6,) on the tissue; NaN when unknown: an unknown force is not a zero force."""
        value = self.wrench.fresh_value if self.wrench is not None else None
        return np.full(6, np.nan) if value is None else value

    def _on_pose(self, source: Input) -> None:
        dt = (source.stamp_ns - self._stamp_ns) / NANOSECONDS
        self._stamp_ns = source.stamp_ns
        if not 0.0 < dt <= source.timeout_s:
            self._estimator.reset()  # first pose, or a gap: no twist over it
        self.twist_filtered = self._estimator.step(base_T_body=source.value, dt=max(dt, 1e-9)).twist_filtered
