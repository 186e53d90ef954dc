// The files that an exercise names, and those that its tissues and tools name, wherever in its JSON
// they stand. For this room's .cpp files.
#pragma once

#include <functional>
#include <string>

#include "base/json.h"

namespace trephine {

enum class NamedFile { caseVolume, labels, tissues, tool, mesh, operatorScript };

// Called with each text of the exercise that names a file, which may be changed; `id` is the tool's
// for `tool` and `mesh`, else empty. A tool in the exercise itself names its mesh, and a set of
// tissues in it names its other set, as `tissues`. A built-in case is none, nor is what is no text.
// The first error ends it and comes back; what was changed before stays so.
using OnNamedFile = std::function<Status(NamedFile kind, const std::string& id, Json& name)>;
Status eachNamedFile(Json& exercise, const OnNamedFile& on);

// Of a tissue set and of a tool as files of their own, which eachNamedFile() does not open: the
// text that names another file, within the argument; null: none does.
Json* elsewhereOf(Json& tissues);
Json* meshOf(Json& tool);

}  // namespace trephine
