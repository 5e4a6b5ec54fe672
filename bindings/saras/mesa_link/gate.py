"""Who may command the arm, and which commands are still worth obeying. Pure: time is an argument.

Age is measured on the arm's clock alone: a command names the newest state tick its sender had seen, and the
gate knows when it sent that tick. A sender that was frozen, or a link that held packets back, therefore
cannot make an old command look new, and the clocks of the two hosts never meet.
"""

from __future__ import annotations

from collections import Counter, deque
from dataclasses import dataclass

from saras import ConfigError
from saras.mesa_link.fields import MessageError
from saras.mesa_link.protocol import Header, Reason


@dataclass(frozen=True)
class GateConfig:
    """The arm's own limits [s], whatever a client asks for."""

    command_age_limit_s: float = 0.15  # a command older than this is dropped
    target_timeout_s: float = 0.10  # without a fresh target for this long the arm holds
    heartbeat_timeout_s: float = 0.30  # without any fresh message for this long the client loses control
    ticks_remembered: int = 1000

    def __post_init__(self) -> None:
        for name in ("command_age_limit_s", "target_timeout_s", "heartbeat_timeout_s"):
            value = getattr(self, name)
            if not 0.0 < value <= 5.0:
                raise ConfigError(f"GateConfig.{name}: {value} is not in (0, 5] s")
        if self.ticks_remembered < 1:
            raise ConfigError(f"GateConfig.ticks_remembered: {self.ticks_remembered} is below 1")


class CommandGate:
    """One controlling client at a time; sessions are numbered by the arm, upwards, never reused."""

    def __init__(self, config: GateConfig, first_session: int) -> None:
        self._config = config
        self._next_session = first_session
        self._sent: deque[tuple[int, float]] = deque(maxlen=config.ticks_remembered)
        self._holder = ""
        self._heard_s = 0.0
        self._target_s = 0.0
        self.controller = ""
        self.session = 0
        self.last_seq = 0
        self.dropped: Counter[str] = Counter()

    def note_state(self, tick: int, now_s: float) -> None:
        """State ``tick`` leaves at ``now_s``."""
        self._sent.append((tick, now_s))

    def take_control(self, client_id: str, name: str, now_s: float) -> int:
        """Give ``client_id`` control in a new session; MessageError(BUSY) while another one has it."""
        if self._holder not in ("", client_id):
            raise MessageError(Reason.BUSY, f"hello.control: '{self.controller}' is in control of this arm")
        self._holder, self.controller = client_id, name
        self.session, self._next_session = self._next_session, self._next_session + 1
        self.last_seq, self._heard_s, self._target_s = 0, now_s, -1.0
        return self.session

    def release(self, client_id: str) -> None:
        """The client is gone or gives up control."""
        if client_id == self._holder:
            self._holder, self.controller, self.session, self._target_s = "", "", 0, -1.0

    def admit(self, client_id: str, header: Header, now_s: float) -> None:
        """Let a command pass, or MessageError with the reason. A refused command feeds no watchdog."""
        if client_id != self._holder:
            raise MessageError(Reason.NOT_IN_CONTROL, "this client has no control, say hello with control: true")
        if header.session != self.session:
            raise MessageError(Reason.OLD_SESSION, f"session {header.session}, the one in control is {self.session}")
        if header.seq <= self.last_seq:
            raise MessageError(Reason.REPLAYED, f"seq {header.seq} is not above {self.last_seq}")
        age_s = now_s - self._sent_at(header.echo_tick)
        limit_s = min(header.max_age_s, self._config.command_age_limit_s)
        if age_s > limit_s:
            raise MessageError(Reason.EXPIRED, f"{1e3 * age_s:.0f} ms old, limit {1e3 * limit_s:.0f} ms")
        self.last_seq = header.seq
        self._heard_s = now_s

    def _sent_at(self, tick: int) -> float:
        """When state ``tick`` left [s, arm clock]."""
        if not self._sent or tick > self._sent[-1][0]:
            raise MessageError(Reason.MALFORMED, f"echo_tick {tick} was never sent")
        index = tick - self._sent[0][0]
        if index < 0:
            raise MessageError(Reason.EXPIRED, f"echo_tick {tick} is long past")
        return self._sent[index][1]

    def target_accepted(self, now_s: float) -> None:
        """A target passed all checks."""
        self._target_s = now_s

    def step(self, now_s: float) -> bool:
        """Watchdogs, once a tick. True: follow the target; False: hold. A silent client loses control."""
        if self._holder and now_s - self._heard_s > self._config.heartbeat_timeout_s:
            self.release(self._holder)
        return self._target_s >= 0.0 and now_s - self._target_s <= self._config.target_timeout_s
