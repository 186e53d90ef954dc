#!/usr/bin/env python3
"""Where text can do more than be read: markup, the terminal, another program. Each has a few places
that are known, with what holds them; a new one is found here and is thought about.

    check_outlets.py SOURCE       ends with 1 where there is one that is not known
    check_outlets.py --self-test  plants one of each kind
"""
import re
import sys
import tempfile
from pathlib import Path

# Kind: what it looks like, where it is looked for, and the files that may hold it with the reason.
OUTLETS = {
    "markup": (
        re.compile(r"Qt::(RichText|AutoText|MarkdownText)|\bset(Html|Markdown)\b|\bQTextBrowser\b"
                   r"|\bQTextEdit\b|\bQErrorMessage\b|\bQWhatsThis\b|\bQTextDocument\b"),
        ("ui", "app"),
        {
            "ui/common/plain_text.h": "the rule for labels",
            "ui/common/plain_text.cpp": "the rule for labels",
            "ui/common/pdf_page.cpp": "pages of ours, made by report_page and commission_page",
            "ui/cases/report_card.cpp": "reportHtml() escapes what is of the file",
            "ui/cases/cases_workspace.cpp": "a case's page, which opens nothing else",
            "ui/commission/commission_page.cpp": "a page of ours, which opens nothing else",
            "ui/commission/commission_page.h": "the same",
            "ui/frame/help_page.cpp": "the pages of the help that are installed",
            "ui/frame/help_page.h": "the same",
            "ui/prepare/trade_view.cpp": "settings of the recommended file are escaped",
            "ui/train/exercise_panel.cpp": "names and steps are escaped",
            "ui/train/result_page.cpp": "names are escaped",
            "ui/train/start_card.cpp": "steps are escaped",
        }),
    "the terminal": (
        re.compile(r"(?<![\w.>])(std::)?(v?f?printf|fputs|puts|putchar|perror)\s*\("
                   r"|\bstd::(cout|cerr|clog)\b|\bq(Debug|Info|Warning|Critical)\s*\("),
        ("modules", "ui", "app"),
        {
            "app/answer.cpp": "say() and sayError(), which clean; JSON for programs",
            "modules/volume/paint_cases.cpp": "a step of the build",
        }),
    "another program": (
        re.compile(r"\bQProcess\b|\bQDesktopServices\b|(?<![\w.>:])(::|std::)?(system|popen|execv\w*|execl\w*)\s*\("
                   r"|\bposix_spawnp?\s*\("),
        ("modules", "ui", "app", "plugins"),
        {
            "modules/base/child_process.cpp": "a program's path and its words, no shell",
            "app/lab_commands.cpp": "becomes trephine-measure with its own words, no shell",
            "ui/commission/commission_page.cpp": "trephine-lab, no shell",
            "ui/commission/commission_page.h": "the same",
        }),
}


def comments_out(text):
    return re.sub(r"//[^\n]*", "", text)


def check(source, say=print):
    source, wrong = Path(source), 0
    for kind, (pattern, rooms, known) in OUTLETS.items():
        for room in rooms:
            for file in sorted((source / room).rglob("*")):
                if file.suffix not in {".cpp", ".h", ".c"}:
                    continue
                name = file.relative_to(source).as_posix()
                for number, line in enumerate(file.read_text().splitlines(), 1):
                    if name in known or not pattern.search(comments_out(line)):
                        continue
                    wrong += 1
                    say(f"{name}:{number}: a way to {kind} that is not known: {line.strip()}")
        for name in known:
            if not (source / name).exists():
                wrong += 1
                say(f"{name} is not there any more: take it off the list of {kind}")
    return wrong == 0


PLANTED = {
    "markup": "label->setTextFormat(Qt::RichText);",
    "the terminal": 'std::printf("%s", name.c_str());',
    "another program": "QDesktopServices::openUrl(url);",
}


def self_test():
    with tempfile.TemporaryDirectory() as folder:
        for _, rooms, known in OUTLETS.values():
            for name in known:
                (Path(folder) / name).parent.mkdir(parents=True, exist_ok=True)
                (Path(folder) / name).write_text("\n")
        quiet = {"say": lambda *_: None}
        assert check(folder, **quiet)
        new = Path(folder) / "ui" / "new.cpp"
        for kind, line in PLANTED.items():
            new.write_text(f"  {line}\n")
            assert not check(folder, **quiet), kind
            new.write_text(f"  // {line}\n")
            assert check(folder, **quiet), kind
        new.write_text('std::snprintf(text, size, "%d", 3);\n')
        assert check(folder, **quiet)
        (Path(folder) / "app" / "answer.cpp").unlink()
        assert not check(folder, **quiet), "a file that is gone"
    print("finds what it looks for")
    return True


if __name__ == "__main__":
    sys.exit(0 if (self_test() if sys.argv[1] == "--self-test" else check(sys.argv[1])) else 1)
