"""Hand-eye calibration. The core has it only where Ceres was there to build with."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from saras._core.calibration import HandEye, HandEyeNoise, hand_eye, rotation_spread
else:
    try:
        from saras._core.calibration import HandEye, HandEyeNoise, hand_eye, rotation_spread
    except ImportError:

        class _Missing:
            """Names the package at the first use: the rest of saras.calibration works without it."""

            def __call__(self, *arguments: Any, **named: Any) -> Any:
                raise ImportError(
                    "hand_eye: saras was built without Ceres; install it (apt-get install libceres-dev) and build again"
                )

        HandEye = HandEyeNoise = hand_eye = rotation_spread = _Missing()

__all__ = ["HandEye", "HandEyeNoise", "hand_eye", "rotation_spread"]
