#include "config/sourced_number.h"

namespace trocar::config {

Result<SourcedNumber> read_sourced_number(const TomlTable& table, std::string_view key, Range allowed) {
  TROCAR_TRY(const TomlTable entry, table.table(key));
  TROCAR_TRY_STATUS(entry.check_keys({"value", "source", "range"}));
  SourcedNumber number;
  TROCAR_TRY(number.value, entry.number("value", allowed));
  TROCAR_TRY(number.source, entry.string("source"));
  if (number.source.empty()) return fail("the source is empty", entry.where(), "state where the number comes from");
  if (entry.has("range")) {
    TROCAR_TRY(const std::vector<double> range, entry.numbers("range", allowed));
    if (range.size() != 2 || range[0] > number.value || number.value > range[1])
      return fail("the range must be [low, high] around the value", entry.where(), "correct the range, or remove it");
    number.range = Range{range[0], range[1]};
  } else if (number.source.starts_with("assumed")) {
    return fail("an assumed number must give its range", entry.where(), "add range = [low, high]");
  }
  return number;
}

}  // namespace trocar::config
