"""Authenticated sessions of Touchball UDP and CSA UDP (docs/protocols.md): one end each for console and platform.

No socket and no clock: bytes and monotonic times go in, bytes and packets come out. Tags are HMAC-SHA-256 of Python's
own ``hmac`` (OpenSSL), truncated to 16 bytes.

A session is proved fresh by two random nonces: each end believes only what its peer has made with a nonce that this end
drew for this very handshake. The keys of a session are derived from both nonces, so that a datagram of any other
session fails at its tag; within the session a replay window refuses what was received before.
"""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Callable
from typing import Generic, TypeVar, Union

from saras import ProtocolError
from saras._core.net import (
    TRAILER_SIZE,
    CsaDown,
    CsaHandshake,
    CsaUp,
    ReplayVerdict,
    ReplayWindow,
    TouchballDown,
    TouchballHandshake,
    TouchballUp,
    seal,
)
from saras.net.keys import Keys

TAG_BYTES = 16
NONCE_BYTES = 16
NONE = bytes(NONCE_BYTES)  #: echo of an end that has heard no nonce
LABEL = b"saras touchball session 1"  #: begins unlike any datagram, so that no datagram's tag is a session key
CSA_LABEL = b"saras csa session 1"

RETRY_NS = 100_000_000  #: between two messages of a console's handshake
UNHEARD_NS = 500_000_000  #: a console that the platform has not shown to hear for so long asks for a new session
LIFETIME_NS = 2_000_000_000  #: of a nonce that waits for its echo: no message of a handshake is believed later
REDRAW_NS = 1_000_000_000  #: a nonce that waits is drawn anew then, but no question can force it earlier
TAKEOVER_NS = 200_000_000  #: a console that is heard keeps its session; a silent one loses it to the next

#: what an end counts: sessions begun, and refusals by name
COUNTS = (
    "handshakes",
    "unauthenticated",  # no tag, or one of another key or session: forged, damaged, replayed from an earlier session
    "replayed",  # within the session
    "too_old",  # behind the replay window
    "far_ahead",  # sequence further ahead than a sender gets
    "handshake_refused",  # echoes no nonce that waits: a replayed message, or one that came too late
    "busy",  # asks for a session while another console is heard
)

_REPLAYS = {
    ReplayVerdict.REPLAYED: ("replayed", "received before in this session"),
    ReplayVerdict.TOO_OLD: ("too_old", "behind the replay window"),
    ReplayVerdict.FAR_AHEAD: ("far_ahead", "further ahead than a sender gets"),
}

Draw = Callable[[int], bytes]
Message = Union[TouchballHandshake, CsaHandshake]
Outgoing = TypeVar("Outgoing", TouchballUp, TouchballDown, CsaUp, CsaDown)
Incoming = TypeVar("Incoming", TouchballUp, TouchballDown, CsaUp, CsaDown)


class TrustError(ProtocolError):  # type: ignore[misc]
    """A datagram that is not believed; ``count`` is its name among COUNTS."""

    def __init__(self, count: str, reason: str) -> None:
        super().__init__(reason)
        self.count = count


class Session:
    """Keys of one session, and when its peer was last heard (at first: when it began)."""

    __slots__ = ("console_nonce", "down_key", "heard_ns", "is_heard", "platform_nonce", "up_key")

    def __init__(
        self, keys: Keys, console_nonce: bytes, platform_nonce: bytes, now_ns: int, label: bytes = LABEL
    ) -> None:
        self.console_nonce, self.platform_nonce = console_nonce, platform_nonce
        context = label + console_nonce + platform_nonce
        self.up_key = hmac.digest(keys.up, context, "sha256")
        self.down_key = hmac.digest(keys.down, context, "sha256")
        self.heard_ns = now_ns
        self.is_heard = False


def tag(key: bytes, data: bytes) -> bytes:
    """HMAC-SHA-256 of a whole datagram's bytes before its trailer, truncated to 16 bytes."""
    return hmac.digest(key, data[:-TRAILER_SIZE], "sha256")[:TAG_BYTES]


def has_tag(key: bytes, data: bytes) -> bool:
    """Whether the datagram carries the tag that this key gives it."""
    return hmac.compare_digest(tag(key, data), data[-TRAILER_SIZE : TAG_BYTES - TRAILER_SIZE])


class End(Generic[Outgoing, Incoming]):
    """What both ends do alike. The session is replaced whole, so that another thread may seal meanwhile."""

    _incoming: type[Incoming]
    _message: type[Message] = TouchballHandshake
    _label = LABEL

    def __init__(self, keys: Keys, send_key: bytes, receive_key: bytes, draw: Draw) -> None:
        self._keys, self._send_key, self._receive_key = keys, send_key, receive_key
        self._draw = draw
        self._window = ReplayWindow()
        self.session: Session | None = None
        self.counts = dict.fromkeys(COUNTS, 0)

    def _data_keys(self, session: Session) -> tuple[bytes, bytes]:
        """(send, receive) keys of a session."""
        raise NotImplementedError

    def seal(self, packet: Outgoing) -> bytes | None:
        """The datagram, or None while there is no session."""
        session = self.session
        if session is None:
            return None
        data: bytes = packet.encode(True)
        return seal(data, tag(self._data_keys(session)[0], data))

    def open(self, data: bytes, now_ns: int) -> Incoming:
        """The packet of a datagram that is new in this session. Raises ProtocolError (TrustError: not believed).

        Order: frame, tag, fields, replay. What fails earlier changes nothing that a later check looks at.
        """
        self._check_frame(data)
        session = self.session
        if session is None or not has_tag(self._data_keys(session)[1], data):
            raise self._refused(
                "unauthenticated",
                "authentication: not of this session (forged, damaged, of an earlier session or of another key file)",
            )
        packet = self._incoming.decode(data, True)
        if not session.is_heard and now_ns - session.heard_ns > LIFETIME_NS:
            # Who holds datagrams back could otherwise begin a session with old ones: their age has no measure yet.
            raise self._refused("handshake_refused", "the first datagram of its session, and that began long ago")
        verdict = self._window.accept(packet.seq)
        if verdict != ReplayVerdict.NEW:
            count, reason = _REPLAYS[verdict]
            raise self._refused(count, f"seq = {packet.seq}: {reason} (newest {self._window.newest})")
        session.heard_ns, session.is_heard = now_ns, True
        return packet

    def _check_frame(self, data: bytes) -> None:
        try:
            self._incoming.check_frame(data, True)
        except ProtocolError as error:
            try:
                self._incoming.check_frame(data, False)
            except ProtocolError:
                raise error from None
            raise self._refused("unauthenticated", str(error)) from None  # good, but of a sender without a key

    def _open_handshake(self, data: bytes) -> Message:
        self._message.check_frame(data)
        if not has_tag(self._receive_key, data):
            raise self._refused("unauthenticated", "handshake: forged, damaged or of another key file")
        return self._message.decode(data)

    def _handshake(self, nonce: bytes, echo: bytes) -> bytes:
        data: bytes = self._message(nonce=nonce, echo=echo).encode()
        return seal(data, tag(self._send_key, data))

    def _adopt(self, console_nonce: bytes, platform_nonce: bytes, now_ns: int) -> None:
        self._window.reset()
        self.session = Session(self._keys, console_nonce, platform_nonce, now_ns, self._label)
        self.counts["handshakes"] += 1

    def _refused(self, count: str, reason: str) -> TrustError:
        self.counts[count] += 1
        return TrustError(count, reason)


class AskingEnd(End[Outgoing, Incoming]):
    """The end that asks for sessions: at its start, and when the platform does not show that it hears."""

    def __init__(self, keys: Keys, draw: Draw = secrets.token_bytes) -> None:
        super().__init__(keys, keys.up, keys.down, draw)
        self._asked: bytes | None = None
        self._asked_ns = self._next_ns = self._proven_ns = 0
        self._confirmation: bytes | None = None

    def _data_keys(self, session: Session) -> tuple[bytes, bytes]:
        return session.up_key, session.down_key

    def handshake_due(self, now_ns: int) -> bytes | None:
        """The message to send now, if one is due. Call it at the send rate."""
        if self._next_ns and now_ns < self._next_ns:
            return None
        waited_ns = now_ns - self._proven_ns
        if self.session is not None and waited_ns < UNHEARD_NS:
            if self._confirmation is not None:
                self._next_ns = now_ns + RETRY_NS
            return self._confirmation
        self._next_ns = now_ns + RETRY_NS
        if self._asked is None or now_ns - self._asked_ns > REDRAW_NS:
            self._asked, self._asked_ns = self._draw(NONCE_BYTES), now_ns
        return self._handshake(self._asked, NONE)

    def handshake(self, data: bytes, now_ns: int) -> bytes | None:
        """Takes the platform's answer; returns the confirmation to send. Raises ProtocolError."""
        answer = self._open_handshake(data)
        if self.session is not None and answer.echo == self.session.console_nonce:
            return None  # to a question that was sent twice
        if self._asked is None or answer.echo != self._asked or now_ns - self._asked_ns > LIFETIME_NS:
            raise self._refused("handshake_refused", "handshake: answers no question that waits")
        self._confirmation = self._handshake(self._asked, answer.nonce)
        self._adopt(self._asked, answer.nonce, now_ns)
        self._asked, self._proven_ns, self._next_ns = None, now_ns, now_ns + RETRY_NS
        return self._confirmation

    def open(self, data: bytes, now_ns: int) -> Incoming:
        """As End.open. A datagram under the session's keys shows that the platform has begun it, too."""
        packet: Incoming = super().open(data, now_ns)  # type: ignore[assignment]
        self._confirmation = None
        return packet

    def hears_us(self, now_ns: int) -> None:
        """The platform has shown (by its echo) that it hears this console: no other session is wanted."""
        self._proven_ns, self._asked = now_ns, None


class AnsweringEnd(End[Outgoing, Incoming]):
    """The end that answers. It keeps no state for a question, and a question changes nothing."""

    def __init__(self, keys: Keys, draw: Draw = secrets.token_bytes) -> None:
        super().__init__(keys, keys.down, keys.up, draw)
        self._challenge: bytes | None = None
        self._drawn_ns = 0

    def _data_keys(self, session: Session) -> tuple[bytes, bytes]:
        return session.down_key, session.up_key

    def handshake(self, data: bytes, now_ns: int) -> bytes | None:
        """Takes a question or a confirmation; returns the answer to a question. Raises ProtocolError."""
        message = self._open_handshake(data)
        session = self.session
        if session is not None:
            if (message.nonce, message.echo) == (session.console_nonce, session.platform_nonce):
                return None  # a confirmation that came twice
            if now_ns - session.heard_ns < TAKEOVER_NS:
                raise self._refused("busy", "handshake: another console, or another run of it, is being heard")
        if message.echo == NONE:
            if self._challenge is None or now_ns - self._drawn_ns > REDRAW_NS:
                self._challenge, self._drawn_ns = self._draw(NONCE_BYTES), now_ns
            return self._handshake(self._challenge, message.nonce)
        if message.echo != self._challenge or now_ns - self._drawn_ns > LIFETIME_NS:
            raise self._refused("handshake_refused", "handshake: confirms no challenge that waits")
        self._challenge = None  # once only: a replay of this message begins nothing
        self._adopt(message.nonce, message.echo, now_ns)
        return None


class ConsoleEnd(AskingEnd[TouchballUp, TouchballDown]):
    """The console's end of Touchball UDP."""

    _incoming = TouchballDown


class PlatformEnd(AnsweringEnd[TouchballDown, TouchballUp]):
    """The platform's end of Touchball UDP."""

    _incoming = TouchballUp


class CsaSlaveEnd(AskingEnd[CsaUp, CsaDown]):
    """The slave's end of CSA UDP: the console of that protocol."""

    _incoming, _message, _label = CsaDown, CsaHandshake, CSA_LABEL


class CsaPlatformEnd(AnsweringEnd[CsaDown, CsaUp]):
    """The platform's end of CSA UDP."""

    _incoming, _message, _label = CsaUp, CsaHandshake, CSA_LABEL
