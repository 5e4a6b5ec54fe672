#!/usr/bin/env python3
"""Faults of the arms and their links, stalls of nodes, and E-stops together with other faults."""

import signal
import sys
import time

import numpy as np
import rostest
from support.case import FaultCase
from support.options import LIMIT_S, process_of
from support.platform import SIDES
from support.tcp_gate import TcpGate
from support.waiting import wait_until

from saras.mesa_link import SocketIoArmDriver

STALL_S = max(0.5, 1.5 * LIMIT_S["node_limit_s"])


class ArmFaults(FaultCase):
    @classmethod
    def prepare(cls, platform):
        """Both clients of the left arm reach it through a gate."""
        url = f"http://127.0.0.1:{platform.gate_ports['left']}"
        platform.params.update({"/arm_state_left/url": url, "/arm_driver_left/url": url})
        cls.gate = TcpGate(platform.gate_ports["left"], platform.arm_port_left)

    def inject(self, side, kind, **fields):
        hand = SocketIoArmDriver(f"http://127.0.0.1:{self.arm_port(side)}", "fault test", control=False)
        try:
            hand.connect(30.0)
            hand.inject(kind, **fields)
        finally:
            hand.close()

    def arm_port(self, side):
        return getattr(self.platform, f"arm_port_{side}")

    def other_goes_on(self, row):
        number = self.watch.engagement("right")
        self.goes_on("right", "the other arm")
        self.assertEqual(self.watch.engagement("right"), number)
        row.saw("the other arm goes on")

    def back(self, row, what="engaged by hand it moves"):
        self.engage_and_move("left")
        row.saw(what)

    def test_14_arm_socket_drops(self):
        self.engage_and_move()
        with self.row(14, "the left arm's TCP connections are reset, new ones refused for a while") as row:
            mark = self.logs["left"].mark()
            self.gate.cut(shut=True)
            self.await_hold(row, "left", "arm state")
            self.other_goes_on(row)
            held = self.logs["left"].mark()
            self.gate.open()
            wait_until(lambda: "connected" in self.watch.report("/arm_state_left")["link"], "the link again")
            self.logs["left"].await_still()
            self.assertEqual(self.watch.state("left"), "HOLD")
            self.assertEqual(len(self.logs["left"].read().commands), held[0], "commands while held")
            row.saw(f"{held[0] - mark[0]} commands between cut and HOLD, 0 after the link was back")
            self.back(row)

    def test_15_half_open(self):
        self.engage_and_move()
        with self.row(15, "SIGSTOP of the left arm's server: its TCP connections stay open") as row:
            pid = self.platform.arm_server("left")
            self.platform.freeze(pid)
            try:
                self.watch.await_state("left", "HOLD")
                event = self.watch.await_event("left: HOLD", self.events_before)
                self.assertIn("arm state", event)
                self.console.await_shown("left", "HOLD")
                self.other_goes_on(row)
                row.saw(f"event “{event}”")
            finally:
                self.platform.thaw(pid)
            self.back(row)

    def test_16_no_backlog_reaches_the_arm(self):
        self.engage_and_move()
        with self.row(16, "SIGSTOP of the left arm's server for 3 s while engaged and moving, then SIGCONT") as row:
            log = self.logs["left"]
            pid = self.platform.arm_server("left")
            before = log.mark()
            self.platform.freeze(pid)
            try:
                time.sleep(3.0)
            finally:
                self.platform.thaw(pid)
            self.watch.await_state("left", "HOLD")
            log.await_still(100)
            log.read()
            thawed = log.ticks[before[1]].t_s if len(log.ticks) > before[1] else log.ticks[-1].t_s
            late = [command for command in log.commands[before[0] :] if self.age_of(log, command) > 0.15]
            refused = [line["refused"] for line in log.refused[before[2] :] if line["command"] == "set_target"]
            self.assertEqual(late, [], "commands older than the arm's limit were obeyed")
            moved = log.moved_since(before)
            self.assertLess(moved, 0.01)
            after = [command for command in log.commands if command.t_s > thawed + 1.0]
            row.saw(
                f"{len(refused)} late commands refused ({', '.join(sorted(set(refused))) or 'none sent'}), {len(late)} "
                f"obeyed; {len(after)} commands in the time after; the arm's target moved {1e3 * moved:.2f} mm in all"
            )
            self.back(row)

    def age_of(self, log, command):
        """By the arm's clock: since the state left that the sender had seen [s]."""
        ticks = {tick.tick: tick.t_s for tick in log.ticks}
        return command.t_s - ticks.get(command.echo_tick, command.t_s)

    def test_17_frozen_pose(self):
        for kind in ("frozen", "frozen_tick"):
            self.engage_and_move()
            with self.row(17, f"the left arm's answers stand still ({kind}) while it is commanded", kind) as row:
                self.inject("left", kind)
                try:
                    self.await_hold(row, "left", "arm state")
                    why = self.watch.report("/arm_state_left")["why"]
                    self.assertIn("frozen", why)
                    self.other_goes_on(row)
                    row.saw(f"arm_state says “{why}”")
                finally:
                    self.inject("left", "none")
                self.back(row)

    def test_18_pose_jump(self):
        self.engage_and_move()
        with self.row(18, "the left arm's reported tip jumps by 60 mm (limit 50)") as row:
            mark = self.logs["left"].mark()
            self.inject("left", "jump", offset=[0.06, 0.0, 0.0])
            try:
                self.await_hold(row, "left")
                why = wait_until(
                    lambda: next((w for w in self.watch.warnings[self.warnings_before :] if "jumped" in w), ""),
                    "arm_state's word",
                )
                self.assertLess(self.logs["left"].path_m(mark), 0.02, "the commands went after the jump")
                self.other_goes_on(row)
                row.saw(f"log “{why}”")
            finally:
                self.inject("left", "none")
            time.sleep(2.5)  # the way back is a jump as well, and believed only when it has stood for a second
            self.back(row)

    def test_36_stalls(self):
        stalled = ("/velocity_integrator_left", "/tank_slave", "/tf_transformer_left", "/arm_driver_left")
        for node in dict.fromkeys(process_of(node) for node in stalled):
            self.engage_and_move()
            limit = LIMIT_S["node_limit_s"]
            with self.row(
                36, f"SIGSTOP of {node[1:]} for {STALL_S:g} s (its heartbeat's limit {limit:g} s)", node
            ) as row:
                log = self.logs["left"]
                pid = self.platform.pid(node)
                self.platform.freeze(pid)
                begin = time.monotonic()
                try:
                    time.sleep(STALL_S)
                finally:
                    self.platform.thaw(pid)
                # The real-time host is the console's link, too: its silence is seen first.
                self.await_hold(row, "left", *([] if node == "/realtime_host" else [f"heartbeat of {node[1:]}"]))
                points = [tick.target for tick in log.read().ticks if tick.t_s > begin + 0.5 * STALL_S]
                moved = max(np.ptp(np.array(points), axis=0)) if points else 0.0
                self.assertLess(moved, 2e-3, "the arm made good what it had missed")
                row.saw(f"afterwards the target moved {1e3 * moved:.2f} mm (no catching up)")
                self.back(row)

    def test_37_restart_away_from_the_start(self):
        node = process_of("/velocity_integrator_left")
        self.engage_and_move()
        with self.row(37, f"kill -9 of {node[1:]} in motion; it is started again; engaged again") as row:
            log = self.logs["left"]
            start = log.read().ticks[0].tip
            self.platform.kill(node)
            self.await_hold(row, "left")
            self.platform.restart(node)
            held = log.mark()
            self.engage("left")
            log.await_commands(5, "after the restart")
            tip = log.ticks[held[1] - 1].tip
            first = log.commands[held[0]].position
            away, step = np.linalg.norm(np.subtract(tip, start)), np.linalg.norm(np.subtract(first, tip))
            self.assertLess(step, 3.7e-3)
            self.goes_on("left", "after the restart")
            row.saw(
                f"{1e3 * away:.1f} mm from its start the first command lies {1e3 * step:.2f} mm from the measured tip"
            )

    def test_57_estop_with_another_fault(self):
        faults = {
            "console killed": lambda: self.console.kill(signal.SIGKILL),
            "arm link cut": lambda: self.gate.cut(shut=True),
            "node killed": lambda: self.platform.kill(process_of("/tank_slave")),
        }
        mends = {
            "console killed": self.console.start,
            "arm link cut": self.gate.open,
            "node killed": lambda: self.platform.restart(process_of("/tank_slave")),
        }
        for order in ("before", "after"):
            for name, strike in faults.items():
                self.engage_and_move()
                with self.row(57, f"E-stop {order} another fault: {name}", f"{name} {order}") as row:
                    if order == "after":
                        strike()
                    self.assertTrue(self.ask("", "estop")[0])
                    if order == "before":
                        strike()
                    for side in SIDES:
                        self.watch.await_state(side, "HOLD")
                        wait_until(lambda side=side: "E-stop" in self.watch.reason(side), f"{side} E-stop")
                        self.await_silent(side)
                    mends[name]()
                    refusals = {side: self.ask(side, "engage") for side in SIDES}
                    self.assertFalse(any(done for done, _ in refusals.values()))
                    marks = {side: self.logs[side].mark() for side in SIDES}
                    self.assertTrue(self.ask("", "estop_reset")[0])
                    wait_until(lambda: "E-stop was reset" in self.watch.reason("left"), "the reset")
                    for side in SIDES:
                        self.logs[side].await_still(60)
                        self.assertEqual(self.watch.state(side), "HOLD")
                        self.assertEqual(
                            len(self.logs[side].read().commands), marks[side][0], "commands after the reset"
                        )
                    row.saw(f"engage refused (“{refusals['left'][1]}”); after the reset alone HOLD and 0 commands")
                    self.engage_and_move()
                    row.saw("engaged by hand it moves")


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "faults_arms", ArmFaults, sys.argv)
