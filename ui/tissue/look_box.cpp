#include "ui/tissue/look_box.h"

#include "ui/common/words.h"

namespace trephine {

LookBox::LookBox(QWidget* parent) : QComboBox(parent) {
  // By number of TissueLook.
  addItems({tr("Shown"), tr("Ghosted"), tr("Hidden")});
  setToolTip(tr("In the views only: what is felt and cut stays as it is"));
  connect(this, &QComboBox::activated, this, [this](int look) {
    if (chosen) chosen(TissueLook(look));
  });
}

void LookBox::show(const Tissue& tissue, TissueLook look) {
  setObjectName(toQt("look:" + tissue.id));
  setAccessibleName(tr("Look of %1").arg(toQt(tissue.name)));
  setCurrentIndex(int(look));
}

}  // namespace trephine
