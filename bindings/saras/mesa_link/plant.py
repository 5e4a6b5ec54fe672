"""What stands behind the arm's server: the interface to the machine, simulated or not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from saras.mesa_link.protocol import MaxVelocity, Target, Tool, Truth


@dataclass(frozen=True)
class ArmSample:
    """One sample of the machine, in the base frame, SI. Fields as in :class:`saras.mesa_link.protocol.State`."""

    joints: tuple[float, ...]
    joint_velocities: tuple[float, ...]
    jaw: float
    passive: tuple[float, ...]
    position: tuple[float, ...]
    quaternion: tuple[float, ...]
    rcm: tuple[float, ...]
    mode: str
    brakes: bool
    target: Target  # that the servo used at this sample
    wrench: tuple[float, ...] | None = None
    fault: str = ""


class ArmPlant(Protocol):
    """A machine that the server drives from one thread. Refusals are MessageError with the reason."""

    def follow(self, target: Target) -> None:
        """Take a new tip target; UNREACHABLE leaves the old one in effect."""

    def hold(self) -> None:
        """Stop: the measured position becomes the target. Calling it again changes nothing."""

    def move_tool(self, tool: Tool) -> None:
        """Command jaw and roll."""

    def set_max_velocity(self, bounds: MaxVelocity) -> None:
        """Bound the motion; the machine's own limits stay."""

    def set_rcm(self, position: tuple[float, ...]) -> None:
        """Set the trocar [m, base frame]; called at rest only."""

    def set_mode(self, mode: str) -> None:
        """Choose pivot or parallel; called at rest only."""

    def brake(self, on: bool) -> None:
        """Lock or release the positioning arm; called at rest only."""

    def step(self, duration_s: float) -> None:
        """Let time pass."""

    def sample(self) -> ArmSample:
        """The state after the last step."""

    def truth(self, tick: int) -> Truth | None:
        """Ground truth of a simulation, None from a machine."""
