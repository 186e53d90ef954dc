#include "ui/prepare/edit_words.h"

#include <QCoreApplication>
#include <utility>

namespace trephine {

namespace {

// What an edit is called where it can be taken back: by what stands before the colon.
constexpr std::pair<const char*, const char*> kEditWords[] = {
    {"threshold", QT_TRANSLATE_NOOP("trephine::EditWords", "HU of a tissue")},
    {"hu", QT_TRANSLATE_NOOP("trephine::EditWords", "HU of a tissue")},
    {"opacity", QT_TRANSLATE_NOOP("trephine::EditWords", "opacity")},
    {"colour", QT_TRANSLATE_NOOP("trephine::EditWords", "colour")},
    {"name", QT_TRANSLATE_NOOP("trephine::EditWords", "the name of a tissue")},
    {"set name", QT_TRANSLATE_NOOP("trephine::EditWords", "the name of the set")},
    {"where", QT_TRANSLATE_NOOP("trephine::EditWords", "where a tissue is")},
    {"add tissue", QT_TRANSLATE_NOOP("trephine::EditWords", "a new tissue")},
    {"remove tissue", QT_TRANSLATE_NOOP("trephine::EditWords", "a tissue removed")},
    {"set", QT_TRANSLATE_NOOP("trephine::EditWords", "another set of tissues")},
    {"elsewhere", QT_TRANSLATE_NOOP("trephine::EditWords", "the set for other cases")},
    {"revert", QT_TRANSLATE_NOOP("trephine::EditWords", "the set reverted")},
    {"entry", QT_TRANSLATE_NOOP("trephine::EditWords", "the entry point")},
    {"landmark name", QT_TRANSLATE_NOOP("trephine::EditWords", "the name of a landmark")},
    {"landmark", QT_TRANSLATE_NOOP("trephine::EditWords", "a landmark")},
    {"add landmark", QT_TRANSLATE_NOOP("trephine::EditWords", "a new landmark")},
    {"remove landmark", QT_TRANSLATE_NOOP("trephine::EditWords", "a landmark removed")},
    {"tool name", QT_TRANSLATE_NOOP("trephine::EditWords", "the name of a tool")},
    {"tool", QT_TRANSLATE_NOOP("trephine::EditWords", "a tool")},
    {"add tool", QT_TRANSLATE_NOOP("trephine::EditWords", "a new tool")},
    {"remove tool", QT_TRANSLATE_NOOP("trephine::EditWords", "a tool removed")},
    {"arm", QT_TRANSLATE_NOOP("trephine::EditWords", "an arm")},
    {"workspace", QT_TRANSLATE_NOOP("trephine::EditWords", "where an arm is")},
    {"add arm", QT_TRANSLATE_NOOP("trephine::EditWords", "a new arm")},
    {"remove arm", QT_TRANSLATE_NOOP("trephine::EditWords", "an arm removed")},
    {"laws", QT_TRANSLATE_NOOP("trephine::EditWords", "what is felt")},
    {"controller", QT_TRANSLATE_NOOP("trephine::EditWords", "the controller")},
    {"force_at", QT_TRANSLATE_NOOP("trephine::EditWords", "where the force acts")},
    {"removal", QT_TRANSLATE_NOOP("trephine::EditWords", "how tissue is removed")},
    {"touch_by_points", QT_TRANSLATE_NOOP("trephine::EditWords", "what is touched by points")},
    {"rate_hz", QT_TRANSLATE_NOOP("trephine::EditWords", "the rate")},
    {"exercise name", QT_TRANSLATE_NOOP("trephine::EditWords", "the name of the exercise")},
    {"exercise anatomy", QT_TRANSLATE_NOOP("trephine::EditWords", "the part of the body")},
    {"exercise structures", QT_TRANSLATE_NOOP("trephine::EditWords", "the structures it needs")},
    {"operator", QT_TRANSLATE_NOOP("trephine::EditWords", "the script")},
    {"view landmark", QT_TRANSLATE_NOOP("trephine::EditWords", "what is looked at")},
    {"view distance_mm", QT_TRANSLATE_NOOP("trephine::EditWords", "the distance of the eye")},
    {"looks", QT_TRANSLATE_NOOP("trephine::EditWords", "the looks it begins with")},
    {"card", QT_TRANSLATE_NOOP("trephine::EditWords", "the card")},
    {"card on", QT_TRANSLATE_NOOP("trephine::EditWords", "the card")},
    {"outline", QT_TRANSLATE_NOOP("trephine::EditWords", "the outline")},
    {"outline off", QT_TRANSLATE_NOOP("trephine::EditWords", "the outline")},
    {"outline closed", QT_TRANSLATE_NOOP("trephine::EditWords", "the outline")},
    {"outline width_mm", QT_TRANSLATE_NOOP("trephine::EditWords", "the outline")},
    {"locks", QT_TRANSLATE_NOOP("trephine::EditWords", "what stays")},
};

}  // namespace

QString editWords(const std::string& what) {
  const std::string of = what.substr(0, what.find(':'));
  for (const auto& [edit, words] : kEditWords) {
    if (of == edit) return QCoreApplication::translate("trephine::EditWords", words);
  }
  return QCoreApplication::translate("trephine::EditWords", "a number of a tissue");
}

}  // namespace trephine
