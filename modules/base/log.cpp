#include "base/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>

namespace trephine {

void setUpLog(bool quiet) {
  auto logger = spdlog::get("trephine");
  if (!logger) logger = spdlog::stderr_color_mt("trephine");
  logger->set_pattern("%H:%M:%S.%e %^%l%$ %v");
  logger->set_level(quiet ? spdlog::level::warn : spdlog::level::info);
  spdlog::set_default_logger(logger);
}

}  // namespace trephine
