// The order in which Tab goes through widgets.
#pragma once

class QLayout;

namespace trephine {

// Tab goes through what a layout holds as it is laid out, whatever was made first.
void tabInOrder(QLayout& layout);

}  // namespace trephine
