"""Where pictures come from, as GStreamer writes it."""

from __future__ import annotations

import re

from saras import ConfigError

SOURCES = ("decklink", "v4l2", "file", "images", "test", "pipeline")
_OPTIONS = re.compile(r"^[\w\s=.,/:+-]*$")


def source_text(
    kind: str, device: str = "", options: str = "", *, width: int = 0, height: int = 0, rate_hz: float = 0.0
) -> str:
    """The pipeline up to raw pictures, for Grabber. Raises ConfigError naming what is wrong.

    kind, and what device is: decklink: the card's input, 0, 1, …; v4l2: /dev/video0; file: a video's path; images: a
    path with %05d for the number; test: a pattern of videotestsrc (ball, smpte …); pipeline: GStreamer's own words, up
    to video/x-raw. options: properties of the source element, as "mode=1080p25 connection=sdi".
    width, height, rate_hz: what the pictures are brought to; 0: as they come. The rate of images must be given.
    """
    if kind not in SOURCES:
        raise ConfigError(f"source = {kind!r}: must be one of {', '.join(SOURCES)}")
    if not _OPTIONS.match(options):
        raise ConfigError(f"options = {options!r}: must be NAME=VALUE pairs")
    if kind == "pipeline":
        if not device.strip():
            raise ConfigError("device = '': must be a pipeline")
        head = device
    else:
        head = f"{_head(kind, device, rate_hz)} {options}".rstrip() + _DECODERS.get(kind, "")
    if bool(width) != bool(height):
        raise ConfigError(f"width = {width}, height = {height}: must both be given, or both be 0")
    caps = []
    if width:
        head += " ! videoscale"
        caps += [f"width={width}", f"height={height}"]
    if rate_hz and kind != "images":
        head += " ! videorate"
        caps += [f"framerate={round(1000 * rate_hz)}/1000"]
    return head + (" ! video/x-raw," + ",".join(caps) if caps else "")


_DECODERS = {"file": " ! decodebin", "images": " ! decodebin", "v4l2": " ! decodebin"}


def _head(kind: str, device: str, rate_hz: float) -> str:
    if '"' in device or "\n" in device or (kind != "test" and not device):
        raise ConfigError(f"device = {device!r}: must name what {kind} reads")
    if kind == "decklink":
        if not device.isdigit():
            raise ConfigError(f"device = {device!r}: must be the number of the card's input")
        return f"decklinkvideosrc device-number={device}"
    if kind == "v4l2":
        return f'v4l2src device="{device}"'
    if kind == "file":
        return f'filesrc location="{device}"'
    if kind == "images":
        if not rate_hz > 0.0:
            raise ConfigError("rate_hz = 0: must be given for images")
        if "%" not in device:
            raise ConfigError(f"device = {device!r}: must hold %05d or the like for the picture's number")
        kind_of = {"png": "image/png", "jpg": "image/jpeg", "jpeg": "image/jpeg"}.get(device.rsplit(".", 1)[-1].lower())
        if kind_of is None:
            raise ConfigError(f"device = {device!r}: must end in .png or .jpg")
        return f'multifilesrc location="{device}" caps="{kind_of},framerate={round(1000 * rate_hz)}/1000"'
    pattern = device or "ball"
    if not re.fullmatch(r"[\w-]+", pattern):
        raise ConfigError(f"device = {device!r}: must be a pattern of videotestsrc")
    return f"videotestsrc is-live=true pattern={pattern}"


__all__ = ["SOURCES", "source_text"]
