#!/usr/bin/env python3
"""Prints where a robot is, as roundeld broadcasts it.

    follow.py ID [SECONDS]

Needs the types, which are plain Python: the package python3-roundel, or
lcm-gen --python --ppath . transport/lcm/*.lcm beside this file. With the LCM module for Python
(pip install lcm) the socket below is three lines; Debian 12 has no package of it, and for messages
that roundeld sends (always one datagram each) a socket will do.
"""
import socket
import struct
import sys
import time

from roundel import frame_t

GROUP, PORT, CHANNEL = "239.255.76.67", 7667, b"ROUNDEL_FRAME"


def messages(seconds):
    """The messages of the channel, as bytes, for so long."""
    link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    link.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    link.bind(("", PORT))
    link.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                    struct.pack("4s4s", socket.inet_aton(GROUP), socket.inet_aton("0.0.0.0")))
    link.settimeout(0.5)
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        try:
            datagram = link.recv(65536)
        except socket.timeout:
            print("nothing comes: is roundeld running?", flush=True)
            continue
        # "LC02", a number, the channel, a zero, the message.
        channel, zero, message = datagram[8:].partition(b"\0")
        if datagram[:4] == b"LC02" and zero and channel == CHANNEL:
            yield message


def main():
    robot = int(sys.argv[1])
    seconds = float(sys.argv[2]) if len(sys.argv) > 2 else float("inf")
    for message in messages(seconds):
        frame = frame_t.decode(message)
        for marker in frame.markers:
            if marker.id != robot:
                continue
            if marker.has_arena:
                print(f"arena: x {marker.arena_x:.4f} m, y {marker.arena_y:.4f} m, "
                      f"heading {marker.arena_heading:.3f} rad", flush=True)
            elif marker.has_pose:
                x, y, z = marker.position
                print(f"camera: x {x:.4f} m, y {y:.4f} m, z {z:.4f} m", flush=True)


if __name__ == "__main__":
    main()
