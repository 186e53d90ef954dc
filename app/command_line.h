// What the programs' command lines have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

namespace trephine {

// Of an option whose empty name is no choice: with it, it would do what it does when not given.
CLI::Validator named();

// Parses. An exit code where nothing is left to be done: help was asked for, or the words are
// wrong, which is said, as JSON where --json is among them.
std::optional<int> parsed(CLI::App& app, int argc, char** argv);

}  // namespace trephine
