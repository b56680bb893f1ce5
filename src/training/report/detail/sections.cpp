#include "report/detail/sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/detail/force_plots.h"
#include "report/detail/html.h"
#include "report/detail/verdict.h"

namespace trocar::report::detail {
namespace {

/// "2026-01-02T03:04:05Z" -> "2026-01-02 03:04 UTC"; other texts are unchanged.
std::string date_text(const std::string& utc) {
  if (utc.size() < 16 || utc[10] != 'T') return escape(utc);
  return escape(utc.substr(0, 10) + " " + utc.substr(11, 5) + " UTC");
}

std::string fact(const char* term, const std::string& escaped) {
  return escaped.empty() ? std::string() : fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", term, escaped);
}

/// The notch as a bar with its pieces to scale.
std::string core_bar(const scoring::BiopsyCore& core) {
  constexpr double kWidth = 760.0;
  constexpr double kMargin = 14.0;
  constexpr double kTickStep_mm = 5.0;
  double length_mm = 0.0;
  for (const scoring::CorePiece& piece : core.pieces) length_mm = std::max(length_mm, piece.to_mm);
  if (!(length_mm > 0.0)) return "<p>The core is empty.</p>";
  const auto x_of = [&](double mm) { return kMargin + mm / length_mm * (kWidth - 2.0 * kMargin); };
  std::string out = "<svg viewBox=\"0 0 760 78\" role=\"img\" aria-label=\"Tissue along the specimen notch\">";
  for (const scoring::CorePiece& piece : core.pieces) {
    const double x = x_of(piece.from_mm);
    const double width = x_of(piece.to_mm) - x;
    out += fmt::format(
        "<rect class=\"band piece {}\" x=\"{:.1f}\" y=\"6\" width=\"{:.1f}\" height=\"34\"><title>{}</title></rect>",
        tissue_style(piece.tissue), x, width, escape(words(piece.label)));
    if (text_width(piece.label, 12.0) + 8.0 < width)
      out += fmt::format("<text x=\"{:.1f}\" y=\"27\" text-anchor=\"middle\">{}</text>", x + 0.5 * width,
                         escape(words(piece.label)));
  }
  out += fmt::format("<rect class=\"frame\" x=\"{}\" y=\"6\" width=\"{}\" height=\"34\"/>", kMargin,
                     kWidth - 2.0 * kMargin);
  for (double mm = 0.0; mm <= length_mm + 1e-9; mm += kTickStep_mm)
    out += fmt::format(
        "<line class=\"axis\" x1=\"{0:.1f}\" y1=\"40\" x2=\"{0:.1f}\" y2=\"45\"/><text x=\"{0:.1f}\" y=\"57\" "
        "text-anchor=\"middle\">{1:.0f}</text>",
        x_of(mm), mm);
  return out +
         "<text class=\"title\" x=\"380\" y=\"74\" text-anchor=\"middle\">mm along the notch, from its hub "
         "end</text></svg>";
}

std::string case_row(const char* name, const std::string& value) {
  return value.empty() ? std::string() : fmt::format("<tr><th>{}</th><td>{}</td></tr>", name, escape(value));
}

std::string name_row(const char* term, const std::string& name) {
  return name.empty() ? std::string() : fmt::format("<tr><th>{}</th><td>{}</td></tr>", term, given_name(name));
}

/// Changes during the attempt with their times; settings of the user before it.
std::string changes_rows(const storage::Session& session) {
  std::string rows;
  for (const storage::SessionParameters& change : session.parameters) {
    if (change.settings.empty()) continue;
    std::string list;
    for (const std::string& setting : change.settings) list += (list.empty() ? "" : ", ") + setting;
    rows += case_row(change.tick == 0 ? "Set before the start" : "Parameters changed",
                     change.tick == 0 ? list : fmt::format("at {} s: {}", number_text(change.time_s, 2), list));
  }
  return rows;
}

/// Each interruption that a trainee notices, of many the longest ones, and the number of the others.
std::string interruption_rows(const storage::Session& session) {
  const Interruptions gaps = interruptions_of(session);
  std::string rows = case_row("Interruptions", gaps.many_text());
  for (const tasks::Interruption& gap : gaps.listed)
    rows += case_row("Interruption", fmt::format("at {} s: {} s, {}", number_text(gap.from_s, 2),
                                                 number_text(gap.to_s - gap.from_s, 2), gap.reason));
  return gaps.short_ones == 0 ? rows : rows + case_row("Short interruptions", gaps.short_text());
}

/// The tissue tables, each with the time from which on it was used.
std::string tissue_tables(const storage::Session& session) {
  const auto details = [](const std::string& title, const std::string& table) {
    return fmt::format("<details><summary>{}</summary><pre>{}</pre></details>", escape(title), escape(table));
  };
  const std::string* before = &session.info.tissue_table_toml;
  std::string out = before->empty() ? std::string() : details("Tissue table", *before);
  for (const storage::SessionParameters& change : session.parameters) {
    if (change.tissue_table_toml == *before) continue;
    before = &change.tissue_table_toml;
    out += details(fmt::format("Tissue table from {} s", number_text(change.time_s, 2)), *before);
  }
  return out;
}

}  // namespace

std::string title_of(const storage::Session& session, const ReportStory& story) {
  return story.title.empty() ? title_words(session.info.task) : story.title;
}

std::string page_header(const storage::Session& session, const ReportStory& story) {
  const storage::SessionInfo& info = session.info;
  return fmt::format(
      "<header><h1>{}: session report</h1><dl class=\"facts\">{}{}{}{}{}</dl>"
      "<p class=\"note\">Trocar is a training simulator, not a medical device.</p></header>",
      escape(title_of(session, story)), fact("Patient", given_name(info.patient_name)),
      fact("Operator", escape(info.operator_name)), fact("Level", escape(title_words(info.level))),
      fact("Date", date_text(info.started_utc)), fact("Trocar", escape(info.program_version)));
}

std::string core_section(const storage::Session& session) {
  if (!session.outcome || session.outcome->cores.empty()) return {};
  const std::vector<scoring::BiopsyCore>& cores = session.outcome->cores;
  std::string out =
      fmt::format("<section class=\"together\"><h2>{}</h2>", cores.size() == 1 ? "The core" : "The cores");
  for (const scoring::BiopsyCore& core : cores) {
    out += "<figure>" + core_bar(core) +
           fmt::format("<figcaption>Target tissue {} mm, organ {} mm, vessel {} mm, other {} mm.</figcaption></figure>",
                       number_text(core.target_mm, 1), number_text(core.organ_mm, 1), number_text(core.vessel_mm, 1),
                       number_text(core.other_mm, 1));
    if (!core.risks_in_throw.empty())
      out += fmt::format("<p class=\"warning\">The shot hit: <b>{}</b>.</p>", joined_words(core.risks_in_throw));
  }
  return out + "</section>";
}

std::string bleeding_section(const storage::Session& session) {
  if (!session.outcome || !session.outcome->bleeding) return {};
  const scoring::Bleeding& bleeding = *session.outcome->bleeding;
  std::string out = fmt::format("<section class=\"together\"><h2>Risk of bleeding: {}</h2>", to_string(bleeding.risk));
  if (bleeding.reasons.empty()) return out + "<p>No vessel was hit, and the channel can close.</p></section>";
  out += "<ul>";
  for (const std::string& reason : bleeding.reasons) out += "<li>" + escape(reason) + "</li>";
  return out + "</ul></section>";
}

std::string case_section(const storage::Session& session) {
  const storage::SessionInfo& info = session.info;
  const double duration_s =
      session.samples.empty() ? 0.0 : session.samples.back().time_s - session.samples.front().time_s;
  std::string out = "<section><h2>The case</h2><table class=\"list case\"><tbody>";
  out += case_row("Task", info.task + (info.is_parenchymal ? " (no lesion: healthy tissue of the organ)" : ""));
  out += name_row("Patient", info.patient_name);
  out += name_row("Patient's source", info.patient_source);
  out += case_row("Patient's hash", info.patient_hash);
  // An embedded patient by its name; a folder has no seed.
  if (info.patient_source == info.patient_name) out += case_row("Patient's seed", fmt::format("{}", info.patient_seed));
  out += case_row("Operator, seed", fmt::format("{}, {}", info.operator_name, info.seed));
  out += case_row("Level of help", info.level);
  out += case_row("Force model", info.force_model);
  if (const auto table = anatomy::parse_tissue_table(info.tissue_table_toml, "session");
      table && !table->origin.empty())
    out += case_row("Tissue table", table->origin);
  out += case_row("Needle", info.needle);
  out += case_row("Device", info.device);
  out += case_row("Recorded", fmt::format("{} ticks, {} s at {:g} Hz", session.samples.size(),
                                          number_text(duration_s, 1), info.rate_hz));
  if (!session.interruptions.empty())
    out += case_row("Active time",
                    fmt::format("{} s without interruptions",
                                number_text(tasks::active_time_s(0.0, duration_s, session.interruptions), 1)));
  out += interruption_rows(session);
  out += changes_rows(session);
  out += case_row("Hash of all ticks", session.ticks_hash);
  out += case_row("Program", fmt::format("Trocar {}, forces version {}", info.program_version, info.force_version));
  out += "</tbody></table>" + tissue_tables(session);
  return out + "</section>";
}

}  // namespace trocar::report::detail
