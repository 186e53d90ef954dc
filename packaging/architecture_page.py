#!/usr/bin/env python3
"""Makes ARCHITECTURE.md of what the build declares.

usage: architecture_page.py SOURCE_FOLDER ROOMS_JSON [--check]

ROOMS_JSON is build/rooms.json. The page goes to SOURCE_FOLDER/ARCHITECTURE.md; with --check nothing
is written, and the exit code is 1 where the file there is another one.
"""
import json
import pathlib
import re
import sys


def job_of(folder):
    """The first sentence of a room's README."""
    text = (folder / "README.md").read_text(encoding="utf-8")
    paragraph = " ".join(text.split("\n\n")[1].split())
    return re.split(r"(?<=[.])\s", paragraph)[0]


def without_shortcuts(rooms, name):
    """Of the rooms that one depends on, those that are not reached through another of them."""
    def below(other, seen):
        for deeper in rooms[other]:
            if deeper not in seen:
                seen.add(deeper)
                below(deeper, seen)
        return seen
    direct = rooms[name]
    return [d for d in direct if not any(d in below(o, set()) for o in direct if o != d)]


def level_of(rooms, name):
    return 1 + max((level_of(rooms, d) for d in rooms[name]), default=0)


def lines_of(source, declared):
    rooms = {r["name"]: [d for d in r["depends"] if d] for r in declared}
    folders = {r["name"]: r["dir"] for r in declared}
    levels = {}
    for name in rooms:
        levels.setdefault(level_of(rooms, name), []).append(name)
    yield "# Architecture"
    yield ""
    yield "Made by `packaging/architecture_page.py` of what the build declares; the test"
    yield "`architecture_page` holds it to that, and `architecture` every `#include`."
    yield ""
    yield "The folders are the architecture. A room may include the rooms that it declares, and no other;"
    yield "a folder `detail/` in a room is private to it. In the picture arrows go down: a room stands"
    yield "above all that it includes, and names those that no other of them includes for it."
    yield ""
    yield "```"
    width = max(len(name) for name in rooms)
    for level in sorted(levels, reverse=True):
        for name in sorted(levels[level]):
            arrows = ", ".join(sorted(without_shortcuts(rooms, name)))
            yield f"{level:>2}  {name:<{width}}  -> {arrows}" if arrows else f"{level:>2}  {name}"
    yield "```"
    yield ""
    yield "| room | job | libraries |"
    yield "|---|---|---|"
    for level in sorted(levels):
        for name in sorted(levels[level]):
            uses = next(r["uses"] for r in declared if r["name"] == name)
            libraries = ", ".join(sorted(u for u in uses if u))
            yield f"| `{folders[name]}` | {job_of(source / folders[name])} | {libraries} |"
    yield ""
    yield "Above the rooms are `app` (the programs) and beside them `plugins` (one device each, on the"
    yield "device interface alone). What is touched to add to a room stands in its README."


def main(arguments):
    if len(arguments) not in (2, 3) or arguments[2:] not in ([], ["--check"]):
        print(__doc__, file=sys.stderr)
        return 1
    source = pathlib.Path(arguments[0])
    declared = json.loads(pathlib.Path(arguments[1]).read_text(encoding="utf-8"))
    text = "\n".join(lines_of(source, declared)) + "\n"
    page = source / "ARCHITECTURE.md"
    if not arguments[2:]:
        page.write_text(text, encoding="utf-8")
        return 0
    if page.is_file() and page.read_text(encoding="utf-8") == text:
        return 0
    print("ARCHITECTURE.md is not what the build declares: run packaging/architecture_page.py "
          "SOURCE_FOLDER build/rooms.json", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
