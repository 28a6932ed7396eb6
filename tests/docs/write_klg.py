"""Writes a log in the format of Logger2: three frames of a wall, uncompressed. Usage: write_klg.py FILE.klg"""
import struct
import sys

PIXELS = 640 * 480

with open(sys.argv[1], "wb") as log:
    log.write(struct.pack("<i", 3))
    for frame in range(3):
        log.write(struct.pack("<qii", 33333 * frame, 2 * PIXELS, 3 * PIXELS))
        log.write(struct.pack("<H", 1500) * PIXELS + bytes((120, 110, 100)) * PIXELS)
