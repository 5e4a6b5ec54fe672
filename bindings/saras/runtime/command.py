"""saras replay-flight: runs the pipeline again on a flight record of the real-time host, and compares to the bit."""

from __future__ import annotations

import argparse
from pathlib import Path

from saras.runtime import read_flight, replay_flight
from saras.runtime.report import write_report


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Of ``saras replay-flight``."""
    parser.description = "Steps the pipeline through a flight record and compares outputs and states to the bit."
    parser.add_argument("record", type=Path, help="a .flight file, written by the real-time host")
    parser.add_argument(
        "--report", type=Path, metavar="DIR", help="also write flight.html there: the last minute drawn"
    )


def run(arguments: argparse.Namespace) -> int:
    """Exit code 0 when every output and every state is equal to the bit."""
    record = read_flight(str(arguments.record))
    replay = replay_flight(record)
    exact = replay.exact == replay.ticks and replay.states_exact == replay.states
    print(f"written because  {record.reason or 'unknown'}")
    print(f"outputs          {replay.exact} of {replay.ticks} steps equal to the bit")
    print(f"states           {replay.states_exact} of {replay.states} equal to the bit")
    if replay.first_difference >= 0:
        print(f"first difference at step {replay.first_difference}")
    if arguments.report is not None:
        print(f"report           {write_report(arguments.report, arguments.record.name, record, replay)}")
    return 0 if exact else 1
