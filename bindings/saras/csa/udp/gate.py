"""What of the set-points a slave may follow: the rules of docs/protocols.md at its end. No socket, no clock."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from saras import ConfigError, displacement
from saras.net import CsaDown, CsaHold, CsaMode

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class GateConfig:
    """Bounds of a slave.

    joint_reach: (n,) how far a set-point may be from where each joint stands [rad] or [m]; reach_m, reach_rad: the same
    for the tip; timeout_s: silence after which it holds.
    """

    joint_reach: tuple[float, ...]
    reach_m: float = 0.02
    reach_rad: float = 0.35
    timeout_s: float = 0.1

    def __post_init__(self) -> None:
        bounds = {"reach_m": self.reach_m, "reach_rad": self.reach_rad, "timeout_s": self.timeout_s}
        bounds.update({f"joint_reach[{i}]": value for i, value in enumerate(self.joint_reach)})
        for name, value in bounds.items():
            if not 0.0 < value < float("inf"):
                raise ConfigError(f"{name} = {value}: must be > 0 and finite")
        if not self.joint_reach:
            raise ConfigError("joint_reach: must have a number for each joint")


class SlaveGate:
    """Follows an engagement until the platform ends it, falls silent, or asks what it must not; then needs a new one.

    An engagement is new when its number is another one than the last. What ended it is told in `hold`.
    """

    def __init__(self, config: GateConfig) -> None:
        self.config = config
        self.hold = CsaHold.NOT_ENGAGED
        self.engagement = 0  #: the one that is followed, or the last that was
        self.reason = ""  #: why, in words
        self._heard_ns = 0

    def take(self, down: CsaDown, q: Array, base_T_tip: Array, now_ns: int) -> bool:
        """Whether to follow this datagram. q: (n,) and base_T_tip: (4, 4) where the slave stands."""
        if down.mode == CsaMode.HOLD:
            if self.hold == CsaHold.NONE:
                self._end(CsaHold.NOT_ENGAGED, "the platform says hold")
            return False
        if down.engagement != self.engagement:
            self.engagement, self.hold, self.reason = down.engagement, CsaHold.NONE, ""
        if self.hold != CsaHold.NONE:
            return False
        refusal = self._refusal(down, q, base_T_tip)
        if refusal:
            self._end(CsaHold.REFUSED, refusal)
            return False
        self._heard_ns = now_ns
        return True

    def refuse(self, reason: str) -> None:
        """The slave itself cannot follow what it was given."""
        self._end(CsaHold.REFUSED, reason)

    def check(self, now_ns: int) -> bool:
        """Whether it still follows. Call it each period."""
        silent_s = self.silent_s(now_ns)
        if self.hold == CsaHold.NONE and silent_s > self.config.timeout_s:
            self._end(CsaHold.NO_SET_POINT, f"no set-point for {silent_s * 1e3:.0f} ms")
        return bool(self.hold == CsaHold.NONE)

    def silent_s(self, now_ns: int) -> float:
        """Since the last set-point that was followed."""
        return (now_ns - self._heard_ns) * 1e-9

    def _refusal(self, down: CsaDown, q: Array, base_T_tip: Array) -> str:
        if down.mode == CsaMode.JOINTS:
            if len(down.position) != len(self.config.joint_reach):
                return f"{len(down.position)} joints: must be {len(self.config.joint_reach)}"
            far = np.abs(down.position - q) - np.array(self.config.joint_reach)
            worst = int(np.argmax(far))
            if not far[worst] <= 0.0:  # a NaN fails here as well
                gap = abs(down.position[worst] - q[worst])
                return f"joint {worst}: {gap:.4f} away, limit {self.config.joint_reach[worst]:g}"
            return ""
        delta = displacement(base_T_tip, down.base_T_tip)
        gap_m, gap_rad = float(np.linalg.norm(delta[:3])), float(np.linalg.norm(delta[3:]))
        if not (gap_m <= self.config.reach_m and gap_rad <= self.config.reach_rad):
            return (
                f"tip: {1e3 * gap_m:.1f} mm, {gap_rad:.3f} rad away, limits {1e3 * self.config.reach_m:g} mm, "
                f"{self.config.reach_rad:g} rad"
            )
        return ""

    def _end(self, hold: CsaHold, reason: str) -> None:
        self.hold, self.reason = hold, reason
