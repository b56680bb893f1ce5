#include "attempt/record/attempt_record.h"

#include <gtest/gtest.h>

#include "attempt/live/attempt_view.h"
#include "attempt/record/session_case.h"
#include "core/files/folders.h"
#include "haptics/force_version.h"
#include "phantom/phantom.h"
#include "xray/tools/tool_shape.h"

namespace trocar::attempt {
namespace {

using enum tasks::ActionKind;

/// An attempt with a biopsy gun, recorded a sample at a time.
class GunRecordTest : public ::testing::Test {
 protected:
  void begin(bool is_biopsy, bool is_coaxial) {
    static const auto patient = phantom::generate_phantom("layers-liver");
    auto tables = cases::load_tables({});
    ASSERT_TRUE(patient.has_value() && tables.has_value());
    the_case_ = *std::move(tables);
    the_case_.patient = std::make_shared<const anatomy::VirtualPatient>(*patient);
    the_case_.plan.line_P = {Vec3::Zero(), Vec3(0.0, 50.0, 0.0)};
    the_case_.needle.is_biopsy = is_biopsy;
    the_case_.needle.is_coaxial = is_coaxial;
    RecordOptions options;
    options.session = folder_ / "attempt.session";
    options.longest_s = 50.0;
    auto record = AttemptRecord::create(the_case_, options, {"a device", 1000.0, "insertion", "", {}});
    ASSERT_TRUE(record.has_value()) << record.error().text();
    record_.emplace(*std::move(record));
  }
  void go_to(double depth_mm) {
    telemetry::TickSample sample;
    sample.time_s = 0.001 * static_cast<double>(record_->samples().size());
    sample.axis = Vec3::UnitY();
    sample.depth_mm = depth_mm;
    sample.tip_mm = {0.0, depth_mm, 0.0};
    telemetry::set_at_rest(sample);
    ASSERT_TRUE(record_->append(sample));
  }
  /// Length of the guide wire after it was advanced to `wanted_mm`.
  double advance_wire(double wanted_mm) {
    const auto action = record_->act({kAdvanceWire, wanted_mm});
    EXPECT_TRUE(action && *action);
    return action && *action ? (*action)->amount : -1.0;
  }
  /// The event's text; empty: refused.
  std::string act(tasks::ActionKind kind) {
    const auto action = record_->act({kind});
    EXPECT_TRUE(action) << action.error().text();
    return action && *action ? describe_action(the_case_.substances, **action).text : std::string();
  }
  /// Kinds of the actions in the file when the attempt ends here.
  std::vector<tasks::ActionKind> recorded_kinds() {
    EXPECT_TRUE(record_->finish());
    const auto session = storage::load_session(folder_ / "attempt.session");
    EXPECT_TRUE(session) << (session ? "" : session.error().text());
    std::vector<tasks::ActionKind> kinds;
    if (session)
      for (const tasks::Action& action : session->actions) kinds.push_back(action.kind);
    return kinds;
  }

  TemporaryFolder folder_;
  cases::Case the_case_;
  std::optional<AttemptRecord> record_;
};

TEST_F(GunRecordTest, DoesNotReallocateTicksWithinItsCapacity) {
  begin(true, true);
  go_to(0.0);
  const telemetry::TickSample* first = record_->samples().data();
  while (record_->samples().size() < 40'000) go_to(0.0);
  EXPECT_EQ(record_->samples().data(), first);
}

constexpr const char* kFired = "the gun was fired";
constexpr const char* kLoaded = "the gun is loaded again";

TEST_F(GunRecordTest, AnEmptyGunCannotBeFired) {
  begin(true, true);
  go_to(40.0);
  EXPECT_EQ(act(kFire), kFired);
  go_to(41.0);
  EXPECT_EQ(act(kFire), "");
  EXPECT_EQ(record_->shots(), std::vector<std::size_t>{0});
  EXPECT_EQ(act(kLoad), kLoaded);
  EXPECT_EQ(act(kLoad), "") << "it is loaded already";
  EXPECT_EQ(act(kFire), kFired);
  EXPECT_EQ(record_->shots(), (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(recorded_kinds(), (std::vector<tasks::ActionKind>{kFire, kLoad, kFire}));
}

TEST_F(GunRecordTest, LoadsOnlyOutsideWithoutACoaxialNeedle) {
  begin(true, false);
  go_to(40.0);
  EXPECT_EQ(act(kFire), kFired);
  for (const double depth_mm : {40.0, 10.0, 0.1}) {
    go_to(depth_mm);
    EXPECT_EQ(act(kLoad), "") << depth_mm;
    EXPECT_EQ(act(kFire), "") << "still empty";
  }
  go_to(0.0);
  EXPECT_EQ(act(kLoad), kLoaded);
  EXPECT_EQ(recorded_kinds(), (std::vector<tasks::ActionKind>{kFire, kLoad}));
}

TEST_F(GunRecordTest, DoesNotRecordImpossibleOperatorCommands) {
  begin(true, false);
  for (const tasks::ActionKind kind : {kFire, kFire, kLoad}) {
    tasks::HandCommand command;
    command.action = tasks::ActionRequest{kind};
    record_->note(command);
    go_to(40.0);
  }
  EXPECT_EQ(record_->shots(), std::vector<std::size_t>{0});
  EXPECT_EQ(recorded_kinds(), std::vector<tasks::ActionKind>{kFire});
}

TEST_F(GunRecordTest, RefusesGunActionsForAPlainNeedle) {
  begin(false, false);
  EXPECT_EQ(act(kReplaceStylet), "");
  go_to(40.0);
  EXPECT_EQ(act(kFire), "");
  EXPECT_EQ(act(kLoad), "");
  EXPECT_EQ(act(kReplaceStylet), "stylet reinserted");
  EXPECT_EQ(recorded_kinds(), std::vector<tasks::ActionKind>{kReplaceStylet});
}

/// A duct of 3 mm along the needle from 30 to 60 mm, closed there; behind the obstruction it goes on.
xray::DuctTree obstructed_duct() {
  xray::DuctTree tree;
  tree.cells.resize(2);
  tree.cells[0] = {Vec3(0.0, 30.0, 0.0), Vec3(0.0, 60.0, 0.0), 1.5, 1.5, -1, false, {}, {}};
  tree.cells[1] = {Vec3(0.0, 60.0, 0.0), Vec3(0.0, 100.0, 0.0), 1.5, 1.5, 0, true, {}, {}};
  return tree;
}

TEST_F(GunRecordTest, GuideWireStopsAtAnObstructionAndBucklesOutside) {
  begin(false, false);
  the_case_.ducts = std::make_shared<const xray::DuctTree>(obstructed_duct());
  go_to(40.0);
  EXPECT_NEAR(advance_wire(10.0), 10.0, 1e-9) << "in the duct";
  EXPECT_NEAR(advance_wire(50.0), 20.0, 1e-9) << "up to the obstruction";
  EXPECT_NEAR(advance_wire(350.0), 20.0, 1e-9) << "and never beyond";
  go_to(10.0);
  EXPECT_NEAR(advance_wire(50.0), xray::kWireInTissue_mm, 1e-9) << "no duct";
  the_case_.ducts.reset();
  EXPECT_NEAR(advance_wire(50.0), 50.0, 1e-9) << "a task without a way for it";
}

TEST_F(GunRecordTest, RecordsTheForceVersion) {
  begin(true, false);
  go_to(-1.0);
  record_.reset();
  const auto session = storage::load_session(folder_ / "attempt.session");
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_EQ(session->info.force_version, haptics::kForceVersion);
  EXPECT_EQ(other_forces_note(session->info), "");
  EXPECT_NE(other_forces_note(storage::SessionInfo()).find("recorded with version 1 of the forces"), std::string::npos);
}

}  // namespace
}  // namespace trocar::attempt
