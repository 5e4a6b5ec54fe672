"""saras bag check on videos and sound beside a bag: whole ones are, and each damage is named."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("rosbags")
pytest.importorskip("gi")
pytest.importorskip("cv2")

import synthetic_session as synthetic

from saras import cli
from saras.capture import sound_index, video_file
from saras.capture.sound import SoundFile
from saras.capture.video_file import VideoFile
from saras.recording.beside import beside, check_beside

FRAMES, SIZE, RATE_HZ = 40, (160, 120), 16000


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A bag with both eyes' videos, which have as many pictures as the bag names, and sound."""
    folder = tmp_path_factory.mktemp("whole")
    bag = synthetic.BagWriter(folder / "s.bag")
    for side in ("left", "right"):
        with VideoFile(folder / f"s_{side}.mkv", SIZE, 15.0) as video:
            for k in range(FRAMES):
                stamp_ns = synthetic.START_NS + k * 66_000_000
                video.write(np.full((SIZE[1], SIZE[0], 3), 6 * k, np.uint8), stamp_ns, seq=k + 7)
                if k >= 3:  # the bag's recorder came a little later
                    topic = f"/recorder/video/{side}"
                    head = bag.header(topic, 0.066 * k)
                    fields = {"header": head, "frame": k, "file": f"s_{side}.mkv"}
                    bag.put(topic, "saras_ros1/msg/VideoFrame", 0.066 * k, **fields)
    bag.close()
    sound = SoundFile(folder / "s_audio.flac", RATE_HZ, 1)
    for k in range(30):
        sound.write(np.full((1600, 1), 100 * k, np.int16), synthetic.START_NS + k * 100_010_000)
    sound.close()
    return folder / "s.bag"


@pytest.fixture
def session(whole: Path, tmp_path: Path) -> Path:
    """A copy that may be damaged."""
    for file in whole.parent.iterdir():
        shutil.copy(file, tmp_path)
    return tmp_path / whole.name


def named(bag: Path) -> set[tuple[str, str]]:
    return {(finding.topic, finding.what) for finding in check_beside(bag).findings}


def test_a_whole_session_is_whole_and_says_its_numbers(whole: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = check_beside(whole)
    assert not found.findings
    assert found.lines == [
        "s_left.mkv: 40 pictures of the camera, 0 lost on the way, 37 named in the bag, 40 frames decode",
        "s_right.mkv: 40 pictures of the camera, 0 lost on the way, 37 named in the bag, 40 frames decode",
        "s_audio.flac: 2.9 s of sound, 0 gaps, 48000 samples decode",
    ]
    assert cli.main(["bag", "check", str(whole), "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["numbers"] == {"messages": 74, "counted": 74, "lost": 0} and answer["beside"] == found.lines
    assert cli.main(["bag", "check", str(whole), "--quick"]) == 0
    shown = capsys.readouterr().out
    assert "74 messages, 74 of them numbered, 0 lost" in shown and "decode" not in shown


def test_a_video_that_was_cut(session: Path) -> None:
    video = session.with_name("s_left.mkv")
    video.write_bytes(video.read_bytes()[: video.stat().st_size // 2])
    assert named(session) == {("s_left.mkv", "video")}


def test_a_missing_video_and_index(session: Path) -> None:
    session.with_name("s_left.mkv").unlink()
    video_file.index_path(session.with_name("s_left.mkv")).unlink()
    video_file.index_path(session.with_name("s_right.mkv")).unlink()
    assert named(session) == {("s_left.mkv", "video"), ("s_right.mkv", "video")}


def test_pictures_that_did_not_reach_the_video(session: Path) -> None:
    path = video_file.index_path(session.with_name("s_right.mkv"))
    lines = path.read_text().splitlines()
    shifted = [f"{int(f)},{s},{int(n) + 5 * (int(f) > 20)}" for f, s, n in (line.split(",") for line in lines[1:])]
    path.write_text("\n".join([lines[0], *shifted, ""]))
    found = check_beside(session)
    assert [(one.topic, one.what, one.value) for one in found.findings] == [("s_right.mkv", "lost", 5)]


def test_another_stamp_than_in_the_bag(session: Path) -> None:
    path = video_file.index_path(session.with_name("s_left.mkv"))
    path.write_text(path.read_text().replace(f"{synthetic.START_NS + 10 * 66_000_000}", f"{synthetic.START_NS + 1}"))
    assert named(session) == {("s_left.mkv", "video")}


def test_sound_with_a_gap_and_cut_sound(session: Path) -> None:
    path = sound_index.index_path(session.with_name("s_audio.flac"))
    lines = path.read_text().splitlines()
    late = [f"{s},{int(t) + 2 * 10**9 * (int(s) > 20000)}" for s, t in (line.split(",") for line in lines[1:])]
    path.write_text("\n".join([lines[0], *late, ""]))
    (one,) = check_beside(session).findings
    assert (one.topic, one.what) == ("s_audio.flac", "lost") and one.value == pytest.approx(2.0, abs=0.01)
    sound = session.with_name("s_audio.flac")
    sound.write_bytes(sound.read_bytes()[: sound.stat().st_size // 2])
    assert ("s_audio.flac", "sound") in named(session)


def test_what_is_beside_a_repaired_bag_is_that_of_the_bag(session: Path) -> None:
    names = ("s.bag", "s.bag.active", "s.repaired.bag")
    assert {beside(session.with_name(name), "left.mkv").name for name in names} == {"s_left.mkv"}
    session.rename(session.with_name("s.repaired.bag"))
    found = check_beside(session.with_name("s.repaired.bag"))
    assert len(found.lines) == 3 and not found.findings


def test_a_bag_that_was_not_closed_is_said(session: Path) -> None:
    session.write_bytes(session.read_bytes()[:-200])
    assert ("", "video") in named(session)
