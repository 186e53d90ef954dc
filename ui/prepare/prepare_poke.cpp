// Poking: a session in which nothing is cut, beside the tissues; edits of them are felt at once.
#include <algorithm>

#include "ui/common/actions.h"
#include "ui/prepare/prepare_workspace.h"

namespace trephine {

namespace {
constexpr int kPlotEvery_ms = 40;
}

void PrepareWorkspace::connectPoke() {
  poke_ = makeAction(*app_.window(), Symbol::train, "poke", tr("Poke"),
                     QKeySequence(Qt::CTRL | Qt::Key_E),
                     tr("Feel the tissue with mouse or arm; nothing is cut"));
  poke_->setCheckable(true);
  connect(poke_, &QAction::triggered, this, &PrepareWorkspace::togglePoke);
  connect(tissues_, &TissuePanel::pokeWanted, poke_, &QAction::trigger);
  connect(&workstation_, &Workstation::phaseChanged, this, &PrepareWorkspace::showPoke);
  connect(&workstation_, &Workstation::sessionStarted, this, [this] {
    if (!workstation_.isPoke()) return;
    poke_timer_.start(kPlotEvery_ms);
    layout_before_ = views_->viewLayout();  // the hand works in 3-D
    if (layout_before_->kind == ViewLayout::Kind::four) {
      views_->setLayout({ViewLayout::Kind::one_large, 0});
    }
  });
  connect(&workstation_, &Workstation::sessionEnded, this, [this](Session& session) {
    poke_timer_.stop();
    if (!session.isPoke()) return;
    showPokesOf(session);
    if (layout_before_ && here_) views_->setLayout(*layout_before_);
    layout_before_.reset();
  });
  connect(&workstation_, &Workstation::caseOpened, this,
          [this] { poke_plot_->showPokes({}, {}, 0.0); });
  connect(&poke_timer_, &QTimer::timeout, this, [this] {
    if (workstation_.isPoke() && workstation_.session()) showPokesOf(*workstation_.session());
  });
  showPoke();
}

void PrepareWorkspace::showPoke() {
  using Phase = Workstation::Phase;
  const Phase phase = workstation_.phase();
  const bool poking = phase == Phase::running && workstation_.isPoke();
  const bool ready = phase == Phase::ready && !workstation_.isOpening();
  poke_->setEnabled(poking || (ready && here_));
  poke_->setChecked(poking);
  tissues_->showPoke(poke_->isEnabled(), poking);
  const bool tab = tabs_->currentIndex() == kTissueTab;
  poke_plot_->setVisible(tab && (poking || !poke_plot_->pokes().empty()));
}

void PrepareWorkspace::togglePoke() {
  showPoke();  // as it is until it has begun or ended
  if (workstation_.isPoke()) return workstation_.stop();
  app_.beforeStart([this] {
    app_.unlessLost({AppContext::UnsavedWork::cuts}, [this] {
      if (app_.carved()) app_.showWholeCase();
      app_.go(Place::prepare);
      tabs_->setCurrentIndex(kTissueTab);
      if (const Status& drawing = view_->canDraw(); !drawing) {
        return app_.report(drawing.error());
      }
      workstation_.poke();
    });
  });
}

// The limit is that of the arm that poked last.
void PrepareWorkspace::showPokesOf(Session& session) {
  const std::vector<PokeCurve> pokes = session.pokes();
  if (pokes.empty()) return;
  const std::size_t arm = std::min(pokes.back().arm, session.exercise().arms.size() - 1);
  poke_plot_->showPokes(pokes, session.exercise().tissues,
                        session.exercise().arms[arm].max_force_N);
}

}  // namespace trephine
