"""Frame mapping against scipy: rotations, low-pass, clutch and faults."""

from __future__ import annotations

import numpy as np
import scipy.signal
from hypothesis import given
from hypothesis import strategies as st
from teleop_strategies import BAD_NUMBERS, FAULTY_DT, move, pose, poses, spoilt, turn, vectors

import saras
from saras.teleop import FrameMapping, FrameMappingConfig, Mapping

DT = 0.01


@given(poses(1.0), poses(0.2), st.lists(vectors(1.0, 6), min_size=1, max_size=20))
def test_tracked_pose_is_the_mapped_handle(
    base_T_console: np.ndarray, handle: np.ndarray, twists: list[np.ndarray]
) -> None:
    mapping = FrameMapping(FrameMappingConfig(base_T_console=base_T_console))
    mapping.step(handle, DT)
    for twist in twists:
        handle = move(handle, twist, DT)
        output = mapping.step(handle, DT)
        np.testing.assert_allclose(output.tracked_pose, base_T_console @ handle, atol=1e-12)
        rotation = turn(base_T_console)
        expected = np.concatenate([rotation.apply(twist[:3]), rotation.apply(twist[3:])])
        np.testing.assert_allclose(output.handle_twist, expected, atol=1e-9)


@given(poses(1.0), vectors(1.0, 6), st.lists(st.booleans(), min_size=1, max_size=30))
def test_clutch_toggled_at_any_time_gives_no_step(
    base_T_console: np.ndarray, twist: np.ndarray, clutch: list[bool]
) -> None:
    """The expected pose integrates the handle's motion over the ticks without clutch, by scipy."""
    mapping = FrameMapping(FrameMappingConfig(base_T_console=base_T_console))
    handle = np.eye(4)
    mapping.step(handle, DT)
    rotation = turn(base_T_console)
    base_twist = np.concatenate([rotation.apply(twist[:3]), rotation.apply(twist[3:])])
    expected = base_T_console
    for pressed in clutch:
        handle = move(handle, twist, DT)
        output = mapping.step(handle, DT, clutch=pressed)
        expected = expected if pressed else move(expected, base_twist, DT)
        np.testing.assert_allclose(output.tracked_pose, expected, atol=1e-12)
        np.testing.assert_allclose(output.handle_twist, base_twist, atol=1e-9)
        assert not pressed or not output.tracked_twist.any()


@given(poses(1.0), poses(1.0), vectors(5.0, 6))
def test_wrench_is_rotated_by_the_product_of_both_rotations(
    base_T_console: np.ndarray, touch_T_console: np.ndarray, wrench: np.ndarray
) -> None:
    mapping = FrameMapping(FrameMappingConfig(base_T_console=base_T_console, touch_T_console=touch_T_console))
    output = mapping.step(np.eye(4), DT, base_wrench=wrench)
    touch_R_base = turn(touch_T_console) * turn(base_T_console).inv()
    expected = np.concatenate([touch_R_base.apply(wrench[:3]), touch_R_base.apply(wrench[3:])])
    np.testing.assert_allclose(output.touch_wrench, expected, atol=1e-12)


@given(st.integers(0, 2**32 - 1), st.floats(0.5, 40.0))
def test_filtered_twist_is_scipys_first_order_low_pass(seed: int, cutoff_hz: float) -> None:
    rng = np.random.default_rng(seed)
    mapping = FrameMapping(FrameMappingConfig(cutoff_hz=cutoff_hz))
    x = np.cumsum(np.concatenate([[0.0], rng.normal(0, 1e-3, 200)]))
    outputs = [mapping.step(pose(turn(np.eye(4)), np.array([value, 0, 0])), DT) for value in x]
    # Zero-order hold of 1/(s/w + 1): input held over the interval that it is the mean of.
    w = 2 * np.pi * cutoff_hz
    numerator, denominator, _ = scipy.signal.cont2discrete(([w], [1.0, w]), DT, method="zoh")
    expected = scipy.signal.lfilter(np.atleast_1d(numerator.squeeze())[1:], denominator, np.diff(x) / DT)
    np.testing.assert_allclose([o.tracked_twist_filtered[0] for o in outputs[1:]], expected, atol=1e-9)


@given(st.data())
def test_moving_endoscope_never_moves_the_set_point_by_itself(data: st.DataObject) -> None:
    mapping = FrameMapping(FrameMappingConfig(mapping=Mapping.ENDOSCOPE))
    handle = data.draw(poses(0.2))
    previous = mapping.step(handle, DT, base_T_console=data.draw(poses(1.0))).tracked_pose
    for base_T_console in data.draw(st.lists(poses(1.0), min_size=1, max_size=5)):
        output = mapping.step(handle, DT, base_T_console=base_T_console)
        np.testing.assert_allclose(output.tracked_pose, previous, atol=1e-12)
        twist = data.draw(vectors(1.0, 6))
        handle = move(handle, twist, DT)
        output = mapping.step(handle, DT, base_T_console=base_T_console)
        rotation = turn(base_T_console)
        base_twist = np.concatenate([rotation.apply(twist[:3]), rotation.apply(twist[3:])])
        np.testing.assert_allclose(output.tracked_pose, move(previous, base_twist, DT), atol=1e-12)
        previous = output.tracked_pose


@given(st.data())
def test_faults_never_give_a_number_that_is_not_finite_nor_a_jump(data: st.DataObject) -> None:
    mapping = FrameMapping()
    handle = np.eye(4)
    mapping.step(handle, DT)
    published, seen = np.eye(4), handle
    for _ in range(data.draw(st.integers(1, 25))):
        handle = move(handle, data.draw(vectors(1.0, 6)), DT)
        sent = data.draw(st.one_of(st.just(handle), spoilt(handle)))
        wrench = np.zeros(6)
        wrench[0] = data.draw(st.one_of(st.just(1.0), BAD_NUMBERS))
        dt = data.draw(FAULTY_DT)
        output = mapping.step(sent, dt, data.draw(st.booleans()), wrench, stale=data.draw(st.booleans()))
        for value in (output.tracked_pose, output.tracked_twist, output.tracked_twist_filtered, output.handle_twist):
            assert np.isfinite(value).all()
        assert np.isfinite(output.touch_wrench).all()
        step = np.linalg.norm(output.tracked_pose[:3, 3] - published[:3, 3])
        if output.has_pose:
            assert step <= np.linalg.norm(sent[:3, 3] - seen[:3, 3]) + 1e-12
            published, seen = output.tracked_pose, sent
        else:
            assert step == 0.0
            assert output.status in (saras.Status.STALE, saras.Status.INVALID_INPUT, saras.Status.INVALID_TIME_STEP)
