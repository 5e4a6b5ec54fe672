"""What the surgeons see on the endoscope's images: tools, distances, and what is not known.

Points are in the rectified *left* optical frame for both eyes. Images are drawn on in place.
"""

from saras._core.overlay import (
    CameraConfig,
    EyeSide,
    FrozenWatch,
    FrozenWatchConfig,
    FrozenWatchOutput,
    OverlayNotice,
    OverlayPainter,
    OverlayStyle,
    OverlayTool,
    PinholeEye,
    StereoPairing,
    StereoPairingConfig,
    StereoPairingOutput,
    ToolMark,
    ToolOverlay,
    ToolOverlayConfig,
    ToolOverlayOutput,
    color_of,
    draw_notice,
    fingerprint,
)

__all__ = [
    "CameraConfig",
    "EyeSide",
    "FrozenWatch",
    "FrozenWatchConfig",
    "FrozenWatchOutput",
    "OverlayNotice",
    "OverlayPainter",
    "OverlayStyle",
    "OverlayTool",
    "PinholeEye",
    "StereoPairing",
    "StereoPairingConfig",
    "StereoPairingOutput",
    "ToolMark",
    "ToolOverlay",
    "ToolOverlayConfig",
    "ToolOverlayOutput",
    "color_of",
    "draw_notice",
    "fingerprint",
]
