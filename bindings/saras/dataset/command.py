"""Recorded sessions as aligned tables: Parquet files with a data card.

saras dataset a.bag b.bag --out set                      rows are video frames, else 25 a second
saras dataset *.bag --out set --rate-hz 50 --workers 2
saras dataset *.bag --out set --scheduler tcp://host:8786          on a dask cluster that sees the same paths
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from saras.dataset.export import export
from saras.dataset.table import Options


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Of ``saras dataset``."""
    usual = Options()
    parser.add_argument("bag", type=Path, nargs="+", metavar="BAG")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="made by the command; must be empty")
    rows = parser.add_mutually_exclusive_group()
    rows.add_argument("--rate-hz", type=float, metavar="R", help="rows of a fixed rate instead of video frames")
    rows.add_argument("--frames", metavar="TOPIC", help="a row a message of this topic")
    rows.add_argument("--frame-index", metavar="CSV", help="a row a frame of a video file: stamp_ns or stamp_s, frame")
    parser.add_argument("--calibration", type=Path, nargs="+", default=[], metavar="FILE", help="checked and copied")
    parser.add_argument(
        "--gap-periods",
        type=float,
        default=usual.gap_periods,
        metavar="K",
        help="no value across a gap of more than K periods of its topic (default %(default)s)",
    )
    parser.add_argument("--videos", action="store_true", help="copy videos and sound beside the bags too")
    parser.add_argument("--phase", choices=("time", "path"), default="time", help="of the nominal trajectories")
    parser.add_argument("--workers", type=int, metavar="N", help="processes (default: as many as bags and processors)")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a dask cluster, instead of processes here")


def run(arguments: argparse.Namespace) -> int:
    """Exit code 0 when the data set was written. Refused input is a saras.Error."""
    options = Options(
        rate_hz=arguments.rate_hz,
        frames=arguments.frames,
        frame_index=arguments.frame_index,
        gap_periods=arguments.gap_periods,
    )
    workers = arguments.workers
    if workers is None:
        workers = min(len(arguments.bag), len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else 1)
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    shape = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*shape, console=Console(stderr=True), transient=True, disable=not sys.stderr.isatty()) as bars:
        task = bars.add_task("sessions", total=len(arguments.bag))
        card = export(
            arguments.bag,
            arguments.out,
            options,
            arguments.calibration,
            workers,
            arguments.scheduler,
            arguments.phase,
            arguments.videos,
            lambda name: bars.update(task, advance=1, description=name),
        )
    for session in card["sessions"]:
        print(f"{session['file']}: {session['rows']} rows ({session['row']}), {session['duration_s']:.1f} s")
        for note in session["notes"]:
            print(f"  {note}")
    print(arguments.out / "README.md")
    return 0
