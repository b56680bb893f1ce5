// Files and patient folders made to hang or exhaust the program: each is refused at once, in one line.
#include <sys/stat.h>

#include <functional>

#include "io/image/image_file.h"
#include "io/markups_file.h"
#include "io/mesh_file.h"
#include "io/patient/label_sources.h"
#include "io/patient/patient_folder.h"
#include "io/sequence/plus_config.h"
#include "io/sequence/sequence_file.h"
#include "io/sequence/transform_file.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {
namespace fs = std::filesystem;

using testing::numbered_grid;
using testing::oblique_geometry;
using testing::write_bytes;

const std::string kNrrdPlace =
    "space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n";
const std::string kMetaPlace = "TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 0\nElementSpacing = 1 1 1\n";

template <class T>
std::string error_text(const Result<T>& result) {
  return result ? "was read" : result.error().text();
}

/// Every reader of a file, with the ending that it asks for.
struct Reader {
  std::string ending;
  std::function<std::string(const fs::path&)> error_of;
};

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all = {
      {".nii.gz", [](const fs::path& path) { return error_text(read_ct(path)); }},
      {".nrrd", [](const fs::path& path) { return error_text(read_labels(path)); }},
      {".mha", [](const fs::path& path) { return error_text(read_float(path)); }},
      {".dcm", [](const fs::path& path) { return error_text(read_ct(path)); }},
      {".nrrd", [](const fs::path& path) { return error_text(read_image_fields(path)); }},
      {".seg.nrrd", [](const fs::path& path) { return error_text(read_label_sources({path}, "totalsegmentator")); }},
      {".igs.mha", [](const fs::path& path) { return error_text(read_sequence(path)); }},
      {".xml", [](const fs::path& path) { return error_text(read_plus_config(path)); }},
      {".tfm", [](const fs::path& path) { return error_text(read_transform(path)); }},
      {".mrk.json", [](const fs::path& path) { return error_text(read_landmarks(path)); }},
      {".mrk.json", [](const fs::path& path) { return error_text(read_paths(path)); }},
      {".vtp", [](const fs::path& path) { return error_text(read_mesh(path)); }},
      {".stl", [](const fs::path& path) { return error_text(read_mesh(path)); }}};
  return all;
}

TEST(HostileFiles, EveryReaderRefusesAFifo) {
  TemporaryFolder folder;
  for (const Reader& reader : readers()) {
    const fs::path path = folder / ("fifo" + reader.ending);
    ::mkfifo(path.c_str(), 0600);
    EXPECT_NE(reader.error_of(path).find("not a regular file"), std::string::npos) << reader.error_of(path);
  }
}

TEST(HostileFiles, EveryReaderRefusesALinkToADevice) {
  TemporaryFolder folder;
  for (const Reader& reader : readers()) {
    const fs::path path = folder / ("zero" + reader.ending);
    if (!fs::exists(path)) fs::create_symlink("/dev/zero", path);
    EXPECT_NE(reader.error_of(path).find("not a regular file"), std::string::npos) << reader.error_of(path);
  }
}

TEST(HostileFiles, EveryReaderRefusesAHugeFileOfZeros) {
  TemporaryFolder folder;
  for (const Reader& reader : readers()) {
    const fs::path path = folder / ("huge" + reader.ending);
    write_bytes(path, "");
    fs::resize_file(path, std::uint64_t{20} << 30);  // sparse
    EXPECT_NE(reader.error_of(path), "was read") << path;
  }
}

TEST(HostileFiles, RefuseADetachedHeaderThatLeavesItsFolder) {
  TemporaryFolder folder;
  fs::create_directories(folder / "in");
  write_bytes(folder / "outside.raw", std::string(64, '\0'));
  write_bytes(folder / "in" / "inside.raw", std::string(64, '\0'));
  fs::create_symlink("../outside.raw", folder / "in" / "link.raw");
  ::mkfifo((folder / "in" / "fifo.raw").c_str(), 0600);
  const auto nrrd_error = [&](const std::string& key, const std::string& name) {
    write_bytes(folder / "in" / "a.nhdr", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n" +
                                              kNrrdPlace + key + ": " + name + "\n\n");
    return error_text(read_labels(folder / "in" / "a.nhdr"));
  };
  const auto meta_error = [&](const std::string& name) {
    write_bytes(folder / "in" / "a.mhd", "ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\n" +
                                             kMetaPlace + "ElementDataFile = " + name + "\n");
    return error_text(read_labels(folder / "in" / "a.mhd"));
  };
  EXPECT_EQ(nrrd_error("data file", "inside.raw"), "was read");
  EXPECT_EQ(meta_error("inside.raw"), "was read");
  for (const std::string& name : {std::string("../../etc/passwd"), std::string("/etc/passwd"),
                                  std::string("../outside.raw"), (folder / "in" / "inside.raw").string()}) {
    EXPECT_NE(nrrd_error("data file", name).find("outside of its folder"), std::string::npos) << nrrd_error("x", name);
    EXPECT_NE(nrrd_error("DataFile", name).find("outside of its folder"), std::string::npos);
    EXPECT_NE(meta_error(name).find("outside of its folder"), std::string::npos) << meta_error(name);
  }
  EXPECT_NE(nrrd_error("data file", "link.raw").find("leads out of the folder"), std::string::npos);
  EXPECT_NE(meta_error("link.raw").find("leads out of the folder"), std::string::npos);
  EXPECT_NE(nrrd_error("data file", "fifo.raw").find("not a regular file"), std::string::npos);
  EXPECT_NE(meta_error("fifo.raw").find("not a regular file"), std::string::npos);
  for (const char* name : {"LIST", "slice%03d.raw 1 4 1"}) {
    EXPECT_NE(nrrd_error("data file", name).find("several files"), std::string::npos);
    EXPECT_NE(meta_error(name).find("several files"), std::string::npos);
  }
}

TEST(HostileFiles, RefuseAmbiguousHeaders) {
  TemporaryFolder folder;
  const std::string start = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n" + kNrrdPlace;
  write_bytes(folder / "a.nrrd", start + "content: y\n\n" + std::string(64, '\0'));
  EXPECT_TRUE(read_labels(folder / "a.nrrd")) << error_text(read_labels(folder / "a.nrrd"));
  for (const std::string& more :
       {std::string(" \ndata file: /dev/zero\n\n"), std::string("content: y\rdata file: /dev/zero\n\n"),
        std::string("content: \x01\n\n")}) {
    write_bytes(folder / "a.nrrd", start + more + std::string(64, '\0'));
    EXPECT_FALSE(read_labels(folder / "a.nrrd")) << more;
  }
  write_bytes(folder / "a.mha", "ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\n" +
                                    kMetaPlace + "elementdatafile = LOCAL\nElementDataFile = /dev/zero\n" +
                                    std::string(64, '\0'));
  EXPECT_FALSE(read_labels(folder / "a.mha"));
}

TEST(HostileFiles, CheckADeclaredSizeBeforeAllocating) {
  // 2 GB are declared; nothing may be allocated for them.
  TemporaryFolder folder;
  const std::string sizes = "1000 1000 2000";
  for (const char* encoding : {"raw", "gzip", "ascii", "hex"}) {
    write_bytes(folder / "a.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: " + sizes + "\nencoding: " + encoding +
                                       "\n" + kNrrdPlace + "\n0 1 2");
    EXPECT_FALSE(read_labels(folder / "a.nrrd")) << encoding;
  }
  write_bytes(folder / "a.mha", "ObjectType = Image\nNDims = 3\nDimSize = " + sizes +
                                    "\nElementType = MET_UCHAR\nBinaryData = False\n" + kMetaPlace +
                                    "ElementDataFile = LOCAL\n0 1 2");
  EXPECT_FALSE(read_labels(folder / "a.mha"));
  write_bytes(folder / "a.vtp",
              "<VTKFile type=\"PolyData\" version=\"0.1\"><PolyData><Piece NumberOfPoints=\"40000000\" "
              "NumberOfPolys=\"1\"></Piece></PolyData></VTKFile>");
  EXPECT_NE(error_text(read_mesh(folder / "a.vtp")).find("more points than its file can hold"), std::string::npos);
  write_bytes(folder / "a.igs.mha",
              "ObjectType = Image\nNDims = 3\nDimSize = 4 4 1000000\nElementType = MET_UCHAR\n"
              "Seq_Frame0000_Timestamp = 0\nElementDataFile = LOCAL\n");
  EXPECT_FALSE(read_sequence(folder / "a.igs.mha"));
}

TEST(HostileFiles, AnUnknownEncodingIsNamed) {
  TemporaryFolder folder;
  write_bytes(folder / "a.nrrd",
              "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 4 4 4\nencoding: bzip2\n\n" + std::string(64, '\0'));
  EXPECT_NE(error_text(read_labels(folder / "a.nrrd")).find("\"bzip2\" is not supported"), std::string::npos);
}

/// A patient folder of which one file is replaced.
class HostilePatient : public ::testing::Test {
 protected:
  void SetUp() override {
    anatomy::VirtualPatient patient;
    patient.name = "small";
    const volume::GridGeometry g = oblique_geometry();
    patient.ct = numbered_grid<std::int16_t>(g);
    patient.labels = volume::LabelGrid(g, 1);
    patient.skin_distance_mm = volume::FloatGrid(g, -5.0F);
    patient.label_table.labels = {{1, "liver", "liver", {1, 2, 3}}};
    patient.content_hash = anatomy::hash_patient(patient);
    const anatomy::NamedMesh mesh{
        "liver", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}}};
    ASSERT_TRUE(save_patient(patient, {mesh}, path_));
    ASSERT_TRUE(load_patient(path_));
  }
  /// Loads the folder with one file replaced by `make`, and puts the file back.
  void expect_refused(const std::string& words, const std::function<void(const fs::path&)>& make) {
    for (const char* name : {"patient.toml", "ct.nrrd", "labels.nrrd", "skin_distance.nrrd", "landmarks.mrk.json",
                             "paths.mrk.json", "meshes/liver.vtp"}) {
      fs::rename(path_ / name, folder_ / "kept");
      make(path_ / name);
      const bool is_mesh = std::string_view(name).starts_with("meshes");
      const std::string error = is_mesh ? error_text(load_patient_meshes(path_)) : error_text(load_patient(path_));
      EXPECT_NE(error.find(words), std::string::npos) << name << ": " << error;
      fs::remove(path_ / name);
      fs::rename(folder_ / "kept", path_ / name);
    }
  }

  TemporaryFolder folder_;
  fs::path path_ = folder_ / "patient";
};

TEST_F(HostilePatient, FifosAreRefused) {
  expect_refused("not a regular file", [](const fs::path& file) { ::mkfifo(file.c_str(), 0600); });
}

TEST_F(HostilePatient, LinksToDevicesAreRefused) {
  expect_refused("not a regular file", [](const fs::path& file) { fs::create_symlink("/dev/zero", file); });
}

TEST_F(HostilePatient, LinksOutOfTheFolderAreRefused) {
  expect_refused("leads out of the folder", [&](const fs::path& file) { fs::create_symlink(folder_ / "kept", file); });
}

TEST_F(HostilePatient, RefusesAHugeTextBeforeReadingIt) {
  for (const char* name : {"patient.toml", "landmarks.mrk.json", "paths.mrk.json"}) {
    fs::rename(path_ / name, folder_ / "kept");
    write_bytes(path_ / name, "");
    fs::resize_file(path_ / name, std::uint64_t{1} << 30);
    EXPECT_NE(error_text(load_patient(path_)).find("too large"), std::string::npos) << name;
    fs::remove(path_ / name);
    fs::rename(folder_ / "kept", path_ / name);
  }
}

TEST_F(HostilePatient, VolumesInAnotherFileAreRefused) {
  write_bytes(path_ / "ct.raw", std::string(280, '\0'));
  write_bytes(path_ / "ct.nrrd", "NRRD0004\ntype: short\ndimension: 3\nsizes: 7 5 4\nencoding: raw\nendian: little\n" +
                                     kNrrdPlace + "data file: ct.raw\n\n");
  EXPECT_NE(error_text(load_patient(path_)).find("the voxels are in another file"), std::string::npos);
}

}  // namespace
}  // namespace trocar::io
