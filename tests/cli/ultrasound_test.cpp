// trocar ultrasound: pictures and sweeps of a small test scene, and what cannot be.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "cli/program.h"
#include "core/files/output_file.h"
#include "core/text.h"
#include "geometry/pose.h"
#include "io/image/image_file.h"
#include "io/sequence/transform_file.h"
#include "lab/volume/correlation.h"
#include "volume/sampling.h"

namespace trocar::cli_test {
namespace {

/// Onto the skin of "layers-liver" (entered from the front): y of T to the back, x to the head, pressed in by 8 mm.
const std::string kScene = " --patient layers-liver";
const std::string kQuick = " --lines 64 --samples 256 --planes 1 --looks 1 --depth-mm 60";

std::string place_on_scene(const TemporaryFolder& folder, const Vec3& p_P = {0.0, 8.0, 0.0}) {
  Mat3 R_PT;
  R_PT << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  std::string path = folder / ("pose" + std::to_string(static_cast<int>(p_P.y())) + ".tfm");
  EXPECT_TRUE(io::write_transform(Pose(R_PT, p_P), path));
  return path;
}

std::string text_of_file(const std::string& path) {
  const auto bytes = read_file(path);
  return bytes ? *bytes : std::string();
}

std::size_t files_in(const TemporaryFolder& folder) {
  const auto list = std::filesystem::directory_iterator(folder.path());
  return static_cast<std::size_t>(std::distance(begin(list), end(list)));
}

TEST(UltrasoundImage, IsTheSameForTheSameSeed) {
  const TemporaryFolder folder;
  const std::string line = "ultrasound image" + kScene + kQuick + " --pose " + place_on_scene(folder);
  for (const std::string name : {"a.png --seed 3", "b.png --seed 3", "c.png --seed 4"}) {
    const Outcome outcome = trocar(line + " --out " + (folder / name));
    EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
    // The scene is a small block: the fan reaches beyond it, which is the only thing to warn of.
    EXPECT_EQ(outcome.err.find("touch"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(text_of_file(folder / "a.png").substr(1, 3), "PNG");
  EXPECT_EQ(text_of_file(folder / "a.png"), text_of_file(folder / "b.png"));
  EXPECT_NE(text_of_file(folder / "a.png"), text_of_file(folder / "c.png"));
}

TEST(UltrasoundImage, NrrdLiesInTheTransducerPlane) {
  const TemporaryFolder folder;
  const std::string pose = place_on_scene(folder);
  const config::Json json = json_of(trocar("ultrasound image" + kScene + kQuick + " --pose " + pose +
                                           " --size 320x240 --json --out " + (folder / "slab.nrrd")));
  EXPECT_EQ(json["columns"], 320);
  EXPECT_EQ(json["frames"], nullptr);
  const auto slice = io::read_labels(folder / "slab.nrrd");
  ASSERT_TRUE(slice) << slice.error().text();
  EXPECT_EQ(slice->geometry.size, (volume::Index3{320, 240, 2}));
  // Mirrored, as is usual: columns run from the head to the feet, rows to the back.
  EXPECT_LT((slice->geometry.R_PV.col(0) - Vec3(0, 0, -1)).norm(), 1e-9);
  EXPECT_LT((slice->geometry.R_PV.col(1) - Vec3(0, 1, 0)).norm(), 1e-9);
  const Vec3 middle_of_face = slice->geometry.to_index({0.0, 8.0, 0.0});
  EXPECT_NEAR(middle_of_face.x(), 159.5, 1.0);
  EXPECT_NEAR(middle_of_face.z(), 0.5, 1e-6);
  EXPECT_GT(volume::sample_nearest(*slice, Vec3(0.0, 38.0, 0.0), std::uint8_t{0}), 0);
}

TEST(UltrasoundImage, TimesFramesOfEngineAndScanner) {
  const TemporaryFolder folder;
  const config::Json json = json_of(trocar("ultrasound image" + kScene + kQuick + " --frames 5 --json --pose " +
                                           place_on_scene(folder) + " --out " + (folder / "x.png")));
  const config::Json& frames = json["frames"];
  EXPECT_EQ(frames["count"], 5);
  EXPECT_GT(frames["frames_per_s"], 0.0);
  for (const char* part : {"frame_ms", "engine_ms", "scanner_ms"}) {
    EXPECT_GT(frames[part]["median"], 0.0) << part;
    EXPECT_EQ(frames[part]["p99"], nullptr) << part;  // of so few frames there is none
  }
}

TEST(UltrasoundImage, NeedleAndArtefactSwitchesChangeTheImage) {
  const TemporaryFolder folder;
  const std::string needle = folder / "needle.tfm";
  ASSERT_TRUE(io::write_transform(needle_pose({0.0, 40.0, 0.0}, Vec3(0.0, 0.5, -0.8).normalized()), needle));
  const std::string line =
      "ultrasound image" + kScene + kQuick + " --plain --pose " + place_on_scene(folder) + " --out ";
  const std::vector<std::pair<std::string, std::string>> asked = {{"plain.png", ""},
                                                                  {"needle.png", " --needle " + needle},
                                                                  {"silent.png", " --off noise,clutter"},
                                                                  {"harmonic.png", " --harmonic"}};
  std::vector<std::string> pictures;
  for (const auto& [name, more] : asked) {
    const Outcome outcome = trocar(line + (folder / name) + more);
    EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
    pictures.push_back(text_of_file(folder / name));
  }
  EXPECT_NE(pictures[0], pictures[1]);
  EXPECT_NE(pictures[0], pictures[2]);
  EXPECT_NE(pictures[0], pictures[3]);
}

/// A patient folder of the scene; the panorama is a sweep from the pose, in P.
std::string make_patient_with_panorama(const TemporaryFolder& folder) {
  const std::string patient = folder / "patient";
  const std::string pose = place_on_scene(folder);
  for (const std::string& line :
       {"patient generate layers-liver --out " + patient,
        "ultrasound sweep" + kScene + kQuick + " --transducer 4DC7-3 --angle-deg 40 --step-deg 2 --spacing 1" +
            " --in-patient --pose " + pose + " --out " + (folder / "sweep.nrrd")}) {
    const Outcome outcome = trocar(line);
    EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  }
  std::filesystem::create_directory(patient + "/us");
  std::filesystem::copy_file(folder / "sweep.nrrd", patient + "/us/panorama.nrrd");
  EXPECT_TRUE(io::write_transform(Pose(), patient + "/us_to_ct.tfm"));
  return patient;
}

TEST(UltrasoundImage, PanoramaOfThePatientFolderIsShown) {
  const TemporaryFolder folder;
  const std::string patient = make_patient_with_panorama(folder);
  const std::string line = "ultrasound image --json" + kQuick + " --transducer 4DC7-3 --patient " + patient +
                           " --pose " + place_on_scene(folder) + " --out ";
  const config::Json sliced = json_of(trocar(line + (folder / "panorama.nrrd") + " --engine panorama"));
  EXPECT_EQ(sliced["engine"], "panorama");
  EXPECT_GT(sliced["panorama_share"], 0.6);
  const config::Json cast = json_of(trocar(line + (folder / "cast.nrrd")));
  EXPECT_EQ(cast["engine"], "raycast");
  EXPECT_EQ(cast["panorama_share"], nullptr);
  const auto a = io::read_labels(folder / "panorama.nrrd"), b = io::read_labels(folder / "cast.nrrd");
  ASSERT_TRUE(a && b);
  EXPECT_NE(a->voxels, b->voxels);
  // The same tissue at the same place: layers, not speckle.
  EXPECT_GT(volume::correlation(a->voxels, b->voxels, volume::ComparedVoxels::kBothAboveZero), 0.4);
}

TEST(UltrasoundImage, ShowsTheRayCastImageFarFromThePanorama) {
  const TemporaryFolder folder;
  const std::string patient = make_patient_with_panorama(folder);
  std::filesystem::remove(patient + "/us_to_ct.tfm");
  ASSERT_TRUE(io::write_transform(Pose::translation(Vec3(0.0, 0.0, 900.0)), patient + "/us_to_ct.tfm"));
  const std::string line =
      "ultrasound image --plain" + kQuick + " --patient " + patient + " --pose " + place_on_scene(folder) + " --out ";
  const Outcome outcome = trocar(line + (folder / "a.png") + " --engine panorama");
  EXPECT_EQ(outcome.exit_status, 0);
  EXPECT_NE(outcome.err.find("does not cover"), std::string::npos) << outcome.err;
  EXPECT_EQ(trocar(line + (folder / "b.png")).exit_status, 0);
  EXPECT_EQ(text_of_file(folder / "a.png"), text_of_file(folder / "b.png"));
}

TEST(UltrasoundImage, ReportsADamagedPanoramaInOneLine) {
  const TemporaryFolder folder;
  const std::string patient = make_patient_with_panorama(folder);
  const std::string line = "ultrasound image" + kQuick + " --engine panorama --patient " + patient + " --pose " +
                           place_on_scene(folder) + " --out " + (folder / "x.png");
  const auto expect_refused = [&](const char* named) {
    const Outcome outcome = trocar(line);
    EXPECT_EQ(outcome.exit_status, 1) << outcome.err;
    EXPECT_EQ(line_count(outcome.err), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(named), std::string::npos) << outcome.err;
  };
  std::ofstream(patient + "/us_to_ct.tfm") << "#Insight Transform File V1.0\n#Transform 0\nTransform: "
                                              "AffineTransform_double_3_3\nParameters: nan 0 0 0 1 0 0 0 1 0 0 0\n"
                                              "FixedParameters: 0 0 0\n";
  expect_refused("us_to_ct.tfm");
  std::filesystem::remove(patient + "/us_to_ct.tfm");
  expect_refused("trocar register");
  ASSERT_TRUE(io::write_transform(Pose(), patient + "/us_to_ct.tfm"));
  std::filesystem::resize_file(patient + "/us/panorama.nrrd", 900);
  expect_refused("panorama.nrrd");
  std::filesystem::remove(patient + "/us/panorama.nrrd");
  volume::LabelGrid black(volume::GridGeometry{{4, 4, 4}, Vec3::Ones(), Vec3::Zero(), Mat3::Identity()});
  ASSERT_TRUE(io::write_image(black, patient + "/us/panorama.nrrd"));
  expect_refused("no imaged voxel");
  black.voxels[0] = 5;
  std::filesystem::remove(patient + "/us/panorama.nrrd");
  ASSERT_TRUE(io::write_image(black, patient + "/us/panorama.nrrd", {{"trocar_dynamic_range_db", "inf"}}));
  expect_refused("dynamic");
}

TEST(UltrasoundImage, SavedPoseKeepsTransducerDepthFrequencyAndFocus) {
  const TemporaryFolder folder;
  const std::string line = "ultrasound image" + kScene + " --lines 32 --samples 128 --planes 1 --looks 1 --json";
  const std::string saved = folder / "saved.tfm";
  const config::Json first = json_of(trocar(line + " --pose " + place_on_scene(folder) +
                                            " --transducer P4-2 --depth-mm 47 --frequency-mhz 2.5" +
                                            " --focus-mm 21 --save-pose " + saved + " --out " + (folder / "a.png")));
  const config::Json again = json_of(trocar(line + " --pose " + saved + " --out " + (folder / "b.png")));
  for (const char* key : {"transducer", "depth_mm", "frequency_mhz", "focus_mm", "X_PT"})
    EXPECT_EQ(again[key], first[key]) << key;
  EXPECT_EQ(again["depth_mm"], 47.0);
  const config::Json deeper = json_of(trocar(line + " --pose " + saved + " --depth-mm 60 --out " + (folder / "c.png")));
  EXPECT_EQ(deeper["depth_mm"], 60.0) << "an option counts more than the file";
  EXPECT_EQ(deeper["frequency_mhz"], 2.5);
}

TEST(UltrasoundImage, SavedPoseKeepsHarmonicImaging) {
  const TemporaryFolder folder;
  const std::string line = "ultrasound image" + kScene + " --lines 32 --samples 128 --planes 1 --looks 1 --json";
  const std::string saved = folder / "saved.tfm";
  const config::Json first =
      json_of(trocar(line + " --pose " + place_on_scene(folder) + " --transducer P4-2 --harmonic --save-pose " + saved +
                     " --out " + (folder / "a.png")));
  EXPECT_EQ(first["harmonic"], true);
  const config::Json again = json_of(trocar(line + " --pose " + saved + " --out " + (folder / "b.png")));
  EXPECT_EQ(again["harmonic"], true);
  EXPECT_EQ(again["frequency_mhz"], first["frequency_mhz"]);
  const config::Json plain = json_of(trocar(line + " --pose " + saved + " --no-harmonic --out " + (folder / "c.png")));
  EXPECT_EQ(plain["harmonic"], false) << "an option counts more than the file";
}

TEST(UltrasoundImage, WarnsOfAnImageBeyondTheCt) {
  const TemporaryFolder folder;
  const Outcome outcome =
      trocar("ultrasound image" + kScene + " --lines 32 --samples 128 --planes 1 --looks 1" +
             " --depth-mm 200 --pose " + place_on_scene(folder) + " --out " + (folder / "deep.png"));
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("outside the CT"), std::string::npos) << outcome.err;
}

TEST(UltrasoundImage, WarnsOfAFaceOutsideTheBody) {
  const TemporaryFolder folder;
  const Outcome outcome = trocar("ultrasound image" + kScene + kQuick + " --pose " +
                                 place_on_scene(folder, {0.0, -400.0, 0.0}) + " --out " + (folder / "air.png"));
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("the transducer does not touch the skin"), std::string::npos) << outcome.err;
}

TEST(UltrasoundSweep, MotorAndFreehandVolumesAgree) {
  const TemporaryFolder folder;
  const std::string common = " --pose " + place_on_scene(folder) + kScene + kQuick +
                             " --transducer 4DC7-3 --angle-deg 40 --step-deg 1 --frequency-mhz 3";
  const auto run = [&](const std::string& line) {
    const Outcome outcome = trocar("ultrasound " + line);
    EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  };
  run("sweep" + common + " --in-patient --out " + (folder / "motor.nrrd"));
  run("sweep" + common + " --tracked " + (folder / "hand.igs.mha"));
  run("reconstruct " + (folder / "hand.igs.mha") + " --spacing 0.7 --out " + (folder / "hand.nrrd"));
  const auto motor = io::read_labels(folder / "motor.nrrd");
  const auto hand = io::read_labels(folder / "hand.nrrd");
  ASSERT_TRUE(motor && hand);
  std::vector<std::uint8_t> resampled(motor->voxels.size());
  for (std::size_t n = 0; n < resampled.size(); ++n) {
    const volume::Index3 ijk = motor->geometry.index_of(n);
    const Vec3 p_P = motor->geometry.centre_mm(ijk);
    resampled[n] = volume::sample_nearest(*hand, p_P, std::uint8_t{0});
  }
  EXPECT_GT(volume::correlation(motor->voxels, resampled, volume::ComparedVoxels::kBothAboveZero), 0.8);
}

TEST(UltrasoundSweep, ScannerVolumeHasItsOwnFrameAndFan) {
  const TemporaryFolder folder;
  const config::Json json = json_of(trocar("ultrasound sweep" + kScene + kQuick +
                                           " --angle-deg 20 --step-deg 2 --spacing 1.5 --json --pose " +
                                           place_on_scene(folder) + " --out " + (folder / "v.nrrd")));
  EXPECT_EQ(json["frame"], "T");
  EXPECT_EQ(json["frames"], 11);
  const auto fields = io::read_image_fields(folder / "v.nrrd");
  ASSERT_TRUE(fields);
  EXPECT_EQ(fields->at("trocar_apex_mm"), "0 -40 0");
  EXPECT_EQ(fields->at("trocar_beam_axis"), "+y");
  EXPECT_EQ(fields->at("trocar_depth_mm"), "60");
  EXPECT_NEAR(parse_number<double>(fields->at("trocar_sweep_rad")).value_or(0.0), 0.349066, 1e-5);
  EXPECT_EQ(fields->count("trocar_fov_rad") + fields->count("trocar_radius_mm"), 2U);
  EXPECT_EQ(fields->count("trocar_X_PT"), 0U) << "a scanner's volume does not know the patient";
  const auto volume = io::read_labels(folder / "v.nrrd");
  ASSERT_TRUE(volume);
  EXPECT_EQ(volume->geometry.R_PV, Mat3::Identity());
  const Vec3 middle = volume->geometry.to_index({0.0, 30.0, 0.0});
  EXPECT_NEAR(middle.x(), 0.5 * static_cast<double>(volume->geometry.size[0] - 1), 1.0);
  EXPECT_NEAR(middle.z(), 0.5 * static_cast<double>(volume->geometry.size[2] - 1), 1.0);
}

TEST(UltrasoundLists, NameViewsAndTransducers) {
  const config::Json transducers = json_of(trocar("ultrasound transducers --json"));
  EXPECT_GE(transducers["transducers"].size(), 5U);
  const config::Json views = json_of(trocar("ultrasound views --json"));
  EXPECT_EQ(views["views"].front()["possible"], nullptr);  // without a patient nobody knows
  const config::Json of_scene = json_of(trocar("ultrasound views --patient layers-ascites --json"));
  const auto is_possible = [&](const char* name) {
    const auto found = std::find_if(of_scene["views"].begin(), of_scene["views"].end(),
                                    [&](const config::Json& view) { return view["name"] == name; });
    return found != of_scene["views"].end() && (*found)["possible"] == true;
  };
  EXPECT_TRUE(is_possible("ascites"));
  EXPECT_FALSE(is_possible("gallbladder"));
}

/// What fails, its exit status, and what the line must name.
struct Refused {
  const char* line;
  int exit_status;
  const char* named;
};

class UltrasoundMistake : public ::testing::TestWithParam<Refused> {};

TEST_P(UltrasoundMistake, FailsInOneLineAndWritesNothing) {
  const TemporaryFolder folder;
  place_on_scene(folder);  // pose8.tfm
  std::ofstream(folder / "scaled.tfm") << "#Insight Transform File V1.0\n#Transform 0\nTransform: "
                                          "AffineTransform_double_3_3\nParameters: 2 0 0 0 1 0 0 0 1 0 0 0\n"
                                          "FixedParameters: 0 0 0\n";
  const std::size_t before = files_in(folder);
  const Outcome outcome =
      trocar(std::string("ultrasound ") + GetParam().line, "cd '" + folder.path().string() + "' &&");
  EXPECT_EQ(outcome.exit_status, GetParam().exit_status) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(line_count(outcome.err), 1) << outcome.err;
  EXPECT_NE(outcome.err.find(GetParam().named), std::string::npos) << outcome.err;
  EXPECT_EQ(files_in(folder), before);
}

INSTANTIATE_TEST_SUITE_P(
    OfTheUser, UltrasoundMistake,
    ::testing::Values(
        Refused{"image --patient layers-liver --out x.png", 2, "--view"},
        Refused{"image --patient nobody --pose pose8.tfm --out x.png", 2, "abdomen"},
        Refused{"image --patient layers-liver --view nothing --out x.png", 2, "liver-right-kidney"},
        Refused{"image --patient layers-liver --view bladder --out x.png", 2, "bladder"},
        Refused{"image --patient layers-liver --view spleen --pose pose8.tfm --out x.png", 2, "--view"},
        Refused{"image --patient layers-liver --pose pose8.tfm --transducer C9 --out x.png", 2, "C5-2"},
        Refused{"image --patient layers-liver --pose pose8.tfm --engine panorama --out x.png", 1, "us/panorama.nrrd"},
        Refused{"image --patient layers-liver --pose pose8.tfm --engine mirror --out x.png", 2, "panorama"},
        Refused{"image --patient layers-liver --pose pose8.tfm --off ghosts --out x.png", 2, "side-lobes"},
        Refused{"image --patient layers-liver --pose pose8.tfm --depth-mm nan --out x.png", 2, "--depth-mm"},
        Refused{"image --patient layers-liver --pose pose8.tfm --frequency-mhz 50 --out x.png", 2, "2 to 5 MHz"},
        Refused{"image --patient layers-liver --pose pose8.tfm --gain-db nan --out x.png", 2, "gain"},
        Refused{"image --patient layers-liver --pose pose8.tfm --tgc 1,2,3 --out x.png", 2, "eight"},
        Refused{"image --patient layers-liver --pose pose8.tfm --planes 4 --out x.png", 2, "--planes"},
        Refused{"image --patient layers-liver --pose pose8.tfm --gray-map rainbow --out x.png", 2, "soft"},
        Refused{"image --patient layers-liver --pose pose8.tfm --size 640 --out x.png", 2, "640x480"},
        Refused{"image --patient layers-liver --pose pose8.tfm --frames -1 --out x.png", 2, "--frames"},
        Refused{"image --patient layers-liver --pose pose8.tfm --needle-gauge 99 --out x.png", 2, "14 to 25"},
        Refused{"image --patient layers-liver --pose pose8.tfm --out x.jpg", 2, ".nrrd"},
        Refused{"image --patient layers-liver --pose pose8.tfm --save-pose x.png --out x.png", 2, "same name"},
        Refused{"image --patient layers-liver --pose pose8.tfm --out pose8.tfm.png/x.png", 1, "folder does not exist"},
        Refused{"image --patient layers-liver --pose pose8.tfm --needle missing.tfm --out x.png", 1, "missing.tfm"},
        Refused{"image --patient layers-liver --pose missing.tfm --out x.png", 1, "missing.tfm"},
        Refused{"image --patient layers-liver --pose scaled.tfm --out x.png", 1, "rigid"},
        Refused{"sweep --patient layers-liver --pose pose8.tfm", 2, "--tracked"},
        Refused{"sweep --patient layers-liver --pose pose8.tfm --out x.nii", 2, ".nrrd"},
        Refused{"sweep --patient layers-liver --pose pose8.tfm --angle-deg 400 --out x.nrrd", 2, "1 to 90 degrees"},
        Refused{"sweep --patient layers-liver --pose pose8.tfm --spacing nan --out x.nrrd", 2, "--spacing"},
        Refused{"sweep --patient layers-liver --pose pose8.tfm --tracked x.nrrd", 2, ".igs.mha"}));

TEST(UltrasoundSweep, NeedsAMotor) {
  const TemporaryFolder folder;
  const Outcome outcome = trocar("ultrasound sweep --patient layers-liver --transducer C5-2 --pose " +
                                 place_on_scene(folder) + " --out " + (folder / "x.nrrd"));
  EXPECT_EQ(outcome.exit_status, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("no motor"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace trocar::cli_test
