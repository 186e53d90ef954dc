#include "app/answer.h"

#include <cstdio>

#include "base/system.h"

namespace trephine {

Json errorJson(const Error& error) {
  return {{"code", error.code}, {"what", error.what}, {"where", error.where}, {"next", error.next}};
}

void printAnswer(const std::string& name, const Json& answer) {
  Json out = {{"schema", "trephine." + name + ".1"}, {"build", buildName()}};
  for (auto it = answer.begin(); it != answer.end(); ++it) out[it.key()] = it.value();
  std::printf("%s\n", out.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
}

int printError(const std::string& name, const Error& error, bool json, const Json& extra) {
  if (json) {
    Json out = extra.is_object() ? extra : Json::object();
    out["error"] = errorJson(error);
    printAnswer(name, out);
  } else {
    std::fprintf(stderr, "%s\n", error.sentence().c_str());
  }
  return 1;
}

}  // namespace trephine
