"""The real-time host's configuration, from the parameters of the separate nodes: one set of numbers for both hostings.

Every key of every section is read and checked as its node would; what only concerns a node's own topics is given back
for the host's publishing.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import rospy

from saras import ConfigError
from saras.collision import RepulsiveForceConfig
from saras.net.keys import Keys
from saras.net.keys import load as load_keys
from saras.pipeline import PipelineConfig
from saras.runtime import ConsoleSocketConfig, HostConfig, LoopConfig, Pacing, RealtimeRequest
from saras.teleop import (
    EnergyTankConfig,
    FrameMappingConfig,
    Mapping,
    TransparencyConfig,
    TwistEstimatorConfig,
    VelocityIntegratorConfig,
)
from saras_ros1.channel import SIDES, STATE_TIMEOUT_S
from saras_ros1.console_link import check_addresses
from saras_ros1.params import Params

TANKS = ("tank_master", "tank_slave")
FORCE_TOPICS = {"arm": "/mesa_{s}/measured_cf", "contact": "/contact_force/{s}/wrench"}


@dataclass
class Publishing:
    """How often what is published: every n-th time, as in the separate nodes' parameters."""

    buttons_every: int
    state_every: int
    exchange_every: dict[str, int]
    tank_state_every: dict[str, int]
    tf_every: int


@dataclass
class Settings:
    """All that the host is built from. The frames of the mappings are filled in later: they come through tf."""

    host: HostConfig
    keys: Keys | None
    operator: str
    publishing: Publishing
    frames_wait_s: float
    force_topic: str  # with {s} for the side
    wants_nearness: bool


def _section(name: str) -> Params:
    return Params(rospy.get_param(f"/{name}", {}), f"/{name}")


def read(own: Params) -> Settings:
    """own: of the host itself. Raises ConfigError naming section, key, value and bound."""
    session = time.time_ns()
    pipeline = PipelineConfig(session=session, channel_timeout_s=STATE_TIMEOUT_S)
    frames_wait_s = _read_mappings(pipeline)
    force_topic = _read_transparency(pipeline)
    publishing = _read_tanks(pipeline)
    _read_integrators(pipeline, publishing)
    console, keys, operator = _read_console(pipeline, publishing, session)
    host = HostConfig(
        loop=LoopConfig(
            period_s=own.number("period_s", 1e-4, 0.1),
            pacing=getattr(Pacing, own.text("pacing", ("datagram", "tick")).upper()),
            hold_after_s=own.number("hold_after_s", 1e-4, 10.0),
            realtime=RealtimeRequest(priority=own.integer("priority", 0, 99), lock_memory=own.flag("lock_memory")),
        ),
        console=console,
        pipeline=pipeline,
        record_s=own.number("record_s", 0.0, 3600.0),
    )
    return Settings(
        host=host,
        keys=keys,
        operator=operator,
        publishing=publishing,
        frames_wait_s=frames_wait_s,
        force_topic=force_topic,
        wants_nearness=pipeline.proximity_force or pipeline.proximity_slowdown,
    )


def _read_mappings(pipeline: PipelineConfig) -> float:
    frames_wait_s, timeouts = 0.0, []
    for side in SIDES:
        params = _section(f"tf_transformer_{side}")
        params.text("side", (side,))
        params.number("period_s", 0.001, 0.1)
        frames_wait_s = max(frames_wait_s, params.number("frames_wait_s", 0.1, 600.0))
        timeouts.append(params.number("pose_timeout_s", 0.005, 1.0))
        params.number("wrench_timeout_s", 0.005, 1.0)
        config = params.build(FrameMappingConfig, "law", base_T_console=np.eye(4), touch_T_console=np.eye(4))
        params.finish()
        if config.mapping != Mapping.STATIC:
            raise ConfigError("law/mapping = endoscope: must be static until a node publishes the camera's frames")
        setattr(pipeline, f"{side}_mapping", config)
    pipeline.handle_timeout_s = min(timeouts)
    return frames_wait_s


def _read_transparency(pipeline: PipelineConfig) -> str:
    params = _section("transparency")
    params.number("period_s", 0.001, 0.1)
    pipeline.handle_timeout_s = min(pipeline.handle_timeout_s, params.number("master_timeout_s", 0.005, 1.0))
    pipeline.arm_timeout_s = params.number("arm_timeout_s", 0.005, 1.0)
    force_source = params.text("force_source", ("arm", "contact"))
    pipeline.transparency = params.build(TransparencyConfig, "law")
    pipeline.slave_twist = params.build(TwistEstimatorConfig, "slave_twist")
    proximity = params.section("proximity_force")
    proximity.number("timeout_s", 0.02, 0.15)
    pipeline.proximity_force = proximity.flag("enabled")
    pipeline.repulsion = proximity.build(RepulsiveForceConfig, "law")
    params.finish()
    return FORCE_TOPICS[force_source]


def _read_tanks(pipeline: PipelineConfig) -> Publishing:
    exchange, state = {}, {}
    peers = []
    for name in TANKS:
        params = _section(name)
        params.number("period_s", 0.001, 0.1)
        params.number("input_timeout_s", 0.005, 1.0)
        if name == "tank_slave":
            pipeline.arm_timeout_s = min(pipeline.arm_timeout_s, params.number("arm_timeout_s", 0.005, 1.0))
        peers.append(params.number("peer_timeout_s", 0.005, 2.0))
        setattr(pipeline, name, params.build(EnergyTankConfig, "tank"))
        exchange[name] = params.integer("exchange_every", 1, 10)
        state[name] = params.integer("state_every", 1, 100)
        params.finish()
    pipeline.peer_timeout_s = min(peers)
    return Publishing(1, 1, exchange, state, 1)


def _read_integrators(pipeline: PipelineConfig, publishing: Publishing) -> None:
    nearness_timeout_s = float("inf")
    for side in SIDES:
        params = _section(f"velocity_integrator_{side}")
        params.text("side", (side,))
        params.number("period_s", 0.001, 0.1)
        params.number("start_pose_wait_s", 0.1, 600.0)
        params.number("twist_timeout_s", 0.005, 1.0)
        pipeline.arm_timeout_s = min(pipeline.arm_timeout_s, params.number("arm_timeout_s", 0.005, 1.0))
        publishing.tf_every = params.integer("tf_every", 1, 1000)
        config = params.build(VelocityIntegratorConfig, "law")
        slowdown = params.section("proximity_slowdown")
        nearness_timeout_s = min(nearness_timeout_s, slowdown.number("timeout_s", 0.02, 0.15))
        unknown_speed_m_s = slowdown.number("unknown_speed_m_s", 0.0, config.speed_limit_m_s)
        pipeline.proximity_slowdown = slowdown.flag("enabled") or pipeline.proximity_slowdown
        params.finish()
        setattr(pipeline, f"{side}_integrator", config)
        setattr(pipeline, f"{side}_unknown_speed_m_s", unknown_speed_m_s)
    pipeline.nearness_timeout_s = nearness_timeout_s


def _read_console(
    pipeline: PipelineConfig, publishing: Publishing, session: int
) -> tuple[ConsoleSocketConfig, Keys | None, str]:
    params = _section("touchball_receiver")
    params.number("period_s", 0.001, 0.1)
    params.number("wrench_timeout_s", 0.005, 1.0)
    params.skip("second_console")
    if params.flag("has_second_console"):
        raise ConfigError("/touchball_receiver/has_second_console = true: hosting realtime serves one console")
    operator = params.text("operator")
    pipeline.peer_timeout_s = min(pipeline.peer_timeout_s, params.number("peer_timeout_s", 0.005, 2.0))
    publishing.buttons_every = params.integer("buttons_every", 1, 100)
    publishing.state_every = params.integer("state_every", 1, 100)
    key_file = params.text("key_file", empty=True)
    keys = load_keys(Path(key_file).expanduser()) if key_file else None
    config = ConsoleSocketConfig(
        bind_host=params.text("bind_host"),
        bind_port=params.integer("bind_port", 0, 65535),
        console_host=params.text("console_host"),
        console_port=params.integer("console_port", 1, 65535),
        age_limit_s=params.number("age_limit_s", 0.005, 1.0),
        keyed=keys is not None,
        session=session,
    )
    params.finish()
    check_addresses(config.bind_host, config.console_host, keys is not None)
    return config, keys, operator
