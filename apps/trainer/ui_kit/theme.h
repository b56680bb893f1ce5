#pragma once

#include <QColor>
#include <QFont>

class QApplication;

namespace trocar::trainer {

/// The palette of the program. Custom-painted widgets use its colours directly; all others use the style sheet that is
/// generated from it. Text has a contrast of at least 4.5 to its background (WCAG 2.1, AA).
struct Theme {
  QColor ground{0x10, 0x14, 0x1a};  ///< Background of the window.
  QColor view{0x08, 0x0a, 0x0d};    ///< Background of images.
  QColor panel{0x18, 0x1e, 0x27};
  QColor raised{0x24, 0x2d, 0x39};  ///< Buttons, fields.
  QColor line{0x35, 0x41, 0x50};
  QColor text{0xe8, 0xed, 0xf3};
  QColor dim{0x9a, 0xa8, 0xb9};  ///< Captions, units.
  QColor accent{0x4f, 0xb3, 0xd9};
  QColor good{0x57, 0xc7, 0x8b};
  QColor warning{0xf2, 0xb6, 0x3c};
  QColor bad{0xf4, 0x7c, 0x77};
  // Colours of planes and tools, the same in all views.
  QColor axial{0xe0, 0x5a, 0x5a};
  QColor coronal{0x5f, 0xc4, 0x6f};
  QColor sagittal{0xe3, 0xc5, 0x4a};
  QColor along_needle{0x7a, 0xa2, 0xff};  ///< The planes of NeedlePlane.
  QColor turned_needle{0xc0, 0x8c, 0xf2};
  QColor across_needle{0xf0, 0x8f, 0xb6};
  QColor needle{0xd8, 0xe2, 0xee};
  QColor path{0x54, 0xd1, 0xc4};  ///< The expert's path.
  QColor target{0xff, 0x8a, 0x3d};
};
const Theme& theme() noexcept;

/// Selectable text sizes, in percent of the system's font.
inline constexpr int kTextPercents[] = {90, 100, 115, 130, 150};
inline constexpr int kPlainText_percent = 100;

/// Sets style, palette, font and style sheet of the program; call it again for another text size.
void apply_theme(QApplication& application, int text_percent = kPlainText_percent);
/// The text size that the user selected last, else 100.
int kept_text_percent();
/// Sets the text size of the whole program and stores it for the next start.
void choose_text_percent(int percent);
/// The program's font, scaled by a factor.
QFont scaled_font(double factor, bool is_bold = false);

}  // namespace trocar::trainer
