"""Seeded pictures for the surfaces: RGB, uint8. Needs OpenCV."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from saras.calibration.board import Board
from saras.calibration.rendering import BoardPattern

Image = npt.NDArray[np.uint8]
Array = npt.NDArray[np.float64]


def cloud(rng: np.random.Generator, size: tuple[int, int], cells: int, octaves: int, fall: float = 0.5) -> Array:
    """(rows, columns) smooth noise about 0 with deviation 1: `cells` across the coarsest octave."""
    import cv2

    rows, columns = size
    total = np.zeros(size)
    for octave in range(octaves):
        n = max(2, min(columns, cells << octave))
        coarse = rng.normal(size=(max(2, n * rows // columns), n)).astype(np.float32)
        total += fall**octave * cv2.resize(coarse, (columns, rows), interpolation=cv2.INTER_CUBIC)
    total -= total.mean()
    return np.asarray(total / total.std())


def tissue(rng: np.random.Generator, side: int = 2048) -> Image:
    """Moist tissue: mottled, with branching vessels and streaks of fat."""
    import cv2

    mottle = cloud(rng, (side, side), 12, 6, 0.62)
    grain = cloud(rng, (side, side), side // 4, 2, 0.8)
    vessels = np.zeros((side, side), np.uint8)
    for _ in range(13):
        _vessel(vessels, rng, rng.uniform(0, side, 2), rng.uniform(0, 2 * np.pi), rng.uniform(2.0, 5.0))
    dark = cv2.GaussianBlur(vessels, (0, 0), 1.6).astype(float) / 255.0
    fat = np.clip(cloud(rng, (side, side), 7, 4) - 1.0, 0.0, 1.0)[..., None]
    colour = (
        np.array([196.0, 92.0, 82.0]) + mottle[..., None] * [17.0, 15.0, 13.0] + grain[..., None] * [11.0, 9.0, 8.0]
    )
    colour += fat * (np.array([226.0, 176.0, 96.0]) - colour) * 0.8
    colour += 0.75 * dark[..., None] * (np.array([112.0, 22.0, 34.0]) - colour)
    return _bytes(colour)


def lining(rng: np.random.Generator, side: int = 512) -> Image:
    """The abdominal wall from inside: dark, little of it is lit."""
    mottle = cloud(rng, (side, side), 24, 5, 0.6)[..., None]
    return _bytes(np.array([46.0, 19.0, 18.0]) + mottle * [7.0, 4.0, 4.0])


def bone(rng: np.random.Generator, side: int = 256) -> Image:
    """Ivory with pores."""
    mottle = cloud(rng, (side, side), 16, 5, 0.6)[..., None]
    return _bytes(np.array([222.0, 208.0, 176.0]) + mottle * [10.0, 10.0, 11.0])


def board(pattern: Board, half_m: float, pixel_m: float) -> Image:
    """The print, row 0 at y = +half_m, column 0 at x = -half_m; each pixel is the mean of 3 by 3 points."""
    count = round(2.0 * half_m / pixel_m)
    white = np.zeros((count, count))
    shade = BoardPattern(pattern).shade
    for du in (-1.0, 0.0, 1.0):
        for dv in (-1.0, 0.0, 1.0):
            x = (np.arange(count) + 0.5 + du / 3.0) * pixel_m - half_m
            y = half_m - (np.arange(count) + 0.5 + dv / 3.0) * pixel_m
            grid = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
            white += shade(grid).reshape(count, count) / 9.0
    return np.repeat(_bytes(255.0 * (0.08 + 0.84 * white))[..., None], 3, axis=2)


def _vessel(image: Image, rng: np.random.Generator, at: Array, heading: float, width: float) -> None:
    import cv2

    path = [at.copy()]
    turn = 0.0
    for _ in range(int(rng.integers(40, 120))):
        turn = 0.75 * turn + rng.normal(0.0, 0.045)
        heading += turn
        at = at + 14.0 * np.array([np.cos(heading), np.sin(heading)])
        path.append(at.copy())
        if width > 2.0 and rng.random() < 0.035:
            _vessel(image, rng, at, heading + rng.choice([-0.7, 0.7]), 0.6 * width)
    points = np.round(np.array(path)).astype(np.int32)[:, None]
    cv2.polylines(image, [points], False, 255, max(1, round(width)), cv2.LINE_AA)


def _bytes(values: Array) -> Image:
    return np.asarray(np.clip(np.round(values), 0, 255), dtype=np.uint8)
