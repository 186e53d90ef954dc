#include "app/command_line.h"

#include <algorithm>
#include <string>
#include <vector>

#include "app/answer.h"
#include "base/codes.h"
#include "base/utf8.h"

namespace trephine {

CLI::Validator named() {
  return CLI::Validator(
      [](const std::string& name) {
        return name.empty() ? std::string("needs a name, not nothing") : std::string();
      },
      "");
}

std::optional<int> parsed(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return {};
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    // Of a word that is no command the parser says only that a command is missing.
    const CLI::App* of = &app;
    while (!of->get_subcommands().empty()) of = of->get_subcommands().front();
    const bool missing = of->get_require_subcommand_min() > 0;
    const std::vector<std::string> words = app.remaining(true);
    const auto word = std::find_if(words.begin(), words.end(),
                                   [](const std::string& w) { return !w.starts_with('-'); });
    const bool misnamed = missing && word != words.end();
    const std::string what =
        cleanUtf8(misnamed ? "There is no command '" + *word + "'" : std::string(error.what()));
    // The flag itself may stand behind what could not be parsed.
    if (!wantsJson(argc, argv)) {
      sayError("%s\nRun with --help for more information.\n", what.c_str());
      return 1;
    }
    return printError("usage", {code::kBadArgument, what, "the command line", "See --help"}, true);
  }
}

}  // namespace trephine
