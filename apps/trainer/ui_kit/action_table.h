#pragma once

#include <QKeySequence>
#include <QString>
#include <functional>
#include <optional>
#include <span>
#include <vector>

class QKeyEvent;

namespace trocar::trainer {

/// Everything that a user can do by key or mouse gesture.
enum class Action {
  // In every page.
  kTissues,
  kCaseBuilder,
  kKeys,
  kMirroring,
  kFullScreen,
  kLargerText,
  kSmallerText,
  // Start page, briefing.
  kStart,
  kOpenFolder,
  kStartProposal,
  kBegin,
  kBack,
  // Puncture.
  kSelectNeedle,
  kSelectTransducer,
  kSelectFinger,
  kSelectView,
  kMove,
  kTilt,
  kTurn,
  kAdvance,
  kAdvanceFinely,
  kRotateView,
  kPlannedPosition,
  kLock,
  kFire,
  kLoad,
  kAnaesthetic,
  kStylet,
  kAspirate,
  kWire,
  kBreath,
  kFluoroscopy,
  kContrast,
  kMark,
  kRemoveMark,
  kEnd,
  kConfirm,
  kDecline,
  kForces,
  // Puncture and feedback.
  kLayout,
  kXrayView,
  kFreeze,
  kHarmonic,
  kAutomaticGain,
  kMoreGain,
  kLessGain,
  kDeeper,
  kShallower,
  kDoppler,
  kMeasure,
  kUltrasoundControls,
  // Feedback.
  kPlay,
  kNextEvent,
  kPreviousEvent,
  kWorstMoment,
  kNextHint,
  kTryAgain,
  kOtherCase,
  kReport,
  // Case builder.
  kUndo,
  kRedo,
  kSaveCase,
  kCaseStep,
  kPickTarget,
  kPickLandmark,
  kPickPair,
  kDrawZone,
  kPlanPath,
  kPickEntry,
  kPickTip,
  // Views and panels that have the focus.
  kCameraPreset,
  kResetCamera,
  kOrbit,
  kZoom3d,
  kFollowTip,
  kAlongNeedle,
  kBesideNeedle,
  kGuidance,
  kLandmarks,
  kWindowPreset,
  kMoveFocus,
  kMoveFocusFar,
  kScrollSlices,
  kZoomSlice,
  kResetSlice,
  kLabels,
  kCineFrame,
  kCinePlay,
  kZoomUltrasound,
  kWholeUltrasound,
  kDeleteCaliper,
  kLeaveCaliper,
  kPlotAxis,
  kStepTime,
  kStepTimeFar,
  kFirstMoment,
  kLastMoment,
  kSpeed,
  kUndoHere,
  kRedoHere,
};

/// Where the keys of an action act.
enum class Scope {
  kWindow,       ///< Every page.
  kStart,        ///< A page, whatever has the focus.
  kBriefing,     ///< As kStart.
  kPuncture,     ///< As kStart.
  kWork,         ///< Puncture and feedback, whatever has the focus.
  kFeedback,     ///< As kStart.
  kCaseBuilder,  ///< As kStart.
  kView3d,       ///< A view or panel that has the focus. It precedes the page.
  kSlices,
  kUltrasound,
  kForcePlot,
  kTimeLine,
  kPanel,
};

/// A row of the table.
struct ActionRow {
  Action action;
  Scope scope;
  const char* keys;   ///< Portable key sequences, separated by spaces; each of them acts. Empty: mouse only.
  const char* shown;  ///< What to press, where `keys` alone does not say it: "drag, arrow keys"; empty: `keys`.
  const char* does;   ///< "end the attempt": for texts in the source language; translated by does_text().
  bool acts_on_patient = false;  ///< Not while an editor, a list, a choice or a dialog has the focus.
};

/// The whole table, in the order in which help shows it.
std::span<const ActionRow> action_table() noexcept;
const ActionRow& row_of(Action action);
std::vector<QKeySequence> keys_of(Action action);
/// The first key of an action.
QKeySequence key_of(Action action);
/// What to press, for people: "A", "Enter", "drag, arrow keys".
QString keys_text(Action action);
/// What the action does, translated: "end the attempt".
QString does_text(Action action);
/// Tooltip of a button: "End the attempt  (E)". `text` replaces what the action does.
QString tooltip_of(Action action, const QString& text = {});
QString scope_title(Scope scope);

struct FoundAction {
  Action action;
  int key = 0;  ///< Which of its keys, from 0.
};
/// The action of a key in one scope; the numeric keypad counts as the other keys, and a
/// sign or digit with Shift as without, for it needs Shift on some keyboards. `is_offered`: tells apart actions that
/// share a key; empty: all are. Nothing: another key.
std::optional<FoundAction> find_action(Scope scope, const QKeyEvent& event,
                                       const std::function<bool(Action)>& is_offered = {});
/// As text in Markdown, for the user guide.
QString actions_as_markdown();

}  // namespace trocar::trainer
