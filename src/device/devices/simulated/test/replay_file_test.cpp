#include <gtest/gtest.h>

#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "devices/simulated/replay_device.h"

namespace trocar::devices {
namespace {

constexpr const char* kHeader = "time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz\n";

class ReplayFile : public ::testing::Test {
 protected:
  /// The message for a file of this text; empty: it is read.
  std::string refusal(const std::string& text) const {
    const auto path = folder_ / "motion.csv";
    EXPECT_TRUE(write_file_atomically(path, text));
    const auto motion = read_motion(path);
    return motion ? "" : motion.error().what;
  }
  TemporaryFolder folder_;
};

TEST_F(ReplayFile, RoundTripsItsPoses) {
  RecordedMotion motion;
  motion.rate_hz = 500.0;
  for (int i = 0; i < 3001; ++i)
    motion.poses.emplace_back(rotation_from_vector({0.001 * i, -0.3, 1.0}), Vec3(i / 3.0, 1e-7 * i, -1.0 / 7));
  ASSERT_TRUE(write_motion(motion, folder_ / "motion.csv"));
  const auto read = read_motion(folder_ / "motion.csv");
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->rate_hz, 500.0);
  ASSERT_EQ(read->poses.size(), motion.poses.size());
  for (std::size_t n = 0; n < motion.poses.size(); ++n) {
    ASSERT_EQ(read->poses[n].p(), motion.poses[n].p()) << n;
    ASSERT_LT((read->poses[n].R() - motion.poses[n].R()).norm(), 1e-14) << n;
  }
}

TEST_F(ReplayFile, NamesTheLineThatIsDamaged) {
  const std::string first = "0,1,2,3,1,0,0,0\n", second = "0.001,1,2,3,1,0,0,0\n";
  EXPECT_EQ(refusal(kHeader + first + second), "");
  EXPECT_EQ(refusal(kHeader + first + "0.001,1,2,3,1,0,0,0\r\n"), "") << "lines of another system";
  EXPECT_EQ(refusal(""), "not a recorded motion: line 1 is not time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz");
  EXPECT_EQ(refusal("x,y\n" + first), "not a recorded motion: line 1 is not time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz");
  EXPECT_EQ(refusal(kHeader), "fewer than two poses");
  EXPECT_EQ(refusal(kHeader + first), "fewer than two poses");
  EXPECT_EQ(refusal(kHeader + first + "0.001,1,2,3,1,0,0\n"),
            "line 3: 7 fields, not 8: commas separate them, numbers have a decimal point");
  EXPECT_EQ(refusal(kHeader + first + "0.001,1,nan,3,1,0,0,0\n"), "line 3: column y_mm: 'nan' is not a finite number");
  EXPECT_EQ(refusal(kHeader + first + "0.001,1,2,3,1,0,0,0,9\n"),
            "line 3: 9 fields, not 8: commas separate them, numbers have a decimal point");
  struct Case {
    const char *row, *what;
  };
  for (const Case& c : std::vector<Case>{
           {"", "fewer than two poses"},
           {"0.001,1.0x,2,3,1,0,0,0", "line 3: column x_mm: '1.0x' is not a finite number"},
           {"0.001,1,inf,3,1,0,0,0", "line 3: column y_mm: 'inf' is not a finite number"},
           {"0.001,1,2,,1,0,0,0", "line 3: column z_mm: '' is not a finite number"},
           {"0.001,1,2,3,1,0,0, 0", "line 3: column qz: ' 0' is not a finite number"},
           {"0.001,1e999,2,3,1,0,0,0", "line 3: column x_mm: '1e999' is not a finite number"},
           {"\"0.001,1,2,3,1,0,0,0", "a quotation does not end"},
           {"0,001,1,2,3,1,0,0,0", "line 3: 9 fields, not 8: commas separate them, numbers have a decimal point"},
       })
    EXPECT_EQ(refusal(kHeader + first + c.row + "\n"), c.what) << c.row;
  EXPECT_EQ(refusal(kHeader + first + "0.001,1,2,3,0,0,0,0\n"), "line 3: column qw: the quaternion's length is not 1");
  EXPECT_EQ(refusal(kHeader + first + first), "line 3: column time_s: the steps in time are not equal");
  EXPECT_EQ(refusal(kHeader + first + second + "0.003,1,2,3,1,0,0,0\n"),
            "line 4: column time_s: the steps in time are not equal");
}

}  // namespace
}  // namespace trocar::devices
