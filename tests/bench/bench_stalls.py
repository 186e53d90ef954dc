#!/usr/bin/env python3
"""The longest stall of the window's event loop in each test of the window, against its bar. Runs
the tests of the window one after the other; the machine must have nothing else to do. Which stalls
are beyond the bar the tests say themselves (system/gui/stalls.h).
   bench_stalls.py BUILD [REGEX]      of the names of the tests; all of the window's without one"""
import pathlib
import re
import subprocess
import sys

LINE = re.compile(r"^(STALL|busy|) *(\d+) ms (.*)$")


def main():
    build = pathlib.Path(sys.argv[1])
    tests = sys.argv[2] if len(sys.argv) > 2 else "_gui|window_size|screens"
    artefacts = build / "artefacts"
    for old in artefacts.glob("stalls-*.txt"):
        old.unlink()
    ran = subprocess.run(["ctest", "--test-dir", build, "-R", tests, "-LE", "slow",
                          "--no-tests=error"], check=False)
    rows = []
    for file in artefacts.glob("stalls-*.txt"):
        program = file.stem.removeprefix("stalls-")
        for line in file.read_text().splitlines():
            mark, ms, rest = LINE.match(line).groups()
            rows.append((int(ms), mark, f"{program}: {rest}"))
    if not rows:
        sys.exit("no test left its stalls")
    rows.sort(reverse=True)
    for ms, mark, rest in rows[:25]:
        print(f"{mark:5} {ms:4} ms  {rest}")
    beyond = sum(mark == "STALL" for _, mark, _ in rows)
    busy = sum(mark == "busy" for _, mark, _ in rows)
    longest = max((ms for ms, mark, _ in rows if mark != "busy"), default=0)
    print(f"{len(rows)} tests: longest {longest} ms, {beyond} over the bar; not judged, as other "
          f"programs were at work: {busy}")
    return 1 if beyond or ran.returncode else 0


if __name__ == "__main__":
    sys.exit(main())
