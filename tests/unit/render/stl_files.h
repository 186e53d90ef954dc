// STL files for tests, and what the log says meanwhile.
#pragma once

#include <spdlog/sinks/ostream_sink.h>

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "base/log.h"
#include "base/math.h"

namespace trephine::test {

// A closed box between two corners, anticlockwise seen from outside.
inline std::vector<glm::vec3> boxCorners(glm::vec3 low, glm::vec3 high) {
  std::vector<glm::vec3> corners;
  const auto corner = [&](int bits) {
    return glm::vec3(bits & 1 ? high.x : low.x, bits & 2 ? high.y : low.y,
                     bits & 4 ? high.z : low.z);
  };
  const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    for (int i : {0, 1, 2, 0, 2, 3}) corners.push_back(corner(f[i]));
  }
  return corners;
}

inline std::string binaryStl(const std::vector<glm::vec3>& corners,
                             const std::string& title = "box") {
  std::string bytes = title;
  bytes.resize(80, '\0');
  const auto put = [&](std::uint32_t value) {
    for (int i = 0; i < 4; ++i) bytes.push_back(char(value >> 8 * i & 0xff));
  };
  put(std::uint32_t(corners.size() / 3));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i % 3 == 0) bytes.append(12, '\0');
    for (int c = 0; c < 3; ++c) put(std::bit_cast<std::uint32_t>(corners[i][c]));
    if (i % 3 == 2) bytes.append(2, '\0');
  }
  return bytes;
}

inline std::string asciiStl(const std::vector<glm::vec3>& corners) {
  std::ostringstream text;
  text << "solid a box of tests\n";
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i % 3 == 0) text << "  facet normal 0 0 0\r\n    outer loop\r\n";
    text << "      vertex " << corners[i].x << " " << corners[i].y << " " << corners[i].z << "\r\n";
    if (i % 3 == 2) text << "    endloop\r\n  endfacet\r\n";
  }
  text << "endsolid a box of tests\n";
  return text.str();
}

inline std::filesystem::path put(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

// Takes the log for as long as it lives.
class Log {
 public:
  Log() : before_(spdlog::default_logger()) {
    auto sink = std::make_shared<spdlog::sinks::ostream_sink_mt>(text_);
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", sink));
    spdlog::set_pattern("%l: %v");
  }
  ~Log() { spdlog::set_default_logger(before_); }
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  std::vector<std::string> lines() const {
    std::istringstream all(text_.str());
    std::vector<std::string> lines;
    for (std::string line; std::getline(all, line);) lines.push_back(line);
    return lines;
  }

 private:
  std::ostringstream text_;
  std::shared_ptr<spdlog::logger> before_;
};

}  // namespace trephine::test
