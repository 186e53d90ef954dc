"""No room has a sentence that cannot be translated: text of several words, which a person may read,
is given to tr(), trCount() or trLater() (modules/base/tr.h).

usage: check_words.py ROOT | --self-test
"""
import pathlib
import re
import sys

# Rooms whose texts are for those who develop Trephine.
DEVELOPERS = {"lab"}
# Files whose texts belong to a format, a standard, a driver or a document in English, and why.
FOREIGN = {
    "modules/imaging/dicom/seg_codes.cpp": "meanings of codes, as DICOM writes them",
    "modules/imaging/dicom/transfer_syntax.cpp": "names of transfer syntaxes, as DICOM has them",
    "modules/base/crash_report.cpp": "a file for those who mend Trephine",
}
# Texts of a standard or of files, in rooms that say sentences as well.
NAMES = {'"Series Instance UID"', '"SOP Class UID"', '"SOP Instance UID"', '"Trephine case"'}
# What takes texts that no person reads, or only in a log.
CALLS = re.compile(
    r"(?:\b(?:tr|trCount|trLater|static_assert|starts_with|ends_with|contains|find|rfind|getenv|setenv)"
    r"|\bspdlog::\w+|\bwarn|\blogged)$")
TOKEN = re.compile(
    r'//[^\n]*|/\*.*?\*/|^[ \t]*#[^\n]*|R"([^()\s\\]*)\(.*?\)\1"|"(?:[^"\\\n]|\\.)*"'
    r"|'(?:[^'\\\n]|\\.)+'|[A-Za-z_]\w*(?:::\w+)*|[(){}\[\];]", re.S | re.M)
# Two words or more, of which the first begins the text as a sentence does.
SENTENCE = re.compile(r'"(?:<[^>]*>)*[A-Z][a-z]+(?:\'s)?,? [^"]*[a-z]{2,}')


def raw_sentences(source):
    """(line, text) of each sentence of a C++ source outside the calls that take it."""
    found, open_calls, word = [], [], ""
    for match in TOKEN.finditer(source):
        token = match.group(0)
        if token.startswith(("//", "/*")) or token.lstrip().startswith("#"):
            continue
        if token in "([{":
            open_calls.append(bool(CALLS.search(word)))
        elif token in ")]}" and open_calls:
            open_calls.pop()
        elif token.startswith('"') and token not in NAMES and SENTENCE.match(token) and not any(open_calls):
            found.append((source.count("\n", 0, match.start()) + 1, token))
        word = token if token[0].isalpha() or token[0] == "_" else ""
    return found


def check(root):
    problems, seen = [], 0
    for path in sorted((root / "modules").rglob("*")):
        name = path.relative_to(root).as_posix()
        if path.suffix not in (".h", ".cpp") or name.split("/")[1] in DEVELOPERS:
            continue
        source = path.read_text()
        seen += len(re.findall(r"\btr\(", source))
        if name not in FOREIGN:
            problems += [f"{name}:{line}: {text}" for line, text in raw_sentences(source)]
    for problem in problems:
        print(problem)
    if problems:
        print(f"{len(problems)} sentences are not given to tr(), trCount() or trLater()")
    elif seen == 0:
        print("No sentence was found at all")
    else:
        print(f"{seen} sentences of the rooms can be translated")
    return 1 if problems or seen == 0 else 0


def self_test():
    """A planted sentence is seen; one that is marked, logged or compared is not."""
    def count(source):
        return len(raw_sentences(source))

    assert count('return Error{kX, "The file is not there", "", ""};') == 1
    assert count('const char* kText = "Close other programs";') == 1
    assert count('fail("The value of " + name);') == 1
    assert count('return Error{kX, tr("The file {} is not there", name(file)), ""};') == 0
    assert count('tr("The file {}", f("The other file"));') == 0
    assert count('spdlog::warn("The file is not there");') == 0
    assert count('// "The file is not there"\n') == 0
    assert count('if (text.starts_with("The file is")) return;') == 0
    assert count('f(tr("The {}", g(x)), "The file is not there");') == 1
    print("planted sentences are found")


if __name__ == "__main__":
    if sys.argv[1] == "--self-test":
        self_test()
    else:
        sys.exit(check(pathlib.Path(sys.argv[1])))
