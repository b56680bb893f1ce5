#pragma once

#include <string_view>

namespace trocar::link::detail {

enum class Layout { kLine, kLines };  ///< kLines: the text may contain tab, CR and newline.

/// True for valid UTF-8 (no overlong forms, surrogates or values beyond U+10FFFF) without C0, DEL and C1 control
/// characters.
bool is_plain_text(std::string_view text, Layout layout);

}  // namespace trocar::link::detail
