#!/usr/bin/env python3
"""Every process of the whole graph is killed, one after the other: who needs it holds by his own watchdog.

The nodes are those that run; a node that this file does not know must not be needed by anybody.
"""

import signal
import sys
import time
from typing import ClassVar

import rostest
from support.case import FaultCase, OnHold
from support.options import HOSTING, process_of
from support.platform import SIDES
from support.waiting import wait_until

#: node: sides that must hold without it. {s}: the side in its name.
HOLDS = {
    "supervisor": SIDES,
    "realtime_host": SIDES,
    "touchball_receiver": SIDES,
    "transparency": SIDES,
    "tank_master": SIDES,
    "tank_slave": SIDES,
    "tf_transformer": ("{s}",),
    "velocity_integrator": ("{s}",),
    "arm_driver": ("{s}",),
    "arm_state": ("{s}",),
    "sim_arm": ("{s}",),
}
#: how many of the nodes these are, by hosting
HOLD_NODES = {"separate": 15, "realtime": 8}
#: node: what its death does instead of a HOLD
ELSE = {
    "colliding_regions": {
        "separate": "distances unknown: motion goes on, no faster than 20 mm/s",
        "realtime": "the loop takes the distances itself: motion goes on, nothing is shown",
    }[HOSTING],
    "dvrk_sim": "distances to the da Vinci unknown: motion goes on",
    "frames": "its frames are latched: motion goes on, no new node gets them",
    "graph_watch": "nobody watches the links and ports: motion goes on",
    "recorder": "the bag is closed, NOT RECORDING is shown: motion goes on",
    "tool_command": "the instrument stays as it is: motion goes on",
    "visualization": "no markers: motion goes on",
}


def base_and_side(node):
    """/tf_transformer_left → ("tf_transformer", "left")."""
    name = node.strip("/")
    for side in SIDES:
        if name.endswith(f"_{side}"):
            return name[: -len(side) - 1], side
    return name, ""


def holds(node):
    """The sides that must hold without this node."""
    base, own = base_and_side(node)
    return tuple(side.format(s=own) for side in HOLDS.get(base, ()))


class ProcessFaults(FaultCase):
    arguments: ClassVar = {"dvrk": True, "surgeon": "rest", "collision": True}

    def hold_without(self, row, node, sides):
        """HOLD of these sides with all that belongs to it; the others go on."""
        numbers = {side: self.watch.engagement(side) for side in SIDES}
        if node == "/supervisor":  # nobody is left to say HOLD: who receives its state does
            for side in sides:
                self.await_silent(side)
                self.console.await_shown(side, "HOLD")
            row.saw("receivers hold by themselves, the console shows HOLD")
            return
        for side in sides:
            self.watch.await_state(side, "HOLD")
            event = self.watch.await_event(f"{side}: HOLD", self.events_before)
            if base_and_side(node)[0] != "sim_arm":
                self.await_silent(side)
            self.console.await_shown(side, "HOLD", "unknown")
        row.saw(f"event “{event}”, arm still")
        for side in set(SIDES) - set(sides):
            self.goes_on(side, "the other side")
            self.assertEqual(self.watch.engagement(side), numbers[side])
            row.saw("the other side goes on")

    def revive(self):
        """What a failed part left dead."""
        for node in [*self.platform.expected, *(f"/sim_arm_{side}" for side in SIDES)]:
            if not self.platform.running(node):
                self.platform.restart(node)

    def kill_and_recover(self, node, sides, how):
        self.engage_and_move()
        name = node.strip("/")
        with self.row(58, f"{how.name} of {name}", name) as row:
            numbers = {side: self.watch.engagement(side) for side in SIDES}
            killed_at = time.monotonic()
            self.platform.kill(node, how)
            self.hold_without(row, node, sides)
            if base_and_side(node)[0] != "sim_arm":
                row.saw(
                    "still after "
                    + " and ".join(f"{1e3 * self.logs[s].still_after_s(killed_at):.0f}" for s in sides)
                    + " ms"
                )
            told = {side: len(self.watch.states[side]) for side in sides}
            self.platform.restart(node)
            for side in sides:
                wait_until(lambda side=side: len(self.watch.states[side]) > told[side], f"the state of {side}")
                self.assertNotEqual(self.watch.state(side), "ENGAGED", "nobody has engaged it again")
            self.engage_and_move(*sides)
            if node != "/supervisor":  # that one counts from 1 again, and its receivers go on counting
                for side in sides:
                    self.assertNotEqual(self.watch.engagement(side), numbers[side], "a new engagement, a new number")
            row.saw("restarted and engaged by hand it moves")

    def test_1_nodes_that_motion_needs(self):
        nodes = sorted(self.platform.expected | {f"/sim_arm_{side}" for side in SIDES})
        needed = [node for node in nodes if holds(node)]
        self.assertEqual(len(needed), HOLD_NODES[HOSTING], needed)
        # The supervisor first: its first engagement after a restart has the same number as the first one before.
        needed.sort(key=lambda node: node != "/supervisor")
        for node in needed:
            with self.subTest(node):
                try:
                    self.kill_and_recover(node, holds(node), signal.SIGKILL)
                except OnHold as error:  # by this node or by a busy machine: the second try tells
                    self.revive()
                    print(f"{node}: again, for {error}")
                    self.kill_and_recover(node, holds(node), signal.SIGKILL)
                except AssertionError:
                    self.revive()
                    raise

    def test_2_sigterm(self):
        for node in (process_of("/tank_slave"), "/arm_driver_left"):
            with self.subTest(node):
                self.engage_and_move()
                with self.row(58, f"SIGTERM of {node[1:]}", f"{node[1:]} sigterm") as row:
                    self.platform.kill(node, signal.SIGTERM)
                    self.hold_without(row, node, holds(node))
                    self.platform.restart(node)
                    self.engage_and_move(*holds(node))
                    row.saw("restarted and engaged by hand it moves")

    def test_3_the_console(self):
        self.engage_and_move()
        with self.row(58, "SIGKILL of the console program", "console") as row:
            self.console.kill(signal.SIGKILL)
            for side in SIDES:
                self.await_hold(row, side, "console data", shown=False)
            self.console.start()
            self.engage_and_move()
            row.saw("started again and engaged by hand it moves")

    def test_4_nodes_that_nothing_waits_for(self):
        nodes = sorted(node for node in self.platform.expected if not holds(node))
        known = [node for node in nodes if node.strip("/") in ELSE]
        drawing = [node for node in nodes if node.startswith("/describe_")]
        self.assertEqual(sorted(known + drawing), nodes, "a node that this test does not know")
        for node in known:
            with self.subTest(node):
                self.motion_goes_on_without([node], node.strip("/"), ELSE[node.strip("/")])
        self.motion_goes_on_without(drawing, "describe_*", "no models in tf: motion goes on")

    def motion_goes_on_without(self, nodes, name, effect):
        self.engage_and_move()
        with self.row(58, f"SIGKILL of {name}", name) as row:
            numbers = {side: self.watch.engagement(side) for side in SIDES}
            for node in nodes:
                self.platform.kill(node)
            speeds = {}
            time.sleep(0.5)  # what it published is old then
            for side in SIDES:
                mark = self.logs[side].mark()
                self.logs[side].await_commands(75, f"without {name}")
                self.goes_on(side, f"without {name}")
                speeds[side] = self.logs[side].sustained_speed_m_s(mark)
                self.assertEqual(self.watch.engagement(side), numbers[side])
            row.saw(f"{effect}; fastest {1e3 * max(speeds.values()):.0f} mm/s")
            if name == "colliding_regions" and HOSTING == "separate":
                self.assertLess(max(speeds.values()), 0.022, "a tool of which nothing is known goes no faster")
            for node in nodes:
                self.platform.restart(node)
            for side in SIDES:
                self.goes_on(side, f"with {name} again")

    def test_5_a_second_node_of_the_same_name(self):
        self.engage_and_move()
        node = process_of("/tank_slave")
        with self.row(45, f"a second {node[1:]} is started") as row:
            self.platform.spawn(node)
            for side in SIDES:
                self.await_hold(row, side)
            alarm = wait_until(
                lambda: next((w for w in self.watch.warnings[self.warnings_before :] if "another node" in w), ""),
                "the alarm in the log",
            )
            row.saw(f"log “{alarm}”")
            time.sleep(2.0)  # the master may end the newer one, too
            if not self.platform.pid(node):
                row.saw("the master ended both; started once more")
                self.platform.restart(node)
            self.engage_and_move()
            row.saw("engaged by hand it moves")


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "faults_processes", ProcessFaults, sys.argv)
