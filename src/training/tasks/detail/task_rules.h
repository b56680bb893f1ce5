#pragma once

#include "config/toml.h"
#include "config/toml_writer.h"
#include "tasks/task.h"

namespace trocar::tasks::detail {

/// Reads [entry_zone], [highest_entry] and [bevel] of a task file; what the file lacks stays as it is. Errors: an
/// unknown or missing key, a number out of its range.
Status read_rules(const config::TomlTable& document, Task& task);
/// Reads [[levels]], and gives the task the numbers of its `level`. Errors: the same, two levels of one name, a level
/// that is not there.
Status read_level_of(const config::TomlTable& document, Task& task);
/// Writes what differs from the base.
void write_rules(config::TomlWriter& writer, const Task& task, const Task& base);

/// A posture by its name; the list of `postures`, without repetitions, and its names.
Result<anatomy::Posture> read_posture(const std::string& name, const std::string& where);
Result<std::vector<anatomy::Posture>> read_postures(const config::TomlTable& path);
std::vector<std::string> names_of(const std::vector<anatomy::Posture>& postures);

/// A point [x, y, z] in mm.
Result<Vec3> read_point(const config::TomlTable& table, const char* key);

}  // namespace trocar::tasks::detail
