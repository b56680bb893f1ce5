#include "attempt/record/journal.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "config/json.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"

namespace trocar::attempt {
namespace {

struct JournalTest : ::testing::Test {
  JournalTest() : folder(std::make_unique<TemporaryFolder>()), journal(folder->path()) {
    state.choice.patient_source = "layers-liver";
    state.choice.patient_seed = 7;
    state.choice.force_model = "proxy";
    state.choice.options.overrides = {"liver.k=0.5"};
    state.session = folder->path() / "one.trocar";
  }
  std::unique_ptr<TemporaryFolder> folder;
  Journal journal;
  JournalEntry state;
};

/// Another trainer's process that begins the attempt and is killed when this object goes.
class OtherTrainer {
 public:
  OtherTrainer(const std::filesystem::path& folder, const JournalEntry& state) {
    int told[2];
    if (::pipe(told) != 0) return;
    process_ = ::fork();
    if (process_ == 0) {
      Journal journal(folder);
      const char has_begun = journal.begin(state) ? 'y' : 'n';
      if (::write(told[1], &has_begun, 1) != 1) ::_exit(1);
      for (;;) ::pause();
    }
    char has_begun = 'n';
    has_begun_ = ::read(told[0], &has_begun, 1) == 1 && has_begun == 'y';
    ::close(told[0]);
    ::close(told[1]);
  }
  ~OtherTrainer() { kill(); }
  void kill() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
    process_ = 0;
  }
  bool has_begun() const { return has_begun_; }

 private:
  pid_t process_ = 0;
  bool has_begun_ = false;
};

TEST_F(JournalTest, FindsNothingInitiallyOrAfterAnEnd) {
  EXPECT_FALSE(journal.find_cut_off());
  ASSERT_TRUE(write_file_atomically(state.session, "ticks"));
  ASSERT_TRUE(journal.begin(state));
  journal.clear();
  EXPECT_FALSE(journal.find_cut_off());
}

TEST_F(JournalTest, FindsAnInterruptedAttempt) {
  ASSERT_TRUE(write_file_atomically(state.session, "ticks"));
  {
    Journal cut_off(folder->path());
    ASSERT_TRUE(cut_off.begin(state));
  }
  const auto found = journal.find_cut_off();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->session, state.session);
  EXPECT_TRUE(found->choice == state.choice);
}

TEST_F(JournalTest, IgnoresARunningTrainersAttemptUntilItIsKilled) {
  ASSERT_TRUE(write_file_atomically(state.session, "ticks"));
  OtherTrainer other(folder->path(), state);
  ASSERT_TRUE(other.has_begun());
  EXPECT_FALSE(journal.find_cut_off());
  EXPECT_FALSE(journal.claim(state));
  JournalEntry own = state;
  own.session = folder->path() / "two.trocar";
  ASSERT_TRUE(write_file_atomically(own.session, "ticks"));
  ASSERT_TRUE(journal.begin(own));
  journal.clear();  // leaves the other's alone
  other.kill();
  const auto found = journal.find_cut_off();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->session, state.session);
  {
    const auto claim = journal.claim(*found);
    ASSERT_TRUE(claim);
    EXPECT_EQ(claim->entry().session, state.session);
    EXPECT_FALSE(journal.find_cut_off()) << "somebody opens it";
    EXPECT_FALSE(Journal(folder->path()).claim(*found));
  }
  ASSERT_TRUE(journal.find_cut_off()) << "it was not seen to its end: it is offered again";
  std::move(*journal.claim(*found)).forget();
  EXPECT_FALSE(journal.find_cut_off());
  EXPECT_FALSE(journal.claim(*found));
}

TEST_F(JournalTest, IgnoresItsOwnRunningAttempt) {
  ASSERT_TRUE(write_file_atomically(state.session, "ticks"));
  ASSERT_TRUE(journal.begin(state));
  EXPECT_FALSE(journal.find_cut_off());
  EXPECT_FALSE(Journal(folder->path()).find_cut_off());
}

TEST_F(JournalTest, FindsNothingWithoutASession) {
  {
    Journal cut_off(folder->path());
    ASSERT_TRUE(cut_off.begin(state));
  }
  EXPECT_FALSE(journal.find_cut_off());
}

TEST_F(JournalTest, SurvivesDamagedEntries) {
  ASSERT_TRUE(write_file_atomically(state.session, "ticks"));
  std::filesystem::create_directories(folder->path() / "attempts");
  for (const char* text : {"", "{", "[]", "{\"version\": 2}", "{\"version\": 1, \"session\": 3}", "\xff\xfe"}) {
    ASSERT_TRUE(write_file_atomically(folder->path() / "attempts" / "one.json", text));
    EXPECT_FALSE(journal.find_cut_off()) << text;
  }
}

TEST_F(JournalTest, IgnoresEntriesWithFieldsOfTheWrongType) {
  ASSERT_TRUE(write_file_atomically(state.session, "ticks"));
  {
    Journal cut_off(folder->path());
    ASSERT_TRUE(cut_off.begin(state));
  }
  const auto file = folder->path() / "attempts" / (state.session.stem().string() + ".json");
  const config::Json whole = config::load_json(file).value();
  ASSERT_TRUE(journal.find_cut_off());
  for (const auto& [key, value] : whole.items()) {
    config::Json damaged = whole;
    damaged[key] = nullptr;
    ASSERT_TRUE(write_file_atomically(file, damaged.dump()));
    EXPECT_FALSE(journal.find_cut_off()) << key;
  }
}

}  // namespace
}  // namespace trocar::attempt
