// How both programs answer: JSON alone on stdout under --json, else words; errors as one sentence.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "base/json.h"
#include "base/result.h"

namespace trephine {

// Prints `answer` with `schema` ("trephine.<name>.1") and `build` in front.
void printAnswer(const std::string& name, const Json& answer);

// The same in one line: of what is answered bit by bit.
void printLine(const std::string& name, const Json& answer);

// Under --json prints {error:{code,what,where,next}} with `extra` merged in, else the sentence on
// stderr. Returns the exit code: 1.
int printError(const std::string& name, const Error& error, bool json, const Json& extra = {});

// What work came to: `answer` under --json, else `text` on stdout. With a `failure` that is printed
// as well, and the exit code is 1.
int printOutcome(const std::string& name, const Json& answer, const std::string& text,
                 const std::optional<Error>& failure, bool json);

// A Progress's report: a line on stderr that is written over, where that is a terminal.
void reportToTerminal(double fraction, const std::string& step);
// From here on it is a line for each report, "0.25 step", for a program that reads them.
void reportInLines();

Json errorJson(const Error& error);

// printf to stdout and stderr of what a person reads, and the only way to print in the programs:
// text of a file or a device in it cannot command the terminal (cleanLines).
void say(const char* format, ...) __attribute__((format(printf, 1, 2)));
void sayError(const char* format, ...) __attribute__((format(printf, 1, 2)));

// Whether --json stands anywhere on the command line.
bool wantsJson(int argc, char** argv);

// Runs a program's work: what would end it otherwise (no memory, a library's exception, a file
// over the user's limit) becomes an answer and an exit code; that of work which a signal ended is
// 128 and the signal's number.
int guarded(const std::string& name, bool json, const std::function<int()>& work);

}  // namespace trephine
