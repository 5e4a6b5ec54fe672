"""Rows 34 and 48 of the fault catalogue: every parameter of every node is spoilt, and the start refused by name.

The nodes' own constructors run, with rospy's connections stubbed out: a thousand starts of real processes would take an
hour. Real processes: tests/ros/start_test.py.
"""

from __future__ import annotations

import copy
import importlib
import math
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

rospy = pytest.importorskip("rospy")
from saras import Error
from saras.mesa_link import SocketIoArmDriver
from saras_ros1 import direct_publishing, direct_reception, scheduling
from saras_ros1.node import Node, StartupError
from saras_ros1.nodes.tf_transformer import TfTransformer

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "faults"))
from support.results import Row, recorded

#: config file, node's namespace, module, class
NODES = [
    ("teleop.yaml", "tf_transformer_left", "tf_transformer", "TfTransformer"),
    ("teleop.yaml", "transparency", "transparency", "TransparencyNode"),
    ("teleop.yaml", "velocity_integrator_left", "velocity_integrator", "VelocityIntegratorNode"),
    ("teleop.yaml", "tool_command", "tool_command", "ToolCommand"),
    ("tanks.yaml", "tank_master", "tank_master", "TankMaster"),
    ("tanks.yaml", "tank_slave", "tank_slave", "TankSlave"),
    ("console.yaml", "touchball_receiver", "touchball_receiver", "TouchballReceiver"),
    ("supervisor.yaml", "supervisor", "supervisor", "Supervisor"),
    ("arms.yaml", "arm_driver_left", "arm_driver", "ArmDriverNode"),
    ("arms.yaml", "arm_state_left", "arm_state", "ArmStateNode"),
    ("contact.yaml", "contact_force", "contact_force", "ContactForceNode"),
]
#: numbers of which every finite value is good, or that only another one bounds
UNBOUNDED = {"cone_axis", "console_port", "bind_port"}
TEST = "tests/python/test_fault_parameters.py"


class Done(Exception):
    """The constructor came to where it waits for others: all parameters were taken."""


class Nothing:
    """Stands in for publishers, subscribers, services, listeners."""

    def __init__(self, *_: object, **__: object) -> None: ...

    def __getattr__(self, name: str) -> Nothing:
        return Nothing()

    def __call__(self, *_: object, **__: object) -> None: ...


@pytest.fixture(autouse=True)
def alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """rospy without a master, and no sockets."""
    for name in ("Publisher", "Subscriber", "Service"):
        monkeypatch.setattr(rospy, name, Nothing)
    for name in ("init_node", "on_shutdown", "loginfo", "logwarn", "logerr", "loginfo_throttle"):
        monkeypatch.setattr(rospy, name, lambda *_, **__: None)
    monkeypatch.setattr(rospy.core, "add_preshutdown_hook", lambda hook: None)
    monkeypatch.setattr(SocketIoArmDriver, "connect", lambda self, timeout_s: None)
    for module in (direct_publishing, direct_reception):
        monkeypatch.setattr(module, "install", lambda: None)
    monkeypatch.setattr(scheduling, "wake_without_preempting", lambda: None)
    monkeypatch.setattr(Node, "wait_for", _done)
    monkeypatch.setattr(TfTransformer, "_wait_for_frames", _done)
    monkeypatch.setattr("saras_ros1.node._log_without_asking", lambda: None)


def _done(*_: object) -> None:
    raise Done


def start(monkeypatch: pytest.MonkeyPatch, node: str, module: str, name: str, values: dict) -> str:
    """What the refusal says; "" when all parameters were taken."""
    monkeypatch.setattr(rospy, "get_name", lambda: f"/{node}")
    monkeypatch.setattr(rospy, "get_param", lambda key, default=None: values if key == f"/{node}" else default)
    try:
        made = getattr(importlib.import_module(f"saras_ros1.nodes.{module}"), name)()
        made.params.finish()
    except (Error, StartupError) as refusal:
        return str(refusal)
    except Done:
        return ""
    link = getattr(made, "link", None)
    if link is not None:
        link.close()
    return ""


def leaves(values: dict, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], object]]:
    for key, value in values.items():
        if isinstance(value, dict):
            yield from leaves(value, (*path, key))
        else:
            yield (*path, key), value


def spoilt(values: dict, path: tuple[str, ...], change: object) -> dict:
    """A copy in which the leaf is changed, or gone (KeyError)."""
    values = copy.deepcopy(values)
    owner = values
    for key in path[:-1]:
        owner = owner[key]
    if change is KeyError:
        del owner[path[-1]]
    else:
        owner[path[-1]] = change
    return values


def is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def changes(path: tuple[str, ...], value: object) -> Iterator[tuple[str, object]]:
    yield "missing", KeyError
    numbers = isinstance(value, list) and all(map(is_number, value))
    if is_number(value) or numbers:
        for bad in (math.nan, math.inf):
            yield str(bad), [bad] * len(value) if numbers else bad
        if path[-1] not in UNBOUNDED:
            yield "out of range", [-1e9] * len(value) if numbers else -1e9
    yield "of another kind", {"a": 1}


@pytest.mark.parametrize(("file", "node", "module", "name"), NODES, ids=[node for _, node, _, _ in NODES])
def test_every_spoilt_parameter_refuses_the_start_by_name(monkeypatch, file, node, module, name):
    values = yaml.safe_load((ROOT / "config" / file).read_text(encoding="utf-8"))[node]
    assert start(monkeypatch, node, module, name, values) == "", "the shipped values"
    row = Row(
        48,
        f"each parameter of {node} missing, NaN, Inf, out of range, of another kind",
        f"{TEST}::test_every_spoilt_parameter_refuses_the_start_by_name",
        node,
    )
    with recorded(row):
        count = 0
        for path, value in leaves(values):
            for what, change in changes(path, value):
                said = start(monkeypatch, node, module, name, spoilt(values, path, change))
                assert path[-1] in said, f"{'/'.join(path)} {what}: {said or 'accepted'}"
                count += 1
        row.saw(f"{count} starts refused, each naming its parameter")


@pytest.mark.parametrize(
    ("file", "node", "path"),
    [
        ("tanks.yaml", "tank_slave", ("tank", "damping_min")),
        ("tanks.yaml", "tank_slave", ("tank", "damping_max")),
        ("tanks.yaml", "tank_master", ("tank", "damping_min")),
        ("teleop.yaml", "transparency", ("law", "damping_N_s_m")),
    ],
)
def test_damping_of_wrong_sign_is_refused(monkeypatch, file, node, path):
    module, name = next((m, n) for _, known, m, n in NODES if known == node)
    values = yaml.safe_load((ROOT / "config" / file).read_text(encoding="utf-8"))[node]
    row = Row(
        34, f"{node}: {'/'.join(path)} = -1", f"{TEST}::test_damping_of_wrong_sign_is_refused", f"{node} {path[-1]}"
    )
    with recorded(row):
        bad = [-1.0] * 6 if node.startswith("tank") else -1.0
        said = start(monkeypatch, node, module, name, spoilt(values, path, bad))
        assert path[-1] in said and "-1" in said
        row.saw(f"“{said}” (the real process: tests/ros/start_test.py)")
