"""No room and no part of the window has a sentence that cannot be translated: text of several words,
which a person may read, is given to tr(), trCount() or trLater() (modules/base/tr.h), in the window
also to Qt's tr(), translate() or the macros that mark a text of a table; so is the name of a step,
if only one word, that is given to a Progress.

usage: check_words.py ROOT | --self-test
"""
import contextlib
import io
import pathlib
import re
import sys
import tempfile

PARTS = ("modules", "ui")
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
    r"(?:\b(?:tr|trCount|trLater|translate|QT_TR(?:ANSLATE)?(?:_N)?_NOOP\w*|static_assert|starts_with|ends_with|contains|find|rfind|getenv|setenv)"
    r"|\bspdlog::\w+|\bwarn|\blogged)$")
# What takes the name of a step, which a person reads while it lasts.
STEPS = re.compile(r"\b(?:[pP]rogress_?(?:\.|->)at|Progress)$")
TOKEN = re.compile(
    r'//[^\n]*|/\*.*?\*/|^[ \t]*#[^\n]*|R"([^()\s\\]*)\(.*?\)\1"|"(?:[^"\\\n]|\\.)*"'
    r"|'(?:[^'\\\n]|\\.)+'|[A-Za-z_]\w*(?:(?:::|\.|->)\w+)*|[(){}\[\];]", re.S | re.M)
# Two words or more, of which the first begins the text as a sentence does.
SENTENCE = re.compile(r'"(?:<[^>]*>)*[A-Z][a-z]*(?:\'s)?,? [^"]*[a-z]{2,}')
STEP = re.compile(r'"[A-Z][a-z]')


def raw_sentences(source):
    """(line, text) of each sentence of a C++ source outside the calls that take it."""
    found, open_calls, word = [], [], ""  # each call that is open: what it is called

    def read_by_a_person(text):
        if text in NAMES or any(CALLS.search(call) for call in open_calls):
            return False
        step = open_calls and STEPS.search(open_calls[-1])
        return SENTENCE.match(text) or (step and STEP.match(text))

    for match in TOKEN.finditer(source):
        token = match.group(0)
        if token.startswith(("//", "/*")) or token.lstrip().startswith("#"):
            continue
        if token in "([{":
            open_calls.append(word)
        elif token in ")]}" and open_calls:
            open_calls.pop()
        elif token.startswith('"') and read_by_a_person(token):
            found.append((source.count("\n", 0, match.start()) + 1, token))
        word = token if token[0].isalpha() or token[0] == "_" else ""
    return found


def check(root):
    problems, seen = [], dict.fromkeys(PARTS, 0)
    for path in sorted(path for part in PARTS for path in (root / part).rglob("*")):
        name = path.relative_to(root).as_posix()
        part, room = name.split("/")[:2]
        if path.suffix not in (".h", ".cpp") or (part == "modules" and room in DEVELOPERS):
            continue
        source = path.read_text()
        seen[part] += len(re.findall(r"\btr\(", source))
        if name not in FOREIGN:
            problems += [f"{name}:{line}: {text}" for line, text in raw_sentences(source)]
    for problem in problems:
        print(problem)
    if problems:
        print(f"{len(problems)} sentences are not given to tr(), trCount() or trLater()")
    elif not all(seen.values()):
        print("No sentence was found at all in " + ", ".join(part for part in PARTS if not seen[part]))
    else:
        print(f"{sum(seen.values())} sentences of the rooms and of the window can be translated")
    return 1 if problems or not all(seen.values()) else 0


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
    assert count('return Error{kX, "A name is missing", "", ""};') == 1
    assert count('label->setText(tr("Of %1").arg("The whole case"));') == 1
    assert count('text = QCoreApplication::translate("Setting", "Not applied. %1.");') == 0
    assert count('{Preset::soft, "presetSoft", QT_TRANSLATE_NOOP("trephine::TissueList", "Soft tissue")},') == 0
    assert count('error = Error{kX, trephine::tr("Another is called \'{}\'", name), ""};') == 0
    assert count('widget->setObjectName("reportDialog");') == 0
    assert count('widget->setStyleSheet("QLabel { color: red; }");') == 0
    assert count('html += "<p style=\'margin: 3px\'>" + QString(" <b>%1</b>");') == 0
    assert count('progress.at(0.5, "Pictures");') == 1
    assert count('measure({}, Progress(progress_, 0.0, 0.5, "Pictures"));') == 1
    assert count('progress.at(0.5, tr("Pictures"));') == 0
    assert count('colours.at("Bone");') == 0
    with tempfile.TemporaryDirectory() as folder:
        for part in PARTS:
            (pathlib.Path(folder) / part / "work").mkdir(parents=True)
            (pathlib.Path(folder) / part / "work" / "one.cpp").write_text('say(tr("It is done"));\n')
        planted = pathlib.Path(folder) / "ui" / "work" / "two.h"
        with contextlib.redirect_stdout(io.StringIO()) as said:
            assert check(pathlib.Path(folder)) == 0
            planted.write_text('Status state_{Error{kX, "The case is not there", "", ""}};\n')
            assert check(pathlib.Path(folder)) == 1
        assert 'ui/work/two.h:1: "The case is not there"' in said.getvalue()
    print("planted sentences are found")


if __name__ == "__main__":
    if sys.argv[1] == "--self-test":
        self_test()
    else:
        sys.exit(check(pathlib.Path(sys.argv[1])))
