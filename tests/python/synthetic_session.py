"""Writes a bag that looks like a short session, with rosbags' writer: no ROS, no simulator, known numbers.

Left and right handle draw circles; the slave follows s = 0.5 times the handle, LAG_S later; the clutch is pressed
from 6 to 7 s; the left side is in HOLD from 9 to 10 s.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

ROOT = Path(__file__).resolve().parents[2]
START_NS = 1_700_000_000_000_000_000
RATE_HZ = 100
LAG_S = 0.04
SCALE = 0.5
GRANTED_J = 0.4
MINIMUM_J, REQUEST_J, AVAILABLE_J, MAXIMUM_J = 0.02, 0.15, 0.25, 0.5


def typestore():
    store = get_typestore(Stores.ROS1_NOETIC)
    types = {}
    for file in sorted((ROOT / "msg").glob("*.msg")):
        types.update(get_types_from_msg(file.read_text(), f"saras_ros1/msg/{file.stem}"))
    store.register(types)
    return store


class BagWriter:
    """Publishes messages by keyword into a bag, stamped at t [s], received transport_s later."""

    def __init__(self, path: Path, transport_s: float = 0.0005) -> None:
        self.store = typestore()
        self.transport_s = transport_s
        self.writer = Writer(path)
        self.writer.open()
        self.connections = {}
        self.seqs: dict[str, int] = {}
        self.pending: list[tuple[int, object, bytes]] = []

    def make(self, name: str, /, **fields):
        return self.store.types[name](**fields)

    def header(self, topic: str, t: float, frame: str = ""):
        self.seqs[topic] = self.seqs.get(topic, -1) + 1
        ns = START_NS + round(t * 1e9)
        stamp = self.make("builtin_interfaces/msg/Time", sec=ns // 10**9, nanosec=ns % 10**9)
        return self.make("std_msgs/msg/Header", seq=self.seqs[topic], stamp=stamp, frame_id=frame)

    def put(self, topic: str, msgtype: str, t: float, **fields) -> None:
        if topic not in self.connections:
            self.connections[topic] = self.writer.add_connection(topic, msgtype, typestore=self.store)
        message = self.make(msgtype, **fields)
        data = bytes(self.store.serialize_ros1(message, msgtype))
        self.pending.append((START_NS + round((t + self.transport_s) * 1e9), self.connections[topic], data))

    def pose(self, topic: str, t: float, position, frame: str) -> None:
        point = self.make("geometry_msgs/msg/Point", **dict(zip("xyz", map(float, position))))
        quaternion = self.make("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=0.0, w=1.0)
        pose = self.make("geometry_msgs/msg/Pose", position=point, orientation=quaternion)
        self.put(topic, "geometry_msgs/msg/PoseStamped", t, header=self.header(topic, t, frame), pose=pose)

    def vector(self, topic: str, t: float, value, kind: str, frame: str) -> None:
        names = {"Twist": ("linear", "angular"), "Wrench": ("force", "torque")}[kind]
        parts = [
            self.make("geometry_msgs/msg/Vector3", **dict(zip("xyz", map(float, v)))) for v in (value[:3], value[3:])
        ]
        inner = self.make(f"geometry_msgs/msg/{kind}", **dict(zip(names, parts)))
        fields = {"header": self.header(topic, t, frame), kind.lower(): inner}
        self.put(topic, f"geometry_msgs/msg/{kind}Stamped", t, **fields)

    def text(self, topic: str, t: float, data: str) -> None:
        self.put(topic, "std_msgs/msg/String", t, data=data)

    def close(self) -> None:
        for time_ns, connection, data in sorted(self.pending, key=lambda row: row[0]):
            self.writer.write(connection, time_ns, data)
        self.writer.close()


def handle_position(t):
    """(…, 3) the circle that the handle draws, mapped into the arm's base frame [m]."""
    phase = 2 * np.pi * 0.5 * np.asarray(t)
    return np.stack([0.03 * np.sin(phase), 0.03 * np.cos(phase), 0.01 * np.sin(2 * phase)], axis=-1)


def channel_state(side: str, t: float) -> tuple[int, str, str]:
    if t < 1.0:
        return 1, "", "press engage"
    if side == "left" and 9.0 <= t < 10.0:
        return 3, "console: no datagram for 61 ms", "check the console, then engage"
    return 2, "", ""


def write_tank(bag: BagWriter, name: str, t: float, energy: float, sent: float, received: float) -> None:
    topic = f"/{name}/state"
    granted = GRANTED_J if t >= 1.0 else 0.0
    bag.put(
        topic,
        "saras_ros1/msg/TankState",
        t,
        header=bag.header(topic, t),
        seq=bag.seqs[topic],
        session=1,
        energy_J=energy,
        minimum_J=MINIMUM_J,
        request_J=REQUEST_J,
        available_J=AVAILABLE_J,
        maximum_J=MAXIMUM_J,
        reduction=float(np.clip((REQUEST_J - energy) / (REQUEST_J - MINIMUM_J), 0, 1)),
        scale=1.0,
        damping=np.full(6, 1.0),
        work_out_J=granted + received - sent - energy,
        received_J=received,
        sent_J=sent,
        vented_J=0.0,
        granted_J=granted,
        requesting=energy < REQUEST_J,
        has_room=True,
        status="OK",
    )


def write_session(path: Path, duration_s: float = 12.0) -> Path:
    """The whole session; returns the path."""
    bag = BagWriter(path)
    bag.text(
        "/saras/session", 0.0, json.dumps({"hosting": "separate", "operator": "normal", "seed": 7, "rate_hz": RATE_HZ})
    )
    for tick in range(int(duration_s * RATE_HZ)):
        t = tick / RATE_HZ
        # tank_slave lends to tank_master in the first seconds after engagement.
        lent = 0.05 * min(max(t - 1.0, 0.0), 2.0)
        drain = 0.06 * (1 - np.cos(0.8 * max(t - 1.0, 0.0)))
        charged = GRANTED_J if t >= 1.0 else 0.0
        write_tank(bag, "tank_master", t, charged + lent - drain, 0.0, lent)
        write_tank(bag, "tank_slave", t, charged - lent, lent, 0.0)
        if tick % 2 == 0:
            write_distances(bag, t)
        for side in ("left", "right"):
            write_side(bag, side, t)
            write_tank(bag, f"port_guard_{side}", t, charged - 0.5 * drain, 0.0, 0.0)
    bag.close()
    return path


def tip_distance(t: float) -> tuple[float, int]:
    """Of mesa_left from PSM1 [m], and its state: a warning from 13.5 to 14.5 s, unknown before 0.5 s."""
    distance = 0.05 - 0.045 * max(0.0, 1.0 - abs(t - 14.0) / 4.5)
    return distance, 0 if t < 0.5 else 2 if distance < 0.01 else 1


def write_distances(bag: BagWriter, t: float) -> None:
    distance, state = tip_distance(t)
    zero, nan = {"x": 0.0, "y": 0.0, "z": 0.0}, float("nan")
    point, vector = (bag.make(f"geometry_msgs/msg/{name}", **zero) for name in ("Point", "Vector3"))
    tool = bag.make(
        "saras_ros1/msg/ToolCollision",
        name="mesa_left",
        state=state,
        reason="PSM2: silent" if state == 0 else "",
        distance=nan if state == 0 else distance,
        partner="PSM1",
        known_distance=distance,
        on_tool=point,
        on_partner=point,
        normal=vector,
        tip=point,
        trocar=point,
        radius=0.0025,
        max_speed_scale=1.0,
        approach_speed_limit=min(0.1, max(0.0, 0.1 * (distance - 0.001) / 0.014)),
    )
    topic = "/collision/state"
    bag.put(topic, "saras_ros1/msg/CollisionState", t, header=bag.header(topic, t, "world"), tools=[tool])


def write_side(bag: BagWriter, side: str, t: float) -> None:
    frame = f"mesa_{side}/sbs_world"
    state, reason, advice = channel_state(side, t)
    topic = f"/system/{side}/state"
    bag.put(
        topic,
        "saras_ros1/msg/ChannelState",
        t,
        header=bag.header(topic, t),
        seq=bag.seqs[topic],
        side=side,
        state=state,
        engagement=1,
        clutch=6.0 <= t < 7.0,
        estop=False,
        holder="assistant",
        offered_to="",
        misaligned="",
        reason=reason,
        advice=advice,
    )
    now, later = handle_position(t), handle_position(t - LAG_S)
    base = np.array([0.3, 0.0, -0.1])
    bag.pose(f"/touchball_{side}/pose", t, now, f"touchball_{side}/simball_base")
    bag.pose(f"/tf_transformer_{side}/tracked_pose", t, now, frame)
    bag.pose(f"/mesa_{side}/set_point", t, base + SCALE * handle_position(t - 0.01), frame)
    bag.pose(f"/mesa_{side}/ee_pose", t, base + SCALE * later, frame)
    force = np.array([0.0, 0.0, max(0.0, 2.0 * np.sin(0.9 * t)), 0.0, 0.0, 0.0])
    bag.vector(f"/transparency/{side}/desired_wrench", t, -force, "Wrench", frame)
    bag.vector(f"/tank_master/{side}/wrench", t, -0.9 * force, "Wrench", frame)
    bag.vector(f"/mesa_{side}/measured_cf", t, force, "Wrench", frame)
    speed = (handle_position(t) - handle_position(t - 0.01)) / 0.01
    bag.vector(f"/transparency/{side}/desired_twist", t, [*(SCALE * speed), 0, 0, 0], "Twist", frame)
    bag.vector(f"/tank_slave/{side}/twist", t, [*(SCALE * speed), 0, 0, 0], "Twist", frame)
