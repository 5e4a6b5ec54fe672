"""What a node believes of /system/{side}/state: nothing old, nothing that began before the node itself."""

import threading
from types import SimpleNamespace

import pytest

rospy = pytest.importorskip("rospy")
from saras_ros1.msg import ChannelState

from saras_ros1.channel import STATE_TIMEOUT_S, Channel
from saras_ros1.inputs import Input

ENGAGED, HOLD, READY = ChannelState.ENGAGED, ChannelState.HOLD, ChannelState.READY


class Supervisor:
    """Its messages, straight into one channel."""

    def __init__(self, **options):
        node = SimpleNamespace(
            heard_channels=[], input=lambda topic, kind, timeout_s: Input(topic, timeout_s, None, threading.RLock())
        )
        self.channel = Channel(node, "left", **options)
        self.seq = 0

    def says(self, state, engagement):
        self.seq += 1
        self.channel.input.on_message(ChannelState(seq=self.seq, state=state, engagement=engagement))

    def restarts(self):
        self.seq = 0


def test_an_engagement_is_new_once():
    supervisor = Supervisor()
    supervisor.says(READY, 0)
    assert not supervisor.channel.engaged and not supervisor.channel.newly_engaged()
    for _ in range(2):
        supervisor.says(ENGAGED, 1)
    assert supervisor.channel.engaged
    assert [supervisor.channel.newly_engaged() for _ in range(3)] == [True, False, False]


def test_silence_is_hold():
    supervisor = Supervisor()
    supervisor.says(READY, 0)
    supervisor.says(ENGAGED, 1)
    supervisor.channel.input.received_s -= 2.0 * STATE_TIMEOUT_S
    assert supervisor.channel.state == HOLD


def test_an_engagement_older_than_the_node_is_hold_until_the_next_one():
    supervisor = Supervisor()
    for _ in range(3):
        supervisor.says(ENGAGED, 4)
        assert supervisor.channel.inherited and not supervisor.channel.engaged
        assert supervisor.channel.state == HOLD and not supervisor.channel.newly_engaged()
    supervisor.says(HOLD, 4)
    assert not supervisor.channel.inherited
    supervisor.says(ENGAGED, 5)
    assert supervisor.channel.engaged and supervisor.channel.newly_engaged()


def test_a_node_that_nobody_waits_for_takes_part_at_once():
    supervisor = Supervisor(inherits=True)
    supervisor.says(ENGAGED, 4)
    assert supervisor.channel.engaged and not supervisor.channel.inherited


def test_a_restarted_supervisor_begins_at_one_and_its_engagement_is_new():
    supervisor = Supervisor()
    supervisor.says(READY, 0)
    supervisor.says(ENGAGED, 1)
    assert supervisor.channel.newly_engaged()
    supervisor.restarts()
    supervisor.says(READY, 0)
    assert not supervisor.channel.newly_engaged()
    supervisor.says(ENGAGED, 1)
    assert supervisor.channel.newly_engaged()
    assert supervisor.channel.engagement == 2  # the guards grant their charge to a larger number only
