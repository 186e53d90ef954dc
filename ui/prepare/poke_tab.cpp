#include "ui/prepare/poke_tab.h"

#include <algorithm>

#include "ui/common/actions.h"

namespace trephine {

namespace {
constexpr int kPlotEvery_ms = 40;
}

PokeTab::PokeTab(Workstation& workstation, Messages& messages, WorkGuards& guards,
                 CaseViews& case_views, TissuePanel& tissues, PokePlot& plot, QObject* parent)
    : QObject(parent),
      workstation_(workstation),
      messages_(messages),
      guards_(guards),
      case_views_(case_views),
      views_(&case_views.views()),
      view_(&case_views.view()),
      tissues_(tissues),
      plot_(plot),
      forecast_(workstation, this) {
  for (const auto changed : {&Workstation::exerciseChanged, &Workstation::armsAnswered}) {
    connect(&workstation_, changed, this, &PokeTab::renewForecast);
  }
  connect(&forecast_, &PokeForecast::changed, this, &PokeTab::showForecast);
  connect(&tissues_, &TissuePanel::chosenChanged, this, &PokeTab::showForecast);
  action_ = makeAction(*messages_.window(), Symbol::train, "poke", tr("Poke"), Qt::CTRL | Qt::Key_E,
                       tr("Feel the tissue with mouse or arm; nothing is cut"));
  action_->setCheckable(true);
  connect(action_, &QAction::triggered, this, &PokeTab::toggle);
  connect(&tissues_, &TissuePanel::pokeWanted, action_, &QAction::trigger);
  connect(&workstation_, &Workstation::phaseChanged, this, &PokeTab::refresh);
  connect(&workstation_, &Workstation::sessionStarted, this, [this] {
    if (!workstation_.isPoke()) return;
    timer_.start(kPlotEvery_ms);
    layout_before_ = views_->viewLayout();  // the hand works in 3-D
    if (layout_before_->kind == ViewLayout::Kind::four) {
      views_->setLayout({ViewLayout::Kind::one_large, 0});
    }
  });
  connect(&workstation_, &Workstation::sessionEnded, this, [this](Session& session) {
    timer_.stop();
    if (!session.isPoke()) return;
    showPokes(session);
    if (layout_before_ && here_) views_->setLayout(*layout_before_);
    layout_before_.reset();
  });
  connect(&workstation_, &Workstation::caseOpened, this,
          [this] { plot_.showPokes({}, {}, 0.0); });
  connect(&timer_, &QTimer::timeout, this, [this] {
    if (workstation_.isPoke() && workstation_.session()) showPokes(*workstation_.session());
  });
}

void PokeTab::show(bool here, bool in_front) {
  here_ = here;
  in_front_ = in_front;
  forecast_.setShown(here && in_front);
  refresh();
}

void PokeTab::showForecast() {
  plot_.showForeseen(forecast_.of(tissues_.chosen()), forecast_.friction_N());
  tissues_.setHidden(forecast_.hiddenWords(tissues_.chosen()));
  refresh();
}

void PokeTab::refresh() {
  using Phase = Workstation::Phase;
  const Phase phase = workstation_.phase();
  const bool poking = phase == Phase::running && workstation_.isPoke();
  const bool ready = phase == Phase::ready && !workstation_.isOpening();
  action_->setEnabled(poking || (ready && here_));
  action_->setChecked(poking);
  tissues_.showPoke(action_->isEnabled(), poking);
  plot_.setVisible(in_front_ && (poking || !plot_.pokes().empty() || !plot_.foreseen().empty()));
}

void PokeTab::toggle() {
  refresh();  // as it is until it has begun or ended
  if (workstation_.isPoke()) return workstation_.stop();
  guards_.beforeStart([this] {
    guards_.unlessLost({UnsavedWork::cuts}, [this] {
      if (case_views_.carved()) case_views_.showWholeCase();
      emit frontWanted();
      if (const Status& drawing = view_->canDraw(); !drawing) {
        return messages_.report(drawing.error());
      }
      workstation_.poke();
    });
  });
}

// The limit is that of the arm that poked last.
void PokeTab::showPokes(Session& session) {
  const std::vector<PokeCurve> pokes = session.pokes();
  if (pokes.empty()) return;
  const std::size_t arm = std::min(pokes.back().arm, session.exercise().arms.size() - 1);
  plot_.showPokes(pokes, session.exercise().tissues,
                        session.exercise().arms[arm].max_force_N);
}

}  // namespace trephine
