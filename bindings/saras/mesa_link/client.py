"""Our Socket.IO driver: what a caller may ask of an arm, checked before it goes to the connection's thread."""

from __future__ import annotations

import math
import time

import numpy as np
from numpy.typing import NDArray

from saras.mesa_link.connection import Command, Connection, LinkTimes
from saras.mesa_link.driver import ArmDriver, ArmLinkError, LinkStats, Received, StateCallback, TruthCallback
from saras.mesa_link.poses import angle_between, to_target
from saras.mesa_link.protocol import PROTOCOL_VERSION, Hello, MaxVelocity, State, Tool

# A target this long after the last one is a new beginning: it must start from the measured pose again.
_PAUSE_S = 0.25


class SocketIoArmDriver(ArmDriver):
    """See ArmDriver. ``control`` False makes a reader, of which there may be any number."""

    def __init__(
        self,
        url: str,
        client: str,
        *,
        control: bool = True,
        state_rate_hz: float = 1000.0,
        truth_rate_hz: float = 0.0,
        times: LinkTimes | None = None,
        start_distance_m: float = 0.02,
        start_angle_rad: float = 0.35,
        on_state: StateCallback | None = None,
        on_truth: TruthCallback | None = None,
    ) -> None:
        """``state_rate_hz``: states wanted, at most the arm's own rate; ``truth_rate_hz``: a simulation's truths.
        ``start_*``: how near to the measured pose the first target after a pause, or of a session, must lie.
        Callbacks run in the connection's thread.
        """
        self._url = url
        self._times = times or LinkTimes()
        self._start_distance_m, self._start_angle_rad = start_distance_m, start_angle_rad
        self._last_target = (0, -math.inf)  # session, local time
        hello = Hello(PROTOCOL_VERSION, client, control, state_rate_hz, truth_rate_hz)
        self._connection = Connection(url, hello, self._times, on_state, on_truth)

    def connect(self, timeout_s: float) -> None:
        """See ArmDriver."""
        self._connection.start()
        if not self._connection.first_state.wait(timeout_s):
            reason = self._connection.stats().last_error or "connected, but it sends no state"
            raise ArmLinkError(f"{self._url}: no state from the arm within {timeout_s:g} s ({reason})")

    def close(self) -> None:
        """See ArmDriver."""
        self._connection.stop()

    def latest_state(self) -> Received | None:
        """See ArmDriver."""
        return self._connection.latest

    def stats(self) -> LinkStats:
        """See ArmDriver."""
        return self._connection.stats()

    def command_pose(self, base_T_tip: NDArray[np.float64]) -> None:
        """See ArmDriver. ValueError when it is not a pose."""
        target = to_target(np.asarray(base_T_tip, dtype=np.float64))
        state, session = self._commandable()
        now = time.monotonic()
        if self._last_target[0] != session or now - self._last_target[1] > _PAUSE_S:
            distance = math.dist(target.position, state.position)
            angle = angle_between(target.quaternion, state.quaternion)
            if distance > self._start_distance_m or angle > self._start_angle_rad:
                raise ArmLinkError(
                    f"the first target must start from the measured pose: {1e3 * distance:.1f} mm and {angle:.3f} rad "
                    f"away, allowed {1e3 * self._start_distance_m:.1f} mm and {self._start_angle_rad:g} rad"
                )
        self._last_target = (session, now)
        self._connection.put(Command("set_target", target, state.tick, session))

    def command_tool(self, tool: Tool) -> None:
        """See ArmDriver."""
        state, session = self._commandable()
        self._connection.put(Command("tool", tool, state.tick, session))

    def set_max_velocity(self, bounds: MaxVelocity, timeout_s: float = 1.0) -> None:
        """See ArmDriver."""
        self._request("set_max_velocity", timeout_s, linear_m_s=bounds.linear_m_s, angular_rad_s=bounds.angular_rad_s)

    def set_rcm(self, position: tuple[float, ...], timeout_s: float = 1.0) -> None:
        """See ArmDriver."""
        self._request("set_rcm", timeout_s, position=list(position))

    def set_mode(self, mode: str, timeout_s: float = 1.0) -> None:
        """See ArmDriver."""
        self._request("set_mode", timeout_s, mode=mode)

    def brake(self, on: bool, timeout_s: float = 1.0) -> None:
        """See ArmDriver."""
        self._request("brake", timeout_s, on=on)

    def inject(self, kind: str, timeout_s: float = 1.0, **fields: object) -> None:
        """Ask a simulated arm that allows it to show a fault (see faults)."""
        self._connection.request("inject", {"kind": kind, **fields}, timeout_s)

    def _request(self, event: str, timeout_s: float, **fields: object) -> None:
        state, _ = self._commandable()
        self._connection.request(event, dict(fields), timeout_s, echo_tick=state.tick)

    def _commandable(self) -> tuple[State, int]:
        """Newest state and session, or ArmLinkError when nothing may be sent now."""
        in_control, session, error = self._connection.standing()
        if not in_control:
            raise ArmLinkError(f"{self._url}: not in control ({error or 'connecting'})")
        latest = self._connection.latest
        age_s = math.inf if latest is None else time.monotonic() - latest.received_s + latest.lag_s
        if latest is None or age_s > self._times.stale_s:
            raise ArmLinkError(f"{self._url}: the arm's state is {1e3 * age_s:.0f} ms old")
        return latest.state, session
