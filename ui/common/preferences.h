// How a person likes to work here, a row each: kept from one session to the next (settings.h), set in
// the dialogs of settings and of headset and screens. Nothing of a patient. Window's thread.
#pragma once

#include "base/field.h"
#include "base/tr.h"
#include "headset/stereo_screen.h"
#include "ui/common/colours.h"
#include "ui/common/settings.h"

namespace trephine {

enum class Language { en, zh_TW };
enum class MainHand { right, left };
template <class Kind, std::size_t N>
using PreferenceNames = std::array<std::pair<std::string_view, Kind>, N>;
inline constexpr PreferenceNames<Language, 2> kLanguages{
    {{"en", Language::en}, {"zh_TW", Language::zh_TW}}};
inline constexpr PreferenceNames<colours::Theme, 2> kThemes{
    {{"dark", colours::Theme::dark}, {"light", colours::Theme::light}}};
inline constexpr PreferenceNames<MainHand, 2> kMainHands{
    {{"right", MainHand::right}, {"left", MainHand::left}}};
inline constexpr PreferenceNames<Packing, 3> kPackings{{{"half", Packing::half},
                                                         {"full", Packing::full},
                                                         {"top_bottom", Packing::top_bottom}}};

struct Preferences {
  Language language = Language::en;
  colours::Theme theme = colours::Theme::dark;
  int text_percent = 100;
  double arms_most_N = 40.0;  // beside the exercise's own limit
  MainHand main_hand = MainHand::right;  // that the mouse takes first
  double push_step_N = 0.2;   // a notch of the wheel
  double key_step_mm = 1.0;   // an arrow key
  bool research = false;      // exercises for comparison with others' work are listed
  // Where the patient stands before the eyes in a headset, and how large.
  double headset_ahead_m = 0.4, headset_below_m = 0.2, headset_scale = 1.0;
  bool headset_mirror = false;  // the window shows the left eye
  // Two pictures on one screen.
  Packing packing = Packing::half;
  double eyes_mm = 63.0, screen_mm = 600.0;
};

// A preference on its form; of a number with its step and decimals there, and the unit that it is
// shown in.
constexpr FieldRow preferenceRow(const char* key, const Range& range, const char* label,
                                 double step = 0.0, int decimals = -1, const char* shown_unit = "",
                                 double shown_per = 1.0) {
  return {key, range, Given::may_be, "", label, "", "", step, decimals, shown_unit, shown_per};
}

inline constexpr FieldOf<Preferences> kWorkFields[] = {
    {preferenceRow("language", {}, trLater("&Language of exercises")),
     oneOf<&Preferences::language, kLanguages>()},
    {preferenceRow("theme", {}, trLater("&Theme")), oneOf<&Preferences::theme, kThemes>()},
    {preferenceRow("text_percent", {80, 200, "%"}, trLater("Size of te&xt"), 10.0),
     &Preferences::text_percent},
    {preferenceRow("arms/most_N", {0.5, 40, "N"}, trLater("An arm &gives at most"), 0.5, 1),
     &Preferences::arms_most_N},
    {preferenceRow("hands/main", {}, trLater("The mouse &begins with the")),
     oneOf<&Preferences::main_hand, kMainHands>()},
    {preferenceRow("mouse/push_step_N", {0.05, 1, "N"},
                   trLater("One notch of the &wheel pushes by"), 0.05, 2),
     &Preferences::push_step_N},
    {preferenceRow("keys/step_mm", {0.1, 5, "mm"}, trLater("An &arrow key moves by"), 0.5, 1),
     &Preferences::key_step_mm},
    {preferenceRow("exercises/research", {}, trLater("List exercises for &research")),
     &Preferences::research},
};
inline constexpr FieldOf<Preferences> kHeadsetFields[] = {
    {preferenceRow("headset/ahead_m", {0.2, 2, "m"},
                   trLater("The patient is so far &ahead of the eyes"), 5.0, 0, "cm", 100.0),
     &Preferences::headset_ahead_m},
    {preferenceRow("headset/below_m", {0, 1, "m"}, trLater("and so far &below them"), 5.0, 0, "cm",
                   100.0),
     &Preferences::headset_below_m},
    {preferenceRow("headset/scale", {0.25, 8}, trLater("Of the size in &life"), 25.0, 0, "%",
                   100.0),
     &Preferences::headset_scale},
    {preferenceRow("headset/mirror", {}, trLater("The &window shows what the left eye sees")),
     &Preferences::headset_mirror},
};
inline constexpr FieldOf<Preferences> kScreenFields[] = {
    {preferenceRow("stereo/packing", {}, trLater("&Pictures")),
     oneOf<&Preferences::packing, kPackings>()},
    {preferenceRow("stereo/eyes_mm", {40, 80, "mm"}, trLater("The &eyes are apart by"), 1.0, 1),
     &Preferences::eyes_mm},
    {preferenceRow("stereo/screen_mm", {100, 20000, "mm"}, trLater("The screen is &distant by"),
                   10.0, 0, "cm", 0.1),
     &Preferences::screen_mm},
};

// Those that are kept; one that is none of a field's values is as it is at first.
Preferences preferences();
void keepPreferences(const Preferences& preferences);
// The language of texts that are in several, as exercises and pages of help call it.
std::string languageInUse();

}  // namespace trephine
