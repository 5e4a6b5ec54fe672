"""Pictures of a real endoscope through GStreamer: Blackmagic DeckLink, V4L2, image and video files, or any pipeline.

    grabber = Grabber("left eye", source_text("v4l2", "/dev/video0"), on_frame)
    grabber.start()                                       # on_frame(Frame) from the grabber's thread
    grabber.state                                         # "OK", or what is wrong; it tries again by itself

Needs GStreamer with its Python bindings: python3-gi gir1.2-gstreamer-1.0 gstreamer1.0-plugins-{base,good,bad}.
"""

from saras.capture.frames import Pairing, halves
from saras.capture.grabber import Frame, Grabber
from saras.capture.sources import SOURCES, source_text

__all__ = ["SOURCES", "Frame", "Grabber", "Pairing", "halves", "source_text"]
