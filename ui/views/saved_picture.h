// A picture as it leaves the window: what it is for stands below it. Window's thread.
#pragma once

#include "render/picture.h"

namespace trephine {

// The same picture, and below it a strip with purposeText(), which hides none of it. As small as
// can be read; smaller where the picture is narrow. What is no picture stays so.
Picture withPurpose(const Picture& picture);

}  // namespace trephine
