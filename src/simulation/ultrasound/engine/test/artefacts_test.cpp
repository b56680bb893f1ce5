#include <gtest/gtest.h>

#include <string>

#include "ultrasound/engine/echo_engine.h"

namespace trocar::ultrasound {
namespace {

int count_on(const Artefacts& a) {
  return a.attenuation + a.downshift + a.reverberation + a.mirror + a.refraction + a.range_distortion + a.side_lobes +
         a.contact_loss + a.clutter + a.noise;
}

TEST(Artefacts, DisablesOneByName) {
  const auto names = artefact_names();
  EXPECT_EQ(names.size(), sizeof(Artefacts));
  Artefacts together;
  for (std::size_t n = 0; n < names.size(); ++n) {
    Artefacts alone;
    ASSERT_TRUE(switch_off(alone, names[n]));
    EXPECT_EQ(count_on(alone), static_cast<int>(names.size()) - 1) << names[n];
    ASSERT_TRUE(switch_off(together, names[n]));
    EXPECT_EQ(count_on(together), static_cast<int>(names.size() - n) - 1) << names[n];
  }
}

TEST(Artefacts, AllDisablesEveryArtefact) {
  Artefacts artefacts;
  ASSERT_TRUE(switch_off(artefacts, "all"));
  EXPECT_EQ(count_on(artefacts), 0);
}

TEST(Artefacts, UnknownNameListsTheKnownOnes) {
  Artefacts artefacts;
  for (const char* name : {"", "Noise", "ghosts"}) {
    const Status status = switch_off(artefacts, name);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().exit_status, 2);
    EXPECT_NE(status.error().text().find("side-lobes"), std::string::npos);
  }
  EXPECT_EQ(count_on(artefacts), static_cast<int>(artefact_names().size()));
}

}  // namespace
}  // namespace trocar::ultrasound
