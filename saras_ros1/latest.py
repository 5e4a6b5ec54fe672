"""The newest message of a topic, decoded only when it is looked at: for displays, which look seldom."""

from __future__ import annotations

import time
from typing import Any

import rospy

STALE_S = 1.0


class Latest:
    """Subscribes; needs an initialised rospy node."""

    def __init__(self, topic: str, message_class: type) -> None:
        self._class = message_class
        self._raw: bytes | None = None
        self._at = 0.0
        # Without tcp_nodelay the kernel joins small messages: a display wakes up less often, and sees them 40 ms later.
        rospy.Subscriber(topic, rospy.AnyMsg, self._on_message, queue_size=1)

    def _on_message(self, message: rospy.AnyMsg) -> None:
        self._raw, self._at = message._buff, time.monotonic()

    def value(self, stale_s: float = STALE_S) -> Any | None:
        """The message, or None when there was none within stale_s."""
        raw = self._raw
        if raw is None or time.monotonic() - self._at > stale_s:
            return None
        return self._class().deserialize(raw)
