"""Chunks of sound: nothing lost or twice, and a sample's number says when it was, whatever the source does."""

from __future__ import annotations

import numpy as np
import pytest

from saras import ConfigError
from saras.capture.chunks import GAP_NS, Chunk, Chunker

DRAWS = 300


def test_every_sample_leaves_once_with_its_number_and_its_time(many: int) -> None:
    for seed in range(DRAWS * many):
        rng = np.random.default_rng(seed)
        rate_hz, channels = int(rng.choice([8000, 16000, 44100])), int(rng.integers(1, 3))
        pace = 1.0 + rng.uniform(-3e-4, 3e-4)  # of the sound card's clock
        wanted = int(rng.integers(100, 3000))
        chunker = Chunker(rate_hz, channels, wanted)
        value, at_ns = 0, int(rng.integers(10**18, 2 * 10**18))
        given: dict[int, int] = {}  # a sample's value: when it was taken
        out: list[Chunk] = []
        gaps = 0
        for _ in range(int(rng.integers(2, 60))):
            count = int(rng.integers(1, 4000))
            values = value + np.arange(count)
            times = at_ns + np.round(np.arange(count) * pace * 1e9 / rate_hz).astype(np.int64)
            given.update(zip(values.tolist(), times.tolist()))
            samples = np.repeat((values % 32768).astype(np.int16)[:, None], channels, axis=1)
            jitter_ns = int(rng.integers(-50_000, 50_000))
            out += chunker.add(samples, at_ns + jitter_ns)
            value, at_ns = value + count, at_ns + round(count * pace * 1e9 / rate_hz)
            if rng.random() < 0.1:
                gaps += 1
                at_ns += int(rng.integers(2 * GAP_NS, 50 * GAP_NS))
        out += chunker.rest()
        joined = np.concatenate([chunk.samples for chunk in out])
        assert np.array_equal(joined[:, 0], np.arange(value) % 32768)
        assert sum(len(chunk.samples) != wanted for chunk in out) <= gaps + 1
        begin, done = out[0], 0
        for chunk, after in zip(out, [*out[1:], None]):
            assert abs(chunk.taken_ns - given[done]) < 1_200_000  # jitter, and one buffer at the card's pace
            by_time = (given[done] - begin.taken_ns) * 1e-9 * rate_hz
            assert abs(chunk.first - by_time) < 5e-4 * by_time + 1e-3 * rate_hz
            assert after is None or after.first >= chunk.first + len(chunk.samples)
            done += len(chunk.samples)


def test_a_source_without_times_goes_on_by_count() -> None:
    chunker = Chunker(1000, 1, 100)
    with pytest.raises(ConfigError, match="taken_ns"):
        chunker.add(np.zeros((10, 1), np.int16), None)
    out = chunker.add(np.zeros((150, 1), np.int16), 10**18) + chunker.add(np.zeros((60, 1), np.int16), None)
    assert [(chunk.first, chunk.taken_ns - 10**18, len(chunk.samples)) for chunk in out] == [
        (0, 0, 100),
        (100, 100_000_000, 100),
    ]
    again = chunker.add(np.zeros((100, 1), np.int16), 10**18 + 5 * 10**9)  # it failed, and came back
    assert [(chunk.first, len(chunk.samples)) for chunk in again] == [(200, 10), (5000, 100)]
