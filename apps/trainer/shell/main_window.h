#pragma once

#include <QMainWindow>
#include <QVariantMap>
#include <filesystem>
#include <vector>

#include "database/database_url.h"
#include "ui_kit/banner.h"

class QAction;
class QLabel;
class QMenu;
class QStackedWidget;

namespace trocar::trainer {

class BriefingPage;
class CasePage;
class MirrorStation;
class TrainerFlow;
class StartPage;
class StatusStrip;
class WorkPage;

/// The window: the pages, the bar above and the status strip below. TrainerFlow controls the transitions between pages.
class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  /// `state_folder`: folder of sessions, profiles and crash recovery data. `results`: where attempts are recorded.
  MainWindow(const std::filesystem::path& state_folder, const database::DatabaseUrl& results,
             QWidget* parent = nullptr);
  ~MainWindow() override;  ///< Ends running work before the views are destroyed.

  StartPage& start() noexcept { return *start_; }
  BriefingPage& briefing() noexcept { return *briefing_; }
  WorkPage& work() noexcept { return *work_; }
  CasePage& case_builder() noexcept { return *case_; }
  StatusStrip& strip() noexcept { return *strip_; }
  TrainerFlow& flow() noexcept { return *flow_; }
  MirrorStation& mirror() noexcept { return *mirror_; }

  /// "start", "briefing", "puncture", "feedback", "case-builder".
  void show_page(const QString& name);
  QString page() const { return page_; }
  /// Shows a banner over the pages until an empty or another text replaces it.
  void show_banner(const QString& text, BannerKind kind = BannerKind::kWarning);
  /// Shows a message over the pages for some seconds.
  void show_message(const QString& text, BannerKind kind);
  bool has_sound() const;  ///< User setting; on by default.
  /// State of the window, for scripts.
  QVariantMap facts() const;

 protected:
  void closeEvent(QCloseEvent* event) override;

 private:
  QWidget* make_top_bar();
  void add_sound(QMenu& menu);
  void fill_language_menu(QMenu& menu);
  void fill_text_menu(QMenu& menu);
  void add_shortcuts();

  QStackedWidget* pages_ = nullptr;
  StartPage* start_ = nullptr;
  BriefingPage* briefing_ = nullptr;
  WorkPage* work_ = nullptr;
  CasePage* case_ = nullptr;
  StatusStrip* strip_ = nullptr;
  QAction* sound_ = nullptr;
  Banner* banner_ = nullptr;
  QMenu* views_menu_ = nullptr;
  std::vector<QLabel*> steps_;
  TrainerFlow* flow_ = nullptr;
  MirrorStation* mirror_ = nullptr;
  QString page_;
};

}  // namespace trocar::trainer
