"""Rows of the group overlay: drawing four tools into one 1920 x 1080 picture, beside the same in Python with OpenCV.

Ours is called through its binding, whose cost (a microsecond or two) is in its times.
"""

from __future__ import annotations

import sys
import time

import numpy as np

from saras.collision import ProximityState
from saras.overlay import (
    CameraConfig,
    OverlayPainter,
    OverlayTool,
    ToolOverlay,
    ToolOverlayOutput,
    color_of,
    fingerprint,
)

WIDTH, HEIGHT, FRAMES, WARM_UP = 1920, 1080, 400, 20
LEAST_SHARE, NEAR_PX = 0.97, 2


class NotTheSame(RuntimeError):
    """The peer draws something else: its time would say nothing."""


def camera(rectified: bool) -> CameraConfig:
    k = np.array([[1400.0, 0.0, 965.0], [0.0, 1395.0, 541.0], [0.0, 0.0, 1.0]])
    p = np.column_stack([k, [-1400.0 * 0.005, 0.0, 0.0]])
    return CameraConfig(
        width_px=WIDTH,
        height_px=HEIGHT,
        K=k,
        P=p,
        distortion=[-0.22, 0.08, 5e-4, -4e-4, 0, 0, 0, 0],
        rectified=rectified,
    )


def frames() -> list[ToolOverlayOutput]:
    """Four tools that move about; the first two near each other, with their nearest points."""
    rng, law, out = np.random.default_rng(1), ToolOverlay(), []
    tips = np.array([[-0.016, 0.012, 0.105], [0.012, 0.016, 0.11], [-0.026, -0.014, 0.12], [0.024, -0.018, 0.125]])
    trocars = np.array([[-0.09, 0.08, 0.02], [0.09, 0.08, 0.02], [-0.11, -0.03, 0.03], [0.11, -0.03, 0.03]])
    levels = (ProximityState.WARNING, ProximityState.WARNING, ProximityState.CLEAR, ProximityState.CLEAR)
    for _ in range(FRAMES):
        tools = []
        moved = tips + rng.normal(0.0, 0.003, (4, 3))
        for i, name in enumerate(("MESA LEFT", "MESA RIGHT", "PSM1", "PSM2")):
            near = {"on_tool": moved[0], "on_partner": moved[1], "known_distance_m": 0.009} if i < 2 else {}
            distance = 0.009 if i < 2 else 0.04
            tools.append(
                OverlayTool(name=name, tip=moved[i], trocar=trocars[i], distance_m=distance, state=levels[i], **near)
            )
        ages = {"distances_age_s": 0.01, "tools_age_s": 0.01, "camera_age_s": 0.01, "dt": 0.04}
        out.append(law.step(tools, camera_T_world=np.eye(4), **ages))
    return out


def timed(call, arguments: list[tuple]) -> dict[str, float]:
    """{"p50", "p99"} of single calls [µs], the first ones not counted."""
    samples = []
    for given in arguments:
        start = time.perf_counter_ns()
        call(*given)
        samples.append(time.perf_counter_ns() - start)
    return {f"p{q}": float(np.percentile(samples[WARM_UP:], q)) / 1e3 for q in (50, 99)}


def coloured(image: np.ndarray) -> np.ndarray:
    """(height, width) whether a pixel has the colour of a level, in the part that the list does not reach."""
    found = np.zeros(image.shape[:2], dtype=bool)
    for level in (ProximityState.WARNING, ProximityState.CLEAR):
        r, g, b, _ = color_of(level)
        found |= (np.abs(image.astype(int) - [b, g, r]) < 60).all(axis=-1)
    found[:300, :700] = False
    return found


def same_lines(frame: ToolOverlayOutput, rectified: bool) -> float:
    """Share of the peer's lines that are within NEAR_PX of ours: its lines are whole pixels thick."""
    import cv2
    import overlay_opencv

    images = [np.full((HEIGHT, WIDTH, 3), 60, dtype=np.uint8) for _ in range(2)]
    OverlayPainter(camera(rectified)).draw(frame, images[0], "bgr8")
    overlay_opencv.Painter(camera(rectified), letters=False).draw(images[1], list(frame.tools))
    ours, theirs = map(coloured, images)
    near = cv2.dilate(ours.astype(np.uint8), np.ones((2 * NEAR_PX + 1, 2 * NEAR_PX + 1), np.uint8)) > 0
    return float((near & theirs).sum() / theirs.sum())


def run() -> list[dict]:
    """Rows in the format of the JSON file. Raises NotTheSame."""
    try:
        import overlay_opencv
    except ImportError:
        print("overlay: left out, needs OpenCV: apt-get install python3-opencv", file=sys.stderr)
        return []
    rows, marks = [], frames()
    lists = [list(frame.tools) for frame in marks]
    for rectified in (True, False):
        ours, theirs = OverlayPainter(camera(rectified)), overlay_opencv.Painter(camera(rectified))
        share = min(same_lines(frame, rectified) for frame in marks[:5])
        if not share >= LEAST_SHARE:
            raise NotTheSame(f"overlay: of opencv's lines only {share:.0%} are within {NEAR_PX} px of ours")
        print(
            f"overlay: opencv draws the same ({share:.0%} of its lines are within {NEAR_PX} px of ours)",
            file=sys.stderr,
        )
        images = [np.full((HEIGHT, WIDTH, 3), 60, dtype=np.uint8) for _ in range(2)]
        own = timed(ours.draw, [(frame, images[0], "bgr8") for frame in marks])
        peer = timed(theirs.draw, [(images[1], frame) for frame in lists])
        rows.append(row("rectified_1080p" if rectified else "raw_1080p", own, {"opencv_python": peer}))
    image = np.random.default_rng(2).integers(0, 256, (HEIGHT, WIDTH, 3), dtype=np.uint8)
    rows.append(row("frozen_fingerprint_1080p", timed(fingerprint, FRAMES * [(image, "bgr8")]), {}))
    rows.append(row("copy_1080p", timed(image.copy, FRAMES * [()]), {}))
    return rows


def row(name: str, ours: dict[str, float], peers: dict[str, dict[str, float]]) -> dict:
    ratio = {peer: round(times["p50"] / ours["p50"], 2) for peer, times in peers.items()}
    return {"group": "overlay", "name": name, "unit": "us", "ours": ours, "peers": peers, "ratio": ratio}
