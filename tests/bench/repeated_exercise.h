// A shipped exercise with its script over and over, each time a little beside, so that the arms cut
// all the while.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "base/file.h"
#include "base/json.h"

namespace trephine::bench {

// Writes exercise and script into the folder; the exercise's file comes back.
inline std::filesystem::path repeated(const std::filesystem::path& file, double seconds,
                                      const std::filesystem::path& folder) {
  constexpr double kAside_mm = 1.5;
  Json exercise = *readJsonFile(file);
  const auto absolute = [&](Json& path) {
    path = std::filesystem::absolute(file.parent_path() / path.get<std::string>())
               .lexically_normal()
               .string();
  };
  absolute(exercise["tissues"]);
  absolute(exercise["operator"]);
  for (Json& tool : exercise["tools"]) {
    if (tool.contains("file")) absolute(tool["file"]);
  }
  Json script = *readJsonFile(exercise["operator"].get<std::string>());
  double once_s = 0.0;
  for (const Json& arm : script["arms"]) {
    once_s = std::max(once_s, arm["waypoints"].back()["t"].get<double>());
  }
  for (Json& arm : script["arms"]) {
    const Json one = arm["waypoints"];
    constexpr double kBetween_s = 0.001;  // the end of one and the start of the next
    for (int n = 1; n * once_s < seconds; ++n) {
      for (Json at : one) {
        at["t"] = at["t"].get<double>() + n * (once_s + kBetween_s);
        at["at_mm"][1] = at["at_mm"][1].get<double>() + kAside_mm * (n % 5);
        arm["waypoints"].push_back(at);
      }
    }
  }
  exercise["operator"] = (folder / "script.json").string();
  if (!writeTextFile(folder / "script.json", script.dump()) ||
      !writeTextFile(folder / "scene.json", exercise.dump())) {
    std::fprintf(stderr, "%s cannot be written\n", folder.c_str());
    std::exit(1);
  }
  return folder / "scene.json";
}

}  // namespace trephine::bench
