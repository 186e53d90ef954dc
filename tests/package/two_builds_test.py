"""Two builds of one source in two folders make the same packages, to the byte. Some minutes each.

    two_builds_test.py SOURCE_FOLDER WORK_FOLDER
"""
import hashlib
import os
import shutil
import subprocess
import sys
import time
import unittest
from pathlib import Path

SOURCE, WORK = (Path(argument).resolve() for argument in sys.argv[1:3])
PLACES = ("a", "another place/deeper/b")  # of other lengths, and with a space


def run(*command, cwd=None):
    # What a compiler's cache kept from one would be no second build.
    environment = {**os.environ, "CCACHE_DISABLE": "1"}
    environment.pop("SOURCE_DATE_EPOCH", None)
    done = subprocess.run([str(word) for word in command], cwd=cwd, env=environment,
                          capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}: {done.returncode}\n"
                             f"{done.stdout[-3000:]}\n{done.stderr[-2000:]}")
    return done.stdout


def packages(place):
    tree = WORK / place
    shutil.rmtree(tree, ignore_errors=True)
    for name in run("git", "-C", SOURCE, "ls-files", "-z").split("\0"):
        if name and (SOURCE / name).is_file():
            (tree / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(SOURCE / name, tree / name)
    begun = time.monotonic()
    run("cmake", "-S", tree, "-B", tree / "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
        "-DCMAKE_UNITY_BUILD=ON", "-DTREPHINE_TESTS=OFF")
    run("cmake", "--build", tree / "build")
    for kind in ("DEB", "TGZ"):
        run("cpack", "-G", kind, cwd=tree / "build")
    made = {file.name: hashlib.sha256(file.read_bytes()).hexdigest()
            for kind in ("*.deb", "*.tar.gz") for file in (tree / "build").glob(kind)}
    print(f"{place}: built and packed in {time.monotonic() - begun:.0f} s, {made}", flush=True)
    shutil.rmtree(tree)
    return made


class TwoBuilds(unittest.TestCase):
    def test_make_the_same_packages(self):
        first, second = map(packages, PLACES)
        self.assertEqual(len(first), 3)
        self.assertEqual(first, second)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
