#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <optional>

#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/files/unfinished_output.h"

namespace trocar {
inline namespace core {
namespace {
namespace fs = std::filesystem;

/// A process that has begun to write a folder and does not finish it.
class StoppedWriter {
 public:
  explicit StoppedWriter(const fs::path& target) {
    int told[2];
    EXPECT_EQ(::pipe(told), 0);
    process_ = ::fork();
    if (process_ == 0) {
      const auto wait = [&](const fs::path& temporary) -> Status {
        std::ofstream(temporary / "00001.dcm") << "a part";
        if (::write(told[1], "x", 1) != 1) ::_exit(1);
        for (;;) ::pause();
      };
      ::_exit(write_folder_atomically(target, wait) ? 0 : 1);
    }
    ::close(told[1]);
    char byte = 0;
    EXPECT_EQ(::read(told[0], &byte, 1), 1);
    ::close(told[0]);
    part_ = part_path(target, process_);
  }
  ~StoppedWriter() { kill(); }
  StoppedWriter(const StoppedWriter&) = delete;
  StoppedWriter& operator=(const StoppedWriter&) = delete;

  void kill() {
    if (process_ > 0) {
      ::kill(process_, SIGKILL);
      ::waitpid(process_, nullptr, 0);
    }
    process_ = -1;
  }
  const fs::path& part() const { return part_; }

 private:
  pid_t process_ = -1;
  fs::path part_;
};

Status write_one(const fs::path& temporary) {
  return write_file_atomically(temporary / "a", "1");
}

TEST(PartFolder, IsRemovedByTheNextOutputAfterAKill) {
  const TemporaryFolder folder;
  const fs::path target = folder / "dicom1";
  StoppedWriter writer(target);
  writer.kill();
  ASSERT_TRUE(fs::exists(writer.part() / "00001.dcm")) << "SIGKILL leaves the part";
  ASSERT_TRUE(write_folder_atomically(folder / "another", write_one));
  EXPECT_TRUE(fs::exists(writer.part())) << "belongs to another output";
  ASSERT_TRUE(write_folder_atomically(target, write_one));
  EXPECT_FALSE(fs::exists(writer.part()));
  EXPECT_TRUE(fs::exists(target / "a"));
}

TEST(PartFolder, StaysWhileItsProcessRuns) {
  const TemporaryFolder folder;
  const fs::path target = folder / "dicom1";
  StoppedWriter running(target);
  StoppedWriter killed(target);
  killed.kill();
  ASSERT_TRUE(write_folder_atomically(target, write_one));
  EXPECT_TRUE(fs::exists(running.part() / "00001.dcm"));
  EXPECT_FALSE(fs::exists(killed.part()));
}

TEST(PartFolder, IsNotTakenOverWhileInUse) {
  const TemporaryFolder folder;
  const fs::path path = folder / ".a.7.part";
  auto first = PartFolder::create(path);
  ASSERT_TRUE(first) << first.error().text();
  std::ofstream(path / "file") << "x";
  const auto second = PartFolder::create(path);  // another computer or container can have a process of this number
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().where, path.string());
  EXPECT_TRUE(fs::exists(path / "file"));
  { const PartFolder ended = *std::move(first); }
  EXPECT_FALSE(fs::exists(path)) << "was not renamed";
  auto third = PartFolder::create(path);
  ASSERT_TRUE(third);
  EXPECT_FALSE(third->rename_to(folder / "a"));
  EXPECT_TRUE(fs::is_empty(folder / "a"));
}

TEST(PartFolder, NothingElseIsRemoved) {
  const TemporaryFolder folder;
  const TemporaryFolder elsewhere;
  const fs::path target = folder / "dicom1";
  std::ofstream(elsewhere / "precious") << "x";
  fs::create_directory_symlink(elsewhere.path(), folder / ".dicom1.12.part");
  for (const char* name : {".dicom1.part", ".dicom1..part", ".dicom1.12x.part", ".dicom10.12.part", "dicom1.12.part"})
    fs::create_directory(folder / name);
  std::ofstream(folder / ".dicom1.13.part") << "a file";
  remove_abandoned_parts(target);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 7);
  EXPECT_TRUE(fs::exists(elsewhere / "precious"));
  fs::create_directory(folder / ".dicom1.14.part");
  remove_abandoned_parts(target);
  EXPECT_FALSE(fs::exists(folder / ".dicom1.14.part"));
}

TEST(PartFolder, KeepsTheEndingOfItsTarget) {
  EXPECT_EQ(part_path("/x/case", 7), "/x/.case.7.part");
  EXPECT_EQ(part_path("/x/ct.nii.gz", 7), "/x/.ct.nii.7.part.nii.gz");
  EXPECT_EQ(part_path("/x/case.1", 7), "/x/.case.7.part.1");
}

TEST(PartFolder, NamesAFolderThatCannotBeCreated) {
  const auto part = PartFolder::create("/nowhere/.a.7.part");
  ASSERT_FALSE(part);
  EXPECT_EQ(part.error().where, "/nowhere/.a.7.part");
}

}  // namespace
}  // namespace core
}  // namespace trocar
