"""Markers for rviz: forces, set-points, trails, trocars, and a line of text a side. Pure: messages in, markers out."""

from __future__ import annotations

import math
import textwrap
from typing import Any

from geometry_msgs.msg import Point
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker

ARROW_M_PER_N = 0.02
SMALLEST_ARROW_N = 0.02
TRAIL_POINTS = 150
ORANGE, BLUE, WHITE = ColorRGBA(1.0, 0.5, 0.1, 1.0), ColorRGBA(0.2, 0.6, 1.0, 0.8), ColorRGBA(1.0, 1.0, 1.0, 1.0)
# Unknown is grey, never green.
GREY = ColorRGBA(0.6, 0.6, 0.6, 1.0)
RED = ColorRGBA(1.0, 0.25, 0.2, 1.0)
RECORDING_HEIGHT_M = 0.85
ENGAGED = 2
STATE_STYLE = {
    0: ("WAITING", ColorRGBA(1.0, 0.85, 0.2, 1.0)),
    1: ("READY", ColorRGBA(0.3, 0.8, 1.0, 1.0)),
    2: ("ENGAGED", ColorRGBA(0.3, 1.0, 0.4, 1.0)),
    3: ("HOLD", RED),
}


def new_marker(namespace: str, kind: int, frame: str, colour: ColorRGBA, scale: tuple[float, float, float]) -> Marker:
    """An identity-posed marker; ids are 0: the namespace tells them apart."""
    marker = Marker(ns=namespace, type=kind, action=Marker.ADD, color=colour)
    marker.header.frame_id = frame
    marker.pose.orientation.w = 1.0
    marker.scale.x, marker.scale.y, marker.scale.z = scale
    return marker


def remove(namespace: str) -> Marker:
    """Takes a marker away: what is not known now is not shown."""
    return Marker(ns=namespace, action=Marker.DELETE)


def force(namespace: str, frame: str, at: Point | None, wrench: Any | None) -> Marker:
    """An arrow along the force of a WrenchStamped, from a point."""
    if at is None or wrench is None:
        return remove(namespace)
    f = wrench.wrench.force
    if not math.hypot(f.x, f.y, f.z) >= SMALLEST_ARROW_N:  # neither small nor NaN
        return remove(namespace)
    marker = new_marker(namespace, Marker.ARROW, frame, ORANGE, (0.004, 0.009, 0.012))
    k = ARROW_M_PER_N
    marker.points = [at, Point(at.x + k * f.x, at.y + k * f.y, at.z + k * f.z)]
    return marker


def ball(namespace: str, frame: str, at: Point | None, colour: ColorRGBA, diameter_m: float) -> Marker:
    """A ball at a point."""
    if at is None:
        return remove(namespace)
    marker = new_marker(namespace, Marker.SPHERE, frame, colour, (diameter_m,) * 3)
    marker.pose.position = at
    return marker


def trail(namespace: str, frame: str, points: list[Point], colour: ColorRGBA) -> Marker:
    """A line through the last points."""
    if len(points) < 2:
        return remove(namespace)
    marker = new_marker(namespace, Marker.LINE_STRIP, frame, colour, (0.0015, 0.0, 0.0))
    marker.points = points
    return marker


def recording(state: Any | None) -> Marker:
    """Over the table: red when the session should be recorded and is not, grey when nobody asked for it."""
    wanted, well = state is None or state.wanted, state is not None and state.recording
    colour = WHITE if well else RED if wanted else GREY
    marker = new_marker("recording", Marker.TEXT_VIEW_FACING, "world", colour, (0.0, 0.0, 0.03))
    marker.pose.position.z = RECORDING_HEIGHT_M
    if state is None:
        marker.text = "NOT RECORDING\nno recorder"
    elif well:
        marker.text = f"recording {state.bytes / 1e6:.0f} MB"
    else:
        marker.text = "\n".join(["NOT RECORDING", *textwrap.wrap(state.reason, LABEL_COLUMNS)])
    return marker


#: wider lines of one side would run into the label of the other
LABEL_COLUMNS = 26


def label(namespace: str, frame: str, height_m: float, state: Any | None, energies: dict[str, Any]) -> Marker:
    """State and energies of a side; a grey "?" for what is not known."""
    name, colour = STATE_STYLE.get(state.state, ("?", GREY)) if state is not None else ("?", GREY)
    if state is not None and state.estop:
        name = "E-STOP"
    levels = "\n".join(f"{tank} {'?' if s is None else format(s.energy_J, '.2f')} J" for tank, s in energies.items())
    marker = new_marker(namespace, Marker.TEXT_VIEW_FACING, frame, colour, (0.0, 0.0, 0.025))
    marker.pose.position.z = height_m
    marker.text = f"{namespace.split()[0]} {name}\n{levels}"
    if state is not None and state.state != ENGAGED:
        lines = [line for words in (state.reason, state.advice) for line in textwrap.wrap(words, LABEL_COLUMNS)]
        marker.text += "".join(f"\n{line}" for line in lines)
    return marker
