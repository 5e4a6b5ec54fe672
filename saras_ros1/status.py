"""The live table: both sides, tanks, nodes. Values are drawn from the last messages; old ones are shown as unknown."""

from __future__ import annotations

import math
import threading
import time
from typing import Any

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from rich.table import Table
from rich.text import Text

from saras_ros1.collision_markers import NAMES as DISTANCE_STATES
from saras_ros1.latest import Latest
from saras_ros1.msg import ChannelState, CollisionState, RecorderState, TankState

SIDES = ("left", "right")
TANKS = ("tank_master", "tank_slave", "port_guard_left", "port_guard_right")
DIAGNOSTICS_STALE_S = 3.0
STATE_NAMES = {0: "WAITING", 1: "READY", 2: "ENGAGED", 3: "HOLD"}
_STATE_STYLE = {0: "yellow", 1: "cyan", 2: "bold green", 3: "bold white on red"}
_DISTANCE_STYLE = {0: "dim italic", 1: "green", 2: "bold yellow", 3: "bold white on red"}
_LEVEL_STYLE = {0: "green", 1: "yellow", 2: "red", 3: "magenta"}
UNKNOWN = Text("unknown", style="dim italic")


def state_name(state: ChannelState) -> str:
    """As the operator reads it: an E-stop by its own name."""
    return "E-STOP" if state.estop else STATE_NAMES.get(state.state, "?")


def recording_words(state: Any | None) -> str:
    """Of a RecorderState; a silent recorder records nothing."""
    if state is None:
        return "NOT RECORDING: no recorder"
    if state.recording:
        return f"recording {state.bytes / 1e6:.0f} MB" + (f" ({state.reason})" if state.reason else "")
    return f"NOT RECORDING: {state.reason}"


class Status:
    """Subscribes to what the table shows; needs an initialised rospy node."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._nodes: dict[str, tuple[float, Any]] = {}
        self.sides = {side: Latest(f"/system/{side}/state", ChannelState) for side in SIDES}
        self.tanks = {name: Latest(f"/{name}/state", TankState) for name in TANKS}
        self.recorder = Latest("/recorder/state", RecorderState)
        self.distances = Latest("/collision/state", CollisionState)
        rospy.Subscriber("/diagnostics", DiagnosticArray, self._on_diagnostics, queue_size=50)

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        with self._lock:
            for status in message.status:
                self._nodes[status.name] = (time.monotonic(), status)

    def states(self) -> dict[str, Any | None]:
        """ChannelState of each side, None where unknown."""
        return {side: latest.value() for side, latest in self.sides.items()}

    @property
    def recording(self) -> bool:
        """Whether what happens now will be in the bag."""
        state = self.recorder.value()
        return state is not None and state.recording

    def table(self, title: str = "") -> Table:
        """All of it, for rich."""
        grid = Table.grid(padding=(0, 3))
        grid.add_row(self._sides_table(), self._tanks_table(), self._distances_table())
        outer = Table.grid()
        if title:
            outer.add_row(Text(title, style="bold"))
        outer.add_row(grid)
        recorder = self.recorder.value()
        style = "green" if recorder is not None and recorder.recording else "bold white on red"
        outer.add_row(Text(recording_words(recorder), style=style))
        outer.add_row(self._nodes_table())
        return outer

    def line(self) -> str:
        """One line of plain text, for logs."""
        parts = []
        for side, state in self.states().items():
            name = "unknown" if state is None else state_name(state)
            reason = f" ({state.reason})" if state is not None and state.reason else ""
            parts.append(f"{side} {name}{reason}")
        for name, latest in self.tanks.items():
            tank = latest.value()
            parts.append(f"{name} " + ("unknown" if tank is None else f"{tank.energy_J:.3f} J"))
        return " | ".join([*parts, self._distance_words(), recording_words(self.recorder.value())])

    def _distance_words(self) -> str:
        state = self.distances.value()
        if state is None or not state.tools:
            return "distances unknown"
        unknown = [tool.name for tool in state.tools if tool.state == 0]
        known = [tool for tool in state.tools if math.isfinite(tool.known_distance)]
        words = f"distances unknown: {' '.join(unknown)}" if unknown else "nearest"
        if known:
            least = min(known, key=lambda tool: tool.known_distance)
            words += f" {1e3 * least.known_distance:.1f} mm {least.name}-{least.partner} {DISTANCE_STATES[least.state]}"
        return words

    def _distances_table(self) -> Table:
        table = Table("tool", "state", "mm", "to", title="distances", title_justify="left")
        state = self.distances.value()
        if state is None:
            table.add_row("all", UNKNOWN, UNKNOWN, "")
            return table
        for tool in state.tools:
            name = Text(DISTANCE_STATES.get(tool.state, "?"), style=_DISTANCE_STYLE.get(tool.state, ""))
            known = math.isfinite(tool.known_distance)
            distance: Any = f"{1e3 * tool.known_distance:.1f}" if known else UNKNOWN
            table.add_row(tool.name, name, distance, tool.partner)
        return table

    def _sides_table(self) -> Table:
        columns = ("side", "state", "held by", "clutch", "what is wrong, what to do")
        table = Table(*columns, title="sides", title_justify="left")
        for side, state in self.states().items():
            if state is None:
                table.add_row(side, UNKNOWN, UNKNOWN, UNKNOWN, "no state for a second")
                continue
            name = Text(state_name(state), style=_STATE_STYLE.get(state.state, ""))
            holder = state.holder or "nobody"
            if state.offered_to:
                holder += f", offered to {state.offered_to}"
            words = " → ".join(part for part in (state.reason, state.advice) if part)
            table.add_row(side, name, holder, "pressed" if state.clutch else "", words)
        return table

    def _tanks_table(self) -> Table:
        table = Table("tank", "energy [J]", "", "reduction", "out [J]", "status", title="tanks", title_justify="left")
        for name, latest in self.tanks.items():
            tank = latest.value()
            if tank is None:
                table.add_row(name, UNKNOWN, "", UNKNOWN, UNKNOWN, UNKNOWN)
                continue
            style = (
                "green" if tank.energy_J >= tank.request_J else "yellow" if tank.energy_J >= tank.minimum_J else "red"
            )
            share = tank.energy_J / tank.maximum_J if tank.maximum_J > 0 else 0.0
            bar = Text("█" * round(12 * min(max(share, 0.0), 1.0)), style=style)
            numbers = f"{tank.energy_J:.3f}", bar, f"{tank.reduction:.2f}", f"{tank.work_out_J:+.3f}"
            table.add_row(name, *numbers, tank.status)
        return table

    def _nodes_table(self) -> Table:
        table = Table("node", "rate [Hz]", "worst step [ms]", "message", title="nodes", title_justify="left")
        with self._lock:
            nodes = sorted(self._nodes.items())
        now = time.monotonic()
        for name, (at, status) in nodes:
            if now - at > DIAGNOSTICS_STALE_S:
                table.add_row(name, UNKNOWN, UNKNOWN, Text(f"silent for {now - at:.0f} s", style="magenta"))
                continue
            values = {pair.key: pair.value for pair in status.values}
            rate, worst = values.get("rate_hz", ""), values.get("step_worst_ms", "")
            table.add_row(name, rate, worst, Text(status.message, style=_LEVEL_STYLE.get(status.level, "")))
        return table
