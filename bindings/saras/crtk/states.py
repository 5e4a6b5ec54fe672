"""CRTK's state machine as a table."""

from __future__ import annotations

from dataclasses import dataclass

STATES = ("DISABLED", "ENABLED", "PAUSED", "FAULT")
COMMANDS = ("enable", "disable", "pause", "resume", "home", "unhome")

# (state, command) → next state. What is not here is invalid. From FAULT, enable and disable are retries.
TRANSITIONS = {
    ("DISABLED", "enable"): "ENABLED",
    ("DISABLED", "disable"): "DISABLED",
    ("DISABLED", "home"): "ENABLED",  # as the dVRK does: homing powers the arm
    ("DISABLED", "unhome"): "DISABLED",
    ("ENABLED", "enable"): "ENABLED",
    ("ENABLED", "disable"): "DISABLED",
    ("ENABLED", "pause"): "PAUSED",
    ("ENABLED", "home"): "ENABLED",
    ("ENABLED", "unhome"): "ENABLED",
    ("PAUSED", "disable"): "DISABLED",
    ("PAUSED", "pause"): "PAUSED",
    ("PAUSED", "resume"): "ENABLED",
    ("FAULT", "enable"): "ENABLED",
    ("FAULT", "disable"): "DISABLED",
}


@dataclass
class StateMachine:
    """State and flags. Commands are refused by ValueError, and then change nothing."""

    state: str = "DISABLED"
    is_homed: bool = False
    is_busy: bool = False

    def command(self, text: str) -> None:
        """Follows the table. Raises ValueError naming command and state."""
        if text not in COMMANDS:
            raise ValueError(f"state_command '{text}': must be one of {', '.join(COMMANDS)}")
        target = TRANSITIONS.get((self.state, text))
        if target is None:
            raise ValueError(f"state_command '{text}' is invalid in state {self.state}")
        self.state = target
        if text == "home":
            self.is_homed = True
        elif text == "unhome":
            self.is_homed = False
        if not self.ready:
            self.is_busy = False

    def fault(self) -> None:
        """What only the device itself can do."""
        self.state, self.is_busy = "FAULT", False

    @property
    def ready(self) -> bool:
        """Whether motion commands are obeyed."""
        return self.state == "ENABLED" and self.is_homed


__all__ = ["COMMANDS", "STATES", "TRANSITIONS", "StateMachine"]
