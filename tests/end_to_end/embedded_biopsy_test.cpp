// The whole line on the embedded patient: plan, perform, record, score, report.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>

#include "attempt.h"
#include "cases/scene_request.h"
#include "cases/testing/phantom_case.h"
#include "core/files/output_file.h"
#include "core/interruption.h"
#include "haptics/insertion/insertion_law.h"
#include "haptics/needle_geometry.h"
#include "report/html_report.h"

namespace trocar::testing {
namespace {

class EmbeddedBiopsy : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto prepared = phantom_case("abdomen");
    ASSERT_TRUE(prepared.has_value()) << prepared.error().text();
    the_case = new cases::Case(*std::move(prepared));
    expert = new Attempt(perform(*the_case, "expert"));
  }
  static void TearDownTestSuite() {
    delete expert;
    delete the_case;
    expert = nullptr;
    the_case = nullptr;
  }
  /// Of the needle against the one of the tissue table.
  static double size_factor() {
    return haptics::needle_size_factor(the_case->tissues.needle_size, 0.0, cases::needle_geometry(the_case->needle));
  }
  static inline cases::Case* the_case = nullptr;
  static inline Attempt* expert = nullptr;
};

TEST_F(EmbeddedBiopsy, ExpertMeetsThreePeaksAndReachesTheLesion) {
  expect_three_peaks(*expert);
  EXPECT_TRUE(expert->result.outcome.target_reached);
  EXPECT_GT(expert->result.outcome.score, 85.0);
  EXPECT_TRUE(expert->result.outcome.risks_touched.empty());
  ASSERT_TRUE(expert->result.outcome.best_core() != nullptr);
  EXPECT_GT(expert->result.outcome.best_core()->target_mm, 5.0);
}

TEST_F(EmbeddedBiopsy, NoviceScoresLowerThanTheExpert) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Attempt novice = perform(*the_case, "novice", seed);
    EXPECT_LT(novice.result.outcome.score, expert->result.outcome.score) << "seed " << seed;
    EXPECT_FALSE(novice.result.outcome.hints.empty());
  }
}

TEST_F(EmbeddedBiopsy, RecordsTheForceLawsOwnValues) {
  const anatomy::TissueTable& tissues = the_case->tissues;
  std::size_t layer = 0;
  std::size_t loaded = 0;
  for (const telemetry::TickSample& s : expert->session.samples) {
    const double along = s.f_prepuncture_n + s.f_friction_n + s.f_cutting_n;
    ASSERT_LT((s.f_total_n - s.axis * along - s.f_constraint_n - s.f_weight_n).norm(), 1e-9);
    if (s.f_prepuncture_n == 0.0) continue;
    const auto found = tissues.find_layer(expert->result.punctures.at(layer).layer);
    const anatomy::LayerParams& law = tissues.layers.at(*found);
    ASSERT_NEAR(-s.f_prepuncture_n,
                haptics::prepuncture_force_n(s.layer_displacement_mm, s.axial_velocity_mm_s,
                                             {law.stiffness_n_per_mm, law.viscosity_ns_per_mm, law.delta_x_mm}),
                1e-9);
    ++loaded;
    if (s.events[0].kind == telemetry::EventKind::kPuncture) ++layer;
  }
  EXPECT_GT(loaded, 300u);
}

TEST_F(EmbeddedBiopsy, ExpertReachesTheLesionWithEveryForceModel) {
  using Layers = std::vector<std::string>;
  const std::vector<std::pair<std::string, Layers>> models{
      {"proxy", {"skin", "liver_capsule"}}, {"combined", {"skin", "liver_capsule"}}};  // muscle: from the CT
  for (const auto& [model, layers] : models) {
    const Attempt attempt = perform(*the_case, "expert", 1, model);
    EXPECT_EQ(attempt.session.info.force_model, model);
    EXPECT_EQ(layers_of(attempt), layers) << model;
    EXPECT_TRUE(attempt.result.outcome.target_reached) << model;
    EXPECT_GT(attempt.result.outcome.score, 85.0) << model;
    for (const attempt::PunctureRecord& puncture : attempt.result.punctures) {
      const anatomy::LayerParams& layer = the_case->tissues.layers.at(*the_case->tissues.find_layer(puncture.layer));
      const double force_n = size_factor() * layer.puncture_force_n;
      EXPECT_NEAR(puncture.peak_n, force_n, 0.01 * force_n) << model << puncture.layer;
    }
    for (const telemetry::TickSample& s : attempt.session.samples) {
      const double along = s.f_prepuncture_n + s.f_friction_n + s.f_cutting_n + s.f_body_axial_n;
      ASSERT_LT((s.f_total_n - s.axis * along - s.f_constraint_n - s.f_tip_proxy_n - s.f_weight_n).norm(), 1e-9);
      ASSERT_EQ(s.f_friction_n, 0.0);
      if (model == "proxy") {
        ASSERT_EQ(s.f_prepuncture_n, 0.0);
        ASSERT_EQ(s.f_cutting_n, 0.0);
      }
    }
  }
}

TEST_F(EmbeddedBiopsy, SameSeedGivesTheSameAttempt) {
  const Attempt again = perform(*the_case, "expert");
  ASSERT_EQ(again.session.samples.size(), expert->session.samples.size());
  for (std::size_t i = 0; i < again.session.samples.size(); ++i)
    ASSERT_EQ(again.session.samples[i].f_total_n, expert->session.samples[i].f_total_n);
}

TEST_F(EmbeddedBiopsy, ReplayGivesTheSameForces) {
  const TemporaryFolder folder;
  attempt::RunOptions options;
  options.session = folder.path() / "first.trocar";
  ASSERT_TRUE(attempt::run_session(*the_case, options).has_value());
  const Attempt replay = perform(*the_case, "replay:" + options.session.string());
  ASSERT_EQ(replay.session.samples.size(), expert->session.samples.size());
  for (std::size_t i = 0; i < replay.session.samples.size(); ++i) {
    const telemetry::TickSample& now = replay.session.samples[i];
    const telemetry::TickSample& then = expert->session.samples[i];
    ASSERT_EQ(now.f_total_n, then.f_total_n) << i;
    ASSERT_EQ(now.tau_nmm, then.tau_nmm) << i;
    ASSERT_EQ(now.tip_mm, then.tip_mm) << i;
    ASSERT_EQ(now.device_rotation_wxyz, then.device_rotation_wxyz) << i;
  }
  EXPECT_EQ(replay.result.outcome.score, expert->result.outcome.score);
}

TEST_F(EmbeddedBiopsy, ReplayAppliesChangesAtTheirTick) {
  // The expert's motion, but the skin was made tougher while the needle came near: as a trainer's session tells it.
  const TemporaryFolder folder;
  const auto touch =
      std::ranges::find(expert->session.samples, telemetry::InsertionPhase::kLoading, &telemetry::TickSample::phase);
  const auto change = static_cast<std::size_t>(touch - expert->session.samples.begin()) - 100;
  anatomy::TissueTable tougher = the_case->tissues;
  ASSERT_TRUE(anatomy::apply_override(tougher, "skin.fp=6"));
  const std::filesystem::path file = folder / "changed.trocar";
  {
    auto writer = storage::SessionWriter::create(file, expert->session.info);
    ASSERT_TRUE(writer) << writer.error().text();
    for (const telemetry::TickSample& sample : expert->session.samples) ASSERT_TRUE(writer->append(sample));
    storage::SessionParameters parameters = expert->session.parameters.at(0);
    ASSERT_TRUE(writer->append(parameters));
    parameters.tick = change;
    parameters.time_s = expert->session.samples[change].time_s;
    parameters.settings = {"skin.fp=6"};
    parameters.tissue_table_toml = tougher.to_toml();
    ASSERT_TRUE(writer->append(parameters));
    ASSERT_TRUE(writer->finish(expert->result.outcome, expert->session.shots));
  }
  const Attempt replay = perform(*the_case, "replay:" + file.string());
  ASSERT_FALSE(replay.result.punctures.empty());
  EXPECT_NEAR(expert->result.punctures[0].peak_n, 2.8 * size_factor(), 0.028);
  EXPECT_NEAR(replay.result.punctures[0].peak_n, 6.0 * size_factor(), 0.06);
  ASSERT_EQ(replay.session.parameters.size(), 2u);
  EXPECT_EQ(replay.session.parameters[1].tick, change);
  EXPECT_EQ(replay.session.parameters[1].settings, std::vector<std::string>{"skin.fp=6"});
  // A replay of the replay makes the same forces.
  attempt::RunOptions options;
  options.operator_name = "replay:" + file.string();
  options.session = folder / "again.trocar";
  ASSERT_TRUE(attempt::run_session(*the_case, options));
  const Attempt third = perform(*the_case, "replay:" + options.session.string());
  ASSERT_EQ(third.session.samples.size(), replay.session.samples.size());
  for (std::size_t n = 0; n < third.session.samples.size(); ++n)
    ASSERT_LT((third.session.samples[n].f_total_n - replay.session.samples[n].f_total_n).norm(), 1e-6) << n;
}

TEST_F(EmbeddedBiopsy, ReplayKeepsItsSeedsAndRefusesAnotherPatient) {
  const TemporaryFolder folder;
  attempt::RunOptions options;
  options.seed = 42;
  options.session = folder / "seeded.trocar";
  const auto first = attempt::run_session(*the_case, options);
  ASSERT_TRUE(first) << first.error().text();
  const Attempt replay = perform(*the_case, "replay:" + options.session.string());
  EXPECT_EQ(replay.session.info.seed, 42u);
  EXPECT_NEAR(replay.result.outcome.score, first->outcome.score, 1e-6);

  cases::Case other = *the_case;
  auto changed = std::make_shared<anatomy::VirtualPatient>(*the_case->patient);
  changed->content_hash = "another";
  other.patient = changed;
  options.operator_name = "replay:" + options.session.string();
  options.session = folder / "other.trocar";
  const auto refused = attempt::run_session(other, options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().exit_status, 2);
  options.is_other_patient_meant = true;
  EXPECT_TRUE(attempt::run_session(other, options));
}

TEST_F(EmbeddedBiopsy, ReportShowsThePeaksByName) {
  const std::string page = report::html_report(expert->session, the_case->patient.get());
  for (const char* words : {"skin", "muscle", "liver capsule", "<svg", "data:image/png"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
}

TEST_F(EmbeddedBiopsy, SessionExportsOneRowATick) {
  const TemporaryFolder folder;
  ASSERT_TRUE(storage::export_csv(expert->session, folder.path() / "ticks.csv").has_value());
  const auto text = read_file(folder.path() / "ticks.csv");
  ASSERT_TRUE(text.has_value());
  EXPECT_EQ(static_cast<std::size_t>(std::count(text->begin(), text->end(), '\n')), expert->session.samples.size() + 1);
}

/// Runs an attempt in a process of its own that meets trouble at the `moment`-th progress step; gives its exit status.
int run_in_child(const cases::Case& the_case, const std::filesystem::path& session, int moment, void (*trouble)()) {
  const pid_t child = ::fork();
  if (child == 0) {
    handle_interruptions("trocar run");
    attempt::RunOptions options;
    options.patient_source = the_case.patient->name;
    options.session = session;
    int step = 0;
    const auto result = attempt::run_session(the_case, options, [&](std::string_view, double) {
      if (step++ == moment) trouble();
    });
    ::_exit(result ? 0 : result.error().exit_status);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST_F(EmbeddedBiopsy, AnInterruptionOrAFullDiskLeavesNothing) {
  constexpr int kEarly = 0, kRecording = 2, kLate = 5;  // a step is 2 s of an attempt
  for (const int moment : {kEarly, kRecording, kLate}) {
    for (void (*const trouble)() : {+[] { ::raise(SIGINT); }, +[] { ::raise(SIGTERM); },
                                    +[] {
                                      const rlimit limit{100'000, 100'000};
                                      ::setrlimit(RLIMIT_FSIZE, &limit);
                                    }}) {
      const TemporaryFolder folder;
      EXPECT_EQ(run_in_child(*the_case, folder / "a.session", moment, trouble), 1) << "step " << moment;
      EXPECT_TRUE(folder.is_empty()) << "step " << moment;
    }
  }
}

TEST_F(EmbeddedBiopsy, KeepsAKilledAttemptAsIncompleteAndAllowsARetry) {
  const TemporaryFolder folder;
  const std::filesystem::path session = folder / "a.session";
  EXPECT_EQ(run_in_child(*the_case, session, 3, [] { ::kill(::getpid(), SIGKILL); }), 128 + SIGKILL);
  const auto kept_as = storage::set_aside_incomplete_session(session);
  ASSERT_TRUE(kept_as.has_value() && kept_as->has_value());
  EXPECT_EQ(run_in_child(*the_case, session, -1, [] {}), 0);
  const auto incomplete = storage::load_session(**kept_as);
  ASSERT_TRUE(incomplete.has_value()) << incomplete.error().text();
  EXPECT_TRUE(incomplete->is_incomplete);
  EXPECT_GT(incomplete->samples.size(), 4000u);
  EXPECT_FALSE(storage::load_session(session)->is_incomplete);
}

}  // namespace
}  // namespace trocar::testing
