#include "shell/keys_dialog.h"

#include <QDialog>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <span>
#include <vector>

#include "ui_kit/parts.h"
#include "workspace/workspace.h"

namespace trocar::trainer {
namespace {

struct Key {
  const char* keys;
  const char* does;
};
constexpr Key kTools[] = {
    {"A, S, P, V", "select needle, transducer, palpating finger or view as the active tool"},
    {"click, Backspace", "finger: marks the skin (also Enter), removes the last mark"},
    {"drag", "moves along the skin"},
    {"right drag", "tilts; with Shift it turns about the axis"},
    {"wheel", "needle: advance and withdraw, transducer: press harder and softer; Shift: fine steps"},
    {"arrows", "same as dragging, one millimetre per step"},
    {"Page up, down", "same as the wheel"},
    {"H", "to the planned position"},
    {"X", "locks or unlocks the active tool"},
    {"Enter", "fires the biopsy gun"},
    {"N", "local anaesthetic"},
    {"Y", "draws the stylet, or puts it back; takes the core out and loads the gun"},
    {"Q", "aspirates"},
    {"W", "advances the guide wire"},
    {"U", "the patient holds the breath, or breathes again"},
    {"E", "ends the attempt"},
    {"Space", "stops all forces, or switches them on again"}};
constexpr Key kPages[] = {{"Tab", "next control; Space presses it, during a puncture Enter"},
                          {"Ctrl++, Ctrl+-", "larger, smaller text"},
                          {"Ctrl+R", "tries again; after an exam, begins another"},
                          {"W", "worst moment of the replay"},
                          {"N, P", "next and previous event of the replay"},
                          {"H", "next hint's moment in the replay"},
                          {"Ctrl+T", "tissue parameters"},
                          {"Ctrl+B", "case builder"},
                          {"F1", "these keys"},
                          {"F8", "switches window mirroring on or off"},
                          {"F11", "full screen"}};

using Keys = std::vector<ViewKeys>;

void append(Keys& keys, std::span<const Key> more) {
  for (const Key& key : more) keys.push_back({QString::fromUtf8(key.keys), QString::fromUtf8(key.does)});
}

Keys keys_of_views_and_pages(const Workspace& workspace) {
  Keys keys{{QStringLiteral("Ctrl+1 … %1").arg(workspace.layouts().size()), QStringLiteral("layouts")}};
  for (const ViewDescription& view : workspace.registry().views())
    keys.insert(keys.end(), view.keys.begin(), view.keys.end());
  append(keys, kPages);
  return keys;
}

void add_keys(QGridLayout& grid, int column, const QString& title, const Keys& keys) {
  grid.addWidget(make_label(title, "heading"), 0, column, 1, 2);
  int row = 1;
  for (const ViewKeys& key : keys) {
    grid.addWidget(make_label(key.keys, "badge"), row, column, Qt::AlignLeft);
    grid.addWidget(make_label(key.action), row, column + 1);
    ++row;
  }
}

}  // namespace

void show_keys(QWidget* parent, const Workspace& workspace) {
  QDialog dialog(parent);
  dialog.setObjectName(QStringLiteral("keys"));
  dialog.setWindowTitle(QDialog::tr("Keys and mouse"));
  auto* grid = new QGridLayout(&dialog);
  grid->setContentsMargins(24, 20, 24, 20);
  grid->setHorizontalSpacing(16);
  grid->setVerticalSpacing(8);
  Keys tools;
  append(tools, kTools);
  add_keys(*grid, 0, QDialog::tr("Tools"), tools);
  add_keys(*grid, 2, QDialog::tr("Views and pages"), keys_of_views_and_pages(workspace));
  auto* close = make_button("close-keys", QDialog::tr("Close"), QDialog::tr("Closes this"), QStringLiteral("Esc"));
  grid->addWidget(close, grid->rowCount(), 3, Qt::AlignRight);
  QObject::connect(close, &QPushButton::clicked, &dialog, &QDialog::accept);
  dialog.exec();
}

}  // namespace trocar::trainer
