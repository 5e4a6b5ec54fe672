"""A UDP slave as a system file has it: whose kinematics, both ends' addresses, watchdogs, reach."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from saras import ConfigError
from saras.console.link import Address, resolve
from saras.csa.udp.gate import GateConfig
from saras.csa.udp.remote import RemoteSlaveConfig

Json = dict[str, Any]

#: How far a set-point may be from where each joint stands [rad, m], by kinematics.
JOINT_REACH = {
    "dvrk_psm": (0.3, 0.3, 0.02, 0.3, 0.3, 0.3),
    "saras_arm": (0.3, 0.3, 0.3, 0.3, 0.02, 0.3),
}


@dataclass(frozen=True)
class UdpSettings:
    """What the platform's end of the link needs."""

    bind: Address
    slave: Address
    key_file: Path | None
    period_s: float
    """between two datagrams down"""
    age_limit_s: float
    """what was held up for longer is dropped"""
    remote: RemoteSlaveConfig
    auto_enable: bool
    """enable once, when the slave is first heard"""


def udp_settings(arm: Json, joints: int, folder: Path) -> UdpSettings:
    """Of an arm of type udp with so many joints. folder: where a relative key file is. Raises ConfigError, whose text
    begins with the place in the arm.
    """
    link, kind = arm.get("link", {}), arm["kinematics"]["type"]
    reach = arm.get("joint_reach", JOINT_REACH[kind])
    if len(reach) != joints:
        raise ConfigError(f"joint_reach = {list(reach)}: {len(reach)} numbers: must be {joints}, the joints of {kind}")
    key_file = folder / Path(link["key_file"]).expanduser() if "key_file" in link else None
    if key_file is not None and not key_file.is_file():
        raise ConfigError(f"link.key_file = {link['key_file']!r}: no file {key_file}")
    bind = Address(link.get("bind_host", "127.0.0.1"), link.get("bind_port", 48030))
    slave = Address(link.get("slave_host", "127.0.0.1"), link.get("slave_port", 48031))
    for name, address in (("bind_host", bind), ("slave_host", slave)):
        resolve(address, f"link.{name}", key_file is not None)
    gate = GateConfig(
        joint_reach=tuple(reach),
        reach_m=link.get("reach_m", 0.02),
        reach_rad=link.get("reach_rad", 0.35),
        timeout_s=link.get("set_point_timeout_s", 0.1),
    )
    return UdpSettings(
        bind=bind,
        slave=slave,
        key_file=key_file,
        period_s=link.get("period_s", 0.01),
        age_limit_s=link.get("age_limit_s", 0.1),
        remote=RemoteSlaveConfig(gate, link.get("state_timeout_s", 0.1), link.get("begin_timeout_s", 1.0)),
        auto_enable=link.get("auto_enable", False),
    )
