#!/usr/bin/env python3
"""What the live page is told, a line each: TOPIC AGE_MS JSON.

Usage: page_topics.py PORT SECONDS
"""
import base64
import json
import os
import socket
import struct
import sys
import time


def exactly(line, count):
    data = b""
    while len(data) < count:
        more = line.recv(count - len(data))
        if not more:
            raise EOFError
        data += more
    return data


def connect(port):
    line = socket.create_connection(("127.0.0.1", port), timeout=10)
    key = base64.b64encode(os.urandom(16)).decode()
    line.sendall(
        (
            f"GET /live HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: voxlist.live.v1\r\n\r\n"
        ).encode()
    )
    answer = b""
    while not answer.endswith(b"\r\n\r\n"):
        answer += exactly(line, 1)
    if b" 101 " not in answer.split(b"\r\n")[0]:
        sys.exit(answer.decode())
    return line


def messages(line):
    """Whole binary messages; the server sends no masks."""
    parts = b""
    while True:
        first, second = exactly(line, 2)
        length = second & 127
        if length == 126:
            (length,) = struct.unpack(">H", exactly(line, 2))
        elif length == 127:
            (length,) = struct.unpack(">Q", exactly(line, 8))
        data = exactly(line, length)
        if first & 15 in (8, 9, 10):
            continue
        parts += data
        if first & 128:
            yield parts
            parts = b""


def main():
    end = time.monotonic() + float(sys.argv[2])
    line = connect(int(sys.argv[1]))
    line.settimeout(1.0)
    try:
        for message in messages(line):
            (length,) = struct.unpack("<I", message[:4])
            told = json.loads(message[4 : 4 + length])
            print(told["topic"], told["age_ms"], json.dumps(told["data"]))
            if time.monotonic() > end:
                return
    except (TimeoutError, socket.timeout):
        pass


main()
