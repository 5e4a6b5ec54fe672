#!/usr/bin/env python3
"""Faults of the network and of the console. The console program has a key and talks through the proxy."""

import random
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import rospy
import rostest
from support.case import FaultCase
from support.clock import Clock
from support.console import Console
from support.flood import forged
from support.options import LIMIT_S
from support.platform import SIDES, python
from support.proxy import Proxy
from support.waiting import wait_until

from saras.net import TouchballUp, keys
from saras.net.keys import Keys
from saras.net.trust import ConsoleEnd
from saras_ros1.stamped import StampedPose

CONSOLE_LIMIT_S = LIMIT_S["console_limit_s"]


class NetworkFaults(FaultCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.key_file = str(Path(cls.scratch.name, "saras.key"))
        keys.save(Path(cls.key_file), keys.draw())
        cls.clock = Clock(Path(cls.scratch.name))
        cls.node_env = cls.clock.env
        cls.arguments = {**cls.arguments, "key_file": cls.key_file}
        super().setUpClass()

    @classmethod
    def start_console(cls):
        cls.proxy = Proxy(cls.platform, seed=4)
        cls.console = Console(cls.platform, "--motion", "circle", "--key", cls.key_file)
        cls.console.start()

    @classmethod
    def tearDownClass(cls):
        super().tearDownClass()
        cls.scratch.cleanup()

    def await_passed(self, count, direction="up"):
        """Until so many datagrams more came out of the proxy."""
        begin = self.proxy.passed(direction)
        wait_until(lambda: self.proxy.passed(direction) >= begin + count, f"{count} datagrams {direction}")

    def send_to_platform(self, datagrams):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            for datagram in datagrams:
                sender.sendto(datagram, ("127.0.0.1", self.platform.bind_port))
                time.sleep(0.001)

    def unchanged(self, before, after, *names):
        for name in names:
            self.assertEqual(after[name], before[name], name)

    def test_01_isolated_loss(self):
        self.engage_and_move()
        with self.row(1, "1 and 2 datagrams lost, 20 times, 12 good ones between") as row:
            number, before, lost = self.watch.engagement("left"), self.watch.counts(), 0
            for i in range(20):
                self.proxy(f"drop {1 + i % 2} up")
                lost += 1 + i % 2
                self.await_passed(12)
            after = self.watch.await_count("gaps", before["gaps"] + lost)
            for side in SIDES:
                self.goes_on(side, "with gaps")
            self.assertEqual(self.watch.engagement("left"), number)
            self.await_told(row, "not taken", "gaps")
            row.saw(f"{after['gaps'] - before['gaps']} missing numbers counted for {lost} lost, engaged throughout")

    def test_02_loss_bursts(self):
        for part, burst_s in (("short", 2.0 * CONSOLE_LIMIT_S), ("long", 5.0)):
            self.engage_and_move()
            with self.row(2, f"nothing passes for {burst_s:g} s (limit {CONSOLE_LIMIT_S:g} s)", part) as row:
                self.proxy(f"blackout {burst_s}")
                for side in SIDES:
                    self.await_hold(row, side, "console data", shown=False)
                self.console.await_shown("left", "unknown", "HOLD")
                self.await_passed(50)
                self.console.await_shown("left", "HOLD")
                for side in SIDES:
                    self.assertEqual(self.watch.state(side), "HOLD", "HOLD is latched when data comes again")
                self.engage_and_move()
                row.saw("stays HOLD when data comes again; engaged by hand it moves")

    def test_03_reordering(self):
        self.engage_and_move()
        with self.row(3, "100 datagrams up and 100 down come after their successors") as row:
            stamps = []
            subscriber = rospy.Subscriber("/touchball_left/pose", StampedPose, lambda m: stamps.append(m.stamp_ns))
            before = self.watch.counts()
            self.proxy("swap 100")
            self.await_passed(260)
            after = self.watch.await_count("out_of_order", before["out_of_order"] + 95)
            self.goes_on("left", "with reordering")
            subscriber.unregister()
            self.assertGreater(len(stamps), 50)
            self.assertTrue(np.all(np.diff(stamps) > 0), "a pose came after a newer one")
            late = after["out_of_order"] - before["out_of_order"]
            row.saw(f"{late} late ones dropped, {len(stamps)} poses in strictly rising order")

    def test_04_duplicates(self):
        self.engage_and_move()
        with self.row(4, "300 datagrams up and 300 down come twice") as row:
            before = self.watch.counts()
            self.proxy("duplicate 300")
            self.await_passed(650)
            after = self.watch.await_count("replayed", before["replayed"] + 290)
            self.goes_on("left", "with duplicates")
            row.saw(f"{after['replayed'] - before['replayed']} second copies refused, engaged throughout")

    def test_05_energy_ledgers_on_a_lossy_network(self):
        self.engage_and_move()
        with self.row(33, "30 % of all datagrams lost, 30 % doubled, 10 % late, both ways, 800 datagrams") as row:
            self.proxy("impair loss=0.3 duplicate=0.3 reorder=0.1 reorder_s=0.03")
            self.await_passed(800)
            self.proxy("impair loss=0 duplicate=0 reorder=0")
            for side in SIDES:
                self.ask(side, "hold")
                self.watch.await_state(side, "HOLD")
            traded, in_flight, residual = wait_until(self.settled_ledgers, lambda: f"ledgers: {self.ledgers()}", 120.0)
            self.assertGreater(traded, 0.05, "nothing was traded")
            row.saw(
                f"{traded:.3f} J traded by the four tanks, {in_flight:.1e} J in flight at rest, "
                f"largest balance residual {residual:.1e} J"
            )
            self.engage_and_move()

    def ledgers(self):
        """(traded, in flight, residual) [J] of the newest states of all tanks."""
        tanks = self.watch.tanks.values()
        residual = max(
            abs(t.granted_J + t.received_J - t.sent_J - t.work_out_J - t.vented_J - t.energy_J) for t in tanks
        )
        sent, received = sum(t.sent_J for t in tanks), sum(t.received_J for t in tanks)
        return sent, sent - received, residual

    def settled_ledgers(self):
        first = self.ledgers()
        time.sleep(1.0)  # longer than any tank's state takes to come
        if self.ledgers() != first or not -1e-9 <= first[1] <= 1e-9 or first[2] > 1e-9:
            return None
        return first

    def test_06_replays_of_this_session(self):
        self.engage_and_move()
        with self.row(5, "the newest 2000 datagrams of this session sent again", "this session") as row:
            before = self.watch.counts()
            sent = self.proxy("replay 2000 up")["sent"]
            refused = ("replayed", "too_old")
            after = wait_until(
                lambda: (c := self.watch.counts()) and sum(c[n] - before[n] for n in refused) > 100 and c, "refusals"
            )
            self.goes_on("left", "with replays")
            self.unchanged(before, after, "sessions", "handshakes", "malformed")
            after = self.watch.counts()
            self.await_told(row, "not taken")
            row.saw(
                f"of {sent} sent again {sum(after[n] - before[n] for n in refused)} refused by their number (the rest "
                "lost at the full socket), none taken, the side stays engaged"
            )

    def test_07_forged(self):
        self.engage_and_move()
        with self.row(6, "500 forged datagrams: newer session, sequence 2^40 ahead, random tags or no tag") as row:
            before = self.watch.counts()
            rng = random.Random(6)
            stranger = ConsoleEnd(Keys(bytes(range(32)), bytes(range(32, 64))))
            untagged = [TouchballUp(session=2**63, seq=2**40 + i).encode() for i in range(100)]
            self.send_to_platform([forged(rng, 2**40 + i) for i in range(300)] + untagged)
            self.send_to_platform([stranger.handshake_due(10**9 * (i + 1)) for i in range(100)])
            after = self.watch.await_count("unauthenticated", before["unauthenticated"] + 450)
            self.goes_on("left", "with forgeries")
            self.unchanged(before, after, "sessions", "handshakes", "malformed", "far_ahead")
            self.await_told(row, "not taken", "unauthenticated")
            row.saw(f"{after['unauthenticated'] - before['unauthenticated']} refused by their tag, none taken")

    def test_08_damaged(self):
        self.engage_and_move()
        with self.row(7, "100 datagrams up with one bit turned; 1000 truncated, oversized or random ones") as row:
            before = self.watch.counts()
            self.proxy("flip 100 up")
            self.await_passed(150)
            rng = random.Random(7)
            good = forged(rng, 1)
            lengths = [rng.choice((rng.randrange(len(good)), len(good) + rng.randrange(1, 900))) for _ in range(900)]
            self.send_to_platform([(good + bytes(900))[:n] for n in lengths] + [rng.randbytes(580) for _ in range(100)])
            after = wait_until(
                lambda: (
                    (c := self.watch.counts())
                    and sum(c[n] - before[n] for n in ("malformed", "unauthenticated")) >= 1050
                    and c
                ),
                "refusals",
            )
            for side in SIDES:
                if self.watch.state(side) == "HOLD":  # a hundred in a row are a second without data
                    self.engage(side)
                self.goes_on(side, "after damaged ones")
            begun = {n: after[n] - before[n] for n in ("sessions", "handshakes")}
            self.assertEqual(begun["sessions"], begun["handshakes"], "a session that the console did not begin")
            refused = {n: after[n] - before[n] for n in ("malformed", "unauthenticated")}
            self.await_told(row, "not taken", "malformed")
            row.saw(
                f"{refused['malformed']} refused by their frame, {refused['unauthenticated']} by their tag, none taken"
            )

    def test_09_flood(self):
        self.engage_and_move()
        with self.row(9, "forged datagrams at 2000 a second for 5 s") as row:
            quiet = self.control_figures(4.0)
            before = self.watch.counts()
            flood = str(Path(__file__).parent / "support" / "flood.py")
            command = [python(), flood, str(self.platform.bind_port), "2000", "5", "9"]
            child = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=self.platform.env)
            loaded = self.control_figures(4.0)
            sent = int(child.communicate(timeout=60)[0])
            after = self.watch.counts()
            refused = after["unauthenticated"] - before["unauthenticated"]
            self.assertGreater(refused, 0.5 * sent, f"counted of {sent}")
            self.unchanged(before, after, "sessions", "handshakes")
            for side in SIDES:
                self.goes_on(side, "in the flood")
            self.assertGreater(loaded["accepted"], 0.8 * loaded["passed"])
            row.saw(
                f"{refused} of {sent} counted as refused; true ones taken {loaded['accepted']} of {loaded['passed']} "
                f"(without flood {quiet['accepted']} of {quiet['passed']}); interval of the arm's commands p50/p99 "
                f"{loaded['p50']:.1f}/{loaded['p99']:.1f} ms (without {quiet['p50']:.1f}/{quiet['p99']:.1f}); no HOLD"
            )

    def control_figures(self, seconds):
        """Of the left arm and the link over so many seconds."""
        taken, passed, mark = self.watch.counts()["accepted"], self.proxy.passed(), self.logs["left"].mark()
        time.sleep(seconds)
        accepted, passed = self.watch.counts()["accepted"] - taken, self.proxy.passed() - passed
        commands = self.logs["left"].read().commands[mark[0] :]
        intervals = 1e3 * np.diff([command.t_s for command in commands])
        p50, p99 = np.percentile(intervals, [50, 99])
        return {"accepted": accepted, "passed": passed, "p50": p50, "p99": p99}

    def test_10_bunched(self):
        self.engage_and_move()
        held_s = 0.5
        with self.row(10, f"all datagrams held back for {held_s:g} s, then released at once") as row:
            before, mark = self.watch.counts(), {side: log.mark() for side, log in self.logs.items()}
            self.proxy(f"hold {held_s}")
            after = self.watch.await_count("overdue", before["overdue"] + 20)
            for side in SIDES:
                if self.watch.state(side) == "HOLD":
                    self.engage(side)
                self.goes_on(side, "after the bunch")
            dense = max(self.densest(self.logs[side], mark[side]) for side in SIDES)
            self.assertLess(dense, 20, "commands in ten ticks of the arm, 5 are nominal")
            row.saw(f"{after['overdue'] - before['overdue']} over-age ones dropped, at most {dense} commands in 100 ms")

    def densest(self, log, mark):
        """The most commands in any ten of the arm's ticks."""
        times = np.array([command.t_s for command in log.read().commands[mark[0] :]])
        return int(max(np.searchsorted(times, times + 0.1) - np.arange(len(times))))

    def test_11_clock_steps(self):
        for part, shift_s in (("forward", 3600), ("back", 0)):
            self.engage_and_move()
            with self.row(
                35, f"the wall clock of all processes steps by {3600 if shift_s else -3600:+d} s", part
            ) as row:
                before = self.tank_levels()
                self.clock.step(shift_s)
                wait_until(lambda s=shift_s: abs(self.shift_of_the_platform_s() - s) < 10.0, "the nodes see the step")
                time.sleep(1.0)
                after = self.tank_levels()
                worst = max(abs(after[name] - level) for name, level in before.items())
                self.assertLess(worst, 0.2, f"{before} {after}")  # an hour at the exchange power would be 7200 J
                states = [self.watch.state(side) for side in SIDES]
                self.engage_and_move()
                row.saw(
                    f"tank levels within {1e3 * worst:.0f} mJ a second later, sides {' '.join(states)}, motion goes on"
                )

    def shift_of_the_platform_s(self):
        """By the stamps of the supervisor; the test's own clock is the true one."""
        return self.watch.states["left"][-1].header.stamp.to_sec() - time.time()

    def tank_levels(self):
        return {name: tank.energy_J for name, tank in self.watch.tanks.items()}

    def test_12_console_freezes(self):
        self.engage_and_move()
        with self.row(12, "SIGSTOP of the console for 3 s, then SIGCONT") as row:
            self.console.freeze()
            try:
                for side in SIDES:
                    self.await_hold(row, side, "console data", shown=False)
                time.sleep(3.0)
            finally:
                self.console.thaw()
            late = self.console.count("late")
            self.await_passed(100)
            for side in SIDES:
                self.assertEqual(self.watch.state(side), "HOLD")
                self.logs[side].await_still()
                self.console.await_shown(side, "HOLD")
            row.saw(f"still HOLD and still after 100 datagrams more (console: {late} late)")
            self.engage_and_move()

    def test_13_console_dies_and_comes_back(self):
        self.engage_and_move()
        with self.row(11, "kill -9 of the console of both sides") as row:
            self.console.kill(signal.SIGKILL)
            for side in SIDES:
                self.await_hold(row, side, "console data", shown=False)
            row.saw("a console serves both hands, so both sides hold")
        with self.row(13, "the killed console is started again") as row:
            before = self.watch.counts()
            self.console.start()
            after = self.watch.await_count("handshakes", before["handshakes"] + 1)
            self.await_passed(100)
            for side in SIDES:
                self.assertEqual(self.watch.state(side), "HOLD")
                self.console.await_shown(side, "HOLD")
            self.engage_and_move()
            row.saw(f"handshake {after['handshakes']}, HOLD until engaged by hand, then it moves")
        with self.row(5, "4096 datagrams, most of them of the session before, sent again", "earlier session") as row:
            before = self.watch.counts()
            sent = self.proxy("replay 4096 up")["sent"]
            after = wait_until(
                lambda: (c := self.watch.counts()) and c["unauthenticated"] > before["unauthenticated"] + 20 and c,
                "refusals",
            )
            self.goes_on("left", "with replays of an earlier session")
            self.unchanged(before, after, "sessions", "handshakes")
            row.saw(f"of {sent} sent again {after['unauthenticated'] - before['unauthenticated']} refused by their tag")


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "faults_network", NetworkFaults, sys.argv)
