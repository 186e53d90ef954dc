// The mouse and the keys as a hand: the tool goes where the pointer is, the wheel sets how hard it
// presses, Shift and arrow keys tilt it, Tab takes the other hand: both stay where they are until
// the pointer moves. Of simulated arms alone: a hand that a real arm holds is never the pointer's;
// what it sends is recorded by the session.
#pragma once

#include <QObject>
#include <QPointF>
#include <optional>
#include <vector>

#include "session/session.h"
#include "ui/views/view_widget.h"

namespace trephine {

class PointerHands : public QObject {
  Q_OBJECT
 public:
  explicit PointerHands(ViewWidget& view);

  // An exercise has started; its hands rest until the pointer comes into the view, or a script has
  // them. Null: it is over.
  void begin(Session* session);
  // Once a picture: where the pointer is the tissue may have changed.
  void follow() {
    if (!stays_) send();
  }

  // The arm that the pointer has, and how hard it presses.
  std::size_t active() const { return active_; }
  double push_N() const;
  double mostPush_N() const;
  // Somebody has pointed since the exercise began.
  bool taken() const { return last_.has_value(); }
  void takeOther();
  // All hands have gone back to where they began, and stay there until the pointer moves.
  void goneBack();
  void setPush(double push_N);

 signals:
  void changed();  // active(), push_N(), taken()

 private:
  void letGo();
  std::size_t nextSimulated() const;
  // False where real arms have all hands.
  bool hasHand() const { return session_ && session_->isSimulated(active_); }
  bool holds();
  void point(const QPointF& to);
  std::optional<QPointF>& place() { return places_[active_]; }
  void send();
  void step(int right, int up);
  void tilt(int right, int up);

  ViewWidget& view_;
  Session* session_ = nullptr;
  std::size_t active_ = 0;
  std::vector<std::optional<QPointF>> places_{std::nullopt};  // of each hand, in the view
  std::optional<QPointF> last_;                               // of any hand
  bool stays_ = false;  // where it is, until the pointer moves
};

}  // namespace trephine
