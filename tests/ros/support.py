"""Shared by the rostests: waiting with generous bounds, recording of topics, child processes."""

from __future__ import annotations

import contextlib
import subprocess
import sys
import time
from pathlib import Path

import rospy

from saras import Error
from saras.capture.video_file import read_index

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
from fakes.fake_console import FakeConsole  # noqa: F401

PATIENCE_S = 30.0


def wait_until(condition, what, patience_s=PATIENCE_S):
    """Returns condition()'s first true value; fails after patience_s, which is no claim about speed."""
    end = time.monotonic() + patience_s
    while time.monotonic() < end and not rospy.is_shutdown():
        value = condition()
        if value:
            return value
        time.sleep(0.02)
    raise AssertionError(f"not within {patience_s:g} s: {what() if callable(what) else what}")


class Newest:
    """The newest message of a topic and all of them since clear()."""

    def __init__(self, topic, message_class):
        self.topic, self.all = topic, []
        self.subscriber = rospy.Subscriber(topic, message_class, self.all.append, queue_size=500, tcp_nodelay=True)

    @property
    def message(self):
        return self.all[-1] if self.all else None

    def clear(self):
        self.all.clear()

    def next(self, what=""):
        """The next message from now on."""
        count = len(self.all)
        wait_until(lambda: len(self.all) > count, f"a message on {self.topic} {what}")
        return self.all[-1]


def spawn(executable, *arguments):
    """Starts a program of the package's devel space (or a path)."""
    path = executable if "/" in str(executable) else ROOT / "devel" / "lib" / "saras_ros1" / executable
    return subprocess.Popen([str(path), *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def frames_in(video):
    """So far, of a video that is perhaps being begun: its index comes a moment after it."""
    with contextlib.suppress(OSError, Error):
        return len(read_index(video))
    return 0


def pair_of_pictures(left, right, patience_s=PATIENCE_S, what=""):
    """Both pictures of one stamp, from now on; left, right: Newest of Image. what: said when none comes."""
    for image in (left, right):
        image.clear()

    def there():
        by_stamp = {message.header.stamp: message for message in list(right.all)}
        both = [(m, by_stamp[m.header.stamp]) for m in list(left.all) if m.header.stamp in by_stamp]
        return both[-1] if both else None

    return wait_until(there, lambda: f"two pictures of one stamp {what() if callable(what) else what}", patience_s)
