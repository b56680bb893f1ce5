#include "choice/training_mode.h"

#include <QtGlobal>

namespace trocar::trainer {

const char* name_of(TrainingMode mode) noexcept {
  constexpr std::array kNames{"guided", "assisted", "exam"};
  return kNames[static_cast<std::size_t>(mode)];
}

const char* title_of(TrainingMode mode) noexcept {
  constexpr std::array kTitles{QT_TRANSLATE_NOOP("Table", "Guided"), QT_TRANSLATE_NOOP("Table", "Assisted"),
                               QT_TRANSLATE_NOOP("Table", "Exam")};
  return kTitles[static_cast<std::size_t>(mode)];
}

const char* help_text_of(TrainingMode mode) noexcept {
  constexpr std::array kTexts{QT_TRANSLATE_NOOP("Table", "Expert path, entry zone, target, guide line and hints."),
                              QT_TRANSLATE_NOOP("Table", "Entry zone, target and hints, without the path."),
                              QT_TRANSLATE_NOOP("Table", "Images and forces only.")};
  return kTexts[static_cast<std::size_t>(mode)];
}

}  // namespace trocar::trainer
