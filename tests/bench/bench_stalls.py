#!/usr/bin/env python3
"""The longest stall of the window's event loop in each test of the window, against its bar. Runs
the tests of the window one after the other; the machine must have nothing else to do.
   bench_stalls.py BUILD [REGEX]      of the names of the tests; all of the window's without one"""
import pathlib
import re
import subprocess
import sys

BAR_MS = 100
LINE = re.compile(r"^(STALL|busy|) *(\d+) ms (.*)$")


def main():
    build = pathlib.Path(sys.argv[1])
    tests = sys.argv[2] if len(sys.argv) > 2 else "_gui|window_size|screens"
    artefacts = build / "artefacts"
    for old in artefacts.glob("stalls-*.txt"):
        old.unlink()
    ran = subprocess.run(["ctest", "--test-dir", build, "-R", tests, "--no-tests=error"], check=False)
    worst = []
    for file in sorted(artefacts.glob("stalls-*.txt")):
        for line in file.read_text().splitlines():
            found = LINE.match(line)
            worst.append((int(found.group(2)), found.group(1), file.stem[7:], found.group(3)))
    judged = [row for row in worst if row[1] != "busy"]
    if not judged:
        sys.exit("no test left its stalls")
    for ms, mark, program, rest in sorted(worst, reverse=True)[:25]:
        print(f"{mark:5} {ms:4} ms  {program}: {rest}")
    beyond = [row for row in judged if row[0] > BAR_MS]
    print(f"{len(worst)} tests of {len(list(artefacts.glob('stalls-*.txt')))} programs: longest "
          f"{max(judged)[0]} ms, {len(beyond)} over the bar of {BAR_MS} ms; not judged, as other "
          f"programs were at work: {sum(row[1] == 'busy' for row in worst)} tests")
    return 1 if beyond or ran.returncode else 0


if __name__ == "__main__":
    sys.exit(main())
