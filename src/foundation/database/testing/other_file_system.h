#pragma once

#include <soci/sqlite3/soci-sqlite3.h>
#include <unistd.h>

#include <csignal>
#include <limits>

#include "core/result.h"

namespace trocar::database::testing {

/// How a file system without memory that programs share is met by SQLite: it has no such function, or it fails.
enum class SharedMemory { kMissing, kFails };

/// SQLite's default file system for the files that this process opens during its lifetime, without shared memory: a
/// write-ahead log is impossible. One at a time.
class OtherFileSystem {
 public:
  explicit OtherFileSystem(SharedMemory memory) : before_(sqlite_api::sqlite3_vfs_find(nullptr)) {
    TROCAR_CHECK(before_ != nullptr && shared().original == nullptr);
    shared() = {before_, memory, std::numeric_limits<int>::max()};
    ours_ = *before_;
    ours_.pNext = nullptr;
    ours_.zName = "other-file-system";
    ours_.xOpen = open;
    sqlite_api::sqlite3_vfs_register(&ours_, 1);
  }
  ~OtherFileSystem() {
    sqlite_api::sqlite3_vfs_unregister(&ours_);
    sqlite_api::sqlite3_vfs_register(before_, 1);
    shared() = {};
  }
  OtherFileSystem(const OtherFileSystem&) = delete;
  OtherFileSystem& operator=(const OtherFileSystem&) = delete;

  /// The process dies as by kill -9 instead of its next write but `writes`.
  static void die_after(int writes) noexcept { shared().writes_left = writes; }

 private:
  using File = sqlite_api::sqlite3_file;
  struct Shared {
    sqlite_api::sqlite3_vfs* original = nullptr;
    SharedMemory memory = SharedMemory::kMissing;
    int writes_left = 0;
  };
  /// The functions of databases and of journals, which are not locked.
  template <bool is_database>
  struct Methods {
    static inline const sqlite_api::sqlite3_io_methods* original = nullptr;
    static inline sqlite_api::sqlite3_io_methods changed{};

    static void put_into(File* file) {
      original = file->pMethods;
      changed = *file->pMethods;
      changed.xWrite = write;
      changed.xShmMap = fail_to_map;
      if (shared().memory == SharedMemory::kMissing) changed.iVersion = 1;
      file->pMethods = &changed;
    }
    static int write(File* file, const void* data, int bytes, sqlite_api::sqlite3_int64 offset) {
      if (shared().writes_left-- <= 0) ::kill(::getpid(), SIGKILL);
      return original->xWrite(file, data, bytes, offset);
    }
  };
  static Shared& shared() noexcept {
    static Shared state;
    return state;
  }

  static int open(sqlite_api::sqlite3_vfs*, const char* name, File* file, int flags, int* out) {
    const int code = shared().original->xOpen(shared().original, name, file, flags, out);
    if (code != SQLITE_OK || file->pMethods == nullptr) return code;
    if ((flags & SQLITE_OPEN_MAIN_DB) != 0)
      Methods<true>::put_into(file);
    else
      Methods<false>::put_into(file);
    return code;
  }
  static int fail_to_map(File*, int, int, int, void volatile**) { return SQLITE_IOERR_SHMMAP; }

  sqlite_api::sqlite3_vfs* before_;
  sqlite_api::sqlite3_vfs ours_{};
};

}  // namespace trocar::database::testing
