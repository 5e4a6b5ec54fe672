"""What the dVRK lets a user set beside CRTK, for one simulated arm: dvrk_python will not start without these topics."""

from __future__ import annotations

from typing import Any, Callable

import rospy
from std_msgs.msg import Bool, Float64

from saras.crtk import SimulatedCrtkArm

# Which bounds a ratio is of: suffix of the topic → arguments of set_ratio.
RATIOS: dict[str, dict[str, bool]] = {"": {}, "_v": {"acceleration": False}, "_a": {"speed": False}}
# Heard and without effect: no forces act on the simulated arm, and its instrument is always mounted.
WITHOUT_EFFECT = ("use_gravity_compensation", "body/set_cf_orientation_absolute")
WITHOUT_EFFECT_PSM = ("emulate_adapter_present", "emulate_tool_present")


class Settings:
    """Ratios of the bounds of moves, below /<arm>/trajectory_j, and switches that are only heard.

    subscribe: takes topic, type and a callback, which is called under the arm's lock.
    """

    def __init__(self, arm: SimulatedCrtkArm, subscribe: Callable[[str, type, Callable[[Any], None]], None]) -> None:
        self._arm = arm
        prefix = f"/{arm.name}/"
        self._ratios = {
            suffix: rospy.Publisher(f"{prefix}trajectory_j/ratio{suffix}", Float64, queue_size=20, latch=True)
            for suffix in RATIOS
        }
        for suffix, which in RATIOS.items():
            subscribe(
                f"{prefix}trajectory_j/set_ratio{suffix}", Float64, lambda m, which=which: self._on_ratio(m.data, which)
            )
        for name in WITHOUT_EFFECT + (WITHOUT_EFFECT_PSM if arm.jaw is not None else ()):
            subscribe(prefix + name, Bool, lambda _: None)
        self._tell()

    def _on_ratio(self, value: float, which: dict[str, bool]) -> None:
        if self._arm.set_ratio(value, **which):
            self._tell()

    def _tell(self) -> None:
        speed, acceleration = self._arm.ratios
        self._ratios["_v"].publish(Float64(speed))
        self._ratios["_a"].publish(Float64(acceleration))
        if speed == acceleration:  # else the one for both has no value
            self._ratios[""].publish(Float64(speed))
