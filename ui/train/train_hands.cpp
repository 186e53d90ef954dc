// How mouse and keys move a hand of a simulated arm.
#include "ui/train/train_workspace.h"

namespace trephine {

std::size_t TrainWorkspace::armOf(Hand hand) const {
  const std::vector<SceneArm>& arms = workstation_.scene()->arms;
  const std::string name = hand == Hand::right ? "right" : "left";
  for (std::size_t i = 0; i < arms.size(); ++i) {
    if (arms[i].name == name) return i;
  }
  return hand == Hand::right ? arms.size() - 1 : 0;  // a lone arm answers to both
}

void TrainWorkspace::moveHand(Hand hand, const Vec3& by_mm) {
  Session* session = workstation_.session();
  if (!session) return;
  session->moveHand(armOf(hand), by_mm);
  placeHandPoints();
}

void TrainWorkspace::placeHandPoints() {
  const Session* session = workstation_.session();
  for (Hand hand : {Hand::left, Hand::right}) {
    view_->setHandPoint(hand, session->handTarget_mm(armOf(hand)));
  }
}

}  // namespace trephine
