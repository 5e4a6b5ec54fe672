"""Messages of an energy tank, wherever it lives: in a node, in the real-time loop, in a console's port guard."""

from __future__ import annotations

from typing import Any

from saras_ros1.msg import TankExchange, TankState
from saras_ros1.stamped import time_of


def exchange(session: int, seq: int, sent_J: float, *, wishes: Any, stamp_ns: int) -> TankExchange:
    """A ledger message to a peer. wishes: has .requesting and .has_room of the tank that sends it."""
    message = TankExchange(
        session=session, seq=seq, sent_J=sent_J, requesting=wishes.requesting, has_room=wishes.has_room
    )
    message.header.stamp = time_of(stamp_ns)
    return message


def state(
    session: int, seq: int, *, levels: Any, out: Any, sums: Any, sent_J: float, wishes: Any, stamp_ns: int
) -> TankState:
    """levels: has minimum_J … maximum_J; out: energy_J, reduction, scale, damping (6,), status; sums: the cumulative
    work_out_J, received_J, vented_J, granted_J; wishes: requesting, has_room. One object may be several of them.
    """
    message = TankState(
        seq=seq,
        session=session,
        energy_J=out.energy_J,
        minimum_J=levels.minimum_J,
        request_J=levels.request_J,
        available_J=levels.available_J,
        maximum_J=levels.maximum_J,
        reduction=out.reduction,
        scale=out.scale,
        damping=out.damping.tolist(),
        work_out_J=sums.work_out_J,
        received_J=sums.received_J,
        sent_J=sent_J,
        vented_J=sums.vented_J,
        granted_J=sums.granted_J,
        requesting=wishes.requesting,
        has_room=wishes.has_room,
        status=out.status.name,
    )
    message.header.stamp = time_of(stamp_ns)
    return message
