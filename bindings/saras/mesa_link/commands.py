"""From a command's JSON to what the machine does about it. Each command is checked in full before anything moves."""

from __future__ import annotations

from collections.abc import Callable

from saras.mesa_link.fields import MessageError, Reader
from saras.mesa_link.gate import CommandGate
from saras.mesa_link.plant import ArmPlant
from saras.mesa_link.protocol import MODES, Header, MaxVelocity, Reason, Target, Tool

Action = Callable[[float], None]  # takes the arm's monotonic time [s]


class CommandTable:
    """The commands of the protocol over one machine and its gate."""

    def __init__(self, plant: ArmPlant, gate: CommandGate) -> None:
        self._plant = plant
        self._gate = gate
        self.in_effect = (0, 0)  # session and seq of the target that the machine follows

    def obey(self, event: str, client_id: str, data: object, now_s: float) -> None:
        """Check, pass the gate, act. MessageError with the reason when any of them refuses."""
        read = Reader(event, data)
        header = Header.read(read)
        action = self._action(event, read, header)
        self._gate.admit(client_id, header, now_s)
        action(now_s)

    def _action(self, event: str, read: Reader, header: Header) -> Action:
        if event == "set_target":
            target = Target.read(read)
            return lambda now_s: self._follow(target, header, now_s)
        if event == "tool":
            tool = Tool.read(read)
            return lambda _: self._plant.move_tool(tool)
        if event == "set_max_velocity":
            bounds = MaxVelocity.read(read)
            return lambda _: self._plant.set_max_velocity(bounds)
        if event == "set_rcm":
            position = read.vector("position", 3)
            return self._at_rest(event, lambda _: self._plant.set_rcm(position))
        if event == "set_mode":
            mode = read.text("mode", MODES)
            return self._at_rest(event, lambda _: self._plant.set_mode(mode))
        if event == "brake":
            on = read.boolean("on")
            return self._at_rest(event, lambda _: self._plant.brake(on))
        if event == "heartbeat":
            return lambda _: None
        raise MessageError(Reason.UNSUPPORTED, f"{event}: no such command")

    def _follow(self, target: Target, header: Header, now_s: float) -> None:
        try:
            self._plant.follow(target)
        except MessageError as error:
            if error.reason == Reason.UNREACHABLE:
                # The sender is alive: the arm stays at its last reachable target, it does not let go.
                self._gate.target_accepted(now_s)
            raise
        self._gate.target_accepted(now_s)
        self.in_effect = (header.session, header.seq)

    def _at_rest(self, event: str, action: Action) -> Action:
        def act(now_s: float) -> None:
            if self._gate.step(now_s):
                raise MessageError(Reason.MOVING, f"{event}: allowed only while the arm holds")
            action(now_s)

        return act
