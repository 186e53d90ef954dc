#include "base/log.h"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>

#include <memory>
#include <mutex>

#include "base/crash_report.h"

namespace trephine {

namespace {

// For the report of a crash.
class LastLines : public spdlog::sinks::base_sink<std::mutex> {
 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t text;
    formatter_->format(message, text);
    std::size_t size = text.size();
    while (size > 0 && (text[size - 1] == '\n' || text[size - 1] == '\r')) --size;
    keepLastLine(text.data(), size);
  }
  void flush_() override {}
};

}  // namespace

void setUpLog(bool quiet) {
  auto logger = spdlog::get("trephine");
  if (!logger) {
    logger = spdlog::stderr_color_mt("trephine");
    logger->sinks().push_back(std::make_shared<LastLines>());
  }
  logger->set_pattern("%H:%M:%S.%e %^%l%$ %v");
  logger->set_level(quiet ? spdlog::level::warn : spdlog::level::info);
  spdlog::set_default_logger(logger);
}

}  // namespace trephine
