"""What is wrong with the samples, in words."""

from __future__ import annotations

import time
from collections import deque

from saras.model import StiffnessGpConfig

RECENT_S = 1.0
SHARE = 0.25  #: of the last second's samples that makes a fault of it
TAKEN = ("LEARNED", "RELEARNED")
WRONG = ("SENSOR_DRIFT", "IMPLAUSIBLE_POSITION", "IMPLAUSIBLE_FORCE", "INVALID", "OUTLIER")


class Pace:
    """How fast a counter grows, over the last second or more."""

    def __init__(self) -> None:
        self._seen: deque[tuple[float, int]] = deque()

    def rate_hz(self, count: int) -> float:
        """count: what it shows now. Call it a few times a second."""
        now = time.monotonic()
        self._seen.append((now, count))
        while len(self._seen) > 2 and self._seen[1][0] < now - RECENT_S:
            self._seen.popleft()
        since, before = self._seen[0]
        return max(0, count - before) / (now - since) if now > since else 0.0


class SampleStatus:
    """Counts verdicts, since the start and over the last second."""

    def __init__(self, config: StiffnessGpConfig) -> None:
        self._config = config
        self._recent: deque[tuple[float, dict[str, int]]] = deque()
        self.total: dict[str, int] = {}

    def count(self, total: dict[str, int]) -> None:
        """How many samples met which verdict since the start."""
        self._recent.append(
            (time.monotonic(), {name: max(0, n - self.total.get(name, 0)) for name, n in total.items()})
        )
        self.total = dict(total)

    def reset(self) -> None:
        """Forgets."""
        self._recent.clear()
        self.total = {}

    @property
    def learned(self) -> int:
        """Samples."""
        return sum(self.total.get(name, 0) for name in TAKEN)

    @property
    def refused(self) -> int:
        """Samples that should have been learned and were not."""
        return sum(self.total.get(name, 0) for name in WRONG)

    def text(self, missing: str, bias_N: float, disagreement: float) -> tuple[bool, str]:
        """(all is well, OK or NO_CONTACT or what is wrong)."""
        if missing:
            return False, f"STALE: {missing}"
        end = time.monotonic() - RECENT_S
        while self._recent and self._recent[0][0] < end:
            self._recent.popleft()
        now: dict[str, int] = {}
        for _, said in list(self._recent):
            for name, number in said.items():
                now[name] = now.get(name, 0) + number
        count = sum(now.values())
        worst = max(WRONG, key=lambda name: now.get(name, 0))
        if count and now.get(worst, 0) > SHARE * count:
            return False, f"{worst}: {self._why(worst, bias_N)}"
        if abs(disagreement) > self._config.agreement_limit:
            return False, (
                f"DISAGREES: samples are {disagreement:+.1f} sigma from the map, "
                f"limit {self._config.agreement_limit:g}: the sensor has drifted or the organ has moved"
            )
        return True, "OK" if any(now.get(name, 0) for name in TAKEN) else "NO_CONTACT"

    def _why(self, verdict: str, bias_N: float) -> str:
        c = self._config
        return {
            "SENSOR_DRIFT": f"{bias_N:.2f} N in free air, bias_limit_N = {c.bias_limit_N:g}",
            "IMPLAUSIBLE_POSITION": f"beyond workspace_m = {c.workspace_m:g} or speed_limit_m_s = "
            f"{c.speed_limit_m_s:g}: millimetres for metres, another frame?",
            "IMPLAUSIBLE_FORCE": f"beyond force_limit_N = {c.force_limit_N:g}: another unit, a broken sensor?",
            "INVALID": "not finite",
            "OUTLIER": f"beyond outlier_sigma = {c.outlier_sigma:g} of what their neighbours predict",
        }[verdict]
