"""Key files: made once and for their owner alone; everything else is refused by name, and no message shows a key."""

from __future__ import annotations

import json
import stat

import pytest

from saras import ConfigError
from saras.cli import main
from saras.net import keys


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "saras.key"
    assert main(["keys", "make", str(path)]) == 0
    return path


def test_a_made_file_is_for_its_owner_alone_and_is_read_again(path, capsys):
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    made = keys.load(path)
    assert made.up != made.down and len(made.up) == len(made.down) == 32
    capsys.readouterr()
    assert main(["keys", "check", str(path)]) == 0
    shown = capsys.readouterr().out
    assert made.fingerprint() in shown and made.up.hex() not in shown and made.down.hex() not in shown
    assert made.up.hex() not in repr(made) and keys.draw().fingerprint() != made.fingerprint()


def test_a_file_that_exists_is_not_overwritten(path, capsys):
    before = path.read_bytes()
    assert main(["keys", "make", str(path)]) == 2
    assert "exists already" in capsys.readouterr().err and path.read_bytes() == before


@pytest.mark.parametrize("mode", [0o640, 0o604, 0o660, 0o644, 0o601])
def test_a_file_that_others_reach_is_refused(path, mode, capsys):
    path.chmod(mode)
    assert main(["keys", "check", str(path)]) == 2
    said = capsys.readouterr().err
    assert f"mode = {mode:04o}" in said and "0600" in said


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda c: c.update(down=c["up"]), "same key for both directions"),
        (lambda c: c.update(up=c["up"][:-2]), "31 bytes: must be 32"),
        (lambda c: c.update(up="zz" * 32), "up: must be 64 hexadecimal digits"),
        (lambda c: c.update(down=7), "down: must be 64 hexadecimal digits"),
        (lambda c: c.pop("down"), "down: must be 64 hexadecimal digits"),
        (lambda c: c.update(up="00" * 32), "not a random key"),
        (lambda c: c.update(version=2), "version = 2: must be 1"),
        (lambda c: c.update(format="other"), "format"),
        (lambda c: c.update(upp="1"), "upp: unknown field"),
    ],
)
def test_a_spoilt_file_is_refused_by_name(path, change, words):
    content = json.loads(path.read_text())
    secret = content["up"]
    change(content)
    path.write_text(json.dumps(content))
    with pytest.raises(ConfigError, match=words) as refusal:
        keys.load(path)
    assert str(path) in str(refusal.value) and secret[:16] not in str(refusal.value)


def test_what_is_no_key_file_is_refused(path, tmp_path):
    path.write_text("not JSON")
    with pytest.raises(ConfigError, match="not JSON"):
        keys.load(path)
    path.write_text(" " * 5000)
    with pytest.raises(ConfigError, match="more than 4096 bytes"):
        keys.load(path)
    with pytest.raises(ConfigError, match="saras keys make"):
        keys.load(tmp_path / "nowhere")
    tmp_path.chmod(0o700)
    with pytest.raises(ConfigError):
        keys.load(tmp_path)
