"""Reads LCM event logs, the files of lcm-logger, without the LCM library.

    import voxlist
    from voxlist.event_log import read_events

    for event in read_events("robot.lcm"):
        if event.channel == "POSE":
            print(voxlist.pose_t.decode(event.data).pos)
"""
import struct
from typing import Iterator, NamedTuple

# Before each event, big-endian: sync word, number, time, length of the channel's name, length of the message.
_HEADER = struct.Struct(">IqqII")
_SYNC = 0xEDA1DA01


class Event(NamedTuple):
    """One recorded message."""

    # Counts up in the file.
    number: int
    # When it was recorded, microseconds of the wall clock.
    utime: int
    channel: str
    # For the type's decode().
    data: bytes


def read_events(path) -> Iterator[Event]:
    """Yields the whole events of a log in their order; one that is cut off, as by a crash of the logger, is the end.

    Raises OSError when the file cannot be read, ValueError with the position where it is no event log.
    """
    with open(path, "rb") as log:
        while True:
            position = log.tell()
            header = log.read(_HEADER.size)
            if len(header) < _HEADER.size:
                return
            sync, number, utime, channel_bytes, data_bytes = _HEADER.unpack(header)
            if sync != _SYNC:
                raise ValueError(f"{path}: no event at byte {position}: damaged, or no LCM event log")
            channel, data = log.read(channel_bytes), log.read(data_bytes)
            if len(channel) + len(data) < channel_bytes + data_bytes:
                return
            yield Event(number, utime, channel.decode("utf-8", "replace"), data)
