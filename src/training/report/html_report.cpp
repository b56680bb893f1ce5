#include "report/html_report.h"

#include "report/detail/force_plots.h"
#include "report/detail/html.h"
#include "report/detail/path_figure.h"
#include "report/detail/sections.h"
#include "report/detail/style.h"

namespace trocar::report {
using namespace detail;

std::filesystem::path report_file_of(const std::filesystem::path& session) {
  return std::filesystem::path(session).replace_extension(".report.html");
}

std::string html_report(const storage::Session& session, const anatomy::VirtualPatient* patient,
                        const ReportStory& story, const language::Language& language) {
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>";
  page += escape(title_of(session, story)) + ": session report</title><style>";
  page += style_sheet();
  page += "</style></head><body><main>";
  page += page_header(session, story);
  page += verdict_section(session);
  page += advice_section(session);
  page += score_section(session);
  page += steps_section(session, story);
  page += actions_section(story);
  page += core_section(session);
  page += bleeding_section(session);
  page +=
      "<section><h2>Force against depth</h2>" + force_depth_figure(session) + puncture_table(session) + "</section>";
  if (!session.samples.empty()) {
    page += "<section><h2>Forces over time</h2>" + force_time_figure(session) + motion_figure(session) + "</section>";
    page += "<section class=\"together\"><h2>The path</h2>" + path_figure(session, patient) + "</section>";
  }
  page += case_section(session);
  page += "<footer>Made by Trocar " + escape(session.info.program_version) +
          ", a training simulator and not a medical device. Lengths in mm, forces in N.</footer>";
  return language::translate_page(language, page + "</main></body></html>\n");
}

}  // namespace trocar::report
