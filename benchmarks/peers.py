"""The Python peers, timed: numpy_laws for the teleop group, struct_codec for the codec group."""

from __future__ import annotations

import time

import numpy as np
import numpy_laws
import scenario
import struct_codec
from pipeline import CUTOFF_HZ, Numpy, configs, plain
from scenario import BASE_T_CONSOLE, DT_S, RCM, TOUCH_T_CONSOLE


def measure(call, rows, warm_up=50):
    """{"p50", "p99"} of single calls [ns]; call(row) for each row, the first ones not counted."""
    samples = []
    for row in rows:
        start = time.perf_counter_ns()
        call(row)
        samples.append(time.perf_counter_ns() - start)
    return {"p50": float(np.percentile(samples[warm_up:], 50)), "p99": float(np.percentile(samples[warm_up:], 99))}


def teleop():
    """{row name: {"p50", "p99"}} of numpy_laws."""
    rows = scenario.inputs()
    transparency_config, _, slave_config, integrator_config = (plain(config) for config in configs())
    pipeline = Numpy()
    mapping = numpy_laws.FrameMapping(BASE_T_CONSOLE, TOUCH_T_CONSOLE, CUTOFF_HZ)
    estimator = numpy_laws.TwistEstimator(CUTOFF_HZ)
    transparency = numpy_laws.Transparency(transparency_config)
    integrator = numpy_laws.VelocityIntegrator(integrator_config)
    full = numpy_laws.EnergyTank(slave_config, 2)
    low_config = type("Low", (slave_config,), {"initial_J": slave_config.minimum_J + 1e-4})
    low = numpy_laws.EnergyTank(low_config, 2)
    zero, desired = np.zeros(6), np.full((2, 6), 0.05)
    twist = np.array([0.01, 0.0, 0.01, 0.0, 0.0, 0.0])
    contact = [rows[scenario.TICKS // 6 + i % 10] for i in range(len(rows))]
    return {
        "pipeline_both_arms": measure(lambda row: pipeline.step(*row), rows),
        "frame_mapping": measure(lambda row: mapping.step(row[0][0], DT_S, row[2][0]), rows),
        "twist_estimator": measure(lambda row: estimator.step(row[1][0], DT_S), rows),
        "transparency": measure(lambda row: transparency.step(row[0][0], zero, zero, row[1][0], zero, RCM, DT_S), rows),
        "energy_tank_full": measure(lambda row: full.step(desired, row[2], DT_S, work_J=0.0), rows),
        "energy_tank_near_floor": measure(lambda row: low.step(desired, row[2], DT_S, work_J=0.0), contact),
        "velocity_integrator": measure(lambda row: integrator.step(twist, row[1][0], RCM, DT_S), rows),
    }


def codec():
    """{row name: {"p50", "p99"}} of struct_codec."""
    up, down = struct_codec.example_up(), struct_codec.example_down()
    up_bytes, down_bytes = struct_codec.encode_up(up), struct_codec.encode_down(down)
    times = range(5000)
    return {
        "touchball_up_encode": measure(lambda _: struct_codec.encode_up(up), times),
        "touchball_up_decode": measure(lambda _: struct_codec.decode_up(up_bytes), times),
        "touchball_down_encode": measure(lambda _: struct_codec.encode_down(down), times),
        "touchball_down_decode": measure(lambda _: struct_codec.decode_down(down_bytes), times),
    }
