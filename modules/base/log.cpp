#include "base/log.h"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/dist_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>

#include <memory>
#include <mutex>
#include <string>

#include "base/crash_report.h"
#include "base/utf8.h"

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

// What a file or a device calls itself stands in messages, and a terminal obeys control characters.
class CleanLines : public spdlog::sinks::dist_sink<std::mutex> {
 public:
  CleanLines()
      : dist_sink({std::make_shared<spdlog::sinks::stderr_color_sink_mt>(),
                   std::make_shared<LastLines>()}) {}

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    const std::string text = cleanLines({message.payload.data(), message.payload.size()});
    spdlog::details::log_msg clean = message;
    clean.payload = text;
    dist_sink::sink_it_(clean);
  }
};

}  // namespace

void setUpLog(bool quiet) {
  auto logger = spdlog::get("trephine");
  if (!logger) {
    logger = std::make_shared<spdlog::logger>("trephine", std::make_shared<CleanLines>());
    spdlog::register_logger(logger);
  }
  logger->set_pattern("%H:%M:%S.%e %^%l%$ %v");
  logger->set_level(quiet ? spdlog::level::warn : spdlog::level::info);
  spdlog::set_default_logger(logger);
}

}  // namespace trephine
