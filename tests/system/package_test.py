"""The packages of this build: what is in them, what they need, and that a build makes the same file
each time. On a bare system they are tried by tests/package."""

import gzip
import hashlib
import json
import os
import re
import shutil
import subprocess
import tarfile
import tempfile
import unittest
from pathlib import Path

from check_runpath import faults
from lab_support import LAB, SOURCE, WINDOW, main

BUILD = Path(LAB).parents[1]
MEASURE = Path(LAB).with_name("trephine-measure")


def output(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True,
                          text=True, **options).stdout


def packed(kind, folder, *options):
    output("cpack", "-G", kind, "--config", BUILD / "CPackConfig.cmake", "-B", folder, *options,
           cwd=folder)
    return next(Path(folder).glob("trephine_*.deb" if kind == "DEB" else "*.tar.gz"))


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        for name in ("a", "b", "tar", "root", "researcher"):
            (cls.folder / name).mkdir()
        os.environ.pop("SOURCE_DATE_EPOCH", None)
        cls.deb = packed("DEB", cls.folder / "a")
        output("dpkg-deb", "-x", cls.deb, cls.folder / "root")
        cls.root = cls.folder / "root"
        cls.researcher = next((cls.folder / "a").glob("trephine-researcher_*.deb"))
        output("dpkg-deb", "-x", cls.researcher, cls.folder / "researcher")
        print(f"{cls.deb.name}: {cls.deb.stat().st_size / 1e6:.1f} MB")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_holds_what_an_administrator_and_a_desktop_look_for(self):
        names = {str(path.relative_to(self.root)) for path in self.root.rglob("*")}
        for name in ("usr/bin/trephine", "usr/bin/trephine-lab",
                     "usr/share/applications/trephine.desktop",
                     "usr/share/metainfo/org.trephine.Trephine.metainfo.xml",
                     "usr/share/icons/hicolor/scalable/apps/trephine.svg",
                     "usr/share/mime/packages/trephine.xml",
                     "usr/lib/udev/rules.d/60-trephine-devices.rules",
                     "usr/share/man/man1/trephine.1.gz", "usr/share/man/man1/trephine-lab.1.gz",
                     "etc/trephine", "etc/security/limits.d/60-trephine.conf",
                     "usr/share/trephine/scenes/cranium.json",
                     "usr/share/doc/trephine/copyright"):
            self.assertIn(name, names)
        plugins = {path.name for path in (self.root / "usr/lib/trephine/plugins").iterdir()}
        self.assertEqual(plugins, {f"trephine_{name}.so" for name in
                                   ("openhaptics", "pedal", "simulated", "woodenhaptics")})
        cases = {path.name for path in (self.root / "usr/lib/trephine/cases").iterdir()}
        self.assertEqual(cases, {"cranium.case", "abdomen.case"})
        self.assertFalse([name for name in names if "openxr_test" in name or name.endswith(".py")])
        first = {name.split("/")[0] for name in names}
        self.assertEqual(first, {"usr", "etc"})

    def test_needs_what_runs_it_and_nothing_to_build_with(self):
        depends = output("dpkg-deb", "-f", self.deb, "Depends")
        self.assertIn("libvtk9", depends)
        self.assertIn("qt6-qpa-plugins", depends)
        self.assertNotIn("-dev", depends)
        self.assertIn("xvfb", output("dpkg-deb", "-f", self.deb, "Recommends"))

    def test_leaves_what_researchers_measure_with_to_a_package_of_its_own(self):
        def files(root):
            return {str(path.relative_to(root)) for path in root.rglob("*") if path.is_file()}
        own = files(self.folder / "researcher")
        self.assertEqual(own, {"usr/bin/trephine-measure",
                               "usr/share/man/man1/trephine-measure.1.gz",
                               "usr/share/lintian/overrides/trephine-researcher",
                               "usr/share/doc/trephine-researcher/changelog.gz",
                               "usr/share/doc/trephine-researcher/copyright"})
        self.assertEqual(own & files(self.root), set())
        depends = output("dpkg-deb", "-f", self.researcher, "Depends")
        version = output("dpkg-deb", "-f", self.deb, "Version").strip()
        self.assertIn(f"trephine (= {version})", depends)
        self.assertNotIn("trephine-researcher", output("dpkg-deb", "-f", self.deb, "Depends"))
        for control in ("postinst", "postrm", "conffiles"):
            self.assertNotIn(control, output("dpkg-deb", "-I", self.researcher))
        for program in ("trephine", "trephine-lab"):  # none of its code
            self.assertNotIn(b"full upload %.2f ms", (self.root / "usr/bin" / program).read_bytes())
        self.assertIn(b"full upload %.2f ms",
                      (self.folder / "researcher/usr/bin/trephine-measure").read_bytes())

    def test_looks_for_libraries_nowhere_but_where_the_system_does(self):
        found, count = faults([self.root, self.folder / "researcher"])
        self.assertEqual(found, [])
        self.assertGreaterEqual(count, 7)

    def test_tells_nobody_where_it_was_built(self):
        for path in [*self.root.rglob("*"), *(self.folder / "researcher").rglob("*")]:
            if path.is_file():
                data = path.read_bytes()
                if path.suffix == ".gz":
                    data = gzip.decompress(data)
                self.assertNotIn(str(SOURCE).encode(), data, path)

    def test_is_the_same_file_each_time(self):
        again = packed("DEB", self.folder / "b")
        for first, second in ((self.deb, again), (self.researcher,
                                                  again.with_name(self.researcher.name))):
            digest = [hashlib.sha256(file.read_bytes()).hexdigest() for file in (first, second)]
            self.assertEqual(digest[0], digest[1])

    def test_satisfies_those_who_look_at_packages(self):
        for tool in ("lintian", "appstreamcli", "desktop-file-validate"):
            if not shutil.which(tool):
                self.skipTest(f"{tool} is not installed")
        said = subprocess.run(["lintian", "--no-tag-display-limit", "--allow-root", str(self.deb),
                               str(self.researcher)],
                              capture_output=True, text=True).stdout
        errors = [line for line in said.splitlines() if line.startswith("E:")]
        self.assertEqual(errors, [], said)
        share = self.root / "usr/share"
        output("appstreamcli", "validate", "--no-net",
               share / "metainfo/org.trephine.Trephine.metainfo.xml")
        output("desktop-file-validate", share / "applications/trephine.desktop")

    def test_its_bill_of_materials_names_what_it_runs_on_with_licences(self):
        bill = json.loads(output(SOURCE / "packaging" / "bill_of_materials.py", self.deb))
        self.assertEqual(bill["spdxVersion"], "SPDX-2.3")
        packages = {package["name"]: package for package in bill["packages"]}
        self.assertEqual(packages["trephine"]["licenseDeclared"], "BSD-3-Clause")
        for library in ("libvtk9.1", "libqt6widgets6", "libdcmtk17", "libhdf5-103-1", "libc6"):
            self.assertTrue(packages[library]["versionInfo"], library)
            self.assertTrue(packages[library]["licenseComments"], library)
        self.assertGreater(len(bill["files"]), 50)

    def test_its_manual_names_every_command_and_option(self):
        pages = {name: gzip.decompress((root / f"usr/share/man/man1/{name}.1.gz").read_bytes())
                 .decode().replace("\\-", "-")
                 for name, root in (("trephine", self.root), ("trephine-lab", self.root),
                                    ("trephine-measure", self.folder / "researcher"))}
        options = re.findall(r"--[a-z]+", output(WINDOW, "--help"))
        self.assertIn("--exercise", options)
        for option in options:
            self.assertIn(option, pages["trephine"])

        def commands(program, *words):
            text = output(program, *words, "--help")
            listed = text.split("Subcommands:")[1] if "Subcommands:" in text else ""
            return re.findall(r"^  ([a-z]+)  ", listed, re.MULTILINE)
        named = commands(LAB)
        self.assertIn("import", named)
        for command in named:
            inner = [] if command == "measure" else commands(LAB, command)
            for name in [f"{command} {each}" for each in inner] or [command]:
                self.assertRegex(pages["trephine-lab"], rf'(?m)(^\.B {name}$|"{name}")')
        measurements = commands(MEASURE)
        self.assertIn("stability", measurements)
        for name in measurements:
            self.assertRegex(pages["trephine-measure"], rf"(?m)^\.B {name}$")

    def test_runs_from_any_folder(self):
        archive = packed("TGZ", self.folder / "tar")
        with tarfile.open(archive) as tar:
            tar.extractall(self.folder / "tar" / "elsewhere with a blank")
        program = next((self.folder / "tar").glob("elsewhere*/*/bin/trephine-lab"))
        scene = program.parents[1] / "share/trephine/scenes/cranium.json"
        environment = {key: value for key, value in os.environ.items()
                       if key not in ("DISPLAY", "TREPHINE_RESOURCES", "TREPHINE_PLUGINS")}
        said = output(program, "run", scene, "--seconds", "0.5", "--out", self.folder / "out",
                      env=environment)
        self.assertIn("in tissue", said)


if __name__ == "__main__":
    main()
