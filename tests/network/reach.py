"""Which of the TCP ports of a host answer: reach.py ADDRESS PORT…; prints a JSON list."""

import json
import socket
import sys

reached = []
for port in map(int, sys.argv[2:]):
    with socket.socket() as one:
        one.settimeout(2.0)
        if one.connect_ex((sys.argv[1], port)) == 0:
            reached.append(port)
print(json.dumps(reached))
