"""Datagrams between consoles, slave arms and the platform (docs/protocols.md), and what a receiver needs around them.

Authentication is in ``saras.net.trust``, its key file in ``saras.net.keys``.

Pure: no sockets, no clocks. ``TouchballUp.decode(data)`` and ``packet.encode()`` refuse with
``saras.ProtocolError`` what the other end would refuse; nothing half-decoded is ever handed out.
"""

from saras._core.net import (
    CSA_MAX_JOINTS,
    ChannelState,
    CsaDown,
    CsaHandshake,
    CsaHold,
    CsaMode,
    CsaSlaveState,
    CsaUp,
    GuardState,
    LinkAge,
    PortLedger,
    ReplayVerdict,
    ReplayWindow,
    SequenceCounts,
    SequenceFilter,
    SimballJoints,
    TouchballDown,
    TouchballDownSide,
    TouchballHandshake,
    TouchballUp,
    TouchballUpSide,
    crc32,
    seal,
)

__all__ = [
    "CSA_MAX_JOINTS",
    "ChannelState",
    "CsaDown",
    "CsaHandshake",
    "CsaHold",
    "CsaMode",
    "CsaSlaveState",
    "CsaUp",
    "GuardState",
    "LinkAge",
    "PortLedger",
    "ReplayVerdict",
    "ReplayWindow",
    "SequenceCounts",
    "SequenceFilter",
    "SimballJoints",
    "TouchballDown",
    "TouchballDownSide",
    "TouchballHandshake",
    "TouchballUp",
    "TouchballUpSide",
    "crc32",
    "seal",
]
