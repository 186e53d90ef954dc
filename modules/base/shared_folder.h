// Folders that several accounts of one machine use. What is in one that carries its group (setgid)
// and that the group may write is that group's to change; in one that everybody may write, and
// nobody take from (sticky), each has what is his own. Folders of one person are neither, and
// nothing below does anything to what lies in them. Nothing throws.
#pragma once

#include <sys/stat.h>

#include <filesystem>

namespace trephine {

bool isGroups(const std::filesystem::path& folder);
bool isEachOnesOwn(const std::filesystem::path& folder);

// Of what lies in a group's folder of that mode: the group may do what the owner may, and whoever
// may look into the folder may look at it, whatever the umask of its maker. Nothing beyond that.
mode_t modeInGroups(mode_t own, mode_t folder);
// What was made in a group's folder, with all that is in it, has that mode; a link is left alone.
// Whoever made it calls this; a file system without modes is not in the way.
void giveToGroup(const std::filesystem::path& made);
// What was made in a folder where each has his own: its group may read it, others not.
void keepOwn(const std::filesystem::path& made);

}  // namespace trephine
