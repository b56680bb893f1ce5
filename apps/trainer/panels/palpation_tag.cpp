#include "panels/palpation_tag.h"

#include <QFontMetrics>
#include <QPainter>
#include <algorithm>
#include <cmath>

#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

constexpr int kTagMargin_px = 8, kBarHeight_px = 8, kGapAboveBar_px = 4;
constexpr double kFullBar_n_per_mm = 2.0 * haptics::kHard_n_per_mm;

}  // namespace

PalpationTag::PalpationTag(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("palpation-tag"));
  setAttribute(Qt::WA_TransparentForMouseEvents);
  hide();
}

QColor PalpationTag::color_of(haptics::Hardness hardness) {
  switch (hardness) {
    case haptics::Hardness::kSoft:
      return theme().good;
    case haptics::Hardness::kFirm:
      return theme().warning;
    case haptics::Hardness::kHard:
      break;
  }
  return theme().bad;
}

QString PalpationTag::words_of(const haptics::Palpation& felt, bool says_below) {
  QString words = tr("Hard");
  switch (haptics::hardness_of(felt)) {
    case haptics::Hardness::kSoft:
      words = tr("Soft");
      break;
    case haptics::Hardness::kFirm:
      words = tr("Firm");
      break;
    case haptics::Hardness::kHard:
      break;
  }
  if (!says_below) return words;
  return felt.bone_mm ? tr("%1: bone %2 mm below the skin").arg(words).arg(*felt.bone_mm, 0, 'f', 0)
                      : tr("%1: no bone straight below").arg(words);
}

void PalpationTag::show_felt(const haptics::Palpation& felt, bool says_below) {
  felt_ = felt;
  words_ = words_of(felt, says_below);
  figure_ = tr("yields %1 mm to %2 N").arg(felt.pressed_mm, 0, 'f', 0).arg(haptics::kPalpating_n, 0, 'f', 0);
  setAccessibleName(words_);
  resize(sizeHint());
  show();
  update();
}

QSize PalpationTag::sizeHint() const {
  const QFontMetrics metrics = fontMetrics();
  const int width = std::max({metrics.horizontalAdvance(words_), metrics.horizontalAdvance(figure_), 90});
  return {width + 2 * kTagMargin_px, 2 * metrics.lineSpacing() + kBarHeight_px + kGapAboveBar_px + 2 * kTagMargin_px};
}

void PalpationTag::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(theme().line);
  QColor ground = theme().view;
  ground.setAlphaF(0.85F);
  painter.setBrush(ground);
  painter.drawRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), 6.0, 6.0);
  const int line = fontMetrics().lineSpacing();
  const QRect inside = rect().adjusted(kTagMargin_px, kTagMargin_px, -kTagMargin_px, -kTagMargin_px);
  painter.setPen(theme().text);
  painter.drawText(inside.left(), inside.top() + fontMetrics().ascent(), words_);
  painter.setPen(theme().dim);
  painter.drawText(inside.left(), inside.top() + line + fontMetrics().ascent(), figure_);
  const QRectF bar(inside.left(), inside.bottom() - kBarHeight_px + 1, inside.width(), kBarHeight_px);
  const double share = std::clamp(felt_.stiffness_n_per_mm / kFullBar_n_per_mm, 0.03, 1.0);
  painter.setPen(Qt::NoPen);
  painter.setBrush(theme().raised);
  painter.drawRoundedRect(bar, 3.0, 3.0);
  painter.setBrush(color_of(haptics::hardness_of(felt_)));
  painter.drawRoundedRect(QRectF(bar.topLeft(), QSizeF(share * bar.width(), bar.height())), 3.0, 3.0);
}

}  // namespace trocar::trainer
