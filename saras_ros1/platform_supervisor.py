"""All sides of the supervisor: ages, faults and operators' words in; states with reason and advice out.

The deciding is saras.safety's (Supervisor, Lease); here are the words around it. No ROS: tests walk through it.
"""

from __future__ import annotations

from typing import NamedTuple

from saras.safety import (
    ChannelInput,
    ChannelMemory,
    Lease,
    OperatorSigns,
    SafetyEvent,
    Supervisor,
    SupervisorConfig,
    SupervisorState,
    crtk_state,
)
from saras.safety import SafetyState as State
from saras_ros1.operator_ask import LEASE_ACTS, Ask
from saras_ros1.watch import Watch, describe

_AGAIN = "engage again when ready"
_STOPPED = (State.HOLD, State.ESTOP)


class SideSigns(NamedTuple):
    """What is seen of one side in one look. fault: text of one that needs no age, such as a pose that jumped."""

    watches: list[Watch]
    fault: str = ""
    fault_advice: str = "look at the arm, then engage again"
    misaligned: str = ""
    clutch: bool = False


class Side:
    """State and words of one side, for reading."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.state = State.WAITING
        self.engagement = 0
        self.may_move = False
        self.reason, self.advice = "nothing was seen yet", ""
        self.misaligned = ""
        self.holder = self.offered_to = 0
        self.lease = Lease()
        self.lost_lease = ""  # why nobody holds it
        self.settled = 0  # looks in a row in which all was there
        self.changes_hands = 0  # looks until the new holder's console is the source of this side

    @property
    def crtk(self) -> str:
        """CRTK's name of this state."""
        return crtk_state(self.state).name


class PlatformSupervisor:
    """Every side with its lease, and one E-stop. update() each look; ask() and estop() are the operators' words.

    A sole operator's console takes free arms by itself; with several an arm is claimed. Silence must be seen in two
    looks in a row, so that one hiccup of this process latches nothing; motion and force do not wait for that, each
    receiver's own watchdog has stopped them at the limit. auto_engage engages each side once, when all was there for
    settle_looks in a row; never out of HOLD. With several operators a side may be engaged hand_over_looks after it got
    a new holder: the change of consoles is a silence that would end the engagement. latched: reason of an E-stop from
    before this process.
    """

    def __init__(
        self,
        sides: tuple[str, ...],
        operators: tuple[str, ...] = ("assistant",),
        *,
        auto_engage: bool = False,
        settle_looks: int = 1,
        hand_over_looks: int = 0,
        latched: str = "",
    ) -> None:
        self.sides = {name: Side(name) for name in sides}
        self.operators = operators
        self._law = Supervisor(SupervisorConfig(channels=len(sides)))
        self._auto = dict.fromkeys(sides, auto_engage)
        self._settle_looks = settle_looks
        self._hand_over_looks = hand_over_looks if len(operators) > 1 else 0
        self._asks: list[Ask] = []
        self._alive = [False] * len(operators)
        self._estop_reason = latched
        if latched:
            memory = [ChannelMemory(state=State.ESTOP, cause=SafetyEvent.ESTOP) for _ in self._law.state.channels]
            self._law.reset(SupervisorState(channels=memory))
            for side in self.sides.values():
                side.state = State.ESTOP
                side.reason, side.advice = latched, "make it safe, reset the E-stop, then engage again"

    @property
    def estop_latched(self) -> str:
        """The reason of the latched E-stop, "" when there is none."""
        return self._estop_reason

    def name_of(self, operator: int) -> str:
        """Of an operator's number; empty for nobody."""
        return self.operators[operator - 1] if 1 <= operator <= len(self.operators) else ""

    def ask(self, ask: Ask) -> None:
        """Answered in the next look."""
        self._asks.append(ask)

    def estop(self, reason: str) -> list[Side]:
        """Stops all sides now; the sides that changed."""
        return self._step({name: SideSigns([]) for name in self.sides}, [], estop=reason)

    def update(
        self, signs: dict[str, SideSigns], alive: list[bool], *, estop: str = "", reset: bool = False
    ) -> list[Side]:
        """One look; the sides whose state changed.

        alive: of each operator, whether its console is heard. estop: why the button counts as pressed, "": it is not.
        """
        asks, self._asks = [ask for ask in self._asks if not ask.withdrawn], []
        self._alive = alive
        for side in self.sides.values():
            self._step_lease(side, [ask for ask in asks if ask.side == side.name])
        signs = {name: self._with_hand_over(self.sides[name], seen) for name, seen in signs.items()}
        asks += self._automatic(signs)
        return self._step(signs, [ask for ask in asks if ask.act not in LEASE_ACTS], estop=estop, reset=reset)

    def _with_hand_over(self, side: Side, signs: SideSigns) -> SideSigns:
        if side.changes_hands == 0:
            return signs
        side.changes_hands -= 1
        return signs._replace(misaligned=f"the console of {self.name_of(side.holder)} takes over: wait a moment")

    def _automatic(self, signs: dict[str, SideSigns]) -> list[Ask]:
        asks = []
        for name, side in self.sides.items():
            there = side.state == State.READY and not signs[name].misaligned
            side.settled = side.settled + 1 if there else 0
            if self._auto[name] and side.settled >= self._settle_looks:
                asks.append(Ask(name, "engage"))
        return asks

    def _step_lease(self, side: Side, asks: list[Ask]) -> None:
        signs = [OperatorSigns(alive=alive) for alive in self._alive]
        mine = {ask.operator: ask for ask in asks if ask.act in LEASE_ACTS}
        if len(self.operators) == 1 and side.holder == 0 and 1 not in mine:
            signs[0].claim = True
        for operator, ask in mine.items():
            field = "offer_to" if ask.act == "offer" else ask.act
            setattr(signs[operator - 1], field, ask.to if ask.act == "offer" else True)
        before = side.holder
        out = side.lease.step(signs, dt=1.0)
        side.holder, side.offered_to = out.holder, out.offered_to
        if before != out.holder:
            side.changes_hands = self._hand_over_looks if out.holder else 0
        if before and before != out.holder:
            silent = not self._alive[before - 1]
            said = "is silent" if silent else "released the arm" if not out.holder else "handed the arm over"
            side.lost_lease = f"the console of {self.name_of(before)} {said}"
        for ask in asks:
            if ask.act in LEASE_ACTS:
                done = mine[ask.operator] is ask and not out.refused[ask.operator - 1]
                done = done and (ask.act != "release" or before == ask.operator)
                ask.answer(done, self._lease_answer(side, ask, done))

    def _lease_answer(self, side: Side, ask: Ask, done: bool) -> str:
        who = self.name_of(side.holder) or "nobody"
        offered = f", offered to {self.name_of(side.offered_to)}" if side.offered_to else ""
        silent = "" if self._alive[ask.operator - 1] else f"; the console of {self.name_of(ask.operator)} is not heard"
        return f"{side.name}: {ask.act} {'done' if done else 'refused'}: held by {who}{offered}{silent}"

    def _step(
        self, signs: dict[str, SideSigns], asks: list[Ask], *, estop: str = "", reset: bool = False
    ) -> list[Side]:
        inputs = []
        for name, side in self.sides.items():
            inputs.append(self._channel_input(side, signs[name], [ask for ask in asks if ask.side == name]))
        if estop:
            self._estop_reason = estop
        elif reset:
            self._estop_reason = ""
        out = self._law.step(inputs, estop=bool(estop), estop_reset=reset, dt=1.0)
        changed = []
        for side, channel in zip(self.sides.values(), out.channels):
            if self._take(side, channel, signs[side.name], [ask for ask in asks if ask.side == side.name]):
                changed.append(side)
        return changed

    def _channel_input(self, side: Side, signs: SideSigns, asks: list[Ask]) -> ChannelInput:
        refused = any(ask.act == "engage" and ask.refusal for ask in asks)
        channel = ChannelInput(
            all_there=bool(signs.watches) and all(w.fresh for w in signs.watches),
            aligned=not signs.misaligned and not refused,
            fault=bool(signs.fault),
            clutch=signs.clutch,
            holder=side.holder,
        )
        for ask in asks:
            if ask.act == "engage":
                channel.engage_by = ask.operator or side.holder
            elif ask.act == "hold":
                channel.hold = True
            elif ask.operator in (0, side.holder):
                channel.disengage = True
        return channel

    def _take(self, side: Side, channel: object, signs: SideSigns, asks: list[Ask]) -> bool:
        before, side.state = side.state, channel.state
        side.engagement, side.may_move = channel.engagement, channel.may_move
        side.misaligned = signs.misaligned if side.state in (State.READY, State.HOLD) else ""
        if side.state != before or channel.event == SafetyEvent.ESTOP:
            self._explain(side, channel.event, signs, asks)
        if side.state in (State.WAITING, State.READY):
            self._explain_waiting(side, signs)
        asked_to_stop = channel.event in (SafetyEvent.HOLD, SafetyEvent.DISENGAGE, SafetyEvent.ESTOP)
        if side.state == State.ENGAGED or asked_to_stop:
            self._auto[side.name] = False
        for ask in asks:
            ask.answer(*self._side_answer(side, ask, signs, before))
        return side.state != before

    def _explain(self, side: Side, event: SafetyEvent, signs: SideSigns, asks: list[Ask]) -> None:
        missing = [w for w in signs.watches if not w.fresh]
        if event == SafetyEvent.ESTOP:
            side.reason, side.advice = self._estop_reason, "make it safe, reset the E-stop, then engage again"
        elif event == SafetyEvent.ESTOP_RESET:
            side.reason, side.advice = "the E-stop was reset", _AGAIN
        elif event == SafetyEvent.HOLD:
            reasons = [ask.reason for ask in asks if ask.act == "hold" and ask.reason]
            side.reason, side.advice = reasons[0] if reasons else "the operator asked", _AGAIN
        elif event == SafetyEvent.FAULT:
            side.reason, side.advice = signs.fault, signs.fault_advice
        elif event == SafetyEvent.DISENGAGE:
            side.reason, side.advice = "disengaged by the operator", ""
        elif event == SafetyEvent.ENGAGE:
            by = f" by {self.name_of(side.holder)}" if len(self.operators) > 1 else ""
            side.reason, side.advice = f"engaged{by}", ""
        elif event == SafetyEvent.LOST and missing:
            side.reason, side.advice = describe(missing), missing[0].advice
        elif event == SafetyEvent.LOST:
            side.reason, side.advice = side.lost_lease or "nobody holds the arm", _AGAIN

    def _explain_waiting(self, side: Side, signs: SideSigns) -> None:
        missing = [w for w in signs.watches if not w.fresh]
        if missing:
            side.reason, side.advice = describe(missing), missing[0].advice
        elif not side.holder:
            side.reason = "nobody holds the arm"
            side.advice = "claim it" if len(self.operators) > 1 else "check the console and its link"
        else:
            side.reason = "all there"
            side.advice = f"to engage: {signs.misaligned}" if signs.misaligned else "engage to begin"

    def _side_answer(self, side: Side, ask: Ask, signs: SideSigns, before: State) -> tuple[bool, str]:
        name = side.name
        if ask.act == "hold":
            return True, f"{name} stands by E-stop" if side.state == State.ESTOP else f"{name} holds"
        if ask.act == "disengage":
            done = side.state not in _STOPPED and side.state != State.ENGAGED
            return done, f"{name} {'disengaged' if done else 'not disengaged'}: {side.reason}"
        by = ask.operator or side.holder
        if side.state == State.ENGAGED and by == side.holder:
            again = " already" if before == State.ENGAGED else f" (number {side.engagement})"
            return True, f"{name} {'is engaged' if again == ' already' else 'engaged'}{again}"
        missing = [w for w in signs.watches if not w.fresh]
        who = self.name_of(side.holder) or "nobody"
        if side.state == State.ESTOP:
            why = f"{side.reason}: {side.advice}"
        elif ask.operator and ask.operator != side.holder:
            why = f"{self.name_of(ask.operator)} does not hold the arm, {who} does"
        else:
            why = ask.refusal or describe(missing) or signs.misaligned or side.reason
        return False, f"{name} not engaged: {why}"
