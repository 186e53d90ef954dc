#include "exchange/named_files.h"

#include "volume/phantom.h"

namespace trephine {

namespace {

Json* textOf(Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? &*found : nullptr;
}

std::string idOf(Json& object, const char* key) {
  const Json* text = textOf(object, key);
  return text ? text->get<std::string>() : std::string();
}

}  // namespace

Json* elsewhereOf(Json& tissues) {
  return textOf(tissues, "elsewhere");
}

Json* meshOf(Json& tool) {
  return textOf(tool, "mesh");
}

Status eachNamedFile(Json& exercise, const OnNamedFile& on) {
  const auto one = [&](NamedFile kind, const std::string& id, Json* name) {
    return name ? on(kind, id, *name) : Status();
  };
  Json* of_case = textOf(exercise, "case");
  if (of_case && phantomNamed(of_case->get<std::string>())) of_case = nullptr;
  if (Status done = one(NamedFile::caseVolume, "", of_case); !done) return done;
  if (Status done = one(NamedFile::labels, "", textOf(exercise, "labels")); !done) return done;
  Json* tissues = textOf(exercise, "tissues");
  if (!tissues && exercise.contains("tissues")) tissues = elsewhereOf(exercise["tissues"]);
  if (Status done = one(NamedFile::tissues, "", tissues); !done) return done;
  if (exercise.contains("tools") && exercise["tools"].is_array()) {
    for (Json& tool : exercise["tools"]) {
      const std::string id = idOf(tool, "id");
      if (Status done = one(NamedFile::tool, id, textOf(tool, "file")); !done) return done;
      if (Status done = one(NamedFile::mesh, id, meshOf(tool)); !done) return done;
    }
  }
  return one(NamedFile::operatorScript, "", textOf(exercise, "operator"));
}

}  // namespace trephine
