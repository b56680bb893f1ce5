#include "phantom/phantom_data.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "anatomy/known_structures.h"
#include "core/testing/changed_file.h"
#include "core/testing/data_folder.h"
#include "phantom/layered/layer_scene.h"
#include "phantom/phantom.h"

namespace trocar::phantom {
namespace {

using trocar::testing::load_changed;
using trocar::testing::OwnDataFolder;

constexpr PhantomResolution kCoarsest{{40, 32, 24}};

struct Change {
  std::string_view from, to, message;
};

template <class Load>
void expect_refused(std::string_view file, const Change& change, const Load& load) {
  const auto data = load_changed(data_dir() / file, change.from, change.to, load);
  ASSERT_FALSE(data) << change.to;
  EXPECT_NE(data.error().text().find(change.message), std::string::npos) << data.error().text();
  EXPECT_NE(data.error().where.find(std::filesystem::path(file).filename().string()), std::string::npos)
      << data.error().text();
}

TEST(AbdomenData, MatchesTheFile) {
  const auto data = load_abdomen_data(data_dir() / kAbdomenFile);
  ASSERT_TRUE(data) << data.error().text();
  EXPECT_EQ(data->spine.height(0), 230.0F);
  EXPECT_EQ(data->spine.height(12), -130.0F);
  EXPECT_EQ(data->spine.height(13), data->spine.height(12));
  EXPECT_EQ(data->ribs.end_deg(5), 140.0F);
  EXPECT_EQ(data->ribs.end_deg(12), 50.0F);
  EXPECT_EQ(data->ribs.outward_mm, 6.3F);
  EXPECT_EQ(data->colon.course.size(), 27U);
  EXPECT_EQ(data->colon.hanging_knots, (std::array<std::size_t, 2>{6, 9}));
  EXPECT_EQ(data->aorta.branches.size(), 9U);
  EXPECT_EQ(data->portal_vein.course.back().p, data->liver.hilum);
  EXPECT_EQ(data->gallbladder.x_mm.low, -54.0);
  EXPECT_EQ(data->lumbar_vertebra.spinous.size(), 4U);
  EXPECT_FLOAT_EQ(data->torso.skin.erector.centre, 0.48869219F);  // 28 degrees
}

TEST(AbdomenData, EveryKeyIsNeeded) {
  // Removes one line "key = value" after the other.
  const std::string text = *read_file(data_dir() / kAbdomenFile);
  std::istringstream lines(text);
  std::size_t begin = 0;
  int removed = 0;
  for (std::string line; std::getline(lines, line); begin += line.size() + 1) {
    if (line.starts_with("[phases.")) break;  // its keys are labels, any of them
    const std::size_t equals = line.find(" = ");
    if (equals == std::string::npos || line.ends_with('[') || line.starts_with('#')) continue;
    const std::string key = line.substr(0, equals);
    const TemporaryFolder folder;
    ASSERT_TRUE(
        write_file_atomically(folder / "abdomen.toml", text.substr(0, begin) + text.substr(begin + line.size())));
    const auto data = load_abdomen_data(folder / "abdomen.toml");
    ASSERT_FALSE(data) << key;
    EXPECT_NE(data.error().where.find(key), std::string::npos) << data.error().text();
    ++removed;
  }
  EXPECT_GT(removed, 150);
}

TEST(AbdomenData, RefusesWrongNumbersWithTheirLocation) {
  for (const Change& change : std::initializer_list<Change>{
           {"outward_mm = 6.3", "outward_mm = nan", "ribs.outward_mm"},
           {"outward_mm = 6.3", "outward_mm = \"6.3\"", "ribs.outward_mm"},
           {"outward_mm = 6.3", "outward_mm = 6300.0", "from -1000 to 1000"},
           {"half_thickness_mm = 3.2", "half_thickness_mm = 0.0", "ribs.half_thickness_mm"},
           {"98.0, 50.0]  #", "98.0]  #", "has 7 numbers, not 8"},
           {"203.0, 176.0", "176.0, 203.0", "do not go down"},
           {"half_width_mm = [156.0, 166.0]", "half_width_mm = [166.0, 156.0]", "low end is above"},
           {"size = [0.94, 1.06]", "size = [0.0, 1.06]", "spleen.size"},
           {"waist_z = [6.0, -45.0, 50.0]", "waist_z = [6.0, -45.0, 0.0]", "torso.skin.waist_z"},
           {"chest_taper_z = [3.0, 60.0, 125.0]", "chest_taper_z = [3.0, 60.0, 60.0]", "both ends are the same"},
           {"centre = [106.0, 34.0, 36.0]", "centre = [106.0, 34.0]", "has 2 numbers, not 3"},
           {"[62.0, 18.0, 56.0, 26.0]", "[62.0, 18.0, 56.0]", "row 1 is not"},
           {"[62.0, 18.0, 56.0, 26.0]", "[62.0, 18.0, 56.0, -26.0]", "stomach.course"},
           {"[6.0, 152.0, 84.0, 173.0, 112.0]", "[4.0, 152.0, 84.0, 173.0, 112.0]", "no such rib"},
           {"hanging_knots = [7, 10]", "hanging_knots = [7, 28]", "no such knots"},
           {"hanging_knots = [7, 10]", "hanging_knots = [0, 10]", "no such knots"},
           {"columns = 6", "columns = 6.5", "a whole number"},
           {"columns = 6", "columns = 3", "too short"},
           {"radius_spread_mm = 2.8", "radius_spread_mm = 11.0", "thinner than nothing"},
           {"direction = [-0.6, -0.2, 0.7]", "direction = [0.0, 0.0, 0.0]", "direction is zero"},
           {"[spleen]", "[spleen]\nweight = 1.0", "unknown key"},
           {"[spleen]", "[milt]", "spleen"}})
    expect_refused(kAbdomenFile, change, load_abdomen_data);
}

TEST(LayerData, MatchesTheFile) {
  const auto data = load_layer_data(data_dir() / kLayersFile);
  ASSERT_TRUE(data) << data.error().text();
  EXPECT_EQ(data->lumbar.epidural, 51.2F);
  EXPECT_EQ(data->ascites.gas_loops_z, (std::array<float, 2>{28.5F, -28.5F}));
  EXPECT_EQ(data->liver.vein_radius, 4.5F);
}

TEST(LayerData, RefusesWrongNumbersWithTheirLocation) {
  for (const Change& change :
       std::initializer_list<Change>{{"dura_mm = 57.2", "", "lumbar.dura_mm"},
                                     {"dura_mm = 57.2", "dura_mm = 75.0", "do not follow each other"},
                                     {"duct_radius_mm = 3.0", "duct_radius_mm = -3.0", "liver.duct_radius_mm"},
                                     {"skin_mm = 2.0", "skin_mm = inf", "cover.skin_mm"},
                                     {"[ascites]", "[ascite]", "ascites"}})
    expect_refused(kLayersFile, change, load_layer_data);
}

TEST(PhantomDataFiles, AreNamedWhenMissing) {
  const OwnDataFolder own;
  own.remove(kAbdomenFile);
  const auto abdomen = generate_phantom("abdomen", 1, kCoarsest);
  ASSERT_FALSE(abdomen);
  EXPECT_NE(abdomen.error().where.find("abdomen.toml"), std::string::npos) << abdomen.error().text();
  EXPECT_TRUE(generate_phantom("layers-liver", 1, kCoarsest));
  own.remove(kLayersFile);
  const auto layers = generate_phantom("layers-liver", 1, kCoarsest);
  ASSERT_FALSE(layers);
  EXPECT_NE(layers.error().where.find("layers.toml"), std::string::npos) << layers.error().text();
}

TEST(PhantomDataFiles, AStructureThatIsNotKnownIsNamed) {
  const OwnDataFolder own;
  own.change(anatomy::kStructuresFile, "\"gallbladder\"", "\"gallblader\"");
  own.change(anatomy::kStructuresFile, "\"bile_duct#\", \"bile_ducts\", ", "");
  for (const auto& [patient, name] :
       {std::pair("abdomen", "\"gallbladder\""), std::pair("layers-liver", "\"bile_duct\"")}) {
    const auto made = generate_phantom(patient, 1, kCoarsest);
    ASSERT_FALSE(made) << patient;
    EXPECT_NE(made.error().what.find(name), std::string::npos) << made.error().text();
    EXPECT_NE(made.error().where.find("structures.toml"), std::string::npos) << made.error().text();
  }
}

TEST(PhantomDataFiles, ChangeThePatient) {
  const auto before = generate_phantom("layers-liver", 1, kCoarsest);
  const OwnDataFolder own;
  own.change(kLayersFile, "duct_mm = 58.0", "duct_mm = 50.0");
  const auto after = generate_phantom("layers-liver", 1, kCoarsest);
  ASSERT_TRUE(before && after);
  EXPECT_NE(before->content_hash, after->content_hash);
  EXPECT_DOUBLE_EQ(before->paths[0].line_P.length_mm() - after->paths[0].line_P.length_mm(), 8.0);
}

}  // namespace
}  // namespace trocar::phantom
