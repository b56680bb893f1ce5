#pragma once

#include <map>
#include <string>
#include <string_view>

#include "core/result.h"

namespace trocar::io::detail {

/// The names of numbers in a Caret label table, as TotalSegmentator writes it into a NIfTI header:
/// <Label Key="5" …>liver</Label>, also in <![CDATA[…]]>. Numbers that no label has (0 is the background, above
/// 255) are left out. Errors (at `where`): an entry without a number or an end, a number with two names, a name of more
/// than 200 letters or with control characters.
Result<std::map<int, std::string>> read_label_table(std::string_view xml, const std::string& where);

}  // namespace trocar::io::detail
