#!/usr/bin/env python3
"""No program or library of ours looks for libraries in the current folder, in one that is named from
there, or in one that others may write: RPATH and RUNPATH of every ELF file below the given folders.

    check_runpath.py FOLDER...
"""
import os
import re
import stat
import subprocess
import sys
from pathlib import Path


def is_elf(file):
    if file.is_symlink() or not file.is_file():
        return False
    with open(file, "rb") as opened:
        return opened.read(4) == b"\x7fELF"


def elements(file):
    said = subprocess.run(["readelf", "-d", file], capture_output=True, text=True, check=False).stdout
    return [part for path in re.findall(r"\((?:RPATH|RUNPATH)\).*\[(.*)\]", said)
            for part in path.split(":")]


def wrong(element, file):
    """Why an element may not stand there; None where it may."""
    if element.startswith("$ORIGIN"):
        element = str(file.parent) + element[len("$ORIGIN"):]
    if not element:
        return "an empty element, which is the current folder"
    if not element.startswith("/"):
        return f"'{element}', which depends on the current folder"
    place = Path(os.path.normpath(element))
    while not place.exists():  # whoever may make it may fill it
        place = place.parent
    for folder in (place, *place.parents):
        mode = folder.stat().st_mode
        mine = folder.stat().st_gid in (os.getgid(), 0)  # a group of one's own, or root's
        writable = mode & stat.S_IWOTH or (mode & stat.S_IWGRP and not mine)
        if writable and not mode & stat.S_ISVTX:
            return f"'{element}', where others than its owner may write"
    return None


def faults(folders):
    """Each as a sentence, and how many files were looked at."""
    found, count = [], 0
    for folder in folders:
        for file in sorted(Path(folder).rglob("*")):
            if not is_elf(file):
                continue
            count += 1
            found += [f"{file.name} looks in {why}" for e in elements(file) if (why := wrong(e, file))]
    return found, count


if __name__ == "__main__":
    bad, looked_at = faults(sys.argv[1:])
    for sentence in bad:
        print(sentence)
    print(f"{looked_at} programs and libraries")
    sys.exit(1 if bad or looked_at == 0 else 0)
