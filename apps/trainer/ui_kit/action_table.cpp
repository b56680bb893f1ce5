#include "ui_kit/action_table.h"

#include <QCoreApplication>
#include <QKeyEvent>
#include <QStringList>
#include <algorithm>

#include "core/result.h"

namespace trocar::trainer {
namespace {

// A key that acts on the patient is marked true. The translations of these texts have the context "Action".
constexpr ActionRow kTable[] = {
    {Action::kSelectNeedle, Scope::kPuncture, "A", "", QT_TRANSLATE_NOOP("Action", "select the needle")},
    {Action::kSelectTransducer, Scope::kPuncture, "S", "", QT_TRANSLATE_NOOP("Action", "select the transducer")},
    {Action::kSelectFinger, Scope::kPuncture, "P", "", QT_TRANSLATE_NOOP("Action", "select the palpating finger")},
    {Action::kSelectView, Scope::kPuncture, "V", "",
     QT_TRANSLATE_NOOP("Action", "select no tool: the mouse rotates the view")},
    {Action::kMove, Scope::kPuncture, "Left Right Up Down", QT_TRANSLATE_NOOP("Action", "drag; arrow keys"),
     QT_TRANSLATE_NOOP("Action", "move the tool along the skin")},
    {Action::kTilt, Scope::kPuncture, "Shift+Left Shift+Right Shift+Up Shift+Down",
     QT_TRANSLATE_NOOP("Action", "right drag; Shift + arrow keys"), QT_TRANSLATE_NOOP("Action", "tilt the tool")},
    {Action::kTurn, Scope::kPuncture, "", QT_TRANSLATE_NOOP("Action", "Shift + right drag"),
     QT_TRANSLATE_NOOP("Action", "turn the tool about its axis")},
    {Action::kAdvance, Scope::kPuncture, "PgUp PgDown", QT_TRANSLATE_NOOP("Action", "wheel; Page up, Page down"),
     QT_TRANSLATE_NOOP("Action", "advance or withdraw the needle; press the transducer harder or softer")},
    {Action::kAdvanceFinely, Scope::kPuncture, "Shift+PgUp Shift+PgDown",
     QT_TRANSLATE_NOOP("Action", "Shift + wheel; Shift + Page up, Page down"),
     QT_TRANSLATE_NOOP("Action", "the same in steps of 0.1 mm")},
    {Action::kRotateView, Scope::kPuncture, "", QT_TRANSLATE_NOOP("Action", "Ctrl + drag"),
     QT_TRANSLATE_NOOP("Action", "rotate the view while a tool is selected")},
    {Action::kPlannedPosition, Scope::kPuncture, "H", "",
     QT_TRANSLATE_NOOP("Action", "move the tool to its planned position (guided attempts)"), true},
    {Action::kLock, Scope::kPuncture, "X", "", QT_TRANSLATE_NOOP("Action", "hold the tool in place, or release it")},
    {Action::kFire, Scope::kPuncture, "Return Enter", "", QT_TRANSLATE_NOOP("Action", "fire the biopsy gun"), true},
    {Action::kLoad, Scope::kPuncture, "Y", "", QT_TRANSLATE_NOOP("Action", "take the core out and load the biopsy gun"),
     true},
    {Action::kAnaesthetic, Scope::kPuncture, "N", "", QT_TRANSLATE_NOOP("Action", "inject local anaesthetic"), true},
    {Action::kStylet, Scope::kPuncture, "Y", "", QT_TRANSLATE_NOOP("Action", "remove or reinsert the stylet"), true},
    {Action::kAspirate, Scope::kPuncture, "Q", "", QT_TRANSLATE_NOOP("Action", "aspirate with a syringe"), true},
    {Action::kWire, Scope::kPuncture, "W", "", QT_TRANSLATE_NOOP("Action", "advance the guide wire"), true},
    {Action::kBreath, Scope::kPuncture, "U", "",
     QT_TRANSLATE_NOOP("Action", "ask for a breath hold, or let the patient breathe again"), true},
    {Action::kFluoroscopy, Scope::kPuncture, "Z", QT_TRANSLATE_NOOP("Action", "Z (hold)"),
     QT_TRANSLATE_NOOP("Action", "fluoroscopy, while the X-ray view is visible"), true},
    {Action::kContrast, Scope::kPuncture, "J", QT_TRANSLATE_NOOP("Action", "J (hold)"),
     QT_TRANSLATE_NOOP("Action", "inject contrast agent at the needle tip"), true},
    {Action::kMark, Scope::kPuncture, "Return Enter", QT_TRANSLATE_NOOP("Action", "click; Enter"),
     QT_TRANSLATE_NOOP("Action", "mark the skin under the finger"), true},
    {Action::kRemoveMark, Scope::kPuncture, "Backspace", "", QT_TRANSLATE_NOOP("Action", "remove the last mark")},
    {Action::kForces, Scope::kPuncture, "Space", "",
     QT_TRANSLATE_NOOP("Action", "stop all forces, or switch them on again")},
    {Action::kEnd, Scope::kPuncture, "E", "",
     QT_TRANSLATE_NOOP("Action", "end and score the attempt; asks for confirmation"), true},
    {Action::kConfirm, Scope::kPuncture, "Return Enter", "", QT_TRANSLATE_NOOP("Action", "answer a question with yes"),
     true},
    {Action::kDecline, Scope::kPuncture, "Esc", "", QT_TRANSLATE_NOOP("Action", "answer a question with no")},

    {Action::kPlay, Scope::kFeedback, "Space", "", QT_TRANSLATE_NOOP("Action", "play or pause the replay")},
    {Action::kNextEvent, Scope::kFeedback, "N", "", QT_TRANSLATE_NOOP("Action", "next event of the replay")},
    {Action::kPreviousEvent, Scope::kFeedback, "P", "", QT_TRANSLATE_NOOP("Action", "previous event of the replay")},
    {Action::kWorstMoment, Scope::kFeedback, "W", "", QT_TRANSLATE_NOOP("Action", "worst moment of the replay")},
    {Action::kNextHint, Scope::kFeedback, "H", "", QT_TRANSLATE_NOOP("Action", "moment of the next hint")},
    {Action::kTryAgain, Scope::kFeedback, "Ctrl+R", "",
     QT_TRANSLATE_NOOP("Action", "try again; after an exam, begin another")},
    {Action::kOtherCase, Scope::kFeedback, "Ctrl+N", "", QT_TRANSLATE_NOOP("Action", "back to the start page")},
    {Action::kReport, Scope::kFeedback, "Ctrl+P", "", QT_TRANSLATE_NOOP("Action", "save the report of the attempt")},

    {Action::kLayout, Scope::kWork, "Ctrl+1 Ctrl+2 Ctrl+3 Ctrl+4 Ctrl+5 Ctrl+6",
     QT_TRANSLATE_NOOP("Action", "Ctrl+1, Ctrl+2 …"), QT_TRANSLATE_NOOP("Action", "layout of the views")},
    {Action::kXrayView, Scope::kWork, "Ctrl+Shift+X", "", QT_TRANSLATE_NOOP("Action", "show or hide the X-ray view")},
    {Action::kFreeze, Scope::kWork, "F", "", QT_TRANSLATE_NOOP("Action", "freeze the ultrasound image")},
    {Action::kAutomaticGain, Scope::kWork, "Ctrl+G", "", QT_TRANSLATE_NOOP("Action", "automatic ultrasound gain")},
    {Action::kMoreGain, Scope::kWork, "G", "", QT_TRANSLATE_NOOP("Action", "more ultrasound gain")},
    {Action::kLessGain, Scope::kWork, "Shift+G", "", QT_TRANSLATE_NOOP("Action", "less ultrasound gain")},
    {Action::kDeeper, Scope::kWork, "D", "", QT_TRANSLATE_NOOP("Action", "more ultrasound depth")},
    {Action::kShallower, Scope::kWork, "Shift+D", "", QT_TRANSLATE_NOOP("Action", "less ultrasound depth")},
    {Action::kHarmonic, Scope::kWork, "R", "", QT_TRANSLATE_NOOP("Action", "tissue harmonic imaging (THI)")},
    {Action::kDoppler, Scope::kWork, "C", "", QT_TRANSLATE_NOOP("Action", "colour Doppler")},
    {Action::kMeasure, Scope::kWork, "M", QT_TRANSLATE_NOOP("Action", "M, then two clicks or a drag"),
     QT_TRANSLATE_NOOP("Action", "measure a distance in the ultrasound image; its ends can be dragged later")},
    {Action::kUltrasoundControls, Scope::kWork, "K", "",
     QT_TRANSLATE_NOOP("Action", "show or hide the image controls beside the ultrasound image")},

    {Action::kTissues, Scope::kWindow, "Ctrl+T", "",
     QT_TRANSLATE_NOOP("Action", "tissue parameters and the predicted force")},
    {Action::kCaseBuilder, Scope::kWindow, "Ctrl+B", "",
     QT_TRANSLATE_NOOP("Action", "case builder: create cases from CT and labels")},
    {Action::kKeys, Scope::kWindow, "F1", "", QT_TRANSLATE_NOOP("Action", "all keys and mouse actions")},
    {Action::kMirroring, Scope::kWindow, "F8", "", QT_TRANSLATE_NOOP("Action", "mirror the window, or not")},
    {Action::kFullScreen, Scope::kWindow, "F11", "", QT_TRANSLATE_NOOP("Action", "full screen")},
    {Action::kLargerText, Scope::kWindow, "Ctrl++", "", QT_TRANSLATE_NOOP("Action", "larger text")},
    {Action::kSmallerText, Scope::kWindow, "Ctrl+-", "", QT_TRANSLATE_NOOP("Action", "smaller text")},

    {Action::kStart, Scope::kStart, "Return Enter", "",
     QT_TRANSLATE_NOOP("Action", "open the case and show the briefing")},
    {Action::kStartProposal, Scope::kStart, "Ctrl+G", "",
     QT_TRANSLATE_NOOP("Action", "select the proposed exercise and open the case")},
    {Action::kOpenFolder, Scope::kStart, "Ctrl+O", "", QT_TRANSLATE_NOOP("Action", "open a patient folder")},

    {Action::kBegin, Scope::kBriefing, "Return Enter", "", QT_TRANSLATE_NOOP("Action", "begin the attempt")},
    {Action::kBack, Scope::kBriefing, "Esc", "",
     QT_TRANSLATE_NOOP("Action", "back to the start page; stops opening the case")},

    {Action::kCameraPreset, Scope::kView3d, "1 2 3 4 5 6", QT_TRANSLATE_NOOP("Action", "1 … 6"),
     QT_TRANSLATE_NOOP("Action", "look from the front, obliquely, from the right, left, back, head")},
    {Action::kOrbit, Scope::kView3d, "Left Right Up Down", QT_TRANSLATE_NOOP("Action", "drag; arrow keys"),
     QT_TRANSLATE_NOOP("Action", "rotate the view")},
    {Action::kZoom3d, Scope::kView3d, "+ -", QT_TRANSLATE_NOOP("Action", "wheel; +, −"),
     QT_TRANSLATE_NOOP("Action", "zoom in, out")},
    {Action::kFollowTip, Scope::kView3d, "T", "", QT_TRANSLATE_NOOP("Action", "follow the needle tip")},
    {Action::kAlongNeedle, Scope::kView3d, "L", "", QT_TRANSLATE_NOOP("Action", "look along the needle")},
    {Action::kBesideNeedle, Scope::kView3d, "B", "", QT_TRANSLATE_NOOP("Action", "look from beside the needle")},
    {Action::kGuidance, Scope::kView3d, "O", "", QT_TRANSLATE_NOOP("Action", "show or hide the guidance")},
    {Action::kLandmarks, Scope::kView3d, "I", "", QT_TRANSLATE_NOOP("Action", "show or hide the landmarks")},
    {Action::kResetCamera, Scope::kView3d, "Home", "", QT_TRANSLATE_NOOP("Action", "reset the view")},

    {Action::kMoveFocus, Scope::kSlices, "Left Right Up Down", QT_TRANSLATE_NOOP("Action", "click; arrow keys"),
     QT_TRANSLATE_NOOP("Action", "move the crosshairs")},
    {Action::kMoveFocusFar, Scope::kSlices, "Shift+Left Shift+Right Shift+Up Shift+Down",
     QT_TRANSLATE_NOOP("Action", "Shift + arrow keys"), QT_TRANSLATE_NOOP("Action", "the same by 10 mm")},
    {Action::kScrollSlices, Scope::kSlices, "PgUp PgDown", QT_TRANSLATE_NOOP("Action", "wheel; Page up, Page down"),
     QT_TRANSLATE_NOOP("Action", "next, previous slice")},
    {Action::kZoomSlice, Scope::kSlices, "+ = -", QT_TRANSLATE_NOOP("Action", "Ctrl + wheel; +, −"),
     QT_TRANSLATE_NOOP("Action", "zoom in, out")},
    {Action::kWindowPreset, Scope::kSlices, "1 2 3 4 5", QT_TRANSLATE_NOOP("Action", "1 … 5"),
     QT_TRANSLATE_NOOP("Action", "CT window")},
    {Action::kResetSlice, Scope::kSlices, "R", "", QT_TRANSLATE_NOOP("Action", "reset the slice")},
    {Action::kLabels, Scope::kSlices, "L", "", QT_TRANSLATE_NOOP("Action", "show or hide the labels")},

    {Action::kCineFrame, Scope::kUltrasound, "Left Right", QT_TRANSLATE_NOOP("Action", "wheel; arrow keys"),
     QT_TRANSLATE_NOOP("Action", "previous, next image of the frozen cine loop")},
    {Action::kCinePlay, Scope::kUltrasound, "P", "", QT_TRANSLATE_NOOP("Action", "play the frozen cine loop")},
    {Action::kZoomUltrasound, Scope::kUltrasound, "+ = -", QT_TRANSLATE_NOOP("Action", "Ctrl + wheel; +, −"),
     QT_TRANSLATE_NOOP("Action", "magnify the image")},
    {Action::kWholeUltrasound, Scope::kUltrasound, "0", "", QT_TRANSLATE_NOOP("Action", "whole image")},
    {Action::kDeleteCaliper, Scope::kUltrasound, "Del Backspace", "",
     QT_TRANSLATE_NOOP("Action", "delete the selected caliper, else the last one")},
    {Action::kLeaveCaliper, Scope::kUltrasound, "Esc", "", QT_TRANSLATE_NOOP("Action", "stop measuring")},

    {Action::kPlotAxis, Scope::kForcePlot, "T", "", QT_TRANSLATE_NOOP("Action", "plot over depth or time")},

    {Action::kStepTime, Scope::kTimeLine, "Left Right", "", QT_TRANSLATE_NOOP("Action", "back, forward")},
    {Action::kStepTimeFar, Scope::kTimeLine, "Shift+Left Shift+Right", "",
     QT_TRANSLATE_NOOP("Action", "further back, forward")},
    {Action::kFirstMoment, Scope::kTimeLine, "Home", "", QT_TRANSLATE_NOOP("Action", "start of the replay")},
    {Action::kLastMoment, Scope::kTimeLine, "End", "", QT_TRANSLATE_NOOP("Action", "end of the replay")},
    {Action::kSpeed, Scope::kTimeLine, "< , > .", QT_TRANSLATE_NOOP("Action", "<, >"),
     QT_TRANSLATE_NOOP("Action", "slower, faster")},

    {Action::kUndoHere, Scope::kPanel, "Ctrl+Z", "",
     QT_TRANSLATE_NOOP("Action", "undo a change of an opacity, a tissue parameter or a caliper")},
    {Action::kRedoHere, Scope::kPanel, "Ctrl+Shift+Z", "", QT_TRANSLATE_NOOP("Action", "redo it")},

    {Action::kCaseStep, Scope::kCaseBuilder, "Alt+1 Alt+2 Alt+3 Alt+4 Alt+5 Alt+6 Alt+7",
     QT_TRANSLATE_NOOP("Action", "Alt+1 … Alt+7"), QT_TRANSLATE_NOOP("Action", "go to a step of the case")},
    {Action::kUndo, Scope::kCaseBuilder, "Ctrl+Z", "", QT_TRANSLATE_NOOP("Action", "undo the last step")},
    {Action::kRedo, Scope::kCaseBuilder, "Ctrl+Shift+Z", "", QT_TRANSLATE_NOOP("Action", "redo it")},
    {Action::kPickTarget, Scope::kCaseBuilder, "Ctrl+Shift+T", "",
     QT_TRANSLATE_NOOP("Action", "click the target in a slice, or double-click it in 3D")},
    {Action::kPickLandmark, Scope::kCaseBuilder, "Ctrl+L", "",
     QT_TRANSLATE_NOOP("Action", "click a landmark in a slice, or double-click it in 3D; click again to move it")},
    {Action::kPickPair, Scope::kCaseBuilder, "Ctrl+U", "",
     QT_TRANSLATE_NOOP("Action", "click a landmark pair in the CT and in the ultrasound")},
    {Action::kDrawZone, Scope::kCaseBuilder, "Ctrl+E", "", QT_TRANSLATE_NOOP("Action", "mark the entry zone")},
    {Action::kPlanPath, Scope::kCaseBuilder, "Ctrl+P", "", QT_TRANSLATE_NOOP("Action", "plan the path")},
    {Action::kPickEntry, Scope::kCaseBuilder, "Ctrl+Shift+E", "",
     QT_TRANSLATE_NOOP("Action", "click the entry of the path")},
    {Action::kPickTip, Scope::kCaseBuilder, "Ctrl+Shift+G", "",
     QT_TRANSLATE_NOOP("Action", "click the goal of the path")},
    {Action::kSaveCase, Scope::kCaseBuilder, "Ctrl+S", "", QT_TRANSLATE_NOOP("Action", "save the case")},
};

QString translated(const char* text) {
  return QCoreApplication::translate("Action", text);
}

/// "PgUp" and "Return" have other names on keyboards.
QString key_name(const QKeySequence& key) {
  if (key == QKeySequence(Qt::Key_Return) || key == QKeySequence(Qt::Key_Enter))
    return QCoreApplication::translate("Action", "Enter");
  return key.toString(QKeySequence::NativeText);
}

QStringList portable_keys(const ActionRow& row) {
  return QString::fromLatin1(row.keys).split(QLatin1Char(' '), Qt::SkipEmptyParts);
}

}  // namespace

std::span<const ActionRow> action_table() noexcept {
  return kTable;
}

const ActionRow& row_of(Action action) {
  const auto* row =
      std::find_if(std::begin(kTable), std::end(kTable), [&](const ActionRow& r) { return r.action == action; });
  TROCAR_CHECK(row != std::end(kTable));
  return *row;
}

std::vector<QKeySequence> keys_of(Action action) {
  std::vector<QKeySequence> keys;
  for (const QString& key : portable_keys(row_of(action))) keys.emplace_back(key, QKeySequence::PortableText);
  return keys;
}

QKeySequence key_of(Action action) {
  const std::vector<QKeySequence> keys = keys_of(action);
  return keys.empty() ? QKeySequence() : keys.front();
}

QString keys_text(Action action) {
  const ActionRow& row = row_of(action);
  if (*row.shown != '\0') return translated(row.shown);
  QStringList names;
  for (const QKeySequence& key : keys_of(action)) names << key_name(key);
  names.removeDuplicates();
  return names.join(QStringLiteral(", "));
}

QString does_text(Action action) {
  return translated(row_of(action).does);
}

QString tooltip_of(Action action, const QString& text) {
  QString does = text.isEmpty() ? does_text(action) : text;
  does[0] = does[0].toUpper();
  return QStringLiteral("%1  (%2)").arg(does, keys_text(action));
}

QString scope_title(Scope scope) {
  switch (scope) {
    case Scope::kWindow:
      return QCoreApplication::translate("Action", "Everywhere");
    case Scope::kStart:
      return QCoreApplication::translate("Action", "Start page");
    case Scope::kBriefing:
      return QCoreApplication::translate("Action", "Briefing");
    case Scope::kPuncture:
      return QCoreApplication::translate("Action", "Puncture");
    case Scope::kWork:
      return QCoreApplication::translate("Action", "Puncture and feedback");
    case Scope::kFeedback:
      return QCoreApplication::translate("Action", "Feedback");
    case Scope::kCaseBuilder:
      return QCoreApplication::translate("Action", "Case builder");
    case Scope::kView3d:
      return QCoreApplication::translate("Action", "3D view with the focus");
    case Scope::kSlices:
      return QCoreApplication::translate("Action", "Slice with the focus");
    case Scope::kUltrasound:
      return QCoreApplication::translate("Action", "Ultrasound image with the focus");
    case Scope::kForcePlot:
      return QCoreApplication::translate("Action", "Force plot with the focus");
    case Scope::kTimeLine:
      return QCoreApplication::translate("Action", "Time line with the focus");
    case Scope::kPanel:
      return QCoreApplication::translate("Action", "Panel with the focus");
  }
  return {};
}

std::optional<FoundAction> find_action(Scope scope, const QKeyEvent& event,
                                       const std::function<bool(Action)>& is_offered) {
  const bool is_sign = event.key() > Qt::Key_Space && event.key() <= Qt::Key_AsciiTilde &&
                       !(event.key() >= Qt::Key_A && event.key() <= Qt::Key_Z);
  Qt::KeyboardModifiers modifiers = event.modifiers() & ~Qt::KeypadModifier;
  if (is_sign) modifiers &= ~Qt::ShiftModifier;
  const int pressed = event.key() | static_cast<int>(modifiers);
  for (const ActionRow& row : kTable) {
    if (row.scope != scope || (is_offered && !is_offered(row.action))) continue;
    const QStringList keys = portable_keys(row);
    for (int n = 0; n < keys.size(); ++n)
      if (QKeySequence(keys[n], QKeySequence::PortableText) == QKeySequence(pressed)) return FoundAction{row.action, n};
  }
  return std::nullopt;
}

QString actions_as_markdown() {
  QString text = QStringLiteral("| where | action | keys, mouse |\n|---|---|---|\n");
  for (const ActionRow& row : kTable)
    text +=
        QStringLiteral("| %1 | %2 | %3 |\n").arg(scope_title(row.scope), does_text(row.action), keys_text(row.action));
  return text;
}

}  // namespace trocar::trainer
