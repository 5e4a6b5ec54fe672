"""A cost of exploration written as a .m function: one Octave process computes it, beside this one.

Octave is optional (Debian: apt install octave). The function gets what a cost in Python gets, a path a row:

    function costs = my_cost(estimates, points)   % estimates.stiffness_N_m ... (c, n), vectors (c, n, 3); -> (c, 1)

Requests and answers are doubles of this machine over two pipes of their own, so the function may print what it likes.
"""

from __future__ import annotations

import os
import re
import selectors
import shutil
import subprocess
import threading
import time
import weakref
from dataclasses import fields
from pathlib import Path

import numpy as np
import numpy.typing as npt

from saras import ConfigError, ModelError
from saras.model.stiffness_map import SurfaceEstimates

Array = npt.NDArray[np.float64]

FIELDS = (*(field.name for field in fields(SurfaceEstimates)), "known")
"""Of the struct estimates, in the order in which they are sent."""

# Request: c, n, then for points and each of FIELDS its columns (1 or 3) and c * n * columns values in Octave's order.
# Answer: 0, how many, costs; or 1, how many, the letters of what went wrong. The first answer says: ready.
_WORKER = """
requests = fopen (getenv ("SARAS_COST_REQUESTS"), "r");
answers = fopen (getenv ("SARAS_COST_ANSWERS"), "w");
names = strsplit (getenv ("SARAS_COST_FIELDS"), ",");
failed = "";
try
  addpath (getenv ("SARAS_COST_FOLDER"));
  cost = str2func (getenv ("SARAS_COST_FUNCTION"));
  if (exist (getenv ("SARAS_COST_FUNCTION")) == 0)
    error ("is not found");
  end
catch raised
  failed = raised.message;
end
fwrite (answers, [! isempty(failed), numel(failed), double(failed)], "double");
fflush (answers);
while (isempty (failed))
  shape = fread (requests, 2, "double");
  if (numel (shape) < 2)
    break
  end
  values = cell (1, numel (names) + 1);
  for i = 1:numel (values)
    columns = fread (requests, 1, "double");
    values{i} = reshape (fread (requests, prod (shape) * columns, "double"), shape(1), shape(2), columns);
  end
  estimates = cell2struct (values(2:end), names, 2);
  estimates.known = logical (estimates.known);
  try
    costs = cost (estimates, values{1});
    if (! isnumeric (costs) && ! islogical (costs) || ! isreal (costs))
      error (["gave a " class(costs) ", not real numbers"]);
    end
    answer = [0, numel(costs), double(costs(:))'];
  catch raised
    answer = [1, numel(raised.message), double(raised.message)];
  end
  fwrite (answers, answer, "double");
  fflush (answers);
end
"""


class OctaveError(ModelError):
    """The Octave function raised, was too slow, or its process has ended."""


class OctaveCost:
    """A cost for TrajectoryOptimizer: (estimates, points (c, n, 3) [m]) -> (c,).

    path: file my_cost.m, which defines the function my_cost. time_limit_s: for one call; keep it below that of the
    optimizer. One that is slower is ended and not called again. start_limit_s: for Octave to start. octave: the
    program; octave-cli or octave by default. Raises ConfigError: no such file, no Octave; OctaveError: it does not
    start.
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        *,
        time_limit_s: float = 0.5,
        start_limit_s: float = 30.0,
        octave: str | None = None,
    ) -> None:
        for name, value in (("time_limit_s", time_limit_s), ("start_limit_s", start_limit_s)):
            if not (np.isfinite(value) and value > 0.0):
                raise ConfigError(f"{name} = {value}: must be finite and > 0")
        file = Path(path).resolve()
        if file.suffix != ".m" or not re.fullmatch(r"[A-Za-z]\w*", file.stem, re.ASCII) or not file.is_file():
            raise ConfigError(f"cost = {os.fspath(path)!r}: must be a file NAME.m that defines the function NAME")
        program = shutil.which(octave) if octave else shutil.which("octave-cli") or shutil.which("octave")
        if program is None:
            raise ConfigError(f"cost = {os.fspath(path)!r}: needs {octave or 'Octave'}; Debian: apt install octave")
        self.__name__ = file.name
        self._limit_s = time_limit_s
        self._ended: str | None = None
        self._one_call = threading.Lock()
        self._start(program, file)
        try:
            self._answer(time.monotonic() + start_limit_s, f"did not start within start_limit_s = {start_limit_s:g} s")
        except OctaveError:
            self.close()
            raise

    def __call__(self, estimates: SurfaceEstimates, points: npt.ArrayLike) -> Array:
        """The costs (c,). Raises OctaveError saying what the function said."""
        paths = np.asarray(points, dtype=float)
        rows, count = paths.shape[:2]
        request: list[Array] = [np.array([rows, count], dtype=float)]
        for values in (paths, *(np.asarray(getattr(estimates, name), dtype=float) for name in FIELDS)):
            shaped = values.reshape(rows, count, -1)
            request += [np.array([shaped.shape[2]], dtype=float), shaped.ravel(order="F")]
        with self._one_call:
            if self._ended is not None:
                raise OctaveError(f"{self.__name__}: {self._ended}, and is not called again")
            until = time.monotonic() + self._limit_s
            slow = f"gave no answer within time_limit_s = {self._limit_s:g} s"
            self._send(np.concatenate(request).tobytes(), until, slow)
            return self._answer(until, slow)

    def close(self) -> None:
        """Ends the Octave process; also done when this object goes."""
        self._ended = self._ended or "was closed"
        self._process.kill()  # a call that is under way sees the pipe's end, before its pipes are closed
        with self._one_call:
            self._finalizer()

    def __enter__(self) -> OctaveCost:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _start(self, program: str, file: Path) -> None:
        theirs, self._requests = os.pipe()
        self._answers, answers = os.pipe()
        environment = {
            **os.environ,
            "SARAS_COST_REQUESTS": f"/dev/fd/{theirs}",
            "SARAS_COST_ANSWERS": f"/dev/fd/{answers}",
            "SARAS_COST_FIELDS": ",".join(FIELDS),
            "SARAS_COST_FOLDER": str(file.parent),
            "SARAS_COST_FUNCTION": file.stem,
        }
        try:
            self._process = subprocess.Popen(
                [program, "--norc", "--quiet", "--no-history", "--eval", _WORKER],
                stdin=subprocess.DEVNULL,
                pass_fds=(theirs, answers),
                env=environment,
                start_new_session=True,  # Ctrl-C is for us: we end it
            )
        except OSError:
            os.close(self._requests)
            os.close(self._answers)
            raise
        finally:
            os.close(theirs)
            os.close(answers)
        os.set_blocking(self._requests, False)
        self._finalizer = weakref.finalize(self, _end, self._process, self._requests, self._answers)

    def _send(self, request: bytes, until: float, slow: str) -> None:
        rest = memoryview(request)
        while rest:
            self._wait(self._requests, selectors.EVENT_WRITE, until, slow)
            try:
                rest = rest[os.write(self._requests, rest) :]
            except BrokenPipeError:
                raise self._end("its Octave process has ended") from None

    def _answer(self, until: float, slow: str) -> Array:
        failed, count = np.frombuffer(self._read(16, until, slow))
        values = np.frombuffer(self._read(8 * int(count), until, slow)).copy()
        if failed:
            raise OctaveError(f"{self.__name__}: {''.join(chr(int(letter)) for letter in values)}")
        return values

    def _read(self, size: int, until: float, slow: str) -> bytes:
        got = bytearray()
        while len(got) < size:
            self._wait(self._answers, selectors.EVENT_READ, until, slow)
            part = os.read(self._answers, size - len(got))
            if not part:
                raise self._end("its Octave process has ended")
            got += part
        return bytes(got)

    def _wait(self, pipe: int, event: int, until: float, slow: str) -> None:
        with selectors.DefaultSelector() as selector:
            selector.register(pipe, event)
            if not selector.select(max(0.0, until - time.monotonic())):
                raise self._end(slow)

    def _end(self, why: str) -> OctaveError:
        self._ended = why
        self._finalizer()
        return OctaveError(f"{self.__name__}: {why}")


def _end(process: subprocess.Popen[bytes], requests: int, answers: int) -> None:
    process.kill()
    process.wait()
    os.close(requests)
    os.close(answers)


__all__ = ["FIELDS", "OctaveCost", "OctaveError"]
