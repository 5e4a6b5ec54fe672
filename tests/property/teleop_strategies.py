"""Hypothesis strategies for poses, twists and faults of the teleoperation laws."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

BAD_NUMBERS = st.sampled_from([np.nan, np.inf, -np.inf, 1e308, -1e308])
#: mostly good time steps [s], then none, stalls and clocks that step
FAULTY_DT = st.sampled_from([0.01, 0.01, 0.01, 0.004, 0.03, 0.0, -0.01, 3.0, np.nan, np.inf])


def vectors(size: float, n: int = 3) -> st.SearchStrategy[np.ndarray]:
    """(n,) with each component in [-size, size]."""
    return st.lists(st.floats(-size, size), min_size=n, max_size=n).map(np.array)


def rotations() -> st.SearchStrategy[Rotation]:
    """Any rotation, half turns and identity included."""
    return vectors(np.pi).map(Rotation.from_rotvec)


@st.composite
def poses(draw: st.DrawFn, size: float) -> np.ndarray:
    """(4, 4) with translation in a cube."""
    return pose(draw(rotations()), draw(vectors(size)))


def pose(rotation: Rotation, translation: np.ndarray) -> np.ndarray:
    """(4, 4) from scipy's rotation and (3,)."""
    a_T_b = np.eye(4)
    a_T_b[:3, :3] = rotation.as_matrix()
    a_T_b[:3, 3] = translation
    return a_T_b


def turn(a_T_b: np.ndarray) -> Rotation:
    """Rotation of a (4, 4) pose."""
    return Rotation.from_matrix(a_T_b[:3, :3])


def move(a_T_b: np.ndarray, twist: np.ndarray, dt: float) -> np.ndarray:
    """(4, 4) pose moved by a (6,) twist in a for dt: scipy's own exponential."""
    return pose(Rotation.from_rotvec(twist[3:] * dt) * turn(a_T_b), a_T_b[:3, 3] + twist[:3] * dt)


@st.composite
def spoilt(draw: st.DrawFn, value: np.ndarray) -> np.ndarray:
    """The array with one number replaced by a bad one."""
    result = np.array(value, dtype=float)
    result.flat[draw(st.integers(0, result.size - 1))] = draw(BAD_NUMBERS)
    return result
