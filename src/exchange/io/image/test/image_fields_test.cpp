#include "io/image/image_file.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {

using testing::numbered_grid;
using testing::oblique_geometry;
using testing::read_bytes;

TEST(ImageFields, RoundTripThroughNrrd) {
  const TemporaryFolder folder;
  const volume::LabelGrid grid = numbered_grid<std::uint8_t>(oblique_geometry());
  const ImageFields fields{{"trocar.fan.radius_mm", "40.5"}, {"trocar_axis", "+z; a = b: c"}, {"empty", ""}};
  ASSERT_TRUE(write_image(grid, folder / "sweep.nrrd", fields));
  EXPECT_NE(read_bytes(folder / "sweep.nrrd").find("trocar.fan.radius_mm:=40.5\n"), std::string::npos);
  const auto read = read_image_fields(folder / "sweep.nrrd");
  ASSERT_TRUE(read) << read.error().text();
  ImageFields with_text = fields;
  with_text.erase("empty");
  for (const auto& [key, value] : with_text) EXPECT_EQ(read->at(key), value);
  for (const auto& [key, value] : *read) EXPECT_TRUE(fields.contains(key)) << key;
  const auto image = read_labels(folder / "sweep.nrrd");
  ASSERT_TRUE(image) << image.error().text();
  EXPECT_EQ(image->voxels, grid.voxels);
  EXPECT_TRUE(image->geometry.matches(grid.geometry));
}

TEST(ImageFields, AreEmptyIfAbsent) {
  const TemporaryFolder folder;
  const volume::LabelGrid grid = numbered_grid<std::uint8_t>(oblique_geometry());
  for (const char* name : {"a.nrrd", "a.nii.gz", "a.mha"}) {
    ASSERT_TRUE(write_image(grid, folder / name));
    const auto read = read_image_fields(folder / name);
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_TRUE(read->empty()) << name;
  }
  EXPECT_FALSE(read_image_fields(folder / "none.nrrd"));
}

TEST(ImageFields, RefuseUnrepresentableEntries) {
  const TemporaryFolder folder;
  const volume::LabelGrid grid = numbered_grid<std::uint8_t>(oblique_geometry());
  EXPECT_FALSE(write_image(grid, folder / "a.nii.gz", {{"key", "value"}}));
  for (const ImageFields& fields : {ImageFields{{"two words", "v"}}, ImageFields{{"", "v"}}, ImageFields{{"a:=b", "v"}},
                                    ImageFields{{"k", "a\nb"}}, ImageFields{{"NRRD_space", "v"}}})
    EXPECT_FALSE(write_image(grid, folder / "a.nrrd", fields)) << fields.begin()->first;
  EXPECT_FALSE(std::filesystem::exists(folder / "a.nrrd"));
}

}  // namespace
}  // namespace trocar::io
