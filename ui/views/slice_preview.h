// Looks through a stack slice by slice: slider, wheel, arrow keys, Page Up/Down, Home, End, and HU
// windows (keys 1 to 5, which with Page Up/Down work wherever in the window the focus is, except
// in a field that takes them). It asks for the slice it wants and shows what it is given; the
// picture before stays until then. Looking never changes a volume.
#pragma once

#include <QButtonGroup>
#include <QLabel>
#include <QSlider>
#include <QToolButton>

#include "imaging/steps/couch.h"
#include "ui/views/slice_canvas.h"

namespace trephine {

class SlicePreview : public QWidget {
  Q_OBJECT
 public:
  explicit SlicePreview(QWidget* parent = nullptr);

  // Another stack of `count` slices, looked at in its middle; wants that slice. `direction` as in
  // SliceCanvas.
  void showStack(int count, const std::optional<Mat3>& direction = {});
  void showNothing(const QString& why);
  // Another part than before is looked at with its usual HU window.
  void setBodyPart(const std::string& body_part);
  // `picture` of slice `index`, or why there is none. Shown only while it is the one wanted, or on
  // the way there, so that a quick hand sees the slices go by.
  void showSlice(int index, const Result<SlicePicture>& picture);
  int index() const { return slider_->value(); }
  SliceCanvas& canvas() { return *canvas_; }
  // Whether a part of the slices can be chosen: by a box that is drawn while its button is down.
  void setCroppable(bool croppable);

 signals:
  void sliceWanted(int index);

 protected:
  void wheelEvent(QWheelEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;

 private:
  void showPosition();
  void showWindow();

  SliceCanvas* canvas_;
  QSlider* slider_;
  QLabel* position_;
  QButtonGroup* windows_;
  QLabel* window_;
  QToolButton* box_;
  std::optional<std::string> body_part_;
  bool croppable_ = false;
  int turned_ = 0;  // of the wheel, since the last whole notch
};

// Slice `k` of a volume that was read; empty outside.
SlicePicture sliceOf(const Volume& volume, int k);
// Where in that slice something would go with the couch, for SliceCanvas::setMarked; null where
// nothing would. `couch` is of this volume.
QImage couchMask(const CouchFinding& couch, const Volume& volume, int k);

}  // namespace trephine
