#include "ui_kit/theme.h"

#include <QApplication>
#include <QPalette>
#include <QRegularExpression>
#include <QSettings>
#include <QString>
#include <QStyleFactory>
#include <algorithm>

namespace trocar::trainer {
namespace {

constexpr const char* kTextSizeKey = "window/text_percent";

/// The style sheet with @names for colours, and @ before sizes that scale with the selected text size.
constexpr const char* kSheet = R"(
* { outline: none; }
QWidget { color: @text; background: transparent; selection-background-color: @accent; selection-color: @ground; }
QMainWindow, QDialog, QStackedWidget, QMessageBox { background: @ground; }
QToolTip { background: @raised; color: @text; border: 1px solid @line; padding: 4px 6px; }
QLabel[role="title"] { font-size: @22pt; font-weight: 600; }
QLabel[role="heading"] { font-size: @13pt; font-weight: 600; }
QLabel[role="brand"] { font-size: @12pt; font-weight: 700; }
QLabel[role="dim"] { color: @dim; }
QLabel[role="badge"] { background: @raised; border-radius: 9px; padding: 2px 10px; color: @dim; }
QLabel[role="alarm"] { background: #c8322d; color: white; border-radius: 6px; padding: 8px 12px; font-weight: 600; }
QFrame[role="card"] { background: @panel; border: 1px solid @line; border-radius: 8px; }
QFrame[role="card"][chosen="true"] { border: 2px solid @accent; }
QFrame[role="bar"] { background: @panel; border: none; }
QPushButton, QToolButton { background: @raised; border: 1px solid @line; border-radius: 6px; padding: 6px 14px; min-height: 18px; }
QToolButton { padding: 5px 9px; }
QPushButton:hover, QToolButton:hover { border-color: @accent; }
QPushButton:pressed, QToolButton:pressed { background: @line; }
QPushButton:focus, QToolButton:focus { border-color: @accent; }
QPushButton:checked, QToolButton:checked { background: @pressed; border-color: @accent; color: @text; }
QPushButton:disabled, QToolButton:disabled { color: @faint; background: @panel; }
QPushButton[role="primary"] { background: @accent; color: @ground; border-color: @accent; font-weight: 600; padding: 9px 26px; }
QPushButton[role="primary"]:hover { background: @bright; }
QPushButton[role="primary"]:disabled { background: @raised; color: @faint; border-color: @line; }
QPushButton[role="stop"] { background: #c8322d; color: white; border: 2px solid #e0524d; font-weight: 700; padding: 6px 22px; }
QPushButton[role="stop"]:disabled { background: @panel; border-color: @line; color: @faint; }
QPushButton[role="stop"]:hover { background: #e0423c; }
QToolButton::menu-indicator { image: none; }
QLineEdit, QSpinBox, QDoubleSpinBox, QComboBox, QPlainTextEdit, QTextEdit { background: @raised; border: 1px solid @line; border-radius: 5px; padding: 4px 8px; min-height: 18px; }
QLineEdit:focus, QSpinBox:focus, QDoubleSpinBox:focus, QComboBox:focus { border-color: @accent; }
QSpinBox::up-button, QSpinBox::down-button, QDoubleSpinBox::up-button, QDoubleSpinBox::down-button { width: 0; border: none; }
QComboBox::drop-down { border: none; background: transparent; width: 22px; }
QComboBox QAbstractItemView { background: @raised; border: 1px solid @line; padding: 2px; }
QCheckBox, QRadioButton { spacing: 8px; padding: 3px 5px; }
QCheckBox::indicator, QRadioButton::indicator { width: 15px; height: 15px; background: @raised; border: 1px solid @line; border-radius: 4px; }
QRadioButton::indicator { border-radius: 8px; }
QCheckBox::indicator:checked, QRadioButton::indicator:checked { background: @accent; border-color: @accent; }
QCheckBox::indicator:focus, QRadioButton::indicator:focus { border-color: @accent; }
QSlider::groove:horizontal { height: 4px; background: @line; border-radius: 2px; }
QSlider::sub-page:horizontal { background: @accent; border-radius: 2px; }
QSlider::handle:horizontal { width: 14px; height: 14px; margin: -5px 0; border-radius: 7px; background: @text; }
QSlider::groove:vertical { width: 4px; background: @line; border-radius: 2px; }
QSlider::add-page:vertical { background: @accent; border-radius: 2px; }
QSlider::handle:vertical { width: 14px; height: 14px; margin: 0 -5px; border-radius: 7px; background: @text; }
QSlider::handle:focus { background: @accent; }
QComboBox::down-arrow { width: 0; height: 0; border-left: 5px solid @raised; border-right: 5px solid @raised; border-top: 6px solid @dim; }
QComboBox::down-arrow:disabled { border-top-color: @line; }
QProgressBar { background: @raised; border: none; border-radius: 4px; height: 8px; text-align: center; color: transparent; }
QProgressBar::chunk { background: @accent; border-radius: 4px; }
QTabWidget::pane { border: none; }
QTabBar::tab { background: transparent; padding: 7px 14px; border-bottom: 2px solid transparent; color: @dim; }
QTabBar::tab:selected { color: @text; border-bottom-color: @accent; }
QListView, QTreeView, QTableView { background: @panel; border: 1px solid @line; border-radius: 6px; alternate-background-color: @raised; }
QListView::item, QTreeView::item { padding: 4px; border: none; background: transparent; }
QListView::item:selected, QTreeView::item:selected, QTableView::item:selected { background: @pressed; color: @text; }
QHeaderView::section { background: @raised; border: none; border-right: 1px solid @line; padding: 5px 8px; color: @dim; }
QMenu { background: @raised; border: 1px solid @line; padding: 4px; }
QMenu::item { padding: 5px 26px 5px 14px; border-radius: 4px; }
QMenu::item:selected { background: @pressed; }
QMenu::separator { height: 1px; background: @line; margin: 4px 8px; }
QScrollArea { border: none; }
QScrollBar:vertical { background: transparent; width: 10px; margin: 0; }
QScrollBar:horizontal { background: transparent; height: 10px; margin: 0; }
QScrollBar::handle { background: @line; border-radius: 4px; min-height: 24px; min-width: 24px; margin: 1px; }
QScrollBar::handle:hover { background: @dim; }
QScrollBar::add-line, QScrollBar::sub-line { width: 0; height: 0; }
QScrollBar::add-page, QScrollBar::sub-page { background: transparent; }
QSplitter::handle, QMainWindow::separator { background: @ground; width: 5px; height: 5px; }
QMainWindow::separator:hover { background: @accent; }
QDockWidget { titlebar-close-icon: none; titlebar-normal-icon: none; }
QStatusBar { background: @panel; }
)";

QColor mixed(const QColor& a, const QColor& b, double share_of_b) {
  const auto mix = [&](int x, int y) { return static_cast<int>(x + share_of_b * (y - x)); };
  return {mix(a.red(), b.red()), mix(a.green(), b.green()), mix(a.blue(), b.blue())};
}

/// Point sizes of the style sheet for the selected text size.
QString with_text_size(QString sheet, int text_percent) {
  static const QRegularExpression points(QStringLiteral("@(\\d+)pt"));
  for (auto found = points.match(sheet); found.hasMatch(); found = points.match(sheet))
    sheet.replace(found.capturedStart(), found.capturedLength(),
                  QStringLiteral("%1pt").arg(0.01 * text_percent * found.captured(1).toInt(), 0, 'f', 1));
  return sheet;
}

QString style_sheet(const Theme& t, int text_percent) {
  QString sheet = with_text_size(QString::fromLatin1(kSheet), text_percent);
  const std::pair<const char*, QColor> names[] = {
      {"@ground", t.ground},
      {"@panel", t.panel},
      {"@raised", t.raised},
      {"@line", t.line},
      {"@text", t.text},
      {"@dim", t.dim},
      {"@bright", t.accent.lighter(115)},
      {"@accent", t.accent},
      {"@warning", t.warning},
      {"@bad", t.bad},
      {"@pressed", mixed(t.raised, t.accent, 0.35)},
      {"@faint", mixed(t.panel, t.dim, 0.55)},
  };
  for (const auto& [name, color] : names) sheet.replace(QString::fromLatin1(name), color.name());
  return sheet;
}

}  // namespace

const Theme& theme() noexcept {
  static const Theme the_theme;
  return the_theme;
}

void apply_theme(QApplication& application, int text_percent) {
  const Theme& t = theme();
  static const QFont system_font = QApplication::font();
  QFont font = system_font;
  font.setPointSizeF(0.01 * text_percent * system_font.pointSizeF());
  QApplication::setFont(font);
  QApplication::setStyle(QStyleFactory::create(QStringLiteral("Fusion")));
  QPalette palette;
  palette.setColor(QPalette::Window, t.ground);
  palette.setColor(QPalette::Base, t.panel);
  palette.setColor(QPalette::AlternateBase, t.raised);
  palette.setColor(QPalette::Button, t.raised);
  for (const QPalette::ColorRole role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
    palette.setColor(role, t.text);
  palette.setColor(QPalette::Highlight, t.accent);
  palette.setColor(QPalette::HighlightedText, t.ground);
  palette.setColor(QPalette::PlaceholderText, t.dim);
  palette.setColor(QPalette::Link, t.accent);
  QApplication::setPalette(palette);
  application.setStyleSheet(style_sheet(t, text_percent));
}

int kept_text_percent() {
  const int kept = QSettings().value(QString::fromLatin1(kTextSizeKey), kPlainText_percent).toInt();
  return std::find(std::begin(kTextPercents), std::end(kTextPercents), kept) != std::end(kTextPercents)
             ? kept
             : kPlainText_percent;
}

void choose_text_percent(int percent) {
  QSettings().setValue(QString::fromLatin1(kTextSizeKey), percent);
  apply_theme(*qApp, percent);
}

QFont scaled_font(double factor, bool is_bold) {
  QFont font = QApplication::font();
  font.setPointSizeF(font.pointSizeF() * factor);
  font.setBold(is_bold);
  return font;
}

}  // namespace trocar::trainer
