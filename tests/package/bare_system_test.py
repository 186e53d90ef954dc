"""The package on a bare Debian 12, made with debootstrap, without a network: an older build of ours is
installed from its offline bundle, used by an ordinary user, upgraded, and removed. As root.

    bare_system_test.py BUILD_FOLDER SOURCE_FOLDER WORK_FOLDER

Figures are printed as they are measured. WORK_FOLDER is kept between runs: its bare system is made
once and copied.
"""
import concurrent.futures
import contextlib
import hashlib
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import threading
import time
import unittest
import zlib
from pathlib import Path

BUILD, SOURCE, WORK = (Path(argument).resolve() for argument in sys.argv[1:4])
sys.path.insert(0, str(SOURCE / "tests/system"))
for name in ("TREPHINE", "TREPHINE_LAB", "TREPHINE_SOURCE"):  # programs that are not used here
    os.environ.setdefault(name, "")
from lab_support import wait_until  # noqa: E402

OLD_VERSION = "0.0.9"
USER = "trainee"
SCENE = "/usr/share/trephine/scenes/cranium.json"
ROOT = WORK / "system"


def run(*command, **options):
    options.setdefault("timeout", 900)
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}: {done.returncode}\n"
                             f"{done.stdout[-2000:]}\n{done.stderr[-2000:]}")
    return done.stdout


def size_mb(folder):
    return int(run("du", "-smx", folder).split()[0])


def packed(version, folder):
    """A package of the build, and its name."""
    folder.mkdir(parents=True, exist_ok=True)
    run("cpack", "-G", "DEB", "--config", BUILD / "CPackConfig.cmake", "-B", folder,
        "-D", f"CPACK_PACKAGE_VERSION={version}", cwd=folder)
    return next(folder.glob(f"trephine_{version}_*.deb"))


def bare_system():
    """A bare Debian 12 in a folder of its own: made once, copied for each run."""
    made = WORK / "bare"
    if not (made / "etc/debian_version").exists():
        mirror = run("apt-get", "indextargets", "--format", "$(SITE)",
                     "Codename: bookworm", "Component: main").split()[0]
        shutil.rmtree(made, ignore_errors=True)
        run("debootstrap", "--variant=minbase", "bookworm", made, mirror)
    # What an earlier run may have left mounted there is not this test's to take away.
    run("rm", "-rf", "--one-file-system", ROOT)
    run("cp", "-a", made, ROOT)


@contextlib.contextmanager
def mounted():
    for kind, where in (("proc", "proc"), ("tmpfs", "dev/shm")):
        (ROOT / where).mkdir(exist_ok=True)
        run("mount", "-t", kind, kind, ROOT / where)
    try:
        yield
    finally:
        for where in ("dev/shm", "proc"):
            run("umount", "-l", ROOT / where)


def inside(command, user=None, **options):
    """A shell's command in the bare system, which has no network but its own loopback."""
    words = ["unshare", "-n", "chroot", str(ROOT)]
    if user:
        words += ["su", "-", user, "-c"]
    else:
        words += ["sh", "-c"]
    return run(*words, "export LANG=C.UTF-8; " + command, **options)


def files_of_system():
    """All there is, but for what apt and dpkg keep for themselves and what users have."""
    kept = re.compile(r"^/(home|proc|dev|sys|tmp|run|opt/bundle|var/(lib/(dpkg|apt)|cache|log))(/|$)")
    names = run("find", ROOT, "-xdev", "-printf", "/%P\n").splitlines()
    return {name for name in names if not kept.match(name)}


def older_files(home):
    """What an older build of ours left in a user's storage: a case of version 1 as
    resources/schemas/case.md has it, the slab that an old recording was made on, and that recording.
    The files are written here, so that no program of today has had a hand in them."""
    storage = home / ".local/share/trephine"
    case = storage / "cases" / "old-slab"
    case.mkdir(parents=True)
    size, spacing = 24, 1.0
    voxels = b"".join(struct.pack("<h", 900 if index < size**3 // 2 else -1000)
                      for index in range(size**3))
    header = ("ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
              "CompressedData = False\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = -12 -12 -12\n"
              "CenterOfRotation = 0 0 0\nElementSpacing = 1 1 1\nDimSize = 24 24 24\n"
              "AnatomicalOrientation = RAI\nElementType = MET_SHORT\nElementDataFile = LOCAL\n")
    (case / "volume.mha").write_bytes(header.encode() + voxels)
    rows = b"".join(b"\0" + b"\x60\x60\x60" * 256 for _ in range(192))

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))
    (case / "picture.png").write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 256, 192, 8, 2, 0, 0, 0)) +
        chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
    (case / "case.json").write_text(json.dumps({
        "format": "trephine.case", "version": 1, "name": "Old slab",
        "imported": "2026-01-02T03:04:05", "region": "head", "size": [size] * 3,
        "spacing_mm": [spacing] * 3, "origin_mm": [-12.0] * 3,
        "direction": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
        "volume_sha256": hashlib.sha256(voxels).hexdigest(), "verdict": "", "structures": []}))
    recordings = storage / "sessions"
    recordings.mkdir()
    shutil.copy(SOURCE / "tests/system/data/version-8.h5", recordings / "session-old.h5")


class Listeners(threading.Thread):
    """Looks, ten times a second, for whoever waits for a connection in the bare system."""

    def __init__(self):
        super().__init__(daemon=True)
        self.found, self.looks, self.done = set(), 0, threading.Event()

    def run(self):
        while not self.done.wait(0.1):
            for pid in Path("/proc").glob("[0-9]*"):
                try:
                    if Path(os.readlink(pid / "root")) != ROOT:
                        continue
                    name = (pid / "comm").read_text().strip()
                    self.looks += 1
                    for table in ("tcp", "tcp6"):
                        for row in (pid / "net" / table).read_text().splitlines()[1:]:
                            if row.split()[3] == "0A":
                                self.found.add((name, table, row.split()[1]))
                    for table in ("udp", "udp6", "raw", "raw6"):
                        for row in (pid / "net" / table).read_text().splitlines()[1:]:
                            self.found.add((name, table, row.split()[1]))
                except OSError:
                    continue


def picture_of(framebuffer):
    """Rows of pixels of an X server's framebuffer file (XWD): width, height, distinct colours."""
    data = framebuffer.read_bytes()
    words = struct.unpack(">25I", data[:100])
    header_size, width, height, line, colours = words[0], words[4], words[5], words[12], words[19]
    begin = header_size + 12 * colours
    rows = [data[begin + y * line:begin + y * line + 4 * width] for y in range(height)]
    distinct = {row[x:x + 3] for row in rows[::4] for x in range(0, len(row), 16)}
    return width, height, len(distinct)


class BareSystem(unittest.TestCase):
    """One walk, in the order of an administrator's and a user's day."""

    def test_install_use_upgrade_and_remove(self):
        version = re.search(r"project\(Trephine VERSION ([\d.]+)",
                            (SOURCE / "CMakeLists.txt").read_text())[1]
        old, new = packed(OLD_VERSION, WORK / "old"), packed(version, WORK / "new")
        bundle = WORK / "bundle"
        shutil.rmtree(bundle, ignore_errors=True)
        run(SOURCE / "packaging/bundle", old, bundle)
        print(f"package {new.stat().st_size / 1e6:.1f} MB, bundle {size_mb(bundle)} MB", flush=True)
        bare_system()
        shutil.copytree(bundle, ROOT / "opt/bundle")
        shutil.copy(new, ROOT / "opt/bundle" / new.name)
        before_mb = size_mb(ROOT) - size_mb(bundle)
        with mounted():
            listeners = Listeners()
            listeners.start()
            self.install(before_mb, bundle)
            with_old = files_of_system()
            self.use()
            self.upgrade(new, version)
            self.remove(with_old)
            listeners.done.set()
            listeners.join()
            self.assertGreater(listeners.looks, 50)
            self.assertEqual(listeners.found, set())
            print(f"listeners 0 in {listeners.looks} looks")

    def install(self, before_mb, bundle):
        begun = time.monotonic()
        inside("/opt/bundle/install")
        self.begun = begun
        print(f"install without a network {time.monotonic() - begun:.1f} s, "
              f"on disk {size_mb(ROOT) - size_mb(bundle) - before_mb} MB", flush=True)
        names = inside("dpkg-query -W -f '${Package}\\n'").split()
        self.assertEqual([name for name in names if name.endswith("-dev")], [])
        inside(f"useradd -m -s /bin/sh -G trephine {USER}")
        groups = inside("getent group trephine trephine-teach")
        self.assertIn(f"trephine:x:", groups)
        self.assertIn("trephine-teach:x:", groups)

    def use(self):
        self.assertIn(" ", inside("trephine --version", USER))
        self.assertIn(" ", inside("trephine-lab --version", USER))
        inside(f"trephine-lab run {SCENE} --seconds 2 --out headless --json > headless.json", USER)
        headless = json.loads((ROOT / f"home/{USER}/headless.json").read_text())
        self.assertGreater(sum(arm["removed_mm3"] for arm in headless["arms"]), 0.0)
        inside("xvfb-run -a -s '-screen 0 1280x800x24 -nolisten tcp' "
               f"trephine --exercise {SCENE} --seconds 6 --out window --json > window.json", USER)
        window = json.loads((ROOT / f"home/{USER}/window.json").read_text())
        self.assertGreater(sum(arm["removed_mm3"] for arm in window["arms"]), 0.0)
        print(f"install to first cut {time.monotonic() - self.begun:.1f} s, as an ordinary user",
              flush=True)
        self.screenshot()
        older_files(ROOT / f"home/{USER}")
        inside(f"chown -R {USER}: ~{USER}")

    def screenshot(self):
        """The window, as a person starts it: usable, and a picture of it on the screen."""
        home = ROOT / f"home/{USER}"
        log, shown, end = home / "window.log", home / "fb/Xvfb_screen0", home / "end"
        with concurrent.futures.ThreadPoolExecutor() as pool:
            used = pool.submit(
                inside, "mkdir -p fb; mkfifo ready end; "
                "Xvfb -displayfd 3 -screen 0 1280x800x24 -fbdir fb -nolisten tcp 3>ready >/dev/null "
                f"2>&1 & X=$!; read display <ready; DISPLAY=:$display trephine {SCENE} "
                ">window.log 2>&1 & T=$!; read end <end; kill $T || echo gone; wait $T; kill $X",
                USER)
            try:
                usable = wait_until(lambda: log.exists() and
                                    re.search(r"usable, (\d+) ms", log.read_text()),
                                    "the window is usable")
                print(f"window usable {usable[1]} ms after its start", flush=True)
                wait_until(lambda: picture_of(shown)[2] > 200, "a window with a case in it")
                self.assertEqual(picture_of(shown)[:2], (1280, 800))
            finally:  # it waits for a line
                gate = os.open(end, os.O_WRONLY | os.O_NONBLOCK)
                os.write(gate, b"\n")
                os.close(gate)
            self.assertEqual(used.result(), "", "it is still there")

    def upgrade(self, new, version):
        installed = "dpkg-query -W -f '${Version}' trephine"
        self.assertEqual(inside(installed), OLD_VERSION)
        begun = time.monotonic()
        inside(f"dpkg -i /opt/bundle/{new.name}")
        self.assertEqual(inside(installed), version)
        print(f"upgrade {time.monotonic() - begun:.1f} s", flush=True)
        replayed = inside("trephine-lab replay "
                          "~/.local/share/trephine/sessions/session-old.h5 --json", USER)
        self.assertTrue(json.loads(replayed)["identical"])
        cases = json.loads(inside("trephine-lab storage list --open --json", USER))["cases"]
        self.assertEqual([(case["id"], case["problem"]) for case in cases], [("old-slab", None)])

    def remove(self, with_package):
        user_files = set(run("find", ROOT / f"home/{USER}", "-type", "f").splitlines())
        package = set(inside("dpkg -L trephine").split())
        inside("apt-get -q -y purge trephine")
        left = files_of_system()
        own = {name for name in package & left if not (ROOT / name[1:]).is_dir()}
        own |= {name for name in left if "trephine" in name}
        self.assertEqual(own, set(), "of the package")
        self.assertEqual(left - with_package, set(), "what it made while it ran")
        self.assertEqual(set(run("find", ROOT / f"home/{USER}", "-type", "f").splitlines()), user_files)
        print("removed: nothing of it is left but what users have")


if __name__ == "__main__":
    if os.geteuid() != 0 or not shutil.which("debootstrap"):
        print("skipped: this needs root and debootstrap")
        sys.exit(77)
    WORK.mkdir(parents=True, exist_ok=True)
    unittest.main(argv=sys.argv[:1])
