#include "pages/briefing_text.h"

#include <QCoreApplication>
#include <QRegularExpression>
#include <QStringList>
#include <algorithm>
#include <array>
#include <map>
#include <span>

#include "anatomy/structure_words.h"
#include "attempt/live/live_attempt.h"
#include "attempt/servers/haptic_servers.h"
#include "attempt/servers/server_host.h"
#include "choice/patient_entry.h"
#include "panels/action_buttons.h"
#include "phantom/phantom.h"
#include "scoring/score.h"
#include "tasks/fit_to_patient.h"
#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"
#include "volume/sampling.h"

namespace trocar::trainer {
namespace {

class BriefingText {
  Q_DECLARE_TR_FUNCTIONS(BriefingText)
};

QString escaped(const std::string& text) {
  return shown(text).toHtmlEscaped();
}

QString words(const std::string& name) {
  return escaped(anatomy::structure_words(name));
}

QString not_stated() {
  return QStringLiteral("<span style='color:%1'>%2</span>").arg(theme().dim.name(), BriefingText::tr("not stated"));
}

QString person_text(const std::string& name, const phantom::Referral& referral) {
  const double height_m = 0.01 * referral.height_cm;
  return BriefingText::tr("<b>%1</b>, %2, %3 years, %4 cm, %5 kg (BMI %6)")
      .arg(escaped(name), referral.is_female ? BriefingText::tr("female") : BriefingText::tr("male"))
      .arg(referral.age_years, 0, 'f', 0)
      .arg(referral.height_cm, 0, 'f', 0)
      .arg(referral.weight_kg, 0, 'f', 0)
      .arg(referral.weight_kg / (height_m * height_m), 0, 'f', 1);
}

/// Size of a label about a point: the extent along the axes of P until another label comes, mm.
Vec3 extent_mm(const anatomy::VirtualPatient& patient, const Vec3& middle_P, std::uint8_t id) {
  constexpr double kStep_mm = 0.25, kMost_mm = 150.0;
  Vec3 extent = Vec3::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double way : {-1.0, 1.0}) {
      double out_mm = 0.0;
      for (; out_mm < kMost_mm; out_mm += kStep_mm) {
        const anatomy::Label* label = find_label(patient, middle_P + way * out_mm * Vec3::Unit(axis));
        if (label == nullptr || label->id != id) break;
      }
      extent[axis] += out_mm;
    }
  }
  return extent;
}

/// Couinaud segment that the description of a procedural patient states for a lesion of that label ("liver_lesion_2"):
/// "lesions of the liver: 1 of 21 mm in segment VI, 2 of …"; empty: none.
QString stated_segment(const anatomy::VirtualPatient& patient, const std::string& label) {
  const QString number = to_qt(label).section(QLatin1Char('_'), -1);
  const QRegularExpression stated(
      QStringLiteral("[:,] %1 of [0-9]+ mm in segment ([IV]+)").arg(QRegularExpression::escape(number)));
  return stated.match(to_qt(patient.description)).captured(1);
}

/// Couinaud segment of a lesion, as the description states it, else of labels of liver segments around the lesion
/// ("liver_segment_6"); empty: not known.
QString segment_of(const anatomy::VirtualPatient& patient, const anatomy::Label& lesion, const Vec3& middle_P,
                   double radius_mm) {
  constexpr std::string_view kLabel = "liver_segment_";
  if (const QString stated = stated_segment(patient, lesion.name); !stated.isEmpty()) return stated;
  static constexpr std::array kNumerals{"I", "II", "III", "IV", "V", "VI", "VII", "VIII"};
  constexpr double kBeside_mm = 4.0;
  std::map<std::string, int> votes;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const Vec3 way = Vec3(x, y, z).normalized();
        const anatomy::Label* label = find_label(patient, middle_P + (radius_mm + kBeside_mm) * way);
        if (label != nullptr && label->name.starts_with(kLabel)) ++votes[label->name.substr(kLabel.size())];
      }
  const auto most =
      std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most == votes.end()) return {};
  const int number = to_qt(most->first).toInt();
  return number >= 1 && number <= 8 ? QString::fromLatin1(kNumerals[static_cast<std::size_t>(number - 1)])
                                    : escaped(most->first);
}

QString lesion_text(const cases::Case& the_case) {
  const anatomy::VirtualPatient& patient = *the_case.patient;
  const Segment& path_P = the_case.plan.line_P;
  const Vec3 middle_P = path_P.b + the_case.needle.notch_middle_mm() * path_P.direction();
  const anatomy::Label* label = find_label(patient, middle_P);
  if (label == nullptr || !tasks::is_target(the_case.task, *label)) return {};
  const Vec3 size_mm = extent_mm(patient, middle_P, label->id);
  QString text = BriefingText::tr("%1 × %2 × %3 mm")
                     .arg(size_mm.x(), 0, 'f', 0)
                     .arg(size_mm.y(), 0, 'f', 0)
                     .arg(size_mm.z(), 0, 'f', 0);
  text = BriefingText::tr("lesion of %1 (right–left, front–back, head–feet)").arg(text);
  if (const QString segment = segment_of(patient, *label, middle_P, 0.5 * size_mm.maxCoeff()); !segment.isEmpty())
    text = BriefingText::tr("%1 in segment %2 of the %3").arg(text, segment, words(the_case.task.organ));
  const double depth_mm = -volume::sample_linear(patient.skin_distance_mm, middle_P);
  return depth_mm > 0.0 ? BriefingText::tr("%1; middle %2 mm below the nearest skin").arg(text).arg(depth_mm, 0, 'f', 0)
                        : text;
}

bool is_target_tissue(const tasks::Task& task, std::string_view tissue) {
  return std::find(task.target_tissues.begin(), task.target_tissues.end(), tissue) != task.target_tissues.end();
}

QString goal_text(const tasks::Task& task, std::optional<bool> is_parenchymal) {
  if (is_target_tissue(task, "csf"))
    return BriefingText::tr("Bring the needle's tip into the spinal fluid of the dural sac.");
  if (is_target_tissue(task, "ascites"))
    return BriefingText::tr("Bring the needle's tip into the free fluid of the abdomen.");
  if (is_target_tissue(task, "bile_duct"))
    return BriefingText::tr("Bring the needle's tip into a bile duct of the liver.");
  if (!is_parenchymal)
    return BriefingText::tr("Bring the needle's tip to the lesion of the %1; without a lesion, to its healthy tissue.")
        .arg(words(task.organ));
  return (*is_parenchymal ? BriefingText::tr("Bring the needle's tip to the healthy tissue of the %1.")
                          : BriefingText::tr("Bring the needle's tip to the lesion of the %1."))
      .arg(words(task.organ));
}

QString guidance_text(tasks::ImagingModality guidance) {
  switch (guidance) {
    case tasks::ImagingModality::kUltrasound:
      return BriefingText::tr("ultrasound");
    case tasks::ImagingModality::kXray:
      return BriefingText::tr("fluoroscopy (X-ray)");
    case tasks::ImagingModality::kPalpation:
      return BriefingText::tr("palpation of the landmarks");
  }
  return {};
}

/// The title has gauge, length and throw.
QString needle_text(const tasks::Needle& needle) {
  QString text =
      BriefingText::tr("%1; %2 mm thick").arg(escaped(needle.title)).arg(needle.outer_diameter_mm, 0, 'f', 2);
  if (needle.is_biopsy)
    text += BriefingText::tr(", notch of %1 mm; the stylet shoots %2 mm beyond the tip")
                .arg(needle.notch_mm, 0, 'f', 0)
                .arg(needle.throw_mm, 0, 'f', 0);
  return text;
}

QString steps_text(const std::vector<tasks::Phase>& phases) {
  QStringList lines;
  for (const tasks::Phase& phase : phases)
    lines << BriefingText::tr("%1. %2").arg(lines.size() + 1).arg(escaped(phase.title));
  return lines.join(QStringLiteral("<br>"));
}

/// How a part of the score is judged, after its title; empty: the title says it.
QString rule_of(const tasks::Task& task, std::string_view part) {
  const auto half = [](double tolerance, const char* unit) {
    return BriefingText::tr("half of the points at %1%2").arg(tolerance, 0, 'f', 0).arg(QString::fromUtf8(unit));
  };
  if (part == "target") return half(task.target_tolerance_mm, " mm");
  if (part == "entry") return half(task.entry_tolerance_mm, " mm");
  if (part == "angle") return half(task.angle_tolerance_deg, "°");
  if (part == "bevel" && task.bevel) return half(task.bevel->tolerance_deg, "°");
  if (part == "passes") return BriefingText::tr("one needless puncture or shot halves the points");
  if (part == "access") return half(task.margin_tolerance_mm, " mm");
  if (part == "bevel" && task.bevel) return half(task.bevel->tolerance_deg, "°");
  if (part == "time") return BriefingText::tr("none from %1 s on").arg(task.time_limit_s, 0, 'f', 0);
  if (part == "dose") return BriefingText::tr("none from %1 Gy cm² on").arg(task.dose_limit_gycm2, 0, 'g', 3);
  if (part == "comfort") return BriefingText::tr("one of them halves the points");
  if (part == "confirmation")
    return BriefingText::tr("%1 comes back").arg(escaped(tasks::substance_words(task.confirmed_by)));
  if (part == "risk") return BriefingText::tr("none with major harm, minor harm costs 40 %");
  return {};
}

/// Parts that an attempt is judged by, the heaviest first.
std::vector<std::pair<std::string, double>> weighed_parts(const cases::Case& tables) {
  const bool has_transducer = tables.task.guidance == tasks::ImagingModality::kUltrasound;
  auto parts = scoring::judged_parts(tables.task, tables.needle, has_transducer);
  std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return parts;
}

QString points_table(const cases::Case& tables) {
  QString text = QStringLiteral("<table cellspacing='0' cellpadding='1'>");
  for (const auto& [name, points] : weighed_parts(tables)) {
    QString what = shown(scoring::part_title(name)).toHtmlEscaped();
    if (const QString rule = rule_of(tables.task, name); !rule.isEmpty())
      what += QStringLiteral(" <span style='color:%1'>(%2)</span>").arg(theme().dim.name(), rule);
    text += QStringLiteral("<tr><td align='right'><b>%1</b>&nbsp;&nbsp;</td><td>%2</td></tr>")
                .arg(points, 0, 'f', 0)
                .arg(what);
  }
  return text + QStringLiteral("</table>");
}

QString risks_text(const tasks::Task& task) {
  QStringList risks;
  for (const tasks::RiskStructure& risk : task.risks) risks << words(risk.label.empty() ? risk.tissue : risk.label);
  return risks.join(QStringLiteral(", "));
}

/// Structures of the patient whose harm fails the attempt, each kind once.
QString failing_text(const cases::Case& the_case) {
  QStringList names;
  if (the_case.patient == nullptr) return {};
  for (const anatomy::Label& label : the_case.patient->label_table.labels) {
    if (tasks::find_harm(the_case.task, label).grade != tasks::Harm::kCritical) continue;
    const bool is_own_name = label.tissue == "organ" || label.tissue == "vessel" || label.tissue == "nerve";
    const QString name = words(is_own_name ? label.name : label.tissue);
    if (!names.contains(name)) names << name;
  }
  return names.join(QStringLiteral(", "));
}

struct Control {
  const char* with;
  const char* does;
};
constexpr Control kNeedleByGamepad[] = {
    {QT_TRANSLATE_NOOP("Table", "left stick"),
     QT_TRANSLATE_NOOP("Table", "moves the needle; cross: lifts and lowers it")},
    {QT_TRANSLATE_NOOP("Table", "right stick"),
     QT_TRANSLATE_NOOP("Table", "swings the tip in the direction of the stick")},
    {QT_TRANSLATE_NOOP("Table", "triggers"),
     QT_TRANSLATE_NOOP("Table", "right: push in, left: pull out; rumble: resistance")},
    {QT_TRANSLATE_NOOP("Table", "shoulders"), QT_TRANSLATE_NOOP("Table", "turn the bevel")}};
constexpr Control kProbeByGamepad[] = {
    {QT_TRANSLATE_NOOP("Table", "left stick"),
     QT_TRANSLATE_NOOP("Table", "moves the transducer; cross: lifts and lowers it")},
    {QT_TRANSLATE_NOOP("Table", "right stick"), QT_TRANSLATE_NOOP("Table", "tilts it")},
    {QT_TRANSLATE_NOOP("Table", "shoulders"), QT_TRANSLATE_NOOP("Table", "turn it")}};
constexpr Action kByMouse[] = {Action::kMove, Action::kTilt, Action::kAdvance, Action::kAdvanceFinely};

void add_action(std::vector<BriefingRow>& rows, Action action) {
  rows.push_back({keys_text(action), does_text(action)});
}

void add_controls(std::vector<BriefingRow>& rows, std::span<const Control> controls) {
  for (const Control& control : controls)
    rows.push_back({BriefingText::tr(control.with), BriefingText::tr(control.does)});
}

/// Rows for devices other than the mouse.
void add_device(std::vector<BriefingRow>& rows, const std::string& device, bool is_needle) {
  if (device == "gamepad") {
    if (is_needle) return add_controls(rows, kNeedleByGamepad);
    return add_controls(rows, kProbeByGamepad);
  }
  const QString tool = is_needle ? BriefingText::tr("needle") : BriefingText::tr("transducer");
  if (device == "spacemouse")
    return rows.push_back(
        {BriefingText::tr("cap"), BriefingText::tr("push and turn it to move and turn the %1").arg(tool)});
  rows.push_back({shown(attempt::device_title(device)), BriefingText::tr("its stylus is the %1").arg(tool)});
}

}  // namespace

bool is_lesion_task(const tasks::Task& task) {
  return !is_target_tissue(task, "csf") && !is_target_tissue(task, "ascites") && !is_target_tissue(task, "bile_duct");
}

std::vector<BriefingRow> referral_rows(const TrainerChoice& choice) {
  const std::optional<phantom::PhantomInfo> info = phantom::find_embedded_patient(choice.patient);
  if (info && info->referral) {
    const phantom::Referral& referral = *info->referral;
    return {{BriefingText::tr("Patient"), person_text(info->name, referral)},
            {BriefingText::tr("Indication"), escaped(referral.indication)},
            {BriefingText::tr("Coagulation"), escaped(referral.coagulation)},
            {BriefingText::tr("Allergies"), escaped(referral.allergies)},
            {BriefingText::tr("Posture"), escaped(std::string(posture_words(referral.posture)))}};
  }
  const PatientEntry entry = info ? PatientEntry{{}, to_qt(info->name), {}, shown(info->description), {}, {}}
                                  : folder_entry(to_qt(choice.patient));
  return {
      {BriefingText::tr("Patient"), QStringLiteral("<b>%1</b>").arg(entry.name.toHtmlEscaped())},
      {BriefingText::tr("Description"), entry.description.isEmpty() ? not_stated() : entry.description.toHtmlEscaped()},
      {BriefingText::tr("Indication"), not_stated()},
      {BriefingText::tr("Coagulation"), not_stated()},
      {BriefingText::tr("Allergies"), not_stated()}};
}

std::vector<BriefingRow> finding_rows(const cases::Case& the_case) {
  std::vector<BriefingRow> rows;
  const std::optional<phantom::PhantomInfo> info = phantom::find_embedded_patient(the_case.patient->name);
  if (!info || !info->referral)
    rows.push_back({BriefingText::tr("Posture"),
                    escaped(std::string(posture_words(tasks::posture_of(the_case.task, *the_case.patient))))});
  if (!is_lesion_task(the_case.task)) return rows;
  const QString lesion = the_case.is_parenchymal ? QString() : lesion_text(the_case);
  if (!lesion.isEmpty()) {
    rows.push_back({BriefingText::tr("Finding"), lesion});
  } else {
    rows.push_back({BriefingText::tr("Finding"),
                    the_case.is_parenchymal
                        ? BriefingText::tr("no lesion: take healthy tissue of the %1").arg(words(the_case.task.organ))
                        : BriefingText::tr("lesion of the %1").arg(words(the_case.task.organ))});
  }
  return rows;
}

std::vector<BriefingRow> procedure_rows(const cases::Case& tables, std::optional<bool> is_parenchymal) {
  std::vector<BriefingRow> rows{{BriefingText::tr("Goal"), goal_text(tables.task, is_parenchymal)},
                                {BriefingText::tr("Guidance"), guidance_text(tables.task.guidance)},
                                {BriefingText::tr("Needle"), needle_text(tables.needle)}};
  if (!tables.task.phases.empty()) rows.push_back({BriefingText::tr("Steps"), steps_text(tables.task.phases)});
  return rows;
}

BriefingRow path_row(const cases::Case& the_case) {
  const tasks::PlannedPath& plan = the_case.plan;
  QString text = BriefingText::tr("%1 mm long").arg(plan.length_mm, 0, 'f', 0);
  if (plan.organ_path_mm >= 1.0)  // else the path ends where the organ begins: a space filled with fluid
    text +=
        BriefingText::tr(", %1 mm of it in the %2").arg(plan.organ_path_mm, 0, 'f', 0).arg(words(the_case.task.organ));
  text += BriefingText::tr("; nearest structure at risk: %1")
              .arg(plan.nearest_risk.empty() ? BriefingText::tr("none") : words(plan.nearest_risk));
  return {BriefingText::tr("Planned path"), text};
}

std::vector<BriefingRow> scoring_rows(const cases::Case& tables) {
  const tasks::Task& task = tables.task;
  std::vector<BriefingRow> rows{
      {BriefingText::tr("Points"), points_table(tables)},
      {BriefingText::tr("Passed"),
       BriefingText::tr("with %1 of 100 points and the target reached").arg(task.pass_mark, 0, 'f', 0)}};
  if (!task.risks.empty()) rows.push_back({BriefingText::tr("Do not touch"), risks_text(task)});
  if (const QString failing = failing_text(tables); !failing.isEmpty())
    rows.push_back(
        {BriefingText::tr("Not passed"), BriefingText::tr("whatever the points, after touching: %1").arg(failing)});
  if (task.highest_entry)
    rows.push_back({BriefingText::tr("Not passed"),
                    BriefingText::tr("whatever the points: %1").arg(escaped(task.highest_entry->reason))});
  return rows;
}

std::vector<BriefingRow> control_rows(const TrainerChoice& choice, const cases::Case* tables) {
  const bool is_needle_led = attempt::follows_targets(choice.needle_device);
  const bool is_probe_led = attempt::follows_targets(choice.probe_device);
  std::vector<BriefingRow> rows;
  if (is_needle_led || is_probe_led) {
    if (is_needle_led) add_action(rows, Action::kSelectNeedle);
    if (is_probe_led) add_action(rows, Action::kSelectTransducer);
    for (const Action action : kByMouse) add_action(rows, action);
  }
  if (!is_needle_led) add_device(rows, choice.needle_device, true);
  if (!is_probe_led) add_device(rows, choice.probe_device, false);
  if (choice.mode == TrainingMode::kGuided && is_needle_led) add_action(rows, Action::kPlannedPosition);
  if (tables != nullptr) {
    if (tables->needle.is_biopsy) add_action(rows, Action::kFire);
    for (const Action action : actions_of(tables->task, tables->needle)) add_action(rows, action);
    if (tables->task.guidance == tasks::ImagingModality::kXray) {
      add_action(rows, Action::kFluoroscopy);
      add_action(rows, Action::kContrast);
    }
    if (tables->task.guidance == tasks::ImagingModality::kPalpation) add_action(rows, Action::kSelectFinger);
  }
  for (const Action action : {Action::kEnd, Action::kForces, Action::kKeys}) add_action(rows, action);
  return rows;
}

QString form_html(const std::vector<BriefingRow>& rows) {
  QString text = QStringLiteral("<table cellspacing='0' cellpadding='3' width='100%'>");
  for (const BriefingRow& row : rows)
    text += QStringLiteral("<tr><td width='100' style='color:%1'>%2</td><td>%3</td></tr>")
                .arg(theme().dim.name(), row.heading.toHtmlEscaped(), row.text);
  return text + QStringLiteral("</table>");
}

Result<cases::Case> load_briefing_tables(const TrainerChoice& choice) {
  cases::CaseOptions options;
  options.patient_folder = choice.patient;
  options.task = cases::has_own_task(choice.patient) ? std::string() : choice.task;
  options.needle = choice.needle;
  return cases::load_tables(options);
}

}  // namespace trocar::trainer
