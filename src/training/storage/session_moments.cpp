#include "storage/session_moments.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

#include "core/files/output_file.h"
#include "core/text.h"
#include "scoring/attempt_end.h"
#include "storage/detail/columns.h"
#include "storage/session_file.h"

namespace trocar::storage {
namespace {

/// Moves `next` to the first sample later than a time; the sample in force is the one before.
template <class Sample>
const Sample* newest(const std::vector<Sample>& samples, std::size_t& next, double time_s) {
  while (next < samples.size() && samples[next].time_s <= time_s) ++next;
  return next == 0 ? nullptr : &samples[next - 1];
}

}  // namespace

void walk_moments(const Session& session, const std::function<void(const metrics::Moment&)>& visit) {
  std::size_t transducer = 0, xray = 0, gap = 0, damage = 0;
  for (std::size_t n = 0; n < session.samples.size(); ++n) {
    metrics::Moment moment = metrics::moment_of(session.samples[n]);
    if (const TransducerSample* sample = newest(session.transducer, transducer, moment.time_s)) {
      moment.X_PT = sample->X_PT;
      moment.contact_n = sample->contact_n;
    }
    if (const tasks::XrayUse* use = newest(session.xray, xray, moment.time_s)) moment.xray = *use;
    for (; gap < session.interruptions.size() && session.interruptions[gap].to_s <= moment.time_s; ++gap)
      moment.is_paused = n > 0;
    for (; damage < session.damage.size() && session.damage[damage].sample <= n; ++damage)
      moment.is_paused = moment.is_paused || (n > 0 && session.damage[damage].ticks > 0);
    visit(moment);
  }
}

std::optional<double> end_s_of(const Session& session, const tasks::Task* task, bool is_biopsy) {
  const auto end = scoring::end_of_attempt({session.samples, session.shots, session.actions, is_biopsy,
                                            task != nullptr ? task->confirmed_by : tasks::Substance::kNothing});
  return end ? std::optional(session.samples[*end].time_s) : std::nullopt;
}

metrics::MetricContext context_of(const Session& session) {
  metrics::MetricContext context;
  context.layer_names = session.info.layer_names;
  context.plane = session.info.plane;
  for (const std::size_t shot : session.shots)
    if (shot < session.samples.size()) context.shots_s.push_back(session.samples[shot].time_s);
  const anatomy::NeedlePath& plan = session.info.plan_P;
  if (plan.line_P.a.allFinite() && plan.line_P.b.allFinite() && plan.line_P.length_mm() > 0.0)
    context.expert_paths.push_back({plan.name.empty() ? "plan" : plan.name, plan.line_P});
  return context;
}

using namespace detail;
namespace {

constexpr std::size_t kBytesATick = 420;  ///< Usual length of a row, for reserving memory.

std::string name_of(const std::vector<std::string>& names, std::uint8_t id) {
  return id < names.size() ? names[id] : fmt::format("#{}", id);
}

/// A field according to RFC 4180, without formulas: quoted if it contains a comma, a quotation mark or a line break.
void append_text(std::string& out, const std::string& unguarded) {
  const std::string text = guard_formulas(unguarded);
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  out += '"';
}

std::string joined(const std::string& events, const std::string& mark) {
  return events.empty() || mark.empty() ? events + mark : events + ';' + mark;
}

/// The shortest digits that read back to the same double, independent of the locale.
void append_number(std::string& out, double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  out.append(digits, end);
}

void append_header(std::string& out) {
  const telemetry::TickSample sample;
  visit_columns(sample, [&](const char* name, const auto&) {
    out += name;
    out += ',';
  });
  out.back() = '\n';
}

/// Marks by sample: additional texts of the event column.
std::map<std::size_t, std::string> marks_of(const Session& session) {
  std::map<std::size_t, std::string> marks;
  if (session.samples.empty()) return marks;
  const std::size_t last = session.samples.size() - 1;
  const auto mark = [&](std::size_t sample, const std::string& text) {
    std::string& all = marks[std::min(sample, last)];
    all += (all.empty() ? "" : ";") + text;
  };
  for (const SessionDamage& damage : session.damage)
    if (damage.ticks > 0)
      mark(damage.sample, fmt::format("damaged:{}-{}", damage.first_tick, damage.first_tick + damage.ticks - 1));
  if (session.is_incomplete) mark(last, "incomplete");
  return marks;
}

/// Data of other tables for a tick, by its index.
using TickNotes = std::map<std::size_t, std::string>;

void add_note(TickNotes& notes, std::size_t tick, const std::string& text) {
  if (text.empty()) return;
  std::string& note = notes[tick];
  note += (note.empty() ? "" : ";") + text;
}

TickNotes notes_of(const Session& session) {
  TickNotes notes;
  const auto& samples = session.samples;
  for (const tasks::Interruption& gap : session.interruptions) {
    const auto after =
        std::lower_bound(samples.begin(), samples.end(), gap.to_s,
                         [](const telemetry::TickSample& sample, double t) { return sample.time_s < t; });
    if (after != samples.end()) add_note(notes, static_cast<std::size_t>(after - samples.begin()), event_text(gap));
  }
  for (const SessionParameters& change : session.parameters) add_note(notes, change.tick, event_text(change));
  return notes;
}

/// Text of the event column: notes before the tick, its events, marks of the record.
struct EventColumn {
  std::string note, mark;
};

void append_row(std::string& out, const SessionInfo& info, const telemetry::TickSample& sample,
                const EventColumn& beside) {
  visit_columns(sample, [&](const char*, const auto& field) {
    using Field = std::remove_cvref_t<decltype(field)>;
    if constexpr (std::is_same_v<Field, double>)
      append_number(out, field);
    else if constexpr (std::is_same_v<Field, std::uint8_t>)
      append_text(out, name_of(info.tissue_names, field));
    else if constexpr (std::is_enum_v<Field>)
      out += to_string(field);
    else if constexpr (std::is_same_v<Field, bool>)
      out += field ? '1' : '0';
    else
      append_text(out, joined(joined(beside.note, event_text(info, sample)), beside.mark));
    out += ',';
  });
  out.back() = '\n';
}

}  // namespace

std::string event_text(const SessionInfo& info, const telemetry::TickEvent& event) {
  switch (event.kind) {
    case telemetry::EventKind::kNone:
      return {};
    case telemetry::EventKind::kPuncture:
      return "puncture:" + name_of(info.layer_names, event.id);
    case telemetry::EventKind::kEnter:
      return "enter:" + name_of(info.label_names, event.id);
    case telemetry::EventKind::kLimit:
      return std::string("limit:") + to_string(static_cast<telemetry::LimitReason>(event.id));
  }
  return {};
}

std::string event_text(const SessionInfo& info, const telemetry::TickSample& sample) {
  std::string text;
  for (const telemetry::TickEvent& event : sample.events) {
    if (event.kind == telemetry::EventKind::kNone) continue;
    if (!text.empty()) text += ';';
    text += event_text(info, event);
  }
  return text;
}

std::string event_text(const SessionParameters& parameters) {
  std::string text;
  for (const std::string& setting : parameters.settings) text += (text.empty() ? "set:" : ";set:") + setting;
  return text;
}

std::string event_text(const tasks::Interruption& interruption) {
  return fmt::format("interruption:{:.3f}", interruption.to_s - interruption.from_s);
}

Status export_csv(const Session& session, const std::filesystem::path& path) {
  std::string text;
  text.reserve((session.samples.size() + 2) * kBytesATick);
  append_header(text);
  const std::map<std::size_t, std::string> notes = notes_of(session), marks = marks_of(session);
  const auto text_at = [](const std::map<std::size_t, std::string>& texts, std::size_t n) {
    const auto found = texts.find(n);
    return found == texts.end() ? std::string() : found->second;
  };
  for (std::size_t n = 0; n < session.samples.size(); ++n)
    append_row(text, session.info, session.samples[n], {text_at(notes, n), text_at(marks, n)});
  return write_file_atomically(path, text);
}

}  // namespace trocar::storage
