"""What the data set takes from a session: a table of sources, each a topic with its columns, units and frames."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from saras.recording.bag import Topic

Array = NDArray[Any]
LINEAR, SLERP, PREVIOUS, TEXT = "linear", "slerp", "previous", "previous text"


@dataclass(frozen=True)
class Column:
    """One column of the table."""

    name: str
    unit: str
    method: str


@dataclass
class Samples:
    """What a topic gave: columns that belong together are interpolated together."""

    blocks: list[tuple[list[Column], Array]] = field(default_factory=list)  #: (n, k) each
    frame: str = ""  #: of the message, empty: none


@dataclass(frozen=True)
class Source:
    """One topic (the first of several that is there), and what becomes of it."""

    name: str  #: begins the names of its columns; ``<name>_valid`` tells where they are known
    topics: tuple[str, ...]
    kind: str
    text: str  #: for the data card
    age_max_s: float | None = None  #: for states; None: a few periods of the topic

    def read(self, topic: Topic) -> Samples:
        """The topic's samples. Raises saras.Error when the topic has other fields than this source needs."""
        return _READERS[self.kind](self.name, topic)


def sources() -> list[Source]:
    """All of them; those that were not recorded are left out of a table, and named in its card."""
    rows = []
    for side in ("left", "right"):
        arm, hand = f"mesa_{side}", f"touchball_{side}"
        base = f"in {arm}/sbs_world"
        rows += [
            Source(f"{arm}_tip", (f"/{arm}/ee_pose",), "pose", f"measured tool tip {base}"),
            Source(f"{arm}_set_point", (f"/{arm}/set_point",), "pose", f"commanded tool tip {base}"),
            Source(f"{arm}_joint", (f"/{arm}/joint_states",), "joints", "measured joints"),
            Source(f"{arm}_tool", (f"/{arm}/tool",), "joints", "measured roll and jaw of the instrument"),
            Source(f"{arm}_tool_command", (f"/{arm}/tool_command",), "joints", "commanded roll and jaw"),
            Source(f"{arm}_exerted", (f"/{arm}/measured_cf",), "wrench", f"wrench exerted on tissue, {base}"),
            Source(f"{arm}_contact", (f"/contact_force/{side}/wrench",), "wrench", "contact wrench, by a camera"),
            Source(f"{arm}_contact_depth", (f"/contact/{side}",), "depth", "depth of a contact, by a camera"),
            Source(f"{arm}_state", (f"/system/{side}/state",), "channel", "state, clutch and holder of the side", 0.5),
            Source(f"{hand}_handle", (f"/{hand}/pose",), "pose", f"handle in {hand}/simball_base"),
            Source(f"{hand}_joint", (f"/{hand}/joint_states",), "joints", "joints of the hand piece"),
            Source(f"{hand}_grip", (f"/{hand}/grip",), "joints", "grip of the hand piece, 0 to 1"),
            Source(f"{hand}_buttons", (f"/{hand}/buttons",), "buttons", "clutch and clip button", 0.2),
            Source(f"{hand}_mapped", (f"/tf_transformer_{side}/tracked_pose",), "pose", f"handle mapped {base}"),
            Source(f"{hand}_force", (f"/{hand}/wrench",), "wrench", "wrench sent to the hand, touch frame"),
            Source(f"{hand}_desired", (f"/transparency/{side}/desired_wrench",), "wrench", f"wrench asked for, {base}"),
            Source(f"{hand}_applied", (f"/tank_master/{side}/wrench",), "wrench", f"wrench let through, {base}"),
            Source(f"{arm}_desired", (f"/transparency/{side}/desired_twist",), "twist", f"twist asked for, {base}"),
            Source(f"{arm}_command", (f"/tank_slave/{side}/twist",), "twist", f"twist let through, {base}"),
            Source(f"port_guard_{side}", (f"/port_guard_{side}/state",), "tank", "energy tank at the hand's port"),
        ]
    for arm in ("PSM1", "PSM2", "ECM"):
        old = f"/dvrk/{arm}/position_cartesian_current"
        rows += [
            Source(f"{arm}_tip", (f"/{arm}/measured_cp", old), "pose", f"measured tip of {arm} in its header's frame"),
            Source(f"{arm}_joint", (f"/{arm}/measured_js",), "joints", f"measured joints of {arm}"),
        ]
    rows += [Source(f"{arm}_jaw", (f"/{arm}/jaw/measured_js",), "joints", f"jaw of {arm}") for arm in ("PSM1", "PSM2")]
    rows += [
        Source("distance", ("/collision/distances",), "distances", "distance of each tool from the nearest thing"),
        Source("tank_master", ("/tank_master/state",), "tank", "energy tank of the master side"),
        Source("tank_slave", ("/tank_slave/state",), "tank", "energy tank of the slave side"),
        Source("system", ("/system/operating_state",), "operating", "CRTK state of the whole", 2.0),
    ]
    return rows


def _stacked(topic: Topic, fields: Sequence[str]) -> Array:
    return np.stack([np.asarray(topic[name], dtype=float) for name in fields], axis=1)


def _frame(topic: Topic) -> str:
    column = topic.columns.get("header.frame_id")
    return str(column[0]) if column is not None and len(column) else ""


def _pose(name: str, topic: Topic) -> Samples:
    position = [Column(f"{name}_{axis}_m", "m", LINEAR) for axis in "xyz"]
    rotation = [Column(f"{name}_q{axis}", "1", SLERP) for axis in "xyzw"]
    blocks = [
        (position, _stacked(topic, [f"pose.position.{axis}" for axis in "xyz"])),
        (rotation, _stacked(topic, [f"pose.orientation.{axis}" for axis in "xyzw"])),
    ]
    return Samples(blocks, _frame(topic))


def _vector(name: str, topic: Topic, outer: str, parts: tuple[tuple[str, str, str, str], ...]) -> Samples:
    columns = [
        Column(f"{name}_{short}{axis}_{label}", unit, LINEAR) for _, short, label, unit in parts for axis in "xyz"
    ]
    fields = [f"{outer}.{part}.{axis}" for part, *_ in parts for axis in "xyz"]
    return Samples([(columns, _stacked(topic, fields))], _frame(topic))


def _wrench(name: str, topic: Topic) -> Samples:
    return _vector(name, topic, "wrench", (("force", "f", "N", "N"), ("torque", "t", "Nm", "N m")))


def _twist(name: str, topic: Topic) -> Samples:
    return _vector(name, topic, "twist", (("linear", "v", "m_per_s", "m/s"), ("angular", "w", "rad_per_s", "rad/s")))


def _joints(name: str, topic: Topic) -> Samples:
    names = [str(joint) for joint in topic["name"][0]]
    same = np.array([list(row) == names for row in topic["name"]])
    width = len(names)
    values = np.full((len(topic), width), np.nan)
    for row, (position, known) in enumerate(zip(topic["position"], same)):
        if known and len(position) == width:
            values[row] = position
    columns = [_joint(name, joint.rsplit("/", 1)[-1]) for joint in names]
    return Samples([(columns, values)])


def _joint(name: str, joint: str) -> Column:
    # JointState names no units: only these are no angles.
    unit = "m" if "insertion" in joint else "1" if joint in ("grip", "jaw") and not name.startswith("PSM") else "rad"
    stem = name if name.endswith(f"_{joint}") else f"{name}_{joint}"
    return Column(stem if unit == "1" else f"{stem}_{unit}", unit, LINEAR)


def _depth(name: str, topic: Topic) -> Samples:
    direction = [Column(f"{name}_normal_{axis}", "1", LINEAR) for axis in "xyz"]
    blocks = [
        ([Column(f"{name}_m", "m", LINEAR)], _stacked(topic, ["depth"])),
        (direction, _stacked(topic, [f"direction.{axis}" for axis in "xyz"])),
    ]
    return Samples(blocks, _frame(topic))


def _channel(name: str, topic: Topic) -> Samples:
    from saras.recording.session import CHANNEL_STATES

    words = np.array([CHANNEL_STATES.get(int(state), "UNKNOWN") for state in topic["state"]], dtype=object)
    holder = topic.columns.get("holder")
    texts = [words] if holder is None else [words, np.array([str(text) for text in holder], dtype=object)]
    names = [Column(name, "", TEXT), Column(f"{name}_holder", "", TEXT)][: len(texts)]
    numbers = [Column(f"{name}_clutch", "bool", PREVIOUS), Column(f"{name}_engagement", "count", PREVIOUS)]
    return Samples([(names, np.stack(texts, axis=1)), (numbers, _stacked(topic, ["clutch", "engagement"]))])


def _operating(name: str, topic: Topic) -> Samples:
    words = np.array([str(state) for state in topic["state"]], dtype=object)
    return Samples([([Column(f"{name}_state", "", TEXT)], words[:, None])])


def _buttons(name: str, topic: Topic) -> Samples:
    values = np.full((len(topic), 2), math.nan)
    for row, pressed in enumerate(topic["buttons"]):
        values[row, : min(2, len(pressed))] = pressed[:2]
    columns = [Column(f"{name}_{button}", "bool", PREVIOUS) for button in ("clutch", "clip")]
    return Samples([(columns, values)])


def _distances(name: str, topic: Topic) -> Samples:
    tools = ("mesa_left", "mesa_right", "PSM1", "PSM2")  # ECM and more: /collision/state
    values = np.full((len(topic), len(tools)), math.nan)
    for row, data in enumerate(topic["data"]):
        values[row, : min(len(tools), len(data))] = data[: len(tools)]
    return Samples([([Column(f"{name}_{tool}_m", "m", LINEAR) for tool in tools], values)])


def _tank(name: str, topic: Topic) -> Samples:
    fields = ("energy_J", "work_out_J", "sent_J", "received_J", "vented_J", "granted_J", "reduction")
    columns = [Column(f"{name}_{part}", "J" if part.endswith("_J") else "1", LINEAR) for part in fields]
    return Samples([(columns, _stacked(topic, fields))])


_READERS = {
    "pose": _pose,
    "wrench": _wrench,
    "twist": _twist,
    "joints": _joints,
    "depth": _depth,
    "channel": _channel,
    "operating": _operating,
    "buttons": _buttons,
    "distances": _distances,
    "tank": _tank,
}
