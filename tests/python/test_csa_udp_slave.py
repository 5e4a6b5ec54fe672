"""The stand-alone slaves of examples/udp_slave: the same bytes as ours, and the platform's end over real sockets."""

from __future__ import annotations

import json
import shutil
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from saras import ConfigError
from saras.console.link import Address
from saras.csa.udp import GateConfig, HoldReason, PlatformLink, RemoteSlave, RemoteSlaveConfig, SlaveLink
from saras.kinematics import dvrk
from saras.net import CsaDown, CsaHold, CsaMode, CsaSlaveState, CsaUp, seal
from saras.net import keys as key_files
from saras.net.trust import tag

HERE = Path(__file__).resolve().parents[2] / "examples" / "udp_slave"
VECTORS = json.loads((HERE / "vectors.json").read_text())
REACH = (0.3, 0.3, 0.02, 0.3, 0.3, 0.3)


@pytest.fixture(scope="module")
def c_slave(tmp_path_factory):
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")
    made = tmp_path_factory.mktemp("slave") / "udp_slave"
    flags = ["-std=c11", "-O2", "-Wall", "-Wextra", "-Werror", "-fsanitize=address,undefined"]
    if subprocess.run(
        [compiler, *flags, "-x", "c", "-", "-o", made], input=b"int main(void) {}", check=False
    ).returncode:
        flags.pop()
    subprocess.run([compiler, *flags, "-o", made, HERE / "udp_slave.c", "-lm"], check=True)
    return made


# ---- the same bytes


def packet(case):
    kind = {"up": CsaUp, "down": CsaDown}[case["kind"]]
    fields = dict(case["fields"])
    enums = {"mode": CsaMode, "hold": CsaHold, "state": CsaSlaveState}
    return kind(**{name: getattr(enums[name], value) if name in enums else value for name, value in fields.items()})


def encoded(case):
    key = bytes.fromhex(case["session_key"])
    data = packet(case).encode(bool(key))
    return seal(data, tag(key, data)) if key else data


@pytest.mark.parametrize("case", VECTORS, ids=lambda case: case["name"])
def test_the_vectors_are_what_our_codec_makes(case):
    assert encoded(case).hex() == case["datagram"]


@pytest.mark.parametrize("case", [v for v in VECTORS if v["kind"] == "up"], ids=lambda case: case["name"])
def test_the_vectors_are_what_the_c_slave_makes(c_slave, case):
    key = ["--session-key", case["session_key"]] if case["session_key"] else []
    joints = str(len(case["fields"]["position"]))
    done = subprocess.run([c_slave, "--joints", joints, *key, "--example"], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == case["datagram"]


def c_decode(c_slave, data, key=""):
    done = subprocess.run(
        [c_slave, *(["--session-key", key] if key else []), "--decode", data.hex()],
        capture_output=True,
        text=True,
        check=False,
    )
    assert "Sanitizer" not in done.stderr, done.stderr
    return done.stdout.strip()


@pytest.mark.parametrize("case", [v for v in VECTORS if v["kind"] == "down"], ids=lambda case: case["name"])
def test_the_c_slave_reads_the_vectors_and_refuses_every_damage(c_slave, case):
    data, fields = bytes.fromhex(case["datagram"]), case["fields"]
    words = c_decode(c_slave, data, case["session_key"]).split()
    told = dict(zip(words[0:10:2], words[1:10:2]))
    mode = getattr(CsaMode, fields["mode"])
    assert (int(told["session"]), int(told["seq"])) == (fields["session"], fields["seq"])
    assert (int(told["engagement"]), int(told["mode"])) == (fields["engagement"], mode.value)
    q = fields.get("position", [])
    assert int(told["joints"]) == len(q)
    assert [float(w) for w in words[10 : 10 + len(q)]] == q
    assert words[10 + len(q)] == "tip"
    tip = [*fields.get("tip_position_m", [0, 0, 0]), *fields.get("tip_quaternion_xyzw", [0, 0, 0, 1])]
    assert [float(w) for w in words[11 + len(q) :]] == tip
    for at in range(0, len(data), 7):
        spoilt = bytearray(data)
        spoilt[at] ^= 1 << at % 8
        assert c_decode(c_slave, bytes(spoilt), case["session_key"]).startswith("refused: ")
    for size in (0, 1, len(data) - 1, len(data) + 1, 2000):
        assert c_decode(c_slave, (data + bytes(2000))[:size], case["session_key"]) == "refused: size"
    other = "" if case["session_key"] else "11" * 32
    assert c_decode(c_slave, data, other).startswith("refused: ")


def test_the_c_slave_is_the_psm_that_we_know(c_slave):
    rng = np.random.default_rng(1)
    psm = dvrk.psm()
    lower, upper = np.asarray(psm.limits).T
    for _ in range(20):
        q = rng.uniform(lower, upper)
        done = subprocess.run(
            [c_slave, "--forward", *map(repr, q.tolist())], capture_output=True, text=True, check=True
        )
        numbers = np.array(done.stdout.split(), dtype=float)
        pose = psm.forward(q)
        np.testing.assert_allclose(numbers[:3], pose[:3, 3], atol=1e-12)
        np.testing.assert_allclose(numbers[3:].reshape(3, 3), pose[:3, :3], atol=1e-9)


# ---- over real sockets


class Platform:
    """Our end against a slave in a process of its own."""

    def __init__(self, joints=6, keys=None, tmp_path=None):
        self.key_path = None
        if keys is not None:
            self.key_path = tmp_path / "link.keys"
            key_files.save(self.key_path, keys)
        self.joints = joints
        # The slave's port is not known before it runs: it is told in start().
        placeholder = SlaveLink(Address("127.0.0.1", 0), Address("127.0.0.1", 9))
        slave_port = placeholder.address.port
        placeholder.close()
        self.link = PlatformLink(Address("127.0.0.1", 0), Address("127.0.0.1", slave_port), 5.0, keys)
        self.slave_port, self.process = slave_port, None
        reach = REACH if joints == 6 else (0.3, *REACH)
        # A busy machine is no fault here: patience instead of the platform's own limits.
        gate = GateConfig(joint_reach=reach, timeout_s=2.0)
        self.remote = RemoteSlave(RemoteSlaveConfig(gate, state_timeout_s=2.0, begin_timeout_s=10.0))

    def start(self, command, *more):
        key = ["--key", str(self.key_path)] if self.key_path else []
        joints = ["--joints", str(self.joints)] if self.joints != 6 else []
        addresses = ["--listen", f"127.0.0.1:{self.slave_port}", "--platform", str(self.link.address)]
        patience = ["--timeout-s", "2"]  # for the same reason
        self.process = subprocess.Popen([*map(str, command), *addresses, *key, *joints, *patience, *more])

    def tick(self, set_point=None):
        now = time.monotonic_ns()
        up = self.link.poll(now)
        if up is not None:
            self.remote.take(up)
        if set_point is not None and self.remote.up is not None:
            servo = self.remote.servo_cp if np.shape(set_point) == (4, 4) else self.remote.servo_jp
            servo(np.asarray(set_point), now)
        self.link.send(self.remote.step(now, self.link.age_s(now)), now)
        time.sleep(0.005)

    def until(self, condition, what, set_point=None, patience_s=30.0):
        """set_point: a function of where the slave stands, or None."""
        end = time.monotonic() + patience_s
        while time.monotonic() < end:
            self.tick(None if set_point is None or self.remote.up is None else set_point(self.remote.up))
            if condition():
                return
        raise AssertionError(f"{what}: {self.remote.hold} {self.link.counts()} {self.link.last_refusal}")

    def engage(self, command="enable"):
        self.until(lambda: self.remote.ready, "the slave")
        self.remote.state_command(command)

    def go(self, goal):
        """Joints, in steps that are within reach."""
        limit = np.array(self.remote.config.gate.joint_reach) * 0.3

        def towards(up):
            return up.position + np.clip(goal - up.position, -limit, limit)

        self.until(lambda: np.abs(self.remote.up.position - goal).max() < 1e-3, "there", towards)

    def stop(self, how=signal.SIGTERM):
        if self.process is not None:
            self.process.send_signal(how)
            self.process.wait(20)
            self.process = None


@contextmanager
def platform(*args, **kwargs):
    made = Platform(*args, **kwargs)
    try:
        yield made
    finally:
        if made.process is not None:
            made.process.kill()
            made.process.wait()
        made.link.close()


@pytest.fixture(params=["c", "python"])
def command(request):
    if request.param == "c":
        return [request.getfixturevalue("c_slave")]
    return [sys.executable, HERE / "udp_slave.py"]


@pytest.mark.parametrize("keyed", [False, True], ids=["open", "keyed"])
def test_it_follows_holds_and_comes_back_by_the_documented_steps(command, keyed, tmp_path):
    keys = key_files.draw() if keyed else None
    with platform(keys=keys, tmp_path=tmp_path) as end:
        end.start(command)
        end.engage()
        start = end.remote.up.position.copy()
        goal = start + np.array([0.3, -0.2, 0.05, 0.5, 0.2, 0.4])
        end.go(goal)
        np.testing.assert_allclose(end.remote.up.base_T_tip, dvrk.psm().forward(end.remote.up.position), atol=1e-9)
        assert not end.remote.up.has_force
        pose = np.asarray(end.remote.up.base_T_tip).copy()
        pose[:3, 3] += [0.004, -0.003, 0.005]
        end.until(
            lambda: np.linalg.norm(end.remote.up.base_T_tip[:3, 3] - pose[:3, 3]) < 1e-4, "the pose", lambda up: pose
        )
        # Who sends the set-points is silent: hold at both ends, until resume.
        end.until(lambda: end.remote.hold is HoldReason.SET_POINT_LOST, "the hold")
        end.until(lambda: end.remote.up.hold != CsaHold.NONE, "the slave's own hold")
        stood = end.remote.up.position.copy()
        for _ in range(30):
            end.tick(goal)  # nothing moves by itself
        np.testing.assert_allclose(end.remote.up.position, stood, atol=1e-9)
        end.engage("resume")
        end.go(stood + np.array([0.1, 0, 0, 0, 0, 0]))
        # The slave dies and is started anew: a hold with a name; it stands where it began until resume.
        end.stop(signal.SIGKILL)
        lost = (HoldReason.SLAVE_LOST, HoldReason.SET_POINT_LOST)
        end.until(lambda: end.remote.hold in lost, "the hold", lambda up: up.position)
        end.start(command)
        end.engage("resume")
        np.testing.assert_allclose(end.remote.up.position, start, atol=1e-9)
        end.go(start + 0.01)
        if keyed:
            assert end.link.counts()["handshakes"] == 2
        end.stop()


def test_seven_joints(c_slave):
    with platform(joints=7) as end:
        end.start([c_slave])
        end.engage()
        start = end.remote.up.position.copy()
        assert len(start) == 7
        end.go(start + np.array([0.4, 0.1, 0, 0.02, 0, 0, 0.1]))
        q = end.remote.up.position
        turned = np.asarray(dvrk.psm().forward(q[1:])).copy()
        c, s = np.cos(q[0]), np.sin(q[0])
        turn = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
        np.testing.assert_allclose(end.remote.up.base_T_tip, turn @ turned, atol=1e-9)


def test_a_set_point_far_away_is_refused_by_the_slave_itself(command):
    with platform() as end:
        end.start(command)
        end.until(lambda: end.remote.up is not None, "the slave")
        start = end.remote.up.position.copy()
        far = CsaDown(mode=CsaMode.JOINTS, position=start + 0.5, engagement=77)

        def refused():
            end.link.send(far, time.monotonic_ns())
            up = end.link.poll(time.monotonic_ns())
            time.sleep(0.01)
            return up is not None and up.engagement == 77 and up.hold == CsaHold.REFUSED

        end_s = time.monotonic() + 30
        while not refused():
            assert time.monotonic() < end_s
        np.testing.assert_array_equal(end.link.newest.position, start)


def test_other_keys_and_none_are_not_heard(c_slave, tmp_path):
    with platform(keys=key_files.draw(), tmp_path=tmp_path) as end:
        end.key_path.unlink()
        key_files.save(end.key_path, key_files.draw())
        end.start([c_slave])
        end.until(lambda: end.link.counts()["unauthenticated"] > 3, "refusals")
        end.stop()
        end.key_path = None
        before = end.link.counts()["unauthenticated"]
        end.start([c_slave])
        end.until(lambda: end.link.counts()["unauthenticated"] > before + 3, "refusals")
        assert end.remote.up is None and end.link.counts()["accepted"] == 0


def test_without_keys_only_loopback(c_slave, tmp_path):
    with pytest.raises(ConfigError, match="loopback"):
        PlatformLink(Address("0.0.0.0", 0), Address("127.0.0.1", 9))
    done = subprocess.run([c_slave, "--listen", "0.0.0.0:0"], capture_output=True, text=True, check=False)
    assert done.returncode == 2 and "loopback" in done.stderr
    readable = tmp_path / "keys"
    key_files.save(readable, key_files.draw())
    readable.chmod(0o644)
    done = subprocess.run([c_slave, "--key", readable], capture_output=True, text=True, check=False)
    assert done.returncode == 2 and "others can read it" in done.stderr
