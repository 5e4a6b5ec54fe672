"""The da Vinci's arms as the dVRK knows them. Base frames ``PSM1``, ``PSM2``, ``ECM`` are the remote centres."""

from __future__ import annotations

from saras._core.kinematics import (
    DvrkTool,
    Ecm,
    EcmConfig,
    Psm,
    PsmConfig,
    dvrk_ecm_config,
    dvrk_find_tool,
    dvrk_psm_config,
    dvrk_tools,
)

PSM_JOINT_NAMES = ("yaw", "pitch", "insertion", "roll", "wrist_pitch", "wrist_yaw")
"""Order of a PSM's q everywhere; the jaw is apart."""

ECM_JOINT_NAMES = ("yaw", "pitch", "insertion", "roll")
"""Order of an ECM's q everywhere."""

SHAFT_RADIUS_M = 0.0042
"""Of an 8 mm instrument with its sleeve."""

ENDOSCOPE_RADIUS_M = 0.006
"""Of the 12 mm endoscope."""

CANNULA_M = 0.025
"""From the remote centre to the cannula's tip, about."""


def tool(text: str) -> DvrkTool:
    """An instrument by model ("400006") or dVRK name ("LARGE_NEEDLE_DRIVER:400006"). Raises ConfigError."""
    return dvrk_find_tool(text)


def tools() -> list[DvrkTool]:
    """All known instruments, by model."""
    return dvrk_tools()


def psm(tool: str = "400006", body: str = "classic") -> Psm:
    """A PSM with an instrument.

    body: "classic" or "si". A Classic body takes Classic (400xxx) and S/Si (420xxx) instruments, an Si body the latter
    only. Raises ConfigError naming the value and what is allowed.
    """
    return Psm(dvrk_psm_config(tool, body))


def ecm(endoscope: str = "straight", body: str = "classic") -> Ecm:
    """An ECM with an endoscope that looks "straight", 30 degrees "up" or 30 degrees "down". Raises ConfigError."""
    return Ecm(dvrk_ecm_config(endoscope, body))


__all__ = [
    "CANNULA_M",
    "ECM_JOINT_NAMES",
    "ENDOSCOPE_RADIUS_M",
    "PSM_JOINT_NAMES",
    "SHAFT_RADIUS_M",
    "DvrkTool",
    "Ecm",
    "EcmConfig",
    "Psm",
    "PsmConfig",
    "ecm",
    "psm",
    "tool",
    "tools",
]
