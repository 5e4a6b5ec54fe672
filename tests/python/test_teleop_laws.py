"""The Python face of the teleoperation laws: construction, refusals, optional inputs, replay from state."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import saras
from saras import teleop
from saras.teleop import (
    DisturbanceObserver,
    FrameMapping,
    FrameMappingConfig,
    Mapping,
    Transparency,
    TwistEstimator,
    VelocityIntegrator,
    VelocityIntegratorConfig,
)

DT = 0.01
ZERO6, ZERO3 = np.zeros(6), np.zeros(3)


def tip(x: float) -> np.ndarray:
    """A (4, 4) tip 0.1 m below a trocar at the origin."""
    pose = np.eye(4)
    pose[:3, 3] = [x, 0, -0.1]
    return pose


CALLS: list[tuple[Any, Any]] = [
    (TwistEstimator, lambda law, i: law.step(tip(1e-3 * i), DT)),
    (FrameMapping, lambda law, i: law.step(tip(1e-3 * i), DT, clutch=i % 7 == 0, base_wrench=np.ones(6))),
    (Transparency, lambda law, i: law.step(tip(1e-3 * i), ZERO6, tip(0.0), ZERO6, ZERO6, ZERO3, DT)),
    (VelocityIntegrator, lambda law, i: law.step([0.05, 0, 0, 0, 0, 1], tip(0.0), ZERO3, DT)),
    (DisturbanceObserver, lambda law, i: law.step([1e-3 * i, 0, 0], ZERO3, DT)),
]


def fields(struct: Any) -> dict[str, Any]:
    return {name: np.asarray(getattr(struct, name)) for name in struct._fields if name != "status"}


@pytest.mark.parametrize(("law_class", "step"), CALLS, ids=lambda value: getattr(value, "__name__", ""))
def test_replays_bit_for_bit_from_its_state(law_class: Any, step: Any) -> None:
    first, second = law_class(), law_class()
    for i in range(40):
        step(first, i)
    second.reset(first.state)
    for i in range(40, 60):
        a, b = step(first, i), step(second, i)
        assert a.status == b.status
        for name, value in fields(a).items():
            np.testing.assert_array_equal(value, fields(b)[name], err_msg=name)


@pytest.mark.parametrize(("law_class", "step"), CALLS, ids=lambda value: getattr(value, "__name__", ""))
def test_reset_without_argument_is_a_new_law(law_class: Any, step: Any) -> None:
    law = law_class()
    for i in range(10):
        step(law, i)
    law.reset()
    for name, value in fields(law.state).items():
        np.testing.assert_array_equal(value, fields(law_class().state)[name], err_msg=name)


def test_configuration_errors_name_field_value_and_bound() -> None:
    for config, field in [
        ("FrameMappingConfig", "cutoff_hz"),
        ("TransparencyConfig", "ramp_s"),
        ("VelocityIntegratorConfig", "lead_limit_m"),
        ("DisturbanceObserverConfig", "mass_kg"),
        ("TwistEstimatorConfig", "dt_max_s"),
    ]:
        with pytest.raises(saras.ConfigError, match=f"{field} = -1: must be finite and > 0"):
            getattr(teleop, config)(**{field: -1.0})
        with pytest.raises(saras.ConfigError, match=f"{field} = nan"):
            getattr(teleop, config)(**{field: np.nan})
        with pytest.raises(TypeError, match="no field named gain"):
            getattr(teleop, config)(gain=1.0)


def test_shapes_are_checked() -> None:
    with pytest.raises(ValueError, match=r"expected a \(4, 4\) matrix"):
        FrameMapping().step(np.eye(3), DT)
    with pytest.raises(ValueError, match="expected 6 numbers"):
        FrameMapping().step(np.eye(4), DT, base_wrench=ZERO3)


def test_endoscope_mapping_needs_its_input() -> None:
    mapping = FrameMapping(FrameMappingConfig(mapping=Mapping.ENDOSCOPE))
    output = mapping.step(np.eye(4), DT)
    assert (output.status, output.has_pose) == (saras.Status.STALE, False)
    assert mapping.step(np.eye(4), DT, base_T_console=np.eye(4)).status == saras.Status.WAITING
    assert mapping.step(np.eye(4), DT, base_T_console=np.eye(4)).has_pose


def test_a_matrix_that_is_no_rotation_is_invalid_input() -> None:
    law = VelocityIntegrator()
    law.step(ZERO6, tip(0.0), ZERO3, DT)
    assert law.step(ZERO6, 2 * np.eye(4), ZERO3, DT).status == saras.Status.INVALID_INPUT


def test_bounds_that_acted_are_named() -> None:
    law = VelocityIntegrator(VelocityIntegratorConfig(lead_limit_m=0.001))
    for _ in range(5):
        output = law.step([1, 0, 0, 0, 0, 0], tip(0.0), ZERO3, DT)
    assert output.speed_limited and output.lead_limited
    assert not output.cone_limited and not output.insertion_limited and not output.approach_limited
    assert output.status == saras.Status.LIMITED
