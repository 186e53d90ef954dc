"""Displays on which nothing can be drawn: what the programs say there, and that no arm moves."""

import contextlib
import ctypes
import json
import os
import shutil
import subprocess
import sys
import time
import unittest
from pathlib import Path

from lab_support import SCENES, WINDOW, LabTest, lab, main, wait_until

LIMIT_S = 30
# Where a context cannot be made, where only an old one can, and where Qt would draw elsewhere.
NO_OPENGL = [
    {"LIBGL_DRIVERS_PATH": "/nonexistent"},
    {"LIBGL_ALWAYS_INDIRECT": "1"},
    {"LIBGL_ALWAYS_INDIRECT": "1", "QT_QPA_PLATFORM": "offscreen"},
    {"GALLIUM_DRIVER": "nonsense"},
] + [{"MESA_GL_VERSION_OVERRIDE": version} for version in ("2.0", "2.1", "3.0", "3.1")]
USABLE = [{}, {"MESA_GL_VERSION_OVERRIDE": "3.2"}, {"QT_XCB_GL_INTEGRATION": "none"},
          {"QT_QPA_PLATFORM": "wayland"}]


@contextlib.contextmanager
def x_server(*options):
    """An X server of the test's own; its environment."""
    read, write = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24", "-nolisten", "tcp",
         *options], pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    try:
        with os.fdopen(read) as number:
            display = number.readline().strip()
        environment = {key: value for key, value in os.environ.items()
                       if not key.startswith(("QT_", "LIBGL_", "MESA_", "XAUTHORITY"))}
        yield {**environment, "DISPLAY": ":" + display}
    finally:
        server.terminate()
        server.wait()


class ClientMessage(ctypes.Structure):
    """XEvent, as far as XClientMessageEvent fills it."""
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
                ("display", ctypes.c_void_p), ("window", ctypes.c_ulong),
                ("message_type", ctypes.c_ulong), ("format", ctypes.c_int),
                ("data", ctypes.c_long * 5), ("rest", ctypes.c_long * 24)]


class Desk:
    """What a person sees of windows, and closes."""

    def __init__(self, display):
        self.x = ctypes.CDLL("libX11.so.6")
        for name in ("XOpenDisplay", "XInternAtom", "XDefaultRootWindow"):
            getattr(self.x, name).restype = ctypes.c_void_p
        self.on_error = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)(
            lambda *_: 0)  # windows come and go
        self.x.XSetErrorHandler(self.on_error)
        self.display = ctypes.c_void_p(self.x.XOpenDisplay(display.encode()))

    def windows(self):
        root, parent = ctypes.c_ulong(), ctypes.c_ulong()
        children, count = ctypes.POINTER(ctypes.c_ulong)(), ctypes.c_uint()
        self.x.XQueryTree(self.display, ctypes.c_ulong(self.x.XDefaultRootWindow(self.display)),
                          ctypes.byref(root), ctypes.byref(parent), ctypes.byref(children),
                          ctypes.byref(count))
        for child in children[:count.value]:
            name, numbers = ctypes.c_char_p(), [ctypes.c_int() for _ in range(6)]
            self.x.XGetGeometry(self.display, ctypes.c_ulong(child), ctypes.byref(root),
                                *map(ctypes.byref, numbers))
            hidden = numbers[2].value < 10  # a toolkit's own
            if not hidden and self.x.XFetchName(self.display, ctypes.c_ulong(child),
                                                ctypes.byref(name)):
                yield child, name.value.decode()

    def close(self, window):
        atom = [self.x.XInternAtom(self.display, name, 0)
                for name in (b"WM_PROTOCOLS", b"WM_DELETE_WINDOW")]
        event = ClientMessage(type=33, window=window, message_type=atom[0], format=32)
        event.data[0] = atom[1]
        self.x.XSendEvent(self.display, ctypes.c_ulong(window), 0, ctypes.c_long(0),
                          ctypes.byref(event))
        self.x.XFlush(self.display)


def waits(program):
    """Whether its main thread computes no more."""
    stat = Path(f"/proc/{program.pid}/stat").read_text()
    return stat.rsplit(") ", 1)[1].startswith("S")


class NothingToDrawOn(LabTest):
    def setUp(self):
        super().setUp()
        self.scene = self.small_scene()

    def small_scene(self):
        """The shipped one-arm scene on a ball of bone, which opens at once."""
        edge, spacing = 60, 1.5
        middle = (edge - 1) / 2
        reach = [(i - middle) ** 2 * spacing ** 2 for i in range(edge)]
        bone, air = (1200).to_bytes(2, "little"), (-1000).to_bytes(2, "little", signed=True)
        (self.folder / "ball.mha").write_bytes(
            f"ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
            f"DimSize = {edge} {edge} {edge}\nElementSpacing = {spacing} {spacing} {spacing}\n"
            f"Offset = -44.25 -44.25 -44.25\nElementType = MET_SHORT\n"
            f"ElementDataFile = LOCAL\n".encode() +
            b"".join(bone if x + y + z < 1600 else air
                     for z in reach for y in reach for x in reach))
        text = (SCENES / "cranium-one-arm.json").read_text()
        scene = json.loads(text.replace('"../', f'"{SCENES.parent}/'))
        scene["case"] = str(self.folder / "ball.mha")
        file = self.folder / "scene.json"
        file.write_text(json.dumps(scene))
        return file

    def exercise(self, environment):
        """The answer to --exercise, its exit code, and whether an arm's plugin was opened."""
        out, trace = self.folder / "out", self.folder / "trace"
        shutil.rmtree(out, ignore_errors=True)
        done = subprocess.run(
            [WINDOW, "--exercise", self.scene, "--seconds", "0.3", "--out", out, "--json"],
            capture_output=True, text=True, timeout=600,
            env={**environment, "LD_DEBUG": "files", "LD_DEBUG_OUTPUT": str(trace)})
        traces = list(self.folder.glob("trace.*"))
        armed = any("trephine_simulated" in file.read_text(errors="replace") for file in traces)
        for file in traces:
            file.unlink()
        self.assertTrue(done.stdout, f"{done.returncode}: {done.stderr[-500:]}")
        return json.loads(done.stdout), done.returncode, armed

    def assert_refused(self, environment, code):
        started = time.monotonic()
        answer, returncode, armed = self.exercise(environment)
        self.assertLess(time.monotonic() - started, LIMIT_S)
        self.assert_error(answer, code)
        self.assertEqual(returncode, 1)
        self.assertFalse(armed, "an arm was started")
        self.assertFalse((self.folder / "out").exists())

    def assert_runs_without_a_picture(self, environment):
        run = lab("run", self.scene, "--seconds", 0.1, "--out", self.folder / "run",
                  environment=environment)
        self.assertIsNone(run["picture"])
        self.assertGreater(run["ticks"], 0)

    def test_an_exercise_says_no_opengl_and_starts_no_arm(self):
        with x_server() as display:
            for variant in NO_OPENGL:
                with self.subTest(variant):
                    self.assert_refused({**display, **variant}, "NO_OPENGL")
        with x_server("-extension", "GLX") as display:
            self.assert_refused(display, "NO_OPENGL")

    def test_an_exercise_without_a_display_says_so(self):
        with x_server() as display:
            pass
        self.assert_refused(display, "NO_DISPLAY")  # nobody listens there any more
        del display["DISPLAY"]
        self.assert_refused(display, "NO_DISPLAY")

    def test_where_opengl_is_good_an_exercise_runs_whatever_qt_was_asked_for(self):
        with x_server() as display:
            for variant in USABLE:
                with self.subTest(variant):
                    answer, returncode, armed = self.exercise({**display, **variant})
                    self.assertEqual(returncode, 0, answer)
                    self.assertTrue(armed)
                    self.assertGreater(answer["frames"], 0)
                    self.assertTrue(Path(answer["picture"]).exists())

    def test_the_window_says_it_in_a_dialog_and_ends_with_an_error(self):
        with x_server() as display:
            desk = Desk(display["DISPLAY"])
            for variant in ({"LIBGL_ALWAYS_INDIRECT": "1"}, {"MESA_GL_VERSION_OVERRIDE": "2.0"}):
                with self.subTest(variant), subprocess.Popen(
                        [WINDOW], env={**display, **variant}, text=True,
                        stderr=subprocess.PIPE) as program, contextlib.ExitStack() as ending:
                    ending.callback(program.kill)
                    def dialogs():
                        self.assertIsNone(program.poll(), "it waits until it has been read")
                        return [window for window, name in desk.windows() if name == "Trephine"]

                    seen = wait_until(dialogs, "there is a dialog", LIMIT_S)
                    self.assertEqual(len(seen), 1)
                    wait_until(lambda: waits(program), "it waits until it has been read", LIMIT_S)
                    self.assertIsNone(program.poll())
                    desk.close(seen[0])
                    self.assertEqual(program.wait(LIMIT_S), 1)
                    self.assertIn("OpenGL", program.stderr.read())

    def test_the_laboratory_goes_on_without_a_picture(self):
        with x_server() as display:
            for variant in NO_OPENGL[:2] + NO_OPENGL[4:5]:
                with self.subTest(variant):
                    self.assert_runs_without_a_picture({**display, **variant})
            run = lab("run", self.scene, "--seconds", 0.1, "--out", self.folder / "run",
                      environment=display)
            self.assertTrue(Path(run["picture"]).exists())
        with x_server("-extension", "GLX") as display:
            self.assert_runs_without_a_picture(display)
        self.assert_runs_without_a_picture(display)  # no server any more


if __name__ == "__main__":
    if not shutil.which("Xvfb"):
        print("SKIP: there is no Xvfb to draw on")
        sys.exit(77)
    main()
