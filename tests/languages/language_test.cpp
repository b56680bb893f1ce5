// Every language has words for what attempts at the four tasks say to a trainee.

#include "language/language.h"

#include <set>

#include "anatomy/structure_words.h"
#include "anatomy/tissue/tissue_parameters.h"
#include "anatomy/tissue/tissue_table.h"
#include "attempt/live/attempt_view.h"
#include "cases/testing/cached_case.h"
#include "core/files/folders.h"
#include "core/text.h"
#include "end_to_end/attempt.h"
#include "metrics/metric.h"
#include "phantom/phantom.h"
#include "report/html_report.h"
#include "tasks/action.h"
#include "tasks/task.h"

namespace trocar::testing {
namespace {

/// The texts of which a language has not every word.
class Lacking {
 public:
  explicit Lacking(const language::Language& language) : language_(language) {}
  void check(const std::string& text) {
    // One word with a digit is an identifier: a needle, a hash, a version.
    const bool is_name = names_.contains(text) ||
                         (text.find(' ') == std::string::npos && text.find_first_of("0123456789") != std::string::npos);
    if (!is_name && !language_.find(text)) texts_.insert(text);
  }
  /// A name: the same in every language.
  void allow(const std::string& name) { names_.insert(name); }
  std::string lines() const {
    std::string lines;
    for (const std::string& text : texts_) lines += text + "\n";
    return lines;
  }
  std::size_t count() const { return texts_.size(); }

 private:
  const language::Language& language_;
  std::set<std::string> names_, texts_;
};

std::vector<language::Language> other_languages() {
  std::vector<language::Language> languages;
  for (const language::LanguageEntry& entry : language::list_languages()) {
    const auto loaded = language::load_language(entry.code);
    EXPECT_TRUE(loaded) << loaded.error().text();
    if (loaded && !loaded->is_english()) languages.push_back(*loaded);
  }
  return languages;
}

/// The report of one attempt, with steps and actions, as the trainer makes it.
std::string report_of(const cases::Case& the_case, const char* operator_name) {
  const Attempt attempt = perform(the_case, operator_name, 3);
  report::ReportStory story;
  story.title = the_case.task.title;
  story.needs_image = the_case.task.guidance == tasks::ImagingModality::kUltrasound;
  for (const attempt::AttemptEvent& action :
       attempt::describe_actions(the_case.substances, attempt.session, the_case.patient.get()))
    story.actions.push_back({action.time_s, action.depth_mm, action.text});
  story.steps = report::step_times(attempt.session, the_case.task, *the_case.patient, the_case.needle, the_case.plan);
  return report::html_report(attempt.session, the_case.patient.get(), story);
}

TEST(Languages, TranslateEveryReport) {
  const std::vector<language::Language> languages = other_languages();
  ASSERT_FALSE(languages.empty());
  std::vector<Lacking> lacking(languages.begin(), languages.end());
  const std::pair<const char*, const char*> choices[] = {{"liver-biopsy", "biopsy-1"},
                                                         {"lumbar-puncture", "lumbar-1"},
                                                         {"ascites-puncture", "ascites-1"},
                                                         {"ptcd", "ptcd-1"}};
  for (const auto& [task, patient] : choices) {
    cases::CaseChoice choice;
    choice.options.task = task;
    choice.patient_source = patient;
    const auto open = open_cached_case(choice);
    ASSERT_TRUE(open) << patient << ": " << open.error().text();
    for (const char* operator_name : {"expert", "novice"}) {
      const std::vector<std::string> texts = language::texts_of_page(report_of((*open)->the_case, operator_name));
      EXPECT_GT(texts.size(), 100u);
      for (Lacking& one : lacking) {
        one.allow(patient);
        for (const std::string& text : texts) one.check(text);
      }
    }
  }
  for (std::size_t n = 0; n < languages.size(); ++n)
    EXPECT_EQ(lacking[n].count(), 0u) << languages[n].code() << " lacks:\n" << lacking[n].lines();
}

TEST(Languages, TranslateEveryTask) {
  const auto tasks = tasks::load_tasks(data_dir() / "tasks");
  ASSERT_TRUE(tasks) << tasks.error().text();
  const auto tutorial = tasks::load_task_file(data_dir() / "tutorial" / "first-puncture.toml", data_dir() / "tasks");
  ASSERT_TRUE(tutorial) << tutorial.error().text();
  const auto needles = tasks::load_needles(data_dir() / "needles.toml");
  ASSERT_TRUE(needles) << needles.error().text();
  const auto tissues = anatomy::load_tissue_table(data_dir() / "tissues.toml");
  ASSERT_TRUE(tissues) << tissues.error().text();
  std::vector<tasks::Task> all = *tasks;
  all.push_back(*tutorial);
  for (const language::Language& language : other_languages()) {
    Lacking lacking(language);
    for (const tasks::Task& task : all) {
      lacking.check(task.title);
      lacking.check(anatomy::structure_words(task.organ));
      for (const tasks::Phase& phase : task.phases) {
        lacking.check(phase.title);
        lacking.check(phase.why);
        for (const tasks::Condition& condition : phase.done) {
          std::string words = tasks::condition_words(condition);
          words.front() = ascii::to_upper(words.front());  // as the step shows it
          lacking.check(words);
        }
      }
    }
    for (const tasks::Needle& needle : *needles) lacking.check(needle.title);
    for (const metrics::MetricDescription& metric : metrics::metric_catalogue()) lacking.check(metric.title);
    for (const char* reason :
         {tasks::kServerWasAway, tasks::kServerSentNothing, tasks::kProgramDidNotRun, tasks::kSamplesWereLost})
      lacking.check(reason);
    for (const anatomy::TissueParameterGroup& group : anatomy::tissue_parameters(*tissues)) {
      // Unlabelled tissue, whose group the window names itself.
      if (group.name != "transfer") lacking.check(anatomy::structure_words(group.name));
      for (const anatomy::TissueParameter& parameter : group.parameters) lacking.check(std::string(parameter.name));
    }
    for (const phantom::PhantomInfo& info : phantom::embedded_patients()) {
      lacking.check(info.description);
      lacking.check(info.briefing);
      if (!info.referral) continue;
      for (const std::string* text :
           {&info.referral->indication, &info.referral->coagulation, &info.referral->allergies})
        lacking.check(*text);
    }
    EXPECT_EQ(lacking.count(), 0u) << language.code() << " lacks:\n" << lacking.lines();
  }
}

}  // namespace
}  // namespace trocar::testing
