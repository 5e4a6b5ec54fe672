"""Static transforms through tf2, without a subscription to the busy /tf."""

from __future__ import annotations

import numpy as np
import rospy
import tf2_ros
from tf2_msgs.msg import TFMessage

from saras_ros1 import convert


class StaticFrames:
    """Looks up chains of /tf_static. tf2 accepts Inf and non-unit quaternions: the result is checked here."""

    def __init__(self) -> None:
        self._buffer = tf2_ros.Buffer(debug=False)
        self.changes = 0  #: number of messages with static transforms so far
        rospy.Subscriber("/tf_static", TFMessage, self._on_transforms, queue_size=20, tcp_nodelay=True)

    def _on_transforms(self, message: TFMessage) -> None:
        for transform in message.transforms:
            try:
                convert.transform(transform)
            except ValueError as error:
                rospy.logerr(f"/tf_static: {transform.header.frame_id} → {transform.child_frame_id} refused: {error}")
            else:
                self._buffer.set_transform_static(transform, "tf_static")
        self.changes += 1

    def known(self, target: str, source: str) -> bool:
        """Whether target_T_source can be computed now."""
        return bool(self._buffer.can_transform(target, source, rospy.Time(0)))

    def lookup(self, target: str, source: str) -> np.ndarray:
        """(4, 4) target_T_source; raises tf2_ros.TransformException."""
        return convert.transform(self._buffer.lookup_transform(target, source, rospy.Time(0)))
