"""saras csa shell: a Python prompt whose arrays follow the topics of /csa, to look and try while somebody palpates."""

from __future__ import annotations

import argparse
import code
import importlib
import time

import numpy as np

from saras import ConfigError
from saras.csa.live_arrays import LiveArrays

BANNER = (
    "Arrays that follow /csa/...: show() lists them, ages() says how old they are.\n"
    "Each message binds a name anew; x = tip keeps what it is now. np is numpy."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Of the action shell."""
    parser.add_argument("--once", action="store_true", help="print names, shapes and newest values, and end")
    parser.add_argument("--wait", type=float, default=3.0, metavar="S", help="with --once: gather so long, 0.1 to 600")
    parser.add_argument("--samples", type=int, default=60_000, metavar="N", help="newest touches that are kept")
    parser.add_argument("--namespace", default="/csa", help="of the topics")


def run(arguments: argparse.Namespace) -> int:
    """Exit code, 1: nothing came. Raises ConfigError: no ROS, no ROS master, bad numbers."""
    if not 0.1 <= arguments.wait <= 600.0:
        raise ConfigError(f"--wait = {arguments.wait}: must be in [0.1, 600] s")
    live = LiveArrays(arguments.samples)
    try:
        topics = importlib.import_module("saras_ros1.csa_topics")
    except ModuleNotFoundError as missing:
        raise ConfigError(
            f"shell needs ROS 1 and this package's messages ({missing.name} is missing): . devel/setup.bash"
        ) from None
    topics.follow(live, arguments.namespace)
    if arguments.once:
        time.sleep(arguments.wait)
        print(live.table())
        if not live.any_came:
            print(f"nothing came within {arguments.wait:g} s on {arguments.namespace}/...")
        return 0 if live.any_came else 1
    live.names["np"] = np
    prompt(live)
    return 0


def prompt(live: LiveArrays) -> None:
    """IPython where it is installed, else Python's own; returns when it is left."""
    try:
        ipython = importlib.import_module("IPython")
    except ModuleNotFoundError:
        code.interact(banner=BANNER, local=live.names, exitmsg="")
        return
    print(BANNER)
    ipython.start_ipython(argv=["--no-banner"], user_ns=live.names)


__all__ = ["add_arguments", "prompt", "run"]
