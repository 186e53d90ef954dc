#!/usr/bin/env python3
"""Files that are compiled as one (CMAKE_UNITY_BUILD) share their anonymous namespaces: two functions
of one name in them are overloads, and a call may silently mean the other file's.
   check_batches.py BUILD       exit 1 and a line for each such name"""
import collections
import pathlib
import re
import sys

INCLUDE = re.compile(r'#include "([^"]+)"')
FUNCTION = re.compile(r"(?:template <.*> ?)?(?:[\w:<>,&*\s\[\]]+?[\s&*>])(\w+)\(")
TEXT = re.compile(r'R"\(.*?\)"', re.DOTALL)  # such as a shader, whose functions are its own
NO_FUNCTION = ("return", "static_assert", "using")


def functions(source):
    """Names of functions at the left margin within `namespace {`."""
    found, inside = set(), False
    for line in TEXT.sub("", source).splitlines():
        if line.startswith("namespace {"):
            inside = True
        elif line.startswith("}  // namespace") and "trephine" not in line:
            inside = False
        elif inside and line[:1].isalpha() and not line.startswith(NO_FUNCTION):
            match = FUNCTION.match(line)
            if match:
                found.add(match[1])
    return found


def clashes(files):
    """{name: files} of those that several have; `files` from name to text."""
    by_name = collections.defaultdict(list)
    for file, source in files.items():
        for name in functions(source):
            by_name[name].append(file)
    return {name: of for name, of in by_name.items() if len(of) > 1}


def self_test():
    first = "namespace {\n\nint twice(int a) {\n  return a;\n}\n\n}  // namespace\n"
    other = first.replace("int a", "double a")
    elsewhere = "int twice(double a) {\n  return a;\n}\n"
    assert clashes({"a": first, "b": other}) == {"twice": ["a", "b"]}
    assert not clashes({"a": first, "b": first.replace("twice", "thrice")})
    assert not clashes({"a": first, "b": elsewhere})
    shader = first.replace("int twice", 'const char* kShader = R"(\nint twice').replace(";\n}", ';\n})";')
    assert not clashes({"a": first, "b": shader}), shader


def main():
    self_test()
    failed = 0
    for batch in sorted(pathlib.Path(sys.argv[1]).rglob("Unity/unity_*.cxx")):
        paths = [pathlib.Path(path) for path in INCLUDE.findall(batch.read_text())]
        files = {path.name: path.read_text() for path in paths if path.is_file()}
        for name, of in sorted(clashes(files).items()):
            failed += 1
            print(f"'{name}' is a function of {' and of '.join(of)}: rename one of them")
    print(f"{failed} names of two functions in one batch")
    sys.exit(1 if failed else 0)


main()
