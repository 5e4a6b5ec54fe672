"""The laws of saras.teleop written in numpy: the peer of the teleop benchmark.

The same formulas, states and order of operations for good input (finite, fresh, valid time step, clutch released);
bad input is refused with one check instead of a status. test_bench.py and the benchmark itself hold them to 1e-9.
"""

from __future__ import annotations

import numpy as np


def log(rotation):
    """Rotation vector of a (3, 3) matrix, below pi."""
    vee = 0.5 * np.array(
        [rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]]
    )
    sine = np.linalg.norm(vee)
    if sine < 1e-12:
        return vee
    return vee * (np.arctan2(sine, 0.5 * (np.trace(rotation) - 1.0)) / sine)


def exp(vector):
    """(3, 3) of a rotation vector."""
    angle = np.linalg.norm(vector)
    if angle < 1e-12:
        return np.eye(3)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def clamp_norm(vector, limit):
    norm = np.linalg.norm(vector)
    return vector * (limit / norm) if norm > limit else vector


def displacement(base_T_1, base_T_2):
    return np.concatenate([base_T_2[:3, 3] - base_T_1[:3, 3], log(base_T_2[:3, :3] @ base_T_1[:3, :3].T)])


def angle_between(a, b):
    return np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b)


def check(*values):
    for value in values:
        if not np.isfinite(value).all():
            raise ValueError("not finite")


class TwistEstimator:
    def __init__(self, cutoff_hz):
        self.cutoff_hz, self.previous, self.filtered = cutoff_hz, None, np.zeros(6)

    def step(self, pose, dt):
        check(pose)
        if self.previous is None:
            self.previous = pose
            return np.zeros(6)
        twist = displacement(self.previous, pose) / dt
        self.filtered = self.filtered - np.expm1(-2 * np.pi * self.cutoff_hz * dt) * (twist - self.filtered)
        self.previous = pose
        return twist


class FrameMapping:
    def __init__(self, base_T_console, touch_T_console, cutoff_hz):
        self.base_T_console, self.touch_T_console, self.cutoff_hz = base_T_console, touch_T_console, cutoff_hz
        self.reference = None
        self.filtered = np.zeros(6)

    def step(self, handle, dt, base_wrench):
        check(handle, base_wrench)
        base_R_console = self.base_T_console[:3, :3]
        touch_R_base = self.touch_T_console[:3, :3] @ base_R_console.T
        touch_wrench = np.concatenate([touch_R_base @ base_wrench[:3], touch_R_base @ base_wrench[3:]])
        if self.reference is None:
            self.reference = self.base_T_console @ handle
            self.handle_reference = self.previous = handle
            return self.reference, np.zeros(6), np.zeros(6), touch_wrench
        moved = displacement(self.previous, handle)
        twist = np.concatenate([base_R_console @ moved[:3], base_R_console @ moved[3:]]) / dt
        tracked = np.eye(4)
        turn = handle[:3, :3] @ self.handle_reference[:3, :3].T
        tracked[:3, :3] = base_R_console @ turn @ base_R_console.T @ self.reference[:3, :3]
        tracked[:3, 3] = self.reference[:3, 3] + base_R_console @ (handle[:3, 3] - self.handle_reference[:3, 3])
        self.previous = handle
        self.filtered = self.filtered - np.expm1(-2 * np.pi * self.cutoff_hz * dt) * (twist - self.filtered)
        return tracked, twist, self.filtered, touch_wrench


class Transparency:
    """Mode position_position, pivoted."""

    def __init__(self, config):
        self.c = config
        self.master_reference = None
        self.ramp, self.lagged = 0.0, np.zeros(3)

    def step(self, master, master_twist, master_filtered, slave, slave_twist, rcm, dt):
        check(master, master_twist, master_filtered, slave, slave_twist, rcm)
        c = self.c
        if self.master_reference is None:
            self.master_reference, self.slave_reference = master, slave
            return np.zeros(6), np.zeros(6)
        moved = c.scale * (master[:3, 3] - self.master_reference[:3, 3])
        slave_moved = slave[:3, 3] - self.slave_reference[:3, 3]
        slave_turned = slave[:3, :3] @ self.slave_reference[:3, :3].T
        turned = slave_turned @ (master[:3, :3] @ self.master_reference[:3, :3].T).T
        error, turn_error = slave_moved - moved, log(turned)
        gain = 1.0 if c.slave_lag_s == 0 else 1.0 - np.exp(-dt / c.slave_lag_s)
        self.lagged = self.lagged + gain * (moved - self.lagged)
        linear = c.scale * master_twist[:3] - clamp_norm(
            c.drift_gain_1_s * (slave_moved - self.lagged), c.drift_limit_m_s
        )
        angular = master_twist[3:] - clamp_norm(c.rotation_drift_gain_1_s * turn_error, c.rotation_drift_limit_rad_s)
        arm = slave[:3, 3] - rcm
        radius = np.linalg.norm(arm)
        shaft = arm / radius
        angular = np.cross(shaft, linear) / max(radius, c.pivot_radius_min_m) + shaft * (shaft @ angular)
        rate_error = slave_twist - np.concatenate([c.scale * master_filtered[:3], master_filtered[3:]])
        force = c.stiffness_N_m * error + c.damping_N_s_m * rate_error[:3]
        torque = c.rotation_stiffness_Nm_rad * turn_error + c.rotation_damping_Nm_s_rad * rate_error[3:]
        self.ramp = min(1.0, self.ramp + dt / c.ramp_s)
        wrench = [clamp_norm(force, c.force_limit_N), clamp_norm(torque, c.torque_limit_Nm)]
        return self.ramp * np.concatenate(wrench), np.concatenate([linear, angular])


class EnergyTank:
    """Arrays are (channels, 6)."""

    def __init__(self, config, channels):
        self.c = c = config
        self.energy_J = c.initial_J
        self.applied = np.zeros((channels, 6))
        self.conjugate = None
        self.drift = np.asarray(c.conjugate_rate) * c.hold_s
        reserve = channels * (np.asarray(c.damping_max) * self.drift**2).sum() * c.hold_s / 4
        self.damping_floor_J = c.minimum_J - reserve

    def command(self, desired, conjugate, reduction, damping, scale):
        limit = self.c.applied_limit
        return np.clip(scale * ((1 - reduction) * desired) - damping * conjugate, -limit, limit)

    def worst_J(self, applied, conjugate, measured):
        worst = applied * conjugate + np.abs(applied) * self.drift
        if measured is not None:
            worst = np.maximum(worst, measured * conjugate + np.abs(measured) * self.drift)
        return worst.sum() * self.c.hold_s

    def step(self, desired, conjugate, dt, received_J=0.0, requests=0, work_J=None, measured=None):
        check(desired, conjugate, received_J)
        c = self.c
        work_J = float((self.applied * conjugate).sum() * dt) if work_J is None else work_J
        self.energy_J += received_J - work_J
        sent_J = min(requests * c.exchange_W * dt, max(0.0, self.energy_J - c.available_J))
        self.energy_J -= sent_J
        overflow_J = max(0.0, self.energy_J - c.maximum_J)
        self.energy_J -= overflow_J
        if self.conjugate is not None:
            powered = np.asarray(c.applied_limit) > 0
            if (np.abs(conjugate - self.conjugate)[:, powered] > self.drift[powered] * (1 + 1e-9)).any():
                raise ValueError("rate exceeded")
        self.conjugate = conjugate
        reduction = min(max((c.request_J - self.energy_J) / (c.request_J - c.minimum_J), 0.0), 1.0)
        damping = c.damping_min + reduction * (np.asarray(c.damping_max) - c.damping_min)
        budget_J = self.energy_J - c.minimum_J

        def fits(scale):
            return (
                self.worst_J(self.command(desired, conjugate, reduction, damping, scale), conjugate, measured)
                <= budget_J
            )

        if budget_J > 0 and fits(1.0):
            scale = 1.0
        elif budget_J > 0 and fits(0.0):
            scale = bisect(fits)
        else:
            self.applied = self.damp(conjugate, damping)
            return self.applied, sent_J + overflow_J
        self.applied = self.command(desired, conjugate, reduction, damping, scale)
        return self.applied, sent_J + overflow_J

    def damp(self, conjugate, damping):
        zero = np.zeros_like(conjugate)
        budget_J = max(0.0, self.energy_J - max(0.0, self.damping_floor_J))

        def fits(share):
            return self.worst_J(self.command(zero, conjugate, 1.0, share * damping, 0.0), conjugate, None) <= budget_J

        return self.command(zero, conjugate, 1.0, (1.0 if fits(1.0) else bisect(fits)) * damping, 0.0)


def bisect(fits):
    feasible, infeasible = 0.0, 1.0
    for _ in range(50):
        middle = 0.5 * (feasible + infeasible)
        if fits(middle):
            feasible = middle
        else:
            infeasible = middle
    return feasible


class VelocityIntegrator:
    def __init__(self, config):
        self.c = config
        self.set_point = None

    def step(self, twist, measured, rcm, dt):
        check(twist, measured, rcm)
        c = self.c
        if self.set_point is None:
            self.set_point, dt = measured, c.nominal_dt_s
        linear, angular = clamp_norm(twist[:3], c.speed_limit_m_s), clamp_norm(twist[3:], c.speed_limit_rad_s)
        previous = self.set_point[:3, 3]
        at = measured[:3, 3]
        wanted = at + clamp_norm(previous + linear * dt - at, c.lead_limit_m)
        wanted = self.within_workspace(wanted, rcm)
        wanted = at + clamp_norm(wanted - at, c.lead_limit_m)
        position = previous + clamp_norm(wanted - previous, c.speed_limit_m_s * dt)
        rotation = self.set_point[:3, :3]
        wanted_rotation = self.wanted_rotation(angular, rotation, position - rcm, dt)
        bounded = rotate_toward(measured[:3, :3], wanted_rotation, c.lead_limit_rad)
        self.set_point = np.eye(4)
        self.set_point[:3, :3] = rotate_toward(rotation, bounded, c.speed_limit_rad_s * dt)
        self.set_point[:3, 3] = position
        return self.set_point

    def within_workspace(self, wanted, rcm):
        c = self.c
        axis = np.asarray(c.cone_axis)
        previous = self.set_point[:3, 3] - rcm
        half_angle = max(c.cone_half_angle_rad, angle_between(axis, previous))
        low = min(c.insertion_min_m, np.linalg.norm(previous))
        high = max(c.insertion_max_m, np.linalg.norm(previous))
        shaft = wanted - rcm
        if angle_between(axis, shaft) > half_angle:
            across = shaft - axis * (axis @ shaft)
            edge = np.cos(half_angle) * axis + np.sin(half_angle) * across / np.linalg.norm(across)
            shaft = edge * max(edge @ shaft, 0.0)
        insertion = np.linalg.norm(shaft)
        return rcm + shaft * (min(max(insertion, low), high) / insertion)

    def wanted_rotation(self, angular, rotation, shaft, dt):
        c = self.c
        if not c.shaft_through_rcm:
            return exp(angular * dt) @ rotation
        z = rotation[:, 2]
        pivot = angle_between(z, shaft)
        roll_limit = np.sqrt(max(0.0, (c.speed_limit_rad_s * dt) ** 2 - pivot**2))
        roll = min(max(z @ angular * dt, -roll_limit), roll_limit)
        axis = np.cross(z, shaft)
        length = np.linalg.norm(axis)
        pivoting = exp(axis / length * pivot) if length > 1e-12 else np.eye(3)
        return pivoting @ exp(z * roll) @ rotation


def rotate_toward(start, end, limit):
    arc = log(end @ start.T)
    return exp(clamp_norm(arc, limit)) @ start if np.linalg.norm(arc) > limit else end
