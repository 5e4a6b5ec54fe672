"""Where VTK draws when there is no display, and how its pixels become arrays."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import numpy.typing as npt

from saras import Error

#: The first VTK that chooses its window at run time: with EGL it needs neither a display nor a graphics card.
FREE_OF_DISPLAYS = (9, 4)


class NoWindowError(Error):
    """There is nothing to draw into; the text says what is missing."""


def check_drawing() -> None:
    """Raises NoWindowError: no VTK, or a VTK that needs a display where there is none."""
    try:
        import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (registers the OpenGL classes)
        from vtkmodules.vtkCommonCore import vtkVersion
    except ImportError as error:
        raise NoWindowError(f"the simulated endoscope needs VTK: pip install vtk ({error})") from None
    version = vtkVersion.GetVTKMajorVersion(), vtkVersion.GetVTKMinorVersion()
    if version >= FREE_OF_DISPLAYS:
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    elif "DISPLAY" not in os.environ:  # this VTK would end the process
        raise NoWindowError(
            f"VTK {version[0]}.{version[1]} draws on a display only: must be >= 9.4 (pip install vtk), or start Xvfb"
        )


def offscreen_window(width: int, height: int) -> Any:
    """A vtkRenderWindow that no one sees, of this size. To be used in the thread that made it. As check_drawing."""
    check_drawing()
    from vtkmodules.vtkRenderingCore import vtkRenderWindow

    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(width, height)
    return window


class Pixels:
    """Reads a window back into buffers that are used again: copy what is to be kept."""

    def __init__(self, window: Any) -> None:
        from vtkmodules.vtkCommonCore import vtkFloatArray, vtkUnsignedCharArray

        self._window = window
        self._width, self._height = window.GetSize()
        self._colours, self._depths = vtkUnsignedCharArray(), vtkFloatArray()

    def colours(self) -> npt.NDArray[np.uint8]:
        """(height, width, 3) RGB, lowest row first."""
        from vtkmodules.util.numpy_support import vtk_to_numpy

        self._window.GetPixelData(0, 0, self._width - 1, self._height - 1, 0, self._colours, 0)
        pixels: npt.NDArray[np.uint8] = vtk_to_numpy(self._colours).reshape(self._height, self._width, 3)
        return pixels

    def depths(self) -> npt.NDArray[np.float32]:
        """(height, width) of the depth buffer, 0 at the near plane, 1 at the far one; lowest row first."""
        from vtkmodules.util.numpy_support import vtk_to_numpy

        self._window.GetZbufferData(0, 0, self._width - 1, self._height - 1, self._depths)
        values: npt.NDArray[np.float32] = vtk_to_numpy(self._depths).reshape(self._height, self._width)
        return values


__all__ = ["NoWindowError", "Pixels", "check_drawing", "offscreen_window"]
