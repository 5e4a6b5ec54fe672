"""saras.replay: laws run again on recorded steps give the recorded outputs; tampering, gaps and restarts are seen."""

from __future__ import annotations

import json

import numpy as np
import pytest

pytest.importorskip("rosbags")

import synthetic_session as synthetic

import saras
from saras import Error
from saras.law_trace import STATE_PERIODIC, STATE_SET, STATE_UNCHANGED, TickBatch, TracedLaw, flatten, unpack
from saras.replay import build_law, from_plain, replay_bag, unflatten
from saras.teleop import (
    EnergyTank,
    EnergyTankConfig,
    FrameMapping,
    FrameMappingConfig,
    Transparency,
    TransparencyConfig,
    TwistEstimator,
    TwistEstimatorConfig,
    VelocityIntegrator,
    VelocityIntegratorConfig,
)


def pose(t):
    result = np.eye(4)
    c, s = np.cos(0.3 * t), np.sin(0.3 * t)
    result[:2, :2] = [[c, -s], [s, c]]
    result[:3, 3] = synthetic.handle_position(t)
    return result


def publish(bag, name, law, tick_count, inputs, *, drop=(), tamper=None):
    """Steps a traced law and records it, as a node does."""
    topic = f"/laws/{name}"
    rng = np.random.default_rng(1)
    batch = TickBatch()

    def flush(t):
        fields = batch.take()
        if fields is None:
            return
        types = {"layout": np.uint16, "input_size": np.uint32, "output_size": np.uint32, "state_size": np.uint32}
        for key, value in fields.items():
            if isinstance(value, bytes):
                fields[key] = np.frombuffer(value, dtype=np.uint8)
            elif isinstance(value, list):
                fields[key] = np.array(value, dtype=types.get(key, np.float64))
        bag.put(topic, "saras_ros1/msg/LawTicks", t, header=bag.header(topic, t), **fields)

    for i in range(tick_count):
        t = i * 0.01
        if i == tick_count // 2 and hasattr(law, "grant"):
            law.grant(0.05)
        law.step(dt=0.01 + 1e-3 * rng.random(), **inputs(t))
        tick = law.tick
        if tamper is not None and i == tamper:
            tick = tick._replace(output=[tick.output[0] + 1e-6, *tick.output[1:]])
        if i in drop:
            flush(t)
        else:
            batch.add(tick, t)
        if len(batch) >= 7:
            flush(t)
    flush(tick_count * 0.01)
    bag.text(f"{topic}/info", 0.0, law.info)


def tank_inputs(t):
    force = np.zeros((2, 6))
    force[:, 0] = 2 * np.sin(3 * t)
    speed = np.zeros((2, 6))
    speed[:, 0] = 0.1 * np.cos(2 * t)
    return {"desired": force, "conjugate": speed, "received_J": 1e-4, "peer_requests": t > 1, "work_J": None}


def tank_config():
    return EnergyTankConfig(hold_s=0.02)


@pytest.fixture
def bag(tmp_path):
    writer = synthetic.BagWriter(tmp_path / "laws.bag")
    writer.path = tmp_path / "laws.bag"
    return writer


def test_all_laws_replay_within_the_bound(bag):
    publish(bag, "tank_master", TracedLaw(EnergyTank, tank_config(), 2, name="tank_master"), 350, tank_inputs)
    twist = TracedLaw(TwistEstimator, TwistEstimatorConfig(cutoff_hz=10.0), name="twist")
    publish(bag, "twist", twist, 250, lambda t: {"base_T_body": pose(t)})
    mapping = TracedLaw(FrameMapping, FrameMappingConfig(base_T_console=pose(2.0)), name="tf_transformer_left")
    publish(
        bag, "tf_transformer_left", mapping, 250,
        lambda t: {"console_T_handle": pose(t), "clutch": 1 < t < 1.5, "base_wrench": np.arange(6.0), "stale": False},
    )  # fmt: skip
    bag.close()
    results = {result.name: result for result in replay_bag(bag.path)}
    assert set(results) == {"tank_master", "twist", "tf_transformer_left"}
    for result in results.values():
        assert result.agrees, result
        assert result.skipped == 0
    assert results["tank_master"].exact == 350
    assert results["twist"].exact == 250


def test_a_changed_number_is_found_and_named(bag):
    law = TracedLaw(TwistEstimator, TwistEstimatorConfig(), name="twist")
    publish(bag, "twist", law, 50, lambda t: {"base_T_body": pose(t)}, tamper=20)
    bag.close()
    (result,) = replay_bag(bag.path)
    assert not result.agrees
    assert result.worst == pytest.approx(1e-6, rel=1e-3)
    assert result.worst_field == "twist[0]"
    assert result.worst_t == pytest.approx(0.2, abs=1e-3)


def test_after_a_gap_it_waits_for_the_next_state(bag):
    law = TracedLaw(EnergyTank, tank_config(), 2, name="tank")
    publish(bag, "tank", law, 400, tank_inputs, drop=(30, 31, 250))
    bag.close()
    (result,) = replay_bag(bag.path)
    assert result.agrees
    # From 32 to the state at 100; from 251 to the state at 300.
    assert result.skipped == (100 - 32) + (300 - 251)


def test_state_flags():
    law = TracedLaw(EnergyTank, tank_config(), 2)
    flags = []
    for i in range(102):
        if i == 50:
            law.grant(0.01)
        law.step(dt=0.01, **tank_inputs(0.0))
        flags.append(law.tick.state_flag)
        assert (len(law.tick.state) > 0) == (flags[-1] != STATE_UNCHANGED)
    assert [i for i, flag in enumerate(flags) if flag == STATE_SET] == [0, 50]
    assert [i for i, flag in enumerate(flags) if flag == STATE_PERIODIC] == [100]


def test_a_tick_is_small():
    law = TracedLaw(EnergyTank, tank_config(), 2)
    law.step(dt=0.01, **tank_inputs(0.0))
    law.step(dt=0.01, **tank_inputs(0.01))
    assert 8 * (len(law.tick.input) + len(law.tick.output) + len(law.tick.state)) < 1024


@pytest.mark.parametrize(
    ("law_class", "config"),
    [
        (FrameMapping, FrameMappingConfig()),
        (Transparency, TransparencyConfig()),
        (VelocityIntegrator, VelocityIntegratorConfig()),
        (TwistEstimator, TwistEstimatorConfig()),
    ],
)
def test_every_law_describes_and_restores_itself(law_class, config):
    traced = TracedLaw(law_class, config, name="law")
    info = json.loads(traced.info)
    rebuilt = build_law(info)
    assert type(rebuilt) is law_class
    numbers = np.array(list(flatten(rebuilt.state)))
    again = unflatten(rebuilt.state, numbers)
    np.testing.assert_array_equal(list(flatten(again)), numbers)
    np.testing.assert_allclose(list(flatten(from_plain(info["args"][0]))), list(flatten(config)), atol=1e-15)


def test_a_recording_cannot_import_foreign_code():
    with pytest.raises(saras.Error, match="no law of saras"):
        build_law({"law": "os.system", "args": ["true"], "kwargs": {}})
    with pytest.raises(saras.Error, match=r"no saras\.teleop\.Nothing"):
        build_law({"law": "saras.teleop.Nothing", "args": [], "kwargs": {}})


def test_a_bag_without_law_steps_says_how_to_record_them(bag):
    bag.text("/x", 0.0, "y")
    bag.close()
    with pytest.raises(saras.Error, match="trace_laws"):
        replay_bag(bag.path)


def test_a_batch_with_too_few_numbers_is_refused_by_name():
    law, batch = TracedLaw(EnergyTank, tank_config(), 2, name="tank"), TickBatch()
    for i in range(3):
        law.step(dt=0.01, **tank_inputs(0.01 * i))
        batch.add(law.tick, 0.01 * i)
    message = batch.take()
    message["output"] = message["output"][:-1]
    with pytest.raises(Error, match=r"step 2 of 3 needs .* numbers of output"):
        unpack(message)
