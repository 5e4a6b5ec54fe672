"""A law whose steps are published, so that a bag replays them exactly (saras.replay)."""

from __future__ import annotations

from typing import Any

import rospy
from std_msgs.msg import String

from saras.law_trace import TracedLaw
from saras_ros1.msg import LawTick


class PublishedLaw(TracedLaw):
    """TracedLaw with its publishers: /laws/<name> a step, /laws/<name>/info (latched JSON) when it changes."""

    def __init__(self, name: str, law_class: type, *args: Any) -> None:
        super().__init__(law_class, *args, name=name)
        self._ticks = rospy.Publisher(f"/laws/{name}", LawTick, queue_size=20)
        self._infos = rospy.Publisher(f"/laws/{name}/info", String, queue_size=5, latch=True)
        self._published_layouts = -1

    def step(self, *, dt: float, **inputs: Any) -> Any:
        """Steps the law and publishes the step."""
        output = super().step(dt=dt, **inputs)
        if len(self._layouts) != self._published_layouts:
            self._published_layouts = len(self._layouts)
            self._infos.publish(String(self.info))
        message = LawTick(**self.tick._asdict())
        message.header.stamp = rospy.Time.now()
        self._ticks.publish(message)
        return output
