"""What goes wrong without a HOLD, in one line of /system/events at a time: refused datagrams, an empty tank. Pure."""

from __future__ import annotations

from collections.abc import Mapping

#: of a console link's counts: those that are not news
WELL = ("accepted", "sessions", "handshakes")
REPEAT_S = 10.0
EMPTY_ABOVE, REFILLED_BELOW = 0.95, 0.5


class LinkFaults:
    """Tells what a console's link lost or refused: at once, then the sum of each ten seconds."""

    def __init__(self, operator: str) -> None:
        self._operator = operator
        self._told: dict[str, int] = {}
        self._due_s = float("-inf")

    def update(self, counts: Mapping[str, int], now_s: float) -> str:
        """counts: since the start, by kind. now_s: monotonic. The line to publish; "" when there is nothing to tell."""
        bad = {kind: n for kind, n in counts.items() if kind not in WELL}
        if not self._told:
            self._told = dict.fromkeys(bad, 0)
        news = {kind: n - self._told.get(kind, 0) for kind, n in bad.items() if n > self._told.get(kind, 0)}
        if not news or now_s < self._due_s:
            return ""
        self._told, self._due_s = bad, now_s + REPEAT_S
        kinds = ", ".join(f"{n} {kind.replace('_', ' ')}" for kind, n in news.items())
        return f"datagrams of {self._operator} not taken: {kinds} → check the console and its link"


class TankFaults:
    """Tells when a tank is so empty that it lets nothing pass, and when it lets again."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._empty = False

    def update(self, reduction: float, energy_J: float) -> str:
        """reduction: 0 … 1 of what the tank was asked for is withheld. The line to publish; "" when nothing changed."""
        if not self._empty and reduction > EMPTY_ABOVE:
            self._empty = True
            what = "motion" if self._name == "tank_slave" else "force"
            return f"{self._name}: empty ({1e3 * energy_J:.0f} mJ), {what} is withheld → engage again to charge it"
        if self._empty and reduction < REFILLED_BELOW:
            self._empty = False
            return f"{self._name}: has energy again ({1e3 * energy_J:.0f} mJ)"
        return ""
