"""The whole pipeline of both arms as one step: by saras (through its bindings) and by numpy_laws."""

from __future__ import annotations

import numpy as np
import numpy_laws
import scenario
from scenario import BASE_T_CONSOLE, DT_S, RCM, TOUCH_T_CONSOLE

from saras import teleop

CUTOFF_HZ = 20.0


def configs():
    """(transparency, tank_master, tank_slave, integrator), as in config/*.yaml."""
    master = teleop.EnergyTankConfig(
        damping_min=np.zeros(6), damping_max=np.zeros(6), conjugate_rate=[20.0] * 3 + [200.0] * 3,
        applied_limit=[3.3] * 3 + [0.1] * 3, hold_s=0.012, dt_max_s=0.1,
    )  # fmt: skip
    slave = teleop.EnergyTankConfig(
        damping_min=[1e-3] * 3 + [0.0] * 3, damping_max=[3e-3] * 3 + [0.0] * 3,
        conjugate_rate=[400.0] * 3 + [40.0] * 3, applied_limit=[0.1] * 3 + [1.0] * 3, hold_s=0.03, dt_max_s=0.1,
    )  # fmt: skip
    transparency = teleop.TransparencyConfig(scale=scenario.SCALE, slave_lag_s=scenario.LAG_S)
    return transparency, master, slave, teleop.VelocityIntegratorConfig(shaft_through_rcm=True, dt_max_s=0.1)


class Ours:
    """saras.teleop."""

    def __init__(self):
        transparency, master, slave, integrator = configs()
        mapping = teleop.FrameMappingConfig(base_T_console=BASE_T_CONSOLE, touch_T_console=TOUCH_T_CONSOLE)
        self.mapping = [teleop.FrameMapping(mapping) for _ in range(2)]
        twist = teleop.TwistEstimatorConfig(cutoff_hz=CUTOFF_HZ)
        self.tip_twist = [teleop.TwistEstimator(twist) for _ in range(2)]
        self.transparency = [teleop.Transparency(transparency) for _ in range(2)]
        self.tank_master, self.tank_slave = teleop.EnergyTank(master, 2), teleop.EnergyTank(slave, 2)
        self.integrator = [teleop.VelocityIntegrator(integrator) for _ in range(2)]
        self.wrench = np.zeros((2, 6))
        self.tips = None

    def step(self, handles, tips, tissue):
        """(touch wrenches (2, 6), set-points (2, 4, 4), tank levels (2,))."""
        wrench, twist, hand, moving = np.zeros((2, 6)), np.zeros((2, 6)), np.zeros((2, 6)), np.zeros((2, 6))
        touch = []
        for i in range(2):
            mapped = self.mapping[i].step(handles[i], DT_S, base_wrench=self.wrench[i])
            moving[i] = self.tip_twist[i].step(tips[i], DT_S).twist
            out = self.transparency[i].step(
                mapped.tracked_pose, mapped.tracked_twist, tips[i], moving[i], tissue[i], RCM, DT_S,
                master_twist_filtered=mapped.tracked_twist_filtered,
            )  # fmt: skip
            wrench[i], twist[i], hand[i] = out.desired_wrench, out.desired_twist, mapped.handle_twist
            touch.append(mapped.touch_wrench)
        self.wrench = self.tank_master.step(wrench, hand, DT_S, work_J=0.0).applied
        work_J = slave_work_J(tissue, self.tips, tips)
        self.tips = tips
        applied = self.tank_slave.step(twist, tissue, DT_S, work_J=work_J, measured=moving).applied
        set_points = [self.integrator[i].step(applied[i], tips[i], RCM, DT_S).set_point for i in range(2)]
        return np.stack(touch), np.stack(set_points), self.levels()

    def levels(self):
        return np.array([self.tank_master.state.energy_J, self.tank_slave.state.energy_J])


class Numpy:
    """benchmarks/numpy_laws.py."""

    def __init__(self):
        transparency, master, slave, integrator = (plain(config) for config in configs())
        self.mapping = [numpy_laws.FrameMapping(BASE_T_CONSOLE, TOUCH_T_CONSOLE, CUTOFF_HZ) for _ in range(2)]
        self.tip_twist = [numpy_laws.TwistEstimator(CUTOFF_HZ) for _ in range(2)]
        self.transparency = [numpy_laws.Transparency(transparency) for _ in range(2)]
        self.tank_master, self.tank_slave = numpy_laws.EnergyTank(master, 2), numpy_laws.EnergyTank(slave, 2)
        self.integrator = [numpy_laws.VelocityIntegrator(integrator) for _ in range(2)]
        self.wrench = np.zeros((2, 6))
        self.tips = None

    def step(self, handles, tips, tissue):
        wrench, twist, hand, moving = np.zeros((2, 6)), np.zeros((2, 6)), np.zeros((2, 6)), np.zeros((2, 6))
        touch = []
        for i in range(2):
            tracked, hand[i], filtered, touch_wrench = self.mapping[i].step(handles[i], DT_S, self.wrench[i])
            moving[i] = self.tip_twist[i].step(tips[i], DT_S)
            wrench[i], twist[i] = self.transparency[i].step(tracked, hand[i], filtered, tips[i], moving[i], RCM, DT_S)
            touch.append(touch_wrench)
        self.wrench, _ = self.tank_master.step(wrench, hand, DT_S, work_J=0.0)
        work_J = slave_work_J(tissue, self.tips, tips)
        self.tips = tips
        applied, _ = self.tank_slave.step(twist, tissue, DT_S, work_J=work_J, measured=moving)
        set_points = [self.integrator[i].step(applied[i], tips[i], RCM, DT_S) for i in range(2)]
        return np.stack(touch), np.stack(set_points), self.levels()

    def levels(self):
        return np.array([self.tank_master.energy_J, self.tank_slave.energy_J])


def slave_work_J(tissue, before, now):
    """Wrench times measured displacement of the tips, translation only."""
    return 0.0 if before is None else float((tissue[:, :3] * (now[:, :3, 3] - before[:, :3, 3])).sum())


def plain(config):
    """A config's fields as attributes of a Python object: reading them costs numpy no crossing into C++."""
    return type("Plain", (), {name: getattr(config, name) for name in config._fields})


def worst_difference(ticks=scenario.TICKS):
    """Largest difference between both over the scenario: touch wrenches, set-points, tank levels."""
    ours, numpy_pipeline = Ours(), Numpy()
    worst = 0.0
    for row in scenario.inputs()[:ticks]:
        for a, b in zip(ours.step(*row), numpy_pipeline.step(*row)):
            worst = max(worst, float(np.abs(a - b).max()))
    return worst
