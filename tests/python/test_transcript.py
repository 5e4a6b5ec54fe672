"""What was said comes to the session's time by the sound's samples."""

from __future__ import annotations

from pathlib import Path

import pytest

from saras import Error
from saras.capture.sound_index import INDEX_HEAD, index_path
from saras.recording.transcript import Utterance, aligned, read

SRT = """1
00:00:01,500 --> 00:00:02,250
move the <i>left</i> arm
a little

2
00:00:04,000 --> 00:00:05,000
clip now
"""
VTT = """WEBVTT

00:01.500 --> 00:02.250 align:start
move the left arm
a little

01:00:04.5 --> 01:00:05.000
clip now
"""
CSV = "start_s,end_s,text\n4,5,clip now\n1.5,2.25,move the left arm a little\n"
FIRST = Utterance(1.5, 2.25, "move the left arm a little")


@pytest.mark.parametrize(
    ("name", "text", "second"),
    [("a.srt", SRT, 4.0), ("a.vtt", VTT, 3604.5), ("a.csv", CSV, 4.0)],
)
def test_three_formats(tmp_path: Path, name: str, text: str, second: float) -> None:
    path = tmp_path / name
    path.write_text(text, encoding="utf-8-sig")
    found = read(path)
    assert found[0] == FIRST and found[1].start_s == second and found[1].text == "clip now"


def test_a_slow_sound_card_and_a_gap_are_followed(tmp_path: Path) -> None:
    sound, rate_hz = tmp_path / "session_audio.flac", 16000
    rows = []
    for k in range(100):  # 0.1 s of samples each; the card is 0.2 % slow, and 3 s are missing after 5 s
        stamp_ns = 10**18 + round(k * 0.1002e9) + (3_000_000_000 if k >= 50 else 0)
        rows.append(f"{1600 * k},{stamp_ns}\n")
    index_path(sound).write_text(INDEX_HEAD + "".join(rows), encoding="utf-8")
    before, after = aligned([FIRST, Utterance(6.0, 7.0, "x")], sound, rate_hz, 10**18 - 2_000_000_000)
    assert before.start_s == pytest.approx(2.0 + 1.5 * 1.002, abs=1e-6)
    assert after.start_s == pytest.approx(2.0 + 3.0 + 6.0 * 1.002, abs=1e-6)
    assert after.end_s - after.start_s == pytest.approx(1.002, abs=1e-6) and after.text == "x"


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("a.srt", "nothing", "no utterance"),
        ("a.csv", "start_s,end_s,text\n3,2,x\n", "a.csv:2: from 3 to 2 s"),
        ("a.csv", "start_s,end_s,text\nsoon,2,x\n", "a.csv:2: must have numbers"),
        ("a.csv", "from,to\n1,2\n", "a.csv:2"),
    ],
)
def test_what_is_refused(tmp_path: Path, name: str, text: str, words: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(Error, match=words):
        read(tmp_path / name)
    with pytest.raises(Error, match="No such file"):
        read(tmp_path / "nowhere.srt")
