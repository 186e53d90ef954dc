// What an edit of the exercise is called where it can be taken back. The window's thread.
#pragma once

#include <QString>
#include <string>

namespace trephine {

// `what`: as it was given to Desk::edit(), "threshold:Bone" or "exercise name"; what stands before
// a colon counts. Of a kind that is not known it is "a number of a tissue".
QString editWords(const std::string& what);

}  // namespace trephine
