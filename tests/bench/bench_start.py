#!/usr/bin/env python3
"""How long the program takes from its start until the window is usable: the start page painted, its
cards there, the event loop idle. The program says it itself, in its log. Needs a screen.
   bench_start.py PROGRAM [STARTS]      five starts, after one that warms the caches"""
import re
import statistics
import subprocess
import sys
import tempfile
import os

BAR_MS = 1500


def start(program, home):
    environment = dict(os.environ, HOME=home, XDG_CONFIG_HOME=home, XDG_DATA_HOME=home)
    with subprocess.Popen([program], stderr=subprocess.PIPE, text=True, env=environment) as process:
        try:
            for line in process.stderr:
                if found := re.search(r"usable, (\d+) ms", line):
                    return int(found.group(1))
        finally:
            process.terminate()
            process.stderr.close()
    raise SystemExit("the program did not say that its window is usable")


def main():
    program, starts = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 5
    with tempfile.TemporaryDirectory() as home:
        first = start(program, home)
        warm = [start(program, home) for _ in range(starts)]
    median = statistics.median(warm)
    print(f"first {first} ms, then {', '.join(map(str, warm))} ms: median {median:.0f} ms "
          f"(bar {BAR_MS} ms: {'met' if median <= BAR_MS else 'missed'})")
    return 0 if median <= BAR_MS else 1


if __name__ == "__main__":
    sys.exit(main())
