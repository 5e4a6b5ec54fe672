"""Sound and videos through GStreamer: a microphone, and the files that stand beside a bag. Import what is needed.

    saras.capture.sound          Microphone, SoundFile, times_ns
    saras.capture.video_file     VideoFile, read_index

Needs GStreamer with its Python bindings: python3-gi gir1.2-gstreamer-1.0 gstreamer1.0-plugins-{base,good,bad}.
Pictures of a real endoscope come from the C++ nodelet endoscope_capture (docs/endoscope.md).
"""
