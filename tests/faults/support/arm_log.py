"""What an arm was told and what it did, from the file that its server writes (saras.mesa_link.arm_log)."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from .platform import ROOT
from .waiting import wait_until

_DRIVER = yaml.safe_load((ROOT / "config" / "arms.yaml").read_text(encoding="utf-8"))["arm_driver_left"]
#: v_max, and the longest dt of one step of the driver
SPEED_M_S, DT_MAX_S = _DRIVER["limiter"]["speed_m_s"], _DRIVER["limiter"]["dt_max_s"]
#: no command is further than this from the last one, unless others between them were never sent [m]
STEP_LIMIT_M = SPEED_M_S * DT_MAX_S
NOMINAL_S = _DRIVER["period_s"] * _DRIVER["send_every"]
#: what the arm's servo follows moves at most this fast [m/s]
ARM_SPEED_M_S = _DRIVER["arm_speed_limit_m_s"]
PAUSE_S = 0.25  #: after this the driver begins anew from the measured pose


class Command(NamedTuple):
    t_s: float
    session: int
    seq: int
    position: tuple[float, ...]
    echo_tick: int


class Tick(NamedTuple):
    t_s: float
    tick: int
    following: bool
    target: tuple[float, ...]
    tip: tuple[float, ...]


class ArmLog:
    """Reads on as the file grows. A mark is the number of lines read so far."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.commands: list[Command] = []
        self.ticks: list[Tick] = []
        self.refused: list[dict[str, Any]] = []
        self.not_finite = 0
        self._offset = 0
        self._rest = b""

    def read(self) -> ArmLog:
        """Takes in what is new."""
        if not self.path.exists():
            return self
        size = self.path.stat().st_size
        if size < self._offset:  # a restarted server begins a new file
            self._offset, self._rest = 0, b""
        with self.path.open("rb") as file:
            file.seek(self._offset)
            data = self._rest + file.read()
            self._offset = file.tell()
        *lines, self._rest = data.split(b"\n")
        for line in lines:
            self._take(json.loads(line))
        return self

    def _take(self, line: dict[str, Any]) -> None:
        if "refused" in line:
            self.refused.append(line)
        elif "tick" in line and "command" not in line:
            self._check((*line["target"], *line["tip"]))
            tick = Tick(line["t_s"], line["tick"], line["following"], tuple(line["target"]), tuple(line["tip"]))
            self.ticks.append(tick)
        elif line["command"] == "set_target":
            self._check((*line["position"], *line["quaternion"]))
            position = tuple(line["position"])
            self.commands.append(Command(line["t_s"], line["session"], line["seq"], position, line["echo_tick"]))

    def _check(self, numbers: tuple[Any, ...]) -> None:
        self.not_finite += any(number is None or not math.isfinite(number) for number in numbers)

    # -- what happened since a mark ----------------------------------------------------------------------------

    def mark(self) -> tuple[int, int, int]:
        """Commands, ticks and refusals so far."""
        self.read()
        return len(self.commands), len(self.ticks), len(self.refused)

    def steps(self, mark: tuple[int, int, int]) -> Iterator[tuple[float, float]]:
        """From each command to the next: (its way, v_max * dt) [m]. The first after a pause is measured from the tip.

        dt is at least the longest that counts as one step, and what passed between them when the driver's loop was held
        up: of commands that wait, it sends the newest. A command that came late itself takes that time from the next.
        """
        self.read()
        ticks = iter(self.ticks)
        tick = next(ticks, None)
        tip: tuple[float, ...] | None = None
        for i, command in enumerate(self.commands):
            while tick is not None and tick.t_s <= command.t_s:
                tip, tick = tick.tip, next(ticks, None)
            if i < max(1, mark[0]):
                continue
            before = self.commands[i - 1]
            begins = command.session != before.session or command.t_s - before.t_s > PAUSE_S
            reference = tip if begins else before.position
            if reference is None:
                continue
            dt_s = DT_MAX_S if begins else max(DT_MAX_S, command.t_s - before.t_s + self._late_s(i - 1))
            yield math.dist(reference, command.position), SPEED_M_S * dt_s

    def _late_s(self, i: int) -> float:
        """How much later than the pace of those before it a command came."""
        t_s = self.commands[i].t_s
        earlier = ((k, t_s - self.commands[i - k].t_s) for k in range(1, min(7, i + 1)))
        return max([0.0, *(min(gone_s, PAUSE_S) - k * NOMINAL_S for k, gone_s in earlier)])

    def worst_speed_m_s(self, mark: tuple[int, int, int]) -> float:
        """Of what the servo followed, by the machine's own time: its period is that of its ticks."""
        self.read()
        ticks = self.ticks[mark[1] :]
        # Where it begins to hold, the target goes back to where the tip is: that is no motion.
        pairs = [(a, b) for a, b in zip(ticks, ticks[1:]) if b.tick == a.tick + 1 and a.following and b.following]
        return max((math.dist(a.target, b.target) for a, b in pairs), default=0.0) * RATE_HZ

    def sustained_speed_m_s(self, mark: tuple[int, int, int], ticks: int = 50) -> float:
        """The longest way of the servo's target in so many ticks, over their time: commands come bunched."""
        self.read()
        chosen = self.ticks[mark[1] :]
        speeds = [
            sum(math.dist(a.target, b.target) for a, b in zip(part, part[1:])) / (part[-1].t_s - part[0].t_s)
            for part in (chosen[i : i + ticks + 1] for i in range(max(0, len(chosen) - ticks)))
        ]
        return max(speeds, default=0.0)

    def still_after_s(self, t_s: float) -> float:
        """From this time of the arm's clock until its servo's target stood where it stands now."""
        newest = self.read().ticks[-1].target
        moving = [tick.t_s for tick in self.ticks if tick.t_s > t_s and math.dist(tick.target, newest) > 1e-5]
        return moving[-1] - t_s if moving else 0.0

    def path_m(self, mark: tuple[int, int, int]) -> float:
        """Largest distance of a commanded position from the first one."""
        self.read()
        points = [command.position for command in self.commands[mark[0] :]]
        return max((math.dist(points[0], point) for point in points), default=0.0)

    def await_commands(self, count: int, what: str) -> None:
        """So many commands more from now on."""
        begin = self.mark()[0]
        wait_until(
            lambda: len(self.read().commands) >= begin + count,
            lambda: f"{count} commands at {self.path.stem} ({what}); there were {len(self.commands) - begin}",
        )

    def await_motion(self, least_m: float, what: str, or_until: Callable[[], bool] = lambda: False) -> None:
        """Until commands have gone so far from where they are now, or until something else."""
        mark = self.mark()
        wait_until(
            lambda: self.path_m(mark) > least_m or or_until(),
            lambda: f"{what}: {self.path.stem} moves by {least_m * 1e3} mm",
        )

    def await_still(self, ticks: int = 30, within_m: float = 1e-6) -> None:
        """Until the servo's target has stood still for so many of the arm's ticks."""

        def still() -> bool:
            newest = self.read().ticks[-ticks:]
            return len(newest) == ticks and all(math.dist(t.target, newest[0].target) < within_m for t in newest)

        wait_until(still, f"{self.path.stem} stands still for {ticks} ticks")

    def moved_since(self, mark: tuple[int, int, int]) -> float:
        """How far the servo's target is now from where it was at the mark [m]."""
        self.read()
        index = max(0, mark[1] - 1)
        return math.dist(self.ticks[index].target, self.ticks[-1].target) if self.ticks else 0.0


RATE_HZ = 100.0  #: of the simulated arms in launch/mesa_arms.launch
