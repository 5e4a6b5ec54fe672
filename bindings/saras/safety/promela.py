"""The tables of the core as Promela text, so that the SPIN model cannot say anything else than the code."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import SupportsInt

from saras._core.safety import (
    EVENT_RULES,
    LeaseAct,
    LeaseState,
    SafetyEvent,
    SafetySign,
    SafetyState,
    next_lease,
    next_state,
)

#: of the model; the law knows more, all alike
OPERATORS = 2

_HEADER = """\
/* Made by saras.safety.promela() from the tables of cpp/include/saras/safety: do not edit.
   script/verify-model --write makes it anew; a test compares. */
"""


def promela() -> str:
    """Text of safety/supervisor_tables.pml: numbers, EVENT(signs), NEXT(state, event), NEXT_HOLDER, NEXT_OFFERED."""
    parts = [_HEADER]
    parts += _numbers("", SafetyState.__members__) + _numbers("EV_", SafetyEvent.__members__)
    parts += _numbers("ACT_", LeaseAct.__members__)
    parts += [_event_macro(), _state_macro(), *_lease_macros()]
    return "\n".join(parts) + "\n"


def _numbers(prefix: str, members: Mapping[str, SupportsInt]) -> list[str]:
    return [f"#define {prefix}{name} {int(value)}" for name, value in members.items()] + [""]


def _choice(cases: Sequence[tuple[str, str]], otherwise: str) -> str:
    """(c1 -> v1 : (c2 -> v2 : … otherwise)), one case a line."""
    lines = [f"  ({condition} -> {value} : \\" for condition, value in cases]
    return "\n".join([*lines, f"  {otherwise}{')' * len(cases)}"])


def _event_macro() -> str:
    signs = {name: int(value) for name, value in SafetySign.__members__.items()}
    arguments = ", ".join(name.lower() for name in signs)
    cases = []
    for rule in EVENT_RULES:
        conditions = [name.lower() for name, bit in signs.items() if rule.all_of & bit]
        conditions += [f"!{name.lower()}" for name, bit in signs.items() if rule.none_of & bit]
        cases.append(("(" + " && ".join(conditions) + ")", f"EV_{rule.event.name}"))
    return f"#define EVENT({arguments}) \\\n{_choice(cases, 'EV_NONE')}\n"


def _state_macro() -> str:
    cases = []
    for state in SafetyState.__members__.values():
        for event in SafetyEvent.__members__.values():
            after = next_state(state, event)
            if after != state:
                cases.append((f"((s) == {state.name} && (e) == EV_{event.name})", after.name))
    return f"#define NEXT(s, e) \\\n{_choice(cases, '(s)')}\n"


def _lease_macros() -> list[str]:
    """Of two operators, an offer goes to the other one."""
    operators = range(OPERATORS + 1)
    changes = []
    for before in (LeaseState(holder=h, offered_to=o) for h in operators for o in operators):
        for act in LeaseAct.__members__.values():
            for by in operators[1:]:
                after = next_lease(before, act, by, OPERATORS + 1 - by)
                now = f"(h) == {before.holder} && (o) == {before.offered_to}"
                changes.append((f"({now} && (a) == ACT_{act.name} && (by) == {by})", before, after))
    holder = [(condition, str(after.holder)) for condition, before, after in changes if after.holder != before.holder]
    offered = [(c, str(after.offered_to)) for c, before, after in changes if after.offered_to != before.offered_to]
    return [
        f"#define NEXT_HOLDER(h, o, a, by) \\\n{_choice(holder, '(h)')}\n",
        f"#define NEXT_OFFERED(h, o, a, by) \\\n{_choice(offered, '(o)')}",
    ]
