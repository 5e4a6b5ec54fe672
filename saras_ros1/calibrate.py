"""The guided calibration with the arms and the endoscope of a running platform.

    rosrun saras_ros1 calibrate

The same prompts as `saras calibrate simulation`. Reads config/calibration.yaml (--config) and asks the node `frames` to
load what was saved.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import rospy
import yaml
from rich.console import Console

from saras import ConfigError, Error
from saras.calibration.calibrate_command import add_guide_arguments
from saras.calibration.guided import Guide, QuitError, save
from saras_ros1.calibration_room import CalibrationRoom
from saras_ros1.params import Params
from saras_ros1.srv import LoadCalibration

CONFIG = Path(__file__).resolve().parents[1] / "config"
SECTION = "global_frame_registration"


def parse(argv: list[str] | None = None) -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="rosrun saras_ros1 calibrate", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--config", type=Path, default=CONFIG / "calibration.yaml", help="board, arms, topics")
    parser.add_argument("--scene", type=Path, default=CONFIG / "scene.yaml", help="where the bases are expected")
    add_guide_arguments(parser)
    return parser.parse_args(rospy.myargv(argv)[1:] if argv is None else argv)


def run(arguments: argparse.Namespace, console: Console) -> int:
    """Exit code: 0 saved, 1 ended without saving."""
    if arguments.out.exists() and not arguments.force:  # before half an hour of work, not after it
        raise ConfigError(f"{arguments.out}: exists; --force writes over it")
    document = yaml.safe_load(arguments.config.read_text(encoding="utf-8"))
    params = Params((document or {}).get(SECTION), str(arguments.config))
    room = CalibrationRoom(params, str(arguments.scene))
    params.finish()
    try:
        wanted = {"rounds": arguments.rounds, "known_to_m": 1e-3 * arguments.known_to_mm}
        calibration = Guide(room, room.endoscope, console, **wanted).run()
    except (QuitError, EOFError):
        console.print("ended; nothing was saved", style="yellow")
        return 1
    frames = [arm.frame for arm in room.arms.values()]
    save(calibration, arguments.out, arguments.force, console, frames)
    try:
        answer = rospy.ServiceProxy("/frames/load_calibration", LoadCalibration)(str(arguments.out.resolve()))
        console.print(f"frames: {answer.message}")
    except rospy.ServiceException:
        console.print("the node frames does not run: it takes the file at the start", style="yellow")
    return 0


def main() -> int:
    """Exit code; 2 for refused input."""
    arguments, console = parse(), Console()
    rospy.init_node("calibrate", anonymous=True)
    try:
        return run(arguments, console)
    except (Error, OSError) as error:
        console.print(str(error), style="red")
        return 2
