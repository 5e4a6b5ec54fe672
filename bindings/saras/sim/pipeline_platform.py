"""The platform as one Pipeline, in place of the graph's laws: what the real-time host steps."""

from __future__ import annotations

import copy

import numpy as np
import numpy.typing as npt

from saras.net import ChannelState
from saras.pipeline import Pipeline, PipelineConfig, PipelineInput, PipelineSideOutput
from saras.sim.arm_side import ArmSide
from saras.sim.console import DownMessage, UpMessage
from saras.sim.exchange import EnergyBook, ExchangeMessage
from saras.sim.experiment import Experiment
from saras.sim.platform import servo_model
from saras.teleop import EnergyTankConfig, EnergyTankState

Array = npt.NDArray[np.float64]

SIDES = ("left", "right")
TANKS = ("tank_master", "tank_slave")


def _sees_the_handles(tank: EnergyTankConfig) -> EnergyTankConfig:
    """Its conjugate is the handles' twist, as with the nodes: with a rate of zero it would let no wrench through."""
    if np.any(tank.conjugate_rate):
        return tank
    tank = copy.copy(tank)
    tank.conjugate_rate, tank.hold_s = np.repeat([20.0, 200.0], 3), 0.012  # config/tanks.yaml
    return tank


class PipelineSide:
    """What the recorder reads of one side."""

    def __init__(self, arm: ArmSide) -> None:
        self.arm = arm
        self.newest: UpMessage | None = None
        self.is_new = False
        self.heard_at = -np.inf
        self.tracked: Array = np.full((4, 4), np.nan)
        self.set_point: Array = arm.measured_base_T_tip


class PipelineTank:
    """One of the two tanks in the pipeline: its books over all restarts."""

    def __init__(self, platform: PipelinePlatform, name: str) -> None:
        self._platform, self._name = platform, name
        self.past = EnergyBook()

    @property
    def state(self) -> EnergyTankState:
        """The law's."""
        state: EnergyTankState = getattr(self._platform.pipeline.state, self._name)
        return state

    @property
    def energy_J(self) -> float:
        """Level [J]."""
        return float(self.state.energy_J)

    def restart(self) -> None:
        """The tanks share a process: both end with it."""
        self._platform.restart()

    def book(self) -> EnergyBook:
        """All joules so far."""
        return self.past.with_session(self.state)

    def close(self) -> None:
        """The process is killed: what the tank held is lost."""
        book = self.book()
        book.lost_J += book.energy_J
        book.energy_J = 0.0
        self.past = book


class PipelinePlatform:
    """Same face as saras.sim.platform.Platform; both sides are engaged from the start."""

    def __init__(self, experiment: Experiment, arms: list[ArmSide]) -> None:
        self.sides = [PipelineSide(arm) for arm in arms]
        self._observe = [side.slave_wrench == "observer" for side in experiment.sides]
        self._config = PipelineConfig(
            left_mapping=experiment.mapping,
            right_mapping=experiment.mapping,
            transparency=experiment.transparency,
            tank_master=_sees_the_handles(experiment.master_tank),
            tank_slave=experiment.slave_tank,
            left_integrator=experiment.integrator,
            right_integrator=experiment.integrator,
            fixture_force=experiment.fixture_force,
            observe=self._observe[0],
            observer=servo_model(experiment.sides[0]),
            handle_timeout_s=experiment.console_timeout_s,
            peer_timeout_s=experiment.exchange_timeout_s,
            session=1,
        )
        for name, given in zip(SIDES, experiment.sides):
            setattr(self._config, f"{name}_fixtures", list(given.fixtures))
        self.pipeline = Pipeline(self._config)
        self.master, self.slave = (PipelineTank(self, name) for name in TANKS)
        self._seq = 0

    def restart(self) -> None:
        """Kill and restart; the supervisor has engaged again."""
        self.master.close()
        self.slave.close()
        self._config.session += 1
        self.pipeline = Pipeline(self._config)

    def receive(self, side: int, message: UpMessage, now: float) -> None:
        """Newest wins; the ledgers in it are sums."""
        at = self.sides[side]
        if at.newest is None or message.seq > at.newest.seq:
            at.newest, at.is_new, at.heard_at = message, True, now

    def tick(self, dt: float, now: float) -> list[DownMessage]:
        """One step; returns the datagrams for the consoles."""
        out = self.pipeline.step(self._input(dt, now), dt)
        self._seq += 1
        return [self._act(side, getattr(out, name)) for side, name in zip(self.sides, SIDES)]

    def _input(self, dt: float, now: float) -> PipelineInput:
        values = PipelineInput()
        for side, name in zip(self.sides, SIDES):
            given = getattr(values, name)
            if side.newest is not None:
                exchange = side.newest.exchange
                given.handle.is_new, side.is_new = side.is_new, False
                given.handle.age_s = now - side.heard_at
                given.handle.simball_T_handle = side.newest.simball_T_handle
                given.handle.clutch = side.newest.clutch
                ledger = given.handle.ledger
                ledger.session, ledger.seq, ledger.sent_J = exchange.session, exchange.seq, exchange.sent_J
                ledger.requesting, ledger.has_room = exchange.requesting, exchange.has_room
            arm = given.arm
            arm.is_new, arm.age_s, arm.interval_s = True, 0.0, dt
            arm.base_T_tip, arm.target = side.arm.measured_base_T_tip, side.set_point[:3, 3]
            arm.has_rcm, arm.rcm = True, side.arm.rcm
            arm.exerted_wrench, arm.wrench_age_s = side.arm.take_mean_wrench(), 0.0
            channel = given.channel
            channel.age_s, channel.state, channel.engagement = 0.0, ChannelState.ENGAGED, 1
        return values

    def _act(self, side: PipelineSide, told: PipelineSideOutput) -> DownMessage:
        if told.has_tracked:
            side.tracked = told.tracked_pose
        if told.has_set_point:
            side.set_point = told.set_point
            side.arm.follow(side.set_point)
        ledger = told.to_guard
        exchange = ExchangeMessage(ledger.session, ledger.seq, ledger.sent_J, ledger.requesting, ledger.has_room)
        return DownMessage(self._seq, told.touch_wrench, exchange)
