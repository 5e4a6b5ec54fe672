"""The overlay's drawing as one would write it in Python with OpenCV: the peer of the group overlay."""

from __future__ import annotations

import cv2
import numpy as np

from saras.overlay import CameraConfig, ToolMark, color_of

PIECES = 12  # of a shaft, for its thickness and the lens
LINE_M, THINNEST_PX, THICKEST_PX, RULER_M, TICKS, NEAR_M, RIM_PX = 0.0012, 1.5, 9.0, 0.01, 5, 0.005, 0.9
SHIFT = 4  # OpenCV draws on fractions of a pixel


class Painter:
    """Of one eye; bgr8. letters: False leaves them out, to compare the lines."""

    def __init__(self, camera: CameraConfig, letters: bool = True) -> None:
        self.letters = letters
        p = np.asarray(camera.P)
        self.shift = np.linalg.solve(p[:, :3], p[:, 3])
        self.turn = np.eye(3) if camera.rectified else np.asarray(camera.R).T
        self.k = np.ascontiguousarray(p[:, :3] if camera.rectified else np.asarray(camera.K))
        self.distortion = None if camera.rectified else np.asarray(camera.distortion)
        self.focal = 0.5 * (self.k[0, 0] + self.k[1, 1])
        self.scale = camera.height_px / 480.0
        self.text_px = round(0.033 * camera.height_px)
        self.font = self.text_px / 21.0  # of the Hershey capitals

    def eye(self, points: np.ndarray) -> np.ndarray:
        """(n, 3) in this eye's frame."""
        return (points + self.shift) @ self.turn.T

    def pixels(self, in_eye: np.ndarray) -> np.ndarray:
        """(n, 2)."""
        return cv2.projectPoints(in_eye, np.zeros(3), np.zeros(3), self.k, self.distortion)[0].reshape(-1, 2)

    def radius(self, depth: float) -> float:
        thickness = self.focal * LINE_M / depth
        return 0.5 * min(max(thickness, self.scale * THINNEST_PX), self.scale * THICKEST_PX)

    def line(self, image: np.ndarray, a: np.ndarray, b: np.ndarray, radius: float, color: tuple) -> None:
        ends = [tuple(np.round(2**SHIFT * p).astype(int).tolist()) for p in (a, b)]
        cv2.line(image, *ends, color, max(1, round(2.0 * radius)), cv2.LINE_AA, SHIFT)

    def disc(self, image: np.ndarray, at: np.ndarray, radius: float, color: tuple) -> None:
        center = tuple(np.round(2**SHIFT * at).astype(int).tolist())
        cv2.circle(image, center, round(2**SHIFT * radius), color, -1, cv2.LINE_AA, SHIFT)

    def segment(self, image: np.ndarray, a: np.ndarray, b: np.ndarray, color: tuple) -> np.ndarray | None:
        """Pixels of the pieces; None: behind."""
        ends = self.eye(np.array([a, b]))
        za, zb = ends[:, 2]
        if max(za, zb) < NEAR_M:
            return None
        if za < NEAR_M:
            ends[0] += (NEAR_M - za) / (zb - za) * (ends[1] - ends[0])
        elif zb < NEAR_M:
            ends[1] += (NEAR_M - zb) / (za - zb) * (ends[0] - ends[1])
        share = np.linspace(0.0, 1.0, PIECES + 1)
        za, zb = ends[:, 2]
        inverse = (1.0 - share) / za + share / zb  # even steps in the image
        points = ends[0] + (share / zb / inverse)[:, None] * (ends[1] - ends[0])
        pixels = self.pixels(points)
        for rim, with_color in ((RIM_PX * self.scale, (0, 0, 0)), (0.0, color)):
            for i in range(PIECES):
                depth = 2.0 / (inverse[i] + inverse[i + 1])
                self.line(image, pixels[i], pixels[i + 1], self.radius(depth) + rim, with_color)
        return pixels

    def text(self, image: np.ndarray, text: str, x: float, y: float, color: tuple) -> None:
        """Lower left corner at x, y; with a dark rim."""
        if not self.letters:
            return
        at = (int(x), int(y))
        thick = max(1, round(0.17 * self.text_px))
        cv2.putText(image, text, at, cv2.FONT_HERSHEY_SIMPLEX, self.font, (0, 0, 0), thick + 4, cv2.LINE_AA)
        cv2.putText(image, text, at, cv2.FONT_HERSHEY_SIMPLEX, self.font, color, thick, cv2.LINE_AA)

    def tool(self, image: np.ndarray, mark: ToolMark) -> None:
        r, g, b, _ = color_of(mark.level)
        color = (b, g, r)
        if mark.placed:
            pixels = self.segment(image, mark.tip, mark.trocar, color)
            if pixels is not None:
                self.ruler(image, mark, color)
                tip = self.eye(mark.tip[None])
                self.disc(image, pixels[0], 2.0 * self.radius(tip[0, 2]), color)
                self.text(image, f"{1e3 * mark.distance_m:.1f} mm", *(pixels[0] + [10, -8]), color)
        if mark.witness:
            self.segment(image, mark.on_tool, mark.on_partner, color)
            for point in (mark.on_tool, mark.on_partner):
                in_eye = self.eye(point[None])
                self.disc(image, self.pixels(in_eye)[0], 1.4 * self.radius(in_eye[0, 2]) + 1.0, color)

    def ruler(self, image: np.ndarray, mark: ToolMark, color: tuple) -> None:
        along = mark.trocar - mark.tip
        u = along / np.linalg.norm(along)
        at = mark.tip + RULER_M * np.arange(1, TICKS + 1)[:, None] * u
        in_eye = self.eye(np.concatenate([at, at + 0.001 * u]))
        pixels = self.pixels(in_eye)
        for i in range(TICKS):
            d = pixels[TICKS + i] - pixels[i]
            radius = self.radius(in_eye[i, 2])
            across = (2.5 * radius + 1.0) * np.array([-d[1], d[0]]) / np.linalg.norm(d)
            self.line(image, pixels[i] - across, pixels[i] + across, 0.6 * radius, color)

    def draw(self, image: np.ndarray, marks: list[ToolMark]) -> None:
        lines = [f"{mark.name}  {1e3 * mark.distance_m:.1f} mm" for mark in marks]
        height = round(1.9 * self.text_px)
        box = image[: len(marks) * height, : round(0.95 * self.text_px * max(map(len, lines)))]
        box[:] = (box.astype(np.uint16) * 110 >> 8).astype(np.uint8)
        for mark in marks:
            self.tool(image, mark)
        for i, (text, mark) in enumerate(zip(lines, marks)):
            r, g, b, _ = color_of(mark.level)
            self.text(image, text, 0.5 * self.text_px, (i + 0.8) * height, (b, g, r))
