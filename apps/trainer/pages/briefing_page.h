#pragma once

#include <QWidget>
#include <array>
#include <memory>
#include <optional>

#include "cases/open_case.h"
#include "choice/trainer_choice.h"
#include "ui_kit/page_keys.h"
#include "views/slices/briefing_picture.h"

class QHBoxLayout;
class QLabel;
class QProgressBar;
class QPushButton;
class QScrollArea;
class QVBoxLayout;

namespace trocar::trainer {

/// The referral and the task as a form: patient, finding, procedure, scoring, controls, and slices through the target.
/// All that is known without the patient is there at once; finding and slices follow when the case is open. Keys: Enter
/// begins, Escape goes back.
class BriefingPage : public QWidget {
  Q_OBJECT

 public:
  explicit BriefingPage(QWidget* parent = nullptr);

  void show_opening(const TrainerChoice& choice);
  void show_progress(const QString& step, double fraction);
  void show_error(const QString& text);
  void show_case(std::shared_ptr<const cases::OpenCase> open, TrainingMode mode);
  /// Why Begin is not possible now, shown as its tooltip and beside it; empty: it is possible once a case is shown.
  void set_hindrance(const QString& reason);
  bool is_hindered() const noexcept { return !hindrance_.isEmpty(); }
  /// Pictures of the case that are still prepared, after show_case; empty: none.
  void show_later(const QString& step);

 Q_SIGNALS:
  void begin_requested();
  void back_requested();

 protected:
  void resizeEvent(QResizeEvent* event) override;
  bool eventFilter(QObject* object, QEvent* event) override;

 private:
  QWidget* make_texts();
  QWidget* make_pictures();
  QWidget* make_bottom();
  /// Scoring and controls beside the referral in a wide window, below it in a narrow one.
  void place_cards();
  /// `is_parenchymal`: see procedure_rows().
  void show_tables(const cases::Case& tables, std::optional<bool> is_parenchymal = {});
  BriefingPlane plane_of(const QLabel& label) const;
  void show_picture(QLabel& label);
  void show_legend();
  void hinder_begin();

  QLabel* title_ = nullptr;
  QLabel* subtitle_ = nullptr;
  QLabel* referral_ = nullptr;
  QLabel* procedure_ = nullptr;
  QLabel* scoring_ = nullptr;
  QLabel* controls_ = nullptr;
  QHBoxLayout* cards_ = nullptr;
  QVBoxLayout *left_ = nullptr, *right_ = nullptr;  ///< Columns of cards.
  std::array<QWidget*, 4> card_widgets_{};          ///< Referral, procedure, scoring, controls.
  QScrollArea* text_area_ = nullptr;                ///< The cards.
  QLabel* axial_ = nullptr;
  QLabel* second_ = nullptr;  ///< A slice perpendicular to the first.
  QLabel* legend_ = nullptr;
  QLabel* state_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QPushButton* begin_ = nullptr;
  QString hindrance_;
  TrainerChoice choice_;
  std::shared_ptr<const cases::OpenCase> open_;  ///< Whose slices are shown; nullptr: none.
  PageKeys keys_;
};

}  // namespace trocar::trainer
