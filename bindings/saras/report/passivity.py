"""Sections about the tanks: energy, ledger, damping and reduction."""

from __future__ import annotations

from html import escape
from typing import Any

from saras.recording import Session
from saras.report import energy
from saras.report.parts import COLORS, chart, table
from saras.report.verdicts import Findings

_COLOR = dict(zip(energy.TANKS, COLORS))
_THRESHOLDS = ("minimum_J", "request_J", "available_J", "maximum_J")


def tanks(session: Session, found: Findings) -> str:
    """Energy of all tanks with their thresholds."""
    panel = chart(session, found, None, "energy [J]", width=1150, height=300, y_include=(0.0,))
    for name, color in _COLOR.items():
        tank = session.tank(name)
        if tank is None:
            continue
        panel.line(tank.t, tank["energy_J"], name, color)
        if not panel.levels:
            for field in _THRESHOLDS:
                panel.level(float(tank[field][-1]), field.removesuffix("_J"))
    return panel.render() + _missing_tanks(found)


def _missing_tanks(found: Findings) -> str:
    missing = list(energy.TANKS) if found.ledger is None else found.ledger.missing
    if not missing:
        return ""
    return f'<p class="note"><span class="unknown">unknown</span> not recorded: {escape(", ".join(missing))}</p>'


def ledger(session: Session, found: Findings) -> str:
    """Where the granted energy is at the end, tank by tank, and the residual over time."""
    if found.ledger is None:
        return '<p class="unknown">unknown: no tank was recorded</p>'
    names = ("granted_J", "energy_J", "work_out_J", "vented_J", "sent_J", "received_J")
    rows: list[list[Any]] = [
        [a.name, *(f"{getattr(a, name):.4f}" for name in names), f"{a.residual_J:.1e}", f"{a.lowest_J:.4f}", a.sessions]
        for a in found.ledger.accounts
    ]
    rows += [[name, *([None] * 9)] for name in found.ledger.missing]
    total = {name: sum(getattr(a, name) for a in found.ledger.accounts) for name in names}
    rows.append(["all", *(f"{total[name]:.4f}" for name in names), f"{found.ledger.residual_J:.1e}", "", ""])
    head = ["tank", "granted", "in tank", "out", "vented", "sent", "received", "residual", "lowest", "starts"]
    flight = found.ledger.flight_J
    if flight is None:
        balance = '<span class="unknown">unknown</span>: a tank is missing, so the energy in flight is not known.'
    else:
        inside = total["energy_J"] + flight + total["work_out_J"] + total["vented_J"]
        balance = (
            f"granted {total['granted_J']:.4f} J = in tanks {total['energy_J']:.4f} + in flight {flight:.4f} + "
            f"out {total['work_out_J']:.4f} + vented {total['vented_J']:.4f}, "
            f"residual {inside - total['granted_J']:.1e} J"
        )
    panel = chart(session, found, None, "residual of each tank [J]", width=1150, height=120)
    for account in found.ledger.accounts:
        tank = session.tank(account.name)
        if tank is not None:
            panel.line(tank.t, energy.residual(tank), account.name, _COLOR[account.name])
    return f"{table(head, rows)}<p class='balance'>{balance}</p>{panel.render()}"


def damping(session: Session, found: Findings) -> str:
    """How far the tanks held back: reduction K_E and the largest linear damping."""
    reduction = chart(session, found, None, "reduction K_E", y_range=(-0.03, 1.05))
    panels = [reduction]
    units = {"tank_slave": "yielding of tank_slave [mm/(N s)]", "others": "damping on the hand [N s/m]"}
    for key, label in units.items():
        panel = chart(session, found, None, label, y_include=(0.0,))
        for name in energy.TANKS:
            tank = session.tank(name)
            if tank is None or (name == "tank_slave") != (key == "tank_slave"):
                continue
            factor = 1e3 if key == "tank_slave" else 1.0
            panel.line(tank.t, factor * tank["damping"][:, :3].max(axis=1), name, _COLOR[name])
        panels.append(panel)
    for name in energy.TANKS:
        tank = session.tank(name)
        if tank is not None:
            reduction.line(tank.t, tank["reduction"], name, _COLOR[name])
    return f'<div class="sides thirds">{"".join(f"<div class=side>{panel.render()}</div>" for panel in panels)}</div>'
