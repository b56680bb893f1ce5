#include "choice/difficulty.h"

namespace trocar::trainer {

const char* name_of(Difficulty difficulty) noexcept {
  constexpr std::array kNames{"guided", "assisted", "exam"};
  return kNames[static_cast<std::size_t>(difficulty)];
}

const char* title_of(Difficulty difficulty) noexcept {
  constexpr std::array kTitles{"Guided", "Assisted", "Exam"};
  return kTitles[static_cast<std::size_t>(difficulty)];
}

const char* help_text_of(Difficulty difficulty) noexcept {
  constexpr std::array kTexts{"Expert path, entry zone, target, guide line and hints.",
                              "Entry zone, target and hints, without the path.", "Images and forces only."};
  return kTexts[static_cast<std::size_t>(difficulty)];
}

}  // namespace trocar::trainer
