"""Reads golden_messages' lines from standard input: Python decodes each message and encodes the same bytes."""
import importlib
import inspect
import pathlib
import sys

import voxlist

folder = pathlib.Path(sys.argv[1])
in_files = {file.stem.removeprefix("voxlist_") for file in folder.glob("*/*.lcm")}
in_package = {name for name, value in vars(voxlist).items() if inspect.isclass(value)}
assert in_package == in_files, f"types of the package and of {folder}: {in_package ^ in_files}"
for name in in_files:
    assert getattr(importlib.import_module(f"voxlist.{name}"), name) is getattr(voxlist, name)

seen = set()
for line in sys.stdin:
    name, text = line.split()
    data = bytes.fromhex(text)
    again = getattr(voxlist, name).decode(data).encode()
    assert again == data, f"{name}\nread  {data.hex()}\nwrote {again.hex()}"
    seen.add(name)
assert seen == in_files, f"no message of {in_files - seen}"
print(f"{len(seen)} types")
