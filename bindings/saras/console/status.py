"""What the operator sees: a live table in a terminal, one line a second elsewhere."""

from __future__ import annotations

import logging
import math
import sys
import time
from collections.abc import Callable
from typing import Any, TextIO

from saras.console.program import Hand, Program
from saras.net import ChannelState

COLOURS = {
    ChannelState.WAITING: "yellow",
    ChannelState.READY: "cyan",
    ChannelState.ENGAGED: "green",
    ChannelState.HOLD: "bold red",
}


def milliseconds(seconds: float | None) -> str:
    """'12.3 ms', or '?' for what is not known."""
    return "?" if seconds is None or not math.isfinite(seconds) else f"{seconds * 1e3:.1f} ms"


def state_text(hand: Hand, fresh: bool) -> str:
    """State as the platform says it; a state that is too old to be true is shown as unknown."""
    return hand.guard.state.name if fresh else "? (no link)"


def row(side: str, hand: Hand, fresh: bool) -> list[str]:
    """One handle as text: side, state, handle, clip, force, energy, guard."""
    guard = hand.guard
    x, y, z = (1e3 * hand.pose[:3, 3]) if hand.pose is not None else (math.nan, math.nan, math.nan)
    where = f"{x:6.1f} {y:6.1f} {z:6.1f}" if hand.pose is not None else "no reading"
    marks = ("clutch " if hand.clutch else "") + ("" if hand.calibrated else "not calibrated")
    return [
        side,
        state_text(hand, fresh),
        where,
        f"{hand.grip * 100:3.0f} %",
        f"{guard.force_N:4.2f} N",
        f"{guard.energy_J:5.3f} J",
        f"{guard.reduction:4.2f}",
        guard.status.name,
        marks.strip(),
    ]


def link_text(program: Program, now_ns: int) -> str:
    """The link in one line."""
    link, counts = program.link, program.link.filter.counts
    return (
        f"sent {link.counts.sent}  received {link.counts.received}  age {milliseconds(link.age_s(now_ns))}  "
        f"round trip {milliseconds(link.round_trip_s)}  lost {counts.gaps}  late {counts.out_of_order}  "
        f"doubled {counts.duplicate}  refused {link.counts.refused}  overruns {program.overruns}"
    )


class PlainStatus:
    """One line a second, for logs and pipes."""

    def __init__(self, stream: TextIO, period_s: float = 1.0) -> None:
        self._stream, self._period_s, self._next = stream, period_s, 0.0

    def show(self, program: Program, now_ns: int) -> None:
        """Prints when it is time."""
        if now_ns * 1e-9 < self._next:
            return
        self._next = now_ns * 1e-9 + self._period_s
        fresh = program.link.is_fresh(now_ns)
        hands = "  |  ".join(" ".join(part for part in row(s, h, fresh)) for s, h in program.hands.items())
        print(f"{hands}  |  {link_text(program, now_ns)}", file=self._stream, flush=True)

    def close(self) -> None:
        """Nothing to leave."""


class LiveStatus:
    """A table that stays in place (library rich). Log lines scroll above it."""

    def __init__(self, live: Any) -> None:
        self._live, self._next = live, 0.0
        live.start()

    def show(self, program: Program, now_ns: int) -> None:
        """Draws four times a second."""
        if now_ns * 1e-9 < self._next:
            return
        self._next = now_ns * 1e-9 + 0.25
        self._live.update(self._table(program, now_ns), refresh=True)

    def _table(self, program: Program, now_ns: int) -> Any:
        from rich.table import Table

        table = Table(title="SARAS console", caption=link_text(program, now_ns), caption_justify="left")
        for column in ("handle", "state", "x y z [mm]", "clip", "force", "energy", "K_E", "guard", ""):
            table.add_column(column, justify="right" if column in ("clip", "force", "energy", "K_E") else "left")
        fresh = program.link.is_fresh(now_ns)
        for side, hand in program.hands.items():
            cells = row(side, hand, fresh)
            colour = COLOURS[hand.guard.state] if fresh else "dim"
            cells[1] = f"[{colour}]{cells[1]}[/]"
            table.add_row(*cells)
        return table

    def close(self) -> None:
        """Leaves the last table on the screen."""
        self._live.stop()


def open_status(plain: bool) -> tuple[PlainStatus | LiveStatus, logging.Handler, Callable[[str], None]]:
    """The display, the log handler that fits it, and a printer."""
    if not plain and sys.stdout.isatty():
        try:
            from rich.console import Console
            from rich.live import Live
            from rich.logging import RichHandler
        except ModuleNotFoundError:
            pass  # the plain lines say the same
        else:
            console = Console()
            handler: logging.Handler = RichHandler(console=console, show_path=False)
            return LiveStatus(Live(console=console, auto_refresh=False)), handler, console.print
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    return PlainStatus(sys.stdout), handler, print


def clock_ns() -> int:
    """The clock of the whole console."""
    return time.monotonic_ns()
