"""Keys of an authenticated Touchball link: the same file at the console and at the platform.

saras keys make FILE     draws new keys; FILE must not exist, its owner alone may read it
saras keys check FILE    checks file and access, and shows a fingerprint to compare both ends' files by
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from saras.net import keys


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds make and check."""
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    for action, summary in (("make", "draw new keys into a new file"), ("check", "check a file, show its fingerprint")):
        actions.add_parser(action, help=summary).add_argument("file", type=Path, metavar="FILE")


def run(arguments: argparse.Namespace) -> int:
    """Exit code; refused input is a saras.Error."""
    path: Path = arguments.file
    if arguments.action == "make":
        keys.save(path, keys.draw())
    print(f"{path}: fingerprint {keys.load(path).fingerprint()}")
    if os.name == "nt":
        print("  Windows: who may read the file is not checked here; keep it in your own user directory")
    if arguments.action == "make":
        print("  copy it to the other end over a safe way (scp -p, a stick), then compare fingerprints there:")
        print("  saras keys check FILE; then saras console --key FILE and key_file of touchball_receiver")
    return 0
