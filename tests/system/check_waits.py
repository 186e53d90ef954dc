#!/usr/bin/env python3
"""No test waits for a time: it waits for a condition, or moves a clock of its own. Counts the literal
waits in the tests, each of which must say why on its line or the one before.

    check_waits.py SOURCE       ends with 1 where there are more than MOST, or one gives no reason
    check_waits.py --self-test  plants what it looks for
"""
import re
import sys
import tempfile
from pathlib import Path

MOST = 10
WAIT = re.compile(r"\b(?:q(?:Wait|Sleep)|sleep_for|sleep_until|usleep|msleep|nanosleep|time\.sleep)\s*\("
                  r"|QVERIFY2?\(!\s*\w+\.wait\(\d|\bsleep \d")
REASON = re.compile(r"(//|#|\"\"\").*\w")
SUFFIXES = {".cpp", ".h", ".c", ".py", ".sh"}
# What stands for a device, a disk or a machine, and keeps the time of that.
CLOCKS = {
    "conformance/hd_bench.cpp", "conformance/hd_library.cpp", "conformance/openhaptics_device.cpp",
    "conformance/pedal_device.cpp", "conformance/pedal_hid.cpp", "conformance/with_wooden_arms.cpp",
    "conformance/wooden_bench.cpp", "conformance/wooden_firmware.cpp",
    "conformance/woodenhaptics_device.cpp", "headset/runtime/runtime_state.cpp",
    "slow_machine/slow_machine.c", "slow_source/slow_source.cpp",
}


def waits(tests):
    """Each literal wait as (file, line number, its text, whether it says why)."""
    found = []
    for file in sorted(tests.rglob("*")):
        name = file.relative_to(tests).as_posix()
        if file.suffix not in SUFFIXES or name in CLOCKS or name == "system/check_waits.py":
            continue
        if name.startswith("bench/"):  # timings, run by hand
            continue
        before = ""
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            code = re.sub(r"^\s*(//|#).*", "", line)
            if WAIT.search(code):
                why = REASON.search(line) or re.match(r"\s*(//|#|\"\"\")", before)
                found.append((name, number, line.strip(), bool(why)))
            before = line
    return found


def check(source, say=print):
    tests = Path(source) / "tests"
    gone = [name for name in CLOCKS if not (tests / name).exists()]
    found = waits(tests)
    for name, number, text, why in found:
        say(f"{name}:{number}: {text}{'' if why else '   <- says no reason'}")
    say(f"{len(found)} literal waits, at most {MOST}")
    for name in gone:
        say(f"{name} is not there any more: take it off the list")
    return len(found) <= MOST and all(why for *_, why in found) and not gone


def self_test():
    with tempfile.TemporaryDirectory() as folder:
        tests = Path(folder) / "tests"
        for name in CLOCKS:
            (tests / name).parent.mkdir(parents=True, exist_ok=True)
            (tests / name).write_text("sleep_for(1ms);\n")
        quiet = {"say": lambda *_: None}
        assert check(folder, **quiet), "emulated devices keep their own time"
        one = tests / "one.cpp"
        for line in ("QTest::qWait(50);", "std::this_thread::sleep_for(5ms);", "time.sleep(1)",
                     "QVERIFY(!spy.wait(500));", '"sleep 3 && true"', "::usleep (3);"):
            one.write_text(f"{line}\n")
            assert not check(folder, **quiet), line
            one.write_text(f"{line}  // the clock's own\n")
            assert check(folder, **quiet), line
        one.write_text("// sleep_for(1ms) is not used\nspy.wait(500);\nQTest::qWaitFor(x);\n")
        assert check(folder, **quiet)
        one.write_text("QTest::qWait(50);  // a reason\n" * (MOST + 1))
        assert not check(folder, **quiet), "too many"
        one.unlink()
        (tests / sorted(CLOCKS)[0]).unlink()
        assert not check(folder, **quiet), "a file that is gone"
    print("finds what it looks for")
    return True


if __name__ == "__main__":
    sys.exit(0 if (self_test() if sys.argv[1] == "--self-test" else check(sys.argv[1])) else 1)
