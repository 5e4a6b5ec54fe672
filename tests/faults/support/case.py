"""The frame of a fault test: one platform, its console and proxy, and what must hold after every injection."""

from __future__ import annotations

import inspect
import os
import shutil
import tempfile
import unittest
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import ClassVar

import rospy
from std_srvs.srv import Trigger

from .arm_log import ARM_SPEED_M_S, STEP_LIMIT_M, ArmLog
from .console import Console
from .options import HOSTING, LIMITS
from .platform import SIDES, Platform
from .results import Row, recorded
from .waiting import wait_until
from .watch import Watch

MICROMETRE = 1e-6


class OnHold(AssertionError):
    """A side that should go on was stopped. Two busy processors do that too, by a watchdog of milliseconds."""


class FaultCase(unittest.TestCase):
    """Class attributes say what is started; tests run in the order of their names and leave both sides engaged."""

    arguments: ClassVar[dict[str, object]] = {"dvrk": False, "collision": False}
    params: ClassVar[dict[str, object]] = {}
    node_env: ClassVar[dict[str, str]] = {}
    console_words: ClassVar[tuple[str, ...]] = ("--motion", "circle")
    platform: Platform
    watch: Watch
    console: Console | None = None
    logs: dict[str, ArmLog]

    @classmethod
    def setUpClass(cls) -> None:
        keep = os.environ.get("SARAS_FAULTS_LOGS")
        cls.directory = (
            Path(keep, f"{cls.__name__}_{os.getpid()}") if keep else Path(tempfile.mkdtemp(prefix="saras_faults_"))
        )
        cls.platform = Platform(cls.directory, cls.params, cls.node_env)
        cls.prepare(cls.platform)
        try:
            cls.platform.start(**cls.arguments)
            rospy.init_node("fault_test", disable_signals=True)
            cls.watch = Watch()
            cls.logs = {side: ArmLog(cls.directory / f"mesa_{side}.jsonl") for side in SIDES}
            cls.start_console()
        except BaseException:
            cls.platform.stop()
            raise

    @classmethod
    def prepare(cls, platform: Platform) -> None:
        """Before the platform starts: its ports are known, its parameters may be changed."""

    @classmethod
    def start_console(cls) -> None:
        """The console of these tests; here the program, straight to the platform."""
        cls.console = Console(cls.platform, *cls.console_words, direct=True)
        cls.console.start()

    @classmethod
    def tearDownClass(cls) -> None:
        rospy.signal_shutdown("done")
        cls.platform.stop()
        if not os.environ.get("SARAS_FAULTS_LOGS"):
            shutil.rmtree(cls.directory, ignore_errors=True)

    # -- the operator ------------------------------------------------------------------------------------------

    def ask(self, side: str, word: str) -> tuple[bool, str]:
        """/system/SIDE/WORD: whether it succeeded, what was said."""
        answer = rospy.ServiceProxy(f"/system/{side}/{word}" if side else f"/system/{word}", Trigger)()
        return answer.success, answer.message

    def engage(self, *sides: str) -> None:
        """Asks until each side lets itself be engaged and stays so."""
        for side in sides or SIDES:
            said: list[str] = []

            def engaged(side: str = side, said: list[str] = said) -> bool:
                try:
                    done, message = self.ask(side, "engage")
                except rospy.ServiceException as error:  # the supervisor is being restarted
                    done, message = False, str(error)
                said.append(message)
                return done

            wait_until(engaged, lambda side=side, said=said: f"{side} lets itself be engaged: {said[-1:]}", 90.0)
            self.watch.await_state(side, "ENGAGED")

    def engage_and_move(self, *sides: str) -> None:
        """Engaged, and the arms' commands go somewhere: the state in which a fault is injected."""
        for side in sides or SIDES:
            wait_until(lambda side=side: self._engaged_and_moving(side), f"{side} engaged and moving", 120.0)

    def _engaged_and_moving(self, side: str) -> bool:
        """A HOLD soon after the engagement is answered: what was restarted may not have settled."""
        if self.watch.state(side) != "ENGAGED":
            self.engage(side)
        log = self.logs[side]
        mark = log.mark()
        wait_until(lambda: log.path_m(mark) > 2e-3 or self.watch.state(side) == "HOLD", f"{side} moves, or holds")
        return self.watch.state(side) == "ENGAGED"

    # -- one injection -----------------------------------------------------------------------------------------

    @contextmanager
    def row(self, number: int, injected: str, part: str = "") -> Iterator[Row]:
        """Records the row, and checks at its end what holds for every row: steps, numbers."""
        self.marks = {side: log.mark() for side, log in self.logs.items()}
        self.events_before = len(self.watch.events)
        self.warnings_before = len(self.watch.warnings)
        self.not_finite_before = self.watch.not_finite.total()
        test = f"tests/faults/{Path(inspect.getfile(type(self))).name}::{self._testMethodName}"
        with recorded(Row(number, injected, test, part, HOSTING, LIMITS)) as row:
            yield row
            self.check_numbers()
            row.saw(f"longest command step {self.check_steps() * 1e3:.2f} of {STEP_LIMIT_M * 1e3:.1f} mm")

    def check_steps(self) -> float:
        """No command further than v_max · dt from the one before, no faster servo target. The longest step [m]."""
        worst = 0.0
        for side, log in self.logs.items():
            for step, allowed in log.steps(self.marks[side]):
                self.assertLessEqual(step, allowed + 10 * MICROMETRE, f"{side}: command step")
                worst = max(worst, step)
            speed = log.worst_speed_m_s(self.marks[side])
            self.assertLessEqual(speed, 1.02 * ARM_SPEED_M_S, f"{side}: speed of the servo's target")
        return worst

    def check_numbers(self) -> None:
        """Nothing that is no number left for an arm or a hand."""
        self.assertEqual(self.watch.not_finite.total(), self.not_finite_before, dict(self.watch.not_finite))
        for log in self.logs.values():
            self.assertEqual(log.not_finite, 0)

    def await_hold(self, row: Row, side: str, *words: str, shown: bool = True) -> None:
        """HOLD with its reason, an event, zero twist and force, shown at the console; the arm stands still."""
        self.watch.await_state(side, "HOLD")
        event = self.watch.await_event(f"{side}: HOLD", self.events_before)
        for word in words:
            self.assertIn(word, event)
        self.await_silent(side)
        if shown and self.console is not None:
            self.console.await_shown(side, "HOLD", "unknown")
        row.saw(f"event “{event}”, arm still")

    def await_told(self, row: Row, *words: str) -> None:
        """The event of something that needs no HOLD; it comes at once, or with the sum of ten seconds."""
        event = wait_until(
            lambda: next((e for e in self.watch.events[self.events_before :] if all(w in e for w in words)), ""),
            lambda: f"an event with {words}; there were {self.watch.events[self.events_before :]}",
        )
        row.saw(f"event “{event}”")

    def await_silent(self, side: str) -> None:
        """Neither motion to the arm nor force to the hand."""
        self.logs[side].await_still()
        for topic in (f"/tank_slave/{side}/twist", f"/touchball_{side}/wrench"):
            count = self.watch.received[topic]
            wait_until(
                lambda topic=topic, count=count: (
                    self.watch.received[topic] == count or not any(self.watch.newest.get(topic, (0.0,)))
                ),
                lambda topic=topic: f"{topic} zero or silent; {self.watch.newest.get(topic)}",
            )

    def goes_on(self, side: str, what: str) -> None:
        """Engaged, not re-engaged, and moving. OnHold when it was stopped too."""
        self.logs[side].await_motion(1e-3, what, or_until=lambda: self.watch.state(side) != "ENGAGED")
        if self.watch.state(side) != "ENGAGED":
            raise OnHold(f"{what}: {side} is on {self.watch.state(side)} too: {self.watch.reason(side)}")
