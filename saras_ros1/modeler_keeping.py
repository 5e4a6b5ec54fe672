"""The map kept in a file and taken from one, as the modeler's services do it."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Callable

import numpy as np

from saras import ConfigError, Error
from saras.model import StiffMesh
from saras.model.live import LiveMap
from saras_ros1.modeler_prior import refuse_elsewhere
from saras_ros1.srv import KeepModel, KeepModelResponse


class Keeping:
    """lock: nobody forgets while a file is written. forgotten: called when a loaded map has taken the place of all."""

    def __init__(self, live: LiveMap, lock: threading.Lock, forgotten: Callable[[], None]) -> None:
        self._live, self._lock, self._forgotten = live, lock, forgotten

    def save(self, request: KeepModel) -> KeepModelResponse:
        """Writes the map; a file that is there stays whole until the new one is."""
        path = Path(request.path)
        try:
            if not path.is_absolute():
                raise ConfigError(f"path = {request.path!r}: must be absolute")
            if path.exists() and not request.force:
                raise ConfigError(f"{path}: is there already: force overwrites it")
            with self._lock:
                kept = self._live.stiff_mesh()
                partial = path.with_name(f".{path.name}.part")
                kept.save(partial)
                partial.replace(path)
        except (Error, OSError, ImportError) as error:
            return KeepModelResponse(False, str(error))
        return KeepModelResponse(True, _said(path, kept))

    def load(self, request: KeepModel) -> KeepModelResponse:
        """The map of the file is shown where nothing is touched, from now on."""
        try:
            kept = StiffMesh.load(request.path)
            refuse_elsewhere(kept, self._live.laid.mesh)
            with self._lock:
                self._live.take(kept)
                self._forgotten()
        except (Error, OSError, ImportError) as error:
            return KeepModelResponse(False, str(error))
        return KeepModelResponse(True, _said(Path(request.path), kept))


def _said(path: Path, kept: StiffMesh) -> str:
    return f"{path}: {len(kept.vertices)} vertices, {int(np.isfinite(kept.stiffness_N_m).sum())} of them known"
