#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string_view>

#include "core/files/folders.h"
#include "tasks/needle.h"
#include "tasks/task.h"

namespace trocar::testing {

inline std::filesystem::path tasks_folder() {
  return data_dir() / "tasks";
}
/// The task of the data folder.
inline tasks::Task liver_biopsy() {
  auto task = tasks::load_task(tasks_folder(), "liver-biopsy");
  EXPECT_TRUE(task) << (task ? "" : task.error().text());
  return task.value_or(tasks::Task{});
}
/// A needle of the data folder.
inline tasks::Needle shipped_needle(std::string_view name = "biopsy-18g") {
  auto needle = tasks::load_needle(data_dir() / "needles.toml", name);
  EXPECT_TRUE(needle) << (needle ? "" : needle.error().text());
  return needle.value_or(tasks::Needle{});
}

}  // namespace trocar::testing
