#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/files/file_system.h"
#include "core/files/folders.h"

namespace trocar {
inline namespace core {
namespace {

bool is_free(const std::filesystem::path& path) {
  auto lock = FileLock::try_lock(path);
  EXPECT_TRUE(lock) << lock.error().text();
  return lock && lock->has_value();
}

TEST(FileLock, HasOneHolder) {
  const TemporaryFolder folder;
  const auto path = folder / "a.lock";
  {
    auto first = FileLock::try_lock(path);
    ASSERT_TRUE(first && *first);
    EXPECT_FALSE(is_free(path));
    const FileLock moved = *std::move(*first);
    EXPECT_FALSE(is_free(path));
  }
  EXPECT_TRUE(is_free(path));
}

TEST(FileLock, RemovesItsFileAndIsFreeAgain) {
  const TemporaryFolder folder;
  const auto path = folder / "a.lock";
  auto lock = FileLock::try_lock(path);
  ASSERT_TRUE(lock && *lock);
  (*lock)->remove();
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(is_free(path));
}

TEST(FileLock, IsReleasedWhenItsProcessIsKilled) {
  const TemporaryFolder folder;
  const auto path = folder / "a.lock";
  int told[2];
  ASSERT_EQ(::pipe(told), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    auto lock = FileLock::try_lock(path);
    const char has_it = lock && *lock ? 'y' : 'n';
    if (::write(told[1], &has_it, 1) != 1) ::_exit(1);
    for (;;) ::pause();
  }
  char has_it = 'n';
  ASSERT_EQ(::read(told[0], &has_it, 1), 1);
  EXPECT_EQ(has_it, 'y');
  EXPECT_FALSE(is_free(path));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_TRUE(is_free(path));
  ::close(told[0]);
  ::close(told[1]);
}

TEST(FileLock, NamesAFileThatCannotBeOpened) {
  const auto lock = FileLock::try_lock("/nowhere/a.lock");
  ASSERT_FALSE(lock);
  EXPECT_EQ(lock.error().where, "/nowhere/a.lock");
}

}  // namespace
}  // namespace core
}  // namespace trocar
