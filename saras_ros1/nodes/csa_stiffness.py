"""csa_stiffness: the modeler's estimate under the slave's tip, for the slave's gain: /csa/slave/stiffness.

Takes /csa/slave/measured_cp and /csa/modeler/stiffness, touched and state. Where the map is not known all around the
tip, old, or not well by the modeler's word, it says so (NaN): the slave then takes the largest stiffness of its file.
"""

from __future__ import annotations

import os

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import PointCloud2

from saras_ros1 import convert
from saras_ros1.csa_node import CsaNode
from saras_ros1.modeler_messages import read_cloud
from saras_ros1.msg import CsaModelerState, CsaStiffness
from saras_ros1.node import run
from saras_ros1.stiffness_under_tip import UNKNOWN, StiffnessUnderTip

NAMES = ("x", "y", "z", "stiffness", "std")


class CsaStiffnessNode(CsaNode):
    """A timer; the clouds are read as they come."""

    def __init__(self) -> None:
        os.nice(5)  # late is only slower: the slave's gain is then the one for what is not known
        super().__init__("csa_stiffness")
        p = self.params
        rate_hz, stale_s = p.number("rate_hz", 5.0, 200.0), p.number("stale_s", 0.1, 10.0)
        self.under = StiffnessUnderTip(p.number("reach_m", 1e-4, 0.05), p.number("depth_m", 1e-3, 0.1))
        self.status = "WAITING"
        phantom = self.setup.phantom()
        if phantom and phantom.get("stiffness_known", True) and rospy.get_param("/saras/simulated", True):
            rospy.loginfo(f"{self.name}: {self.setup.path} lets the phantom tell its stiffness: nothing to do")
            self.status = "the phantom tells"
            return
        pose = convert.in_frame(self.frame, convert.pose)
        self.tip = self.input("/csa/slave/measured_cp", PoseStamped, pose, timeout_s=self.setup.timeout_s)
        self.whole = self.input("/csa/modeler/stiffness", PointCloud2, self._read, timeout_s=stale_s)
        self.touched = self.input("/csa/modeler/touched", PointCloud2, self._read, timeout_s=stale_s)
        self.state_of_map = self.input("/csa/modeler/state", CsaModelerState, timeout_s=stale_s)
        self.whole.listeners.append(lambda source: self.under.take_map(*self._columns(source.value)))
        self.touched.listeners.append(self._on_touched)
        self.out = self.output("/csa/slave/stiffness", CsaStiffness)
        self.every(1.0 / rate_hz, self._tell)

    def _read(self, message: PointCloud2) -> np.ndarray:
        """Rows. Raises ValueError for another frame, or for no map."""
        if message.header.frame_id.lstrip("/") != self.frame:
            raise ValueError(f"frame_id '{message.header.frame_id}', must be '{self.frame}'")
        rows = read_cloud(message)
        if not set(NAMES) <= set(rows.dtype.names or ()):
            raise ValueError(f"fields {rows.dtype.names}: must have {', '.join(NAMES)}")
        return rows

    @staticmethod
    def _columns(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return np.column_stack([rows[name] for name in "xyz"]), rows["stiffness"], rows["std"]

    def _on_touched(self, source) -> None:
        rows = source.value
        self.under.take_touched(rows["vertex"].astype(int), rows["stiffness"], rows["std"])

    def _unknown(self) -> str:
        """Why the map does not count now; empty: it does."""
        if not self.tip.fresh:
            return f"STALE: nothing from {self.tip.topic}"
        if not self.state_of_map.fresh:
            return f"STALE: nothing from {self.state_of_map.topic}"
        if not self.state_of_map.message.well:
            return f"the modeler says {self.state_of_map.message.status}"
        if not (self.whole.fresh or self.touched.fresh):
            return f"STALE: nothing from {self.whole.topic}"
        return ""

    def _tell(self) -> None:
        with self.lock:
            why = self._unknown()
            stiffness, std = UNKNOWN if why else self.under.at(self.tip.value[:3, 3])
            self.status = why or ("unknown" if np.isnan(stiffness) else f"{stiffness:.0f} +- {std:.0f} N/m")
            stamp_ns = self.tip.stamp_ns
        message = CsaStiffness(stiffness_N_m=stiffness, std_N_m=std)
        message.header.frame_id = self.frame
        message.header.stamp = rospy.Time(*divmod(stamp_ns, 1_000_000_000))
        self.out.publish(message)

    def report(self) -> dict:
        """What is told, or why nothing is known."""
        return {"stiffness": self.status}


def main() -> int:
    """Runs the node."""
    return run(CsaStiffnessNode)
