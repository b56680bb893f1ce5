#include "io/markups_file.h"

#include <cmath>

#include "io/test/test_support.h"

namespace trocar::io {
namespace {

using testing::write_bytes;

std::string markups(const std::string& inside) {
  return R"({"@schema": "markups-schema-v1.0.3.json#", "markups": [{)" + inside + "}]}";
}

class Markups : public ::testing::Test {
 protected:
  Result<std::vector<anatomy::Landmark>> landmarks_of(const std::string& text) {
    write_bytes(folder_ / "x.mrk.json", text);
    return read_landmarks(folder_ / "x.mrk.json");
  }
  Result<std::vector<anatomy::NeedlePath>> paths_of(const std::string& text) {
    write_bytes(folder_ / "x.mrk.json", text);
    return read_paths(folder_ / "x.mrk.json");
  }
  TemporaryFolder folder_;
};

TEST_F(Markups, RoundTripLandmarks) {
  const std::vector<anatomy::Landmark> landmarks = {{"left \"rib\" 9", {1.0 / 3.0, -2.5e-7, 1234.5}}, {"", {0, 0, 0}}};
  ASSERT_TRUE(write_landmarks(landmarks, folder_ / "l.mrk.json"));
  const auto read = read_landmarks(folder_ / "l.mrk.json");
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->size(), 2U);
  EXPECT_EQ((*read)[0].name, landmarks[0].name);
  EXPECT_EQ((*read)[0].p_P, landmarks[0].p_P);
}

TEST_F(Markups, RoundTripPaths) {
  const std::vector<anatomy::NeedlePath> paths = {{"intercostal", {{1, 2, 3}, {4, 5, 6.125}}},
                                                  {"b", {{0, 0, 0}, {0, 0, 9}}}};
  ASSERT_TRUE(write_paths(paths, folder_ / "p.mrk.json"));
  const auto read = read_paths(folder_ / "p.mrk.json");
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->size(), 2U);
  EXPECT_EQ((*read)[0].name, "intercostal");
  EXPECT_EQ((*read)[0].line_P.a, paths[0].line_P.a);
  EXPECT_EQ((*read)[0].line_P.b, paths[0].line_P.b);
}

TEST_F(Markups, ReadCurvesWithTheirPoints) {
  const auto read = [&](const std::string& text) {
    write_bytes(folder_ / "c.mrk.json", text);
    return read_markup_points(folder_ / "c.mrk.json");
  };
  const std::string points = R"("controlPoints": [{"position": [1, 2, 3]}, {"position": [4, 5, 6]}])";
  const auto both = read(R"({"markups": [{"type": "Curve", "name": "catheter", "coordinateSystem": "RAS", )" + points +
                         R"(}, {"type": "Plane"}, {"type": "Fiducial", "name": "marker", )" + points + "}]}");
  ASSERT_TRUE(both) << both.error().text();
  ASSERT_EQ(both->size(), 2U);
  EXPECT_EQ((*both)[0].name, "catheter");
  EXPECT_FALSE((*both)[0].is_list);
  EXPECT_EQ((*both)[0].points_P[1], Vec3(-4, -5, 6));
  EXPECT_TRUE((*both)[1].is_list);
  EXPECT_EQ((*both)[1].points_P.size(), 2U);
  EXPECT_FALSE(read(R"({"markups": [{"type": "Curve", "controlPoints": [{"position": [1, 2, 3]}]}]})"));
  EXPECT_FALSE(read(R"({"markups": [{"type": "Plane"}]})"));
}

TEST_F(Markups, ConvertRasToLps) {
  const std::string points = R"("controlPoints": [{"label": "a", "position": [1, 2, 3]}])";
  const auto ras = landmarks_of(markups(R"("type": "Fiducial", "coordinateSystem": "RAS", )" + points));
  const auto lps = landmarks_of(markups(R"("type": "Fiducial", "coordinateSystem": "LPS", )" + points));
  const auto unsaid = landmarks_of(markups(R"("type": "Fiducial", )" + points));
  ASSERT_TRUE(ras && lps && unsaid);
  EXPECT_EQ((*ras)[0].p_P, Vec3(-1, -2, 3));
  EXPECT_EQ((*lps)[0].p_P, Vec3(1, 2, 3));
  EXPECT_EQ((*unsaid)[0].p_P, Vec3(1, 2, 3));  // the schema's default is LPS
}

TEST_F(Markups, SkipUnplacedPoints) {
  const auto read = landmarks_of(markups(
      R"("type": "Fiducial", "controlPoints": [{"label": "a", "positionStatus": "undefined"},
         {"label": "b", "positionStatus": "defined", "position": [1, 2, 3]}])"));
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->size(), 1U);
  EXPECT_EQ((*read)[0].name, "b");
}

TEST_F(Markups, RefuseUnknownCoordinateSystems) {
  for (const char* text :
       {R"("type": "Fiducial", "coordinateSystem": "HFS", "controlPoints": [])",
        R"("type": "Fiducial", "coordinateSystem": 0, "controlPoints": [])",
        R"("type": "Fiducial", "coordinateSystem": null, "controlPoints": [])",
        R"("type": "Fiducial", "coordinateSystem": ["RAS"], "controlPoints": [])",
        R"("type": "Fiducial", "coordinateUnits": "um", "controlPoints": [])",
        R"("type": "Fiducial", "coordinateUnits": null, "controlPoints": [])",
        R"("type": "Fiducial", "coordinateUnits": ["cm"], "controlPoints": [])", R"("type": 1, "controlPoints": [])",
        R"("type": "Fiducial", "controlPoints": [{"position": [1, 2, 3], "positionStatus": 0}])",
        R"("type": "Fiducial", "controlPoints": [{"position": [1, 2]}])",
        R"("type": "Fiducial", "controlPoints": [{"position": [1, 2, "x"]}])",
        R"("type": "Fiducial", "controlPoints": [{"position": [1, 2, 1e300]}])",
        R"("type": "Fiducial", "controlPoints": [7])", R"("type": "Fiducial", "controlPoints": {"a": 1})"})
    EXPECT_FALSE(landmarks_of(markups(text))) << text;
  for (const char* text : {"", "[]", "7", "null", R"({"markups": 7})", R"({"markups": [7]})", "{"})
    EXPECT_FALSE(landmarks_of(text)) << text;
}

TEST_F(Markups, RequireTwoPointsInALine) {
  EXPECT_FALSE(paths_of(markups(R"("type": "Line", "controlPoints": [{"position": [1, 2, 3]}])")));
  EXPECT_FALSE(
      paths_of(markups(R"("type": "Line", "controlPoints": [{"position": [1, 2, 3]}, {"position": [1, 2, 3]}])")));
  const auto none = paths_of(markups(R"("type": "Fiducial", "controlPoints": [{"position": [1, 2, 3]}])"));
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->empty());
}

TEST_F(Markups, RefuseToWriteNonFinitePoints) {
  EXPECT_FALSE(write_landmarks({{"a", Vec3::Constant(std::nan(""))}}, folder_ / "l.mrk.json"));
  EXPECT_TRUE(folder_.is_empty());
}

}  // namespace
}  // namespace trocar::io
