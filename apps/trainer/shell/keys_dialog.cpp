#include "shell/keys_dialog.h"

#include <QDialog>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <span>

#include "ui_kit/parts.h"

namespace trocar::trainer {
namespace {

struct Key {
  const char* keys;
  const char* does;
};
constexpr Key kTools[] = {
    {"A, S, V", "select needle, transducer or view as the active tool"},
    {"drag", "moves along the skin"},
    {"right drag", "tilts; with Shift it turns about the axis"},
    {"wheel", "needle: advance and withdraw, transducer: press harder and softer; Shift: fine steps"},
    {"arrows", "same as dragging, one millimetre per step"},
    {"Page up, down", "same as the wheel"},
    {"H", "to the planned position"},
    {"X", "locks or unlocks the active tool"},
    {"Enter", "fires the biopsy gun"},
    {"E", "ends the attempt"},
    {"Space", "stops all forces, or switches them on again"}};
constexpr Key kViews[] = {{"Ctrl+1 … 4", "layouts"},
                          {"F", "freezes the ultrasound"},
                          {"G, D", "gain, depth; with Shift less"},
                          {"C", "colour Doppler"},
                          {"M", "measures a distance; its ends can be dragged"},
                          {"Delete", "deletes the selected caliper, otherwise the last"},
                          {"T, L, B", "3D view: follow the tip, along, beside the needle"},
                          {"O, I", "3D view: guidance, landmarks"},
                          {"Tab", "next control; Space presses it, during a puncture Enter"},
                          {"Ctrl++, Ctrl+-", "larger, smaller text"},
                          {"Ctrl+R", "tries again"},
                          {"W", "worst moment of the replay"},
                          {"N, P", "next and previous event of the replay"},
                          {"Ctrl+T", "tissue parameters"},
                          {"Ctrl+B", "case builder"},
                          {"F1", "these keys"},
                          {"F8", "switches window mirroring on or off"},
                          {"F11", "full screen"}};

void add_keys(QGridLayout& grid, int column, const QString& title, std::span<const Key> keys) {
  grid.addWidget(make_label(title, "heading"), 0, column, 1, 2);
  int row = 1;
  for (const Key& key : keys) {
    grid.addWidget(make_label(QString::fromUtf8(key.keys), "badge"), row, column, Qt::AlignLeft);
    grid.addWidget(make_label(QString::fromUtf8(key.does)), row, column + 1);
    ++row;
  }
}

}  // namespace

void show_keys(QWidget* parent) {
  QDialog dialog(parent);
  dialog.setObjectName(QStringLiteral("keys"));
  dialog.setWindowTitle(QDialog::tr("Keys and mouse"));
  auto* grid = new QGridLayout(&dialog);
  grid->setContentsMargins(24, 20, 24, 20);
  grid->setHorizontalSpacing(16);
  grid->setVerticalSpacing(8);
  add_keys(*grid, 0, QDialog::tr("Tools"), kTools);
  add_keys(*grid, 2, QDialog::tr("Views and pages"), kViews);
  auto* close = make_button("close-keys", QDialog::tr("Close"), QDialog::tr("Closes this"), QStringLiteral("Esc"));
  grid->addWidget(close, grid->rowCount(), 3, Qt::AlignRight);
  QObject::connect(close, &QPushButton::clicked, &dialog, &QDialog::accept);
  dialog.exec();
}

}  // namespace trocar::trainer
