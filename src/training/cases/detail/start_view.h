#pragma once

namespace trocar::cases::detail {

// A transducer that the program places on the skin before an attempt.
inline constexpr const char* kLesionView = "liver-lesion";
inline constexpr int kLines = 33;         ///< Scanlines of the examined image.
inline constexpr double kSlope_mm = 6.0;  ///< The skin's normal is averaged over a patch of this size.
inline constexpr double kPress_mm = 3.0;  ///< Depth of the face in the skin.
inline constexpr double kTouching = 0.8;  ///< Share of the scanlines that must have contact.

}  // namespace trocar::cases::detail
