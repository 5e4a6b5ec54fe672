"""Frozen pictures and eyes out of step, against the plain definition on random streams."""

from __future__ import annotations

import math

import numpy as np

from saras.overlay import (
    EyeSide,
    FrozenWatch,
    FrozenWatchConfig,
    StereoPairing,
    StereoPairingConfig,
    fingerprint,
)

LEFT, RIGHT, NONE = EyeSide.LEFT, EyeSide.RIGHT, EyeSide.NONE


def test_the_fingerprint_sees_each_byte(many: int) -> None:
    rng = np.random.default_rng(1)
    for encoding, channels in (("mono8", 1), ("bgr8", 3), ("rgba8", 4)):
        shape = (37, 53) if channels == 1 else (37, 53, channels)
        image = rng.integers(0, 256, shape, dtype=np.uint8)
        seen = {fingerprint(image, encoding)}
        for _ in range(1000 * many):
            changed = image.copy()
            at = tuple(rng.integers(0, size) for size in shape)
            changed[at] ^= 1 << rng.integers(8)
            assert fingerprint(changed, encoding) not in seen or (changed == image).all()
        whole = image.copy()
        whole.flags.writeable = False
        assert fingerprint(whole, encoding) in seen
    assert fingerprint(np.zeros((4, 9), np.uint8), "mono8") != fingerprint(np.zeros((9, 4), np.uint8), "mono8")


def test_the_same_picture_for_long_enough_is_frozen(many: int) -> None:
    rng = np.random.default_rng(2)
    for _ in range(100 * many):
        limit_s = float(rng.uniform(0.05, 0.3))
        watch = FrozenWatch(FrozenWatchConfig(frozen_after_s=limit_s))
        picture, since = 0, 0.0
        for i in range(80):
            dt = float(rng.choice([0.01, 0.04, 0.1]))
            same = rng.random() < 0.8
            if not same or i == 0:
                picture, since = picture + 1, 0.0
            else:
                since += dt
            out = watch.step(picture, dt)
            assert math.isclose(out.unchanged_s, since, abs_tol=1e-12)
            assert out.frozen == (out.unchanged_s >= limit_s)


def test_a_bad_time_step_neither_freezes_nor_thaws() -> None:
    watch = FrozenWatch(FrozenWatchConfig(frozen_after_s=0.1))
    for _ in range(4):
        out = watch.step(1, 0.04)
    assert out.frozen
    for dt in (math.nan, math.inf, 0.0, -1.0):
        assert watch.step(1, dt).frozen
        assert watch.step(1, dt).unchanged_s == out.unchanged_s


def test_fifteen_hertz_freeze_within_200_ms() -> None:
    watch, time_s = FrozenWatch(), 0.0
    watch.step(1, 1.0 / 15.0)
    while not watch.step(1, 1.0 / 15.0).frozen:
        time_s += 1.0 / 15.0
    assert time_s + 1.0 / 15.0 <= 0.2


def run(events: list[tuple[float, EyeSide, int]], config: StereoPairingConfig):
    """events: (time [s], eye, stamp [ns]) in order. Gives pairs of stamps and stamps that stay alone, by eye."""
    law, waiting, pairs = StereoPairing(config), {LEFT: None, RIGHT: None}, []
    alone: dict[EyeSide, list[int]] = {LEFT: [], RIGHT: []}
    last = events[0][0] - 0.01
    for time_s, eye, stamp in events:
        out = law.step(eye, stamp, time_s - last)
        last = time_s
        arrives = eye != NONE
        for i, side in enumerate((LEFT, RIGHT)):
            if out.waiting_alone[i]:
                assert waiting[side] is not None
                alone[side].append(waiting[side])
                waiting[side] = None
        if not arrives:
            assert not out.pair and not out.arrived_alone
            continue
        other = RIGHT if eye == LEFT else LEFT
        if out.pair:
            pairs.append((stamp, waiting[other]) if eye == LEFT else (waiting[other], stamp))
            assert waiting[other] is not None
            waiting[other] = None
        elif out.arrived_alone:
            alone[eye].append(stamp)
        else:
            waiting[eye] = stamp
    return pairs, alone, waiting


def test_each_image_leaves_once_and_pairs_are_of_one_moment(many: int) -> None:
    rng = np.random.default_rng(3)
    for _ in range(100 * many):
        skew_s = float(rng.uniform(0.0, 0.02))
        config = StereoPairingConfig(max_skew_s=skew_s, wait_s=float(rng.uniform(0.02, 0.1)))
        events = []
        for eye in (LEFT, RIGHT):
            offset, delay = rng.normal(0.0, 0.01), rng.uniform(0.0, 0.08)
            for n in range(60):
                if rng.random() < 0.1:
                    continue
                stamp_s = 0.04 * n + offset + rng.normal(0.0, 0.001)
                events.append((stamp_s + delay, eye, round(1e9 * (stamp_s + 1.0))))
        events += [(float(t), NONE, 0) for t in rng.uniform(0.0, 2.4, 30)] + [(10.0, NONE, 0)]
        events.sort(key=lambda event: event[0])
        pairs, alone, waiting = run(events, config)
        assert waiting == {LEFT: None, RIGHT: None}
        for i, eye in enumerate((LEFT, RIGHT)):
            came = [stamp for _, side, stamp in events if side == eye]
            assert sorted([pair[i] for pair in pairs] + alone[eye]) == sorted(came)
        assert all(abs(a - b) <= 1e9 * skew_s + 1 for a, b in pairs)


def test_in_step_all_are_paired_and_a_late_eye_is_not() -> None:
    config = StereoPairingConfig(max_skew_s=0.01, wait_s=0.06)

    def stream(delay_s: float, old_by_s: float):
        events = [(0.066 * n, LEFT, round(6.6e7 * n) + 10**9) for n in range(50)]
        events += [(0.066 * n + delay_s, RIGHT, round(6.6e7 * n - 1e9 * old_by_s) + 10**9) for n in range(50)]
        return run(sorted([*events, (10.0, NONE, 0)], key=lambda event: event[0]), config)

    pairs, alone, _ = stream(0.001, 0.0)
    assert len(pairs) == 50 and not alone[LEFT] and not alone[RIGHT]
    pairs, alone, _ = stream(0.001, 0.033)  # its pictures are old
    assert not pairs and len(alone[LEFT]) == len(alone[RIGHT]) == 50
    pairs, alone, _ = stream(0.120, 0.0)  # its pictures come late
    assert not pairs and len(alone[LEFT]) == len(alone[RIGHT]) == 50


def test_one_eye_alone_leaves_alone_in_time() -> None:
    law = StereoPairing(StereoPairingConfig(max_skew_s=0.01, wait_s=0.06))
    assert not any(law.step(LEFT, 10**9, 0.01).waiting_alone)
    assert not any(law.step(NONE, 0, 0.03).waiting_alone)
    assert law.step(NONE, 0, 0.04).waiting_alone == [True, False]
