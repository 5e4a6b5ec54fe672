"""Sound with its times: from a test source, through a file, and back."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

from saras import ConfigError

pytest.importorskip("gi")
from saras.capture.sound import Chunk, Microphone, SoundError, SoundFile, read_sound, source_text, times_ns

RATE_HZ = 16000


def heard(source: str, chunks: int) -> list[Chunk]:
    found: list[Chunk] = []
    microphone = Microphone(source_text(source), found.append, rate_hz=RATE_HZ)
    microphone.start()
    end = time.monotonic() + 60.0
    while len(found) < chunks and time.monotonic() < end:
        time.sleep(0.05)
    microphone.stop()
    assert len(found) >= chunks, microphone.state
    return found[:chunks]


def test_a_tone_comes_without_gaps_and_at_its_time() -> None:
    begin_ns = time.time_ns()
    chunks = heard("test", 12)
    assert [chunk.first for chunk in chunks] == [1600 * k for k in range(12)]
    assert all(begin_ns - 10**9 < chunk.taken_ns <= time.time_ns() for chunk in chunks)
    steps = np.diff([chunk.taken_ns for chunk in chunks])
    assert abs(steps.mean() - 1e8) < 2e7
    samples = np.concatenate([chunk.samples[:, 0] for chunk in chunks]).astype(float)
    spectrum = np.abs(np.fft.rfft(samples * np.hanning(len(samples))))
    assert abs(np.argmax(spectrum) * RATE_HZ / len(samples) - 440.0) < 2.0


def test_a_file_keeps_every_sample(tmp_path: Path) -> None:
    rng, path = np.random.default_rng(1), tmp_path / "a.flac"
    samples = rng.integers(-20000, 20000, (48_123, 1)).astype(np.int16)
    file, done = SoundFile(path, RATE_HZ, 1), 0
    while done < len(samples):
        count = int(rng.integers(300, 3000))
        # A gap of 5 s in the middle, and a clock of the sound card that is 0.1 % slow.
        file.write(samples[done : done + count], round(1e18 + done * 1.001e9 / RATE_HZ + 5e9 * (done > 20000)))
        done += count
    file.close()
    np.testing.assert_array_equal(read_sound(path), samples)
    for number in (0, 5000, 15000, 30000, 48_122):
        truth_ns = 1e18 + number * 1.001e9 / RATE_HZ + 5e9 * (number > 20000)
        assert abs(int(times_ns(path, [number])[0]) - truth_ns) < 1e9 if 17000 < number < 23000 else 2e7


def test_what_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="source = 'radio'"):
        source_text("radio")
    with pytest.raises(ConfigError, match="pipeline"):
        source_text("pipeline")
    path = tmp_path / "a.flac"
    file = SoundFile(path, RATE_HZ, 2)
    with pytest.raises(ConfigError, match=r"must be \(n, 2\)"):
        file.write(np.zeros((10, 1), np.int16), 0)
    file.write(np.zeros((1600, 2), np.int16), 0)
    file.write(np.zeros((1600, 2), np.int16), 100_000_000)
    file.close()
    with pytest.raises(SoundError, match="exists"):
        SoundFile(path, RATE_HZ, 2)
    assert read_sound(path).shape == (3200, 2)
    with pytest.raises(SoundError, match=r"nothing\.flac"):
        read_sound(tmp_path / "nothing.flac")
    (tmp_path / "b.flac").write_bytes(b"no sound")
    with pytest.raises(SoundError, match=r"b\.flac"):
        read_sound(tmp_path / "b.flac")


def test_the_beep_begins_at_full_seconds() -> None:
    chunks = heard("beep", 25)
    samples = np.concatenate([chunk.samples[:, 0] for chunk in chunks]).astype(float)
    times = np.concatenate([chunk.taken_ns + np.arange(len(chunk.samples)) * 62_500 for chunk in chunks])
    loud = times[np.abs(samples) > 5000.0] % 10**9
    assert len(loud) > 1600
    assert np.percentile(loud, 99.0) < 120_000_000  # a busy machine may hear a block a little later


def test_a_source_that_fails_says_so_and_is_tried_again() -> None:
    microphone = Microphone("alsasrc device=nobody_has_this", lambda chunk: None, retry_s=0.1)
    microphone.start()
    end = time.monotonic() + 60.0
    while microphone.failures < 2 and time.monotonic() < end:
        time.sleep(0.05)
    assert microphone.failures >= 2 and microphone.state.startswith("LOST: ")
    microphone.stop()


def test_numbers_go_on_by_time_when_a_source_came_back() -> None:
    found: list[Chunk] = []
    source = "audiotestsrc is-live=true num-buffers=25 samplesperbuffer=160"  # a quarter of a second, then its end
    microphone = Microphone(source, found.append, rate_hz=RATE_HZ, chunk_s=0.05, retry_s=0.3)
    microphone.start()
    end = time.monotonic() + 60.0
    while microphone.failures < 3 and time.monotonic() < end:
        time.sleep(0.05)
    microphone.stop()
    assert microphone.failures >= 3, microphone.state
    firsts = np.array([chunk.first for chunk in found])
    by_time = np.array([chunk.taken_ns - found[0].taken_ns for chunk in found]) * 1e-9 * RATE_HZ
    assert (np.diff(firsts) > 0.3 * RATE_HZ).sum() >= 2, "the silence in between has numbers too"
    assert np.abs(firsts - by_time).max() < 0.1 * RATE_HZ
