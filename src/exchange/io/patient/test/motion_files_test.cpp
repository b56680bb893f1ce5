// The motion model in a patient folder: restored to the bit, replaced as a whole, and damage is noticed.
#include "io/patient/motion_files.h"

#include <gtest/gtest.h>

#include "io/test/test_support.h"
#include "motion/testing/sliding_motion.h"

namespace trocar::io {
namespace {

using testing::read_bytes, testing::write_bytes;

std::shared_ptr<const motion::MotionModel> model(double shift_mm) {
  using namespace motion::testing;
  volume::FloatGrid border(lattice_around({0.5, 0.0, 0.0}, 90.0, 30.0));
  for (std::size_t n = 0; n < border.voxels.size(); ++n)
    border.voxels[n] = static_cast<float>(border.geometry.centre_mm(border.geometry.index_of(n)).x() / 3.0);
  motion::MotionParts parts =
      sliding_parts(border, {uniform({0.0, -0.0, -shift_mm}), bump({1.0 / 3.0, 8.0, 0.1}, Vec3(0.0, -30.0, 7.0), 40.0)},
                    lattice_around({1.125, -2.25, 0.0}, 80.0, 8.0));
  parts.source = "for a \"test\"";
  parts.liver_mm = 24.4;
  parts.at_ct = {0.1, 0.3};
  return made(std::move(parts));
}

TEST(MotionFiles, RestoreTheModelToTheBit) {
  const TemporaryFolder folder;
  const auto none = load_motion_model(folder.path());
  ASSERT_TRUE(none);
  EXPECT_EQ(*none, nullptr);
  for (const double shift_mm : {15.0, 17.3}) {  // the second one replaces the first
    const auto saved = model(shift_mm);
    const Status status = save_motion_model(*saved, folder.path());
    ASSERT_TRUE(status) << status.error().text();
    const auto loaded = load_motion_model(folder.path());
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_EQ((*loaded)->hash(), saved->hash());
    EXPECT_EQ((*loaded)->parts().source, saved->parts().source);
    EXPECT_EQ((*loaded)->parts().modes, saved->parts().modes);
  }
}

TEST(MotionFiles, NoticeWhatIsMissingOrOfAnotherModel) {
  const TemporaryFolder folder, other;
  const auto error_after = [&](const std::string& name, const std::string& bytes) {
    EXPECT_TRUE(save_motion_model(*model(15.0), folder.path()));
    write_bytes(folder / name, bytes);
    const auto loaded = load_motion_model(folder.path());
    return loaded ? std::string("loaded") : loaded.error().text();
  };
  ASSERT_TRUE(save_motion_model(*model(16.0), other.path()));
  for (const char* const name : {"motion_modes.nrrd", "motion_border.nrrd"}) {
    EXPECT_NE(error_after(name, "").find(name), std::string::npos);
    const std::string bytes = read_bytes(other / name);
    EXPECT_NE(error_after(name, bytes.substr(0, bytes.size() / 2)), "loaded") << name;
  }
  EXPECT_NE(error_after("motion_modes.nrrd", read_bytes(other / "motion_modes.nrrd")).find("another model"),
            std::string::npos);
  EXPECT_NE(error_after("motion.toml", read_bytes(other / "motion.toml")).find("another model"), std::string::npos);
  EXPECT_NE(error_after("motion.toml", "format = 1\n").find("older"), std::string::npos);
}

}  // namespace
}  // namespace trocar::io
