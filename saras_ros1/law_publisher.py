"""A law whose steps are published, so that a bag replays them exactly (saras.replay)."""

from __future__ import annotations

import time
from typing import Any

import rospy
from std_msgs.msg import String

from saras.law_trace import TickBatch, TracedLaw
from saras_ros1.msg import LawTicks

STEPS_PER_MESSAGE = 25


class PublishedLaw(TracedLaw):
    """TracedLaw with its publishers: /laws/<name>, /laws/<name>/info (latched JSON) when it changes."""

    def __init__(self, name: str, law_class: type, *args: Any) -> None:
        super().__init__(law_class, *args, name=name)
        self._batch = TickBatch()
        self._ticks = rospy.Publisher(f"/laws/{name}", LawTicks, queue_size=20)
        self._infos = rospy.Publisher(f"/laws/{name}/info", String, queue_size=5, latch=True)
        self._published_layouts = -1
        rospy.core.add_preshutdown_hook(lambda _: self.flush())

    def step(self, *, dt: float, **inputs: Any) -> Any:
        """Steps the law; every STEPS_PER_MESSAGE steps are published together."""
        output = super().step(dt=dt, **inputs)
        if len(self._layouts) != self._published_layouts:
            self._published_layouts = len(self._layouts)
            self._infos.publish(String(self.info))
        self._batch.add(self.tick, time.time())
        if len(self._batch) >= STEPS_PER_MESSAGE:
            self.flush()
        return output

    def flush(self) -> None:
        """Publishes what was gathered."""
        fields = self._batch.take()
        if fields is not None:
            message = LawTicks(**fields)
            message.header.stamp = rospy.Time.now()
            self._ticks.publish(message)
