#include "app/answer.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <new>

#include "app/codes.h"
#include "app/signals.h"
#include "base/codes.h"
#include "base/system.h"
#include "base/utf8.h"

namespace trephine {

namespace {

std::atomic<bool> in_lines{false};

void printClean(std::FILE* to, const char* format, std::va_list arguments) {
  std::va_list again;
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, again);
  va_end(again);
  if (length < 0) return;
  std::string text(std::size_t(length) + 1, '\0');
  std::vsnprintf(text.data(), text.size(), format, arguments);
  text.pop_back();
  std::fputs(cleanLines(text).c_str(), to);
}

void print(const std::string& name, const Json& answer, int indent) {
  Json out = {{"schema", "trephine." + name + ".1"}, {"build", buildName()}};
  for (auto it = answer.begin(); it != answer.end(); ++it) out[it.key()] = it.value();
  std::printf("%s\n", out.dump(indent, ' ', true, Json::error_handler_t::replace).c_str());
}

}  // namespace

void say(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  printClean(stdout, format, arguments);
  va_end(arguments);
}

void sayError(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  printClean(stderr, format, arguments);
  va_end(arguments);
}

void reportInLines() {
  in_lines = true;
}

void reportToTerminal(double fraction, const std::string& step) {
  static const bool terminal = ::isatty(STDERR_FILENO) != 0;
  if (in_lines) {
    sayError("%.4f %s\n", fraction, cleanUtf8(step).c_str());
    return;
  }
  if (terminal) {
    std::fprintf(stderr, "\r%-12s %3.0f %%\033[K", cleanUtf8(step).c_str(), 100.0 * fraction);
  }
  if (terminal && fraction >= 1.0) std::fprintf(stderr, "\r\033[K");
}

Json errorJson(const Error& error) {
  return {{"code", error.code.str()},
          {"what", error.what},
          {"where", error.where},
          {"next", error.next}};
}

void printAnswer(const std::string& name, const Json& answer) { print(name, answer, 2); }

void printLine(const std::string& name, const Json& answer) { print(name, answer, -1); }

int printError(const std::string& name, const Error& error, bool json, const Json& extra) {
  if (json) {
    Json out = extra.is_object() ? extra : Json::object();
    out["error"] = errorJson(error);
    printAnswer(name, out);
  } else {
    sayError("%s\n", error.sentence().c_str());
  }
  return 1;
}

int printOutcome(const std::string& name, const Json& answer, const std::string& text,
                 const std::optional<Error>& failure, bool json) {
  if (!json) say("%s", text.c_str());
  if (failure) return printError(name, *failure, json, answer);
  if (json) printAnswer(name, answer);
  return 0;
}

bool wantsJson(int argc, char** argv) {
  return std::any_of(argv, argv + argc, [](const char* a) { return !std::strcmp(a, "--json"); });
}

int guarded(const std::string& name, bool json, const std::function<int()>& work) {
  std::signal(SIGXFSZ, SIG_IGN);  // then the write fails and says so
  try {
    const int code = work();
    if (code == 0 && (std::fflush(stdout) != 0 || std::ferror(stdout))) {
      sayError("The answer could not be written: %s. Send it to another place.\n",
               std::strerror(errno));
      return 1;
    }
    return signalReceived() != 0 ? 128 + signalReceived() : code;
  } catch (const std::bad_alloc&) {
    return printError(name,
                      {code::kOutOfMemory, "There is not enough memory", "",
                       "Close other programs or choose a smaller case"},
                      json);
  } catch (const std::exception& error) {
    return printError(name,
                      {code::kInternal, std::string("The program had to stop: ") + error.what(), "",
                       "Please report this"},
                      json);
  }
}

}  // namespace trephine
