"""recorder: keeps rosbag's recorder going, and says everywhere when the session is not being recorded.

Services: start, stop, annotate. rosbag runs as a process of its own: nothing here can hold up control.
"""

from __future__ import annotations

import json
import os
import time
from datetime import datetime
from pathlib import Path

import rosgraph
import rospy
import yaml
from diagnostic_msgs.msg import DiagnosticStatus
from std_msgs.msg import String
from std_srvs.srv import Trigger, TriggerResponse

from saras import ConfigError
from saras_ros1.bag_process import BagProcess
from saras_ros1.channel import SIDES
from saras_ros1.msg import RecorderState
from saras_ros1.node import Node, run
from saras_ros1.recording_watch import Look, RecordingLimits, RecordingWatch, free_bytes, writable
from saras_ros1.srv import Annotate, AnnotateResponse, StartRecording, StartRecordingResponse

LOOK_S = 0.2
RESTART_S = 1.0
KINDS = ("action", "misunderstanding", "note")


class Recorder(Node):
    """One recording at a time."""

    def __init__(self) -> None:
        super().__init__("recorder")
        directory = self.params.text("directory", empty=True)
        home = Path(os.environ.get("ROS_HOME", "~/.ros")).expanduser()
        self.directory = Path(directory).expanduser() if directory else home
        self.prefix = self.params.text("prefix")
        self.chunk_kB = self.params.integer("chunk_kB", 1, 4096)
        self.split_MB = self.params.integer("split_MB", 0, 100_000)
        min_free_MB = self.params.number("min_free_MB", 1.0, 1e6)
        self.limits = RecordingLimits(
            stall_s=self.params.number("stall_s", 0.5, 30.0),
            min_free_B=1e6 * min_free_MB,
            warn_free_B=1e6 * self.params.number("warn_free_MB", min_free_MB, 1e9),
            behind_s=self.params.number("behind_s", 1.0, 600.0),
        )
        self.restart = self.params.flag("restart")
        self.topics = read_topics(Path(self.params.text("topics_file")))
        start, path = self.params.flag("start"), self.params.text("bag", empty=True)
        self.params.finish()
        self.bag: BagProcess | None = None
        self.watch: RecordingWatch | None = None
        self.wanted, self.reason, self.path, self.recording = False, "not started", "", False
        self.started_s = self.died_s = 0.0
        self.free_B = self.left_s = self.behind_s = float("nan")
        self.bytes = 0
        self._events = self.output("/system/events", String)
        self._state = self.output("/recorder/state", RecorderState, latch=True)
        self._annotations = self.output("/recorder/annotations", String)
        rospy.Service("~start", StartRecording, self._on_start)
        rospy.Service("~stop", Trigger, self._on_stop)
        rospy.Service("~annotate", Annotate, self._on_annotate)
        rospy.on_shutdown(self._end)
        if start:
            done, said = self._begin(path)
            (rospy.loginfo if done else rospy.logerr)(said)
        self.every(LOOK_S, self._look)

    def _begin(self, path: str) -> tuple[bool, str]:
        """Pre-flight checks, then the child. With the lock, or before anybody else runs."""
        if self.bag is not None:
            return False, f"already recording {self.path}: stop it first"
        target = Path(path).expanduser() if path else self._new_name()
        if not target.is_absolute():
            return self._refuse(f"path = {path!r}: must be absolute")
        target = target.with_name(target.name.removesuffix(".bag") + ".bag")
        if why := writable(str(target.parent)):
            return self._refuse(why)
        if target.exists() or list(target.parent.glob(target.name + ".*")):
            return self._refuse(f"{target}: exists")
        free_B = free_bytes(str(target.parent))
        if not free_B >= self.limits.min_free_B:
            least = f"must be >= {self.limits.min_free_B / 1e6:.0f}"
            return self._refuse(f"{target.parent}: {free_B / 1e6:.0f} MB free: {least}")
        self.started_s = time.monotonic()
        self.bag = BagProcess(target, self.topics, chunk_kB=self.chunk_kB, split_MB=self.split_MB)
        self.watch = RecordingWatch(self.limits, self.started_s)
        self.wanted, self.path, self.bytes, self.reason = True, str(target), 0, "starting"
        silent = self._unpublished()
        said = f"recording {target}"
        return True, said + (f"; nobody publishes yet: {', '.join(silent)}" if silent else "")

    def _refuse(self, why: str) -> tuple[bool, str]:
        self.reason = why
        return False, f"not recording: {why}"

    def _new_name(self) -> Path:
        return self.directory / f"{self.prefix}_{datetime.now():%Y-%m-%d_%H-%M-%S}.bag"

    def _unpublished(self) -> list[str]:
        try:
            publishers, _, _ = rosgraph.Master(self.name).getSystemState()
        except (OSError, rosgraph.MasterException):
            return []
        published = {topic for topic, _ in publishers}
        return [topic for topic in self.topics if topic not in published]

    def _look(self) -> None:
        with self.lock:
            if self.bag is not None and self.watch is not None:
                self._judge(self.bag, self.watch)
            elif self.wanted and self.restart and time.monotonic() - self.died_s > RESTART_S:
                done, said = self._begin("")
                self._tell(said) if done else None
            self._publish()

    def _judge(self, bag: BagProcess, watch: RecordingWatch) -> None:
        self.bytes, self.free_B = bag.bytes(), free_bytes(str(bag.path.parent))
        newest_ns = bag.newest_ns()
        self.behind_s = float("nan") if newest_ns is None else 1e-9 * (time.time_ns() - newest_ns)
        verdict = watch.look(Look(time.monotonic(), self.bytes, bag.exit_code, self.free_B, self.behind_s))
        was, self.recording, self.left_s = self.recording, verdict.recording, verdict.left_s
        news = verdict.reason != self.reason and (not verdict.recording or was != verdict.recording)
        self.reason = verdict.reason
        if verdict.stop:
            died = bag.exit_code is not None
            bag.stop()
            self.bag = self.watch = None
            self.died_s = time.monotonic()
            self.wanted = self.wanted and died  # a full disk stays full until somebody starts again
            if left := bag.unfinished():
                self.reason += f"; saras bag repair {' '.join(map(str, left))}"
        if news:
            self._tell(f"recording {self.path}" if verdict.recording else f"NOT RECORDING: {self.reason}")

    def _tell(self, text: str) -> None:
        (rospy.loginfo if self.recording else rospy.logerr)(text)
        self._events.publish(String(text))

    def _publish(self) -> None:
        state = RecorderState(recording=self.recording, wanted=self.wanted, path=self.path, bytes=self.bytes)
        state.header.stamp = rospy.Time.now()
        state.duration = time.monotonic() - self.started_s if self.bag is not None else 0.0
        state.free, state.left, state.reason = self.free_B, self.left_s, self.reason
        self._state.publish(state)

    def _on_start(self, request) -> StartRecordingResponse:
        with self.lock:
            done, said = self._begin(request.path)
        return StartRecordingResponse(done, said)

    def _on_stop(self, _) -> TriggerResponse:
        with self.lock:
            if self.bag is None:
                self.wanted = False
                return TriggerResponse(False, f"not recording: {self.reason}")
            self._end()
            return TriggerResponse(True, f"{self.path}: {self.bytes / 1e6:.1f} MB")

    def _end(self) -> None:
        with self.lock:
            if self.bag is None:
                return
            self.bag.stop()
            self.bytes = self.bag.bytes()
            self.bag = self.watch = None
            self.wanted = self.recording = False
            self.reason = "stopped"

    def _on_annotate(self, request) -> AnnotateResponse:
        if request.kind not in KINDS:
            return AnnotateResponse(False, f"kind = {request.kind!r}: must be one of {', '.join(KINDS)}")
        if not request.label:
            return AnnotateResponse(False, "label = '': must not be empty")
        mark = {"stamp_ns": rospy.Time.now().to_nsec(), "kind": request.kind}
        mark.update(label=request.label, text=request.text)
        self._annotations.publish(String(json.dumps(mark, ensure_ascii=False)))
        with self.lock:
            return AnnotateResponse(self.recording, "marked" if self.recording else f"NOT RECORDING: {self.reason}")

    def _diagnose(self) -> DiagnosticStatus:
        """As every node's; not recording is an error when somebody wants it, else a warning."""
        status = super()._diagnose()
        if not self.recording:
            status.level = DiagnosticStatus.ERROR if self.wanted else DiagnosticStatus.WARN
            status.message = f"NOT RECORDING: {self.reason}"
        elif self.reason:
            status.level, status.message = DiagnosticStatus.WARN, self.reason
        return status

    def report(self) -> dict:
        """The bag and its size."""
        values = {"bag": self.path, "MB": round(self.bytes / 1e6, 1), "free_MB": round(self.free_B / 1e6, 0)}
        return {**values, "behind_s": round(self.behind_s, 1)}


def read_topics(path: Path) -> list[str]:
    """Names in a file of topics; {s} stands for both sides. Raises ConfigError naming the file."""
    try:
        patterns = yaml.safe_load(path.read_text(encoding="utf-8"))["topics"]
        return list(dict.fromkeys(pattern.format(s=side) for pattern in patterns for side in SIDES))
    except (OSError, yaml.YAMLError, KeyError, TypeError, AttributeError) as error:
        raise ConfigError(f"topics_file = {str(path)!r}: must be a file with a list 'topics': {error}") from None


def main() -> int:
    """Runs the node."""
    return run(Recorder)
