"""The benchmark's peers compute what saras computes; else their times would mean nothing."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))
import pipeline
import struct_codec

from saras import net


def test_numpy_laws_equal_ours(many):
    assert pipeline.worst_difference(ticks=200 if many == 1 else 1000) <= 1e-9


def test_struct_codec_writes_our_bytes():
    for packet, encode, cls in (
        (struct_codec.example_up(), struct_codec.encode_up, net.TouchballUp),
        (struct_codec.example_down(), struct_codec.encode_down, net.TouchballDown),
    ):
        data = encode(packet)
        assert cls.decode(data).encode() == data


def test_struct_codec_refuses_a_flipped_bit():
    data = bytearray(struct_codec.encode_up(struct_codec.example_up()))
    data[40] ^= 1
    with pytest.raises(ValueError, match="checksum"):
        struct_codec.decode_up(bytes(data))


@pytest.mark.parametrize("rectified", [True, False])
def test_opencv_draws_our_overlay(rectified):
    pytest.importorskip("cv2")
    import overlay

    for frame in overlay.frames()[:10]:
        assert overlay.same_lines(frame, rectified) >= overlay.LEAST_SHARE


def test_rosbag_and_pandas_read_what_our_export_reads(tmp_path):
    for library in ("rosbag", "rosbags", "pandas", "pyarrow"):
        pytest.importorskip(library)
    import recording
    import synthetic_session

    assert recording.check(synthetic_session.write_session(tmp_path / "s.bag", 2.0)) == 0.0
