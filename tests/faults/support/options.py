"""Arguments of the fault tests: rostest tests/faults/NAME.test hosting:=separate limits:=wide."""

from __future__ import annotations

import os
import sys

#: Ages of the supervisor, and waits at the start [s]. On a busy machine the shipped ones would end engagements that no
#: test has touched. The watchdogs of the receivers, which stop motion and force, are the shipped ones always.
WIDE = {
    "/supervisor/console_limit_s": 1.0,
    "/supervisor/arm_limit_s": 0.9,  # below the time after which arm_state believes a new place (guard/settle_s)
    "/supervisor/node_limit_s": 2.0,
    **{f"/{node}_{side}/connect_wait_s": 90.0 for node in ("arm_state", "arm_driver") for side in ("left", "right")},
    **{f"/velocity_integrator_{side}/start_pose_wait_s": 90.0 for side in ("left", "right")},
    **{f"/tf_transformer_{side}/frames_wait_s": 30.0 for side in ("left", "right")},
}
SHIPPED = {"/supervisor/console_limit_s": 0.06, "/supervisor/arm_limit_s": 0.1, "/supervisor/node_limit_s": 0.35}


def _argument(name: str, default: str) -> str:
    for word in sys.argv[1:]:
        key, _, value = word.partition(":=" if ":=" in word else "=")
        if key.lstrip("-_") == name:
            return value
    return os.environ.get(f"SARAS_FAULTS_{name.upper()}", default)


HOSTING = _argument("hosting", "separate")
LIMITS = _argument("limits", "wide")
LIMIT_S = {name.split("/")[-1]: value for name, value in (WIDE if LIMITS == "wide" else SHIPPED).items()}

_IN_THE_LOOP = (
    "touchball_receiver",
    "tf_transformer",
    "transparency",
    "tank_master",
    "tank_slave",
    "velocity_integrator",
)


def process_of(node: str) -> str:
    """The process that does this node's work: the node itself, or the real-time host in whose loop it is."""
    inside = HOSTING == "realtime" and node.strip("/").startswith(_IN_THE_LOOP)
    return "/realtime_host" if inside else node
