"""The platform's end of a slave arm elsewhere: CRTK's states, what goes down, and a named hold. No socket, no clock.

HOLD is CRTK's PAUSED: the slave stands, `hold` says why, and only `resume` ends it. Nothing moves by itself again.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import numpy as np
import numpy.typing as npt

from saras import ConfigError
from saras.crtk import StateMachine
from saras.csa.udp.gate import GateConfig, SlaveGate
from saras.net import CsaDown, CsaHold, CsaMode, CsaSlaveState, CsaUp

Array = npt.NDArray[np.float64]


class HoldReason(Enum):
    """Why the slave stands. The names are what is shown and published."""

    OK = "follows, or waits for a set-point"
    WAITING = "the slave was never heard"
    DISABLED = "nobody has enabled it"
    PAUSED = "by command"
    JOINTS_DIFFER = "the slave has not the joints of its kinematics"
    SLAVE_LOST = "the slave is silent"
    SLAVE_RESTARTED = "the slave was started anew"
    SLAVE_FAULT = "the slave is not ready"
    SLAVE_HOLDS = "the slave does not follow"
    SET_POINT_LOST = "who sends the set-points is silent"
    SET_POINT_REFUSED = "a set-point that the slave must not follow"


ADVICE = {
    HoldReason.JOINTS_DIFFER: "start another slave or mend the system file, then enable or resume",
    HoldReason.SLAVE_LOST: "start the slave or mend its link, then resume",
    HoldReason.SLAVE_RESTARTED: "look where it stands, then resume",
    HoldReason.SLAVE_FAULT: "mend the slave, then resume",
    HoldReason.SLAVE_HOLDS: "look at the slave, then resume",
    HoldReason.SET_POINT_LOST: "start the controller, then resume",
    HoldReason.SET_POINT_REFUSED: "let the controller start from where the slave stands, then resume",
}


@dataclass(frozen=True)
class RemoteSlaveConfig:
    """Watchdogs of the platform's end.

    gate: bounds of a set-point (its timeout_s is that of set-points); state_timeout_s: of the slave's state;
    begin_timeout_s: from a new engagement until the slave must follow it.
    """

    gate: GateConfig
    state_timeout_s: float = 0.1
    begin_timeout_s: float = 1.0

    def __post_init__(self) -> None:
        for name in ("state_timeout_s", "begin_timeout_s"):
            if not 0.0 < getattr(self, name) < float("inf"):
                raise ConfigError(f"{name} = {getattr(self, name)}: must be > 0 and finite")


class RemoteSlave:
    """One arm. `number` gives engagement numbers, another one at each call.

    `step` goes each period; `events` collects what happened: (level, text), level error or status.
    """

    def __init__(self, config: RemoteSlaveConfig, number: Callable[[], int] = time.time_ns) -> None:
        self.config = config
        self.machine = StateMachine()
        self.hold = HoldReason.WAITING
        self.up: CsaUp | None = None
        self.events: list[tuple[str, str]] = []
        self._number = number
        self._gate = SlaveGate(config.gate)
        self._down = CsaDown()
        self._engagement = 0
        self._begun_ns = 0
        self._age_s = float("inf")
        self._other_joints = ""

    @property
    def engaged(self) -> bool:
        """Whether set-points go to the slave."""
        return self._engagement != 0

    @property
    def ready(self) -> bool:
        """Whether the slave is there and could be enabled."""
        return self._missing() is HoldReason.OK

    # ---- what it obeys

    def state_command(self, text: str) -> None:
        """CRTK's commands. Raises ValueError, and nothing has changed, when the table or the slave's state says no."""
        rouses = text in ("enable", "resume", "home")
        if rouses and self.machine.state != "ENABLED":
            missing = self._missing()
            if missing is not HoldReason.OK:
                raise ValueError(f"{text} refused: {missing.name}: {missing.value}")
        self.machine.command(text)
        self.machine.is_homed = self.up is not None and bool(self.up.homed)  # the slave's word, not the command
        if self.machine.state == "ENABLED":
            self.hold = HoldReason.OK
            return
        self._disengage()
        self.hold = HoldReason.DISABLED if self.machine.state == "DISABLED" else HoldReason.PAUSED

    def _missing(self) -> HoldReason:
        if self._other_joints:
            return HoldReason.JOINTS_DIFFER
        if self.up is None:
            return HoldReason.WAITING
        if not self._age_s <= self.config.state_timeout_s:
            return HoldReason.SLAVE_LOST
        if self.up.state != CsaSlaveState.ENABLED:
            return HoldReason.SLAVE_FAULT
        return HoldReason.OK

    def servo_jp(self, q: Array, now_ns: int) -> None:
        """A set-point of the joints (n,), finite."""
        self._servo(CsaDown(mode=CsaMode.JOINTS, position=q), now_ns)

    def servo_cp(self, base_T_tip: Array, now_ns: int) -> None:
        """A set-point of the tip (4, 4)."""
        self._servo(CsaDown(mode=CsaMode.CARTESIAN, base_T_tip=base_T_tip), now_ns)

    def _servo(self, down: CsaDown, now_ns: int) -> None:
        if self.machine.state != "ENABLED" or self.up is None:
            return
        if not self._engagement:
            self._engagement, self._begun_ns = self._number(), now_ns
        down.engagement = self._engagement
        # The slave's own rules, so that what it would refuse does not go out.
        if not self._gate.take(down, self.up.position, self.up.base_T_tip, now_ns):
            self._pause(HoldReason.SET_POINT_REFUSED, self._gate.reason)
            return
        self._down = down

    # ---- what it hears

    def take(self, up: CsaUp) -> None:
        """A new datagram of the slave; with another number of joints than joint_reach has it is not taken."""
        count, wanted = len(up.position), len(self.config.gate.joint_reach)
        self._other_joints = f"it has {count}, must be {wanted}" if count != wanted else ""
        if self._other_joints:
            if self.machine.state != "ENABLED" and self.hold is not HoldReason.JOINTS_DIFFER:
                self._say(HoldReason.JOINTS_DIFFER, self._other_joints)
            return
        before, self.up = self.up, up
        self._age_s = 0.0
        if self.machine.state == "DISABLED":
            self.hold = HoldReason.DISABLED
        anew = before is not None and up.session != before.session
        if anew and self.machine.state == "ENABLED":
            self._pause(HoldReason.SLAVE_RESTARTED)
        self.machine.is_homed = bool(up.homed)

    def step(self, now_ns: int, age_s: float) -> CsaDown:
        """What to send now. age_s: of the newest that was heard."""
        self._age_s = age_s
        if self.machine.state == "ENABLED":
            self._watch(now_ns)
        if not self._engagement:
            return CsaDown()
        return self._down

    def _watch(self, now_ns: int) -> None:
        missing = self._missing()
        if missing is not HoldReason.OK:
            more = f"{self._age_s * 1e3:.0f} ms" if missing is HoldReason.SLAVE_LOST else ""
            self._pause(missing, more or self._other_joints)
        elif self._engagement and not self._gate.check(now_ns):
            # Who sends set-points steps on the slave's state, and falls silent with it: that is the slave's loss.
            with_it = self._age_s > 0.5 * self._gate.silent_s(now_ns)
            self._pause(HoldReason.SLAVE_LOST if with_it else HoldReason.SET_POINT_LOST, self._gate.reason)
        elif self._engagement and self.up is not None:
            if self.up.engagement == self._engagement and self.up.hold != CsaHold.NONE:
                self._pause(HoldReason.SLAVE_HOLDS, self.up.hold.name)
            elif self.up.engagement != self._engagement:
                waited_s = (now_ns - self._begun_ns) * 1e-9
                if waited_s > self.config.begin_timeout_s:
                    self._pause(HoldReason.SLAVE_HOLDS, f"does not begin for {waited_s:.1f} s")

    def _pause(self, hold: HoldReason, more: str = "") -> None:
        self.machine.command("pause")
        self._disengage()
        self._say(hold, more)

    def _say(self, hold: HoldReason, more: str) -> None:
        self.hold = hold
        detail = f" ({more})" if more else ""
        self.events.append(("error", f"HOLD: {hold.name}: {hold.value}{detail} → {ADVICE[hold]}"))

    def _disengage(self) -> None:
        self._engagement = 0
        self._down = CsaDown()

    def take_events(self) -> list[tuple[str, str]]:
        """What happened since the last call."""
        events, self.events = self.events, []
        return events
