#include "core/files/input_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <fstream>

#include "core/available_memory.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/testing/source_dir.h"

namespace trocar {
inline namespace core {
namespace {
namespace fs = std::filesystem;

class InputFileTest : public ::testing::Test {
 protected:
  fs::path write(const std::string& name, std::string_view text) {
    const fs::path path = folder_ / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
    return path;
  }
  fs::path sparse(const std::string& name, std::uint64_t bytes) {
    const fs::path path = write(name, "");
    fs::resize_file(path, bytes);
    return path;
  }
  /// The error of opening, and of reading through the older door.
  std::string error_of(const fs::path& path) {
    EXPECT_FALSE(read_file(path));
    const auto file = InputFile::open(path, FileKind::kToml);
    return file ? "opened" : file.error().what;
  }

  TemporaryFolder folder_;
};

TEST_F(InputFileTest, ReadsARegularFileAndALinkToOne) {
  const fs::path file = write("a.toml", "x = 1\n");
  EXPECT_EQ(read_input(file, FileKind::kToml).value(), "x = 1\n");
  fs::create_symlink("a.toml", folder_ / "link.toml");
  EXPECT_EQ(read_input(folder_ / "link.toml", FileKind::kToml).value(), "x = 1\n");
  EXPECT_EQ(InputFile::open(file, FileKind::kToml)->size(), 6u);
}

TEST_F(InputFileTest, RefusesAFifoWithoutWaitingForAWriter) {
  ASSERT_EQ(::mkfifo((folder_ / "fifo").c_str(), 0600), 0);
  fs::create_symlink("fifo", folder_ / "link");
  EXPECT_EQ(error_of(folder_ / "fifo"), "not a regular file");
  EXPECT_EQ(error_of(folder_ / "link"), "not a regular file");
}

TEST_F(InputFileTest, RefusesADeviceAndALinkToOne) {
  fs::create_symlink("/dev/zero", folder_ / "zero.toml");
  EXPECT_EQ(error_of("/dev/zero"), "not a regular file");
  EXPECT_EQ(error_of(folder_ / "zero.toml"), "not a regular file");
}

TEST_F(InputFileTest, RefusesASocket) {
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = (folder_ / "s").string();
  ASSERT_LT(path.size(), sizeof address.sun_path);
  path.copy(address.sun_path, path.size());
  ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(error_of(path), "not a regular file");
  ::close(socket);
}

TEST_F(InputFileTest, RefusesFoldersAndMissingFiles) {
  EXPECT_EQ(error_of(folder_.path()), "is a folder, not a file");
  EXPECT_EQ(error_of(folder_ / "none"), "no such file");
  fs::create_symlink("circle", folder_ / "circle");
  EXPECT_EQ(error_of(folder_ / "circle"), "circular symbolic links");
}

TEST_F(InputFileTest, RefusesEachKindAboveItsLimit) {
  for (const FileLimit& limit : file_limits()) {
    EXPECT_TRUE(InputFile::open(sparse("at", limit.max_bytes), limit.kind)) << limit.name;
    const auto above = InputFile::open(sparse("above", limit.max_bytes + 1), limit.kind);
    ASSERT_FALSE(above) << limit.name;
    EXPECT_NE(above.error().what.find("too large"), std::string::npos) << above.error().text();
    EXPECT_FALSE(above.error().advice.empty());
  }
}

TEST_F(InputFileTest, RefusesALinkOutOfTheFolder) {
  write("patient/a.toml", "inside");
  write("secret", "outside");
  write("patient2/b", "a folder whose name only begins alike");
  const fs::path patient = folder_ / "patient";
  fs::create_symlink("../secret", patient / "out");
  fs::create_symlink("a.toml", patient / "in");
  fs::create_symlink("../patient2", patient / "folder");
  EXPECT_EQ(read_input(patient / "in", FileKind::kToml, patient).value(), "inside");
  EXPECT_EQ(read_input(patient / "out", FileKind::kToml).value(), "outside");
  for (const fs::path& path : {patient / "out", patient / ".." / "secret", patient / "folder" / "b"}) {
    const auto file = InputFile::open(path, FileKind::kToml, patient);
    ASSERT_FALSE(file) << path;
    EXPECT_EQ(file.error().what, "a link leads out of the folder");
  }
  // The folder itself may be reached through a link.
  fs::create_symlink("patient", folder_ / "alias");
  EXPECT_TRUE(InputFile::open(folder_ / "alias" / "a.toml", FileKind::kToml, folder_ / "alias"));
}

TEST_F(InputFileTest, ReadsTheCheckedFileWhenThePathIsReplaced) {
  const fs::path path = write("a", "checked");
  const auto file = InputFile::open(path, FileKind::kToml);
  ASSERT_TRUE(file);
  fs::remove(path);
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(read_input(file->pinned_path(), FileKind::kToml).value(), "checked");
  EXPECT_EQ(file->read_all().value(), "checked");
}

TEST_F(InputFileTest, ReadsAGrowingFileUpToTheLimit) {
  const fs::path path = write("a", "12345");
  FileLimit limit = limit_of(FileKind::kOther);
  limit.max_bytes = 8;
  const auto file = InputFile::open(path, limit);
  ASSERT_TRUE(file);
  std::ofstream(path, std::ios::app) << "678";
  EXPECT_EQ(file->read_all().value(), "12345678");
  std::ofstream(path, std::ios::app) << "9";
  EXPECT_FALSE(file->read_all());
  // The kernel states no size for these.
  EXPECT_FALSE(read_input("/proc/self/status", FileKind::kOther)->empty());
}

TEST_F(InputFileTest, LimitsMatchThePatientFilesPage) {
  const std::string page = *read_file(testing::source_dir() / "docs" / "patient_files.md");
  for (const FileLimit& limit : file_limits()) {
    if (limit.kind == FileKind::kOther) continue;
    constexpr std::uint64_t kMiB = 1 << 20, kGiB = 1 << 30;
    const std::string size = limit.max_bytes >= kGiB ? std::to_string(limit.max_bytes / kGiB) + " GiB"
                                                     : std::to_string(limit.max_bytes / kMiB) + " MiB";
    const std::string row = "| " + std::string(limit.name) + " | " + size + " |";
    EXPECT_NE(page.find(row), std::string::npos) << row;
  }
}

TEST(AvailableMemory, RefusesAnImageWithoutRoomForACopy) {
  EXPECT_GT(available_memory_bytes(), 0u);
  EXPECT_TRUE(check_memory_for_image(500, 1000, "ct.nrrd"));
  const Status refused = check_memory_for_image(501, 1000, "ct.nrrd");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("not enough memory to read the image"), std::string::npos);
  EXPECT_EQ(refused.error().where, "ct.nrrd");
}

}  // namespace
}  // namespace core
}  // namespace trocar
