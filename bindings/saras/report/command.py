"""``saras report BAG``: writes the session report."""

from __future__ import annotations

import argparse
from pathlib import Path

from saras.report import write_report


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Of ``saras report``."""
    parser.description = "Writes a self-contained HTML report of a recorded session."
    parser.add_argument("bag", type=Path, help="the recording")
    parser.add_argument("--out", type=Path, help="the HTML file; default: beside the bag")


def run(arguments: argparse.Namespace) -> int:
    """Exit code 0 when the report was written, whatever it says."""
    out: Path = arguments.out or arguments.bag.with_suffix(".html")
    found = write_report(arguments.bag, out)
    for verdict in found.verdicts:
        print(f"{verdict.grade:>8}  {verdict.title}: {verdict.value} ({verdict.detail})")
    print(out)
    return 0
