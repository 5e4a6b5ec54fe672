"""Runs an experiment: the closed loop of hands, consoles, network, platform, arms and tissue, without ROS."""

from __future__ import annotations

import copy
import time

import numpy as np
import numpy.typing as npt

from saras._core.sim import ChannelConfig
from saras.sim.arm_side import ArmSide
from saras.sim.console import Console, DownMessage, UpMessage
from saras.sim.exchange import EnergyBook, ExchangeMessage
from saras.sim.experiment import Experiment, Restart
from saras.sim.link import Link
from saras.sim.pipeline_platform import PipelinePlatform
from saras.sim.platform import Platform
from saras.sim.result import Recorder, Result

Array = npt.NDArray[np.float64]

ROUNDING_S = 1e-9
"""A datagram due at a tick comes at that tick, whichever way the sum of the periods rounds."""


def run(experiment: Experiment) -> Result:
    """Simulate the experiment; the same experiment gives the same arrays, bit for bit."""
    return _Loop(experiment).run()


def _with_seed(config: ChannelConfig, seed: int) -> ChannelConfig:
    config = copy.copy(config)
    config.seed = config.seed * 1_000_003 + seed
    return config


class _Loop:
    def __init__(self, experiment: Experiment) -> None:
        self.experiment = experiment
        sides = range(len(experiment.sides))
        random = np.random.default_rng(experiment.seed)
        n = int(np.ceil(experiment.duration_s * experiment.guard_rate_hz))
        nominal = 1.0 / experiment.guard_rate_hz
        self.dt = nominal * (1.0 + experiment.guard_jitter * random.uniform(-1.0, 1.0, n))
        self.t = np.cumsum(self.dt)
        self.is_late = random.uniform(size=n) < experiment.graph_jitter
        self.consoles = [Console(side, experiment, self.t, self.dt) for side in experiment.sides]
        self.arms = [ArmSide(side) for side in experiment.sides]
        seed = 16 * experiment.seed
        self.up: list[Link[UpMessage]] = [Link(_with_seed(experiment.up, seed + i)) for i in sides]
        self.down: list[Link[DownMessage]] = [Link(_with_seed(experiment.down, seed + 8 + i)) for i in sides]
        self.exchange: tuple[Link[ExchangeMessage], Link[ExchangeMessage]] = (
            Link(_with_seed(experiment.exchange, seed + 6)),
            Link(_with_seed(experiment.exchange, seed + 7)),
        )
        self.platform: Platform | PipelinePlatform = (
            Platform(experiment, self.arms, self.exchange)
            if experiment.controller == "laws"
            else PipelinePlatform(experiment, self.arms)
        )
        self.restarts = sorted(experiment.restarts, key=lambda r: r.time_s, reverse=True)
        self.recorder = Recorder(experiment, self.t)

    def run(self) -> Result:
        """Step all ticks."""
        experiment = self.experiment
        began = time.perf_counter()
        graph_period = 1.0 / experiment.graph_rate_hz
        graph_due = 0.0
        last_graph = 0.0
        for k, (now, dt) in enumerate(zip(self.t.tolist(), self.dt.tolist())):
            while self.restarts and self.restarts[-1].time_s <= now:
                self._restart(self.restarts.pop())
            for arm in self.arms:
                arm.tick(dt)
            for console, link in zip(self.consoles, self.down):
                for down in link.receive(now + ROUNDING_S):
                    console.receive(down, now)
                console.tick(k, now, dt)
            if now >= graph_due - 1e-9 and not self.is_late[k]:
                graph_due += graph_period * max(1, round((now - graph_due) / graph_period))
                self._graph_tick(k, now, now - last_graph)
                last_graph = now
            self.recorder.record(k, self.consoles, self.arms, self.platform)
        return self.recorder.finish(self.books(), time.perf_counter() - began, self.consoles, self.arms)

    def _graph_tick(self, k: int, now: float, dt: float) -> None:
        for i, (side, console, link) in enumerate(zip(self.experiment.sides, self.consoles, self.up)):
            clutch = any(begin <= now < end for begin, end in side.clutch)
            link.send(console.message(clutch), now)
            for up in link.receive(now + ROUNDING_S):
                self.platform.receive(i, up, now)
        for down, message in zip(self.down, self.platform.tick(dt, now)):
            down.send(message, now)
        self.recorder.record_books(k, self.books())

    def _restart(self, restart: Restart) -> None:
        if restart.tank == "guard":
            self.consoles[restart.side].restart()
        else:
            (self.platform.master if restart.tank == "tank_master" else self.platform.slave).restart()

    def books(self) -> list[EnergyBook]:
        """Books of the guards, tank_master, tank_slave, in this order."""
        return [c.guard.book() for c in self.consoles] + [self.platform.master.book(), self.platform.slave.book()]
