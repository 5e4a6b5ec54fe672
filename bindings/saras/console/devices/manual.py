"""Device ``manual``: the intended motion comes from mouse, keyboard or gamepad through a window (library pygame).

Mouse: move with the left button held (across the shaft), wheel (depth); left/right arrow or Q/E turn; space closes the
clip; shift presses the clutch. A gamepad's sticks move, its shoulder buttons turn, A closes the clip, B is the clutch.
The hand is simulated as in the other devices, so that force moves the handle and the window shows by how much.

One window serves both handles: TAB (or the gamepad's Start) changes which one is moved.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Mapping
from typing import Any

from saras.console import options as option
from saras.console.devices.simulated import COMMON_OPTIONS, SimulatedHandle
from saras.console.motion import Intent, Offset

HELP = "drag: across   wheel: depth   Q/E: turn   space: clip   shift: clutch   TAB: other hand"
REACH_M = 0.045  #: the intended position stays within this distance of home
SMOOTHING_HZ = 3.0  #: the hand's intention follows the pointer like a first-order low-pass
METRES_PER_PIXEL = 2e-4
STICK_SPEED_M_S = 0.08
TURN_SPEED_RAD_S = 1.5


class Pointer:
    """An intended motion towards a target that a window moves.

    Written by the main thread, read by the control thread.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._target = [0.0, 0.0, 0.0]
        self._roll = 0.0
        self._grip = 1.0
        self._clutch = False
        self._position = [0.0, 0.0, 0.0]
        self._smooth_roll = 0.0
        self._last_t = 0.0

    def move(self, dx: float, dy: float, dz: float, roll: float) -> None:
        """Moves the target by metres and radians, inside the reach."""
        with self._lock:
            moved = [a + b for a, b in zip(self._target, (dx, dy, dz))]
            scale = min(1.0, REACH_M / max(1e-12, math.hypot(*moved)))
            self._target = [scale * value for value in moved]
            self._roll = min(2.5, max(-2.5, self._roll + roll))

    def press(self, clip: bool, clutch: bool) -> None:
        """Levels of the two buttons."""
        with self._lock:
            self._grip, self._clutch = (0.0 if clip else 1.0), clutch

    @property
    def target(self) -> tuple[float, ...]:
        """Where the pointer is [m]."""
        return tuple(self._target)

    def at(self, t: float) -> Intent:
        """Position and its exact derivative, low-passed."""
        with self._lock:
            dt, self._last_t = max(0.0, t - self._last_t), t
            gain = 1.0 - math.exp(-2.0 * math.pi * SMOOTHING_HZ * dt)
            ahead = [a - b for a, b in zip(self._target, self._position)]
            self._position = [b + gain * a for a, b in zip(ahead, self._position)]
            self._smooth_roll += gain * (self._roll - self._smooth_roll)
            rate = 2.0 * math.pi * SMOOTHING_HZ * (1.0 - gain)
            offset: Offset = (self._position[0], self._position[1], self._position[2])
            velocity: Offset = (rate * ahead[0], rate * ahead[1], rate * ahead[2])
            return Intent(offset, velocity, self._smooth_roll, self._grip, self._clutch)


class Window:
    """The one window of all manual handles."""

    _open: Window | None = None

    def __init__(self) -> None:
        import pygame

        self._pygame: Any = pygame
        pygame.init()
        self._surface = pygame.display.set_mode((640, 360))
        pygame.display.set_caption("SARAS console")
        self._font = pygame.font.Font(None, 22)
        self._sticks = [pygame.joystick.Joystick(i) for i in range(pygame.joystick.get_count())]
        self.pointers: dict[str, Pointer] = {}
        self._texts: dict[str, str] = {}
        self._active = ""
        self.alive = True

    @classmethod
    def shared(cls) -> Window:
        """Opens the window on first use."""
        if cls._open is None:
            cls._open = cls()
        return cls._open

    def pump(self, side: str, status: Mapping[str, object]) -> bool:
        """Handles events once a round (on the first side's turn) and draws."""
        self._texts[side] = (
            f"{side}: {status.get('state')}   force {status.get('force_N', 0.0):.2f} N   "
            f"energy {status.get('energy_J', 0.0):.3f} J"
        )
        if self.alive and side == next(iter(self.pointers)):
            self._events()
            self._keys(1.0 / 20.0)
            self._draw()
        return self.alive

    def _events(self) -> None:
        pygame = self._pygame
        for event in pygame.event.get():
            pointer = self.pointers[self._active]
            if event.type == pygame.QUIT:
                self.alive = False
            elif event.type == pygame.MOUSEMOTION and event.buttons[0]:
                # Right on the screen is -y of simball_base, up is +x (away); home turns y and z over.
                pointer.move(-event.rel[1] * METRES_PER_PIXEL, event.rel[0] * METRES_PER_PIXEL, 0.0, 0.0)
            elif event.type == pygame.MOUSEWHEEL:
                pointer.move(0.0, 0.0, -event.y * 0.002, 0.0)
            elif (event.type == pygame.KEYDOWN and event.key == pygame.K_TAB) or (
                event.type == pygame.JOYBUTTONDOWN and event.button == 7
            ):
                sides = list(self.pointers)
                self._active = sides[(sides.index(self._active) + 1) % len(sides)]

    def _keys(self, dt: float) -> None:
        pygame, keys = self._pygame, self._pygame.key.get_pressed()
        turn = (keys[pygame.K_e] or keys[pygame.K_RIGHT]) - (keys[pygame.K_q] or keys[pygame.K_LEFT])
        clip, clutch = bool(keys[pygame.K_SPACE]), bool(keys[pygame.K_LSHIFT] or keys[pygame.K_RSHIFT])
        dx = dy = dz = 0.0
        for stick in self._sticks:
            axes = [_dead(stick.get_axis(i)) for i in range(min(4, stick.get_numaxes()))] + [0.0] * 4
            dx, dy, dz = dx - axes[1], dy + axes[0], dz + axes[3]
            pressed = [bool(stick.get_button(i)) for i in range(stick.get_numbuttons())] + [False] * 8
            clip, clutch, turn = clip or pressed[0], clutch or pressed[1], turn + pressed[5] - pressed[4]
        step = STICK_SPEED_M_S * dt
        self.pointers[self._active].move(dx * step, dy * step, dz * step, float(turn) * TURN_SPEED_RAD_S * dt)
        for side, pointer in self.pointers.items():
            pointer.press(clip and side == self._active, clutch and side == self._active)

    def _draw(self) -> None:
        pygame = self._pygame
        self._surface.fill((24, 26, 30))
        for i, (side, pointer) in enumerate(self.pointers.items()):
            colour = (120, 220, 120) if side == self._active else (130, 130, 130)
            x, y, z = pointer.target
            centre = (160 + 320 * i, 190)
            pygame.draw.circle(self._surface, (70, 74, 80), centre, 120, 1)
            pygame.draw.circle(
                self._surface,
                colour,
                (centre[0] + y / REACH_M * 120, centre[1] - x / REACH_M * 120),
                8 + 60 * max(0, z),
            )
            self._surface.blit(self._font.render(self._texts.get(side, side), True, colour), (12, 320 + 18 * i))
        self._surface.blit(
            self._font.render("drag, wheel, Q/E, space: clip, shift: clutch, TAB", True, (180, 180, 180)), (12, 10)
        )
        pygame.display.flip()

    def add(self, side: str) -> Pointer:
        """A pointer for one more handle; the first one is active."""
        self.pointers[side] = Pointer()
        self._active = self._active or side
        return self.pointers[side]

    def remove(self, side: str) -> None:
        """Closes the window after its last handle."""
        self.pointers.pop(side, None)
        if not self.pointers and Window._open is self:
            self._pygame.quit()
            Window._open = None
            self.alive = False


def _dead(axis: float) -> float:
    """Small deflections of a worn stick are none."""
    return axis if abs(axis) > 0.15 else 0.0


class ManualHandle(SimulatedHandle):
    """A simulated hand that wants to be where the pointer is."""

    def __init__(self, side: str, options: Mapping[str, str]) -> None:
        self._side = side
        self._window = Window.shared()
        super().__init__(self._window.add(side), side, options)

    def pump(self, status: Mapping[str, object]) -> bool:
        """Window events and drawing; False when the window was closed."""
        return self._window.pump(self._side, status)

    def close(self) -> None:
        """Force to zero, window closed with the last handle."""
        super().close()
        self._window.remove(self._side)


def make(side: str, options: Mapping[str, str]) -> ManualHandle:
    """Options: those of every simulated handle. Needs pygame."""
    option.refuse_unknown(options, COMMON_OPTIONS, "manual")
    return ManualHandle(side, options)
