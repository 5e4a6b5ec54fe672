"""The energy ledger of a session: what was granted is what is in the tanks, in flight, out, or vented."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from saras.recording import Session, Topic

Floats = NDArray[np.float64]

TANKS = ("tank_master", "tank_slave", "port_guard_left", "port_guard_right")
_TERMS = ("energy_J", "work_out_J", "sent_J", "received_J", "vented_J", "granted_J")


@dataclass(frozen=True)
class Account:
    """One tank at the end of the session, in joules, summed over its restarts."""

    name: str
    energy_J: float
    work_out_J: float
    sent_J: float
    received_J: float
    vented_J: float
    granted_J: float
    lowest_J: float
    minimum_J: float  #: the configured floor
    residual_J: float  #: worst |energy + out + sent + vented - received - granted| of all messages
    sessions: int


@dataclass(frozen=True)
class Ledger:
    """All tanks together. ``missing`` names tanks that were not recorded: then flight is not known."""

    accounts: list[Account]
    missing: list[str]

    @property
    def flight_J(self) -> float | None:
        """Energy between tanks: sent and not yet credited. None when a tank is missing."""
        if self.missing:
            return None
        return sum(account.sent_J - account.received_J for account in self.accounts)

    @property
    def scale_J(self) -> float:
        """What a residual is compared with."""
        return max(1.0, *(abs(a.granted_J) + abs(a.work_out_J) + a.sent_J + a.received_J for a in self.accounts))

    @property
    def residual_J(self) -> float:
        """Worst residual of any tank."""
        return max(account.residual_J for account in self.accounts)


def ledger(session: Session) -> Ledger | None:
    """Accounts of all recorded tanks; None when none was recorded."""
    accounts, missing = [], []
    for name in TANKS:
        tank = session.tank(name)
        if tank is None:
            missing.append(name)
        else:
            accounts.append(account(name, tank))
    return Ledger(accounts, missing) if accounts else None


def residual(tank: Topic) -> Floats:
    """(n,) energy + out + sent + vented - received - granted of each message [J]; 0 when the books are right."""
    e, out, sent, received, vented, granted = (tank[term].astype(float) for term in _TERMS)
    return np.asarray(e + out + sent + vented - received - granted)


def account(name: str, tank: Topic) -> Account:
    """Sums a tank's columns over its sessions: cumulative values start again at each restart."""
    ends = np.append(np.flatnonzero(np.diff(tank["session"].astype(np.int64)) != 0), len(tank) - 1)
    total = {term: float(tank[term][ends].sum()) for term in _TERMS}
    # A tank that was never charged lies at its floor.
    charged = tank["granted_J"] > tank["minimum_J"] * (1 + 1e-9)
    lowest = float(tank["energy_J"][charged].min()) if charged.any() else float("nan")
    return Account(
        name,
        float(tank["energy_J"][-1]),
        total["work_out_J"],
        total["sent_J"],
        total["received_J"],
        total["vented_J"],
        total["granted_J"],
        lowest,
        float(tank["minimum_J"][-1]),
        float(np.abs(residual(tank)).max()),
        len(ends),
    )
