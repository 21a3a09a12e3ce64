"""Usage: forbidden.py PORT: what a viewer on this port has to refuse. Exit code 1 when it accepts any of it."""
import re
import socket
import sys
import time

PORT = int(sys.argv[1])
OWN = f"127.0.0.1:{PORT}"
KEY = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA=="}
LIVE = KEY | {"Sec-WebSocket-Protocol": "voxlist.live.v1"}
FOXGLOVE = KEY | {"Sec-WebSocket-Protocol": "foxglove.sdk.v1"}
ORIGIN = {"Origin": f"http://{OWN}"}
JSON = {"Content-Type": "application/json"}


def connect():
    line = socket.create_connection(("127.0.0.1", PORT))
    line.settimeout(60)
    return line


def request(method, target, headers, body=b"", host=OWN):
    fields = [] if host is None else [("Host", host)]
    fields += headers if isinstance(headers, list) else list(headers.items())
    if method == "POST" and not any(name == "Content-Length" for name, _ in fields):
        fields.append(("Content-Length", str(len(body))))
    return "\r\n".join([f"{method} {target} HTTP/1.1"] + [f"{n}: {v}" for n, v in fields]).encode() + b"\r\n\r\n" + body


def status(said):
    found = re.match(rb"HTTP/1.1 (\d+)", said)
    return int(found[1]) if found else 0


def answer(*asked, **more):
    """The status that a request is answered with; 0: the line is closed without one."""
    with connect() as line:
        try:
            line.sendall(request(*asked, **more))
            return status(line.recv(4096))
        except ConnectionError:
            return 0


def open_stream():
    """A stream that is allowed, and what came on it so far."""
    for _ in range(200):  # those before may not have gone yet
        line = connect()
        line.sendall(request("GET", "/live", LIVE | ORIGIN))
        heard = line.recv(4096)
        if status(heard) != 503:
            break
        line.close()
        time.sleep(0.05)
    while b'"session"' not in heard:
        more = line.recv(4096)
        if not more:
            sys.exit(f"FAILED: a stream that is allowed: {heard[:80]!r}")
        heard += more
    return line, heard


def is_closed(line):
    """Whether the other side ends the line."""
    try:
        while line.recv(65536):
            pass
    except ConnectionError:
        pass
    except TimeoutError:
        return False
    return True


own_stream, heard = open_stream()
TOKEN = re.search(rb'"token":\s*"(\w+)"', heard)[1].decode()
WITH = {"X-Voxlist-Token": TOKEN}
SAVE = ("POST", "/command/save")
BOTH = list((JSON | ORIGIN).items())

FORBIDDEN = {
    "no host": ("GET", "/", {}, b"", None),
    "another host": ("GET", "/", {}, b"", f"evil.example:{PORT}"),
    "a name that begins as ours": ("GET", "/live", LIVE, b"", f"localhost.evil.example:{PORT}"),
    "another port": ("GET", "/", {}, b"", "127.0.0.1:80"),
    "another host's commands": (*SAVE, JSON | WITH | ORIGIN, b"{}", f"evil.example:{PORT}"),
    "two hosts": ("GET", "/", {"host": "evil.example"}),
    "PUT": ("PUT", "/", {}),
    "DELETE": ("DELETE", "/index.html", {}),
    "POST of a file": ("POST", "/", JSON | WITH | ORIGIN, b"{}"),
    "GET of a command": ("GET", "/command/save", JSON | WITH | ORIGIN),
    "OPTIONS of a command": ("OPTIONS", "/command/save", {"Origin": "http://evil.example", "Access-Control-Request-Method": "POST"}),
    "a stream of another origin": ("GET", "/live", LIVE | {"Origin": "http://evil.example"}),
    "a stream of no origin": ("GET", "/live", LIVE | {"Origin": "null"}),
    "a stream of another port": ("GET", "/live", LIVE | {"Origin": "http://127.0.0.1:80"}),
    "Foxglove's protocol of another origin": ("GET", "/", FOXGLOVE | {"Origin": "https://evil.example"}),
    "an unknown subprotocol": ("GET", "/live", KEY | {"Sec-WebSocket-Protocol": "voxlist.live.v9"}),
    "no subprotocol": ("GET", "/live", KEY),
    "an upgrade without a key": ("GET", "/live", [(n, v) for n, v in LIVE.items() if "Key" not in n]),
    "no token": (*SAVE, JSON | ORIGIN, b"{}"),
    "an empty token": (*SAVE, JSON | ORIGIN | {"X-Voxlist-Token": ""}, b"{}"),
    "a part of the token": (*SAVE, JSON | ORIGIN | {"X-Voxlist-Token": TOKEN[:-1]}, b"{}"),
    "the token in the address": ("POST", f"/command/save?token={TOKEN}", JSON | ORIGIN, b"{}"),
    "two tokens": (*SAVE, BOTH + list(WITH.items()) * 2, b"{}"),
    "a command of another origin": (*SAVE, JSON | WITH | {"Origin": "http://evil.example"}, b"{}"),
    "a command of no origin": (*SAVE, JSON | WITH, b"{}"),
    "a form": (*SAVE, ORIGIN | WITH | {"Content-Type": "text/plain"}, b"{}"),
    "a body of 70 kB": (*SAVE, JSON | ORIGIN | WITH, b" " * 70_000),
    "a body that is said to be endless": (*SAVE, JSON | ORIGIN | WITH | {"Content-Length": "9" * 15}, b"{}"),
    "a header of 10 kB": ("GET", "/", {"X": "x" * 10_000}),
    "a file elsewhere": ("GET", "/../etc/passwd", {}),
}

accepted = []
slow = connect()
slow.sendall(b"GET / HTTP/1.1\r\nHost: ")
for name, (method, target, headers, *rest) in FORBIDDEN.items():
    said = answer(method, target, headers, *rest)
    if said < 400 and said != 0:
        accepted.append(f"{name}: {said}")

frames = {
    "a frame of 70 kB": b"\x82\xff" + (70_000).to_bytes(8, "big") + bytes(4) + bytes(70_000),
    "a frame without a mask": b"\x81\x05space",
    "a frame of bits that mean nothing": b"\xf1\x80" + bytes(4),
}
for name, frame in frames.items():
    line, _ = open_stream()
    try:
        line.sendall(frame)
    except ConnectionError:
        pass
    if not is_closed(line):
        accepted.append(name)
    line.close()

others = [open_stream()[0] for _ in range(7)]
if answer("GET", "/live", LIVE | ORIGIN) != 503:
    accepted.append("a ninth client")
for line in others:
    line.close()
if not is_closed(slow):
    accepted.append("a handshake that does not end")

allowed = answer(*SAVE, JSON | ORIGIN | WITH, body=b"{}")
if allowed != 204:
    sys.exit(f"FAILED: the page's own command was answered with {allowed}")
print(f"ok: {len(FORBIDDEN) + len(frames) + 2} forbidden requests, {len(accepted)} accepted; the page's own is obeyed")
sys.exit("FAILED: accepted " + "; ".join(accepted) if accepted else 0)
