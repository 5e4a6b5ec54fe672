"""What arm_driver and arm_state share: opening the driver that the parameters name, and times between clocks."""

from __future__ import annotations

import time
from typing import Any

import rospy

from saras.mesa_link import ArmDriver, ArmLinkError, Received, load_driver
from saras_ros1.node import Node, StartupError


def open_driver(node: Node, *, control: bool, **options: Any) -> ArmDriver:
    """The plug-in of ~driver at ~url, connected within ~connect_wait_s, else StartupError saying what is missing.

    options: further keywords of the driver (state_rate_hz, truth_rate_hz, on_state, on_truth).
    """
    name, url = node.params.text("driver"), node.params.text("url")
    wait_s = node.params.number("connect_wait_s", 0.1, 600.0)
    driver = load_driver(name)(url=url, client=node.name, control=control, **options)
    rospy.on_shutdown(driver.close)
    try:
        driver.connect(wait_s)
    except ArmLinkError as error:
        driver.close()
        raise StartupError(f"{error}: does the arm's server run?") from None
    return driver


def stamp_of(received: Received) -> rospy.Time:
    """ROS time of a state: its arrival less its lag, so that stamps are as even as the arm's own clock."""
    ago_s = time.monotonic() - received.received_s + received.lag_s
    return rospy.Time.from_sec(rospy.get_time() - ago_s)
