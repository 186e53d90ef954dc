// Cards that stand in the scene, for a picture that has no panel around it: what a person reads
// there. Every method that says so needs the context to be current, and changes OpenGL's state
// behind VTK's back.
#pragma once

#include <vector>

#include "render/canvas.h"
#include "render/card.h"
#include "render/composer.h"
#include "render/view_camera.h"

namespace trephine {

class CardDrawing {
 public:
  // These and no others. What is shown of each stays until it is drawn otherwise.
  void show(std::vector<Card> cards);
  bool empty() const { return cards_.empty(); }
  // Into the framebuffer that is bound, of this size; tissue in front of a card hides it. Context
  // current.
  void draw(const ViewCamera& camera, int width, int height, const Canvas* volume,
            const Span& span);
  void release();  // context current

 private:
  struct Shown {
    Card card;
    unsigned int texture = 0;
    bool sent = false;
  };
  bool prepare();
  void send(Shown& shown);

  std::vector<Shown> cards_;
  std::vector<unsigned int> left_over_;  // textures of cards that are gone
  unsigned int program_ = 0, array_ = 0, buffer_ = 0;
  bool refused_ = false;  // the program, by the driver
};

}  // namespace trephine
