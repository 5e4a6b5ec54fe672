"""A host that answers questions for the time: ntp_server.py ADDRESS [PORT]. With clock_shim its clock is wrong."""

import socket
import sys
import time

from saras import ProtocolError
from saras.net import ntp

with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as server:
    server.bind((sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else ntp.PORT))
    print("answers", flush=True)
    while True:
        question, asker = server.recvfrom(512)
        heard_ns = time.time_ns()
        try:
            server.sendto(ntp.answer(question, heard_ns, time.time_ns()), asker)
        except ProtocolError as error:
            print(error, flush=True)
