"""The command ``saras``: a table of subcommands, each imported only when it runs.

A subcommand is a module with ``add_arguments(parser)`` and ``run(arguments) -> int`` (the exit code). To add one,
add a line to ``COMMANDS``. A library that only one command needs is thus only missed, and then named, by that command.
"""

from __future__ import annotations

import argparse
import importlib
import signal
import sys
from collections.abc import Sequence
from types import ModuleType

import saras

#: name: (module, one line for --help)
COMMANDS: dict[str, tuple[str, str]] = {
    "bag": ("saras.recording.command", "look into a recording, check its completeness, mend it, report on it"),
    "board": ("saras.calibration.board_command", "make the calibration board: PDF, SVG, YAML"),
    "calibrate": ("saras.calibration.calibrate_command", "calibrate arms, endoscope and cameras, step by step"),
    "console": ("saras.console.command", "read the two handles, guard their ports, talk to the platform over UDP"),
    "csa": ("saras.csa.command", "situational awareness: check a system file, simulate it, live arrays of what runs"),
    "dataset": ("saras.dataset.command", "make aligned tables for learning from recordings"),
    "endoscope": ("saras.sim.endoscope.command", "draw what the simulated stereo endoscope sees"),
    "keys": ("saras.net.command", "make and check the key file of a console's link over a network"),
    "regions": ("saras.collision.command", "make forbidden regions from a bone's mesh, or check a file of them"),
    "replay": ("saras.replay", "run the laws again on recorded inputs and compare"),
    "replay-flight": ("saras.runtime.command", "run a flight record of the real-time host again, and draw it"),
    "report": ("saras.report.command", "write the HTML report of a recorded session"),
    "udp-proxy": ("saras.sim.udp_proxy_command", "an impaired network between a console and the platform"),
}

#: import name of an optional library: what to install
OPTIONAL_LIBRARIES = {
    "matplotlib": "saras[plot]",
    "rosbags": "saras[recording]",
    "trimesh": "saras[regions]",
    "scipy": "saras[regions]",
    "pyarrow": "saras[dataset]",
    "dask": "saras[dataset]",
    "distributed": "saras[dataset]",
    "yaml": "saras[regions]",
    "cv2": "saras[calibration]",
    "jsonschema": "saras[csa]",
    "vtkmodules": "saras[endoscope]",
    "rich": "saras[console]",
    "pygame": "saras[console]",
    "pyOpenHaptics": "saras[haptics]",
}


def main(argv: Sequence[str] | None = None) -> int:
    """Runs one subcommand; returns its exit code. 2: wrong arguments or refused input."""
    argv = sys.argv[1:] if argv is None else list(argv)
    parser = argparse.ArgumentParser(
        prog="saras",
        description="Bilateral surgical teleoperation.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    width = max(map(len, COMMANDS))
    lines = [f"  {name:<{width}}  {summary}" for name, (_, summary) in sorted(COMMANDS.items())]
    parser.epilog = "commands:\n" + "\n".join(lines) + "\n\n'saras COMMAND --help' tells more."
    parser.add_argument("--version", action="version", version=f"saras {saras.__version__}")
    parser.add_argument("command", choices=sorted(COMMANDS), metavar="COMMAND")
    arguments = parser.parse_args(argv[:1])
    return _run(arguments.command, argv[1:])


def _run(name: str, argv: Sequence[str]) -> int:
    try:
        module = importlib.import_module(COMMANDS[name][0])
        return _call(module, name, argv)
    except ModuleNotFoundError as missing:
        library = (missing.name or "").split(".")[0]
        if library not in OPTIONAL_LIBRARIES:
            raise
        print(
            f"saras {name}: needs {library}; install it with: pip install '{OPTIONAL_LIBRARIES[library]}'",
            file=sys.stderr,
        )
    except (saras.Error, OSError) as error:
        print(f"saras {name}: {error}", file=sys.stderr)
    except KeyboardInterrupt:
        return 128 + signal.SIGINT
    return 2


def _call(module: ModuleType, name: str, argv: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(
        prog=f"saras {name}", description=module.__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    module.add_arguments(parser)
    return int(module.run(parser.parse_args(argv)))


if __name__ == "__main__":
    sys.exit(main())
