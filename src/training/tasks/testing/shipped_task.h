#pragma once

#include <string_view>

#include "core/files/data_dir.h"
#include "tasks/needle.h"
#include "tasks/task.h"

namespace trocar::testing {

inline tasks::Task liver_biopsy() {
  return *tasks::load_task(data_dir() / "tasks", "liver-biopsy");
}
inline tasks::Needle shipped_needle(std::string_view name = "biopsy-18g") {
  return *tasks::load_needle(data_dir() / "needles.toml", name);
}

}  // namespace trocar::testing
