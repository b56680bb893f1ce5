#include "station/journal.h"

#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "core/temporary_folder.h"

namespace trocar {
namespace {

struct JournalTest : testing::Test {
  JournalTest() : folder(std::make_unique<TemporaryFolder>()), journal(folder->path()) {
    state.choice.patient_source = "layers-liver";
    state.choice.patient_seed = 7;
    state.choice.force_model = "proxy";
    state.choice.options.overrides = {"liver.k=0.5"};
    state.session = folder->path() / "one.trocar";
  }
  std::unique_ptr<TemporaryFolder> folder;
  Journal journal;
  SeatState state;
};

TEST_F(JournalTest, NothingIsCutOffAtFirstOrAfterAnEnd) {
  EXPECT_FALSE(journal.recover());
  ASSERT_TRUE(write_file_atomically(state.session, "ticks"));
  ASSERT_TRUE(journal.begin(state));
  journal.clear();
  EXPECT_FALSE(journal.recover());
}

TEST_F(JournalTest, WhatWasUnderWayComesBack) {
  ASSERT_TRUE(write_file_atomically(state.session, "ticks"));
  ASSERT_TRUE(journal.begin(state));
  const auto found = journal.recover();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->session, state.session);
  EXPECT_TRUE(found->choice == state.choice);
}

TEST_F(JournalTest, WithoutItsSessionThereIsNothingToRecover) {
  ASSERT_TRUE(journal.begin(state));
  EXPECT_FALSE(journal.recover());
}

TEST_F(JournalTest, DamageIsNoCrash) {
  ASSERT_TRUE(write_file_atomically(state.session, "ticks"));
  for (const char* text : {"", "{", "[]", "{\"version\": 2}", "{\"version\": 1, \"session\": 3}", "\xff\xfe"}) {
    ASSERT_TRUE(write_file_atomically(folder->path() / "seat.json", text));
    EXPECT_FALSE(journal.recover()) << text;
  }
}

}  // namespace
}  // namespace trocar
