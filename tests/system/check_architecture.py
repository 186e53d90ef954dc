"""Holds every #include against the rooms' arrows, every call of std::filesystem against exceptions,
and every text file against machine paths.

usage: check_architecture.py SOURCE_DIR ROOMS_JSON [--self-test]

ROOMS_JSON is written by trephine_room() at configure time. --self-test plants violations, one at a
time, in a copy of the tree and demands that each is found.
"""

import copy
import json
import pathlib
import re
import shutil
import sys
import tempfile

# The arrows of the rooms. A room may declare fewer.
ROOMS = {
    "base": set(),
    "volume": {"base"},
    "tissue": {"base"},
    "imaging": {"base", "volume"},
    "library": {"base", "volume", "tissue", "imaging", "exercise", "case"},
    "device": {"base"},
    "haptics": {"base", "volume", "tissue", "device"},
    "exercise": {"base", "volume", "tissue", "haptics"},
    "case": {"base", "volume", "tissue", "imaging", "exercise"},
    "training": {"base", "volume", "tissue", "device", "haptics", "exercise"},
    "session": {"base", "volume", "tissue", "imaging", "device", "haptics", "exercise", "case",
                "training"},
    "exchange": {"base", "volume", "exercise", "case", "session"},
    "desk": {"base", "volume", "tissue", "imaging", "device", "haptics", "exercise", "case", "session",
             "library"},
    "structures": {"base", "volume"},
    "render": {"base", "volume", "tissue", "exercise"},
    "plot": {"base"},
    "headset": {"base"},
    "machine": {"base", "volume", "tissue", "device", "haptics", "exercise", "case", "session",
                "render", "headset"},
    "lab": {"base", "volume", "tissue", "imaging", "device", "haptics", "exercise", "case",
            "training", "session", "render", "plot", "headset", "machine"},
}
MODULES = set(ROOMS)
ROOMS["ui"] = MODULES - {"lab"}
ROOMS["app"] = MODULES | {"ui"}

# Rooms with inner folders, and the arrows between those. What lies beside them sees all of them, and
# none of them sees it. Every source of other rooms lies in the room's own folder, or in one that
# is part of it as a whole.
INNER = {
    "imaging": {
        "common": set(),
        "dicom": {"common"},
        "report": {"common", "dicom"},
        "series": {"common", "dicom", "report"},
        "steps": {"common", "report", "series"},
        "files": {"common", "report", "series"},
        "segmentation": {"common", "report"},
    },
    "machine": {
        "common": set(),
        "ticks": {"common"},
        "drawing": {"common"},
        "trades": {"common", "drawing"},
        "exercise": {"common", "trades"},
        "commission": {"common", "ticks", "drawing", "trades"},
    },
    "lab": {
        "common": set(),
        "stability": {"common"},
        "touch": {"common"},
        "trades": set(),
        "import": set(),
        "render": {"import"},
        "devices": set(),
        "headset": set(),
    },
    "ui": {
        "common": set(),
        "views": {"common"},
        "tissue": {"common"},
        "structures": {"common", "views", "tissue"},
        "work": {"common", "views"},
        "cases": {"common", "views", "work"},
        "prepare": {"common", "views", "work", "tissue", "structures"},
        "headset": {"common", "views", "work"},
        "train": {"common", "views", "work", "headset"},
        "review": {"common", "work", "views"},
        "devices": {"common", "work"},
        "commission": {"common", "views", "work"},
        "frame": {"common", "views", "work", "cases", "prepare", "train", "review", "devices",
                  "headset", "commission"},
    },
}

# The libraries a room may name under USES; threads and dl are the system's own.
MAY_USE = {
    "base": {"glm", "json", "spdlog", "openssl", "dl"},
    "volume": {"zlib"},
    "tissue": set(),
    "imaging": {"archive", "dcmtk", "openjpeg", "vtk-image"},
    "library": {"qt-gui"},
    "device": {"dl"},
    "haptics": {"glm"},
    "exercise": set(),
    "training": {"hdf5"},
    "case": set(),
    "session": set(),
    "desk": set(),
    "exchange": set(),
    "structures": {"vtk-filters"},
    "render": {"vtk-rendering", "vtk-image", "opengl", "dl"},
    "plot": {"qt-gui"},
    "headset": {"qt-opengl", "openxr", "dl"},
    "machine": set(),
    "lab": {"qt-opengl"},
    "ui": {"qt"},
    "app": {"qt", "cli11"},
}
FOR_ALL = {"threads"}
# What a plugin may use beside JSON, threads and libraries opened at run time.
PLUGIN_USES = {"pedal": {"hidapi"}, "woodenhaptics": {"hidapi"}}

# The headers each library brings. A room that needs one only through another room's header (Vec3
# through base/math.h) includes that room's header.
HEADERS = {
    "glm": r"glm/.+",
    "json": r"nlohmann/.+",
    "spdlog": r"spdlog/.+",
    "openssl": r"openssl/.+",
    "dcmtk": r"dcmtk/.+",
    "archive": r"archive(_entry)?\.h",
    "openjpeg": r"openjpeg.*",
    "hdf5": r"hdf5(_hl)?\.h|H5.+\.h",
    "vtk-image": r"vtk[A-Z]\w*\.h",
    "vtk-filters": r"vtk[A-Z]\w*\.h",
    "vtk-rendering": r"vtk[A-Z]\w*\.h|vtk_gl(ew|ad)\.h|vtksys/\w+\.hxx",
    "opengl": r"GL/.+|vtk_gl(ew|ad)\.h",
    # Pictures and texts, no widgets and no events.
    "qt-gui": r"Q(Buffer|Char|Color|Font\w*|GuiApplication|Image|LineF|List|Painter\w*|Pen|PluginLoader|PointF|PolygonF|"
              r"RectF|SizeF|String)",
    "qt": r"Q\w+|Q\w+/Q?\w+(\.h)?",
    # A context of OpenGL's and its thread.
    "qt-opengl": r"Q(GuiApplication|OffscreenSurface|OpenGLContext|OpenGLExtraFunctions|Thread)",
    "openxr": r"openxr/.+|GL/glx\.h",
    "cli11": r"CLI/.+",
    "zlib": r"zlib\.h",
    "threads": r"pthread\.h|semaphore\.h",
    "dl": r"dlfcn\.h",
    "hidapi": r"hidapi/hidapi\.h",
}
STANDARD = set("""
algorithm any array atomic barrier bit bitset cassert cctype cerrno cfenv cfloat charconv chrono
cinttypes climits clocale cmath compare complex concepts condition_variable coroutine csetjmp
csignal cstdarg cstddef cstdint cstdio cstdlib cstring ctime cuchar cwchar deque exception execution
filesystem forward_list fstream functional future initializer_list iomanip ios iosfwd iostream
istream iterator latch limits list locale map memory memory_resource mutex new numbers numeric
optional ostream queue random ranges ratio regex scoped_allocator semaphore set shared_mutex
source_location span sstream stack stdexcept stop_token streambuf string string_view syncstream
system_error thread tuple type_traits typeindex typeinfo unordered_map unordered_set utility
valarray variant vector version
assert.h ctype.h errno.h float.h inttypes.h limits.h locale.h math.h signal.h stdarg.h stdatomic.h
stdbool.h stddef.h stdint.h stdio.h stdlib.h string.h time.h
dirent.h elf.h execinfo.h fcntl.h grp.h malloc.h poll.h pwd.h sched.h unistd.h
sys/file.h sys/ioctl.h sys/mman.h sys/prctl.h
sys/resource.h sys/socket.h sys/stat.h sys/statvfs.h sys/syscall.h sys/time.h sys/types.h sys/un.h sys/utsname.h
termios.h
sys/wait.h
""".split())

# The headers of ours that show VTK's, to their room alone: several .cpp files share what they hold.
VTK_HEADERS = {"modules/render/scene_parts.h", "modules/render/send_box.h"}
# By its bare name, since a plugin also builds alone, with that folder given.
DEVICE_ABI = "trephine_device.h"

# Everything of std::filesystem that asks the disk, and what its calls need so that they do not throw.
FILESYSTEM_CALL = re.compile(
    r"\b(?:std::filesystem|fs)::((?:recursive_)?directory_iterator(?: \w+)?|absolute|canonical|"
    r"copy\w*|create_\w+|current_path|equivalent|exists|file_size|hard_link_count|"
    r"is_(?:block_file|character_file|directory|empty|fifo|other|regular_file|socket|symlink)|"
    r"last_write_time|permissions|proximate|read_symlink|relative|remove|remove_all|rename|"
    r"resize_file|space|status|symlink_status|temp_directory_path|weakly_canonical)\(")
ERROR_CODE = re.compile(r"\b(?:std::error_code|(?:std::filesystem|fs)::file_status)&? (\w+)"
                        r"|\bauto (\w+) = (?:std::filesystem|fs)::(?:symlink_)?status\(")

SOURCES = {".h", ".hpp", ".c", ".cpp", ".in"}
TEXTS = SOURCES | {".cmake", ".json", ".md", ".py", ".sh", ".txt", ".yml", ".yaml", ".glsl", ".qss",
                   ".svg", ".xml", ".desktop", ".rules", ".ts", ""}
NOT_OURS = {".git", ".cache", "out", "__pycache__"}
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)
# Put together here, so that this file does not hold what it forbids.
MACHINE_PATH = re.compile(r"(?<![\w.$}/])/(" + "|".join(["work", "root", "home"]) + r")/")


def files_below(root, folder):
    base = root / folder
    return sorted(p for p in base.rglob("*") if p.is_file()) if base.is_dir() else []


def sources_below(root, folder):
    return [p for p in files_below(root, folder) if p.suffix in SOURCES]


def includes(path):
    """(line number, name, quoted) of each #include."""
    text = path.read_text(encoding="utf-8", errors="replace")
    for match in INCLUDE.finditer(text):
        line = text.count("\n", 0, match.start(match.lastindex)) + 1
        yield line, match.group(match.lastindex), match.lastindex == 1


def provided_by(libraries, header):
    return any(re.fullmatch(HEADERS[name], header) for name in libraries)


class Report:
    def __init__(self, root):
        self.root = root
        self.lines = []
        self.files = 0
        self.includes = 0

    def add(self, path, line, text):
        where = path.relative_to(self.root) if path.is_absolute() else path
        self.lines.append(f"{where}:{line}: {text}" if line else f"{where}: {text}")


def check_declaration(report, room):
    """What a room's CMakeLists.txt declares, against the table of arrows."""
    name, where = room["name"], pathlib.Path(room["dir"]) / "CMakeLists.txt"
    if name not in ROOMS:
        report.add(where, 0, f"the room '{name}' is not in the table of rooms")
        return
    for other in sorted(set(room["depends"]) - ROOMS[name]):
        report.add(where, 0, f"the room '{name}' may not depend on '{other}'")
    for library in sorted(set(room["uses"]) - MAY_USE[name] - FOR_ALL):
        report.add(where, 0, f"the room '{name}' may not use the library '{library}'")


def check_room(report, rooms, room):
    """Every #include of a room, against its own DEPENDS and USES."""
    root, name = report.root, room["name"]
    allowed_rooms = set(room["depends"]) | {name}
    libraries = set(room["uses"]) | FOR_ALL
    for path in sources_below(root, room["dir"]):
        report.files += 1
        for line, header, quoted in includes(path):
            report.includes += 1
            relative = path.relative_to(root).as_posix()
            if quoted:
                target = header.split("/")[0] if "/" in header else None
                if target is None:
                    if not (path.parent / header).is_file():
                        report.add(path, line, f'"{header}" is to be written as "room/file.h"')
                elif target not in rooms:
                    report.add(path, line, f'"{header}" is in no room')
                elif target not in allowed_rooms:
                    report.add(path, line, f"the room '{name}' does not depend on '{target}'")
                elif "/detail/" in header and target != name:
                    report.add(path, line, f'"{header}" is private to the room \'{target}\'')
                elif f"modules/{header}" in VTK_HEADERS and name != "render":
                    report.add(path, line, f'"{header}" is for render alone: it shows VTK')
                elif not (root / rooms[target]["dir"] / header.split("/", 1)[1]).is_file():
                    report.add(path, line, f'"{header}" does not exist')
                continue
            if header.startswith("vtk") and path.suffix != ".cpp" and relative not in VTK_HEADERS:
                report.add(path, line, f"<{header}>: VTK belongs in .cpp files")
            if header not in STANDARD and not provided_by(libraries, header):
                report.add(path, line, f"the room '{name}' may not include <{header}>")


def inner_folder(path_in_room):
    """"dicom" of "dicom/codecs.h"; "" of what lies in the room's own folder."""
    return path_in_room.split("/")[0] if "/" in path_in_room else ""


def check_inner_folders(report, rooms):
    """Every #include within a room that has inner folders, against their arrows."""
    for name, arrows in INNER.items():
        if name not in rooms:
            continue
        folder = report.root / rooms[name]["dir"]
        for path in sources_below(report.root, rooms[name]["dir"]):
            inner = inner_folder(path.relative_to(folder).as_posix())
            if inner and inner not in arrows:
                report.add(path, 0, f"'{inner}' is no inner folder of the room '{name}'")
                continue
            for line, header, quoted in includes(path):
                if not quoted or not header.startswith(name + "/"):
                    continue
                target = inner_folder(header.split("/", 1)[1])
                of_room = not target and header.endswith("/codes.h")  # the codes of all its folders
                if inner and not of_room and target != inner and target not in arrows[inner]:
                    report.add(path, line, f"the folder '{name}/{inner}' does not depend on "
                                           f"'{name}/{target}'".replace("/'", "'"))


def check_plugins(report):
    """Plugins see the device ABI's header, the standard library and JSON, and their own files."""
    for path in sources_below(report.root, "plugins"):
        report.files += 1
        for line, header, quoted in includes(path):
            report.includes += 1
            if quoted:
                if header != DEVICE_ABI and not (path.parent / header).is_file():
                    report.add(path, line, f'a plugin may include "{DEVICE_ABI}", not "{header}"')
            elif header not in STANDARD and not provided_by(
                    {"json", "threads", "dl"} | PLUGIN_USES.get(path.parent.name, set()), header):
                report.add(path, line, f"a plugin may not include <{header}>")


def check_stray_sources(report, rooms):
    """A source under modules that no room owns would escape every other check."""
    folders = [r["dir"] + "/" for r in rooms.values()]
    for path in sources_below(report.root, "modules"):
        if not path.relative_to(report.root).as_posix().startswith(tuple(folders)):
            report.add(path, 0, "this source belongs to no declared room")


def arguments_from(text, start):
    """The arguments of a call whose opening bracket ends at `start`."""
    depth, begin, found = 1, start, []
    for at in range(start, len(text)):
        depth += {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}.get(text[at], 0)
        if depth == 0 or (depth == 1 and text[at] == ","):
            found.append(text[begin:at].strip())
            begin = at + 1
        if depth == 0:
            break
    return found


def check_filesystem_calls(report):
    """What returns Result throws nothing, so the disk is asked with an error_code (or about a
    file_status, which asks nothing)."""
    for folder in ("modules", "ui", "app", "plugins"):
        for path in sources_below(report.root, folder):
            text = path.read_text(encoding="utf-8", errors="replace")
            safe = {name for found in ERROR_CODE.findall(text) for name in found if name}
            for match in FILESYSTEM_CALL.finditer(text):
                # A range-for goes on to the next entry without one.
                in_range_for = "directory_iterator" in match.group(1) and re.search(
                    r"[^:]:\s*$", text[:match.start()])
                if in_range_for or arguments_from(text, match.end())[-1] not in safe:
                    report.add(path, text.count("\n", 0, match.start()) + 1,
                               f"{match.group(1)} throws without an error_code")


def check_machine_paths(report):
    """No text that is handed on names a folder of one machine."""
    for path in sorted(report.root.rglob("*")):
        folders = path.relative_to(report.root).parts[:-1]
        if any(folder in NOT_OURS or folder.startswith("build") for folder in folders):
            continue
        if path.suffix not in TEXTS or not path.is_file():
            continue
        text = path.read_bytes()
        if b"\0" in text:
            continue
        for number, line in enumerate(text.decode("utf-8", "replace").splitlines(), 1):
            found = MACHINE_PATH.search(line)
            if found:
                report.add(path, number, f"names a path of one machine: {found.group()}")


def check(root, declared):
    """Everything; `declared` is the content of rooms.json."""
    report = Report(root)
    declared = [{**r, "depends": [d for d in r["depends"] if d],
                 "uses": [u for u in r["uses"] if u]} for r in declared]
    rooms = {r["name"]: r for r in declared}
    # ui and app need not be declared as rooms to be held to the arrows.
    for name in ("ui", "app"):
        rooms.setdefault(name, {"name": name, "dir": name, "depends": sorted(ROOMS[name]),
                                "uses": sorted(MAY_USE[name])})
    for room in declared:
        check_declaration(report, room)
    for room in rooms.values():
        check_room(report, rooms, room)
    check_inner_folders(report, rooms)
    check_plugins(report)
    check_stray_sources(report, rooms)
    check_filesystem_calls(report)
    check_machine_paths(report)
    if not report.files or not report.includes:
        report.add(pathlib.Path("modules"), 0, "no source was found, so nothing was checked")
    return report


# (what it breaks, file, text put in front of it, words of the finding)
VIOLATIONS = [
    ("an arrow against the table", "modules/base/json.h", '#include "volume/grid.h"\n',
     "does not depend on 'volume'"),
    ("an exercise that knows the open case", "modules/exercise/rig.h", '#include "case/case.h"\n',
     "does not depend on 'case'"),
    ("a case that knows a session", "modules/case/case.h", '#include "session/session.h"\n',
     "does not depend on 'session'"),
    ("a desk that knows its window", "modules/desk/desk.h", '#include "ui/work/workstation.h"\n',
     "does not depend on 'ui'"),
    ("a case of the library that knows the desk", "modules/library/stored_case.cpp",
     '#include "desk/desk.h"\n', "does not depend on 'desk'"),
    ("Qt on the desk", "modules/desk/opening.cpp", "#include <QString>\n",
     "may not include <QString>"),
    ("a window that measures as developers do", "ui/prepare/arms_tab.cpp",
     '#include "lab/trades/trade_charts.h"\n', "does not depend on 'lab'"),
    ("a private header elsewhere", "ui/planted.cpp",
     '#include "imaging/dicom/detail/dicom_file.h"\n', "private to the room 'imaging'"),
    ("a room's undeclared library", "modules/tissue/tissue_set.cpp", "#include <hdf5.h>\n",
     "may not include <hdf5.h>"),
    ("Qt below ui", "modules/volume/grid.cpp", "#include <QString>\n", "may not include <QString>"),
    ("a widget in a plot", "modules/plot/drawing.cpp", "#include <QWidget>\n",
     "may not include <QWidget>"),
    ("an include with blanks", "modules/base/file.cpp", " #  include  <QString>\n",
     "may not include <QString>"),
    ("VTK in a header", "modules/volume/volume.h", "#include <vtkImageData.h>\n", "in .cpp files"),
    ("VTK in volume", "modules/volume/nifti_file.cpp", "#include <vtkImageData.h>\n",
     "may not include <vtkImageData.h>"),
    ("render's VTK header elsewhere", "ui/planted.cpp", '#include "render/scene_parts.h"\n',
     "render alone"),
    ("a header by its bare name", "modules/tissue/tissue_set.cpp", '#include "json.h"\n',
     "room/file.h"),
    ("a header that is not there", "modules/tissue/tissue_set.cpp", '#include "base/none.h"\n',
     "does not exist"),
    ("a plugin that knows a room", "plugins/planted/planted.cpp", '#include "base/json.h"\n',
     "a plugin may include"),
    ("a plugin with hidapi that has no HID device", "plugins/planted/planted.cpp",
     "#include <hidapi/hidapi.h>\n", "a plugin may not include"),
    ("a plugin with Qt", "plugins/planted/planted.cpp", "#include <QString>\n",
     "a plugin may not include"),
    ("a source of no room", "modules/planted/planted.cpp", "\n", "belongs to no declared room"),
    ("a call that throws", "modules/base/file.cpp", "bool there = fs::exists(fs::path(name));\n",
     "exists throws"),
    ("a listing that throws", "ui/planted.cpp",
     "std::error_code ec;\nfor (auto& e : std::filesystem::directory_iterator(folder, ec)) {}\n",
     "directory_iterator throws"),
    ("a folder that may be missing", "ui/planted.cpp", "std::filesystem::temp_directory_path();\n",
     "temp_directory_path throws"),
    ("a machine's path", "modules/base/README.md", "see /ho" "me/someone/notes\n", "one machine"),
]


def inner_violations():
    """In each inner folder, a file that includes one of its room that no arrow leads to."""
    for room, arrows in INNER.items():
        base = room if room == "ui" else f"modules/{room}"
        for inner, allowed in arrows.items():
            other = next(iter(sorted(set(arrows) - allowed - {inner})), None)
            target = f"{room}/{other}" if other else room
            yield (f"an arrow against the table in {room}/{inner}", f"{base}/{inner}/planted.h",
                   f'#include "{target}/planted.h"\n', f"does not depend on '{target}'")
        yield (f"an unknown folder in {room}", f"{base}/planted/planted.h", "\n",
               "is no inner folder")


def in_rounds(violations):
    """They are planted together, a file once a round: checking the whole tree takes its time."""
    rounds = []
    for violation in violations:
        free = next((r for r in rounds if all(v[1] != violation[1] for v in r)), None)
        if free is None:
            rounds.append(free := [])
        free.append(violation)
    return rounds


def self_test(root, declared):
    failures = []
    skipped = shutil.ignore_patterns(".git", "build*", "out", ".cache", "__pycache__")
    with tempfile.TemporaryDirectory(prefix="trephine-") as folder:
        tree = pathlib.Path(folder).resolve() / "tree"
        shutil.copytree(root, tree, ignore=skipped, symlinks=True)
        before = set(check(tree, declared).lines)
        for planted in in_rounds([*VIOLATIONS, *inner_violations()]):
            old = {}
            for _, name, text, _ in planted:
                path = tree / name
                old[path] = path.read_text(encoding="utf-8") if path.is_file() else None
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text + (old[path] or ""), encoding="utf-8")
            lines = [line for line in check(tree, declared).lines if line not in before]
            for what, name, _, words in planted:
                found = any(line.startswith(name) and words in line for line in lines)
                print(f"{'found' if found else 'MISSED'}: {what}")
                if not found:
                    failures.append(what)
            for path, text in old.items():
                if text is None:
                    path.unlink()
                else:
                    path.write_text(text, encoding="utf-8")
        planted = copy.deepcopy(declared)
        planted[0]["depends"].append("session")
        planted[0]["uses"].append("qt")
        lines = check(tree, planted).lines
        for words in ("may not depend on 'session'", "may not use the library 'qt'"):
            found = any(words in line for line in lines)
            print(f"{'found' if found else 'MISSED'}: a declaration that {words}")
            if not found:
                failures.append(words)
        empty = pathlib.Path(folder).resolve() / "empty"
        empty.mkdir()
        if not check(empty, declared).lines:
            failures.append("a tree without sources")
    return failures


def main(arguments):
    if len(arguments) not in (2, 3) or arguments[2:] not in ([], ["--self-test"]):
        print(__doc__, file=sys.stderr)
        return 1
    root = pathlib.Path(arguments[0]).resolve()
    declared = json.loads(pathlib.Path(arguments[1]).read_text(encoding="utf-8"))
    if arguments[2:]:
        failures = self_test(root, declared)
        for what in failures:
            print(f"the check does not see {what}", file=sys.stderr)
        return 1 if failures else 0
    report = check(root, declared)
    for line in report.lines:
        print(line)
    print(f"{report.includes} includes in {report.files} sources of {len(declared)} rooms, "
          f"{len(report.lines)} violations")
    return 1 if report.lines else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
