"""The rows of the fault catalogue that the fault tests answer for: number → (fault, required).

Everywhere: no set-point step larger than v_max · dt, no NaN leaves the system, an event is logged, the displayed state
is right. HOLD: slave velocity zero, force to the hand ramped to zero within 100 ms, latched, shown to the operator,
left only by an explicit engage. Times are those of a real-time host; the separate graph's limits are in config/.
"""

from __future__ import annotations

ROWS: dict[int, tuple[str, str]] = {
    1: ("isolated UDP loss", "up to 2 gaps bridged, flagged; motion goes on"),
    2: ("loss burst 20 ms – 5 s", "HOLD beyond the console's limit; re-engage"),
    3: ("reordering", "newest wins, no backward motion"),
    4: ("duplicates", "applied once, energy included"),
    5: ("replay, also of an earlier session", "rejected; window not moved"),
    6: ("forged, or sequence far ahead", "rejected; sequence unchanged"),
    7: ("truncated, oversized, flipped bits", "rejected before parsing"),
    8: ("NaN / Inf in any field", "rejected; does not feed the watchdog; no made-up zero"),
    9: ("UDP flood", "control held; drops counted"),
    10: ("bunched late packets", "over-age dropped; no catch-up burst"),
    11: ("console dies", "HOLD for that console alone"),
    12: ("console freezes, resumes", "HOLD; backlog discarded"),
    13: ("console restarts with sequence 0", "new session handshake, re-engage"),
    14: ("arm socket drops", "HOLD for that channel; the other arm goes on"),
    15: ("half-open TCP to an arm", "own heartbeat ≥ 10 Hz notices"),
    16: ("client reconnects with buffered commands", "none reaches the arm"),
    17: ("arm reports a frozen pose", "stale content → HOLD"),
    18: ("pose jump of 50 mm", "rejected, HOLD"),
    32: ("tank empties", "command goes to zero smoothly; damping stays; operator told"),
    33: ("energy packets lost or doubled", "energy never created"),
    34: ("damping of wrong sign", "refused"),
    35: ("clock steps by ±1 h", "dt monotonic; tank unchanged"),
    36: ("500 ms stall", "integrates at most one nominal dt, then HOLD"),
    37: ("node restarts with the arm away from its start", "re-initialised from measured; no jump"),
    38: ("integrator drift", "within 1 mm of measured, or HOLD"),
    39: ("quaternion not normalised, zero, sign flip", "normalised, rejected, shortest arc"),
    40: ("workspace or joint limit", "stops at the limit; resisting force within passivity"),
    42: ("clutch while moving", "decelerates; no jump on release"),
    43: ("clutch packet lost", "level coded and repeated; missing = disengaged"),
    44: ("two operators, one arm", "one lease holder; the second refused"),
    45: ("duplicate node name", "the survivor HOLDs; alarm"),
    46: ("roscore killed", "links go on; alarm; no new engagement"),
    47: ("roscore hung", "no control thread blocks"),
    48: ("parameter missing, NaN or out of range", "start refused, naming it"),
    57: ("E-stop with another fault", "latched within one cycle; reset alone never moves"),
    58: ("SIGTERM or kill of any process", "HOLD comes from the receiver's watchdog"),
}
